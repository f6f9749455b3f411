// All tests on each of the ranks that mpirun starts: GoogleTest inside one Kokkos scope inside MPI.
//
//   --largest-message=N   messages in pieces of N bytes
//   --give-up             no tests: the last rank ends all while the others wait for it
#include <gridmorph/core/error.hpp>
#include <gridmorph/mpi/mpi_ranks.hpp>

#include "ranks/world.hpp"

#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>

#include <array>
#include <cstdio>
#include <string>
#include <string_view>

namespace gridmorph::test {
namespace {

MpiOptions options;

/// Whether ranks are refused for a reason whose words are these.
bool are_refused(std::string_view words) {
  try {
    (void)mpi_ranks(MPI_COMM_WORLD);
  } catch (ConfigError const& e) {
    return std::string_view(e.what()).find(words) != std::string_view::npos;
  }
  return false;
}

}  // namespace

std::shared_ptr<Ranks const> world() {
  static auto const ranks = mpi_ranks(MPI_COMM_WORLD, options);
  return ranks;
}

}  // namespace gridmorph::test

int main(int argc, char** argv) {
  using namespace gridmorph::test;
  bool const before = are_refused("not initialised");
  int level = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
  testing::InitGoogleTest(&argc, argv);
  bool gives_up = false;
  for (int n = 1; n < argc; ++n) {
    std::string const argument = argv[n];
    gives_up = gives_up || argument == "--give-up";
    if (argument.starts_with("--largest-message=")) options.largest_message = std::stoul(argument.substr(18));
  }
  if (gives_up) {
    auto const ranks = world();
    if (ranks->rank() == ranks->size() - 1) ranks->give_up("the extents are wrong here");
    std::array<double, 1> value{};
    ranks->largest(value);
  }
  int failed = 0;
  {
    Kokkos::ScopeGuard const kokkos(argc, argv);
    failed = RUN_ALL_TESTS();
  }
  std::array<std::byte, 8> buffer{};
  auto const channel = world()->channel({{world()->rank(), buffer}}, {{world()->rank(), buffer}});
  MPI_Finalize();  // ranks and channels end later than MPI, which is no harm
  bool const after = are_refused("finalised");
  if (!before || !after) std::puts("mpi_ranks() does not say that MPI is not running");
  return failed != 0 || !before || !after ? 1 : 0;
}
