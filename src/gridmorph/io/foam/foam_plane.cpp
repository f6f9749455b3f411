#include <gridmorph/io/foam/foam_parts.hpp>
#include <gridmorph/io/foam/foam_plane.hpp>
#include <gridmorph/kernels/vec3.hpp>
#include <gridmorph/mesh/extent.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace gridmorph::foam {

namespace {

constexpr double opposite = 1e-6;       // of the mesh size
constexpr double wedge_like = 1e-5;     // of the mesh size: points of meshes in text have six digits and more
constexpr double along_an_axis = 1e-4;  // of a unit vector

enum Side : char { none, upper, lower, both };

/// The axis of the largest component.
int main_axis(Vec3 const& v) {
  double const x = std::abs(v.x), y = std::abs(v.y), z = std::abs(v.z);
  return z >= x && z >= y ? 2 : y >= x ? 1 : 0;
}
Vec3 unit_along(int axis) { return {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0}; }
/// A unit vector, as the axis that it nearly is, if it is one.
Vec3 snapped(Vec3 const& v) {
  int const axis = main_axis(v);
  Vec3 const nearest = component(v, axis) < 0 ? -unit_along(axis) : unit_along(axis);
  return distance(v, nearest) < along_an_axis ? nearest : v;
}

template <class Body>
void each_face(std::vector<BoundaryEntry> const& boundary, std::string_view type, Body const& body) {
  for (BoundaryEntry const& entry : boundary)
    if (entry["type"] == type)
      for (Index f = entry.start; f < entry.start + entry.size; ++f) body(f);
}

/// The two planes that a mesh one cell thick lies between, where it is one.
class PlaneFinder {
 public:
  PlaneFinder(Lists const& lists, std::string& why_not)
      : lists_(lists),
        size_(extent_of(lists.points).size()),
        why_not_(why_not),
        side_(std::size_t(lists.points.size()), none) {}

  std::optional<Planes> run() {
    bool any = false;
    for (char const* type : {"empty", "wedge"}) {
      if (any) continue;
      type_ = type;
      each_face(lists_.boundary, type_, [&](Index f) {
        if (!std::exchange(any, true)) first_ = face_normal(lists_.faces[f], lists_.points);
      });
    }
    if (!any) return std::nullopt;
    up_ = unit_along(main_axis(first_));
    if (is_wedge() && !find_wedge()) return std::nullopt;
    if (!find_sides()) return std::nullopt;
    find_pairs();
    if (is_one_to_one()) return std::move(out_);
    why_not_ = is_wedge() ? "nodes of its planes of type wedge that are no copies of one another"
                          : "nodes of its planes of type empty that are not opposite one another along x, y or z";
    return std::nullopt;
  }

 private:
  [[nodiscard]] bool is_wedge() const { return type_ == "wedge"; }
  [[nodiscard]] Side side_of(Index f, Vec3 const& up) const {
    return dot(face_normal(lists_.faces[f], lists_.points), up) > 0 ? upper : lower;
  }

  /// Normals of the two planes of a wedge, and how far these are from the origin; the one that looks along an axis
  /// first.
  bool measure_planes() {
    auto const plane_of = [&](Index f) { return std::size_t(side_of(f, first_) == upper ? 0 : 1); };
    each_face(lists_.boundary, type_,
              [&](Index f) { normal_[plane_of(f)] += face_normal(lists_.faces[f], lists_.points); });
    for (Vec3& n : normal_) {
      if (!(norm(n) > 0)) return false;
      n = (1 / norm(n)) * n;
    }
    std::array<double, 2> nodes{};
    each_face(lists_.boundary, type_, [&](Index f) {
      std::size_t const k = plane_of(f);
      for (Index32 const v : lists_.faces[f]) {
        offset_[k] += dot(normal_[k], lists_.points[v]);
        nodes[k] += 1;
      }
    });
    for (std::size_t k = 0; k < 2; ++k) offset_[k] /= nodes[k];
    Vec3 const across = normal_[0] - normal_[1];
    if (component(across, main_axis(across)) < 0) {
      std::swap(normal_[0], normal_[1]);
      std::swap(offset_[0], offset_[1]);
    }
    return true;
  }

