// The mesh whose corners between two walls have no blocks of their own, all but its coordinates, and the layers of
// cells along those walls that it is split by.
#pragma once

#include <gridmorph/boundary/links.hpp>

#include <array>
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

/// How many layers each wall's sheets have in the mesh as it is, and how many they get.
struct SheetLayers {
  std::array<int, 2> old{0, 0};  ///< by Wall
  int made = 0;                  ///< of both: they meet layer by layer
};

/// A zone of the new mesh: a box of nodes of an old one, with its layers counted anew where it is a sheet.
struct SplitZone {
  int zone = -1;   ///< of the old mesh
  IndexRange box;  ///< old nodes
  int sheet = -1;  ///< in WallSheets::all; -1: what is left of the zone

  friend bool operator==(SplitZone const&, SplitZone const&) = default;
};

struct SplitMesh {
  Mesh mesh;                     ///< no coordinates
  std::vector<SplitZone> zones;  ///< per Mesh::zones
  std::vector<int> patches;      ///< per Mesh::patches, that of the old mesh
};

/// Takes the blocks out of all corners in which the two walls meet, and joins what they leave open: what was the far
/// side of such a block along the blade and the one along the end wall become one face, node n off the blade on node n
/// off the end wall. Seen across a corner,
///
///         blade                       blade
///         | b | core                  | b | core
///         |---+-----        to        |   o------
///         | x | e                     | /   e
///         +---------end wall          +----------- end wall,
///
/// so three blocks meet in the line o instead of four, and the walls in a line where each of two blocks takes half of
/// the angle: one that may open to 180 degrees. Zones without sheets stay whole; others fall into what is left of them
/// (which keeps the name), one zone per sheet (NAME_blade, NAME_wall; numbered where there are two). Patches and
/// interfaces go on, in pieces where zones fall into several; each piece in one direction, as the file has them.
///
/// Throws MeshError for zones with too few cells, and where interfaces cut sheets lengthwise. Cost O(zones + patches +
/// interfaces).
SplitMesh split_corners(Mesh const& mesh, WallSheets const& sheets, SheetLayers const& layers);

}  // namespace gridmorph
