// Names and values that new CGNS files take, of either kind of mesh.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <cstddef>
#include <set>
#include <string>

namespace gridmorph::cgns {

/// The version that new files name in CGNSLibraryVersion_t.
inline constexpr float library_version = 4.0F;
/// The number of characters that a node's name may have.
inline constexpr std::size_t longest_name = 32;

/// Names of siblings must differ and be short: appends "_2", "_3", ... where a name is taken; then it is.
std::string unique_name(std::set<std::string>& taken, std::string const& wanted);

/// The BCType_t of a patch: its own, else that of its kind.
std::string bc_type_of(Patch const& patch);

}  // namespace gridmorph::cgns
