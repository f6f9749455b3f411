// Is a mesh valid everywhere, between the corners of its cells too (certify())? Is one that moves still valid, asked in
// every time step and answered on the device (ValidityCheck)?
#pragma once

#include <gridmorph/core/built_for.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/mesh/vector_view.hpp>
#include <gridmorph/quality/quality.hpp>

#include <Kokkos_Core.hpp>

#include <memory>
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
/// Certifies a mesh with elements.
template <BuiltFor Exec>
Certificate certify(Exec const& exec, Mesh const& mesh, UnstructuredTopology const& topology,
                    CertificateInput<typename Exec::memory_space> const& input);

struct Validity {
  double smallest_determinant = 1;  ///< Measure::determinant_3x3x3 of the worst cell
  Index inverted = 0;               ///< cells whose determinant is negative, or that have a corner that is no number
};

/// The smallest determinant of a mesh at any time of its motion. Made once (fences `exec`); each call enqueues three
/// kernels on the instance it is given and leaves its answer in memory of the device: no allocation, no fence, no copy.
/// The same bits with any number of threads.
///
/// Cost per cell: about 530 flops and its corners read once, 0.03 to 0.04 microseconds on one core. Memory: 60 bytes
/// per thousand cells; of unstructured meshes a byte per element, and where the host's memory is out of reach the
/// element lists. On the host these are the mesh's own, which must outlive the check. One call at a time.
template <BuiltFor ExecutionSpace>
class ValidityCheck {
 public:
  using MemorySpace = typename ExecutionSpace::memory_space;
  using Result = Kokkos::View<Validity const, MemorySpace>;

  /// The baseline, in the mesh's own coordinates, says which zones are left-handed.
  ValidityCheck(ExecutionSpace const& exec, Mesh const& mesh);
  /// ... and which elements are numbered inside out.
  ValidityCheck(ExecutionSpace const& exec, Mesh const& mesh, UnstructuredTopology const& topology);

  /// x (n_nodes): Views of any layout. The result stands when what is enqueued has run, until the next call.
  Result operator()(ExecutionSpace const& exec, ConstVectorView<MemorySpace> const& x) const;

 private:
  struct State;
  std::shared_ptr<State const> state_;
};

}  // namespace gridmorph
