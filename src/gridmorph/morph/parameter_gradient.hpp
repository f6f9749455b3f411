// Gradients of the parameters of rules: the last step from a functional of the mesh to the numbers that shape it.
#pragma once

#include <gridmorph/morph/morph.hpp>

#include <functional>
#include <span>
#include <vector>

namespace gridmorph {

/// The rules for parameters p: always the same ones for the same patches, only what they displace by differs.
using ParametricMotion = std::function<Motion(std::span<double const> p)>;

/// dJ/dp_k = sum over boundary nodes m of db(m)/dp_k . dJ_db(m), with dJ_db from Morpher::transpose() and
///
///   db/dp_k = (b(p + h_k e_k) - b(p - h_k e_k)) / (2 h_k)
///
/// by centred differences of the rules alone, whatever they are: sections, targets, fields. Exact to round-off where b
/// is linear or quadratic in p_k, else with an error of order h_k^2. steps: h_k, positive; about 1e-5 of what p_k is
/// of. dJ_db: one for each of MorphPlan::boundary_nodes(). Throws ConfigError where lengths do not fit or a step is not
/// positive, MotionError. Cost: two evaluations of the rules per parameter; no mesh is morphed.
std::vector<double> parameter_gradient(MorphPlan const& plan, ParametricMotion const& motion,
                                       std::span<double const> parameters, std::span<double const> steps,
                                       std::span<Vec3 const> dJ_db);

}  // namespace gridmorph
