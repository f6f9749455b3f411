// What is found out before chains are put in order, and plans made on it: of the mesh itself, or of some of its grid
// lines; near fields of moving walls, which are stage 0, and which chain comes first, and why.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/plan/blocks/chain.hpp>
#include <gridmorph/plan/blocks/chain_laws.hpp>
#include <gridmorph/plan/blocks/gaps.hpp>
#include <gridmorph/plan/blocks/grid_lengths.hpp>
#include <gridmorph/plan/blocks/stage_builder.hpp>
#include <gridmorph/plan/chain_order.hpp>
#include <gridmorph/plan/make_plan.hpp>
#include <gridmorph/plan/options.hpp>

#include <array>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// The walls of one [boundary_layer] entry and how many cells its near field has (0: up to the first opposite block
/// face).
struct NearField {
  std::vector<int> walls;  ///< patch numbers
  int layers = 0;
  BoundaryLayer::Mode mode = BoundaryLayer::Mode::rotate;
  bool automatic = false;  ///< Extent::automatic: none where there is no room, see room_limits()
};

/// Whether the near field turns with its walls.
inline bool turns(NearField const& field) { return field.mode != BoundaryLayer::Mode::translate; }

/// Walls and layer counts from the options: an empty wall list takes every patch that ranks as a wall (`kinds`, see
/// ranked_kinds()) and that an explicit rule other than `fixed` moves; walls at gaps (`at_gap`, see gap_walls()) have
/// none. A thickness becomes the median, over all wall nodes, of the layers that reach it. Without any boundary layer
/// in the options there is the default one, if walls move. Throws PlanError for selectors that match no patch and near
/// fields that reach another boundary.
std::vector<NearField> near_fields(Mesh const& mesh, Links const& links, BoundaryMotion const& surface,
                                   std::vector<PatchKind> const& kinds, std::vector<char> const& at_gap,
                                   PlanOptions const& options);

/// Planes that bound the near fields: to be cut, and kept when blocks are merged.
std::vector<CutPlane> near_field_limits(Mesh const& mesh, Links const& links, std::vector<NearField> const& fields);

/// Planes that bound near fields of Extent::automatic where the block off their walls goes on to a boundary, to a
/// periodic interface included: a third of its cells off the wall. `topology`: without them. Adds to the notes how far
/// such near fields reach.
std::vector<CutPlane> room_limits(Mesh const& mesh, Topology const& topology, std::vector<NearField> const& fields,
                                  std::vector<std::string>& notes);

/// Chains off the walls through the near fields, walls first. Blocks between two walls with near fields have none: what
/// moves both is interpolated between them. Throws PlanError when a near field has no opposite face and is not
/// automatic: such ones are left out there.
std::vector<StageChain> near_field_chains(Mesh const& mesh, Topology const& topology, Known const& known,
                                          std::vector<NearField> const& fields);

/// The largest cosine of each box between grid edges of different directions that meet at one of its nodes, over the
/// edges inside the box: the cosine of the smallest angle of the faces of its cells, which is never above 90 degrees.
/// Edges of no length have no angle. The result does not depend on the number of threads, nor on how zones are numbered
/// or turned.
///
/// Cost: one pass over the nodes: 24 bytes, 4 square roots and about 110 flops per node.
std::vector<double> largest_cosines(HostInstance const& host, Mesh const& mesh, std::span<NodeBox const> boxes);

/// A chain with what it is ranked by. Values are quantised, so that round-off of a reoriented mesh decides nothing.
struct RankedChain {
  Chain chain;
  std::array<int, 2> boundary{};                   ///< kind ranks of the better and the worse end
  long long quality = 0;                           ///< smallest angle of its cells, 1e-6 degree
  long long aspect_ratio = 0;                      ///< length / width, 1e-6
  std::array<long long, 3> centre{};               ///< last resort: place of the chain, 1e-9 of the mesh size
  std::array<std::array<long long, 3>, 2> ends{};  ///< and of its two ends
  ChainPlace place{};                              ///< where it was found
};

/// Computes ranks; the quality of a block (smallest angle between cell edges on the baseline) is computed when first
/// needed and kept. Cost of a block's quality: one pass over its nodes, in parallel over all blocks asked for at once.
class Priority {
 public:
  Priority(HostInstance const& host, Mesh const& mesh, Topology const& topology, VolumeOptions const& options,
           double mesh_size);

  /// Boundary rank and geometry; the quality is added where it comes first or has to break a tie.
  [[nodiscard]] RankedChain rank(Chain chain) const;
  void add_quality(std::span<RankedChain> chains);
  void add_quality(RankedChain& chain) { add_quality(std::span(&chain, 1)); }
  /// Sorts chains, best first, by the rule groups in the user's order, then by place.
  void sort(std::vector<RankedChain>& chains) const;
  /// Whether two chains are equal in the first group, so that they are chains of one stage.
  [[nodiscard]] bool same_rank(RankedChain const& a, RankedChain const& b) const;
  /// Whether the quality is what chains are ranked by first: then all of them need it.
  [[nodiscard]] bool quality_leads() const;
  [[nodiscard]] std::string reason(RankedChain const& chain) const;
  [[nodiscard]] std::vector<std::string> const& kind_order() const { return kind_order_; }
  [[nodiscard]] HostInstance const& host() const { return host_; }

 private:
  void measure_angles(std::set<int> const& blocks);

  HostInstance host_;
  Mesh const& mesh_;
  Topology const& topology_;
  VolumeOptions const& options_;
  double mesh_size_;
  std::vector<std::string> kind_order_;
  std::vector<double> angle_of_block_;
};

struct PlanBasis {
  Mesh const& mesh;
  std::vector<std::string> notes;
  std::vector<PatchKind> kinds;   ///< what patches rank as
  std::vector<EndKind> ends;      ///< the same, but those that the priority names apart
  std::vector<NearField> fields;  ///< of `mesh`, in its cells
  ChainLaws laws;
  MergeLimits limits;
  Topology topology;
  Gaps gaps;
};

/// The basis of plans of a mesh by these rules and options. Borrows the mesh. Throws as make_plan() does.
PlanBasis plan_basis(Mesh const& mesh, Links const& links, BoundaryMotion const& surface, PlanOptions const& options);

/// The grid lines that tables are made of: a mesh with the zones, patches, pieces and blocks of the basis in the same
/// order, and how long its edges are.
struct PlanLines {
  Mesh const& mesh;
  Topology const& topology;
  GridLengths lengths;
};

/// The plan of these lines. What coordinates decide (kinds, near fields, ranks) is decided on the mesh of the basis,
/// whose angles `priority` keeps; `first` as in make_plan(); `next`: gets what the stage after those could be, in the
/// order of ranks; `choice`: of the chains of stages that are not given.
PlannedMorph build_plan(PlanBasis const& basis, Priority& priority, PlanLines const& lines,
                        BoundaryMotion const& surface, PlanOptions const& options, ChainOrder const& first,
                        ChainOrder* next = nullptr, ChainChoice choice = ChainChoice::rules);

}  // namespace gridmorph
