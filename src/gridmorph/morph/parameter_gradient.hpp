// The last step from a functional of the mesh to the numbers that shape it: gradients of the parameters of rules, and
// of the control points of free-form deformations.
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

/// dJ/dd_ijk of the control points of an ffd rule, i fastest, with dJ_db from Morpher::transpose():
///
///   dJ/dd_ijk = share * sum over boundary nodes m of B_i(s_m) B_j(t_m) B_k(w_m) dJ/du(m)
///               + what rules beside it make of it
///
/// exactly, as u is linear in d. dJ/du(m) is dJ_db(m) in the frame of the patch's node; summed in the order of
/// boundary_nodes(). Nodes with another rule that the lattice moves all the same (followers, wakes, what is attached or
/// carried, blades and walls that are extended) take centred differences of the rules, by 1e-5 of the size of the
/// lattice. Zero for control points that a face through which the patches run out holds.
///
/// rule: number in Motion::rules, as the plan was made with. dJ_db: one for each of MorphPlan::boundary_nodes(). Throws
/// ConfigError where the rule is no ffd rule or lengths do not fit, MotionError. Cost: O(boundary nodes (degree +
/// 1)^3); with others that go along six evaluations of the rules per control point.
std::vector<Vec3> ffd_gradient(MorphPlan const& plan, int rule, std::span<Vec3 const> dJ_db);

}  // namespace gridmorph
