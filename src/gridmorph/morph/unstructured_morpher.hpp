// Applies the plan of an unstructured morph: boundary displacements in, new positions or displacements of every node out.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <Kokkos_Core.hpp>

#include <memory>
#include <span>

namespace gridmorph {

/// An UnstructuredPlan on an execution space. Construction uploads the rows and allocates the workspace (fences); everything
/// else only enqueues kernels on the instance it is given: no allocation, no fence, no copy to or from the host, no host decision.
/// A boundary displacement of another size than UnstructuredPlan::known is a ConfigError, before anything is enqueued.
///
/// Memory: 48 bytes per node, the rows (about 60 bytes per near node, 70 per far node, 50 for the residual), and the
/// background mesh. A morpher's workspace serves one call at a time; copies of a morpher share it.
template <class ExecutionSpace>
class UnstructuredMorpher {
 public:
  using MemorySpace = typename ExecutionSpace::memory_space;
  using Boundary = Kokkos::View<Vec3 const*, MemorySpace>;

  UnstructuredMorpher(ExecutionSpace const& exec, UnstructuredPlan const& plan);

  /// moved(n) = x(n) + u(n) for every node, bit for bit x(n) where it does not move. `moved` may be x itself.
  /// boundary (n_known): in the order of UnstructuredPlan::known. x: baseline coordinates (n_nodes), any
  /// stride, of the mesh the plan was made for.
  void apply(ExecutionSpace const& exec, Boundary boundary, kernels::Field<double const> x,
             kernels::Field<double> moved) const;

  /// u(n) of every node; x: as above (walls that turn and slip surfaces need it).
  void displace(ExecutionSpace const& exec, Boundary boundary, kernels::Field<double const> x,
                kernels::Field<double> u) const;

  /// Displacement of the background's nodes by the last call, (n_background_nodes), for pictures; empty without a background.
  [[nodiscard]] kernels::Field<double const> background_displacement() const;

 private:
  struct State;
  std::shared_ptr<State const> state_;
};

/// apply() on lists and coordinates of the host; waits. moved: as many nodes as the mesh.
void apply_on_host(UnstructuredMorpher<Kokkos::DefaultHostExecutionSpace> const& morpher,
                   std::span<Vec3 const> boundary, Coordinates const& x, Coordinates const& moved);

}  // namespace gridmorph
