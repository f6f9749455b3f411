// Regions inside the domain that motion rules address by name, as they do patches: cells around a wake or a shock,
// refinement that is to follow a wall, parts that stay as they are, grid surfaces. All their nodes are given a
// displacement by the rule.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

struct ShockSearch;  // io/flow_solution and motion/shock: a flow solution, and what of it is a shock

struct InnerRegion {
  std::string name;                ///< what rules call it: neither the name nor the family of a patch
  std::vector<std::string> zones;  ///< names of zones, in a mesh of elements of subsets too, globs; empty: all
  /// Blocks: nodes of the one zone that `zones` names; extent 1 along one axis: a grid surface.
  std::optional<IndexRange> nodes;
  /// Whether a place lies in the region; nothing: everything in the zones does.
  std::function<bool(Vec3 const& place)> holds;
  /// The place of a wake, behind the trailing edges of blades or wings; locate_wakes() makes `holds` of it.
  struct Wake {
    std::vector<std::string> of;        ///< patches of whole blades or wings
    bool of_wing = false;               ///< sections of a wing, not of blades about Motion::axis
    std::optional<Vec3> span{};         ///< wing: from root to tip
    Vec3 flow{1, 0, 0};                 ///< wing
    std::optional<double> angle_rad{};  ///< of the wake, from the axis (wing: flow) towards theta (span x flow);
                                        ///< absent: that of the camber line
    double length = 0;                  ///< behind the trailing edge
    double width = 0;
  };
  std::optional<Wake> wake{};
  /// Whether each cell of the mesh lies in the region, beside what `holds` says: blocks zone after zone, i fastest;
  /// elements by their numbers. Nothing: places alone say.
  std::shared_ptr<std::vector<std::uint8_t> const> cells{};
  /// Where a flow solution has a shock; whoever reads the solution makes `cells` of it (shock_cells.hpp).
  std::shared_ptr<ShockSearch const> shock{};
  std::string where;           ///< "case.toml:14", for messages
  bool only_measured = false;  ///< has a row of its own in reports of quality, and is no part of the motion
};

/// Boxes of cells that hold all cells c of a zone with `inside[c]`, i fastest, as ranges of nodes: where no cell of a
/// whole layer is inside, the layer separates two boxes. Cost O(cells) for each time a box is divided.
std::vector<IndexRange> boxes_of_cells(Index3 const& cells, std::vector<char> const& inside);

/// Whether a patch is a region of cells, not of a surface.
inline bool is_box(Patch const& patch) {
  return patch.kind == PatchKind::region && patch.range.extent(0) > 1 && patch.range.extent(1) > 1 &&
         patch.range.extent(2) > 1;
}

/// Appends a patch of kind `region` for each box of each region of a mesh of blocks, and says in a note of the mesh
/// what it holds. Cells are inside where the mean of their corners is; as plans are made of boxes, some around them may
/// come along. Throws MotionError naming every region without cells, whose name is taken, or whose zones or nodes there
/// are not. Cost: a look at each cell of the zones that regions name without nodes.
void add_regions(Mesh& mesh, std::span<InnerRegion const> regions);

/// Whether each cell of a mesh of blocks, zone after zone, i fastest, lies in the zones of the region and where it
/// holds (its middle does); none where a zone is not there. Cost: a look at each cell.
std::vector<std::uint8_t> cells_of_region(Mesh const& mesh, InnerRegion const& region);

/// Whether each element of a mesh of elements lies in the region (its middle does); none of a subset that has faces
/// alone. Throws MotionError as add_regions() does, for regions without elements where they are only measured.
std::vector<std::uint8_t> elements_of_region(Mesh const& mesh, InnerRegion const& region);

/// The regions of a mesh of elements as patches: for each one of kind `region`, which lists all nodes of the elements
/// whose mean of the corners is inside, and of faces of subsets likewise; appends a note for each. Throws MotionError
/// as add_regions() does. Cost: a look at each element of what regions name.
std::vector<Patch> regions_of_elements(Mesh const& mesh, std::span<InnerRegion const> regions,
                                       std::vector<std::string>& notes);

}  // namespace gridmorph
