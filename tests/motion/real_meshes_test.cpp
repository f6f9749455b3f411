// Blade rows of meshes from outside: their end walls, and whether follow, slide and blade agree where patches meet.
#include "support/shared_mesh.hpp"

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/motion/boundary_motion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace gridmorph {
namespace {

using kernels::ProfileKnot;

struct Row {
  char const* file;
  Axis axis;
  std::string blade;
  std::vector<std::string> ends;       ///< inlet and exit
  std::vector<std::string> periodics;  ///< interfaces
};

void PrintTo(Row const& row, std::ostream* out) { *out << row.file << ", " << row.blade; }

/// A turn about the axis that grows along it and outwards: axial position and radius of every node kept.
FunctionRule twist(Axis const& axis, double amount) {
  return {"twist", [axis, amount](std::span<Vec3 const> points, std::span<Vec3> out) {
            for (std::size_t n = 0; n < points.size(); ++n) {
              double const a = dot(points[n] - axis.origin, axis.direction);
              double const r = norm(points[n] - axis.origin - a * axis.direction);
              RigidTransform const turn = rotation_about(axis.origin, axis.direction, amount * (0.1 + a) * (0.5 + r));
              out[n] = amount == 0 ? Vec3{} : turn(points[n]) - points[n];
            }
          }};
}

class RealRow : public ::testing::TestWithParam<Row> {
 protected:
  void SetUp() override {
    std::string const path = test::shared_mesh(GetParam().file);
    if (path.empty()) GTEST_SKIP() << GetParam().file << " is not there; its stand-in is tested";
    mesh_ = read_mesh(path);
  }

  ResolvedMotion rules(double amount) const {
    Row const& row = GetParam();
    Motion motion;
    motion.axis = row.axis;
    motion.rules = {{{row.blade}, twist(row.axis, amount), 0, "blade"},
                    {row.ends, CircumferentialSlideRule{{row.blade}}, 0, "ends"},
                    {row.periodics, FollowRule{{row.blade}}, 0, "periodics"},
                    {{"HUB", "SHROUD"}, SlipRule{.surface = SlipRule::Surface::revolution}, 0, "walls"}};
    return resolve(mesh_, motion);
  }

  std::vector<Vec3> points(int zone, IndexRange const& r) const {
    std::vector<Vec3> out;
    for (int k = r.begin[2]; k < r.end[2]; ++k)
      for (int j = r.begin[1]; j < r.end[1]; ++j)
        for (int i = r.begin[0]; i < r.end[0]; ++i) out.push_back(mesh_.coordinates[mesh_.zones[zone].node({i, j, k})]);
    return out;
  }
  std::vector<Vec3> points_of_rule(ResolvedMotion const& motion, int rule) const {
    std::vector<Vec3> out;
    auto const append = [&](std::vector<Vec3> const& more) { out.insert(out.end(), more.begin(), more.end()); };
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p)
      if (motion.patch[p].rule == rule) append(points(mesh_.patches[p].zone, mesh_.patches[p].range));
    for (std::size_t i = 0; i < mesh_.interfaces.size(); ++i)
      if (motion.interface[i].rule == rule) append(points(mesh_.interfaces[i].zone, mesh_.interfaces[i].range));
    return out;
  }
  static std::vector<Vec3> evaluate(BoundaryMotion const& motion, int rule, std::vector<Vec3> const& at) {
    std::vector<Vec3> out(at.size());
    motion.displacement(rule, at, out);
    return out;
  }

  /// Largest disagreement of two rules at the points they share, and how many these are.
  std::pair<double, int> disagreement(BoundaryMotion const& surface, ResolvedMotion const& motion, int a, int b) const {
    auto pa = points_of_rule(motion, a), pb = points_of_rule(motion, b);
    auto const ua = evaluate(surface, a, pa), ub = evaluate(surface, b, pb);
    double const tolerance = 1e-9 * mesh_.size();
    double worst = 0;
    int shared = 0;
    for (std::size_t n = 0; n < pa.size(); ++n)
      for (std::size_t m = 0; m < pb.size(); ++m)
        if (distance(pa[n], pb[m]) < tolerance) {
          worst = std::max(worst, distance(ua[n], ub[m]));
          ++shared;
        }
    return {worst, shared};
  }

  Mesh mesh_;
};

enum RuleNumber { blade, ends, periodics, walls };

TEST_P(RealRow, RulesAgreeWhereTheirPatchesMeet) {
  ResolvedMotion const motion = rules(1);
  BoundaryMotion const surface(mesh_, motion);
  double largest = 0;
  for (Vec3 const& u : evaluate(surface, blade, points_of_rule(motion, blade))) largest = std::max(largest, norm(u));
  EXPECT_GT(largest, 0.005 * mesh_.size());
  auto const [at_blade, n_blade] = disagreement(surface, motion, blade, periodics);
  EXPECT_GT(n_blade, 10);
  EXPECT_LT(at_blade, 1e-12 * mesh_.size());
  auto const [at_ends, n_ends] = disagreement(surface, motion, ends, periodics);
  EXPECT_GT(n_ends, 10);
  EXPECT_LT(at_ends, 1e-12 * mesh_.size());
}

TEST_P(RealRow, EndWallsAreSurfacesOfRevolutionAndOneProfileEach) {
  ResolvedMotion const motion = rules(1);
  BoundaryMotion const surface(mesh_, motion);
  for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
    if (motion.patch[p].rule != walls) continue;
    auto const s = surface.slip_surface(int(p));
    ASSERT_TRUE(s);
    EXPECT_LT(s->baseline_deviation, 1e-5 * mesh_.size()) << describe_patch(mesh_, mesh_.patches[p]);
    for (ProfileKnot const& knot : s->profile.knots) EXPECT_LT(std::abs(knot.slope), 2);
  }
}

