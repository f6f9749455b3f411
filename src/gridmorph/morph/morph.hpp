// From a mesh and rules to a morphed mesh: in one call, or by a plan that serves many displacements.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/plan/options.hpp>

#include <memory>
#include <string>
#include <vector>

namespace gridmorph {

struct PreparedMorph;
struct PreparedUnstructured;
struct SmoothingMap;

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

/// How the nodes of a mesh follow its boundary: depends on the baseline and on which patches the rules move, never on
/// how far. Made once on the host, put on an execution space by Morpher. Copies share their insides.
class MorphPlan {
 public:
  /// Connects the zones, completes and checks the boundary, resolves the rules and plans, for blocks or for elements.
  /// Throws MeshError, MotionError or PlanError. The mesh's coordinates are read here only.
  MorphPlan(HostInstance const& host, Mesh const& mesh, Motion const& motion, PlanOptions const& options = {});
  /// On the default instance of the default host space.
  MorphPlan(Mesh const& mesh, Motion const& motion, PlanOptions const& options = {});

  [[nodiscard]] Index n_nodes() const;
  /// Nodes whose displacement a morph is given, in the order that it expects.
  [[nodiscard]] std::vector<Index> boundary_nodes() const;
  /// Where they lie: one entry for each patch that has the node and an explicit rule, ascending by node. With
  /// PrescribedRule this says which of a solver's surface values go where. Cost O(boundary nodes, log).
  [[nodiscard]] std::vector<BoundaryPlace> boundary_places() const;
  /// What the rules give them, each in the frame of its node; zero where a PrescribedRule leaves it to the caller.
  [[nodiscard]] std::vector<Vec3> const& boundary_displacement() const;
  /// What other rules give them: the same rules for the same patches, whose displacements alone differ. Throws
  /// MotionError. Cost: an evaluation of the rules at the boundary's nodes; nothing is planned.
  [[nodiscard]] std::vector<Vec3> boundary_displacement(Motion const& motion) const;
  /// Defaults taken and facts found on the way, for users.
  [[nodiscard]] std::vector<std::string> notes() const;

  /// The same plan, and what a guard did to some of its meshes as a linear part of every morph
  /// (guard/smoothing_record.hpp).
  [[nodiscard]] MorphPlan with(std::shared_ptr<SmoothingMap const> smoothing) const;
  /// Null where the plan carries none.
  [[nodiscard]] std::shared_ptr<SmoothingMap const> const& smoothing() const { return smoothing_; }

  /// For the library: of the two one is null.
  [[nodiscard]] PreparedMorph const* blocks() const;
  [[nodiscard]] PreparedUnstructured const* elements() const;

 private:
  struct State;
  std::shared_ptr<State const> state_;
  std::shared_ptr<SmoothingMap const> smoothing_;
};

/// New coordinates of a mesh whose patches move as the rules say, on the host; fences `exec`, where it plans too if
/// that is one of the host. Programs that morph again keep a MorphPlan and a Morpher.
template <class ExecutionSpace>
Coordinates morph(ExecutionSpace const& exec, Mesh const& mesh, Motion const& motion, PlanOptions const& options = {});

}  // namespace gridmorph
