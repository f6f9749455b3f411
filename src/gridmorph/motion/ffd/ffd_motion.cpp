#include <gridmorph/motion/ffd/ffd_motion.hpp>

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/motion/ffd/ffd_lattice.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

/// Calls visit(a, b) for the sides of the facets of a patch, as places in its nodes.
template <class Visit>
void for_each_side(BoundarySurface const& surface, Visit visit) {
  if (surface.grid) {
    auto const [across, along] = *surface.grid;
    for (int b = 0; b < along; ++b)
      for (int a = 0; a < across; ++a) {
        if (a + 1 < across) visit(b * across + a, b * across + a + 1);
        if (b + 1 < along) visit(b * across + a, (b + 1) * across + a);
      }
    return;
  }
  for (GridFacet const& facet : surface.faces) {
    auto const corners = std::count_if(facet.begin(), facet.end(), [](int c) { return c >= 0; });
    for (int c = 0; c < corners; ++c) visit(facet[c], facet[(c + 1) % corners]);
  }
}

/// The face through which the way from a place inside to a point outside leaves.
std::size_t exit_of(FfdLattice const& lattice, Vec3 from, Vec3 place, Vec3 to) {
  // In bent lattices the way is followed to near where it ends.
  for (int n = 0; n < 6 && !lattice.is_box(); ++n) {
    Vec3 const middle = 0.5 * (from + to);
    if (auto const inside = lattice.place(middle)) {
      from = middle;
      place = *inside;
    } else {
      to = middle;
    }
  }
  Vec3 const way = lattice.step(place, to - from);
  std::array<double, 3> const at{place.x, place.y, place.z}, by{way.x, way.y, way.z};
  std::array<double, 6> to_face{}, beyond{};  // along the face's own coordinate
  for (std::size_t f = 0; f < 6; ++f) {
    to_face[f] = f % 2 == 0 ? -at[f / 2] : 1 - at[f / 2];
    beyond[f] = f % 2 == 0 ? to_face[f] - by[f / 2] : by[f / 2] - to_face[f];
  }
  double const farthest = *std::max_element(beyond.begin(), beyond.end());
  std::size_t out = 0;
  double first = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < 6; ++f) {
    // What runs along a face, and leaves it by round-off alone, does not leave there.
    if (beyond[f] <= 1e-6 * farthest || by[f / 2] == 0 || to_face[f] / by[f / 2] >= first) continue;
    first = to_face[f] / by[f / 2];
    out = f;
  }
  return out;
}

/// i-min, i-max, j-min, j-max, k-min, k-max: whether a side of a facet of the patches has one end inside the lattice
/// and leaves it there. Cost O(nodes of the patches).
std::array<bool, 6> cut_faces(Boundary const& boundary, std::vector<int> const& patches, FfdLattice const& lattice) {
  std::array<bool, 6> cut{};
  for (int const p : patches) {
    BoundarySurface const& surface = boundary.surface(p);
    auto const point = [&](int n) { return boundary.coordinates()[surface.nodes[n]]; };
    std::vector<std::optional<Vec3>> places;
    for (std::size_t n = 0; n < surface.nodes.size(); ++n) places.push_back(lattice.place(point(int(n))));
    for_each_side(surface, [&](int a, int b) {
      auto const &one = places[a], &other = places[b];
      if (one.has_value() == other.has_value()) return;
      cut[one ? exit_of(lattice, point(a), *one, point(b)) : exit_of(lattice, point(b), *other, point(a))] = true;
    });
  }
  return cut;
}

struct Reach {
  Vec3 low, high;
};

Reach reach_of(std::vector<Vec3> const& points) {
  Reach out{points.front(), points.front()};
  for (Vec3 const& p : points) {
    out.low = {std::min(out.low.x, p.x), std::min(out.low.y, p.y), std::min(out.low.z, p.z)};
    out.high = {std::max(out.high.x, p.x), std::max(out.high.y, p.y), std::max(out.high.z, p.z)};
  }
  return out;
}

