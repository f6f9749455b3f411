// Is a mesh that moves still valid? Asked in every time step, answered on the device.
#pragma once

#include <gridmorph/core/built_for.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/mesh/vector_view.hpp>

#include <Kokkos_Core.hpp>

#include <memory>

namespace gridmorph {

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
