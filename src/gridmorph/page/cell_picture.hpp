// One cell and those around it, in a parallel view, as a drawing.
#pragma once

#include <gridmorph/page/picture_mesh.hpp>

#include <string>

namespace gridmorph::page {

struct CellDrawing {
  std::string baseline, morphed;  ///< SVG that takes its colours from the page
  double stretch = 1;             ///< of the shortest direction of the cell against its longest; 1: true to scale
};

/// Both from one direction and to one scale. A thin cell is stretched along its principal axes, by one linear map for
/// both drawings: that keeps the sign of every Jacobian and all ratios of determinants, not angles. Cost: cells around
/// this one.
CellDrawing draw_cell(PictureMesh const& mesh, Index cell, Coordinates const& baseline, Coordinates const& morphed);

}  // namespace gridmorph::page
