// How far a body can turn: a viscous sphere in a larger one, by several angles, in one step and in more.
//
//   example_sphere_turns [ELEMENTS] [ANGLE_DEG ...]
//
// Prints how many elements are inverted that were not before, and the smallest determinant in parentheses. Made the
// table of docs/unstructured.md, "Large turns".
#include <generators/sphere.hpp>
#include <gridmorph/gridmorph.hpp>

#include <Kokkos_Core.hpp>

#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

struct SphereCase {
  gridmorph::IndexedMesh mesh;

  explicit SphereCase(gridmorph::Index elements) : mesh(gridmorph::make_sphere({.elements = elements})) {}

  /// The sphere turned by an angle about an axis that no grid line follows; the outer sphere, a far field, stands.
  gridmorph::Coordinates turned(double angle_deg, int steps) {
    auto const turn = gridmorph::rotation_about({0, 0, 0}, {1, 2, 3}, angle_deg * std::numbers::pi / 180);
    gridmorph::Motion motion;
    gridmorph::MotionRule& rule = motion.rules.emplace_back();
    rule.patches = {"sphere"};
    rule.rule = gridmorph::RigidRule{turn.rotation, turn.translation};
    rule.where = "sphere_turns";
    gridmorph::MorphPlan const plan(gridmorph::HostInstance(), mesh, motion);
    gridmorph::StepOptions options;
    options.steps = steps;
    return gridmorph::morph_in_steps(mesh, plan, plan.boundary_displacement(), options);
  }

  [[nodiscard]] std::string verdict(gridmorph::Coordinates const& morphed) const {
    gridmorph::UnstructuredQualityInput<Kokkos::HostSpace> input;
    input.baseline = gridmorph::views(mesh.mesh().coordinates);
    input.coordinates = gridmorph::views(morphed);
    auto const quality =
        gridmorph::measure_quality(Exec(), mesh.mesh(), mesh.topology(), mesh.face_patches(), input).far_field;
    char text[64];
    std::snprintf(text, sizeof text, "%lld (%.3g)", static_cast<long long>(quality.newly_inverted),
                  quality[gridmorph::Measure::determinant_3x3x3].min);
    return text;
  }
};

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  SphereCase sphere(argc > 1 ? std::atoll(argv[1]) : 40'000);
  std::vector<double> angles;
  for (int a = 2; a < argc; ++a) angles.push_back(std::atof(argv[a]));
  if (angles.empty()) angles = {45, 90};
  std::printf("%lld elements; inverted (smallest determinant)\n%-12s%18s%18s%18s\n",
              static_cast<long long>(sphere.mesh.n_cells()), "angle [deg]", "one step", "2 steps", "3 steps");
  for (double const angle : angles) {
    std::printf("%-12g", angle);
    for (int const steps : {1, 2, 3}) std::printf("%18s", sphere.verdict(sphere.turned(angle, steps)).c_str());
    std::printf("\n");
  }
}