  /// Normals of the planes are n cos a - m sin a and -n cos a - m sin a, n across the plane between them and m away
  /// from the axis.
  bool find_wedge() {
    if (!measure_planes()) return no_wedge("one plane of type wedge");
    Vec3 const across = normal_[0] - normal_[1], inwards = normal_[0] + normal_[1];
    Vec3 const n = snapped((1 / norm(across)) * across);
    if (!(norm(inwards) > along_an_axis) || component(n, main_axis(n)) != 1)
      return no_wedge("planes of type wedge whose middle does not lie across x, y or z");
    Vec3 const away = inwards - dot(inwards, n) * n;
    Wedge wedge;
    wedge.normal = up_ = n;
    wedge.radial = snapped((-1 / norm(away)) * away);
    wedge.axis = cross(n, wedge.radial);
    double const half = std::atan2(norm(inwards), norm(across));
    wedge.cosine = std::cos(half);
    wedge.sine = std::sin(half);
    Vec3 const origin = (-(offset_[0] + offset_[1]) / (2 * wedge.sine)) * wedge.radial +
                        ((offset_[0] - offset_[1]) / (2 * wedge.cosine)) * n;
    auto const rounded = [&](double v) { return std::abs(v) <= wedge_like * size_ ? 0.0 : v; };
    wedge.origin = {rounded(origin.x), rounded(origin.y), rounded(origin.z)};
    out_.wedge = wedge;
    return true;
  }
  bool no_wedge(char const* why) {
    why_not_ = why;
    return false;
  }

  bool find_sides() {
    bool polygons = false, across = true;
    each_face(lists_.boundary, type_, [&](Index f) {
      Side const own = side_of(f, up_);
      polygons = polygons || (own == upper && lists_.faces[f].size() > 4);
      for (Index32 const n : lists_.faces[f]) {
        char& side = side_[n];
        if (side != none && side != own) {
          across = across && is_wedge();
          side = both;
        } else {
          side = own;
        }
      }
    });
    if (polygons) why_not_ = "cells with more than four corners";
    if (!across) why_not_ = "planes of type empty that do not lie across x, y or z";
    return !polygons && across;
  }

  /// Finds the pairs of nodes by the edges across, and nodes of both planes.
  void find_pairs() {
    auto const side = [&](Index32 n) { return side_[n]; };
    for (Index f = 0; f < lists_.faces.size(); ++f) {
      auto const nodes = lists_.faces[f];
      for (std::size_t v = 0; v < nodes.size(); ++v) {
        Index32 const a = nodes[v], b = nodes[(v + 1) % nodes.size()];
        if (side(a) == upper && side(b) == lower) out_.pairs.push_back({a, b});
        if (side(a) == lower && side(b) == upper) out_.pairs.push_back({b, a});
      }
    }
    for (Index32 n = 0; n < Index32(side_.size()); ++n)
      if (side(n) == both) out_.pairs.push_back({n, n});
    std::sort(out_.pairs.begin(), out_.pairs.end());
    out_.pairs.erase(std::unique(out_.pairs.begin(), out_.pairs.end()), out_.pairs.end());
  }

  [[nodiscard]] bool is_one_to_one() const {
    Index n_nodes = 0;
    for (std::size_t n = 0; n < out_.pairs.size(); ++n) {
      auto const& [a, b] = out_.pairs[n];
      n_nodes += a == b ? 1 : 2;
      if (n > 0 && a == out_.pairs[n - 1][0]) return false;
      if (!(is_wedge() ? is_copy(a, b) : is_opposite(a, b))) return false;
    }
    return n_nodes == lists_.points.size();
  }
  [[nodiscard]] bool is_opposite(Index32 a, Index32 b) const {
    Vec3 const across = lists_.points[a] - lists_.points[b];
    double const along = dot(across, up_);
    return norm(across) > 0 && std::sqrt(std::max(0.0, dot(across, across) - along * along)) <= opposite * size_;
  }
  [[nodiscard]] bool is_copy(Index32 a, Index32 b) const {
    Wedge const& wedge = *out_.wedge;
    Vec3 const between = wedge.between(lists_.points[a], a == b), arm = between - wedge.origin;
    return distance(wedge.origin + wedge.turned(arm, 1), lists_.points[a]) <= wedge_like * size_ &&
           distance(wedge.origin + wedge.turned(arm, -1), lists_.points[b]) <= wedge_like * size_;
  }

