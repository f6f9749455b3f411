// Applies a plan: boundary displacements in, displacement of every node out.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/plan/plan.hpp>

#include <Kokkos_Core.hpp>

#include <memory>

namespace gridmorph {

/// A plan on an execution space. Construction uploads the plan's tables and allocates the workspace (fences once);
/// displace() and move() only enqueue kernels on the instance they are given: no allocation, no fence, no host decision.
/// A Morpher's workspace serves one displace() at a time; copies of a Morpher share it.
template <class ExecutionSpace>
class Morpher {
 public:
  using MemorySpace = typename ExecutionSpace::memory_space;

  Morpher(ExecutionSpace const& exec, Plan const& plan);

  /// u(n) for every node n from the displacement of the plan's boundary nodes.
  /// boundary (n_boundary_nodes): in the order of Plan::boundary_nodes, each in the frame of that node.
  /// x: baseline coordinates, u: displacement, both (n_nodes) in MemorySpace; every element of u is written.
  /// Cost: per node 24 bytes read and 24 written by the stages, 48 read and 24 written more where slip surfaces are.
  void displace(ExecutionSpace const& exec, Kokkos::View<Vec3 const*, MemorySpace> boundary,
                kernels::Field<double const> x, kernels::Field<double> u) const;

  /// Turns displacements into positions in place: u(n) += x(n); nodes that do not move keep x bit for bit.
  void move(ExecutionSpace const& exec, kernels::Field<double const> x, kernels::Field<double> u) const;

 private:
  struct State;
  std::shared_ptr<State const> state_;
};

}  // namespace gridmorph
