// Slip on the baseline surface of real meshes, compared with the plane or surface of revolution that it is.
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/shared_mesh.hpp"

#include <gridmorph/io/mesh_io.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace gridmorph::test {
namespace {

using kernels::FacetFoot;

SlipRule on(SlipRule::Surface surface) { return {.surface = surface}; }

/// What nodes on slip patches do in two runs of the same mesh: largest difference of their displacements, and largest
/// distance from the surfaces of the one and of the other; for the latter those that have left the baseline surface
/// over a rim count apart.
struct Comparison {
  double apart = 0, off_own = 0, off_reference = 0, off_reference_beyond = 0, moved = 0;
};

Comparison compare(Outcome const& own, Outcome const& reference) {
  Comparison c;
  for (int p = 0; p < int(own.mesh.patches.size()); ++p) {
    auto const surface = own.prepared.surface.slip_surface(p),
               true_surface = reference.prepared.surface.slip_surface(p);
    if (!surface || !true_surface) continue;
    Patch const& patch = own.mesh.patches[p];
    IndexRange const& r = patch.range;
    for (int k = r.begin[2]; k < r.end[2]; ++k)
      for (int j = r.begin[1]; j < r.end[1]; ++j)
        for (int i = r.begin[0]; i < r.end[0]; ++i) {
          Index const n = own.mesh.zones[patch.zone].node({i, j, k});
          Vec3 const x = own.morphed.position[n];
          bool const beyond = surface->kind == SlipSurface::Kind::facets &&
                              surface->facets.closest_point(x).place == FacetFoot::Place::rim;
          if (!beyond) c.apart = std::max(c.apart, distance(x, reference.morphed.position[n]));
          c.off_own = std::max(c.off_own, distance(surface->view().project(x), x));
          double& off = beyond ? c.off_reference_beyond : c.off_reference;
          off = std::max(off, distance(true_surface->view().project(x), x));
          c.moved = std::max(c.moved, norm(own.u(n)));
        }
  }
  return c;
}

TEST(BaselineSlipOnRealMeshes, EndWallsOfATurbineStageAsFacetsAreSurfacesOfRevolution) {
  std::string const file = shared_mesh("axial_turbine_stage_H.cgns");
  auto const run = [&](SlipRule::Surface surface, double factor) {
    FunctionRule const turn = function_rule([=](Vec3 const& p) {
      double const angle = factor * (1 + std::sin(20 * p.x));
      return factor == 0 ? Vec3{} : rotation_about({}, {1, 0, 0}, angle)(p) - p;
    });
    Motion m = motion({rule({"BLADE1", "BLADE2"}, turn), rule({"INLET", "OUTLET", "MIXING"}, FixedRule{}),
                       rule({"HUB", "SHROUD"}, on(surface))});
    m.axis.direction = {1, 0, 0};
    return morph(read_mesh(file), m);
  };
  Outcome const own = run(SlipRule::Surface::baseline, 0.02), revolution = run(SlipRule::Surface::revolution, 0.02);
  Comparison const c = compare(own, revolution);
  EXPECT_GT(c.moved, 0.01);
  EXPECT_LE(c.off_own, 1e-10 * own.plan().mesh_size);
  EXPECT_LE(c.off_reference, 2e-6);  // of radii near 1, cells of 0.01 to 0.03
  EXPECT_LE(c.apart, 2e-6);
  // The feet of the blades are holes of the baseline end walls; a node that moves d into one is on the tangent plane of
  // the hole's rim, d^2 / 2 r off.
  EXPECT_LE(c.off_reference_beyond, 0.02 * 0.02 / 2);

  Outcome const still = run(SlipRule::Surface::baseline, 0);
  EXPECT_EQ(different_bits(still.morphed.position, still.mesh.coordinates), 0);
}

class WingOnItsSymmetryPlane : public ::testing::TestWithParam<char const*> {};

TEST_P(WingOnItsSymmetryPlane, FacetsAreThePlane) {
  std::string const file = shared_mesh(GetParam());
  Mesh const mesh = read_mesh(file);
  BoundaryMotion const planes(mesh, resolve(mesh, motion({rule({"type:symmetry"}, SlipRule{})})));
  Vec3 normal;
  for (int p = 0; p < int(mesh.patches.size()); ++p)
    if (auto const s = planes.slip_surface(p)) normal = s->direction;
  Vec3 const up = std::abs(normal.y) > 0.5 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
  Vec3 const back{1, 0, 0};
  auto const run = [&](SlipRule::Surface surface) {
    // Bends up, and slides back at the root, which takes the nodes of the plane with it.
    FunctionRule const bend = function_rule([=](Vec3 const& p) {
      double const s = dot(p, normal);
      return 0.002 * s * s * up + 0.01 * std::exp(-s * s) * back;
    });
    return morph(mesh, motion({rule({"type:wall"}, bend), rule({"type:symmetry"}, on(surface))}));
  };
  Outcome const own = run(SlipRule::Surface::baseline), plane = run(SlipRule::Surface::plane);
  Comparison const c = compare(own, plane);
  EXPECT_GT(c.moved, 1e-3);
  EXPECT_LE(c.off_own, 1e-10 * own.plan().mesh_size);
  EXPECT_LE(c.off_reference, 1e-10 * own.plan().mesh_size);
  EXPECT_LE(c.apart, 1e-9 * own.plan().mesh_size);
}

INSTANTIATE_TEST_SUITE_P(Wings, WingOnItsSymmetryPlane,
                         ::testing::Values("mdo_tutorial_000_vol.cgns", "717_wl_L2.cgns"),
                         [](auto const& info) { return "number_" + std::to_string(info.index); });

}  // namespace
}  // namespace gridmorph::test
