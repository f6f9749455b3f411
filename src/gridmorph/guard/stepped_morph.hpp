// Motions that are too large for one plan.
#pragma once

#include <gridmorph/morph/morph.hpp>

#include <functional>
#include <vector>

namespace gridmorph {

struct StepOptions {
  int steps = 2;
  PlanOptions plan;                        ///< of every step; `motion` is what the step does
  std::function<void(int step)> progress;  ///< called before each step, from 1; may be empty
};

/// Morphs a mesh of elements in several steps, each planned on the mesh that the one before left, and smoothed around
/// elements that it made bad (guard()). Displacements that add up along straight lines shear what lies between a body
/// that turns and a boundary that stands; steps follow the turn (MotionPath). Boundary conditions and slip surfaces are
/// those of `plan`, which was made for the mesh; its boundary nodes get `displacement` exactly.
///
/// Returns the new coordinates. Throws PlanError for a plan of blocks, and for a background mesh of the user's, which
/// stands still while the walls move. Cost: a plan, an apply and a guard per step, and room for a second list of
/// elements, whose coordinates move on the way.
Coordinates morph_in_steps(IndexedMesh const& mesh, MorphPlan const& plan, std::vector<Vec3> const& displacement,
                           StepOptions const& options);

}  // namespace gridmorph
