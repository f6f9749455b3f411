// Which elements and nodes move with the walls, and which take their displacement from the background mesh.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/plan/elements/wrap.hpp>

namespace gridmorph {

enum class Region : std::uint8_t {
  far,      ///< outside the wrap
  partial,  ///< partially wrapped: its box meets the wrap, but not all of its nodes lie inside
  near      ///< all nodes in the wrap
};

struct Classification {
  std::vector<Region> element;
  std::vector<std::uint8_t> near;    ///< per node: 1 when it belongs to a near or partially wrapped element
  std::vector<std::uint8_t> inside;  ///< per node: 1 when it lies in the wrap

  Index n_near = 0, n_partial = 0, n_far = 0;  ///< elements
  Index n_near_nodes = 0;

  /// Sets the numbers from the lists.
  void count();
};

/// Looks at the corners of each element; its further nodes go with it. Linear cost.
template <class AnyWrap>
Classification classify(HostInstance const& host, Mesh const& mesh, AnyWrap const& wrap);

}  // namespace gridmorph
