// Compiles chains into the flat tables of a stage.
#pragma once

#include <gridmorph/plan/plan.hpp>

#include <vector>

namespace gridmorph {

/// Rotations used by segments and copies, without repeats.
class RotationTable {
 public:
  explicit RotationTable(std::vector<Mat3>& table) : table_(table) {}
  std::int32_t number(Mat3 const& m);

 private:
  std::vector<Mat3>& table_;
};

/// Adds to `table` the copies from one entity to all others of its class (and the projection of nodes on an axis).
void add_copies(Mesh const& mesh, Lattice const& lattice, int source_entity, RotationTable& rotations,
                CopyTable& table);

struct StageChain {
  Chain chain;
  kernels::LineLaw law = kernels::LineLaw::linear;
  bool open_end = false;  ///< carry the first end's displacement to the last end
};

/// Lines of all chains; entities not known yet are written by the first chain that holds them and copied to their other
/// copies. Marks them known with the chain's better end kind (as `better` decides). With `correct`, sides that are
/// known get the transfinite correction.
Stage build_stage(Mesh const& mesh, Topology const& topology, std::vector<StageChain> const& chains, Known& known,
                  RotationTable& rotations, std::vector<std::string> const& kind_order);

/// Lines of redistribution chains: every entity of the chains is written once, known or not. `given` are the entities
/// whose displacement the motion rules give: they are honoured exactly while they stay within 1e-10 of the mesh size of
/// their slip surfaces, and trimmed to them beyond that.
SpreadPass build_spread(Mesh const& mesh, Topology const& topology, std::vector<Chain> const& chains,
                        std::vector<int> const& surface_of_patch, Known const& given, double mesh_size,
                        RotationTable& rotations);

/// Position of a kind in the priority's order; kinds that are not listed come after all that are.
int kind_rank(EndKind kind, std::vector<std::string> const& order);

}  // namespace gridmorph
