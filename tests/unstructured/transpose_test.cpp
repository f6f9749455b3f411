// The transpose of a morph of elements against its derivative forwards, each kind of stage and boundary in turn.
#include "support/made_bodies.hpp"
#include "support/morph_run.hpp"
#include "support/sector.hpp"
#include "support/transpose_check.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <ostream>
#include <string>

namespace gridmorph::test {
namespace {

using Case = UnstructuredCase;
using Exec = Case::Host;

bool in_the_middle(Vec3 const& p) { return p.x > 2 && p.x < 5 && p.y > 2 && p.y < 5 && p.z > 2 && p.z < 5; }
Mesh box() { return box_around({7, 7, 7}, in_the_middle); }

/// Turned, bent and shifted.
Rule bends(double size, Vec3 const& centre = {3.5, 3.5, 3.5}) {
  return FunctionRule{"bends", [=](std::span<Vec3 const> x, std::span<Vec3> u) {
                        for (std::size_t n = 0; n < x.size(); ++n) {
                          Vec3 const p = x[n] - centre;
                          Vec3 const bend{0.3 + 0.1 * p.y * p.y, 0.2 * std::sin(p.z), 0.1 * p.x * p.y};
                          u[n] = size * (cross({0.5, 0.2, -0.4}, p) + bend);
                        }
                      }};
}
/// Turned, and changed in length, thickness and by shear, but for a little.
Rule stretches(double size, Vec3 const& centre = {3.5, 3.5, 3.5}, double across = 1) {
  RigidTransform const turn = rotation_about(centre, {0, 0, 1}, 0.5);
  return FunctionRule{"stretches", [=](std::span<Vec3 const> x, std::span<Vec3> u) {
                        for (std::size_t n = 0; n < x.size(); ++n) {
                          Vec3 const p = x[n] - centre;
                          Vec3 const more{0.4 * p.x + 0.3 * p.y, 0.5 * p.y, across * (0.2 * p.z - 0.1 * p.x)};
                          u[n] = turn(x[n] + size * (more + Vec3{0.03 * p.y * p.y, 0.2, 0})) - x[n];
                        }
                      }};
}
PlanOptions with_layers(int n, BoundaryLayer::Mode mode = BoundaryLayer::Mode::rotate) {
  PlanOptions options = by_lattice();
  options.elements.cells = 1;  // a coarse background: the stages are the same
  options.boundary_layers.push_back({.walls = {}, .extent = BoundaryLayer::Extent::layers, .layers = n, .mode = mode});
  return options;
}
PlanOptions by_layers() {
  PlanOptions options = with_layers(1);
  options.elements.method = NearFieldMethod::layers;
  return options;
}
PlanOptions by_fit(PlanOptions options) {
  options.elements.method = NearFieldMethod::least_squares;
  return options;
}
/// By half in all directions alike, but for a little.
Rule grows(Vec3 const& centre) {
  RigidTransform const turn = rotation_about(centre, {0, 0, 1}, 0.5);
  return FunctionRule{"grows", [=](std::span<Vec3 const> x, std::span<Vec3> u) {
                        for (std::size_t n = 0; n < x.size(); ++n) {
                          Vec3 const p = x[n] - centre;
                          u[n] = turn(x[n] + 0.5 * p + Vec3{0.1 * p.y, 0.05 * p.x * p.x, 0}) - x[n];
                        }
                      }};
}
/// Half an annulus whose case bulges.
double case_radius(double x) { return 2 + 0.3 * std::pow(std::sin(x), 2); }
Mesh half_annulus() {
  Mesh mesh = to_hexahedra(unit_box({10, 5, 8}));
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const q = mesh.coordinates[n];
    double const x = q.x * std::numbers::pi / 10, angle = q.z * std::numbers::pi / 8;
    double const r = 1 + (case_radius(x) - 1) * q.y / 5;
    mesh.coordinates.set(n, {x, r * std::cos(angle), r * std::sin(angle)});
  }
  return mesh;
}
SlipRule on_the_case() {
  std::vector<std::pair<double, double>> profile;
  for (int k = 0; k <= 64; ++k) profile.emplace_back(k * std::numbers::pi / 64, case_radius(k * std::numbers::pi / 64));
  return {.surface = SlipRule::Surface::revolution, .profile = profile};
}
/// About x, with a conical shroud.
Sector sector(double inner) {
  return {.inner = inner,
          .outer = inner + 1,
          .cells = {3, 3, 5},
          .frame = rotation_about({}, {0, 1, 0}, std::numbers::pi / 2),
          .cone = 0.2};
}
Rule bulges(Sector const& s) {
  return s.by([](Vec3 const& p) { return Vec3{0.05 * std::sin(3 * p.z + 1), 0.06 * p.z, 0.03}; });
}
/// A body beside another one that stands, near a wall that slips.
Mesh two_bodies() {
  return box_around({12, 7, 6}, [](Vec3 const& p) {
    return p.y > 2 && p.y < 5 && p.z > 2 && p.z < 4 && ((p.x > 2 && p.x < 5) || (p.x > 7 && p.x < 9));
  });
}

/// As a whole, and by a little that is the body's own.
Rule turned_and_bent(double size = 0.02) {
  RigidTransform const turn = rotation_about({1, 2, 3}, {1, -2, 1}, 0.7);
  return FunctionRule{"turned and bent", [=](std::span<Vec3 const> x, std::span<Vec3> u) {
                        for (std::size_t n = 0; n < x.size(); ++n)
                          u[n] = turn(x[n] + size * Vec3{std::sin(x[n].y), 0.3, x[n].x * x[n].x / 7}) - x[n];
                      }};
}
/// A box around a body, and beyond a gap one that has a part of its side to itself.
Mesh two_parts() {
  Mesh mesh = part_of(
      box_around({12, 7, 7}, in_the_middle), [](Vec3 const& p) { return p.x < 7 || p.x > 8; }, "side",
      PatchKind::inflow);
  return mesh;
}

struct Kind {
  std::string name;
  std::function<Mesh()> mesh;
  std::vector<MotionRule> rules;
  PlanOptions options;
  friend std::ostream& operator<<(std::ostream& out, Kind const& k) { return out << k.name; }
};

std::vector<Kind> kinds() {
  auto const moves = [](double size = 0.1) { return rule_for({"body"}, bends(size)); };
  MotionRule const slips = rule_for({"k_min"}, SlipRule{});
  MotionRule const airfoil_turns = rule_for({"airfoil"}, rotation({0.3, 0, 0}, {0, 0, 1}, 0.4));
  using Mode = BoundaryLayer::Mode;
  return {
      {"translated", box, {moves(), slips}, with_layers(1, Mode::translate)},
      {"rotated", box, {moves(), slips}, with_layers(1, Mode::rotate)},
      {"blended", box, {moves(), slips}, with_layers(2, Mode::blend)},
      {"by_layers", box, {moves(), slips}, by_layers()},
      {"by_fit", box, {moves(), rule_for({"?_min", "?_max"}, FixedRule{})}, by_fit(with_layers(1))},
      {"by_fit_beside_what_slips", box, {moves(), slips}, by_fit(with_layers(1))},
      {"by_fit_beside_what_moves",
       half_annulus,
       {rule_for({"j_min", "i_min"}, bends(0.03, {1, 0, 0})),
        rule_for({"j_max", "i_max", "k_min", "k_max"}, FreeRule{})},
       [] {
         PlanOptions options = by_fit({});
         options.elements.walls = {"j_min"};
         return options;
       }()},
      {"by_fit_of_two", two_bodies, {rule_for({"body"}, bends(0.05))}, by_fit({})},
      {"by_fit_as_it_grows",
       [] { return airfoil(48, 3, 0.02, 1.3, 4); },
       {rule_for({"airfoil"}, grows({0.3, 0, 0}))},
       by_fit({})},
      {"by_fit_where_walls_end_on_others",
       half_annulus,
       {rule_for({"j_min"}, bends(0.03, {1, 0, 0})), rule_for({"j_max"}, FixedRule{}),
        rule_for({"i_min", "i_max", "k_min", "k_max"}, FreeRule{})},
       by_fit({})},
      {"by_fit_behind_periodic_sides",
       [] { return sector(1).mesh(); },
       {rule_for({"hub"}, bulges(sector(1))), rule_for({"inlet", "outlet"}, FreeRule{}),
        rule_for({"shroud"}, SlipRule{SlipRule::Surface::revolution})},
       by_fit({})},
      {"no_columns", box, {moves()}, by_lattice()},
      {"slips_on_three_sides",
       box,
       {moves(), rule_for({"i_min", "j_min", "k_min"}, SlipRule{}), rule_for({"i_max"}, translation({0.1, 0, 0})),
        rule_for({"j_max", "k_max"}, FreeRule{})},
       with_layers(1)},
      {"slips_on_itself", box, {moves(), rule_for({"k_min"}, SlipRule{SlipRule::Surface::baseline})}, with_layers(1)},
      {"tetrahedra",
       [] {
         return box_around({7, 7, 7}, in_the_middle, true);
       },
       {rule_for({"body"}, bends(0.1))},
       by_lattice()},
      {"second_order",
       [] { return second_order(box(), true); },
       {rule_for({"body"}, bends(0.1)), slips},
       with_layers(1)},
      {"two_zones",
       [] { return in_two_zones(box(), [](Vec3 const& p) { return p.x < 5; }); },
       {moves(), slips},
       with_layers(1)},
      {"two_bodies", two_bodies, {rule_for({"body"}, bends(0.05))}, by_lattice()},
      {"airfoil", [] { return airfoil(48, 3, 0.02, 1.3, 4); }, {airfoil_turns}, with_layers(2)},
      {"airfoil_alone", [] { return airfoil(48, 3, 0.02, 1.3, 4); }, {airfoil_turns}, by_lattice()},
      {"stretched", box, {rule_for({"body"}, stretches(0.4))}, with_layers(1)},
      {"stretched_along_a_plane",
       [] {
         return box_around({7, 7, 6},
                           [](Vec3 const& p) { return p.x > 2 && p.x < 5 && p.y > 2 && p.y < 4 && p.z < 3; });
       },
       {rule_for({"body"}, stretches(0.4, {3.5, 3, 0}, 0)), rule_for({"k_min"}, SlipRule{})},
       with_layers(1)},
      {"stretched_airfoil",
       [] { return airfoil(48, 3, 0.02, 1.3, 4); },
       {rule_for({"airfoil"}, stretches(0.5, {0.3, 0, 0}, 0))},
       by_lattice()},
      {"periodic", [] { return periodic_flat_box(8, 5, 2); }, {rule_for({"j_min"}, translation({0, 0.3, 0}))}, {}},
      {"common_motion",
       box,
       {rule_for({"body"}, turned_and_bent()), rule_for({"?_min", "?_max"}, turned_and_bent(0))},
       with_layers(1)},
      {"common_motion_along_a_plane",
       box,
       {rule_for({"body", "i_*", "j_*"}, RigidRule{{{{1.2, 0.4, 0}, {-0.3, 1, 0}, {0, 0, 1}}}, {}}),
        rule_for({"k_min", "k_max"}, SlipRule{})},
       with_layers(1)},
      {"common_motion_of_sliding_columns",
       [] {
         Mesh mesh = box();
         for (Patch& patch : mesh.patches)
           if (patch.name == "k_min") patch.kind = PatchKind::wall;
         for (Index n = 0; n < mesh.n_nodes(); ++n)
           if (Vec3 const p = mesh.coordinates[n]; p.z < 2) mesh.coordinates.set(n, {p.x, p.y, 0.1 * p.z});
         return mesh;
       },
       {rule_for({"body", "i_*", "j_*", "k_max"}, RigidRule{{{{1.2, 0.4, 0}, {-0.3, 1, 0}, {0, 0, 1.1}}}, {}}),
        rule_for({"k_min"}, SlipRule{})},
       with_layers(1)},
      {"two_parts",
       two_parts,
       {moves(), rule_for({"side"}, translation({0.1, 0, 0})), rule_for({"j_*", "k_*"}, SlipRule{})},
       with_layers(1)},
      {"common_motion_of_second_order",
       [] { return second_order(box(), true, [](Vec3 const& p) {
              return p + Vec3{0.01 * p.y * p.y, 0, 0};
            }); },
       {rule_for({"body"}, turned_and_bent()), rule_for({"?_min", "?_max"}, turned_and_bent(0))},
       with_layers(1)},
      {"revolution",
       half_annulus,
       {rule_for({"j_min"}, bends(0.03, {1, 0, 0})), rule_for({"j_max"}, on_the_case()),
        rule_for({"i_min", "i_max", "k_min", "k_max"}, FreeRule{})},
       {}},
      {"given_on_slip",
       box,
       {moves(), rule_for({"i_max"}, bends(0.05)), rule_for({"j_min", "k_min"}, SlipRule{}),
        rule_for({"i_min", "j_max", "k_max"}, FreeRule{})},
       with_layers(1)},
      {"periodic_axis",
       [] { return sector(0).mesh(); },
       {rule_for({"shroud"}, bulges(sector(0))), rule_for({"inlet", "outlet"}, FreeRule{})},
       {}},
      {"periodic_slip",
       [] { return sector(1).mesh(); },
       {rule_for({"hub", "inlet"}, bulges(sector(1))), rule_for({"outlet"}, FreeRule{}),
        rule_for({"shroud"}, SlipRule{SlipRule::Surface::revolution})},
       {}},
  };
}

class UnstructuredTranspose : public ::testing::TestWithParam<Kind> {
 protected:
  static void TearDownTestSuite() { made.clear(); }  // before Kokkos is closed

