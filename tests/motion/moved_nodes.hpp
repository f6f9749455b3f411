// What the rules of a motion do to the nodes of its patches.
#pragma once

#include <gridmorph/motion/boundary_motion.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace gridmorph::test {

inline std::shared_ptr<Boundary const> boundary_of(Mesh const& mesh) {
  if (mesh.elements.size() == 0) return std::make_shared<Boundary const>(mesh);
  UnstructuredTopology const topology = make_topology(mesh);
  return std::make_shared<Boundary const>(mesh, topology, find_face_patches(mesh, topology));
}

inline BoundaryMotion motion_on(Mesh const& mesh, Motion const& motion) {
  return BoundaryMotion(mesh, resolve(mesh, motion));
}

/// Nodes of the patches of that name, all of them faces k = 0 of blocks.
inline std::vector<Vec3> points_of(Mesh const& mesh, std::string const& name) {
  std::vector<Vec3> points;
  for (Patch const& p : mesh.patches)
    if (p.name == name)
      for (int j = 0; j < p.range.end[1]; ++j)
        for (int i = 0; i < p.range.end[0]; ++i) points.push_back(mesh.coordinates[mesh.zones[p.zone].node({i, j, 0})]);
  return points;
}

/// Displacements by a rule, in an array that held others.
inline std::vector<Vec3> evaluate(BoundaryMotion const& motion, int rule, std::vector<Vec3> const& points) {
  std::vector<Vec3> out(points.size(), {7, 7, 7});
  motion.displacement(rule, points, out);
  return out;
}

struct MovedNode {
  Index node;
  Vec3 at, u;
};

/// Displacements of the nodes of the patches that the first rule names.
inline std::vector<MovedNode> moved_nodes(Mesh const& mesh, Motion const& motion,
                                          std::vector<std::string>* notes = nullptr) {
  auto const boundary = boundary_of(mesh);
  ResolvedMotion const resolved = resolve(boundary->names(), motion);
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
