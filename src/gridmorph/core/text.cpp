#include <gridmorph/core/text.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <system_error>

namespace gridmorph {

std::string to_text(double value, int digits) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

std::string to_text(Vec3 const& point, int digits) {
  return "(" + to_text(point.x, digits) + ", " + to_text(point.y, digits) + ", " + to_text(point.z, digits) + ")";
}

std::optional<double> to_number(std::string_view field) {
  if (!field.empty() && field.front() == '+') field.remove_prefix(1);
  double value = 0;
  auto const [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error == std::errc::result_out_of_range && end == field.data() + field.size()) {
    // Too small to represent is zero for a length; too large is not a number of use.
    std::size_t const exponent = field.find_first_of("eE");
    bool const tiny = exponent != std::string_view::npos && field.find('-', exponent) != std::string_view::npos;
    return tiny ? 0.0 : HUGE_VAL;
  }
  if (error != std::errc() || end != field.data() + field.size() || field.empty()) return std::nullopt;
  return value;
}

std::optional<double> finite_number(std::string_view field) {
  auto const value = to_number(field);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace gridmorph
