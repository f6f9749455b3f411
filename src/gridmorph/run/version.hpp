// What this program is made of.
#pragma once

#include <string>

namespace gridmorph::cli {

/// Version and commit of gridmorph, version and backends of Kokkos, version of CGNS, compiler: one line each.
std::string version_text();

}  // namespace gridmorph::cli
