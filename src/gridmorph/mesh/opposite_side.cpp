#include <gridmorph/mesh/opposite_side.hpp>

#include <algorithm>
#include <array>
#include <cstdint>

namespace gridmorph {

namespace {

/// What lies across an element from one of its sides, by numbers of the element's corners.
struct OfType {
  int side = -1;
  int n = 0;
  std::array<std::int8_t, 4> below{}, above{};
};

OfType find_of_type(ElementType type, int side) {
  OfType out;
  int const corners = type == ElementType::quadrilateral ? 2 : type == ElementType::prism ? 3 : 4;
  if (n_face_corners(type, side) != corners) return out;
  out.n = corners;
  auto const is_of = [&](std::array<std::int8_t, 4> const& list, int corner) {
    return std::find(list.begin(), list.begin() + corners, std::int8_t(corner)) != list.begin() + corners;
  };
  for (int c = 0; c < corners; ++c) out.below[c] = std::int8_t(face_corner(type, side, c));
  for (int c = 0; c < corners; ++c)
    // The one edge of this corner that leaves the side.
    for (int k = 0; k < n_edges(type); ++k) {
      int const a = edge_corner(type, k, 0), b = edge_corner(type, k, 1), own = out.below[c];
      int const other = a == own ? b : b == own ? a : -1;
      if (other >= 0 && !is_of(out.below, other)) out.above[c] = std::int8_t(other);
    }
  for (int s = 0; s < n_faces(type); ++s) {
    bool same = n_face_corners(type, s) == corners;
    for (int c = 0; same && c < corners; ++c) same = is_of(out.above, face_corner(type, s, c));
    if (same) out.side = s;
  }
  return out;
}

/// What find_of_type() finds, from tables that are made once.
OfType const& of_type(ElementType type, int side) {
  constexpr std::array types{ElementType::quadrilateral, ElementType::prism, ElementType::hexahedron};
  constexpr std::size_t most_sides = 6;
  static auto const tables = [&] {
    std::array<std::array<OfType, most_sides>, types.size()> out{};
    for (std::size_t t = 0; t < types.size(); ++t)
      for (int s = 0; s < n_faces(types[t]); ++s) out[t][s] = find_of_type(types[t], s);
    return out;
  }();
  static OfType const none;
  auto const at = std::find(types.begin(), types.end(), type);
  return at == types.end() ? none : tables[at - types.begin()][side];
}

void find_of_polyhedron(Mesh const& mesh, Index element, int side, OppositeSide& out) {
  std::array<Index32, max_face_corners> room;
  auto const own = side_nodes(mesh, element, side, room);
  out.below.assign(own.begin(), own.end());
  std::size_t const n = out.below.size();
  out.above.assign(n, -1);
  auto const place = [&](Index32 node) {
    auto const at = std::find(out.below.begin(), out.below.end(), node);
    return at == out.below.end() ? -1 : int(at - out.below.begin());
  };
  int const n_of_sides = n_sides(mesh, element);
  for (int s = 0; s < n_of_sides; ++s) {
    if (s == side) continue;
    auto const face = side_nodes(mesh, element, s, room);
    for (std::size_t k = 0; k < face.size(); ++k) {
      Index32 const a = face[k], b = face[(k + 1) % face.size()];
      int const at_a = place(a), at_b = place(b);
      if ((at_a < 0) == (at_b < 0)) continue;
      Index32& above = out.above[at_a >= 0 ? at_a : at_b];
      Index32 const end = at_a >= 0 ? b : a;
      if (above >= 0 && above != end) return;  // two edges leave
      above = end;
    }
  }
  for (std::size_t c = 0; c < n; ++c)
    if (out.above[c] < 0 || std::count(out.above.begin(), out.above.end(), out.above[c]) != 1) return;
  for (int s = 0; s < n_of_sides && out.side < 0; ++s) {
    auto const face = side_nodes(mesh, element, s, room);
    if (face.size() == n && std::all_of(face.begin(), face.end(), [&](Index32 m) {
          return std::find(out.above.begin(), out.above.end(), m) != out.above.end();
        }))
      out.side = s;
  }
}

}  // namespace

void find_opposite_side(Mesh const& mesh, Index element, int side, OppositeSide& out) {
  out.side = -1;
  out.below.clear();
  out.above.clear();
  ElementType const type = mesh.elements.type[element];
  if (type == ElementType::polyhedron) return find_of_polyhedron(mesh, element, side, out);
  OfType const& found = of_type(type, side);
  if (found.side < 0) return;
  auto const nodes = mesh.elements.corners(element);
  for (std::size_t c = 0; c < std::size_t(found.n); ++c) {
    out.below.push_back(nodes[found.below[c]]);
    out.above.push_back(nodes[found.above[c]]);
  }
  out.side = found.side;
}

}  // namespace gridmorph
