// Blade rows of meshes from outside: their end walls, and whether follow, slide and blade agree where patches meet.
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/motion/surface_motion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace gridmorph {
namespace {

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
    char const* folder = std::getenv("GRIDMORPH_MESHES");
    std::filesystem::path const path = std::filesystem::path(folder ? folder : GRIDMORPH_MESHES_DIR) / GetParam().file;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path << "; set GRIDMORPH_MESHES";
    mesh_ = read_mesh(path.string());
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
  static std::vector<Vec3> evaluate(SurfaceMotion const& motion, int rule, std::vector<Vec3> const& at) {
    std::vector<Vec3> out(at.size());
    motion.displacement(rule, at, out);
    return out;
  }

  /// Largest disagreement of two rules at the points they share, and how many these are.
  std::pair<double, int> disagreement(SurfaceMotion const& surface, ResolvedMotion const& motion, int a, int b) const {
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
  SurfaceMotion const surface(mesh_, motion);
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
  SurfaceMotion const surface(mesh_, motion);
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
  SurfaceMotion const surface(mesh_, motion);
  for (int rule : {blade, ends, periodics})
    for (Vec3 const& u : evaluate(surface, rule, points_of_rule(motion, rule))) EXPECT_EQ(u, (Vec3{0, 0, 0}));
}

TEST_P(RealRow, PeriodicCopiesMoveAlike) {
  ResolvedMotion const motion = rules(1);
  SurfaceMotion const surface(mesh_, motion);
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

/// Both rows of a stage at once, each with its own motion: what a row gets is what it gets alone.
TEST(RealStage, RowsInOneFileFollowTheirOwnBlades) {
  char const* folder = std::getenv("GRIDMORPH_MESHES");
  auto const path = std::filesystem::path(folder ? folder : GRIDMORPH_MESHES_DIR) / "axial_turbine_stage_H.cgns";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path << "; set GRIDMORPH_MESHES";
  Mesh const mesh = read_mesh(path.string());
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
    return SurfaceMotion(mesh, resolve(mesh, motion));
  };
  SurfaceMotion const both = surface_motion({first, second}),
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
        Row{"axialTurbine_7blk.cgns", {{0, 0, 0}, {0, 0, 1}}, "BLADE_GV", {"INLET", "GV_in/ax_lo"}, {"GV_*/per*"}},
        Row{"axialTurbine_7blk.cgns", {{0, 0, 0}, {0, 0, 1}}, "BLADE_RU", {"RU_*/ax_*"}, {"RU_*/per*"}}));

}  // namespace
}  // namespace gridmorph
