// Blades with a fillet in motions: the arc goes with the blade, and the end wall's own nodes stay on the end wall.
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/unstructured_case.hpp"
#include "wedge.hpp"

#include <generators/passage.hpp>
#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/fillet/fillet.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/quality/quality.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace gridmorph {
namespace {

constexpr double ball_radius = 0.004, hub_radius = 0.44, case_radius = 0.66;

Mesh filled_passage() {
  PassageOptions options;
  options.nodes = 120'000;  // with fewer too few faces lie across an arc to tell its radius
  options.hub = {hub_radius, hub_radius, 1, 0};
  options.casing = {case_radius, case_radius, 1, 0};
  Mesh mesh = make_passage(options);
  Links const links = connect_and_check(mesh, {});
  return make_fillet(mesh, links, test::between(mesh, {"blade"}, {"hub"}, ball_radius)).split.mesh;
}

/// In components about the machine's axis, x, so that no node leaves its radius.
struct BladeMotion {
  std::string name;
  std::function<void(double span, double x, double arc, double& axial, double& along)> move;
};

std::vector<BladeMotion> blade_motions() {
  auto const turn = [](double angle) {
    return [angle](double, double x, double arc, double& axial, double& along) {
      axial = (std::cos(angle) - 1) * x - std::sin(angle) * arc;
      along = std::sin(angle) * x + (std::cos(angle) - 1) * arc;
    };
  };
  return {{"Stagger", turn(0.035)},
          {"Lean", [](double span, double, double, double&, double& along) { along = 0.004 * (1 + span * span); }},
          {"Flutter",
           [](double span, double, double, double& axial, double& along) {
             axial = 0.002 * span * span;
             along = 0.006 * span * span;
           }},
          {"Untwist", [turn](double span, double x, double arc, double& axial, double& along) {
             turn(0.03 * span)(span, x, arc, axial, along);
           }}};
}

Motion plain(BladeMotion const& blade) {
  Motion m =
      test::motion({test::rule({"blade"}, test::function_rule([move = blade.move](Vec3 const& p) {
                                 double const r = std::hypot(p.y, p.z), angle = std::atan2(p.z, p.y);
                                 double axial = 0, along = 0;
                                 move((r - hub_radius) / (case_radius - hub_radius), p.x, r * angle, axial, along);
                                 double const now = angle + along / r;
                                 return Vec3{axial, r * std::cos(now) - p.y, r * std::sin(now) - p.z};
                               })),
                    test::rule({"inlet", "outlet"}, CircumferentialSlideRule{{"blade"}}),
                    test::rule({"type:periodic"}, FollowRule{{"blade"}}),
                    test::rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution})});
  m.axis = Axis{{0, 0, 0}, {1, 0, 0}};
  return m;
}

double circumradius(Vec3 const& a, Vec3 const& b, Vec3 const& c) {
  return distance(a, b) * distance(b, c) * distance(c, a) / (2 * norm(cross(b - a, c - a)));
}

/// Three nodes one after the other across the arc, by their places.
std::vector<std::array<Vec3, 3>> arcs_of(Mesh const& mesh) {
  std::vector<std::array<Vec3, 3>> out;
  for (Patch const& patch : mesh.patches) {
    if (patch.families.front() != "blade_fillet") continue;
    Zone const& zone = mesh.zones[patch.zone];
    // Fewer faces lie across the arc than along it.
    std::size_t most = 0;
    for (std::size_t a = 1; a < 3; ++a)
      if (patch.range.extent(int(a)) > patch.range.extent(int(most))) most = a;
    std::size_t const axis = patch.range.extent(int((most + 1) % 3)) > 1 ? (most + 1) % 3 : (most + 2) % 3;
    for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
      for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
        for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) {
          Index3 p{i, j, k}, q = p, r = p;
          q[axis] += 1;
          r[axis] += 2;
          if (r[axis] >= patch.range.end[axis]) continue;
          std::array<Vec3, 3> const at{mesh.coordinates[zone.node(p)], mesh.coordinates[zone.node(q)],
                                       mesh.coordinates[zone.node(r)]};
          if (std::abs(circumradius(at[0], at[1], at[2]) / ball_radius - 1) < 0.03) out.push_back(at);
        }
  }
  return out;
}

