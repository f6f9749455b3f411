// [output] stages of a mesh of blocks: the mesh after each stage.
#pragma once

#include <gridmorph/plan/plan.hpp>

#include <filesystem>
#include <span>

namespace gridmorph::cli {

/// The list of the stages: their numbers, names, files and chains.
inline constexpr char const* stage_list_name = "stages.json";
/// Whether a file is named like the meshes that write_block_stages() writes: stage_00_boundary.cgns.
bool is_stage_of_blocks(std::filesystem::path const& path);

/// Makes the folder that stages of either kind of mesh go to. Throws MachineError.
void make_stage_folder(std::filesystem::path const& folder);

/// Writes the mesh after every stage of the plan (stages_of()) and, where guards moved nodes on from there, `morphed`
/// as the last one, as CGNS files stage_NN_NAME.cgns, whatever the format of the mesh; and stages.json. In every cell
/// stand the stage in which it has its turn, its chain and the direction of that (StagesOfCells), at the nodes their
/// displacement so far. Meshes of stages that other runs left there, and this one does not have, are removed. mesh: as
/// it was read.
void write_block_stages(std::filesystem::path const& folder, Mesh const& mesh, Plan const& plan,
                        std::span<Vec3 const> displacement, Coordinates const& morphed);

}  // namespace gridmorph::cli
