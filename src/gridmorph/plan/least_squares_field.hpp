// How walls move, carried into the volume by moving least squares.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/plan/interpolation_operator.hpp>
#include <gridmorph/plan/layers.hpp>

#include <functional>
#include <vector>

namespace gridmorph {

/// The affine motion that fits best, at each node, what the wall nodes around do at the scale of its distance from them
/// (kernels/least_squares.hpp has the formulas). Far groups of wall nodes count as one.
struct LeastSquaresField {
  InterpolationOperator leaves;  ///< sources, by their numbers in the list, then those of each image -> groups
  LayerRows groups;              ///< groups -> groups, from the smallest on
  Index32 n_groups = 0;
  InterpolationOperator nodes;         ///< groups -> nodes of the mesh
  std::vector<RigidTransform> images;  ///< the walls as they come again behind periodic boundaries
  Vec3 origin;                         ///< that moments refer to
  // Per row of `nodes`, see kernels::LeastSquaresTable.
  std::vector<Vec3> lean;
  std::vector<double> level, room;

  [[nodiscard]] bool empty() const { return n_groups == 0; }
};

/// What the field is made of: wall nodes, then nodes of other boundaries that rules move.
struct FieldSources {
  std::vector<Index32> const& nodes;
  std::size_t n_walls;
  std::vector<double> area;              ///< of each
  std::vector<RigidTransform> images{};  ///< that they come again at
};

/// A node that reads the field, and its distance from the walls.
struct FieldReader {
  Index32 node = -1;
  double distance = 0;
};

/// Whether walls as wholes turn by nothing in what the field carries, as bodies that turn freely do; otherwise turns
/// fade with the distance, in shares of the size of the walls, since they would carry far nodes with them.
enum class MeanTurn { taken_off, left };

/// The field at nodes; d is their distance from the nearest source. Cost O(n log n) in the sources, and per reader
/// about 40 groups opened in the plane and 100 in space; on all threads of the instance, whose number does not matter.
LeastSquaresField make_least_squares_field(HostInstance const& host, Coordinates const& coordinates,
                                           FieldSources const& of, MeanTurn turns,
                                           std::vector<FieldReader> const& readers);

}  // namespace gridmorph
