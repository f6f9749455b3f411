#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/for_all.hpp>
#include <gridmorph/core/index_buckets.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <utility>

namespace gridmorph {

namespace {

/// Lists of the items that name a key, ascending, from the keys of each item; an item that names a key twice counts
/// once.
template <class KeysOf>
CsrGraph invert(HostInstance const& host, char const* label, Index n_keys, Index n_items, KeysOf const& keys_of) {
  detail::IndexBuckets<Index32> const buckets(host, label, n_items, n_keys, [&](Index i, auto const& put) {
    auto const keys = keys_of(i);
    for (auto key = keys.begin(); key != keys.end(); ++key)
      if (std::find(keys.begin(), key, *key) == key) put(*key, Index32(i));
  });
  CsrGraph out;
  out.first.resize(n_keys + 1, 0);
  out.item.resize(buckets.size());
  buckets.for_each_key([&](Index32 key, Index at, std::span<Index32 const> items) {
    out.first[key + 1] = at + Index(items.size());
    std::copy(items.begin(), items.end(), out.item.begin() + at);
  });
  return out;
}

bool contains(std::span<Index32 const> list, Index32 value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

/// Whether two short lists without repetitions hold the same numbers.
bool same_set(std::span<Index32 const> a, std::span<Index32 const> b) {
  return a.size() == b.size() && std::all_of(a.begin(), a.end(), [&](Index32 n) { return contains(b, n); });
}

/// The node that fewest elements share: the shortest list to search.
Index32 rarest(CsrGraph const& lists, std::span<Index32 const> nodes) {
  return *std::min_element(nodes.begin(), nodes.end(),
                           [&](Index32 a, Index32 b) { return lists[a].size() < lists[b].size(); });
}

/// A side of an element under the smallest of its nodes.
struct KeyedSide {
  /// The next larger nodes, ascending; -1 where there are fewer. Sides of polyhedra may have more: see `n_nodes`.
  std::array<Index32, max_face_corners - 1> nodes;
  Index32 element;
  Index32 side;
  Index32 n_nodes;

  [[nodiscard]] bool alike(KeyedSide const& other) const { return nodes == other.nodes && n_nodes == other.n_nodes; }
  [[nodiscard]] bool operator<(KeyedSide const& other) const {
    return std::tie(nodes, n_nodes, element, side) < std::tie(other.nodes, other.n_nodes, other.element, other.side);
  }
};

bool same_side(Mesh const& mesh, KeyedSide const& a, KeyedSide const& b) {
  if (a.n_nodes <= max_face_corners) return true;
  std::array<Index32, max_face_corners> room_a{}, room_b{};
  return same_set(side_nodes(mesh, a.element, a.side, room_a), side_nodes(mesh, b.element, b.side, room_b));
}

/// Sorts the corner nodes of a side, each once. Returns how many there are.
template <std::size_t n>
int sort_side(std::array<Index32, n> const& corners, std::array<Index32, max_face_corners>& sorted) {
  int count = 0;
  for (Index32 const corner : corners) {
    int at = count;
    while (at > 0 && sorted[at - 1] > corner) --at;
    if (at > 0 && sorted[at - 1] == corner) continue;
    for (int k = count; k > at; --k) sorted[k] = sorted[k - 1];
    sorted[at] = corner;
    ++count;
  }
  return count;
}

/// Calls put(side) for the sides of an element whose smallest node is this. Tables are looked up by the compiler: an
/// element comes once for each of its nodes.
template <ElementType type, class Put>
void for_each_side_of(Mesh const& mesh, Index32 e, Index32 smallest, Put const& put) {
  Index32 const* const node = mesh.elements.nodes.item.data() + mesh.elements.nodes.first[e];
  auto const side = [&]<int s>() {
    constexpr int n = n_face_corners(type, s);
    auto const corners = [&]<int... c>(std::integer_sequence<int, c...>) {
      return std::array<Index32, n>{node[face_corner(type, s, c)]...};
    }
    (std::make_integer_sequence<int, n>());
    Index32 least = corners[0];
    for (Index32 const corner : corners) least = std::min(least, corner);
    if (least != smallest) return;
    std::array<Index32, max_face_corners> sorted{-1, -1, -1, -1};
    if (int const count = sort_side(corners, sorted); count >= mesh.dimension)
      put(KeyedSide{{sorted[1], sorted[2], sorted[3]}, e, Index32(s), Index32(count)});
  };
  [&]<int... s>(std::integer_sequence<int, s...>) { (side.template operator()<s>(), ...); }
  (std::make_integer_sequence<int, n_faces(type)>());
}

template <class Put>
void for_each_side_of_polyhedron(Mesh const& mesh, Index32 e, Index32 smallest, Put const& put) {
  std::array<Index32, max_face_corners> room{}, sorted{};
  for (int s = 0; s < n_sides(mesh, e); ++s) {
    auto const nodes = side_nodes(mesh, e, s, room);
    if (int(nodes.size()) < mesh.dimension || *std::min_element(nodes.begin(), nodes.end()) != smallest) continue;
    sorted.fill(-1);
    std::partial_sort_copy(nodes.begin(), nodes.end(), sorted.begin(),
                           sorted.begin() + std::min<std::ptrdiff_t>(max_face_corners, std::ssize(nodes)));
    put(KeyedSide{{sorted[1], sorted[2], sorted[3]}, e, Index32(s), Index32(nodes.size())});
  }
}

template <class Put>
void for_each_side_from(Mesh const& mesh, Index32 e, Index32 smallest, Put const& put) {
  using enum ElementType;
  switch (mesh.elements.type[e]) {
    case triangle: return for_each_side_of<triangle>(mesh, e, smallest, put);
    case quadrilateral: return for_each_side_of<quadrilateral>(mesh, e, smallest, put);
    case tetrahedron: return for_each_side_of<tetrahedron>(mesh, e, smallest, put);
    case pyramid: return for_each_side_of<pyramid>(mesh, e, smallest, put);
    case prism: return for_each_side_of<prism>(mesh, e, smallest, put);
    case hexahedron: return for_each_side_of<hexahedron>(mesh, e, smallest, put);
    case polyhedron: return for_each_side_of_polyhedron(mesh, e, smallest, put);
  }
}

/// What is behind one of `alike`, sides that have the same smallest nodes and as many.
Index32 behind(Mesh const& mesh, KeyedSide const& own, std::span<KeyedSide const> alike) {
  Index32 found = ElementSides::boundary;
  for (KeyedSide const& other : alike) {
    if (other.element == own.element || other.element == found || !same_side(mesh, own, other)) continue;
    if (found >= 0) return ElementSides::crowded;
    found = other.element;
  }
  return found;
}

/// take(sides that are alike, in their order), by a search for the other one of a pair, which around most nodes is
/// quicker than a sort, for at most `most` sides.
template <std::size_t most, class Take>
void for_each_alike_of_few(std::span<KeyedSide const> sides, Take const& take) {
  std::array<std::uint64_t, most> key;
  for (std::size_t k = 0; k < sides.size(); ++k)
    key[k] = std::uint64_t(std::uint32_t(sides[k].nodes[0])) << 32 | std::uint32_t(sides[k].nodes[1]);
  std::array<bool, most> done{};
  std::array<KeyedSide, most> alike;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    if (done[k]) continue;
    std::size_t n = 0;
    alike[n++] = sides[k];
    for (std::size_t m = k + 1; m < sides.size(); ++m)
      if (key[m] == key[k] && sides[m].alike(sides[k])) {
        done[m] = true;
        alike[n++] = sides[m];
      }
    take({alike.data(), n});
  }
}

template <class Take>
void for_each_alike(std::span<KeyedSide> sides, Take const& take) {
  constexpr std::size_t few = 64;
  if (sides.size() <= few) return for_each_alike_of_few<few>(sides, take);
  std::sort(sides.begin(), sides.end());
  for (auto begin = sides.begin(); begin != sides.end();) {
    auto const end = std::find_if_not(begin, sides.end(), [&](KeyedSide const& s) { return s.alike(*begin); });
    take({begin, end});
    begin = end;
  }
}

BoundaryFaces boundary_faces(Mesh const& mesh, ElementSides const& sides) {
  BoundaryFaces out;
  std::array<Index32, max_face_corners> room{};
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    auto const neighbours = sides.of(e);
    for (std::size_t s = 0; s < neighbours.size(); ++s) {
      if (neighbours[s] != ElementSides::boundary) continue;
      out.nodes.add(side_nodes(mesh, e, int(s), room));
      out.element.push_back(Index32(e));
      out.side.push_back(Index32(s));
    }
  }
  out.across.assign(out.element.size(), -1);
  out.connection.assign(out.element.size(), -1);
  return out;
}

/// A side of an element inside the mesh, and the same one of its neighbour.
struct InnerSide {
  std::array<Index32, 2> element{-1, -1}, side{-1, -1};
};

/// Sides inside the mesh that walls list, each once; they become boundary. Files list other things inside meshes too,
/// such as where a periodic side comes again.
std::vector<InnerSide> open_inner_sides(Mesh const& mesh, UnstructuredTopology& topology) {
  std::vector<InnerSide> out;
  std::array<Index32, max_face_corners> room{};
  std::vector<Index32> nodes;
  for (Patch const& patch : mesh.patches)
    for (Index f = 0; f < patch.faces.size() && patch.kind == PatchKind::wall; ++f) {
      if (find_boundary_face(topology, patch.faces[f]) >= 0) continue;
      nodes.clear();
      for (Index32 const n : patch.faces[f])
        if (!contains(nodes, n)) nodes.push_back(n);
      if (int(nodes.size()) < mesh.dimension) continue;
      InnerSide inner;
      int found = 0;
      for (Index32 const e : topology.elements_of_nodes[rarest(topology.elements_of_nodes, nodes)])
        for (int s = 0; s < n_sides(mesh, e); ++s) {
          if (topology.sides.of(e)[s] < 0 || !same_set(side_nodes(mesh, e, s, room), nodes)) continue;
          if (found < 2) inner.element[found] = e, inner.side[found] = Index32(s);
          ++found;
        }
      if (found != 2) continue;  // no side, or one that was opened for another patch
      for (std::size_t k = 0; k < 2; ++k)
        topology.sides.neighbour[topology.sides.first[inner.element[k]] + inner.side[k]] = ElementSides::boundary;
      out.push_back(inner);
    }
  return out;
}

void pair_inner_faces(std::vector<InnerSide> const& inner, BoundaryFaces& boundary) {
  boundary.behind.assign(boundary.element.size(), -1);
  auto const face = [&](Index32 element, Index32 side) {
    auto f = std::lower_bound(boundary.element.begin(), boundary.element.end(), element) - boundary.element.begin();
    while (boundary.side[f] != side) ++f;
    return Index32(f);
  };
  for (InnerSide const& one : inner) {
    Index32 const a = face(one.element[0], one.side[0]), b = face(one.element[1], one.side[1]);
    boundary.behind[a] = b;
    boundary.behind[b] = a;
  }
}

/// Finds the faces behind connections: a face whose nodes are all paired, with a face of the donors there.
void cross_connections(Mesh const& mesh, UnstructuredTopology& topology) {
  std::vector<Index32> donor(mesh.n_nodes(), -1);
  for (std::size_t number = 0; number < mesh.connections.size(); ++number)
    for (int const way : {0, 1}) {
      auto const& c = mesh.connections[number];
      auto const& own = way == 0 ? c.nodes : c.donor_nodes;
      auto const& other = way == 0 ? c.donor_nodes : c.nodes;
      for (std::size_t n = 0; n < own.size(); ++n) donor[own[n]] = other[n];
      std::vector<Index32> image;
      for (Index32 const node : own)
        for (Index32 const face : topology.faces_of_nodes[node]) {
          auto& across = topology.boundary.across[face];
          if (across >= 0) continue;
          image.clear();
          for (Index32 const n : topology.boundary.nodes[face]) image.push_back(donor[n]);
          if (contains(image, -1)) continue;
          Index32 const there = find_boundary_face(topology, image);
          if (there < 0 || there == face) continue;
          across = there;
          topology.boundary.connection[face] = Index32(2 * number) + way;
        }
      for (Index32 const node : own) donor[node] = -1;
    }
}

}  // namespace

