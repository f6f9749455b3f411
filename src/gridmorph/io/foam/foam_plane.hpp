// Plane meshes of OpenFOAM: one cell thick, their two planes of type `empty`. Internal to io.
#pragma once

#include <gridmorph/io/foam/foam_file.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gridmorph::foam {

/// Of the fan of triangles from its first node, twice as long as its area.
Vec3 face_normal(std::span<Index32 const> nodes, Coordinates const& coordinates);

/// Nodes of the upper plane (its faces look along x, y or z), ascending, each with the one of the lower plane that an edge joins it with.
using PlanePairs = std::vector<std::array<Index32, 2>>;

/// The pairs of a mesh whose nodes are all on planes of type `empty`, that are opposite one another along x, y or z (1e-6 of its size), and whose cells are
/// prisms and hexahedra between these; nothing for other meshes, `why_not` saying what keeps a mesh with such planes from being one.
std::optional<PlanePairs> plane_pairs(std::vector<BoundaryEntry> const& boundary, CsrGraph const& faces,
                                      Coordinates const& coordinates, double size, std::string& why_not);

/// The upper plane of a mesh as a mesh of dimension 2: triangles and quadrilaterals for cells, edges for faces; node n is that of pairs[n].
/// `owner`: cell of each face.
Mesh upper_plane(Mesh const& mesh, PlanePairs const& pairs, CsrGraph const& faces, std::vector<Index32> const& owner);

/// Coordinates of all nodes where those of the upper plane are `morphed`: both planes move alike, along themselves.
Coordinates both_planes(Coordinates const& all, PlanePairs const& pairs, Coordinates const& morphed);

}  // namespace gridmorph::foam
