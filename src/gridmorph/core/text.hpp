// Numbers as text.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <optional>
#include <string>
#include <string_view>

namespace gridmorph {

/// A number as messages show it, with so many significant digits at most, as "%.3g" writes it with 3.
std::string to_text(double value, int digits);

/// A point as messages show it: "(x, y, z)".
std::string to_text(Vec3 const& point, int digits);

/// The whole text as a number, or nothing. HUGE_VAL when it is too large to represent; too small is zero.
std::optional<double> to_number(std::string_view field);

/// A number that can be computed with; nothing for infinity, what is no number, and what is too large to represent.
std::optional<double> finite_number(std::string_view field);

}  // namespace gridmorph
