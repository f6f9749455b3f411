#include <gridmorph/core/for_all.hpp>
#include <gridmorph/mesh/detail/hex_links.hpp>

#include <algorithm>
#include <utility>

namespace gridmorph::detail {

namespace {

HexTurn turned(int from, int to, int turn) {
  HexTurn out;
  int const start = turn / 2;
  bool const reversed = turn % 2 != 0;
  auto const own = corners_of_side(from), other = corners_of_side(to);
  for (int k = 0; k < 4; ++k) out.corner[own[k]] = std::int8_t(other[reversed ? (start + 4 - k) % 4 : (start + k) % 4]);
  // Out of this cell is into that one.
  int const axis = side_axis[from];
  out.axes.axis[axis] = side_axis[to];
  out.axes.sign[axis] = side_end[from] != side_end[to] ? 1 : -1;
  int const first = own[0];
  for (int a = 0; a < 3; ++a) {
    if (a == axis) continue;
    int const place = corner_place[first], next = corner_place[place ^ (1 << a)];
    int const there = corner_place[out.corner[first]], on = corner_place[out.corner[next]];
    int const along = there ^ on;
    int const b = along == 1 ? 0 : along == 2 ? 1 : 2;
    out.axes.axis[a] = b;
    bool const up_here = (place & (1 << a)) == 0, up_there = (there & (1 << b)) == 0;
    out.axes.sign[a] = up_here == up_there ? 1 : -1;
  }
  return out;
}

std::array<HexTurn, 288> all_turns() {
  std::array<HexTurn, 288> out;
  for (int n = 0; n < 288; ++n) out[n] = turned(n / 48, n / 8 % 6, n % 8);
  return out;
}

}  // namespace

std::array<HexTurn, 288> const side_turns = all_turns();

HexLinks::HexLinks(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology)
    : mesh_(mesh),
      topology_(topology),
      only_hexahedra_(std::all_of(mesh.elements.type.begin(), mesh.elements.type.end(),
                                  [](ElementType type) { return type == ElementType::hexahedron; })),
      representative_(coincident_nodes(mesh)) {
  for (Connection const& c : mesh.connections) {
    auto& there = pairs_.emplace_back();
    for (std::size_t n = 0; n < c.nodes.size(); ++n)
      there.emplace_back(representative_[c.nodes[n]], representative_[c.donor_nodes[n]]);
    auto back = there;
    for (auto& pair : back) std::swap(pair.first, pair.second);
    std::sort(there.begin(), there.end());
    std::sort(back.begin(), back.end());
    pairs_.push_back(std::move(back));
  }
  way_.assign(std::size_t(6 * mesh.n_elements()), -1);
  for_all(host, "gridmorph::hex_links", mesh.n_elements(), [&](Index e) {
    if (!is_hexahedron(Index32(e))) return;
    for (int side = 0; side < 6; ++side) {
      CellSide const s = cell_side(Index32(e), side);
      way_[s] = std::int8_t(find_way(s));
    }
  });
}

Index32 HexLinks::boundary_face(CellSide s) const {
  BoundaryFaces const& boundary = topology_.boundary;
  Index32 const e = s / 6;
  auto f =
      std::size_t(std::lower_bound(boundary.element.begin(), boundary.element.end(), e) - boundary.element.begin());
  for (; f < boundary.element.size() && boundary.element[f] == e; ++f)
    if (boundary.side[f] == s % 6) return Index32(f);
  return -1;
}

Index32 HexLinks::cell_across(CellSide s) const {
  return topology_.boundary.element[topology_.boundary.across[boundary_face(s)]];
}

int HexLinks::find_way(CellSide s) const {
  auto const is_same = [](Index32 a, Index32 b) { return a == b; };
  Index32 const e = s / 6;
  Index32 const other = topology_.sides.of(e)[s % 6];
  if (other >= 0) {
    if (!is_hexahedron(other)) return -1;
    auto const back = topology_.sides.of(other);
    for (int side = 0; side < 6; ++side) {  // two cells may have two sides in common
      if (back[side] != e) continue;
      if (int const way = way_between(s, cell_side(other, side), is_same); way >= 0) return way;
    }
    return -1;
  }
  Index32 const f = other == ElementSides::boundary ? boundary_face(s) : -1;
  Index32 const across = f < 0 ? -1 : topology_.boundary.across[f];
  if (across < 0) return -1;
  auto const c = std::size_t(topology_.boundary.connection[f] / 2);
  Index32 const there = topology_.boundary.element[across];
  if (mesh_.connections[c].periodic || !is_hexahedron(there)) return -1;
  return way_between(s, cell_side(there, topology_.boundary.side[across]), is_same);
}

template <class Same>
int HexLinks::way_between(CellSide from, CellSide to, Same const& same) const {
  auto const own = corners_of_side(from % 6), other = corners_of_side(to % 6);
  // Seen from the two cells a side runs the other way round, unless one of them is inside out: these come last.
  for (int const reversed : {1, 0})
    for (int start = 0; start < 4; ++start) {
      bool all = true;
      for (int k = 0; k < 4 && all; ++k) {
        int const at = reversed ? (start + 4 - k) % 4 : (start + k) % 4;
        all = same(node(from / 6, own[k]), node(to / 6, other[at]));
      }
      if (all) return n_ways * (to % 6) + 2 * start + reversed;
    }
  return -1;
}

std::optional<HexLink> HexLinks::periodic(CellSide s) const {
  Index32 const f = boundary_face(s);
  if (f < 0) return {};
  Index32 const across = topology_.boundary.across[f], c = topology_.boundary.connection[f];
  if (across < 0 || !mesh_.connections[c / 2].periodic) return {};
  Index32 const there = topology_.boundary.element[across];
  if (!is_hexahedron(there)) return {};
  auto const& pairs = pairs_[c];
  CellSide const to = cell_side(there, topology_.boundary.side[across]);
  int const way = way_between(
      s, to, [&](Index32 a, Index32 b) { return std::binary_search(pairs.begin(), pairs.end(), std::pair(a, b)); });
  if (way < 0) return {};
  return made(s, there, way);
}

}  // namespace gridmorph::detail
