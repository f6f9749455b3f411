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
  for (int k = 0; k < 4; ++k)
    out.corner[std::size_t(own[std::size_t(k)])] =
        std::int8_t(other[std::size_t(reversed ? (start + 4 - k) % 4 : (start + k) % 4)]);
  // Out of this cell is into that one.
  int const axis = side_axis[std::size_t(from)];
  out.axes.axis[std::size_t(axis)] = side_axis[std::size_t(to)];
  out.axes.sign[std::size_t(axis)] = side_end[std::size_t(from)] != side_end[std::size_t(to)] ? 1 : -1;
  int const first = own[0];
  for (int a = 0; a < 3; ++a) {
    if (a == axis) continue;
    int const place = corner_place[std::size_t(first)], next = corner_place[std::size_t(place ^ (1 << a))];
    int const there = corner_place[std::size_t(out.corner[std::size_t(first)])],
              on = corner_place[std::size_t(out.corner[std::size_t(next)])];
    int const along = there ^ on;
    int const b = along == 1 ? 0 : along == 2 ? 1 : 2;
    out.axes.axis[std::size_t(a)] = b;
    bool const up_here = (place & (1 << a)) == 0, up_there = (there & (1 << b)) == 0;
    out.axes.sign[std::size_t(a)] = up_here == up_there ? 1 : -1;
  }
  return out;
}

std::array<HexTurn, 288> all_turns() {
  std::array<HexTurn, 288> out;
  for (int n = 0; n < 288; ++n) out[std::size_t(n)] = turned(n / 48, n / 8 % 6, n % 8);
  return out;
}

}  // namespace

std::array<HexTurn, 288> const side_turns = all_turns();

HexLinks::HexLinks(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology)
    : mesh_(mesh), topology_(topology), representative_(coincident_nodes(mesh)) {
  auto const n_sides = std::size_t(6 * mesh.n_elements());
  face_.assign(n_sides, -1);
  for (Index f = 0; f < topology.boundary.size(); ++f) {
    Index32 const e = topology.boundary.element[std::size_t(f)];
    if (is_hexahedron(e)) face_[std::size_t(cell_side(e, topology.boundary.side[std::size_t(f)]))] = Index32(f);
  }
  for (Connection const& c : mesh.connections) {
    auto& there = pairs_.emplace_back();
    for (std::size_t n = 0; n < c.nodes.size(); ++n)
      there.emplace_back(representative_[std::size_t(c.nodes[n])], representative_[std::size_t(c.donor_nodes[n])]);
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
      partner_[std::size_t(s)] = other;
      turn_[std::size_t(s)] = std::int8_t(turn);
    }
  });
}

CellSide HexLinks::find_partner(CellSide s) const {
  Index32 const e = s / 6;
  Index32 const other = topology_.sides.of(e)[std::size_t(s % 6)];
  if (other >= 0) {
    if (!is_hexahedron(other)) return -1;
    auto const back = topology_.sides.of(other);
    for (int side = 0; side < 6; ++side)  // two cells may have two sides in common
      if (back[std::size_t(side)] == e &&
          turn_between(s, cell_side(other, side), [](Index32 a, Index32 b) { return a == b; }) >= 0)
        return cell_side(other, side);
    return -1;
  }
  Index32 const f = face_[std::size_t(s)];
  Index32 const across = f < 0 ? -1 : topology_.boundary.across[std::size_t(f)];
  if (across < 0) return -1;
  auto const c = std::size_t(topology_.boundary.connection[std::size_t(f)] / 2);
  Index32 const there = topology_.boundary.element[std::size_t(across)];
  if (mesh_.connections[c].periodic || !is_hexahedron(there)) return -1;
  return cell_side(there, topology_.boundary.side[std::size_t(across)]);
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
        all = same(node(from / 6, own[std::size_t(k)]), node(to / 6, other[std::size_t(at)]));
      }
      if (all) return 2 * start + reversed;
    }
  return -1;
}

std::optional<HexLink> HexLinks::periodic(CellSide s) const {
  Index32 const f = face_[std::size_t(s)];
  if (f < 0) return {};
  Index32 const across = topology_.boundary.across[std::size_t(f)], c = topology_.boundary.connection[std::size_t(f)];
  if (across < 0 || !mesh_.connections[std::size_t(c / 2)].periodic) return {};
  Index32 const there = topology_.boundary.element[std::size_t(across)];
  if (!is_hexahedron(there)) return {};
  auto const& pairs = pairs_[std::size_t(c)];
  CellSide const to = cell_side(there, topology_.boundary.side[std::size_t(across)]);
  int const turn = turn_between(
      s, to, [&](Index32 a, Index32 b) { return std::binary_search(pairs.begin(), pairs.end(), std::pair(a, b)); });
  if (turn < 0) return {};
  return made(s, to, turn);
}

}  // namespace gridmorph::detail
