// The coordinates of a mesh whose nodes many processes have, on the one that plans.
#pragma once

#include <gridmorph/core/ranks.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <memory>
#include <span>

namespace gridmorph {

/// All coordinates of a mesh of blocks on rank 0, none elsewhere. Collective. zones: the same on all ranks, its own
/// coordinates are not read. boxes: those that this rank has, which may overlap; coordinates: of their nodes, box after
/// box, i fastest. Throws MeshError, on all ranks: a node that no rank has, a box beyond its zone, coordinates that are
/// not those of the boxes. Cost: 24 bytes per node sent, and on rank 0 three times as many held.
Coordinates gather_coordinates(std::shared_ptr<Ranks const> const& ranks, BoundaryMesh const& zones,
                               std::span<NodeBox const> boxes, Coordinates const& coordinates);

}  // namespace gridmorph
