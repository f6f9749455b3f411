// Checks made before the CGNS library sees a file, because it trusts what it reads.
#pragma once

#include <gridmorph/io/mesh_io.hpp>

#include <string>

namespace gridmorph::cgns {

/// Throws IoError unless the file exists, is readable and begins as a CGNS file does; ADF files are walked node by
/// node.
FileFormat check_file(std::string const& path);

/// Whether the file begins as a CGNS file does. Throws IoError unless it exists and can be read.
bool is_cgns(std::string const& path);

/// Walks an ADF file: every pointer inside the file, every tag in place, no loops, data as long as its dimensions say.
/// Throws IoError where not. The files that its links lead to are walked too. Cost: reads the node headers only.
void check_adf(std::string const& path);

}  // namespace gridmorph::cgns