  Lists const& lists_;
  double size_;
  std::string& why_not_;
  std::vector<char> side_;
  std::string_view type_;
  Vec3 first_, up_;
  std::array<Vec3, 2> normal_{};  ///< of the planes of a wedge
  std::array<double, 2> offset_{};
  Planes out_;
};

/// The patch in which the two planes of a wedge meet: its edges on the axis, by the name of the patch that would have
/// faces there.
void add_axis(Lists const& lists, Planes const& planes, std::vector<Index32> const& number, Mesh& mesh) {
  std::vector<char> is_axis(lists.points.size(), 0);
  for (auto const& [a, b] : planes.pairs) is_axis[a] = a == b ? 1 : 0;
  Patch axis;
  axis.name = "axis";
  axis.bc_type = "symmetryPlane";
  axis.kind = PatchKind::symmetry;
  axis.zone = 0;
  for (BoundaryEntry const& entry : lists.boundary)
    if (entry["type"] == "empty" && entry.size == 0) axis.name = entry.name;
  each_face(lists.boundary, "wedge", [&](Index f) {
    auto const nodes = lists.faces[f];
    if (dot(face_normal(nodes, lists.points), planes.wedge->normal) <= 0) return;
    for (std::size_t v = 0; v < nodes.size(); ++v) {
      Index32 const a = nodes[v], b = nodes[(v + 1) % nodes.size()];
      if (is_axis[a] != 0 && is_axis[b] != 0) axis.faces.add(std::array{number[a], number[b]});
    }
  });
  if (axis.faces.size() > 0) mesh.patches.push_back(std::move(axis));
}

}  // namespace

Vec3 Wedge::turned(Vec3 const& v, int side) const {
  return dot(v, axis) * axis + dot(v, radial) * (cosine * radial + (side * sine) * normal);
}

Vec3 Wedge::between(Vec3 const& upper, bool on_axis) const {
  Vec3 const arm = upper - origin;
  double const radius = on_axis ? 0 : cosine * dot(arm, radial) + sine * dot(arm, normal);
  return origin + dot(arm, axis) * axis + radius * radial;
}

std::optional<Planes> find_planes(Lists const& lists, std::string& why_not) {
  return PlaneFinder(lists, why_not).run();
}

