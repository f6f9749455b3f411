// From a mesh and rules to a morphed mesh: in one call, or by a plan that serves many displacements.
#pragma once

#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/plan/options.hpp>

#include <memory>
#include <string>
#include <vector>

namespace gridmorph {

struct PreparedMorph;
struct PreparedUnstructured;

/// How the nodes of a mesh follow its boundary: depends on the baseline and on which patches the rules move, never on how far.
/// Made once on the host, put on an execution space by Morpher. Copies share their insides.
class MorphPlan {
 public:
  /// Connects the zones, completes and checks the boundary, resolves the rules and plans, for blocks or for elements. Throws MeshError, MotionError or
  /// PlanError. The mesh's coordinates are read here only.
  MorphPlan(Mesh const& mesh, Motion const& motion, PlanOptions const& options = {});

  [[nodiscard]] Index n_nodes() const;
  /// Nodes whose displacement a morph is given, in the order that it expects.
  [[nodiscard]] std::vector<Index> boundary_nodes() const;
  /// What the rules give them, each in the frame of its node.
  [[nodiscard]] std::vector<Vec3> const& boundary_displacement() const;
  /// Defaults taken and facts found on the way, for users.
  [[nodiscard]] std::vector<std::string> notes() const;

  /// For the library: of the two one is null.
  [[nodiscard]] PreparedMorph const* blocks() const;
  [[nodiscard]] PreparedUnstructured const* elements() const;

 private:
  struct State;
  std::shared_ptr<State const> state_;
};

/// New coordinates of a mesh whose patches move as the rules say, on the host; fences `exec`. Programs that morph again keep a
/// MorphPlan and a Morpher.
template <class ExecutionSpace>
Coordinates morph(ExecutionSpace const& exec, Mesh const& mesh, Motion const& motion, PlanOptions const& options = {});

}  // namespace gridmorph
