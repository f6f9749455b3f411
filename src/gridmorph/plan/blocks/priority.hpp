// Which chain comes first, and why.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/plan/blocks/chain.hpp>
#include <gridmorph/plan/chain_order.hpp>
#include <gridmorph/plan/options.hpp>

#include <array>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

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

}  // namespace gridmorph