/// A box along the coordinates, wider than the nodes by the margin. Where they have no extent: by the margin of their
/// largest one, or by a tenth of it.
FfdBox box_around(std::vector<Vec3> const& points, double margin, std::string const& name) {
  auto const [low, high] = reach_of(points);
  Vec3 const extent = high - low;
  double const most = std::max({extent.x, extent.y, extent.z});
  if (!(most > 0))
    throw MotionError(name + ": the nodes of its patches are one point; a box around them has no volume");
  auto const room = [&](double length) {
    return length > 1e-9 * most ? margin * length : (margin > 0 ? margin : 0.1) * most;
  };
  Vec3 const around{room(extent.x), room(extent.y), room(extent.z)};
  Vec3 const length = extent + 2 * around;
  return {low - around, {Vec3{length.x, 0, 0}, Vec3{0, length.y, 0}, Vec3{0, 0, length.z}}};
}

std::string box_text(FfdBox const& box) {
  std::string text = "box from " + to_text(box.origin, 6) + " along " + to_text(box.edges[0], 6);
  return text + ", " + to_text(box.edges[1], 6) + " and " + to_text(box.edges[2], 6);
}

std::string words_of(std::vector<std::string> const& words) {
  std::string out;
  for (auto const& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

}  // namespace

std::string const& ffd_face_name(std::size_t face) {
  static std::array<std::string, 6> const names{"i-min", "i-max", "j-min", "j-max", "k-min", "k-max"};
  return names[face];
}

FfdMotion::FfdMotion(Boundary const& boundary, std::vector<int> const& patches, FfdRule const& rule,
                     std::string const& name, std::vector<std::string>& notes)
    : rule_(rule) {
  std::vector<Vec3> nodes;
  for (int const p : patches)
    for (Index const n : boundary.surface(p).nodes) nodes.push_back(boundary.coordinates()[n]);
  if (nodes.empty()) throw MotionError(name + ": its patches have no nodes");
  bool const fitted = !rule_.box && rule_.points.empty();
  if (fitted) rule_.box = box_around(nodes, rule_.margin, name);

  Ground ground{FfdLattice(rule_, name), {}, PointNumbers{0}, {}};
  std::size_t inside = 0;
  for (Vec3 const& x : nodes) {
    auto const place = ground.lattice.place(x);
    inside += place ? 1 : 0;
    if (ground.lattice.is_box() || ground.numbers.find(x) >= 0) continue;
    ground.numbers.add(x, int(ground.places.size()));
    ground.places.push_back(place);
  }
  std::string const where = rule_.box ? box_text(*rule_.box) : "lattice of the control points given";
  if (inside == 0) {
    auto const [low, high] = reach_of(nodes);
    std::string text = name + ": none of the " + std::to_string(nodes.size()) +
                       " nodes of its patches, which reach from " + to_text(low, 6) + " to " + to_text(high, 6) +
                       ", is inside the " + where;
    if (!rule_.points.empty()) {
      auto const [from, to] = reach_of(rule_.points);
      text += ", from " + to_text(from, 6) + " to " + to_text(to, 6);
    }
    throw MotionError(text + "; look at its place and its unit");
  }
  if (inside < nodes.size()) ground.cut = cut_faces(boundary, patches, ground.lattice);
  ground_ = std::make_shared<Ground const>(std::move(ground));

  std::string note = name + ": ";
  if (fitted) note += where + ", fitted to the patches; ";
  note += std::to_string(inside) + " of " + std::to_string(nodes.size()) + " nodes are inside";
  if (inside < nodes.size()) note += ", " + std::to_string(nodes.size() - inside) + " outside stay where they are";
  for (bool const open : {false, true}) {
    std::vector<std::string> faces;
    for (std::size_t f = 0; f < 6; ++f)
      if (cut()[f] && rule_.open[f] == open) faces.push_back(ffd_face_name(f));
    if (faces.empty()) continue;
    note += "; the patches run out through " + words_of(faces);
    note += open ? ", open: what moves there is torn off what stays"
                 : ", where " + std::to_string(rule_.continuity + 1) +
                       " layers of control points are held (continuity " + std::to_string(rule_.continuity) + ")";
  }
  notes.push_back(std::move(note));
  check_held(name);
}

FfdMotion::FfdMotion(FfdMotion const& other, FfdRule const& rule, std::string const& name)
    : rule_(rule), ground_(other.ground_) {
  if (rule_.counts != other.rule_.counts || rule_.degree != other.rule_.degree)
    throw MotionError(name + ": its lattice is not the one that was planned with; only displacements may change");
  check_held(name);
}

bool FfdMotion::is_held(int i, int j, int k) const {
  std::array<int, 3> const at{i, j, k};
  for (std::size_t f = 0; f < 6; ++f) {
    if (!cut()[f] || rule_.open[f]) continue;
    std::size_t const a = f / 2;
    if ((f % 2 == 0 ? at[a] : rule_.counts[a] - 1 - at[a]) <= rule_.continuity) return true;
  }
  return false;
}

void FfdMotion::check_held(std::string const& name) const {
  std::vector<std::string> held;
  std::size_t more = 0;
  int nearest = rule_.continuity;  // layer of the nearest to a face that moves
  for (int k = 0; k < rule_.counts[2]; ++k)
    for (int j = 0; j < rule_.counts[1]; ++j)
      for (int i = 0; i < rule_.counts[0]; ++i) {
        if (rule_.displacement[rule_.number(i, j, k)] == Vec3{} || !is_held(i, j, k)) continue;
        std::array<int, 3> const at{i, j, k};
        for (std::size_t f = 0; f < 6; ++f)
          if (cut()[f] && !rule_.open[f])
            nearest = std::min(nearest, f % 2 == 0 ? at[f / 2] : rule_.counts[f / 2] - 1 - at[f / 2]);
        if (held.size() < 8)
          held.push_back("(" + std::to_string(i + 1) + ", " + std::to_string(j + 1) + ", " + std::to_string(k + 1) +
                         ")");
        else
          ++more;
      }
  if (held.empty()) return;
  std::vector<std::string> faces;
  for (std::size_t f = 0; f < 6; ++f)
    if (cut()[f] && !rule_.open[f]) faces.push_back(ffd_face_name(f));
  std::string text = name + ": the patches run out of the lattice through " + words_of(faces) + ", where continuity " +
                     std::to_string(rule_.continuity) + " holds " + std::to_string(rule_.continuity + 1) +
                     " layers of control points, but " + words_of(held);
  if (more > 0) text += " and " + std::to_string(more) + " more";
  text += held.size() + more == 1 ? " is" : " are";
  text +=
      " displaced; take these displacements away, make the lattice larger than the patches there, or name the face in "
      "open_faces";
  if (nearest > 0) text += ". Continuity " + std::to_string(nearest - 1) + " would do";
  throw MotionError(text);
}

std::optional<Vec3> FfdMotion::place(Vec3 const& point) const {
  int const n = ground_->lattice.is_box() ? -1 : ground_->numbers.find(point);
  return n < 0 ? ground_->lattice.place(point) : ground_->places[n];
}

void FfdMotion::displacement(std::span<Vec3 const> points, std::span<Vec3> out) const {
  for (std::size_t n = 0; n < points.size(); ++n) {
    out[n] = {};
    auto const at = place(points[n]);
    if (!at) continue;
    // About the heaviest point, so that equal displacements come out as they are, and zeros at a held face as zeros.
    std::size_t heaviest = 0;
    double most = -1;
    lattice().for_each_weight(*at, [&](std::size_t number, double weight) {
      if (weight <= most) return;
      most = weight;
      heaviest = number;
    });
    Vec3 const& base = rule_.displacement[heaviest];
    Vec3 sum{};
    lattice().for_each_weight(
        *at, [&](std::size_t number, double weight) { sum += weight * (rule_.displacement[number] - base); });
    out[n] = base + sum;
    if (rule_.share != 1) out[n] = rule_.share * out[n];
  }
}

void FfdMotion::add_gradient(Vec3 const& point, Vec3 const& dJ_du, std::span<Vec3> dJ_dd) const {
  auto const at = place(point);
  if (!at) return;
  lattice().for_each_weight(*at, [&](std::size_t number, double weight) {
    auto const i = int(number % std::size_t(rule_.counts[0])), rest = int(number / std::size_t(rule_.counts[0]));
    if (!is_held(i, rest % rule_.counts[1], rest / rule_.counts[1])) dJ_dd[number] += (rule_.share * weight) * dJ_du;
  });
}

}  // namespace gridmorph
