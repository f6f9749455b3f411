#include <gridmorph/fillet/root_sections.hpp>

#include <gridmorph/geometry/unit.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph {

namespace {

constexpr int n_steps = 64;

Vec3 in_plane(Vec3 const& v, Vec3 const& across) { return v - dot(v, across) * across; }

}  // namespace

WallProfile::WallProfile(FacetSurface const& surface, Vec3 const& root, Vec3 const& across, Vec3 const& up,
                         Vec3 const& normal, double length)
    : step_(length / n_steps) {
  points_.push_back({{}, normal});
  Vec3 direction = up;
  for (int k = 0; k < n_steps; ++k) {
    Vec3 const before = points_.back().point;
    Vec3 p = before + step_ * direction;
    for (int pass = 0; pass < 3; ++pass) {  // on the surface and in the plane
      kernels::FacetFoot const foot = surface.closest_point(root + p);
      p = in_plane(surface.view().slide(foot, root + p) - root, across);
    }
    if (distance(p, before) > 0.2 * step_) direction = unit(p - before);
    points_.push_back({before + step_ * direction, {}});
  }
  for (std::size_t k = 1; k < points_.size(); ++k) {
    Vec3 const chord = points_[std::min(k + 1, points_.size() - 1)].point - points_[k - 1].point;
    Vec3 const n = unit(cross(across, chord));
    points_[k].normal = dot(n, points_[k - 1].normal) < 0 ? -n : n;
  }
}

double WallProfile::nearest(Vec3 const& p) const {
  double best2 = std::numeric_limits<double>::infinity(), out = 0;
  for (std::size_t k = 0; k + 1 < points_.size(); ++k) {
    Vec3 const a = points_[k].point, edge = points_[k + 1].point - a;
    double const t = std::clamp(dot(p - a, edge) / dot(edge, edge), 0.0, 1.0);
    Vec3 const d = p - (a + t * edge);
    if (dot(d, d) >= best2) continue;
    best2 = dot(d, d);
    out = step_ * (double(k) + t);
  }
  return out;
}

std::optional<SectionCircle> circle_between(WallProfile const& first, WallProfile const& second, double radius) {
  auto const centre = [&](double s) {
    WallPoint const at = first.at(s);
    return at.point + radius * at.normal;
  };
  auto const gap = [&](double s) {
    Vec3 const c = centre(s);
    WallPoint const foot = second.at(second.nearest(c));
    return dot(c - foot.point, foot.normal) - radius;
  };
  double low = 0, high = 0;
  for (double const step = radius / 16; gap(high) < 0; high += step) {
    if (high > first.length()) return {};
    low = high;
  }
  for (int step = 0; step < 60; ++step) {
    double const middle = (low + high) / 2;
    (gap(middle) < 0 ? low : high) = middle;
  }
  SectionCircle out;
  out.centre = centre(high);
  out.contact = {high, second.nearest(out.centre)};
  std::array<Vec3, 2> const to{-first.at(out.contact[0]).normal, -second.at(out.contact[1]).normal};
  out.to_middle = unit(to[0] + to[1]);
  out.half_angle_rad = std::atan2(norm(cross(to[0], to[1])), dot(to[0], to[1])) / 2;
  return out;
}

WallPoint WallProfile::at(double s) const {
  int const last = int(points_.size()) - 1;
  int const k = std::clamp(int(std::floor(s / step_)), 0, last - 1);
  double const t = s / step_ - k;
  WallPoint const &a = points_[k], &b = points_[k + 1];
  double const turned = std::clamp(t, 0.0, 1.0);
  return {a.point + t * (b.point - a.point), unit((1 - turned) * a.normal + turned * b.normal)};
}

}  // namespace gridmorph
