// From a mesh and rules to a morphed mesh: in one call, or by a plan that serves many displacements.
#pragma once

#include <gridmorph/core/built_for.hpp>
#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/mesh/vector_view.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/plan/options.hpp>
#include <gridmorph/quality/indexed_mesh.hpp>

#include <Kokkos_Core.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

class BoundaryMotion;
struct PlanAccess;
struct SmoothingMap;
struct Trim;

/// A patch that gives a boundary node of a plan its displacement, and where the node lies there.
struct BoundaryPlace {
  Index boundary_node = 0;  ///< place in MorphPlan::boundary_nodes()
  int patch = -1;           ///< number in Mesh::patches (those that planning adds come last); -1: a periodic connection
  int zone = -1;            ///< number in Mesh::zones
  Index3 index{0, 0, 0};    ///< blocks: i, j, k, 0-based; elements: place among the nodes of the zone, 0, 0
  /// Displacement of the boundary node -> that of this place, where it is a periodic copy of the node; otherwise the
  /// identity.
  Mat3 rotation{};
};

/// The motions that one plan is to serve, one after another: rules for the same patches, whose displacements alone
/// differ. A plan reckons with what comes out worst of them, of long series with some, evenly spaced.
struct MotionSeries {
  int steps = 0;                                ///< 0: there is no series, but the motion that the rules say
  std::function<Motion(int step)> motion = {};  ///< from step 0 on
};

/// Of 0 ... n - 1 all, or `most` of them, spread evenly, the first and the last one among them.
std::vector<int> some_steps(int n, int most);

/// What lies near moving walls.
struct NearCells {
  /// (n_cells), nonzero near them; empty: all are far.
  Kokkos::View<std::uint8_t const*, Kokkos::HostSpace> cells = {};
  std::vector<int> walls = {};  ///< numbers of patches that have a near field of their own by name, or drive
};

/// The time that a part of planning took.
struct PlanSeconds {
  std::string part;  ///< "topology", "rules", "plan", "prediction", "order"
  double seconds = 0;
};

/// How the nodes of a mesh follow its boundary: depends on the baseline and on which patches the rules move, never on
/// how far. Made once on the host, put on an execution space by Morpher. Copies share their insides.
class MorphPlan {
 public:
  /// Connects the zones, completes and checks the boundary, resolves the rules and plans, for blocks or for elements.
  /// Where VolumeOptions leave the order of chains to the library, or ask for a predicted one, the displacements of
  /// `motion`, or of up to eight steps of `series` (a hundred where asked for), are looked at; of elements those of up
  /// to a thousand say how far the near field reaches. A motion that cannot be made is refused by
  /// boundary_displacement(), or here where the order was asked for. Throws MeshError, MotionError or PlanError. The
  /// mesh's coordinates are read here only.
  MorphPlan(HostInstance const& host, IndexedMesh const& mesh, Motion const& motion, PlanOptions const& options = {},
            MotionSeries const& series = {});
  MorphPlan(HostInstance const& host, Mesh const& mesh, Motion const& motion, PlanOptions const& options = {},
            MotionSeries const& series = {});
  /// On the default instance of the default host space.
  MorphPlan(Mesh const& mesh, Motion const& motion, PlanOptions const& options = {});

  [[nodiscard]] Index n_nodes() const;
  /// Nodes whose displacement a morph is given, in the order that it expects.
  [[nodiscard]] std::vector<Index> boundary_nodes() const;
  [[nodiscard]] Index n_boundary_nodes() const;
  /// Where they lie: one entry for each patch that has the node and an explicit rule, ascending by node. With
  /// PrescribedRule this says which of a solver's surface values go where. Cost O(boundary nodes, log).
  [[nodiscard]] std::vector<BoundaryPlace> boundary_places() const;
  /// What the rules give them, each in the frame of its node; zero where a PrescribedRule leaves it to the caller.
  /// Throws MotionError where the rules cannot be evaluated. Evaluated when it is first asked for, by any thread.
  [[nodiscard]] std::vector<Vec3> const& boundary_displacement() const;
  /// What other rules give them: the same rules for the same patches, whose displacements alone differ. Throws
  /// MotionError. Cost: an evaluation of the rules at the boundary's nodes; nothing is planned.
  [[nodiscard]] std::vector<Vec3> boundary_displacement(Motion const& motion) const;
  /// Defaults taken and facts found on the way, for users.
  [[nodiscard]] std::vector<std::string> notes() const;
  /// The rules on the boundary (motion/boundary_motion.hpp), with the patches that planning added.
  [[nodiscard]] BoundaryMotion const& rules() const;
  /// The near field of blocks and the walls that have one by name; near and partially wrapped elements and the walls
  /// that drive them. Cost: O(cells).
  [[nodiscard]] NearCells near_cells() const;
  /// How far displacements of the boundary lead off slip surfaces (plan/trim_note.hpp), and so are undone. Cost:
  /// O(boundary nodes).
  [[nodiscard]] std::vector<Trim> trims(std::vector<Vec3> const& boundary) const;
  /// The same where `motion` gave them, in words of its rules.
  [[nodiscard]] std::vector<Trim> trims(std::vector<Vec3> const& boundary, Motion const& motion) const;
  [[nodiscard]] std::vector<PlanSeconds> seconds() const;

  /// The same plan, and what a guard did to some of its meshes as a linear part of every morph
  /// (guard/guard.hpp).
  [[nodiscard]] MorphPlan with(std::shared_ptr<SmoothingMap const> smoothing) const;
  /// Null where the plan carries none.
  [[nodiscard]] std::shared_ptr<SmoothingMap const> const& smoothing() const { return smoothing_; }

 private:
  friend struct PlanAccess;
  struct State;
  explicit MorphPlan(std::shared_ptr<State const> state) : state_(std::move(state)) {}

  std::shared_ptr<State const> state_;
  std::shared_ptr<SmoothingMap const> smoothing_;
};

/// The coordinates of a mesh that lie in the memory of an execution space, in any layout, on the host: what plans read.
/// Fences `exec`. Cost: a copy of them there and one on the host.
template <BuiltFor ExecutionSpace>
Coordinates host_coordinates(ExecutionSpace const& exec,
                             ConstVectorView<typename ExecutionSpace::memory_space> const& x);

/// New coordinates of a mesh whose patches move as the rules say, on the host; fences `exec`, where it plans too if
/// that is one of the host. Programs that morph again keep a MorphPlan and a Morpher.
template <BuiltFor ExecutionSpace>
Coordinates morph(ExecutionSpace const& exec, Mesh const& mesh, Motion const& motion, PlanOptions const& options = {});

}  // namespace gridmorph
