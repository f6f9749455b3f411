// Applies the plan of an unstructured morph: boundary displacements in, new positions or displacements of every node out.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/mesh/vector_view.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <Kokkos_Core.hpp>

#include <memory>
#include <span>

namespace gridmorph {

/// An UnstructuredPlan on an execution space, as a list of stages (morph/stages/). Construction uploads their tables and
/// allocates the workspace on the instance it is given, and fences it once; everything else only enqueues kernels, each stage in
/// a profiling region of its own: no allocation, no fence, no copy to or from the host, no host decision.
///
/// Vectors are Views of any layout, double or float (mesh/vector_view.hpp), computed with in double. `boundary` has one
/// vector for each of UnstructuredPlan::known, in that order; all others have one for each node of the mesh. A View of another
/// length is a ConfigError with both numbers, before anything is enqueued.
///
/// Memory: 48 bytes per node (96 with MorpherOptions::velocity), the rows (about 60 bytes per near node, 70 per far node, 50 for
/// the residual), and the background mesh. A morpher's workspace serves one call at a time; copies of a morpher share it.
template <class ExecutionSpace>
class UnstructuredMorpher {
 public:
  using MemorySpace = typename ExecutionSpace::memory_space;
  using In = ConstVectorView<MemorySpace>;
  using Out = VectorView<MemorySpace>;

  /// The arrays of the baseline, of the mesh that the plan was made for, are not copied unless they are in float: every call
  /// reads them again.
  UnstructuredMorpher(ExecutionSpace const& exec, UnstructuredPlan const& plan, In const& baseline,
                      MorpherOptions const& options = {});

  /// moved(n) = x(n) + u(n) for every node, bit for bit x(n) where it does not move. `moved` may be the baseline itself, which
  /// is gone then.
  void positions(ExecutionSpace const& exec, In const& boundary, Out const& moved) const;

  /// u(n) of every node.
  void displacements(ExecutionSpace const& exec, In const& boundary, Out const& u) const;

  /// The same for several boundary displacements, any number of them, one after another.
  void positions(ExecutionSpace const& exec, std::span<In const> boundary, std::span<Out const> moved) const;
  void displacements(ExecutionSpace const& exec, std::span<In const> boundary, std::span<Out const> u) const;

  /// Grid velocity v(n) = du(n)/dt where the boundary displacement changes by `rate` per unit of time: the derivative of
  /// displacements() at `boundary` in the direction `rate`. Exact for walls that turn; nodes that slip as
  /// kernels::constrain_to_all() says. Needs MorpherOptions::velocity; costs two morphs.
  void velocities(ExecutionSpace const& exec, In const& boundary, In const& rate, Out const& v) const;

  /// Displacement of the background's nodes by the last call, (n_background_nodes), for pictures; empty without a background.
  [[nodiscard]] kernels::Field<double const> background_displacement() const;

 private:
  struct State;
  std::shared_ptr<State const> state_;
};

/// positions() on lists and coordinates of the host; waits. moved: as many nodes as the mesh.
void apply_on_host(UnstructuredMorpher<Kokkos::DefaultHostExecutionSpace> const& morpher,
                   std::span<Vec3 const> boundary, Coordinates& moved);

}  // namespace gridmorph
