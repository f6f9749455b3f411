// The meshes of a box of parameters as one sum: what certify_designs() asks for.
#pragma once

#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/parameter_gradient.hpp>
#include <gridmorph/quality/design_box.hpp>

#include <span>

namespace gridmorph {

/// The meshes x(p) that a plan makes of a motion with parameters low_i <= p_i <= high_i, as they are where rules and
/// plan are linear in p: centre = x(c), c the middle of the box, modes[i] = (x(c + r_i e_i) - x(c - r_i e_i)) / 2, r_i
/// half of the range.
///
/// That they are so is looked at, not proved: at both ends of every range and at `corners` of the box, the same ones
/// every time, meshes lie beside the sum by `deviation` of the result at most, four times which certify_designs() holds
/// to be possible. Throws ConfigError where that is more than 1e-9 of the mesh's size, with the parameter or design,
/// the node and by how much: near fields that turn, rotations and surfaces of revolution are not linear. MotionError;
/// ConfigError for ranges that are none. On the default host instance. Cost: 3 n + 1 + corners morphs; memory: 24 bytes
/// per node and parameter.
DesignModes design_modes(MorphPlan const& plan, Coordinates const& baseline, ParametricMotion const& motion,
                         std::span<double const> low, std::span<double const> high, int corners = 16);

}  // namespace gridmorph