CsrGraph elements_of_nodes(HostInstance const& host, Mesh const& mesh) {
  return invert(host, "gridmorph::elements_of_nodes", mesh.n_nodes(), mesh.n_elements(),
                [&](Index e) { return mesh.elements.corners(e); });
}

ElementSides element_sides(HostInstance const& host, Mesh const& mesh, CsrGraph const& around) {
  ElementSides out;
  Index const n = mesh.n_elements();
  out.first.resize(n + 1, 0);
  for (Index e = 0; e < n; ++e) out.first[e + 1] = out.first[e] + n_sides(mesh, e);
  out.neighbour.resize(out.first.back(), ElementSides::collapsed);
  auto const take = [&](std::span<KeyedSide const> alike) {
    for (KeyedSide const& own : alike) out.neighbour[out.first[own.element] + own.side] = behind(mesh, own, alike);
  };
  constexpr Index of_part = 1024;
  Index const n_parts = (mesh.n_nodes() + of_part - 1) / of_part;
  detail::for_all_parts(host, "gridmorph::element_sides", n_parts, [&](Index part) {
    std::vector<KeyedSide> sides;
    for (Index node = part * of_part; node < std::min(mesh.n_nodes(), (part + 1) * of_part); ++node) {
      sides.clear();
      for (Index32 const e : around[node])
        for_each_side_from(mesh, e, Index32(node), [&](KeyedSide const& side) { sides.push_back(side); });
      for_each_alike(sides, take);
    }
  });
  return out;
}

