// From a mesh and rules to a plan in one call: what the command line and most embedders use.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/plan/make_plan.hpp>
#include <gridmorph/plan/topology.hpp>

namespace gridmorph {

/// Everything that is known before a displacement is evaluated.
struct PreparedMorph {
  Mesh mesh;  ///< completed by patches for poles, open faces and regions, and notes on them; its
              ///< coordinates are shared
  Links links;
  BoundaryMotion surface;
  PlannedMorph planned;

  /// Wall-clock time of the three parts of prepare().
  struct Seconds {
    double topology = 0;  ///< interfaces and coverage of all faces
    double rules = 0;     ///< which rule moves which patch, slip surfaces, blade rows
    double plan = 0;      ///< blocks, chains, stages
  } seconds{};
  PlanOptions options{};  ///< as given

  [[nodiscard]] Plan const& plan() const { return planned.plan; }
  /// Displacements of Plan::boundary_nodes by the rules. Throws MotionError (see evaluate()).
  [[nodiscard]] std::vector<Vec3> boundary_displacement() const {
    return evaluate(planned.boundary, surface, planned.plan.rotations);
  }
};

/// Connects the zones, completes and checks the boundary (patches for poles and, where asked for, open faces), resolves
/// the rules and plans. Throws MeshError, MotionError or PlanError.
PreparedMorph prepare(HostInstance const& host, Mesh const& mesh, Motion const& motion, PlanOptions const& options);
inline PreparedMorph prepare(Mesh const& mesh, Motion const& motion, PlanOptions const& options) {
  return prepare(HostInstance(), mesh, motion, options);
}

}  // namespace gridmorph
