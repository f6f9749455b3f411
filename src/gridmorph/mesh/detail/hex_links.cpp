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
    : mesh_(mesh), topology_(topology), representative_(coincident_nodes(mesh)) {
  auto const n_sides = std::size_t(6 * mesh.n_elements());
  face_.assign(n_sides, -1);
  for (Index f = 0; f < topology.boundary.size(); ++f) {
    Index32 const e = topology.boundary.element[f];
    if (is_hexahedron(e)) face_[cell_side(e, topology.boundary.side[f])] = Index32(f);
  }
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
  partner_.assign(n_sides, -1);
  turn_.assign(n_sides, -1);
  for_all(host, "gridmorph::hex_links", mesh.n_elements(), [&](Index e) {
    if (!is_hexahedron(Index32(e))) return;
    for (int side = 0; side < 6; ++side) {
      CellSide const s = cell_side(Index32(e), side), other = find_partner(s);
      if (other < 0) continue;
      int const turn = turn_between(s, other, [](Index32 a, Index32 b) { return a == b; });
      if (turn < 0) continue;
      partner_[s] = other;
      turn_[s] = std::int8_t(turn);
    }
  });
}

CellSide HexLinks::find_partner(CellSide s) const {
  Index32 const e = s / 6;
  Index32 const other = topology_.sides.of(e)[s % 6];
  if (other >= 0) {
    if (!is_hexahedron(other)) return -1;
    auto const back = topology_.sides.of(other);
    for (int side = 0; side < 6; ++side)  // two cells may have two sides in common
      if (back[side] == e && turn_between(s, cell_side(other, side), [](Index32 a, Index32 b) { return a == b; }) >= 0)
        return cell_side(other, side);
    return -1;
  }
  Index32 const f = face_[s];
  Index32 const across = f < 0 ? -1 : topology_.boundary.across[f];
  if (across < 0) return -1;
  auto const c = std::size_t(topology_.boundary.connection[f] / 2);
  Index32 const there = topology_.boundary.element[across];
  if (mesh_.connections[c].periodic || !is_hexahedron(there)) return -1;
  return cell_side(there, topology_.boundary.side[across]);
}

template <class Same>
int HexLinks::turn_between(CellSide from, CellSide to, Same const& same) const {
  auto const own = corners_of_side(from % 6), other = corners_of_side(to % 6);
  // Seen from the two cells a side runs the other way round, unless one of them is inside out: these come last.
  for (int const reversed : {1, 0})
    for (int start = 0; start < 4; ++start) {
      bool all = true;
      for (int k = 0; k < 4 && all; ++k) {
        int const at = reversed ? (start + 4 - k) % 4 : (start + k) % 4;
        all = same(node(from / 6, own[k]), node(to / 6, other[at]));
      }
      if (all) return 2 * start + reversed;
    }
  return -1;
}

std::optional<HexLink> HexLinks::periodic(CellSide s) const {
  Index32 const f = face_[s];
  if (f < 0) return {};
  Index32 const across = topology_.boundary.across[f], c = topology_.boundary.connection[f];
  if (across < 0 || !mesh_.connections[c / 2].periodic) return {};
  Index32 const there = topology_.boundary.element[across];
  if (!is_hexahedron(there)) return {};
  auto const& pairs = pairs_[c];
  CellSide const to = cell_side(there, topology_.boundary.side[across]);
  int const turn = turn_between(
      s, to, [&](Index32 a, Index32 b) { return std::binary_search(pairs.begin(), pairs.end(), std::pair(a, b)); });
  if (turn < 0) return {};
  return made(s, to, turn);
}

}  // namespace gridmorph::detail
