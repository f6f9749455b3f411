// Nodes on slip surfaces, by both kernels that ask the surfaces: against planes and circles, and differences of
// themselves.
#include "kernels/tables.hpp"
#include "support/random.hpp"

#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/kernels/slip_end.hpp>
#include <gridmorph/kernels/slip_nodes.hpp>
#include <gridmorph/kernels/transposed_copies.hpp>
#include <gridmorph/kernels/transposed_nodes.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace gridmorph::test {
namespace {

using kernels::SlipSurfaceView;

SlipSurface plane(Vec3 const& normal) {
  SlipSurface s;
  s.direction = (1 / norm(normal)) * normal;
  s.size = 1;
  return s;
}
/// Radius 1 + x^2 / 4 about the x axis.
SlipSurface bulge() {
  SlipSurface s;
  s.kind = SlipKind::revolution;
  s.direction = {1, 0, 0};
  s.size = 1;
  std::vector<std::pair<double, double>> points;
  for (int k = -50; k <= 50; ++k) points.emplace_back(0.04 * k, 1 + 0.0004 * k * k);
  s.profile = RevolutionProfile::from_points(points);
  return s;
}

/// The same curve in a frame that is turned by an angle.
SlipSurface turned_bulge(double angle) {
  SlipSurface s = bulge();
  s.kind = SlipKind::meridional;
  s.frame = {std::cos(angle), std::sin(angle)};
  return s;
}

/// One node at x that slides on some surfaces: displaced by u at the given rate.
class Node {
 public:
  Node(Vec3 const& x, std::vector<SlipSurface> surfaces) : x_(x), surfaces_(std::move(surfaces)) {
    std::vector<SlipSurfaceView> views;
    std::vector<std::int32_t> numbers;
    kernels::SlipEnd end{0, 0, 0, -1, -1, {-1, -1, -1}, 0};
    for (SlipSurface const& s : surfaces_) {
      end.surface[views.size()] = std::int32_t(views.size());
      numbers.push_back(std::int32_t(views.size()));
      views.push_back(s.view());
    }
    table_ = {view<std::int32_t>({0}), view<std::int32_t>({-1}), view<Index>({0, Index(views.size())}), view(numbers),
              view(views)};
    ends_ = view<kernels::SlipEnd>({end});
    kernels::SlipEndBaselines<Host>{ends_, table_.surfaces, {&x_.x, &x_.y, &x_.z}, baselines_}(0);
  }
  Node(Node const&) = delete;
  Node& operator=(Node const&) = delete;

  /// Both; they agree.
  void operator()(Vec3& u, Vec3& rate) const {
    Vec3 v = u, v_rate = rate;
    ask(u, rate);
    add_end(v, v_rate);
    EXPECT_LT(distance(u, v), 1e-15);
    EXPECT_LT(distance(rate, v_rate), 1e-14);
  }
  void expect_rate(Vec3 const& u, Vec3 const& rate, double tolerance) const {
    double const h = 1e-5;
    Vec3 before = u - h * rate, after = u + h * rate, at = u, found = rate, unused;
    (*this)(before, unused);
    (*this)(after, unused);
    (*this)(at, found);
    EXPECT_LT(distance(found, (0.5 / h) * (after - before)), tolerance);
  }
  /// Gradients by both transposes: g . (rate of what is asked) = (gradient) . rate.
  void expect_transposed(Vec3 const& u, Vec3 const& rate, Vec3 const& g) const {
    Vec3 at = u, found = rate;
    (*this)(at, found);
    Vec3 of_node = g, unlisted;
    kernels::PrescribeNodes<Host, false> const ask{table_, {}, {}, {&x_.x, &x_.y, &x_.z}, nullptr, nullptr};
    kernels::PrescribeNodesBack<Host>{ask, &u, &of_node, &unlisted}(0);
    EXPECT_NEAR(dot(of_node, rate), dot(g, found), 1e-13);
    kernels::Field<double const> const kept{&u.x, &u.y, &u.z}, of_end{&g.x, &g.y, &g.z};
    kernels::SlipEndValues<Host, false> const ends{ends_, baselines_, table_.surfaces, {}, kept, kept, {}};
    Vec3 const of_slot = kernels::SlipEndBySlot<Host>{ends, kept, of_end}(0, 0);
    EXPECT_NEAR(dot(of_slot + g, rate), dot(g, found), 1e-13);
  }

 private:
  /// By the kernel of unstructured meshes.
  void ask(Vec3& u, Vec3& rate) const {
    kernels::PrescribeNodes<Host, true>{table_, {}, {}, {&x_.x, &x_.y, &x_.z}, &u, &rate}(0);
  }
  /// By the kernel of structured meshes, which gives what is to be added.
  void add_end(Vec3& u, Vec3& rate) const {
    Vec3 add, add_rate;
    kernels::Field<double const> const given{&u.x, &u.y, &u.z}, given_rate{&rate.x, &rate.y, &rate.z};
    kernels::SlipEndValues<Host, false>{ends_, baselines_, table_.surfaces, {}, given, {}, {&add.x, &add.y, &add.z}}(0);
    kernels::SlipEndValues<Host, true>{
        ends_, baselines_, table_.surfaces, {}, given, given_rate, {&add_rate.x, &add_rate.y, &add_rate.z}}(0);
    u += add;
    rate += add_rate;
  }

