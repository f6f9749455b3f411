// Applies a plan: boundary displacements in, new positions, displacements or velocities of every node out.
#pragma once

#include <gridmorph/core/built_for.hpp>
#include <gridmorph/mesh/vector_view.hpp>

#include <Kokkos_Core.hpp>

#include <cstddef>
#include <memory>
#include <span>

namespace gridmorph {

class MorphPlan;
class PlanShare;
struct MorpherAccess;
struct Plan;
struct SmoothingMap;
struct UnstructuredPlan;

struct MorpherOptions {
  int fields = 1;  ///< displacement fields of blocks that go through the volume together; elements: one after another
  bool velocity = false;  ///< room for velocities()
  /// What a guard did, on top of every displacement, position and velocity; none: that of the MorphPlan, where it
  /// carries any.
  std::shared_ptr<SmoothingMap const> smoothing = nullptr;
  bool transpose = false;  ///< tables and room for transpose()
};

/// A plan on an execution space, of blocks or of elements, as a list of stages. Construction uploads their tables,
/// allocates the workspace and, for blocks, computes the line parameters from the baseline mesh (fences `exec`; 24
/// bytes read and 8 written per node and line parameter); everything else only enqueues kernels on the instance it is
/// given, each stage in a profiling region of its own: no allocation, no fence, no copy, no host decision.
///
/// Vectors are Views of any layout, double or float (mesh/vector_view.hpp), computed with in double. `boundary` has one
/// vector for each of MorphPlan::boundary_nodes(), in that order, each in the frame of its node; all others have one
/// for each node of the mesh. A View of another length is a ConfigError with both numbers, before anything is enqueued.
///
/// Memory, blocks: 8 bytes per node of the far field and 8 per node and finalize pass, plus about 50 bytes per node on
/// the faces of pieces; while it is made, 24 bytes per node more where the baseline is in float or zone by zone. A
/// Morpher's workspace serves one call at a time; copies of a Morpher share it. Elements: 48 bytes per node (96 with
/// MorpherOptions::velocity), about 60 per near node, 70 per far node, 50 for the residual, 8 for each body that turns,
/// and the background mesh. With MorpherOptions::transpose about 50 bytes more per node on the faces of pieces, 24 per
/// node with it or with MorpherOptions::velocity where parts have a motion in common (kernels/common_motion.hpp);
/// elements 12 more for each item of their rows, 4 for each node that reads a lattice, 150 per node.
template <BuiltFor ExecutionSpace>
class Morpher {
 public:
  using MemorySpace = typename ExecutionSpace::memory_space;
  using In = ConstVectorView<MemorySpace>;
  using Out = VectorView<MemorySpace>;

  /// The arrays of the baseline are not copied: positions() reads them again.
  Morpher(ExecutionSpace const& exec, MorphPlan const& plan, In const& baseline, MorpherOptions const& options = {});
  /// Of a share, whose nodes are meant where the mesh's are spoken of. The sum of transpose() over the shares of all
  /// processes is that of the whole plan, to round-off, where each node's dJ_du is in one of them and zero in others.
  Morpher(ExecutionSpace const& exec, PlanShare const& share, In const& baseline, MorpherOptions const& options = {});

  /// moved(n) = x(n) + u(n) for every node, bit for bit x(n) where it does not move. `moved` may be the baseline
  /// itself, which is gone then. Cost per node: 24 bytes read, 24 written, 8 read per line parameter.
  void positions(ExecutionSpace const& exec, In const& boundary, Out const& moved) const;

  /// u(n) of every node. Cost per node: 24 bytes written, 8 read per line parameter.
  void displacements(ExecutionSpace const& exec, In const& boundary, Out const& u) const;

  /// The same for several boundary displacements, any number of them, MorpherOptions::fields at a time: of those, line
  /// parameters of blocks are read once for every eight.
  void positions(ExecutionSpace const& exec, std::span<In const> boundary, std::span<Out const> moved) const;
  void displacements(ExecutionSpace const& exec, std::span<In const> boundary, std::span<Out const> u) const;

  /// Grid velocity v(n) = du(n)/dt where the boundary displacement changes by `rate` per unit of time: the derivative
  /// of displacements() at `boundary` in the direction `rate`, slip surfaces included. Needs MorpherOptions::velocity.
  /// Elements: exact for walls that turn; nodes that slip as kernels::constrain_to_all() says; costs two morphs.
  void velocities(ExecutionSpace const& exec, In const& boundary, In const& rate, Out const& v) const;

  /// The transpose of the derivative of displacements() at `boundary`: with J any function of the displacements u of
  /// all nodes,
  ///
  ///   dJ_db(m) = sum over nodes n of (du(n) / db(m))^T dJ_du(n)
  ///
  /// slip surfaces and walls that turn included; velocities() is the same derivative forwards, and both agree to
  /// round-off. dJ_du, dJ/du = dJ/dx too, has one vector for each node of the mesh, dJ_db one for each boundary node,
  /// in its frame. Sums are in one order whatever the number of threads: the same bits always. Needs
  /// MorpherOptions::transpose. Cost: the stages of one morph forwards, without its pass through the volume, then per
  /// node 32 bytes read for each chain through it, more where chains have known sides (kernels/transposed_sides.hpp).
  void transpose(ExecutionSpace const& exec, In const& boundary, In const& dJ_du, Out const& dJ_db) const;

  /// For pictures: of the nodes of the background mesh between wrap and outer box, by the last call; part: which of
  /// UnstructuredPlan::parts, where there are any. Empty where the plan has none.
  [[nodiscard]] In background_displacements(std::size_t part = 0) const;

 private:
  friend struct MorpherAccess;
  struct State;

  Morpher(ExecutionSpace const& exec, Plan const& plan, In const& baseline, MorpherOptions const& options);
  Morpher(ExecutionSpace const& exec, UnstructuredPlan const& plan, In const& baseline, MorpherOptions const& options);

  std::shared_ptr<State const> state_;
};

}  // namespace gridmorph
