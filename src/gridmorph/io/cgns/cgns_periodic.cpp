#include <gridmorph/io/cgns/cgns_periodic.hpp>
#include <gridmorph/io/periodic_transform.hpp>

#include <array>
#include <cmath>
#include <numbers>

namespace gridmorph::cgns {

namespace {

Vec3 read_vector(File const& file, Node const& periodic, std::string_view name) {
  auto const* node = periodic.child(name);
  auto const values = node ? file.reals(*node) : std::vector<double>{};
  std::array<double, 3> v{};
  for (std::size_t c = 0; c < 3 && c < values.size(); ++c) v[c] = values[c];
  return {v[0], v[1], v[2]};
}

/// Whether angles are in degrees, by the nearest node that names a unit; nothing where none does.
std::optional<bool> in_degrees(File const& file, std::initializer_list<Node const*> nearest_first) {
  constexpr std::size_t width = 32, angle_at = 4 * width;  // mass, length, time, temperature, angle
  for (auto const* node : nearest_first) {
    if (!node) continue;
    if (auto const* data_class = node->labelled("DataClass_t")) {
      auto const name = file.text(*data_class);
      if (name.starts_with("Nondimensional") || name.starts_with("Dimensionless") ||
          name == "NormalizedByUnknownDimensional")
        return false;
    }
    if (auto const* units = node->labelled("DimensionalUnits_t")) {
      auto const text = file.characters(*units);
      if (text.size() <= angle_at) continue;
      auto const angle = std::string_view(text).substr(angle_at, width);
      if (angle.starts_with("Degree")) return true;
      if (angle.starts_with("Radian")) return false;
    }
  }
  return std::nullopt;
}

bool is_zero(Vec3 const& v) { return v == Vec3{}; }

}  // namespace

std::optional<Periodic> read_periodic(File const& file, Node const& base, Node const& zone, Node const& connection,
                                      std::string const& where, std::vector<std::string>& notes) {
  auto const* property = connection.labelled("GridConnectivityProperty_t");
  auto const* node = property ? property->labelled("Periodic_t") : nullptr;
  if (!node) return std::nullopt;
  Periodic periodic;
  periodic.rotation_center = read_vector(file, *node, "RotationCenter");
  periodic.translation = read_vector(file, *node, "Translation");
  Vec3 angle = read_vector(file, *node, "RotationAngle");
  if (is_zero(angle) && is_zero(periodic.translation)) return std::nullopt;

  auto degrees = in_degrees(file, {node->child("RotationAngle"), node, &zone, &base});
  constexpr double full_turn = 2 * std::numbers::pi;
  double const largest = std::max({std::abs(angle.x), std::abs(angle.y), std::abs(angle.z)});
  if (!degrees && largest > full_turn * (1 + 1e-6)) {
    degrees = true;
    notes.push_back(where + ": RotationAngle names no unit and exceeds a full turn in radians; taken as degrees");
  }
  if (degrees.value_or(false)) angle = (std::numbers::pi / 180) * angle;
  periodic.rotation_angle_rad = angle;
  io::set_declared(periodic);
  return periodic;
}

}  // namespace gridmorph::cgns
