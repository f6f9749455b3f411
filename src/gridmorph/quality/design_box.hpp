// Is every mesh of a whole box of designs valid, not those alone that somebody made?
#pragma once

#include <gridmorph/quality/indexed_mesh.hpp>

#include <limits>
#include <span>
#include <vector>

namespace gridmorph {

/// Meshes that are linear in n parameters: x(t) = centre + sum of t_i modes[i], all |t_i| <= 1 the box.
struct DesignModes {
  Coordinates centre;
  std::vector<Coordinates> modes;  ///< what a parameter adds to the centre at the end of its range [length]
  double deviation = 0;            ///< by how much nodes of a mesh may lie beside that sum [length]
};

struct DesignBoxOptions {
  double limit = 1;         ///< the largest box that is of interest, of what is asked for
  double tolerance = 0.02;  ///< how close `certified` and `broken` are to come to one another, where they can
  int most_pieces = 2000;   ///< that a cell and its box are cut into before it is left undecided
};

/// What holds of a box of designs. Sizes are shares of the box that was asked for: all |t_i| <= size.
struct DesignBox {
  double certified = 0;  ///< every cell is valid everywhere in it in every design up to here
  /// The smallest size known of a design that breaks a cell, as certify() says; infinite where none was found. Between
  /// `certified` and this nothing is known.
  double broken = std::numeric_limits<double>::infinity();
  std::vector<double> design;  ///< t of it, (n)
  /// The cell that it breaks; where there is none the cell that limits `certified`, if any does.
  int zone = -1;
  Index3 cell{0, 0, 0};
  Index cells = 0;  ///< that were looked at
  /// Of these: not valid, or without volume, in the mesh itself, and left out where they are not at the centre. Cells
  /// that are sound in the mesh and not at the centre are broken there: `certified` and `broken` are 0.
  Index negative = 0, flat = 0;
  Index by_slopes = 0;  ///< that norms alone did not show to be valid
  Index searched = 0;   ///< of which slopes neither did

  [[nodiscard]] bool holds(double size = 1) const { return certified >= size; }
};

/// The largest box of designs in which no cell is inverted anywhere.
///
/// The Bezier coefficients of a cell's Jacobian (kernels/jacobian_bounds.hpp) are cubic in t. Three stages, each for
/// the cells that the one before leaves open: norms, in the cell's own measure, so that a cell a million times longer
/// than high is measured like a cube; exact slopes, what is of second and third order by norms
/// (kernels/design_cell.hpp); branch and bound over the corners of the box and, where that does not tell, over parts of
/// box and cell (detail/design_search.hpp). Rounding of coordinates and of arithmetic, and `deviation`, are on the safe
/// side. Deterministic, whatever the number of threads.
///
/// Throws ConfigError: arrays of other lengths than the mesh has nodes, elements of second order, polyhedra. Cost per
/// cell: 1100 flops and 300 for each mode, 1300 more for each mode where slopes are wanted; milliseconds for each cell
/// that is searched. Memory: 8 bytes per cell.
DesignBox certify_designs(HostInstance const& host, IndexedMesh const& mesh, DesignModes const& designs,
                          DesignBoxOptions const& options = {});

}  // namespace gridmorph
