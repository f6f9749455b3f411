// Applies a plan: boundary displacements in, new positions or displacements of every node out.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/volume_pass.hpp>
#include <gridmorph/plan/plan.hpp>

#include <Kokkos_Core.hpp>

#include <memory>

namespace gridmorph {

struct MorpherOptions {
  int fields = 1;         ///< displacement fields that one call may take
  bool velocity = false;  ///< room for velocity()
};

/// A plan on an execution space. Construction uploads the plan's tables, allocates the workspace and computes the line
/// parameters from the baseline mesh (fences once, 24 bytes read and 8 written per node and line parameter); everything
/// else only enqueues kernels on the instance it is given: no allocation, no fence, no copy, no host decision. A boundary
/// displacement of another size than Plan::boundary_nodes is a ConfigError, before anything is enqueued.
///
/// Memory: 8 bytes per node of the far field and 8 per node and finalize pass, plus about 50 bytes per node on the faces of
/// pieces. A Morpher's workspace serves one call at a time; copies of a Morpher share it.
template <class ExecutionSpace>
class Morpher {
 public:
  using MemorySpace = typename ExecutionSpace::memory_space;
  using Boundary = Kokkos::View<Vec3 const*, MemorySpace>;
  /// Several boundary displacements: (field, boundary node).
  using BoundaryBatch = Kokkos::View<Vec3 const**, Kokkos::LayoutRight, MemorySpace>;

  /// x: baseline coordinates (n_nodes), any stride.
  Morpher(ExecutionSpace const& exec, Plan const& plan, kernels::Field<double const> x,
          MorpherOptions const& options = {});

  /// moved(n) = x(n) + u(n) for every node, bit for bit x(n) where it does not move. `moved` may be x itself.
  /// boundary (n_boundary_nodes): in the order of Plan::boundary_nodes, each in the frame of that node. x: the baseline the
  /// Morpher was made for. Cost per node: 24 bytes read, 24 written, 8 read per line parameter.
  void apply(ExecutionSpace const& exec, Boundary boundary, kernels::Field<double const> x,
             kernels::Field<double> moved) const;

  /// u(n) of every node. Cost per node: 24 bytes written, 8 read per line parameter.
  void displace(ExecutionSpace const& exec, Boundary boundary, kernels::Field<double> u) const;

  /// u(n) of every node for several boundary displacements at once: the line parameters are read once for all of them.
  /// At most MorpherOptions::fields; u[f] is the displacement field of boundary row f.
  void displace(ExecutionSpace const& exec, BoundaryBatch boundary, kernels::FieldBatch<double> u) const;

  /// Grid velocity v(n) = du(n)/dt where the boundary displacement changes by `rate` per unit of time: the derivative of
  /// displace() at `boundary` in the direction `rate`, slip surfaces included. Needs MorpherOptions::velocity.
  void velocity(ExecutionSpace const& exec, Boundary boundary, Boundary rate, kernels::Field<double> v) const;

 private:
  struct State;
  std::shared_ptr<State const> state_;
};

}  // namespace gridmorph
