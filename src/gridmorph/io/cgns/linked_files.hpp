// Files that a mesh file refers to. Internal to io and the command.
#pragma once

#include <string>
#include <vector>

namespace gridmorph {

/// The other files that links of a CGNS file lead to, as far as they are there; none for other formats. Throws IoError for files that
/// cannot be read. Cost: reading the tree.
std::vector<std::string> linked_files(std::string const& path);

}  // namespace gridmorph
