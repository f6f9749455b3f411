// Links: the 1-to-1 interfaces of a mesh, both directions of each, checked node by node, periodic transforms fitted.
#pragma once

#include <gridmorph/boundary/topology_options.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <vector>

namespace gridmorph {

/// One direction of a 1-to-1 interface. Every Link has its reverse in the same list, stored in the file or not.
struct Link {
  int interface = -1;  ///< number in Mesh::interfaces (of the stored side when only one side is stored)
  int zone = -1;
  int donor_zone = -1;
  IndexRange range;  ///< own nodes
  IndexMap to_donor;
  bool periodic = false;
  RigidTransform transform;  ///< own position -> donor position; exactly the identity unless periodic
  double mismatch = 0;       ///< largest distance between coincident nodes after the transform
};

/// All links of a mesh, by zone.
struct Links {
  std::vector<Link> all;
  std::vector<std::vector<int>> of_zone;  ///< numbers of the links that leave each zone
  double mesh_size = 0;
};

/// Checks every interface (bounds, shape, coincidence within the tolerance) and fits periodic transforms to the matched
/// nodes by least squares (Horn 1987, unit quaternions), since files declare angles in single precision.
/// Throws MeshError naming every interface that does not match, the place and distance of its worst node.
/// Cost: O(interface nodes).
Links connect(Mesh const& mesh, TopologyOptions const& options);

/// All links of a mesh, for callers that go on looking: adds to `problems` instead of throwing. Interfaces whose points
/// do not coincide are in the result all the same (their faces are claimed), those with ranges that cannot be are not.
Links connect(HostInstance const& host, Mesh const& mesh, TopologyOptions const& options, Problems& problems);
inline Links connect(Mesh const& mesh, TopologyOptions const& options, Problems& problems) {
  return connect(HostInstance(), mesh, options, problems);
}

}  // namespace gridmorph
