// The old nodes around a corner, by station, and what is asked for there.
#pragma once

#include <gridmorph/fillet/corner_frame.hpp>
#include <gridmorph/fillet/fillet.hpp>
#include <gridmorph/geometry/arc_curve.hpp>

#include <array>
#include <vector>

namespace gridmorph {

/// Per station of a corner: whether it lies on both walls, so that it gets a fillet.
std::vector<char> filled_stations(Mesh const& mesh, CornerFrame const& corner, FilletOptions const& options);

/// The node at a station. `off`: cells to either wall.
inline Vec3 node_at(Mesh const& mesh, CornerFrame const& corner, int station, std::array<int, 2> off) {
  return mesh.coordinates[corner.zone->node(corner.index(station, off))];
}

/// The nodes along one wall, from the corner to `last` cells from it.
std::vector<Vec3> line_points(Mesh const& mesh, CornerFrame const& corner, int station, int wall, int last);

/// A line of old nodes as a curve. Throws MeshError where two neighbours coincide (poles).
ArcCurve curve_through(std::vector<Vec3> points);

/// A wall's normal across the corner and the wall's own line, unit: lines off the other wall may lean.
Vec3 wall_normal(Mesh const& mesh, CornerFrame const& corner, int station, int wall);

/// How many cells of a wall's line may be changed: to the other side of the zone, or half the way to the corner there.
int last_node(WallSheets const& sheets, CornerFrame const& corner, int wall);

/// The radius of a fillet at a node. Throws MotionError for what is no length.
double checked_radius(FilletOptions const& options, Vec3 const& node);

}  // namespace gridmorph