TEST_P(RealRow, ABladeThatDoesNotMoveMovesNothing) {
  ResolvedMotion const motion = rules(0);
  BoundaryMotion const surface(mesh_, motion);
  for (int rule : {blade, ends, periodics})
    for (Vec3 const& u : evaluate(surface, rule, points_of_rule(motion, rule))) EXPECT_EQ(u, (Vec3{0, 0, 0}));
}

TEST_P(RealRow, PeriodicCopiesMoveAlike) {
  ResolvedMotion const motion = rules(1);
  BoundaryMotion const surface(mesh_, motion);
  Axis const axis = GetParam().axis;
  for (std::size_t i = 0; i < mesh_.interfaces.size(); ++i) {
    if (motion.interface[i].rule != periodics) continue;
    Interface1to1 const& face = mesh_.interfaces[i];
    Zone const &own = mesh_.zones[face.zone], &donor = mesh_.zones[face.donor_zone];
    for (Index3 const& corner :
         {face.range.begin, Index3{face.range.end[0] - 1, face.range.end[1] - 1, face.range.end[2] - 1}}) {
      Vec3 const p = mesh_.coordinates[own.node(corner)], q = mesh_.coordinates[donor.node(face.to_donor(corner))];
      Vec3 const u = evaluate(surface, periodics, {p})[0], v = evaluate(surface, periodics, {q})[0];
      auto const off_axis = [&](Vec3 const& d) { return d - dot(d, axis.direction) * axis.direction; };
      auto const turned = [&](Vec3 const& from, Vec3 const& by) {
        Vec3 const a = off_axis(from - axis.origin), b = off_axis(from + by - axis.origin);
        return std::atan2(dot(axis.direction, cross(a, b)), dot(a, b));
      };
      EXPECT_NEAR(turned(p, u), turned(q, v), 1e-10);
      EXPECT_NEAR(norm(off_axis(p + u - axis.origin)), norm(off_axis(p - axis.origin)), 1e-13);
    }
  }
}

/// The two sides of the blade in this mesh are a pitch apart. Its own sections, turned and pushed along the axis, are a
/// target that says where every node goes.
TEST_P(RealRow, SectionsOfTheBladeAsATargetMoveBothSidesOfIt) {
  Axis const axis = GetParam().axis;
  RigidTransform const moved = [&] {
    RigidTransform t = rotation_about(axis.origin, axis.direction, 0.02);
    t.translation += 1e-3 * mesh_.size() * axis.direction;
    return t;
  }();
  // Each side as lines along the chord, from hub to case.
  std::vector<std::vector<std::vector<Vec3>>> sides;
  int zone = -1;
  for (int const p : select_patches(mesh_, {GetParam().blade})) {
    Patch const& patch = mesh_.patches[p];
    zone = patch.zone;
    std::array<int, 2> extent{};
    for (int a = 0, d = 0; a < 3; ++a)
      if (patch.range.extent(a) > 1) extent[d++] = patch.range.extent(a);
    auto const nodes = points(patch.zone, patch.range);
    auto const radius = [&](Vec3 const& x) { return norm(cross(axis.direction, x - axis.origin)); };
    auto const at = [&](int a, int b) { return nodes[a + extent[0] * b]; };
    bool const rises = std::abs(radius(at(extent[0] - 1, 0)) - radius(at(0, 0))) >
                       std::abs(radius(at(0, extent[1] - 1)) - radius(at(0, 0)));  // along direction 0
    auto& side = sides.emplace_back();
    for (int k = 0; k < extent[rises ? 0 : 1]; ++k) {
      auto& line = side.emplace_back();
      for (int n = 0; n < extent[rises ? 1 : 0]; ++n) line.push_back(rises ? at(k, n) : at(n, k));
    }
  }
  ASSERT_EQ(sides.size(), 2u);
  RigidTransform onto{};
  double nearest = 1e300;
  for (Interface1to1 const& interface : mesh_.interfaces) {
    if (!interface.periodic) continue;
    for (RigidTransform const& t : {interface.periodic->declared, interface.periodic->declared.inverse()})
      if (double const d = distance(t(sides[1].front().front()), sides[0].front().front()); d < nearest) {
        nearest = d;
        onto = t;
      }
  }
  ASSERT_LT(nearest, 1e-6 * mesh_.size()) << "of zone " << zone;
  auto target = std::make_shared<TargetGeometry>();
  for (std::size_t k = 0; k < sides[0].size(); ++k) {
    TargetSection section{"row " + std::to_string(k), {}};
    for (Vec3 const& x : sides[0][k]) section.points.push_back(moved(x));
    auto const& back = sides[1][k];
    for (std::size_t n = back.size() - 1; n-- > 1;) section.points.push_back(moved(onto(back[n])));
    target->sections.push_back(std::move(section));
  }
  TargetRule rule;
  rule.target = target;
  rule.flow = axis.direction;
  Motion motion;
  motion.axis = axis;
  motion.rules = {{{GetParam().blade}, rule, 0, "blade"}};
  ResolvedMotion const resolved = resolve(mesh_, motion);
  BoundaryMotion const surface(mesh_, resolved);
  auto const at = points_of_rule(resolved, blade);
  auto const u = evaluate(surface, blade, at);
  for (std::size_t n = 0; n < at.size(); ++n) EXPECT_LT(distance(at[n] + u[n], moved(at[n])), 1e-8 * mesh_.size()) << n;
}

