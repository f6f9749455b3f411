// Families of a CGNS file: names, trees of names, and the boundary condition type a family stands for.
#pragma once

#include <gridmorph/io/cgns/cgns_file.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::cgns {

/// Names of all families of a base; members of a family tree as "Parent/Child".
std::vector<std::string> family_names(Node const& base);

/// FamilyName_t first, then AdditionalFamilyName_t, of a BC_t or connection node; with the names that these families
/// have themselves, FamilyName_t of a Family_t (SIDS, "Family Data Structure Definition"): before them what is no
/// family of the base (Gmsh writes its physical groups so), behind them families above them.
std::vector<std::string> families_of(File const& file, Node const& base, Node const& owner);

/// The BCType_t that the first of `names` that is a family stands for through its FamilyBC_t, or that of the nearest
/// family above it in its tree. Names may be paths, with or without the base in front.
std::optional<std::string> family_bc_type(File const& file, Node const& tree, Node const& base,
                                          std::vector<std::string> const& names);

/// The group a CGNS BCType_t name belongs to.
PatchKind patch_kind(std::string_view bc_type);

/// Type and kind of a patch by its BC_t node, or by its families where that says so; what there is to say where these
/// do not know it, else empty.
std::string take_bc_type(File const& file, Node const& tree, Node const& base, Node const& bc, Patch& patch);

}  // namespace gridmorph::cgns
