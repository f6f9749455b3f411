#include <gridmorph/plan/elements/one_rings.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace gridmorph::detail {

namespace {

/// Which side of surfaces inside the mesh is left out: neighbours have the same one, whatever the numbers of their
/// faces. 1 for its faces.
std::vector<std::uint8_t> backs_of_inner_faces(Mesh const& mesh, UnstructuredTopology const& topology,
                                               std::vector<Index32> const& faces) {
  auto const& behind = topology.boundary.behind;
  std::vector<std::uint8_t> back(topology.boundary.size(), 0);
  // Faces on one side run along their common edge in opposite senses; in the plane one ends where the other begins.
  using Key = std::array<Index32, 2>;
  auto const keys = [&](Index32 f, bool of_neighbour) {
    auto const face = topology.boundary.nodes[f];
    std::vector<Key> out;
    for (std::size_t k = 0; k < face.size(); ++k) {
      Index32 const a = face[k], b = face[(k + 1) % face.size()];
      out.push_back(mesh.dimension == 2 ? Key{a, Index32(of_neighbour ? 1 - k : k)}
                    : of_neighbour      ? Key{b, a}
                                        : Key{a, b});
    }
    return out;
  };
  std::map<Key, std::vector<Index32>> faces_with;
  for (Index32 const f : faces)
    if (behind[f] >= 0)
      for (Key const& key : keys(f, false)) faces_with[key].push_back(f);
  std::vector<std::uint8_t> decided(back.size(), 0);
  for (Index32 const start : faces) {
    if (behind[start] < 0 || decided[start] != 0) continue;
    std::vector<Index32> front{start};
    auto const decide = [&](Index32 f) {
      Index32 const other = behind[f];
      decided[f] = decided[other] = back[other] = 1;
    };
    decide(start);
    while (!front.empty()) {
      Index32 const f = front.back();
      front.pop_back();
      for (Key const& key : keys(f, true))
        for (Index32 const next : faces_with[key]) {
          if (decided[next] != 0) continue;
          decide(next);
          front.push_back(next);
        }
    }
  }
  return back;
}

/// The faces without the backs of surfaces inside the mesh, and without those that have the nodes of another in a zone
/// before theirs: the other side of a wall between zones, whose normal is the opposite. Were it left to places, which
/// are the same, normals of either zone would cancel around a node.
std::vector<Index32> one_sided(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                               std::vector<Index32> const& all_faces) {
  std::vector<Index32> faces = all_faces;
  if (!topology.boundary.behind.empty()) {
    auto const back = backs_of_inner_faces(mesh, topology, faces);
    std::erase_if(faces, [&](Index32 f) { return back[f] != 0; });
  }
  auto const owner = [&](Index32 n) { return graph.representative[n]; };
  bool const joined = std::any_of(faces.begin(), faces.end(), [&](Index32 f) {
    auto const face = topology.boundary.nodes[f];
    return std::any_of(face.begin(), face.end(), [&](Index32 n) { return owner(n) != n; });
  });
  if (!joined) return faces;
  auto const zone_of = [&](Index32 f) {
    Index const e = topology.boundary.element[f];
    auto const next = std::upper_bound(mesh.zones.begin(), mesh.zones.end(), e,
                                       [](Index a, Zone const& zone) { return a < zone.first_element; });
    return next - mesh.zones.begin();
  };
  std::map<std::vector<Index32>, Index32> kept;  // by their nodes
  for (Index32 const f : faces) {
    std::vector<Index32> owners;
    for (Index32 const n : topology.boundary.nodes[f]) owners.push_back(owner(n));
    std::sort(owners.begin(), owners.end());
    auto const [at, fresh] = kept.try_emplace(std::move(owners), f);
    if (!fresh && zone_of(f) < zone_of(at->second)) at->second = f;
  }
  std::set<Index32> remain;
  for (auto const& [owners, f] : kept) remain.insert(f);
  std::vector<Index32> out;
  std::copy_if(faces.begin(), faces.end(), std::back_inserter(out), [&](Index32 f) { return remain.contains(f); });
  return out;
}

/// Calls visit(node, a, b) for every corner of every face.
template <class Visit>
void for_each_corner(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                     std::vector<Index32> const& faces, Visit&& visit) {
  auto const owner = [&](Index32 n) { return graph.representative[n]; };
  for (Index32 const f : faces) {
    auto const face = topology.boundary.nodes[f];
    std::size_t const n = face.size();
    if (mesh.dimension == 2) {
      for (Index32 const end : face) visit(owner(end), owner(face[0]), owner(face[1]));
    } else {
      for (std::size_t k = 0; k < n; ++k) visit(owner(face[k]), owner(face[(k + 1) % n]), owner(face[(k + n - 1) % n]));
    }
  }
}

}  // namespace

CsrGraph wall_one_rings(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                        std::vector<Index32> const& all_faces, std::vector<Index32> const& roots) {
  std::vector<Index32> const faces = one_sided(mesh, topology, graph, all_faces);
  std::vector<Index32> place(mesh.n_nodes(), -1);
  for (std::size_t r = 0; r < roots.size(); ++r) place[roots[r]] = Index32(r);
  CsrGraph one_rings;
  one_rings.first.assign(roots.size() + 1, 0);
  for_each_corner(mesh, topology, graph, faces, [&](Index32 n, Index32, Index32) {
    if (Index32 const r = place[n]; r >= 0) one_rings.first[r + 1] += 2;
  });
  for (std::size_t r = 0; r < roots.size(); ++r) one_rings.first[r + 1] += one_rings.first[r];
  one_rings.item.resize(one_rings.first.back());
  std::vector<Index> next(one_rings.first.begin(), one_rings.first.end() - 1);
  for_each_corner(mesh, topology, graph, faces, [&](Index32 n, Index32 a, Index32 b) {
    if (Index32 const r = place[n]; r >= 0) {
      one_rings.item[next[r]++] = a;
      one_rings.item[next[r]++] = b;
    }
  });
  return one_rings;
}

std::vector<Vec3> wall_normals(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                               std::vector<Index32> const& all_faces) {
  std::vector<Index32> const faces = one_sided(mesh, topology, graph, all_faces);
  std::vector<Vec3> normal(mesh.n_nodes());
  Vec3 const across = plane_normal(mesh);
  for_each_corner(mesh, topology, graph, faces, [&](Index32 n, Index32 a, Index32 b) {
    Vec3 const x = mesh.coordinates[n], p = mesh.coordinates[a], q = mesh.coordinates[b];
    normal[n] += mesh.dimension == 2 ? cross(q - p, across) : cross(p - x, q - x);
  });
  return normal;
}

}  // namespace gridmorph::detail
