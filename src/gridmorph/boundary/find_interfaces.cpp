#include <gridmorph/boundary/detail/periodic_faces.hpp>
#include <gridmorph/boundary/find_interfaces.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/mesh/check_coordinates.hpp>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <tuple>

namespace gridmorph {

namespace {

using topology::CellPair;
using topology::SurfaceCells;
using topology::Turn;
using topology::ZoneFace;

/// A pair of cells with what it has in common with others of one interface: faces, turn, and where node (0, 0) would
/// go.
struct Placed {
  int face, other_face, turn;
  std::array<int, 2> origin;
  int a, b;

  [[nodiscard]] auto label() const { return std::tie(face, other_face, turn, origin); }
};

Placed place(SurfaceCells const& cells, CellPair const& pair) {
  auto const& at = topology::corner_offset;
  Placed out{cells.face_of(pair.cell), cells.face_of(pair.other), pair.turn.number, {}, 0, 0};
  ZoneFace const& own = cells.faces()[out.face];
  ZoneFace const& other = cells.faces()[out.other_face];
  out.a = int((pair.cell - own.first) % own.nu);
  out.b = int((pair.cell - own.first) / own.nu);
  std::array<int, 2> const there{int((pair.other - other.first) % other.nu),
                                 int((pair.other - other.first) / other.nu)};
  for (int x = 0; x < 2; ++x) {
    int const base = at[pair.turn.image(0)][x];
    int const along_u = at[pair.turn.image(1)][x] - base, along_v = at[pair.turn.image(3)][x] - base;
    out.origin[x] = there[x] + base - along_u * out.a - along_v * out.b;
  }
  return out;
}

struct Rectangle {
  int a0, a1, b0, b1;  ///< cells, half-open
};

/// Rows of cells, joined where the same row goes on above. `cells` are ordered by b, then a.
template <class Iterator>
std::vector<Rectangle> rectangles(Iterator begin, Iterator end) {
  std::vector<Rectangle> out;
  std::vector<std::size_t> below, row;  // rectangles that reach the row before and this one
  for (Iterator at = begin; at != end;) {
    int const b = at->b, a0 = at->a;
    int a1 = a0;
    for (; at != end && at->b == b && at->a == a1; ++at) ++a1;
    auto const grows = std::find_if(below.begin(), below.end(), [&](std::size_t r) {
      return out[r].a0 == a0 && out[r].a1 == a1 && out[r].b1 == b;
    });
    if (grows != below.end()) {
      ++out[*grows].b1;
      row.push_back(*grows);
    } else {
      row.push_back(out.size());
      out.push_back({a0, a1, b, b + 1});
    }
    if (at == end || at->b != b) {
      below = std::move(row);
      row.clear();
    }
  }
  return out;
}

Interface1to1 make_interface(SurfaceCells const& cells, Placed const& p, Rectangle const& r) {
  ZoneFace const& own = cells.faces()[p.face];
  ZoneFace const& other = cells.faces()[p.other_face];
  auto const& at = topology::corner_offset;
  Turn const turn{p.turn};
  Interface1to1 out;
  out.zone = own.zone;
  out.donor_zone = other.zone;
  out.range.begin = cells.node_index(own, r.a0, r.b0);
  out.range.end = cells.node_index(own, r.a1, r.b1);
  for (auto& e : out.range.end) ++e;

  std::array<std::array<int, 2>, 2> column;
  for (int x = 0; x < 2; ++x) {
    int const base = at[turn.image(0)][x];
    column[0][x] = at[turn.image(1)][x] - base;
    column[1][x] = at[turn.image(3)][x] - base;
  }
  Orientation o;
  std::array<int, 2> const own_axis{own.u, own.v}, other_axis{other.u, other.v};
  for (int step = 0; step < 2; ++step)
    for (int x = 0; x < 2; ++x)
      if (column[step][x] != 0) {
        o.axis[own_axis[step]] = other_axis[x];
        o.sign[own_axis[step]] = column[step][x];
      }
  o.axis[own.axis] = other.axis;
  o.sign[own.axis] = own.side == other.side ? -1 : 1;
  std::array<int, 2> image{};
  for (int x = 0; x < 2; ++x) image[x] = p.origin[x] + column[0][x] * r.a0 + column[1][x] * r.b0;
  out.to_donor = {o, out.range.begin, cells.node_index(other, image[0], image[1])};
  return out;
}

std::vector<Interface1to1> assemble(SurfaceCells const& cells, std::vector<CellPair> const& pairs) {
  std::vector<Placed> placed;
  placed.reserve(pairs.size());
  for (auto const& pair : pairs) placed.push_back(place(cells, pair));
  std::sort(placed.begin(), placed.end(), [](Placed const& x, Placed const& y) {
    return std::tuple(x.label(), x.b, x.a) < std::tuple(y.label(), y.b, y.a);
  });
  std::vector<Interface1to1> out;
  for (auto begin = placed.begin(); begin != placed.end();) {
    auto const end = std::find_if(begin, placed.end(), [&](Placed const& p) { return p.label() != begin->label(); });
    for (auto const& r : rectangles(begin, end)) out.push_back(make_interface(cells, *begin, r));
    begin = end;
  }
  return out;
}

Periodic declared(topology::PeriodicMatch const& match) {
  return match.rotation ? periodic_rotation(match.origin, match.direction, match.angle_rad)
                        : periodic_translation(match.transform.translation);
}

}  // namespace

FoundInterfaces find_interfaces(Mesh const& mesh, MatchOptions const& options) {
  check_coordinates(mesh, "gridmorph::find_interfaces");
  check_usable(mesh, "gridmorph::find_interfaces");
  if (!(options.tolerance > 0 && options.tolerance <= 0.25))
    throw MeshError("the tolerance for matching points is a share of the smallest edge, between 0 and 0.25, found " +
                    to_text(options.tolerance, 6));
  FoundInterfaces out;
  SurfaceCells cells(mesh);
  auto const add = [&](std::vector<CellPair> const& pairs, std::optional<Periodic> const& periodic) {
    for (auto& face : assemble(cells, pairs)) {
      face.name = (periodic ? "periodic " : "match ") + std::to_string(out.interfaces.size() + 1);
      face.periodic = periodic;
      out.interfaces.push_back(std::move(face));
    }
    for (auto const& pair : pairs) {
      out.mismatch = std::max(out.mismatch, pair.mismatch);
      cells.claim(pair.cell);
      cells.claim(pair.other);
    }
  };

  Index ambiguous = 0;
  add(topology::CellBins(cells, options.tolerance).match({}, true, ambiguous), std::nullopt);
  if (ambiguous > 0)
    out.notes.push_back(std::to_string(ambiguous) +
                        " face cells coincide with several others and were joined with the nearest");
  if (!options.periodic) return out;

  std::vector<std::uint8_t> open(cells.size());
  for (Index c = 0; c < cells.size(); ++c) open[c] = cells.is_open(c) ? 1 : 0;
  auto const matches = topology::find_periodic(cells, options.tolerance, out.notes);
  auto const judged = topology::judge(cells, matches, open);
  for (std::size_t m = 0; m < matches.size(); ++m) {
    auto const& match = matches[m];
    std::string what = std::to_string(match.pairs.size()) + " pairs of face cells match by ";
    if (match.rotation)
      what += "a rotation of " + to_text(match.angle_rad * 180 / std::numbers::pi, 6) + " degrees about " +
              to_text(match.direction, 6) + " through " + to_text(match.origin, 6);
    else
      what += "the translation " + to_text(match.transform.translation, 6);
    if (!judged[m].taken)
      what += "; not taken as periodic: " + judged[m].why;
    else if (!match.rotation)
      what += "; taken as periodic: take it out if these are inlet and outlet, or end walls";
    out.notes.push_back(std::move(what));
    if (judged[m].taken) add(match.pairs, declared(match));
  }
  return out;
}

}  // namespace gridmorph
