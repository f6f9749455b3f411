// The plan: everything a morph does, as flat tables. Depends on the baseline mesh and on which faces are known, never
// on how far they move; made once on the host, applied any number of times.
#pragma once

#include <gridmorph/kernels/line_parameter.hpp>
#include <gridmorph/kernels/node_copy.hpp>
#include <gridmorph/kernels/skeleton_sweep.hpp>
#include <gridmorph/kernels/slip_end.hpp>
#include <gridmorph/kernels/turned_ends.hpp>
#include <gridmorph/kernels/volume_pass.hpp>
#include <gridmorph/motion/boundary_motion.hpp>
#include <gridmorph/plan/blocks/chain.hpp>
#include <gridmorph/plan/common_motion.hpp>
#include <gridmorph/plan/options.hpp>

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// The lines of a set of chains.
struct LineTables {
  std::vector<kernels::Chain> chains;
  std::vector<kernels::Tube> tubes;
  std::vector<kernels::Segment> segments;
  std::vector<kernels::ParameterTarget> targets;
  Index n_parameters = 0;             ///< line parameters that are kept
  Index n_end_values = 0;             ///< displacements at the ends of all chains
  std::vector<Vec3> end_positions;    ///< of chains that turn: per end value, chain frame
  std::vector<Vec3> end_pivots;       ///< what they turn about, likewise
  std::vector<Vec3> swept_positions;  ///< SkeletonSweep::x, chain frame

  [[nodiscard]] Index n_lines() const;
};

/// What a chain adds to the nodes inside a piece.
struct VolumePart {
  int box = -1;  ///< in Plan::boxes
  kernels::VolumeTerm term{};
};

/// Tables of the transfinite correction of a stage (kernels/side_correction.hpp).
struct SideTables {
  std::vector<kernels::Side> sides;
  std::vector<kernels::Junction> junctions;
  std::vector<kernels::SideLine> lines;
  std::vector<std::int32_t> corrected;     ///< chain numbers
  std::vector<kernels::NodeCopy> gathers;  ///< slots of known side nodes -> side arrays, chain frame
  std::vector<double> t, section;
  std::vector<Vec3> positions;  ///< of chains that turn: as t, chain frame
};

/// Where a chain of a stage runs, for reports.
struct ChainPath {
  std::vector<int> blocks;  ///< that it passes, in order: numbers in Blocks
  std::array<std::string, 2>
      ends;  ///< what its ends lie on, or what made the faces known that they lie on; empty where nothing has a name
};

/// Chains that do not depend on one another, morphed together.
struct Stage {
  LineTables lines;
  SideTables sides;
  std::vector<kernels::NodeCopy> ends;         ///< slots -> displacements at the ends of the chains
  std::vector<kernels::SkeletonSweep> sweeps;  ///< faces, edges and corners that this stage makes known
  std::vector<VolumePart> volume;
  std::vector<kernels::NearFieldLine> near_field;  ///< lines that turn with the wall that they stand on
  bool turns = false;                              ///< whether any of its chains carries rotations
  std::vector<CellBox> cells;                      ///< of the blocks this stage morphs
  std::vector<int> chain_of_cells;                 ///< per entry of `cells`
  std::vector<int> axis_of_cells;                  ///< likewise: index direction of the zone along which the chain runs
  std::vector<ChainPath> paths;                    ///< per chain
  std::string name;                                ///< "near field", "1", "2", ...
  std::vector<std::string> description;            ///< one line per chain: blocks, ends, reasons of its rank
};

/// Projection of slip surfaces and the spread of the correction along the lines between them.
struct SpreadPass {
  LineTables lines;
  std::vector<kernels::SlipEnd> ends;
  std::vector<Vec3> positions;  ///< of ends in the baseline; empty: those of their nodes
  std::vector<kernels::SkeletonSweep> sweeps;
  std::vector<VolumePart> volume;
  std::vector<std::string> description;
};

/// Roots whose mean rotation says which way round they turn, body after body, in chunks that are summed in one go.
struct TurningRoots {
  std::vector<std::int32_t> root;
  std::vector<double> weight;         ///< share in the area of its body
  std::vector<Index> first{0};        ///< of `root` in each chunk, and the end
  std::vector<Index> first_chunk{0};  ///< of each body, and the end
};

/// How near fields turn (kernels/root_turn.hpp); empty where none does.
struct TurnTables {
  std::vector<kernels::Root> roots;
  std::vector<kernels::RootNeighbour> neighbours;
  std::vector<kernels::RootEnds> ends;
  std::vector<kernels::EndWall> end_walls;
  TurningRoots bodies;
};

/// A part of the mesh whose boundaries have a motion in common: it is taken off what they are given, and added to all
/// nodes of the part.
struct CommonPart {
  std::vector<int> zones;                 ///< ascending
  CommonMotion motion;                    ///< of `boundary`
  std::optional<kernels::CommonMap> map;  ///< instead of the fit to what is given
  std::vector<std::int32_t> boundary;     ///< in Plan::boundary_nodes
  std::vector<std::int32_t> slots;        ///< of the skeleton
  std::vector<Vec3> position;             ///< of their owners, as `slots`
};

struct Plan {
  /// Owner nodes whose displacement the motion gives, in the order that morph() expects their values.
  std::vector<Index> boundary_nodes;
  std::vector<Index> boundary_slots;                    ///< where their displacement goes on the skeleton
  std::vector<kernels::NodeCopy> boundary_projections;  ///< of nodes on the axis of a sector, in place
  std::vector<Stage> stages;
  std::vector<SpreadPass> spreads;
  std::vector<kernels::NodeCopy> skeleton_nodes;  ///< from slots to all nodes of the skeleton
  std::vector<kernels::VolumeBox> boxes;          ///< the nodes inside pieces; terms come from stages and spreads
  TurnTables turns;
  std::vector<CommonPart> common;  ///< boxes say which they belong to
  std::vector<double> law_knots;   ///< of laws of the user's own, see kernels::table_weight()
  std::vector<SlipSurface> surfaces;
  std::vector<Mat3> rotations;
  std::vector<CellBox> near_field;        ///< cells of the near field of moving walls
  std::vector<CellBox> regions;           ///< cells of regions that rules move
  std::vector<std::string> region_names;  ///< per entry of `regions`
  std::vector<std::string> notes;
  Index n_nodes = 0;
  Index n_slots = 0;  ///< of the skeleton
  double mesh_size = 0;
  /// Line parameters of all stages and passes, one after another, where they are not to be measured along the
  /// baseline's lines.
  std::vector<double> line_parameters;
};

/// The stages and chains in order, with the reason for each rank, as text; of a stage or a pass at most so many chains,
/// and how many there are besides.
std::string describe(Plan const& plan, std::size_t most_chains = std::numeric_limits<std::size_t>::max());

/// A line per stage: chains, blocks of the longest, grid lines, and what most of its chains run between. For plans of
/// hundreds of chains.
std::string overview(Plan const& plan);

}  // namespace gridmorph
