#include <generators/hybrid_mesh.hpp>

#include <gridmorph/kernels/element_shape.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <span>

namespace gridmorph::demo {

namespace {

double volume(std::span<Vec3 const> x, std::array<Index32, 4> const& t) {
  Vec3 const a = x[t[0]];
  return dot(cross(x[t[1]] - a, x[t[2]] - a), x[t[3]] - a);
}

/// A uniform number in [-1, 1) that belongs to one component of one node.
double noise(Index32 node, int component) {
  std::uint32_t const bits = scatter(scatter(std::uint32_t(node)) + std::uint32_t(component) * 0x9e3779b9U);
  return double(bits) / double(1U << 31U) - 1;
}

/// 0 ... n - 1 in random order. std::shuffle is not the same everywhere; this is.
std::vector<Index32> random_order(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Index32> order(n);
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = n; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return order;
}

template <class List>
void reorder(List& list, std::uint64_t seed) {
  auto const order = random_order(list.size(), seed);
  List moved(list.size());
  for (std::size_t e = 0; e < list.size(); ++e) moved[e] = list[order[e]];
  list = std::move(moved);
}

}  // namespace

bool HybridMesh::cut_02(Index32 a, Index32 b, Index32 c, Index32 d) const {
  auto const rank = [&](Index32 n) { return rank_[n]; };
  return std::min(rank(a), rank(c)) < std::min(rank(b), rank(d));
}

std::array<std::array<Index32, 3>, 2> HybridMesh::triangles(Quad const& q) const {
  if (cut_02(q[0], q[1], q[2], q[3])) return {{{q[0], q[1], q[2]}, {q[0], q[2], q[3]}}};
  return {{{q[1], q[2], q[3]}, {q[1], q[3], q[0]}}};
}

void HybridMesh::add_prisms(Hex const& h) {
  if (cut_02(h[0], h[1], h[2], h[3])) {
    prisms_.push_back({h[0], h[1], h[2], h[4], h[5], h[6]});
    prisms_.push_back({h[0], h[2], h[3], h[4], h[6], h[7]});
  } else {
    prisms_.push_back({h[1], h[2], h[3], h[5], h[6], h[7]});
    prisms_.push_back({h[1], h[3], h[0], h[5], h[7], h[4]});
  }
}

void HybridMesh::add_tetrahedra(Hex const& h) {
  Index32 const first =
      *std::min_element(h.begin(), h.end(), [&](Index32 a, Index32 b) { return rank_[a] < rank_[b]; });
  for (int f = 0; f < n_faces(ElementType::hexahedron); ++f) {
    Quad q;
    for (int c = 0; c < 4; ++c) q[c] = h[face_corner(ElementType::hexahedron, f, c)];
    if (std::find(q.begin(), q.end(), first) != q.end()) continue;
    // Seen from the corner inside, the outward faces turn the other way round.
    for (auto const& t : triangles(q)) tetrahedra_.push_back({t[0], t[2], t[1], first});
  }
}

void HybridMesh::add_pyramid(Hex const& h) {
  Vec3 middle;
  for (Index32 const n : h) middle += 0.125 * nodes_[n];
  auto const apex = Index32(nodes_.size());
  nodes_.push_back(middle);
  rank_.push_back(rank_of(apex));
  pyramids_.push_back({h[0], h[1], h[2], h[3], apex});
  for (int f = 1; f < n_faces(ElementType::hexahedron); ++f) {
    Quad q;
    for (int c = 0; c < 4; ++c) q[c] = h[face_corner(ElementType::hexahedron, f, c)];
    for (auto const& t : triangles(q)) tetrahedra_.push_back({t[0], t[2], t[1], apex});
  }
}

int HybridMesh::add_patch(std::string const& name, PatchKind kind, std::string const& bc_type) {
  Patch patch;
  patch.name = name;
  patch.families = {name};
  patch.kind = kind;
  patch.bc_type = bc_type;
  patch.zone = 0;
  patches_.push_back(std::move(patch));
  faces_.emplace_back();
  return int(patches_.size()) - 1;
}

void HybridMesh::add_triangles(int patch, Quad const& quad) {
  for (auto const& t : triangles(quad)) faces_[patch].push_back({t[0], t[1], t[2], -1});
}

std::vector<std::uint8_t> HybridMesh::free_nodes() const {
  std::vector<std::uint8_t> free(nodes_.size(), 1);
  auto const hold = [&](auto const& lists) {
    for (auto const& list : lists)
      for (Index32 const n : list)
        if (n >= 0) free[n] = 0;
  };
  hold(pyramids_);
  hold(prisms_);
  hold(hexahedra_);
  for (auto const& faces : faces_) hold(faces);
  return free;
}

void HybridMesh::jitter(double amount) {
  constexpr double kept_volume = 0.6;
  constexpr int halvings = 2;  // of the reach of a node; after that it stays, so that the loop ends
  auto const free = free_nodes();
  std::vector<float> reach(nodes_.size(), std::numeric_limits<float>::max());
  for (auto const& t : tetrahedra_)
    for (int e = 0; e < 6; ++e) {
      auto const a = std::size_t(t[edge_corner(ElementType::tetrahedron, e, 0)]);
      auto const b = std::size_t(t[edge_corner(ElementType::tetrahedron, e, 1)]);
      auto const length = float(distance(nodes_[a], nodes_[b]));
      reach[a] = std::min(reach[a], length);
      reach[b] = std::min(reach[b], length);
    }
  std::vector<Vec3> moved(nodes_.size());
  for (int attempt = 0, good = 0; good == 0; ++attempt) {
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      double const r = free[n] != 0 ? amount * double(reach[n]) : 0;
      moved[n] =
          r == 0 ? nodes_[n] : nodes_[n] + r * Vec3{noise(Index32(n), 0), noise(Index32(n), 1), noise(Index32(n), 2)};
    }
    good = 1;
    for (auto const& t : tetrahedra_) {
      double const before = volume(nodes_, t);
      if (volume(moved, t) >= std::min(kept_volume * before, before)) continue;
      good = 0;
      for (Index32 const n : t) reach[n] *= attempt < halvings ? 0.5F : 0.F;
    }
  }
  nodes_ = std::move(moved);
}

