// The patches that a fillet's arcs become: with a family of their own, which goes with the blade.
#pragma once

#include <gridmorph/fillet/fillet.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace gridmorph {

/// Faces of a sheet's wall next to a corner that have nodes on the arc: so many along the wall from the new corner,
/// beside these stations.
struct ArcFaces {
  std::size_t corner = 0;
  int wall = 0;
  int faces = 0;
  int first_station = 0, last_station = 0;
};

/// Takes the faces on arcs out of the patches of blade and end wall: the rest of a patch stays in up to four pieces.
/// Their family is that of the blade with `_fillet` behind it, and they keep the blade's as another one, so that rules
/// that name the blade name them too; walls without a family get one of their patch's name. A face that has nodes on
/// the arc and others beyond counts as the arc's, so that the end wall's own nodes are all on the end wall. Cost
/// O(patches).
void separate_arcs(Mesh const& before, FilletOptions const& options, WallSheets const& sheets,
                   SheetLayers const& layers, std::span<ArcFaces const> arcs, SplitMesh& split);

/// Makes the arcs patches of their own in a mesh of elements: faces that have a node with `on_arc` set.
void separate_arcs(FilletOptions const& options, std::span<std::uint8_t const> on_arc, Mesh& mesh);

}  // namespace gridmorph
