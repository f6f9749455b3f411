// Which chains can be morphed together.
#pragma once

#include <gridmorph/plan/blocks/chain.hpp>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace gridmorph {

/// The entities that chains of one stage will write, each with the line of entities it lies on. Chains may share an
/// entity only when they run the same way along it from the same end to the same end (chains side by side): then both
/// give it the same displacement, whichever writes it.
class IndependentChains {
 public:
  IndependentChains(Topology const& topology, Known const& known) : topology_(topology), known_(known) {}
  /// Takes the chain in; false, and nothing is taken, where what it would write depends on a chain before it. directed:
  /// its law differs from one end to the other, so that lines are shared only from the same first end.
  bool add(Chain const& chain, bool directed = false);

 private:
  Topology const& topology_;
  Known const& known_;
  std::unordered_map<int, std::uint64_t> line_of_class_;
};

}  // namespace gridmorph
