// Where the zones of a passage meet each other and, across its periodic sides, the neighbouring passages: of blocks and
// of elements alike.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/boundary/links.hpp>

#include <array>
#include <vector>

namespace gridmorph {

/// One direction of a 1-to-1 interface of blocks, or of a connection of elements, node by node. Every one has its
/// reverse in the same list, stored in the file or not.
struct PassageLink {
  int connection = -1;  ///< number in connections_of()
  int zone = -1;
  int donor_zone = -1;
  bool periodic = false;
  RigidTransform transform;                 ///< own position -> donor position; exactly the identity unless periodic
  double mismatch = 0;                      ///< largest distance between coincident nodes after the transform
  double tolerance = 0;                     ///< within which nodes count as coincident [length]
  std::vector<std::array<Index, 2>> pairs;  ///< own node and the donor's
  IndexRange range{};                       ///< of blocks: own nodes
  IndexMap to_donor{};
};

/// All of a mesh, by zone.
struct PassageLinks {
  std::vector<PassageLink> all;
  std::vector<std::vector<int>> of_zone;  ///< numbers of the links that leave each zone
  double mesh_size = 0;
};

/// The links of a mesh of blocks, in the order of `links`. Cost: O(interface nodes).
PassageLinks passage_links(Mesh const& mesh, Links const& links, TopologyOptions const& options);
/// Those of a mesh of elements, in the order of its connections, which pair nodes within 1e-6 of the mesh size. Cost:
/// O(n log n) in the nodes of connections.
PassageLinks passage_links(Boundary const& boundary);

/// "periodic interface 'per_i' (zone 'Zone 1' i_min [1:1, 1:33, 1:9])", of elements "periodic connection 'per' (zone
/// 'Fluid')".
std::string describe(Mesh const& mesh, PassageLink const& link);

}  // namespace gridmorph
