// The number of threads: it changes how long a run takes and not one bit of its mesh.
#include "run_command.hpp"

#include <gridmorph/io/mesh_io.hpp>

#include <fmt/format.h>

#include <bit>
#include <cstdint>

namespace gridmorph::testing {
namespace {

class ThreadsRun : public CommandTest {
 protected:
  /// Runs `command` with 1, 2 and 3 threads, in a folder each, and compares what comes out under `name`.
  void expect_same_bits(std::string const& command, std::string const& name) const {
    Mesh first;
    for (int const n : {1, 2, 3}) {
      std::string const folder = fmt::format("with_{}", n);
      Outcome const run = gridmorph(fmt::format("{} --quiet --threads {} --directory {}", command, n, folder));
      ASSERT_LE(run.status, 1) << run.err;
      Mesh mesh = read_mesh(path(folder + "/" + name).string());
      if (n == 1) {
        first = std::move(mesh);
        continue;
      }
      ASSERT_EQ(mesh.coordinates.x.size(), first.coordinates.x.size());
      auto const bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
      for (std::size_t i = 0; i < mesh.coordinates.x.size(); ++i)
        ASSERT_TRUE(bits(mesh.coordinates.x[i]) == bits(first.coordinates.x[i]) &&
                    bits(mesh.coordinates.y[i]) == bits(first.coordinates.y[i]) &&
                    bits(mesh.coordinates.z[i]) == bits(first.coordinates.z[i]))
            << "node " << i << " with " << n << " threads";
    }
  }
};

TEST_F(ThreadsRun, ChangeNoBitOfABladePassage) {
  expect_same_bits("demo passage --nodes 20000 --motion rotation", "passage_rotation.cgns");
}

TEST_F(ThreadsRun, ChangeNoBitOfAMeshOfElements) { expect_same_bits("demo ball --elements 50000", "ball_swing.cgns"); }

}  // namespace
}  // namespace gridmorph::testing
