// Decomposed meshes of OpenFOAM: a polyMesh folder for each processor, joined to one mesh and taken apart again.
// Internal to io.
#pragma once

#include <gridmorph/io/foam/foam_lists.hpp>
#include <gridmorph/io/foam/foam_mesh.hpp>

#include <string>
#include <vector>

namespace gridmorph::foam {

struct JoinedLists {
  Lists lists;
  std::vector<Coordinates> points;          ///< of each part, as they are in its file
  std::vector<std::vector<Index32>> nodes;  ///< of each part: of its points -> of the joined mesh
};

/// The parts as one mesh: faces on patches of type `processor` lie inside of it, their nodes are those of both parts;
/// faces on patches of type `processorCyclic` are those of the cyclic patches that they refer to, in one order on both
/// sides. Points, cells and faces are numbered as pointProcAddressing, cellProcAddressing and faceProcAddressing say
/// where every part has them, else part by part. Throws MeshError for parts that are missing, that name one another for
/// other faces, or whose common nodes are more than 1e-6 of the mesh size apart. Cost O(n log n) in faces.
JoinedLists join(std::vector<Part> const& parts, std::string const& source);

/// Points of a part where those of the joined mesh are `morphed`: those that were equal stay equal, and all keep their
/// distance from one another.
Coordinates points_of_part(JoinedLists const& joined, std::size_t part, Coordinates const& morphed);

/// A number that lies at `own` where another one goes `from` -> `to`: equal numbers stay equal, and what does not move
/// keeps its bits.
inline double gone_along(double own, double from, double to) {
  return to == from ? own : own == from ? to : own + (to - from);
}

}  // namespace gridmorph::foam
