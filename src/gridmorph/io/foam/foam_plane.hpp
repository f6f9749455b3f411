// Meshes of OpenFOAM that are one cell thick, between planes of type `empty` or `wedge`: plane meshes. Internal to io.
#pragma once

#include <gridmorph/io/foam/foam_lists.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gridmorph::foam {

/// Two planes that meet in an axis, and the one between them, across x, y or z as OpenFOAM asks for (wedgePolyPatch).
/// Unit vectors: across that plane, and in it away from and along the axis; cosine and sine are those of half the angle
/// between the planes.
struct Wedge {
  Vec3 origin, normal, radial, axis;
  double cosine = 1, sine = 0;

  /// A vector of the plane between, turned about the axis to the upper plane (side 1) or to the lower one (-1).
  [[nodiscard]] Vec3 turned(Vec3 const& v, int side) const;
  /// Where a point of the upper plane is in the plane between.
  [[nodiscard]] Vec3 between(Vec3 const& upper, bool on_axis) const;
};

struct Planes {
  /// Nodes of the upper plane (its faces look along x, y or z), ascending, each with the one of the lower plane that an
  /// edge joins it with; with itself where the planes of a wedge meet.
  std::vector<std::array<Index32, 2>> pairs;
  std::optional<Wedge> wedge;
};

/// The planes of a mesh whose nodes are all on planes of type `empty`, that are opposite one another along x, y or z
/// (1e-6 of its size), or of type `wedge`, that are copies of one another about their axis (1e-5, as points in text
/// have six digits), and whose cells are prisms and hexahedra between these; nothing for other meshes, `why_not` saying
/// what keeps a mesh with such planes from being one.
std::optional<Planes> find_planes(Lists const& lists, std::string& why_not);

/// The upper plane of a mesh, or the one between those of a wedge, as a mesh of dimension 2: triangles and
/// quadrilaterals for cells, edges for faces; node n is that of pairs[n]. Edges on the axis of a wedge are a patch on
/// which nodes slide.
Mesh upper_plane(Mesh const& mesh, Planes const& planes, Lists const& lists);

/// Coordinates of all nodes where those of that mesh are `morphed`: both planes move alike, along themselves. Nodes on
/// the axis of a wedge stay on it.
Coordinates both_planes(Coordinates const& all, Planes const& planes, Coordinates const& morphed);

}  // namespace gridmorph::foam
