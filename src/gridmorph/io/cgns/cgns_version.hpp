// The CGNS library that reads and writes the files.
#pragma once

#include <string>

namespace gridmorph {

/// The version of the CGNS library: "4.3.0".
std::string cgns_version();

}  // namespace gridmorph