void HybridMesh::shuffle() {
  auto const number = random_order(nodes_.size(), 1);
  std::vector<Vec3> moved(nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) moved[number[n]] = nodes_[n];
  nodes_ = std::move(moved);
  auto const renumber = [&](auto& lists) {
    for (auto& list : lists)
      for (Index32& n : list)
        if (n >= 0) n = number[n];
  };
  renumber(tetrahedra_);
  renumber(pyramids_);
  renumber(prisms_);
  renumber(hexahedra_);
  for (auto& faces : faces_) renumber(faces);
  reorder(tetrahedra_, 2);
  reorder(pyramids_, 3);
  reorder(prisms_, 4);
  reorder(hexahedra_, 5);
  for (auto& faces : faces_) reorder(faces, 6);
}

Mesh HybridMesh::finish(std::string const& zone, std::string const& source) {
  Mesh mesh;
  mesh.source = source;
  mesh.add_zone(zone, Index(nodes_.size()));
  mesh.coordinates = Coordinates(Index(nodes_.size()));
  for (std::size_t n = 0; n < nodes_.size(); ++n) mesh.coordinates.set(Index(n), nodes_[n]);
  nodes_ = {};
  std::size_t const n_elements = tetrahedra_.size() + pyramids_.size() + prisms_.size() + hexahedra_.size();
  mesh.elements.type.reserve(n_elements);
  mesh.elements.nodes.first.reserve(n_elements + 1);
  mesh.elements.nodes.item.reserve(4 * tetrahedra_.size() + 5 * pyramids_.size() + 6 * prisms_.size() +
                                   8 * hexahedra_.size());
  auto const append = [&](ElementType type, auto& lists) {
    for (auto const& list : lists) mesh.add_element(type, list);
    lists = {};
  };
  append(ElementType::tetrahedron, tetrahedra_);
  append(ElementType::pyramid, pyramids_);
  append(ElementType::prism, prisms_);
  append(ElementType::hexahedron, hexahedra_);
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    for (auto const& face : faces_[p]) patches_[p].faces.add(std::span<Index32 const>(face).first(face[3] < 0 ? 3 : 4));
    mesh.families.push_back(patches_[p].name);
  }
  mesh.patches = std::move(patches_);
  *this = HybridMesh({}, {});
  return mesh;
}

}  // namespace gridmorph::demo
