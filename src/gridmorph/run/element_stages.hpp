// [output] stages of a mesh of elements: wrap and background mesh.
#pragma once

#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/plan/planned_elements.hpp>

#include <array>
#include <filesystem>

namespace gridmorph::cli {

/// The files that write_element_stages() may put into its folder.
inline constexpr std::array stage_names{"regions.cgns", "wrap.cgns", "background.cgns", "background_morphed.cgns"};

/// Writes the morphed mesh with its regions (0 near, 1 partially wrapped, 2 far), layers and displacements; the wrap;
/// the background mesh before and after, as CGNS files, whatever the format of the mesh. Of several parts the first one
/// with moving walls. morpher: what made `morphed` last.
void write_element_stages(std::filesystem::path const& folder, Mesh const& mesh, PlannedElements const& planned,
                          Morpher<Kokkos::DefaultHostExecutionSpace> const& morpher, Coordinates const& morphed);

}  // namespace gridmorph::cli
