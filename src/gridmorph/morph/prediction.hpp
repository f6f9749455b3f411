// What a morph would make of cells, known before anything moves: of some of the cells, at a small share of a morph's
// cost.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/quality/quality.hpp>

#include <array>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

class MorphPlan;

struct PredictionOptions {
  /// Along each direction of each piece between cuts one cell in so many is looked at, and the first and the last one;
  /// 1: all cells. 0: the smallest power of two from 4 on that keeps at most 40,000 nodes, or 64.
  int every = 0;
};

/// Worst cells among those looked at.
struct PredictedCells {
  Index cells = 0;
  Index inverted = 0;         ///< a corner's Jacobian would be negative
  CellValue scaled_jacobian;  ///< smallest, over the corners of a cell, of J / product of the lengths of the three
                              ///< edges there
  double scaled_jacobian_before = 1;  ///< of that cell in the baseline
  CellValue kept;                     ///< smallest share of its scaled Jacobian that a cell keeps, at most 1
  CellValue determinant;              ///< smallest 3x3x3
  CellValue angle_deg{180};           ///< smallest
  /// Largest relative displacement along i, j and k of the zones (paper, section 3.2): Measure::relative_displacement.
  std::array<CellValue, 3> relative_displacement{CellValue{0}, CellValue{0}, CellValue{0}};
};

struct PredictedChain {
  std::string stage, chain;  ///< as describe(Plan) names them
  PredictedCells cells;
};

struct Prediction {
  int every = 1;  ///< PredictionOptions::every, where it was 0 what was taken
  PredictedCells all;
  std::vector<PredictedChain> chains;  ///< with cells looked at, that of the smallest scaled Jacobian first
};

/// What Morpher::positions() would make of a mesh of blocks. The plan is made for the sampled grid lines alone, with
/// arc lengths of the whole ones, and applied to them. boundary: one vector for each of MorphPlan::boundary_nodes().
///
/// Of the cells looked at it is what comes out, to round-off, but for two things that are linear between sampled nodes:
/// residuals of known sides whose line parameters differ from those of the line (kernels/side_correction.hpp), and the
/// tangents of walls whose near field turns. Other cells can come out worse. Cost: about 12 / every^2 of the mesh read,
/// and a plan and a morph of about 8 / every^3 of it; milliseconds. Deterministic. Fences. Throws ConfigError:
/// elements, or a boundary of another size.
Prediction predict(HostInstance const& host, MorphPlan const& plan, std::span<Vec3 const> boundary,
                   PredictionOptions const& options = {});

}  // namespace gridmorph
