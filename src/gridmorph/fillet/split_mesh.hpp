// The mesh whose corners between two walls have no blocks of their own, all but its coordinates.
#pragma once

#include <gridmorph/fillet/wall_sheets.hpp>

#include <array>
#include <vector>

namespace gridmorph {

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
