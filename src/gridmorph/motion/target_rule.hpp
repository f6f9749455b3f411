// The rule `target`: nodes move onto another surface. Plain arrays, so that a solver can give them without files.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// A structured piece of a surface: extent[0] * extent[1] points, direction 0 fastest.
struct TargetGrid {
  std::string name;  ///< for messages
  std::array<int, 2> extent{0, 0};
  std::vector<Vec3> points;
};

/// One profile of a blade or wing: points once around it, or from end to end, in any direction and from any start.
struct TargetSection {
  std::string name;  ///< for messages
  std::vector<Vec3> points;
};

/// The surface to move to; lengths in units of the mesh. Any of the four may be empty.
struct TargetGeometry {
  std::vector<TargetGrid> grids;
  std::vector<Vec3> points;                   ///< of the triangles
  std::vector<std::array<int, 3>> triangles;  ///< numbers in points; their order around says which side is out
  std::vector<TargetSection> sections;        ///< in any order along the span
  std::vector<Vec3> nodes;                    ///< new positions of the patches' nodes, patch after patch, i fastest
};

/// Nodes that move to a target surface.
struct TargetRule {
  /// How a node finds its place on the target.
  enum class Mapping {
    automatic,   ///< nodes where `nodes` is given or every patch has its grid of the same size; else sections where
                 ///< there are some; else projection
    nodes,       ///< node for node: the displacement is the difference, bit for bit
    sections,    ///< the same fraction of the arc length around the section, the same span fraction
    projection,  ///< edges to edges by arc length, the rest to the closest point
  };
  /// Which positions along the span belong together.
  enum class SpanMatch {
    fraction,  ///< first section of the mesh to first section of the target, last to last
    position   ///< the same coordinate along the span
  };

  std::shared_ptr<TargetGeometry const> target;
  std::string description{};  ///< for reports: "wing.stl"
  Mapping mapping = Mapping::automatic;
  /// The direction of the span for the mapping by sections; absent: away from Motion::axis (the radius).
  std::optional<Vec3> span{};
  SpanMatch span_match = SpanMatch::fraction;
  /// The direction downstream for the mapping by sections, to tell the leading from the trailing edge.
  Vec3 flow{1, 0, 0};
  /// The angle above which an edge whose facets turn there is an edge of the surface, for the mapping by projection.
  double crease_angle_deg = 40;
  /// The share of the way from the baseline to the target that nodes go, straight.
  double share = 1;
};

}  // namespace gridmorph