Mesh upper_plane(Mesh const& mesh, Planes const& planes, Lists const& lists) {
  auto const& pairs = planes.pairs;
  CsrGraph const& faces = lists.faces;
  std::vector<Index32> number(mesh.n_nodes(), -1);
  for (std::size_t n = 0; n < pairs.size(); ++n) number[pairs[n][0]] = Index32(n);
  auto const on_plane = [&](std::span<Index32 const> nodes) {
    std::vector<Index32> out;
    for (Index32 const n : nodes)
      if (number[n] >= 0) out.push_back(number[n]);
    return out;
  };
  Mesh out;
  out.dimension = 2;
  out.source = mesh.source;
  out.first_number = mesh.first_number;
  out.notes = mesh.notes;
  out.add_zone(mesh.zones.front().name, Index(pairs.size()));
  out.zones.back().single_precision = mesh.zones.front().single_precision;
  std::vector<std::pair<Index32, Index>> cells;  // by number
  for (Index f = 0; f < faces.size(); ++f)
    if (on_plane(faces[f]).size() == faces[f].size()) cells.emplace_back(lists.owner[f], f);
  std::sort(cells.begin(), cells.end());
  for (auto const& [cell, f] : cells) {
    auto const nodes = on_plane(faces[f]);
    out.add_element(nodes.size() == 3 ? ElementType::triangle : ElementType::quadrilateral, nodes);
    out.elements.number.push_back(cell);
  }
  out.coordinates = Coordinates(Index(pairs.size()));
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    Vec3 const at = mesh.coordinates[pairs[n][0]];
    out.coordinates.set(Index(n), planes.wedge ? planes.wedge->between(at, pairs[n][0] == pairs[n][1]) : at);
  }
  for (Patch const& patch : mesh.patches) {
    if (patch.bc_type == "empty" || patch.bc_type == "wedge") continue;
    Patch edges = patch;
    edges.faces = {};
    for (Index f = 0; f < patch.faces.size(); ++f)
      if (auto const nodes = on_plane(patch.faces[f]); nodes.size() == 2) edges.faces.add(nodes);
    out.patches.push_back(std::move(edges));
  }
  if (planes.wedge) add_axis(lists, planes, number, out);
  std::vector<Index32> element(mesh.n_elements(), -1);  // of a cell
  for (std::size_t e = 0; e < out.elements.number.size(); ++e) element[out.elements.number[e]] = Index32(e);
  for (Subset const& subset : mesh.subsets) {
    Subset own{subset.name, {}};
    for (Index32 const c : subset.elements)
      if (element[c] >= 0) own.elements.push_back(element[c]);
    for (Index f = 0; f < subset.faces.size(); ++f)
      if (auto const nodes = on_plane(subset.faces[f]); nodes.size() == 2) own.faces.add(nodes);
    out.subsets.push_back(std::move(own));
  }
  for (Connection const& connection : mesh.connections) {
    Connection own = connection;
    own.nodes.clear();
    own.donor_nodes.clear();
    for (std::size_t n = 0; n < connection.nodes.size(); ++n) {
      Index32 const a = number[connection.nodes[n]], b = number[connection.donor_nodes[n]];
      if (a < 0 || b < 0) continue;
      own.nodes.push_back(a);
      own.donor_nodes.push_back(b);
    }
    if (!own.nodes.empty()) out.connections.push_back(std::move(own));
  }
  return out;
}

namespace {

/// The coordinates of both planes of a wedge: displacements in the plane between them, turned to each.
Coordinates both_sides(Coordinates const& all, Planes const& planes, Coordinates const& morphed) {
  Coordinates out(all.size());
  for (std::size_t n = 0; n < planes.pairs.size(); ++n) {
    auto const& [upper, lower] = planes.pairs[n];
    Vec3 u = morphed[Index(n)] - planes.wedge->between(all[upper], upper == lower);
    if (upper == lower) u = dot(u, planes.wedge->axis) * planes.wedge->axis;
    auto const moved = [&](Index32 node, int side) {
      // What does not move keeps its bits.
      Vec3 const from = all[node], by = planes.wedge->turned(u, side);
      auto const sum = [](double a, double b) { return b == 0 ? a : a + b; };
      return Vec3{sum(from.x, by.x), sum(from.y, by.y), sum(from.z, by.z)};
    };
    out.set(upper, moved(upper, 1));
    out.set(lower, moved(lower, -1));
  }
  return out;
}

}  // namespace

Coordinates both_planes(Coordinates const& all, Planes const& planes, Coordinates const& morphed) {
  if (planes.wedge) return both_sides(all, planes, morphed);
  Coordinates out(all.size());
  for (std::size_t n = 0; n < planes.pairs.size(); ++n) {
    auto const& [upper, lower] = planes.pairs[n];
    Vec3 const to = morphed[Index(n)], from = all[upper], below = all[lower];
    int const axis = main_axis(from - below);
    auto const stays = [axis](int k, double before, double after) { return k == axis ? before : after; };
    out.set(upper, {stays(0, from.x, to.x), stays(1, from.y, to.y), stays(2, from.z, to.z)});
    out.set(lower,
            {stays(0, below.x, gone_along(below.x, from.x, to.x)), stays(1, below.y, gone_along(below.y, from.y, to.y)),
             stays(2, below.z, gone_along(below.z, from.z, to.z))});
  }
  return out;
}

}  // namespace gridmorph::foam
