// Which moving walls turn as a whole: bodies that stand free, or on planes that they slide along.
#pragma once

#include <gridmorph/motion/boundary_conditions.hpp>

#include <cstdint>
#include <vector>

namespace gridmorph {

/// Walls that touch.
struct WallBody {
  std::vector<Index32> faces;  ///< in UnstructuredTopology::boundary
  std::vector<Index32> nodes;  ///< representatives, ascending
  Vec3 axis;                   ///< unit: the only one about which it may turn; zero: any
  /// Whether it ends on boundaries that could not turn with it: given ones, periodic ones, slip surfaces that are no
  /// planes or planes in two directions, free ones.
  bool attached = false;
};

/// Boundary faces that do not move with the driving walls.
struct RestingFaces {
  CsrGraph faces;                      ///< given, periodic, slipping; representatives
  std::vector<Index32> slides_on;      ///< per face: number of the slip surface, -1: given or periodic
  std::vector<std::uint8_t> given;     ///< per face: whether all its nodes are displaced by a rule
  std::vector<std::uint8_t> periodic;  ///< per face: whether it is of a free periodic connection
};

struct WallBodies {
  std::vector<WallBody> bodies;
  RestingFaces resting;
};

/// driving_faces: those of moving walls. plane_normal: of a 2-D mesh, about which everything turns there. Serial,
/// linear.
WallBodies find_wall_bodies(Mesh const& mesh, UnstructuredTopology const& topology,
                            BoundaryFacePatches const& face_patches, NodeGraph const& graph,
                            BoundaryConditions const& boundary, std::vector<Index32> const& driving_faces,
                            std::vector<SlipSurface> const& surfaces, Vec3 const& plane_normal);

/// Whether two unit vectors point along one line.
bool are_parallel(Vec3 const& a, Vec3 const& b);

}  // namespace gridmorph
