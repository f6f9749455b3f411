#include <gridmorph/mesh/coincident_pairs.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace gridmorph {

namespace {

bool has_middle_nodes(Mesh const& mesh) {
  for (Index e = 0; e < mesh.n_elements(); ++e)
    if (mesh.elements.type[e] != ElementType::polyhedron &&
        mesh.elements.nodes[e].size() > mesh.elements.corners(e).size())
      return true;
  return false;
}

/// The middles of a boundary face by the corners that they lie amid, ascending.
std::map<std::vector<Index32>, Index32> middle_nodes_by_corners(Mesh const& mesh, BoundaryFaces const& faces,
                                                                Index face) {
  std::map<std::vector<Index32>, Index32> out;
  for (MiddleNode const& m : side_middle_nodes(mesh, faces.element[face], faces.side[face]))
    out.emplace(m.amid, m.node);
  return out;
}

class Pairing {
 public:
  Pairing(Mesh& mesh, double tolerance)
      : mesh_(mesh),
        tolerance_(tolerance),
        faces_(make_topology(mesh).boundary),
        donor_(std::size_t(mesh.n_nodes()), -1) {}

  Index add_to(std::size_t number) {
    Connection& c = mesh_.connections[number];
    std::size_t const before = c.nodes.size();
    for (std::size_t n = 0; n < before; ++n) donor_[c.nodes[n]] = c.donor_nodes[n];
    for (Index f = 0; f < faces_.size(); ++f)
      if (faces_.connection[f] == Index32(2 * number)) add(c, f);
    for (Index32 const n : c.nodes) donor_[n] = -1;
    return Index(c.nodes.size() - before);
  }

 private:
  void add(Connection& c, Index face) {
    auto const there = middle_nodes_by_corners(mesh_, faces_, faces_.across[face]);
    for (auto const& [corners, node] : middle_nodes_by_corners(mesh_, faces_, face)) {
      if (donor_[node] >= 0) continue;
      std::vector<Index32> image;
      for (Index32 const n : corners) image.push_back(donor_[n]);
      std::sort(image.begin(), image.end());
      auto const found = there.find(image);
      if (found == there.end() || !coincide(c, node, found->second)) continue;
      donor_[node] = found->second;
      c.nodes.push_back(node);
      c.donor_nodes.push_back(found->second);
    }
  }

  [[nodiscard]] bool coincide(Connection const& c, Index32 own, Index32 donor) const {
    Vec3 const p = mesh_.coordinates[own];
    return distance(c.periodic ? c.periodic->declared(p) : p, mesh_.coordinates[donor]) <= tolerance_;
  }

  Mesh& mesh_;
  double tolerance_;
  BoundaryFaces faces_;
  std::vector<Index32> donor_;  ///< of the connection at hand
};

}  // namespace

Index pair_middle_nodes(Mesh& mesh, double tolerance) {
  if (mesh.connections.empty() || !has_middle_nodes(mesh)) return 0;
  Pairing pairing(mesh, tolerance);
  Index added = 0;
  for (std::size_t c = 0; c < mesh.connections.size(); ++c) added += pairing.add_to(c);
  return added;
}

}  // namespace gridmorph