UnstructuredTopology make_topology(HostInstance const& host, Mesh const& mesh) {
  UnstructuredTopology out;
  out.elements_of_nodes = elements_of_nodes(host, mesh);
  out.sides = element_sides(host, mesh, out.elements_of_nodes);
  out.crowded_sides = std::count(out.sides.neighbour.begin(), out.sides.neighbour.end(), ElementSides::crowded);
  auto const find_boundary = [&] {
    out.boundary = boundary_faces(mesh, out.sides);
    out.faces_of_nodes = invert(host, "gridmorph::faces_of_nodes", mesh.n_nodes(), out.boundary.size(),
                                [&](Index f) { return out.boundary.nodes[f]; });
  };
  find_boundary();
  if (auto const inner = open_inner_sides(mesh, out); !inner.empty()) {
    find_boundary();
    pair_inner_faces(inner, out.boundary);
  }
  cross_connections(mesh, out);
  return out;
}

Index32 find_boundary_face(UnstructuredTopology const& topology, std::span<Index32 const> named) {
  if (named.empty()) return -1;
  std::vector<Index32> nodes;
  for (Index32 const n : named)
    if (!contains(nodes, n)) nodes.push_back(n);
  for (Index32 const face : topology.faces_of_nodes[rarest(topology.faces_of_nodes, nodes)])
    if (same_set(topology.boundary.nodes[face], nodes)) return face;
  return -1;
}

