// A background mesh of the user's own, in place of one around a wrap.
#include "support/made_bodies.hpp"
#include "support/unstructured_case.hpp"

#include <gridmorph/core/error.hpp>

#include <gtest/gtest.h>

#include <memory>

namespace gridmorph::test {
namespace {

class OwnBackground : public testing::Test {
 protected:
  static bool in_body(Vec3 const& x) { return x.x > 5 && x.x < 9 && x.y > 5 && x.y < 9 && x.z > 5 && x.z < 9; }
  UnstructuredCase c{box_around({14, 14, 14}, in_body, true)};
  Motion motion = motion_of({rule_for({"body"}, rotation({7, 7, 7}, {1, 2, 3}, 0.3, {1, 0, 0}))});
  UnstructuredMorphed automatic = c.morph(motion, by_lattice());

  /// The background mesh made for this case, as any other structured mesh, deformed by `to`.
  template <class Map>
  PlanOptions with_mesh(Map const& to) const {
    Mesh mesh = automatic.prepared.plan.background->mesh;
    Coordinates moved(mesh.n_nodes());
    for (Index n = 0; n < moved.size(); ++n) moved.set(n, to(mesh.coordinates[n]));
    mesh.coordinates = moved;
    PlanOptions options;
    options.elements.background =
        std::make_shared<Background const>(make_background(std::move(mesh), {"wrap"}, {"outer"}));
    return options;
  }
};

TEST_F(OwnBackground, ThatIsTheAutomaticOneGivesTheSameMesh) {
  auto const own = c.morph(motion, with_mesh([](Vec3 const& x) { return x; }));
  EXPECT_EQ(c.largest_miss(own), 0);
  // Cells are searched for points in another way, and weights are kept in single precision.
  for (Index n = 0; n < c.mesh.n_nodes(); ++n) EXPECT_LT(distance(own.x[n], automatic.x[n]), 1e-5) << n;
}

TEST_F(OwnBackground, MayBeBentAndKeepsBoundaries) {
  // Blocks that are no boxes: only their outer box stays as it was.
  auto const bend = [](Vec3 const& x) {
    double const bump = x.x * (14 - x.x) * x.y * (14 - x.y) * x.z * (14 - x.z) / std::pow(7.0, 6);
    return x + 0.3 * std::max(0.0, bump) * Vec3{1, -1, 0.5};
  };
  auto const own = c.morph(motion, with_mesh(bend));
  EXPECT_EQ(c.largest_miss(own), 0);
  EXPECT_EQ(c.inverted(own.x), 0);
  EXPECT_EQ(own.prepared.report.wrap_outside, 0);
}

TEST_F(OwnBackground, MustLeaveAHoleForTheMovingWalls) {
  try {
    (void)c.morph(motion, with_mesh([](Vec3 const& x) { return x + Vec3{2, 0, 0}; }));
    FAIL() << "accepted";
  } catch (MeshError const& e) {
    std::string const message = e.what();
    for (auto const* part : {"does not go around the moving walls", "node", "hole"})
      EXPECT_NE(message.find(part), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace gridmorph::test
