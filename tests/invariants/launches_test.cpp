// How many kernels a morph of blocks enqueues. On a GPU each costs some microseconds before it runs, which is most of
// what a morph takes there below a million nodes.
#include "invariants/cases.hpp"
#include "support/morph_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

namespace gridmorph::test {
namespace {

namespace hooks = Kokkos::Tools::Experimental;

/// By name, while the callback is set.
std::map<std::string, int> launches;

void on_kernel(char const* name, uint32_t, uint64_t*) { ++launches[name]; }

/// What one call of Morpher::positions() enqueues on the host.
std::map<std::string, int> launches_of(Case const& c) {
  Kokkos::DefaultHostExecutionSpace const exec;
  Mesh const mesh = c.mesh();
  PreparedMorph const prepared = prepare(mesh, c.motion(1), c.options);
  DeviceField<Kokkos::HostSpace> const x(mesh.coordinates);
  auto const morpher = MorpherAccess::of(exec, prepared.plan(), x);
  auto const boundary = upload<Kokkos::HostSpace>(prepared.boundary_displacement());
  launches.clear();
  hooks::set_begin_parallel_for_callback(on_kernel);
  hooks::set_begin_parallel_reduce_callback(on_kernel);
  hooks::set_begin_parallel_scan_callback(on_kernel);
  morpher.positions(exec, boundary, x);
  exec.fence();
  hooks::set_begin_parallel_for_callback(nullptr);
  hooks::set_begin_parallel_reduce_callback(nullptr);
  hooks::set_begin_parallel_scan_callback(nullptr);
  return launches;
}

/// They may become fewer, and the number here with them: who needs another launch has to say why it is worth one. 12
/// are wanted of a passage and 30 of an aircraft, each of whose stages has one for its copies, two for its sides (on
/// the host a third) and one for its lines.
TEST(Launches, OfAMorphAreNoMoreThanTheyWere) {
  std::map<std::string, int> const most{{"passage", 13}, {"passage_turned", 21}, {"aircraft", 59}};
  int n_cases = 0;
  for (Case const& c : make_cases()) {
    auto const found = most.find(c.name);
    if (found == most.end()) continue;
    ++n_cases;
    int n = 0;
    std::string names;
    for (auto const& [name, times] : launches_of(c)) {
      n += times;
      names += "\n  " + std::to_string(times) + " " + name;
    }
    EXPECT_LE(n, found->second) << c.name << " enqueues" << names;
    EXPECT_GT(n, 0) << c.name;
  }
  EXPECT_EQ(n_cases, int(most.size()));
}

}  // namespace
}  // namespace gridmorph::test