  Vec3 x_;
  std::vector<SlipSurface> surfaces_;
  kernels::SlipNodeTable<Host> table_;
  Kokkos::View<kernels::SlipEnd const*, Host> ends_;
  Kokkos::View<kernels::SlipEndBaseline*, Host> baselines_{"test::baselines", 1};
};

TEST(Slip, OnAPlaneLosesWhatIsAcrossIt) {
  Random random(21);
  Node const node{{0.2, 0, 0}, {plane({0, 0, 1})}};
  for (int n = 0; n < 20; ++n) {
    Vec3 const given = random.vector(0.5), rate = random.vector(1);
    Vec3 u = given, r = rate;
    node(u, r);
    EXPECT_LT(distance(u, {given.x, given.y, 0}), 1e-15);
    EXPECT_LT(distance(r, {rate.x, rate.y, 0}), 1e-15);
  }
  Vec3 none, unused;
  node(none, unused);
  EXPECT_EQ(none, Vec3{});
}

TEST(Slip, WherePlanesMeetGoesAlongTheirEdgeWhateverTheAngle) {
  Random random(22);
  for (double const angle : {1.57079632679, 1.0, 0.3, 0.05}) {
    Vec3 const normals[2] = {{0, 0, 1}, {0, std::sin(angle), std::cos(angle)}};
    Node const node{{0, 0, 0}, {plane(normals[0]), plane(normals[1])}};
    for (int n = 0; n < 20; ++n) {
      Vec3 const given = random.vector(0.5), rate = random.vector(1);
      Vec3 u = given, r = rate;
      node(u, r);
      // The edge is the x axis.
      EXPECT_LT(norm(Vec3{0, u.y, u.z}), 1e-12) << angle;
      EXPECT_LT(std::abs(u.x - given.x), 1e-12) << angle;
      EXPECT_LT(distance(r, {rate.x, 0, 0}), 1e-12) << angle;
      // Where the displacement is along the edge already, the rate has to be put there all the same.
      for (Vec3 const& kept : {Vec3{}, Vec3{given.x, 0, 0}}) {
        Vec3 same = kept;
        r = rate;
        node(same, r);
        EXPECT_EQ(same, kept);
        EXPECT_LT(distance(r, {rate.x, 0, 0}), 1e-12) << angle;
      }
    }
  }
}

TEST(Slip, OnASurfaceOfRevolutionKeepsItsRadius) {
  Random random(23);
  Vec3 const x{0.4, (1 + 0.04) * std::cos(0.7), (1 + 0.04) * std::sin(0.7)};
  Node const node{x, {bulge()}};
  for (int n = 0; n < 20; ++n) {
    Vec3 const given = random.vector(0.3), rate = random.vector(1);
    Vec3 u = given, r = rate;
    node(u, r);
    Vec3 const moved = x + u, asked = x + given;
    EXPECT_NEAR(moved.x, asked.x, 1e-14);
    EXPECT_NEAR(std::hypot(moved.y, moved.z), 1 + moved.x * moved.x / 4, 1e-10);
    EXPECT_NEAR(std::atan2(moved.z, moved.y), std::atan2(asked.z, asked.y), 1e-14);
    node.expect_rate(given, rate, 1e-8);
  }
}

TEST(Slip, WhereASurfaceOfRevolutionEndsInAPlaneStaysOnBoth) {
  Random random(24);
  Vec3 const x{0.4, (1 + 0.04) * std::cos(0.7), (1 + 0.04) * std::sin(0.7)};
  Vec3 const along{0, std::cos(0.7), std::sin(0.7)};
  Node const node{x, {bulge(), plane(cross({1, 0, 0}, along))}};
  for (int n = 0; n < 20; ++n) {
    Vec3 const given = random.vector(0.3), rate = random.vector(1);
    Vec3 u = given, r = rate;
    node(u, r);
    Vec3 const moved = x + u;
    EXPECT_NEAR(std::hypot(moved.y, moved.z), 1 + moved.x * moved.x / 4, 1e-10);
    EXPECT_NEAR(dot(moved, cross({1, 0, 0}, along)), 0, 1e-12);
  }
}

TEST(Slip, GradientsAreTheTransposeOfRates) {
  Random random(25);
  Vec3 const x{0.4, 1.07 * std::cos(0.7), 1.07 * std::sin(0.7)}, along{0, std::cos(0.7), std::sin(0.7)};
  SlipSurface axial = plane({1, 0, 0});
  axial.kind = SlipKind::axial;
  std::vector<std::vector<SlipSurface>> const all{{plane({1, 2, -1})}, {axial},
                                                  {bulge()},           {turned_bulge(0)},
                                                  {turned_bulge(0.3)}, {bulge(), plane(cross({1, 0, 0}, along))}};
  for (std::size_t k = 0; k < all.size(); ++k) {
    SCOPED_TRACE(k);
    Node const node{x, all[k]};
    for (int n = 0; n < 20; ++n) node.expect_transposed(random.vector(0.3), random.vector(1), random.vector(1));
  }
}

}  // namespace
}  // namespace gridmorph::test