/// Both rows of a stage at once, each with its own motion: what a row gets is what it gets alone.
TEST(RealStage, RowsInOneFileFollowTheirOwnBlades) {
  Mesh const mesh = read_mesh(test::shared_mesh("axial_turbine_stage_H.cgns"));
  Axis const axis{{0, 0, 0}, {1, 0, 0}};
  std::vector<MotionRule> const first{{{"BLADE1"}, twist(axis, 0.5), 0, ""},
                                      {{"INLET", "mixing_out"}, CircumferentialSlideRule{{"BLADE1"}}, 0, ""},
                                      {{"row1/per*"}, FollowRule{{"BLADE1"}}, 0, ""}},
      second{{{"BLADE2"}, twist(axis, -0.3), 0, ""},
             {{"OUTLET", "mixing_in"}, CircumferentialSlideRule{{"BLADE2"}}, 0, ""},
             {{"row2/per*"}, FollowRule{{"BLADE2"}}, 0, ""}};
  auto const surface_motion = [&](std::vector<std::vector<MotionRule>> const& rows) {
    Motion motion;
    motion.axis = axis;
    for (auto const& row : rows) motion.rules.insert(motion.rules.end(), row.begin(), row.end());
    motion.rules.push_back({{"HUB", "SHROUD"}, SlipRule{.surface = SlipRule::Surface::revolution}, 0, ""});
    return BoundaryMotion(mesh, resolve(mesh, motion));
  };
  BoundaryMotion const both = surface_motion({first, second}),
                       alone[2] = {surface_motion({first}), surface_motion({second})};
  std::vector<Vec3> points;
  for (Index n = 0; n < mesh.n_nodes(); n += 97) points.push_back(mesh.coordinates[n]);
  std::vector<Vec3> u(points.size()), v(points.size());
  double largest[2] = {0, 0};
  for (int row : {0, 1})
    for (int rule : {1, 2}) {
      both.displacement(3 * row + rule, points, u);
      alone[row].displacement(rule, points, v);
      for (std::size_t n = 0; n < points.size(); ++n) {
        EXPECT_EQ(u[n], v[n]);
        largest[row] = std::max(largest[row], norm(u[n]));
      }
    }
  for (double l : largest) EXPECT_GT(l, 1e-3 * mesh.size());
}

INSTANTIATE_TEST_SUITE_P(
    Meshes, RealRow,
    ::testing::Values(
        Row{"axial_turbine_stage_H.cgns", {{0, 0, 0}, {1, 0, 0}}, "BLADE1", {"INLET", "mixing_out"}, {"row1/per*"}},
        Row{"axial_turbine_stage_H.cgns", {{0, 0, 0}, {1, 0, 0}}, "BLADE2", {"OUTLET", "mixing_in"}, {"row2/per*"}},
        Row{"water_turbine.cgns", {{0, 0, 0}, {0, 0, 1}}, "BLADE_GV", {"INLET", "GV_in/ax_lo"}, {"GV_*/per*"}},
        Row{"water_turbine.cgns", {{0, 0, 0}, {0, 0, 1}}, "BLADE_RU", {"RU_*/ax_*"}, {"RU_*/per*"}},
        Row{"axialTurbine_7blk.cgns", {{0, 0, 0}, {0, 0, 1}}, "BLADE_GV", {"INLET", "GV_in/ax_lo"}, {"GV_*/per*"}},
        Row{"axialTurbine_7blk.cgns", {{0, 0, 0}, {0, 0, 1}}, "BLADE_RU", {"RU_*/ax_*"}, {"RU_*/per*"}}));

}  // namespace
}  // namespace gridmorph
