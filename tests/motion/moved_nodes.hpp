// What the first rule of a motion does to the nodes of its patches.
#pragma once

#include <gridmorph/motion/boundary_motion.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace gridmorph::test {

inline std::shared_ptr<Boundary const> boundary_of(Mesh const& mesh) {
  if (mesh.elements.size() == 0) return std::make_shared<Boundary const>(mesh);
  UnstructuredTopology const topology = make_topology(mesh);
  return std::make_shared<Boundary const>(mesh, topology, find_face_patches(mesh, topology));
}

struct MovedNode {
  Index node;
  Vec3 at, u;
};

/// Displacements of the nodes of the patches that the first rule names.
inline std::vector<MovedNode> moved_nodes(Mesh const& mesh, Motion const& motion,
                                          std::vector<std::string>* notes = nullptr) {
  auto const boundary = boundary_of(mesh);
  ResolvedMotion const resolved = resolve(boundary->mesh(), motion);
  BoundaryMotion const moves(boundary, resolved);
  EXPECT_TRUE(moves.is_explicit(0));
  if (notes != nullptr) *notes = moves.notes();
  std::vector<MovedNode> out;
  for (std::size_t p = 0; p < resolved.patch.size(); ++p) {
    if (resolved.patch[p].rule != 0) continue;
    std::vector<Vec3> const at = [&] {
      std::vector<Vec3> list;
      for (Index const n : boundary->surface(int(p)).nodes) list.push_back(mesh.coordinates[n]);
      return list;
    }();
    std::vector<Vec3> u(at.size());
    moves.displacement(0, at, u);
    for (std::size_t n = 0; n < at.size(); ++n) out.push_back({boundary->surface(int(p)).nodes[n], at[n], u[n]});
  }
  EXPECT_FALSE(out.empty());
  return out;
}

}  // namespace gridmorph::test
