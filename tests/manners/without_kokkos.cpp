// A program that forgot to initialise Kokkos, or uses the library after Kokkos was finalised: one clear error each, no
// abort; and what does without Kokkos, however large. A program of its own, because test programs run inside Kokkos
// from beginning to end.
#include <gridmorph/boundary/find_interfaces.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <Kokkos_Core.hpp>

#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace gridmorph;

int failures = 0;

template <class Call>
void expect_error(char const* what, Call const& call) {
  try {
    call();
    std::printf("%s: no error\n", what);
  } catch (ConfigError const& e) {
    if (std::string(e.what()).find("Kokkos::ScopeGuard") != std::string::npos) return;
    std::printf("%s: unclear: %s\n", what, e.what());
  }
  ++failures;
}

/// A profile of as many points as are fitted on all cores elsewhere.
void expect_profile() {
  std::vector<std::pair<double, double>> points;
  for (int n = 0; n < 3000; ++n) points.emplace_back(1e-3 * n, 2 + 0.1 * std::sin(1e-3 * n));
  try {
    if (std::abs(RevolutionProfile::from_points(points)(1.2345) - (2 + 0.1 * std::sin(1.2345))) < 1e-9) return;
    std::printf("a profile: another curve\n");
  } catch (std::exception const& e) {
    std::printf("a profile: %s\n", e.what());
  }
  ++failures;
}

void check_all() {
  expect_profile();
  Mesh mesh;
  mesh.add_zone("a", {2, 2, 2});
  expect_error("Coordinates", [] { (void)Coordinates(8); });
  expect_error("prepare", [&] { (void)prepare(mesh, Motion{}, PlanOptions{}); });
  expect_error("find_interfaces", [&] { (void)find_interfaces(mesh); });
}

}  // namespace

int main(int argc, char** argv) {
  check_all();
  Kokkos::initialize(argc, argv);
  (void)gridmorph::Coordinates(8);
  Kokkos::finalize();
  check_all();
  return failures == 0 ? 0 : 1;
}
