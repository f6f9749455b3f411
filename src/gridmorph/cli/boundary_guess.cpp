#include <gridmorph/cli/boundary_guess.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/detail/cylindrical.hpp>
#include <gridmorph/motion/detail/plane_fit.hpp>
#include <gridmorph/motion/slip_surface.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace gridmorph::cli {

namespace {

constexpr double flat = 1e-6;      // deviation of a plane, of the mesh size
constexpr double round = 1e-3;     // deviation of a surface of revolution, of its largest radius
constexpr double thin = 1e-4;      // first cell of a viscous wall, of the mesh size
constexpr double parallel = 1e-3;  // sine of the angle between directions

/// Bounds of the mesh along and away from the axis.
struct AxialBounds {
  double axial_min = Box::inf, axial_max = -Box::inf, radius_min = Box::inf, radius_max = -Box::inf;
};

std::vector<Vec3> points_of(Mesh const& mesh, BoundarySummary const& b) {
  std::vector<Vec3> points;
  for (int const p : b.patches) {
    Patch const& patch = mesh.patches[p];
    Zone const& zone = mesh.zones[patch.zone];
    for (int a = 0; a < 3; ++a)
      if (patch.range.begin[a] < 0 || patch.range.end[a] > zone.extent[a]) return {};
    for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
      for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
        for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i)
          points.push_back(mesh.coordinates[zone.node({i, j, k})]);
  }
  return points;
}

std::string describe_plane(PlaneFit const& plane) {
  double const n[3] = {plane.normal.x, plane.normal.y, plane.normal.z};
  double const o[3] = {plane.origin.x, plane.origin.y, plane.origin.z};
  for (int a = 0; a < 3; ++a)
    if (std::fabs(n[a]) > 1 - 1e-9) return fmt::format("plane {} = {:.6g}", "xyz"[a], o[a] == 0 ? 0.0 : o[a]);
  return fmt::format("plane with normal ({:.4g}, {:.4g}, {:.4g})", n[0], n[1], n[2]);
}

/// Whether every zone of the boundary is one cell thick away from it: the sides of a 2-D mesh.
bool one_cell_thick(Mesh const& mesh, BoundarySummary const& b) {
  return std::all_of(b.patches.begin(), b.patches.end(), [&](int p) {
    Patch const& patch = mesh.patches[p];
    for (int a = 0; a < 3; ++a)
      if (patch.range.extent(a) == 1) return mesh.zones[patch.zone].extent[a] == 2;
    return false;
  });
}

std::optional<std::string> guess_plane(Mesh const& mesh, MeshSummary const& s, BoundarySummary const& b,
                                       std::vector<Vec3> const& points, double size) {
  PlaneFit const plane = fit_plane(points);
  if (!plane.determined || plane.deviation > flat * size) return std::nullopt;
  std::string text = describe_plane(plane);
  if (one_cell_thick(mesh, b)) return text + ", side of a 2-D mesh";
  if (!s.axis) return text;
  CylindricalFrame const frame(*s.axis);
  double const sine = norm(cross(plane.normal, frame.direction()));
  if (sine < parallel) return text + ", across the axis: inlet, outlet or mixing plane";
  Vec3 const to_axis = plane.origin - frame.origin();
  if (std::fabs(sine - 1) < parallel && std::fabs(dot(to_axis, plane.normal)) < flat * size)
    return text + ", through the axis: periodic or symmetry";
  return text;
}

std::optional<std::string> guess_revolution(MeshSummary const& s, std::vector<Vec3> const& points,
                                            AxialBounds const& bounds) {
  if (!s.axis) return std::nullopt;
  CylindricalFrame const frame(*s.axis);
  std::vector<std::pair<double, double>> profile;
  double low = Box::inf, high = -Box::inf;
  for (Vec3 const& p : points) {
    auto const m = frame.meridional(p);
    profile.emplace_back(m.axial, m.radius);
    low = std::min(low, m.radius);
    high = std::max(high, m.radius);
  }
  if (!(high > 0)) return std::nullopt;
  try {
    if (TurnedProfile::from_points(profile).profile.deviation > round * high) return std::nullopt;
  } catch (Error const&) {
    return std::nullopt;  // no surface of revolution
  }
  std::string text = fmt::format("surface of revolution, radius {:.6g} to {:.6g}", low, high);
  double const range = bounds.radius_max - bounds.radius_min;
  if (low - bounds.radius_min < 1e-3 * range) return text + ", innermost: hub";
  if (bounds.radius_max - high < 1e-3 * range) return text + ", outermost: case";
  return text;
}

bool is_outer_hull(Box const& mesh, Box const& b) {
  double const tolerance = 1e-6 * distance(mesh.low, mesh.high);
  return distance(mesh.low, b.low) < tolerance && distance(mesh.high, b.high) < tolerance;
}

}  // namespace

void guess_roles(Mesh const& mesh, MeshSummary& s) {
  double const size = distance(s.box.low, s.box.high);
  AxialBounds bounds;
  if (s.axis) {
    CylindricalFrame const frame(*s.axis);
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      auto const m = frame.meridional(mesh.coordinates[n]);
      bounds.axial_min = std::min(bounds.axial_min, m.axial);
      bounds.axial_max = std::max(bounds.axial_max, m.axial);
      bounds.radius_min = std::min(bounds.radius_min, m.radius);
      bounds.radius_max = std::max(bounds.radius_max, m.radius);
    }
  }
  for (auto& b : s.boundaries) {
    auto const points = points_of(mesh, b);
    if (points.empty()) continue;
    if (distance(b.box.low, b.box.high) <= 1e-12 * size) {
      b.guess = "collapsed to a point";
      continue;
    }
    std::vector<std::string> said;
    if (auto plane = guess_plane(mesh, s, b, points, size))
      said.push_back(std::move(*plane));
    else if (auto revolution = guess_revolution(s, points, bounds))
      said.push_back(std::move(*revolution));
    else if (is_outer_hull(s.box, b.box))
      said.emplace_back("reaches round the whole mesh: far field");
    if (b.first_height_mean > 0 && b.first_height_mean < thin * size && !one_cell_thick(mesh, b))
      said.emplace_back("thin first cells: viscous wall");
    for (auto const& text : said) b.guess += (b.guess.empty() ? "" : "; ") + text;
  }
}

}  // namespace gridmorph::cli
