// The number of threads: it changes how long a run takes and not one bit of its mesh.
#include "../io/io_support.hpp"
#include "run_command.hpp"

#include <gridmorph/io/mesh_io.hpp>

#include <fmt/format.h>

#include <utility>

namespace gridmorph::test {
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
      SCOPED_TRACE(fmt::format("{} threads", n));
      test::expect_same_coordinates(mesh.coordinates, first.coordinates);
    }
  }
};

TEST_F(ThreadsRun, ChangeNoBitOfABladePassage) {
  expect_same_bits("demo passage --nodes 20000 --motion rotation", "passage_rotation.cgns");
}

TEST_F(ThreadsRun, ChangeNoBitOfAMeshOfElements) { expect_same_bits("demo ball --elements 50000", "ball_swing.cgns"); }

}  // namespace
}  // namespace gridmorph::test
