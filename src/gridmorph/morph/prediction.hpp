// What a morph would make of the cells of a mesh, blocks or elements, known before it is made: the worst of some of
// them.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/quality/quality.hpp>

#include <array>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

class IndexedMesh;
class MorphPlan;

struct PredictionOptions {
  /// One cell in so many is looked at; 1: all. Blocks: along each direction of each piece between cuts, and the first
  /// and the last one; 0: the smallest power of two from 4 on that keeps at most 40,000 nodes, or 64. Elements: in the
  /// order of the mesh (along a Hilbert curve); 0: the smallest power of two that leaves at most 20,000.
  int every = 0;
  /// Elements: those with the largest relative displacements that are looked at as well.
  Index most_strained = 20'000;
};

/// Worst cells among those looked at. Cells may be elements: CellValue::cell is then the place of one among the
/// elements of its zone, 0, 0; polyhedra are not looked at.
struct PredictedCells {
  Index cells = 0;
  Index inverted = 0;  ///< a corner's Jacobian would be negative; elements: and is not in the baseline
  /// Blocks: smallest, over the corners of a cell, of J / product of the lengths of the three edges there.
  CellValue scaled_jacobian;
  double scaled_jacobian_before = 1;  ///< of that cell in the baseline
  CellValue determinant;              ///< smallest 3x3x3
  double determinant_before = 1;      ///< of that cell in the baseline
  /// Smallest share, at most 1, that a cell keeps of its scaled Jacobian, an element of its determinant.
  CellValue kept;
  CellValue angle_deg{180};  ///< smallest
  /// Largest relative displacement (Measure::relative_displacement). Blocks: along i, j and k of the zones (paper,
  /// section 3.2). Elements: in the first place, of all elements, looked at or not.
  std::array<CellValue, 3> relative_displacement{CellValue{0}, CellValue{0}, CellValue{0}};
};

/// The cells that one chain moves, or the elements of one region.
struct PredictedGroup {
  std::string stage;  ///< blocks: as describe(Plan) names it; empty of elements
  std::string name;   ///< the chain, as describe(Plan) names it; the region, as "near field"
  PredictedCells cells;
};

struct Prediction {
  Index n_cells = 0;  ///< of the mesh
  int every = 1;      ///< PredictionOptions::every, where it was 0 what was taken
  PredictedCells all;
  /// With cells looked at, the worst first: that of the smallest scaled Jacobian, of elements of the smallest share
  /// kept.
  std::vector<PredictedGroup> groups;
};

/// What Morpher::positions() would make of a mesh whose plan this is. boundary: one vector for each of
/// MorphPlan::boundary_nodes(). Other cells than those looked at can come out worse. Deterministic, the same for any
/// number of threads. Fences. Throws ConfigError: a plan of another mesh, or a boundary of another size.
///
/// Blocks: the plan is made for the sampled grid lines alone, with arc lengths of the whole ones, and applied to them;
/// nothing else moves. Of the cells looked at it is what comes out, to round-off, but for two things that are linear
/// between sampled nodes: residuals of known sides whose line parameters differ from those of the line
/// (kernels/side_correction.hpp), and the tangents of walls whose near field turns. Cost: about 12 / every^2 of the
/// mesh read, and a plan and a morph of about 8 / every^3 of it; milliseconds.
///
/// Elements: all nodes are displaced, beside the mesh. Looked at are all elements between the end of a column and what
/// is beyond, those with the largest relative displacements, and one in `every`; what the guard then mends is not in
/// it. Cost: a Morpher and a morph, one pass over the elements for their relative displacements (100 flops each), two
/// sets of measures for those looked at; 24 bytes per node and 17 per element.
Prediction predict(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan,
                   std::span<Vec3 const> boundary, PredictionOptions const& options = {});

}  // namespace gridmorph