std::vector<Index32> coincident_nodes(Mesh const& mesh) {
  DisjointSets<Index32> sets(std::size_t(mesh.n_nodes()));
  for (auto const& c : mesh.connections) {
    if (c.periodic) continue;
    for (std::size_t p = 0; p < c.nodes.size(); ++p) sets.join(c.nodes[p], c.donor_nodes[p]);
  }
  return sets.roots();
}

std::vector<std::uint8_t> periodic_nodes(BoundaryMesh const& mesh) {
  std::vector<std::uint8_t> paired(mesh.n_nodes(), 0);
  for (auto const& c : mesh.connections)
    if (c.periodic)
      for (auto const* list : {&c.nodes, &c.donor_nodes})
        for (Index32 const n : *list) paired[n] = 1;
  return paired;
}

std::vector<Index32> match_points(HostInstance const& host, Coordinates const& coordinates,
                                  std::span<Index32 const> points, std::span<Index32 const> donors, double tolerance,
                                  std::optional<Periodic> const& periodic) {
  // Along an oblique line few points of a mesh lie side by side, even where it is a lattice.
  constexpr Vec3 line{0.5318, 0.6173, 0.5797};
  struct Placed {
    double along;
    Index32 node;
  };
  std::vector<Placed> sorted;
  sorted.reserve(donors.size());
  for (Index32 const d : donors) sorted.push_back({dot(line, coordinates[d]), d});
  auto const before = [](Placed const& a, Placed const& b) {
    return a.along < b.along || (a.along == b.along && a.node < b.node);
  };
  std::sort(sorted.begin(), sorted.end(), before);
  std::vector<Index32> out(points.size(), -1);
  detail::for_all(host, "gridmorph::match_points", Index(points.size()), [&](Index p) {
    Vec3 x = coordinates[points[p]];
    if (periodic) x = periodic->declared(x);
    double const along = dot(line, x);
    double nearest = tolerance;
    Index32& best = out[p];
    for (auto at = std::lower_bound(sorted.begin(), sorted.end(), Placed{along - 1.01 * tolerance, -1}, before);
         at != sorted.end() && at->along <= along + 1.01 * tolerance; ++at) {
      double const d = distance(x, coordinates[at->node]);
      if (d < nearest || (d == nearest && (best < 0 || at->node < best))) {
        nearest = d;
        best = at->node;
      }
    }
  });
  return out;
}

double largest_mismatch(Mesh const& mesh, Connection const& c) {
  double worst = 0;
  for (std::size_t n = 0; n < c.nodes.size(); ++n) {
    Vec3 x = mesh.coordinates[c.nodes[n]];
    if (c.periodic) x = c.periodic->declared(x);
    worst = std::max(worst, distance(x, mesh.coordinates[c.donor_nodes[n]]));
  }
  return worst;
}

}  // namespace gridmorph
