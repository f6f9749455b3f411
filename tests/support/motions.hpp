// Motions for tests: rules in one line, and smooth displacement fields that fit a mesh's periodicity.
#pragma once

#include <gridmorph/motion/motion.hpp>

#include "support/mesh_builders.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::test {

using VectorField = std::function<Vec3(Vec3 const&)>;

inline FunctionRule function_rule(VectorField field) {
  return {"test field", [field = std::move(field)](std::span<Vec3 const> p, std::span<Vec3> u) {
            for (std::size_t n = 0; n < p.size(); ++n) u[n] = field(p[n]);
          }};
}

inline MotionRule rule(std::vector<std::string> patches, Rule r, int rank = 0) {
  return {std::move(patches), std::move(r), rank, "test"};
}

inline Motion motion(std::vector<MotionRule> rules) {
  Motion m;
  m.rules = std::move(rules);
  return m;
}

inline VectorField scaled(double factor, VectorField field) {
  return [factor, field = std::move(field)](Vec3 const& p) { return factor * field(p); };
}

/// A wavy field without any symmetry; amplitude is a length.
VectorField waves(double amplitude, double wave_number = 1.5);
/// Repeats itself from copy to copy of the sector, and is single-valued on its axis.
VectorField turning_waves(Sector const& sector, double amplitude);
/// Depends only on the direction across the periodic directions of translational().
VectorField layered_waves(double amplitude);
/// Rotation by angle_rad about the z direction through centre.
VectorField turn_about_z(Vec3 const& centre, double angle_rad);

}  // namespace gridmorph::test