using Places = std::map<std::tuple<double, double, double>, Vec3>;
std::tuple<double, double, double> key(Vec3 const& p) { return {p.x, p.y, p.z}; }

/// Of the hub's own nodes after the motion, by where they were, and of the arcs' radii.
void expect_on_hub_and_round(std::vector<Vec3> const& hub_nodes, std::vector<std::array<Vec3, 3>> const& arcs,
                             Places const& after) {
  ASSERT_GT(hub_nodes.size(), 500U);
  ASSERT_GT(arcs.size(), 50U);
  double off = 0, change = 0;
  for (Vec3 const& p : hub_nodes) {
    Vec3 const& q = after.at(key(p));
    off = std::max(off, std::abs(std::hypot(q.y, q.z) - hub_radius));
  }
  for (auto const& [a, b, c] : arcs)
    change = std::max(
        change,
        std::abs(circumradius(after.at(key(a)), after.at(key(b)), after.at(key(c))) / circumradius(a, b, c) - 1));
  EXPECT_LT(off, 1e-9);
  EXPECT_LT(change, 0.01);
}

class FilletedBlades : public ::testing::TestWithParam<BladeMotion> {
 protected:
  static void TearDownTestSuite() { filled = {}; }
  static Mesh const& mesh() {
    if (filled.n_nodes() == 0) filled = filled_passage();
    return filled;
  }
  static inline Mesh filled;
};
INSTANTIATE_TEST_SUITE_P(Motions, FilletedBlades, ::testing::ValuesIn(blade_motions()),
                         [](auto const& info) { return info.param.name; });

TEST_P(FilletedBlades, OfBlocksKeepArcsAndHubWithARuleForTheBladeAlone) {
  std::vector<Vec3> on_hub;
  PreparedMorph const prepared = prepare(HostInstance(), mesh(), plain(GetParam()), {});
  auto const morphed = test::run_plan(Kokkos::DefaultHostExecutionSpace(), prepared.mesh, prepared.plan(),
                                      prepared.boundary_displacement());
  Places after;
  for (Index n = 0; n < mesh().n_nodes(); ++n) after[key(mesh().coordinates[n])] = morphed.position[n];
  for (Patch const& patch : mesh().patches) {
    if (patch.families.front() != "hub") continue;
    Zone const& zone = mesh().zones[patch.zone];
    for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
      for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
        for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i)
          on_hub.push_back(mesh().coordinates[zone.node({i, j, k})]);
  }
  expect_on_hub_and_round(on_hub, arcs_of(mesh()), after);
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(morphed.position);
  input.baseline = views(prepared.mesh.coordinates);
  EXPECT_EQ(measure_quality(Kokkos::DefaultHostExecutionSpace(), prepared.mesh, input).far_field.inverted, 0);
}

TEST_P(FilletedBlades, OfHexahedraKeepArcsAndHubWithARuleForTheBladeAlone) {
  Mesh blocks = mesh();
  (void)connect_and_check(blocks, {});
  test::UnstructuredCase const one(as_hexahedra(blocks));
  auto const morphed = one.guarded_morph(plain(GetParam()));
  Places after;
  for (Index n = 0; n < one.mesh.n_nodes(); ++n) after[key(one.mesh.coordinates[n])] = morphed.x[n];
  std::vector<Vec3> on_hub;
  for (Patch const& patch : one.mesh.patches)
    if (patch.families.front() == "hub")
      for (Index32 const n : patch_nodes(patch)) on_hub.push_back(one.mesh.coordinates[n]);
  expect_on_hub_and_round(on_hub, arcs_of(blocks), after);
  EXPECT_EQ(one.inverted(morphed.x), 0);
  // Where the arc runs out on the hub, nodes above its edge have the arc's motion: nothing that slides goes along
  // there.
  UnstructuredPlan const& plan = morphed.prepared.plan;
  ASSERT_FALSE(plan.sliding.empty());
  for (Index32 const root : plan.sliding_root)
    EXPECT_FALSE(std::binary_search(plan.driving.begin(), plan.driving.end(), root));
}

}  // namespace
}  // namespace gridmorph