  struct Planned {
    Case c;
    PreparedUnstructured prepared;
    explicit Planned(Kind const& k)
        : c(k.mesh()), prepared(prepare(c.mesh, c.topology, c.face_patches, motion_of(k.rules), k.options)) {}
    template <class On>
    [[nodiscard]] LinearisedMorph<On> at(double factor) const {
      std::vector<Vec3> boundary = prepared.boundary_displacement();
      for (Vec3& u : boundary) u = factor * u;
      return {prepared.plan, c.mesh.coordinates, boundary};
    }
  };

  /// Planned once for all tests.
  static Planned const& planned() {
    auto found = made.find(GetParam().name);
    if (found == made.end()) found = made.try_emplace(GetParam().name, GetParam()).first;
    return found->second;
  }

 private:
  static inline std::map<std::string, Planned> made;
};

TEST_P(UnstructuredTranspose, HasTheProductsOfTheDerivativeForwards) {
  Planned const& planned = this->planned();
  for (double const factor : {1.0, 0.0})
    EXPECT_LE(product_error(planned.at<Exec>(factor)), 1e-13) << "factor " << factor;
}

TEST_P(UnstructuredTranspose, IsTheDerivativeOfAFunctional) {
  Planned const& planned = this->planned();
  LinearisedMorph<Exec> const at = planned.at<Exec>(1);
  // J = sum of w . u + |u|^2 / 2 along a direction of the boundary, by centred differences. Nodes of other boundaries
  // stay: off a surface that nodes slide on, what they ask for is trimmed beyond a tolerance.
  Vec3 const w{1, -2, 0.5};
  Coordinates rate = random_vectors(5, at.boundary.size());
  auto const& plan = planned.prepared.plan;
  for (Index k = 0; k < rate.size(); ++k)
    if (!std::binary_search(plan.driving.begin(), plan.driving.end(), plan.known[k])) rate.set(k, {});
  auto const displacements = [&](double h) {
    Coordinates b(at.boundary.size()), u(at.n_nodes);
    for (Index k = 0; k < b.size(); ++k) b.set(k, at.boundary[k] + h * rate[k]);
    at.morpher.displacements(Exec(), b, u);
    Exec().fence();
    return u;
  };
  auto const J = [&](double h) {
    Coordinates const u = displacements(h);
    double sum = 0;
    for (Index n = 0; n < u.size(); ++n) sum += dot(w + 0.5 * u[n], u[n]);
    return sum;
  };
  Coordinates gradient = displacements(0);
  for (Index n = 0; n < gradient.size(); ++n) gradient.set(n, gradient[n] + w);
  Coordinates const b = at.backwards(gradient);
  double product = 0, size = 0;
  for (Index k = 0; k < b.size(); ++k) {
    product += dot(b[k], rate[k]);
    size += norm(b[k]) * norm(rate[k]);
  }
  double const h = 2e-7;
  EXPECT_NEAR((J(h) - J(-h)) / (2 * h), product, 1e-7 * size);
}

TEST_P(UnstructuredTranspose, DoesNotDependOnWhatWasMorphedBefore) {
  EXPECT_EQ(bits_left_by_others(this->planned().at<Exec>(1)), 0);
}

TEST_P(UnstructuredTranspose, AndItsDerivativeAreTheSameOnAllExecutionSpaces) {
  Planned const& planned = this->planned();
  expect_same_derivatives([&]<class On>(On) { return planned.at<On>(1); },
                          random_vectors(6, Index(planned.prepared.plan.known.size())),
                          random_vectors(7, planned.c.mesh.n_nodes()));
}

INSTANTIATE_TEST_SUITE_P(Of, UnstructuredTranspose, ::testing::ValuesIn(kinds()),
                         [](auto const& info) { return info.param.name; });

}  // namespace
}  // namespace gridmorph::test
