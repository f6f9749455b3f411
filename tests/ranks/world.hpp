// The ranks that tests run on. Their sources are in two programs: test_ranks is one process without MPI, of test_mpi
// mpirun starts several, on which all tests run side by side. A test that fails before its last collective call leaves
// the others waiting, until ctest ends them.
#pragma once

#include <gridmorph/core/ranks.hpp>

#include <memory>

namespace gridmorph::test {

/// All ranks of the program.
std::shared_ptr<Ranks const> world();

}  // namespace gridmorph::test
