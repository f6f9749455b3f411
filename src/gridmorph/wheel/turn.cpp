#include <gridmorph/wheel/turn.hpp>

#include <cstdint>
#include <numbers>
#include <utility>

namespace gridmorph {

Turn::Turn(Axis const& axis, int step, int steps)
    : origin_(axis.origin), direction_((1 / norm(axis.direction)) * axis.direction) {
  step_ = ((step % steps) + steps) % steps;
  std::int64_t const quarters = 4 * std::int64_t(step_) / steps;
  std::int64_t const rest = 4 * std::int64_t(step_) - quarters * steps;  // of a quarter turn, in parts of 1 / steps
  auto const angle = [&](std::int64_t parts) { return 0.5 * std::numbers::pi * double(parts) / double(steps); };
  if (2 * rest <= steps) {
    cosine_ = std::cos(angle(rest));
    sine_ = std::sin(angle(rest));
  } else {
    cosine_ = std::sin(angle(steps - rest));
    sine_ = std::cos(angle(steps - rest));
  }
  for (std::int64_t q = 0; q < quarters; ++q) {
    std::swap(cosine_, sine_);
    cosine_ = 0.0 - cosine_;
  }
}

RigidTransform Turn::transform() const {
  RigidTransform out;
  if (step_ == 0) return out;
  Turn about_zero = *this;
  about_zero.origin_ = {};
  Vec3 const x = about_zero({1, 0, 0}), y = about_zero({0, 1, 0}), z = about_zero({0, 0, 1});
  out.rotation = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
  out.translation = origin_ - out.rotation * origin_;
  return out;
}

}  // namespace gridmorph
