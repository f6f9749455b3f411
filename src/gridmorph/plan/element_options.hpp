// What a user can choose about the morph of a mesh of elements, beside the rest of PlanOptions. Plain values with their
// defaults.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <memory>
#include <string>
#include <vector>

namespace gridmorph {

struct Background;

/// What carries the motion of the walls between the ends of their columns and the wrap.
enum class NearFieldMethod {
  /// Least squares where all moving walls are bodies that turn freely amid other boundaries and nothing is periodic,
  /// else the lattice.
  automatic,
  lattice,  ///< its average on an even lattice, and from layer to layer what that misses at the columns
  layers,   ///< from layer to layer the motion itself: displacement and turn
  /// The affine motion that fits the walls around best, at the scale of their distance, for all nodes of the mesh; amid
  /// a background mesh of the user's as `lattice`.
  least_squares
};

/// How much each node of the layers before counts when displacements pass on.
enum class LayerWeight {
  uniform,           ///< 1
  inverse_distance,  ///< 1 / length of the edge
  quality,           ///< inverse distance times the mean quality of the elements around the edge's two ends
  curvature          ///< inverse distance / (1 + d k)^2: d distance from the wall, k curvature of the wall there
};

struct ElementOptions {
  /// Selectors of the walls that drive the near field; empty: every patch with an explicit rule other than `fixed` that
  /// is no inflow, outflow, farfield or symmetry.
  std::vector<std::string> walls;
  NearFieldMethod method = NearFieldMethod::automatic;
  LayerWeight weight = LayerWeight::inverse_distance;
  double offset = 0;  ///< of the wrap from the moving walls [length]; 0: suggest_offset()
  double motion =
      -1;  ///< size of the displacements to come [length], for suggest_offset(); negative: what the rules give now
  /// A displacement of the boundary nodes (BoundaryConditions::known) like which those to come bend and stretch walls,
  /// by another factor; empty: not known. Not looked at where the displacement is.
  std::vector<Vec3> shape;
  /// Cells of the wrap's lattice along the longest extent of the walls; few are best (WrapOptions::resolution).
  int resolution = 4;
  /// A tube with an O-type background mesh around it instead, where one fits (WrapOptions::tube); not by least squares.
  bool tube = false;
  int cells = 4;  ///< of the background mesh along each cell of the wrap's lattice
  /// A background mesh of the user's instead of one around a wrap made here, which `offset`, `resolution`, `tube` and
  /// `cells` are for; its hole is the wrap.
  std::shared_ptr<Background const> background;
};

}  // namespace gridmorph
