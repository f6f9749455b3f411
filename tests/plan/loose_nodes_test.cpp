// Nodes of two zones at one place that nothing joins are told of, and no others.
#include <gridmorph/morph/morph.hpp>

#include "support/mesh_builders.hpp"
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace gridmorph::test {
namespace {

/// Two boxes in single precision on one floor, the cells on which are thinner than what tells two nodes apart.
Mesh side_by_side(bool joined) {
  MeshBuilder boxes("side_by_side");
  for (int z = 0; z < 2; ++z)
    boxes.zone(z == 0 ? "left" : "right", {3, 4, 5}, [z](Index3 const& i) {
      return Vec3{z + 0.5 * i[0], double(i[1]), i[2] == 0 ? 0.0 : double(1e-7F) + 0.5 * (i[2] - 1)};
    });
  for (int z = 0; z < 2; ++z)
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side)
        if (bool const between = axis == 0 && side != z; !between || !joined)
          boxes.patch(axis == 2  ? (side == 0 ? "floor" : "top")
                      : !between ? "sides"
                      : z == 0   ? "of_left"
                                 : "of_right",
                      PatchKind::wall, z, axis, side);
  if (joined) boxes.join(0, face_of({{0, 0, 0}, {3, 4, 5}}, 0, 1), 1, face_of({{0, 0, 0}, {3, 4, 5}}, 0, 0));
  Mesh mesh = boxes.finish();
  for (Zone& zone : mesh.zones) zone.single_precision = true;
  return mesh;
}

std::size_t notes_of_loose_nodes(bool joined) {
  std::vector<MotionRule> rules{rule({"floor"}, function_rule([](Vec3 const& p) {
                                       return Vec3{0, 0, 0.05 * p.x};
                                     })),
                                rule({"top"}, FixedRule{}), rule({"sides"}, FreeRule{})};
  if (!joined) rules.insert(rules.end(), {rule({"of_left"}, FreeRule{}), rule({"of_right"}, FreeRule{})});
  auto const notes = MorphPlan(side_by_side(joined), motion(rules)).notes();
  return std::size_t(std::count_if(notes.begin(), notes.end(), [](std::string const& note) {
    return note.find("coincide where no interface joins them") != std::string::npos;
  }));
}

TEST(LooseNodes, AreThoseThatNoInterfaceJoins) {
  EXPECT_EQ(notes_of_loose_nodes(false), 1U);
  EXPECT_EQ(notes_of_loose_nodes(true), 0U);
}

}  // namespace
}  // namespace gridmorph::test
