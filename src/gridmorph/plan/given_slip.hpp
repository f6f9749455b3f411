// Given displacements of a mesh of elements on the slip surfaces that their nodes lie on, on the host.
#pragma once

#include <gridmorph/plan/unstructured_plan.hpp>

#include <vector>

namespace gridmorph {

/// What a morph makes of displacements of UnstructuredPlan::known before anything else: those that take nodes off slip
/// surfaces, put back. x: of the baseline. Cost O(known) and the surfaces'.
std::vector<Vec3> put_back_given(UnstructuredPlan const& plan, Coordinates const& x, std::vector<Vec3> given);

}  // namespace gridmorph
