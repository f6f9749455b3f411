// Is every cell of a mesh valid everywhere, between its corners too?
#pragma once

#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/quality/quality.hpp>

#include <vector>

namespace gridmorph {

/// What is certified. Handedness and signs are those of the baseline.
template <class MemorySpace>
struct CertificateInput {
  CoordinateViews<MemorySpace> coordinates;
  CoordinateViews<MemorySpace> baseline;  ///< left empty: every cell that is inside out counts as new
  std::vector<int> handedness = {};       ///< blocks: zone_handedness(); left empty, it is found again
  std::vector<signed char> signs = {};    ///< elements: numbering_signs(); left empty, they are found again
  std::vector<int> zones = {};            ///< that are looked at; left empty, all are
};

/// Looks at every cell; fences. Deterministic. Cost per cell: 260 to 710 flops and its corners read once in blocks,
/// about 1000 flops in elements; memory: 48 bytes per thousand cells. Throws MeshError for Views that are shorter than
/// the mesh.
template <BuiltFor Exec>
Certificate certify(Exec const& exec, Mesh const& mesh, CertificateInput<typename Exec::memory_space> const& input);
/// Of a mesh with elements.
template <BuiltFor Exec>
Certificate certify(Exec const& exec, Mesh const& mesh, UnstructuredTopology const& topology,
                    CertificateInput<typename Exec::memory_space> const& input);

}  // namespace gridmorph
