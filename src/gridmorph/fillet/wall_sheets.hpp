// The layers of cells along two walls that meet in a corner, through all zones that they run through.
#pragma once

#include <gridmorph/boundary/links.hpp>

#include <span>
#include <vector>

namespace gridmorph {

/// The two walls of a corner.
enum class Wall { blade = 0, end_wall = 1 };

/// The first layers of cells off one face of a zone.
struct Sheet {
  int zone = -1;
  int axis = 0;
  int side = 0;  ///< 0: off the first plane of nodes along the axis, 1: off the last
  Wall wall = Wall::blade;
};

/// All sheets along the corners of two sets of patches.
struct WallSheets {
  std::vector<Sheet> all;                 ///< those of a zone one after another
  std::vector<std::vector<int>> of_zone;  ///< numbers of the sheets of each zone
};

/// Whether a patch of each meet along an edge of a zone, so that one block fills the corner between them. Where it is
/// only their layers that meet, in a mitre, several share it.
bool meet_in_corners(Mesh const& mesh, std::span<int const> blade, std::span<int const> end_wall);

/// Starts at every edge of a zone where a patch of `blade` meets a patch of `end_wall`, and carries the layers along
/// both through the 1-to-1 interfaces until they end on patches or in themselves. Coordinates are not touched.
///
/// Throws MeshError where the two never meet in one zone (walls that do not touch, or a corner that has blocks of its
/// own already), where a sheet comes to lie inside a zone, and where two sheets of one wall cross. Cost O(zones +
/// interfaces).
WallSheets find_wall_sheets(Mesh const& mesh, Links const& links, std::span<int const> blade,
                            std::span<int const> end_wall);

}  // namespace gridmorph
