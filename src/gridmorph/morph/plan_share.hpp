// What one process of many keeps of a plan of blocks: the nodes of some boxes, and all that they depend on.
#pragma once

#include <gridmorph/core/ranks.hpp>
#include <gridmorph/morph/morph.hpp>

#include <memory>
#include <span>
#include <vector>

namespace gridmorph {

struct PlanAccess;

/// The share that some boxes of nodes have in a plan of blocks. A Morpher of it has one vector for each node of the
/// boxes, box after box, i fastest, and moves them to the same bits as one of the whole plan; nothing is exchanged. It
/// is given the displacement of all boundary nodes of the whole plan, on every process. Copies share their insides,
/// which do not refer to plan or mesh.
///
/// Boxes may overlap, as planes that parts of a zone have in common or layers of ghost nodes do: each has its own copy
/// of a node, and all copies go to the same bits. Chains that reach the nodes of several processes are swept by each of
/// them, as far as it needs their lines (plan/share.hpp).
class PlanShare {
 public:
  [[nodiscard]] Index n_nodes() const;  ///< of the boxes
  /// As of the whole plan, numbers and places in the whole mesh: MorphPlan::boundary_nodes(), boundary_places() and
  /// boundary_displacement().
  [[nodiscard]] std::vector<Index> const& boundary_nodes() const;
  [[nodiscard]] std::vector<BoundaryPlace> const& boundary_places() const;
  [[nodiscard]] std::vector<Vec3> const& boundary_displacement() const;

  /// All of it as it lies in memory, for another process of the same program, and the share that these bytes are of.
  [[nodiscard]] Bytes to_bytes() const;
  [[nodiscard]] static PlanShare from_bytes(std::span<std::byte const> bytes);

 private:
  friend struct PlanAccess;
  struct State;
  explicit PlanShare(std::shared_ptr<State const> state) : state_(std::move(state)) {}

  std::shared_ptr<State const> state_;
};

/// The share of boxes in a plan of blocks; `mesh` is that of the plan, and its coordinates are those of the baseline:
/// lines are measured along them. Throws ConfigError: a plan of elements; another mesh; a box that is not within its
/// zone. MotionError where the rules cannot be evaluated. Cost: arc lengths of the lines of the chains that are kept,
/// and the memory of what is kept, 8 bytes per line parameter of one stage of the whole plan meanwhile.
PlanShare share(HostInstance const& host, MorphPlan const& plan, Mesh const& mesh, std::span<NodeBox const> boxes);

/// The shares of all ranks in a plan that rank 0 has: each names its boxes. Collective; `plan` and `mesh` on rank 0
/// alone, null elsewhere. Others never have more than their share. What share() throws for any of them all throw.
/// Cost: shares are made on rank 0, one after another, and sent in rounds, so that a few are there at once.
PlanShare share_out(Ranks const& ranks, HostInstance const& host, MorphPlan const* plan, Mesh const* mesh,
                    std::span<NodeBox const> boxes);

}  // namespace gridmorph
