// The plan: everything a morph does, as flat tables. Depends on the baseline mesh and on which faces are known, never on
// how far they move; made once on the host, applied any number of times.
#pragma once

#include <gridmorph/kernels/line_sweep.hpp>
#include <gridmorph/kernels/node_copy.hpp>
#include <gridmorph/motion/surface_motion.hpp>
#include <gridmorph/plan/chain.hpp>
#include <gridmorph/plan/options.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// Copies of displacements between coincident nodes; `projections` (onto the axis of a sector) run first.
struct CopyTable {
  std::vector<kernels::NodeCopy> projections, copies;
};

/// One launch over the lines of independent chains, and what it needs.
struct LineTables {
  std::vector<kernels::Chain> chains;
  std::vector<kernels::Tube> tubes;
  std::vector<kernels::Segment> segments;
  std::vector<Index> first_line{0};
};

/// Tables of the transfinite correction of a stage (kernels/side_correction.hpp).
struct SideTables {
  std::vector<kernels::Side> sides;
  std::vector<kernels::Junction> junctions;
  std::vector<kernels::SideLine> lines;
  std::vector<std::int32_t> corrected;  ///< chain numbers
  std::vector<double> t, section;
};

/// Chains that do not depend on one another, morphed together.
struct Stage {
  LineTables lines;
  SideTables sides;
  CopyTable copies;
  std::vector<CellBox> cells;            ///< of the blocks this stage morphs
  std::string name;                      ///< "near field", "1", "2", ...
  std::vector<std::string> description;  ///< one line per chain: blocks, ends, reasons of its rank
};

/// One end of a line of a redistribution chain that slides on surfaces.
struct SlipEnd {
  Index node = 0;
  Index value = 0;             ///< where its end value goes
  std::int32_t rotation = -1;  ///< chain frame -> frame of the node's zone
  std::int32_t surface[3] = {-1, -1, -1};
  double tolerance = 0;  ///< nodes with a given displacement are left alone this near to their surfaces
};

/// Projection of slip surfaces and the spread of the correction along the lines between them.
struct SpreadPass {
  LineTables lines;
  std::vector<SlipEnd> ends;
  Index n_values = 0;
  CopyTable copies;
  std::vector<std::string> description;
};

struct Plan {
  /// Owner nodes whose displacement the motion gives, in the order that morph() expects their values.
  std::vector<Index> boundary_nodes;
  CopyTable boundary_copies;
  std::vector<Stage> stages;
  std::vector<SpreadPass> spreads;
  std::vector<SlipSurface> surfaces;
  std::vector<Mat3> rotations;
  std::vector<CellBox> near_field;  ///< cells of the near field of moving walls
  std::vector<std::string> notes;
  Index n_nodes = 0;
  double mesh_size = 0;
};

/// The stages and chains in order, with the reason for each rank, as text.
std::string describe(Plan const& plan);

}  // namespace gridmorph
