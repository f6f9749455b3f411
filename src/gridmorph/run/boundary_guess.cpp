#include <gridmorph/boundary/range_nodes.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/geometry/plane_fit.hpp>
#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/run/boundary_guess.hpp>

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

std::string describe_plane(PlaneFit const& plane) {
  double const n[3] = {plane.normal.x, plane.normal.y, plane.normal.z};
  double const o[3] = {plane.origin.x, plane.origin.y, plane.origin.z};
  for (int a = 0; a < 3; ++a)
    if (std::fabs(n[a]) > 1 - 1e-9) return fmt::format("plane {} = {:.6g}", "xyz"[a], o[a] == 0 ? 0.0 : o[a]);
  return fmt::format("plane with normal ({:.4g}, {:.4g}, {:.4g})", n[0], n[1], n[2]);
}

bool one_cell_thick(Mesh const& mesh, BoundarySummary const& b) {
  return std::all_of(b.patches.begin(), b.patches.end(), [&](int p) {
    Patch const& patch = mesh.patches[p];
    for (int a = 0; a < 3; ++a)
      if (patch.range.extent(a) == 1) return mesh.zones[patch.zone].extent[a] == 2;
    return false;
  });
}

/// The plane of the points; in a 2-D mesh of the points and of what lies above them.
PlaneFit plane_of(MeshSummary const& s, std::vector<Vec3> points, double size) {
  if (s.unstructured && s.two_dimensional) {
    Vec3 const filled = s.box.high - s.box.low;
    Vec3 const across = filled.z <= std::min(filled.x, filled.y) ? Vec3{0, 0, size}
                        : filled.y <= filled.x                   ? Vec3{0, size, 0}
                                                                 : Vec3{size, 0, 0};
    for (std::size_t n = points.size(); n > 0; --n) points.push_back(points[n - 1] + across);
  }
  return fit_plane(points);
}

bool is_flat(MeshSummary const& s, std::vector<Vec3> const& points, double size) {
  PlaneFit const plane = plane_of(s, points, size);
  return plane.determined && plane.deviation <= flat * size;
}

/// In how many directions the box keeps off that of the mesh on both sides.
int directions_enclosed(Box const& mesh, Box const& b) {
  double const off = 1e-6 * distance(mesh.low, mesh.high);
  auto const inside = [&](double low, double high, double mesh_low, double mesh_high) {
    return low > mesh_low + off && high < mesh_high - off ? 1 : 0;
  };
  return inside(b.low.x, b.high.x, mesh.low.x, mesh.high.x) + inside(b.low.y, b.high.y, mesh.low.y, mesh.high.y) +
         inside(b.low.z, b.high.z, mesh.low.z, mesh.high.z);
}

std::optional<std::string> guess_plane(MeshSummary const& s, BoundaryShape const& shape,
                                       std::vector<Vec3> const& points, double size) {
  PlaneFit const plane = plane_of(s, points, size);
  if (!plane.determined || plane.deviation > flat * size) return std::nullopt;
  std::string text = describe_plane(plane);
  if (shape.side_of_two_dimensions) return text + ", side of a 2-D mesh";
  if (!s.axis) return text;
  CylindricalFrame const frame(*s.axis);
  double const sine = norm(cross(plane.normal, frame.direction()));
  if (sine < parallel) return text + ", across the axis: inlet, outlet or mixing plane";
  Vec3 const to_axis = plane.origin - frame.origin();
  if (std::fabs(sine - 1) < parallel && std::fabs(dot(to_axis, plane.normal)) < flat * size)
    return text + ", through the axis: periodic or symmetry";
  return text;
}

/// A line of a 2-D mesh about its axis; whatever else such a line is, its points have one axial position, or as many as
/// there are.
std::optional<std::string> guess_arc(CylindricalFrame const& frame, std::vector<Vec3> const& points) {
  double low = Box::inf, high = -Box::inf;
  for (Vec3 const& p : points) {
    double const radius = frame.meridional(p).radius;
    low = std::min(low, radius);
    high = std::max(high, radius);
  }
  if (high - low > flat * high) return std::nullopt;
  return fmt::format("arc about the axis, radius {:.6g}", high);
}

std::optional<std::string> guess_revolution(MeshSummary const& s, std::vector<Vec3> const& points,
                                            AxialBounds const& bounds) {
  if (!s.axis) return std::nullopt;
  CylindricalFrame const frame(*s.axis);
  if (s.two_dimensional) return guess_arc(frame, points);
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

std::vector<BoundaryShape> shapes_of(Mesh const& mesh, MeshSummary const& summary) {
  std::vector<BoundaryShape> out;
  for (auto const& b : summary.boundaries) {
    BoundaryShape shape;
    shape.side_of_two_dimensions = one_cell_thick(mesh, b);
    for (int const p : b.patches) {
      Patch const& patch = mesh.patches[p];
      Zone const& zone = mesh.zones[patch.zone];
      bool inside = true;
      for (int a = 0; a < 3; ++a) inside = inside && patch.range.begin[a] >= 0 && patch.range.end[a] <= zone.extent[a];
      auto& points = shape.patches.emplace_back();
      if (inside) for_each_node(zone, patch.range, [&](Index n) { points.push_back(mesh.coordinates[n]); });
    }
    out.push_back(std::move(shape));
  }
  return out;
}

void guess_roles(Coordinates const& coordinates, std::vector<BoundaryShape> const& shapes, MeshSummary& s) {
  double const size = distance(s.box.low, s.box.high);
  AxialBounds bounds;
  if (s.axis) {
    CylindricalFrame const frame(*s.axis);
    for (Index n = 0; n < coordinates.size(); ++n) {
      auto const m = frame.meridional(coordinates[n]);
      bounds.axial_min = std::min(bounds.axial_min, m.axial);
      bounds.axial_max = std::max(bounds.axial_max, m.axial);
      bounds.radius_min = std::min(bounds.radius_min, m.radius);
      bounds.radius_max = std::max(bounds.radius_max, m.radius);
    }
  }
  for (std::size_t k = 0; k < s.boundaries.size(); ++k) {
    auto& b = s.boundaries[k];
    auto const& shape = shapes[k];
    std::vector<Vec3> points;
    for (auto const& patch : shape.patches) points.insert(points.end(), patch.begin(), patch.end());
    if (points.empty()) continue;
    b.enclosed = directions_enclosed(s.box, b.box);
    if (distance(b.box.low, b.box.high) <= 1e-12 * size) {
      b.guess = "collapsed to a point";
      continue;
    }
    b.flat = std::all_of(shape.patches.begin(), shape.patches.end(),
                         [&](auto const& patch) { return !patch.empty() && is_flat(s, patch, size); });
    std::vector<std::string> said;
    if (auto plane = guess_plane(s, shape, points, size))
      said.push_back(std::move(*plane));
    else if (auto revolution = guess_revolution(s, points, bounds))
      said.push_back(std::move(*revolution));
    else if (is_outer_hull(s.box, b.box))
      said.emplace_back("reaches round the whole mesh: far field");
    else if (b.flat)
      said.push_back(fmt::format("{} patches, each in a plane", shape.patches.size()));
    if (b.first_height_mean > 0 && b.first_height_mean < thin * size && !shape.side_of_two_dimensions)
      said.emplace_back("thin first cells: viscous wall");
    for (auto const& text : said) b.guess += (b.guess.empty() ? "" : "; ") + text;
  }
}

}  // namespace gridmorph::cli
