# What each part needs, found once and early, with a sentence the user can act on when it is missing.
include(gridmorphCheckKokkos)

# A parent project may have made Kokkos::kokkos already.
if(NOT TARGET Kokkos::kokkos)
  # No version here: Kokkos' version file refuses every other major version. The check below looks at it.
  find_package(Kokkos CONFIG QUIET)
endif()
gridmorph_kokkos_problem(problem)
if(problem)
  message(FATAL_ERROR "${problem}")
endif()

if(GRIDMORPH_ENABLE_IO)
  find_package(CGNS 3.4 MODULE REQUIRED)
  if(CGNS_VERSION VERSION_LESS 4)
    message(WARNING
      "CGNS ${CGNS_VERSION} cannot open files that were written with CGNS 4, and writes CGNS 3 files. "
      "Name a CGNS 4 with -DCGNS_ROOT=<prefix>, or take the one that scripts/install-dependencies provides.")
  endif()
endif()

# The C++ bindings that MPI had until its version 3 are another library, which no header of ours needs and newer MPIs do not have.
set(MPI_CXX_SKIP_MPICXX ON)

# find_package with a sentence about what a missing package is for.
macro(gridmorph_require option purpose name)
  if(${option})
    find_package(${name} QUIET ${ARGN})
    if(NOT ${name}_FOUND)
      message(FATAL_ERROR
        "${purpose} need ${name}, which CMake does not find. Install it (scripts/install-dependencies does), name its "
        "prefix in CMAKE_PREFIX_PATH, or build without: -D${option}=OFF.")
    endif()
  endif()
endmacro()
gridmorph_require(GRIDMORPH_ENABLE_CLI "Case files and the gridmorph command" CLI11 CONFIG)
gridmorph_require(GRIDMORPH_ENABLE_CLI "Case files and the gridmorph command" toml11 CONFIG)
gridmorph_require(GRIDMORPH_ENABLE_CLI "Case files and the gridmorph command" nlohmann_json CONFIG)
gridmorph_require(GRIDMORPH_ENABLE_CLI "Case files and the gridmorph command" muparser CONFIG)
gridmorph_require(GRIDMORPH_ENABLE_CLI "Case files and the gridmorph command" nanoflann CONFIG)
gridmorph_require(GRIDMORPH_ENABLE_CLI "Case files and the gridmorph command" fmt CONFIG)
gridmorph_require(GRIDMORPH_ENABLE_MPI "Ranks of MPI (scripts/install-dependencies --mpi)" MPI COMPONENTS CXX)
gridmorph_require(GRIDMORPH_ENABLE_TESTS "The tests" GTest)
gridmorph_require(GRIDMORPH_ENABLE_BENCHMARKS "The benchmarks" benchmark CONFIG)
