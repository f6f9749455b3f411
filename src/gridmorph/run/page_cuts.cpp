// Where a mesh is cut for pictures.
#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/kernels/vec3.hpp>
#include <gridmorph/run/mesh_cuts.hpp>
#include <gridmorph/run/run_page.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace gridmorph::cli {

namespace {

using page::Cut;

constexpr std::array names{"x", "y", "z"};

/// Seen along a coordinate, the other two to the right and up.
Cut seen_along(int coordinate) {
  int const a = coordinate == 0 ? 1 : 0, b = coordinate == 2 ? 1 : 2;
  Cut cut;
  cut.labels = {names[a], names[b]};
  cut.flat = [a, b](Vec3 const& p) { return page::Flat{component(p, a), component(p, b)}; };
  return cut;
}

/// Inner and outer radius of a mesh along its axis.
class Annulus {
 public:
  Annulus(Coordinates const& at, Axis const& axis)
      : frame_(axis), bins_(bins_of(at.size())), inner_(bins_, HUGE_VAL), outer_(bins_, -HUGE_VAL) {
    for (Index n = 0; n < at.size(); ++n) {
      double const a = frame_.meridional(at[n]).axial;
      begin_ = std::min(begin_, a);
      end_ = std::max(end_, a);
    }
    for (Index n = 0; n < at.size(); ++n) {
      MeridionalPoint const p = frame_.meridional(at[n]);
      std::size_t const b = bin(p.axial);
      inner_[b] = std::min(inner_[b], p.radius);
      outer_[b] = std::max(outer_[b], p.radius);
    }
  }

  /// Whether both are functions of the axial position, with room between them everywhere: not so in radial machines.
  [[nodiscard]] bool is_axial() const {
    double gap = 0, jump = 0;
    std::size_t full = 0, last = 0;
    for (std::size_t b = 0; b < bins_; ++b) {
      if (!(inner_[b] < outer_[b])) continue;
      gap += outer_[b] - inner_[b];
      if (full > 0)
        jump = std::max({jump, std::fabs(inner_[b] - inner_[last]) / double(b - last),
                         std::fabs(outer_[b] - outer_[last]) / double(b - last)});
      last = b;
      ++full;
    }
    return full > bins_ / 2 && jump < 0.25 * gap / double(full);
  }

  /// Share of the way from the inner to the outer radius.
  [[nodiscard]] double span(Vec3 const& p) const {
    MeridionalPoint const m = frame_.meridional(p);
    double const at = std::clamp((m.axial - begin_) / (end_ - begin_) * double(bins_) - 0.5, 0.0, double(bins_ - 1));
    auto const b = std::min(std::size_t(at), bins_ - 2);
    double const t = at - double(b);
    double const in = value(inner_, b) * (1 - t) + t * value(inner_, b + 1);
    double const out = value(outer_, b) * (1 - t) + t * value(outer_, b + 1);
    return (m.radius - in) / (out - in);
  }
  [[nodiscard]] CylindricalFrame const& frame() const { return frame_; }

 private:
  /// So few that each has nodes of both walls, where blades lean too.
  static std::size_t bins_of(Index nodes) { return std::size_t(std::clamp(0.5 * std::cbrt(double(nodes)), 8.0, 80.0)); }
  [[nodiscard]] std::size_t bin(double a) const {
    return std::min(bins_ - 1, std::size_t((a - begin_) / (end_ - begin_) * double(bins_)));
  }
  /// The value of the nearest bin that has nodes.
  [[nodiscard]] double value(std::vector<double> const& of, std::size_t b) const {
    for (std::size_t d = 0; d < bins_; ++d) {
      if (b >= d && std::isfinite(of[b - d])) return of[b - d];
      if (b + d < bins_ && std::isfinite(of[b + d])) return of[b + d];
    }
    return 0;
  }

  CylindricalFrame frame_;
  double begin_ = HUGE_VAL, end_ = -HUGE_VAL;
  std::size_t bins_;
  std::vector<double> inner_, outer_;
};

bool has_blades(ResolvedMotion const& motion) {
  return std::any_of(motion.rules.begin(), motion.rules.end(), [](MotionRule const& rule) {
    return std::holds_alternative<CircumferentialSlideRule>(rule.rule) || std::holds_alternative<FollowRule>(rule.rule);
  });
}

}  // namespace

Cut flat_cut(std::span<Vec3 const> nodes) {
  std::array<double, 3> low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (Vec3 const& p : nodes)
    for (int d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], component(p, d));
      high[d] = std::max(high[d], component(p, d));
    }
  int thin = 2;
  for (int d = 1; d >= 0; --d)
    if (high[d] - low[d] < high[thin] - low[thin]) thin = d;
  Cut cut = seen_along(thin);
  cut.title = "The mesh";
  return cut;
}

Cut index_cut(page::PictureMesh const& mesh, Coordinates const& at, int axis, int index) {
  std::vector<Vec3> nodes;
  for (page::Facet const& facet : mesh.index_plane(axis, index).facets)
    for (Index32 const n : facet.node) nodes.push_back(at[n]);
  char const letter = "ijk"[axis];
  if (nodes.empty())
    throw ConfigError(fmt::format("--{} {}: no block of '{}' has this plane of nodes; planes are counted from 1",
                                  letter, index + 1, mesh.mesh().source));
  Cut cut = flat_cut(nodes);
  cut.title = fmt::format("{} = {}", letter, index + 1);
  cut.index_plane = {axis, index};
  return cut;
}

Cut plane_cut(int coordinate, double value) {
  Cut cut = seen_along(coordinate);
  cut.title = fmt::format("{} = {:.4g}", names[coordinate], value);
  cut.levels = [coordinate, value](Coordinates const& nodes, std::span<double> level) {
    double const* const x = (coordinate == 0 ? nodes.x : coordinate == 1 ? nodes.y : nodes.z).data();
    for (std::size_t n = 0; n < level.size(); ++n) level[n] = x[n] - value;
  };
  return cut;
}

std::vector<Cut> span_cuts(Coordinates const& at, Axis const& axis, std::span<double const> shares,
                           std::span<Vec3 const> about) {
  auto const annulus = std::make_shared<Annulus const>(at, axis);
  if (about.empty() || !annulus->is_axial()) return {};
  CylindricalFrame const& frame = annulus->frame();
  Vec3 const across =
      std::fabs(frame.direction().x) < 0.9 ? cross(frame.direction(), {1, 0, 0}) : cross(frame.direction(), {0, 1, 0});
  Vec3 const first = (1 / norm(across)) * across, second = cross(frame.direction(), first);
  double radius = 0, x = 0, y = 0;
  for (Vec3 const& p : about) {
    Vec3 const d = p - frame.origin();
    double const r = frame.meridional(p).radius;
    radius += r;
    x += dot(d, first) / std::max(r, 1e-300);
    y += dot(d, second) / std::max(r, 1e-300);
  }
  radius /= double(about.size());
  constexpr double turn = 2 * 3.14159265358979323846;
  double const middle = std::atan2(y, x);
  std::vector<Cut> out;
  for (double const share : shares) {
    Cut cut;
    cut.title = fmt::format("Span {:.4g} %, rolled out", 100 * share);
    cut.labels = {"axial", "radius x angle"};
    cut.levels = [annulus, share](Coordinates const& nodes, std::span<double> level) {
      for (std::size_t n = 0; n < level.size(); ++n) level[n] = annulus->span(nodes[Index(n)]) - share;
    };
    cut.flat = [annulus, first, second, middle, radius](Vec3 const& p) {
      CylindricalFrame const& f = annulus->frame();
      Vec3 const d = p - f.origin();
      double angle = std::atan2(dot(d, second), dot(d, first)) - middle;
      angle -= turn * std::round(angle / turn);
      return page::Flat{dot(d, f.direction()), radius * angle};
    };
    cut.period = turn * radius;
    out.push_back(std::move(cut));
  }
  return out;
}

std::vector<Cut> plane_cuts(page::Surface const& surface, std::vector<Vec3> const& displacement) {
  Vec3 middle;
  double weight = 0;
  bool const focus = std::find(surface.focus.begin(), surface.focus.end(), 1) != surface.focus.end();
  for (std::size_t n = 0; n < surface.nodes.size(); ++n) {
    if (focus && surface.focus[n] == 0) continue;
    double const u = norm(displacement[n]) + 1e-30;
    middle += u * surface.baseline[n];
    weight += u;
  }
  std::vector<Cut> out;
  for (int d = 0; d < 3 && weight > 0; ++d) out.push_back(plane_cut(d, component(middle, d) / weight));
  return out;
}

std::vector<Vec3> nodes_in_focus(page::Surface const& surface) {
  std::vector<Vec3> out;
  for (std::size_t n = 0; n < surface.nodes.size(); ++n)
    if (surface.focus[n] != 0) out.push_back(surface.baseline[n]);
  return out;
}

Vec3 upwards(std::optional<Axis> const& axis, page::Surface const& surface) {
  Vec3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, sum;
  double n = 0;
  for (std::size_t k = 0; k < surface.nodes.size(); ++k) {
    if (surface.focus[k] == 0) continue;
    Vec3 const& p = surface.baseline[k];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    sum += p;
    ++n;
  }
  if (n == 0) return {0, 0, 1};
  if (axis) {
    CylindricalFrame const frame(*axis);
    Vec3 const d = (1 / n) * sum - frame.origin();
    Vec3 const radial = d - dot(d, frame.direction()) * frame.direction();
    if (norm(radial) > 1e-3 * norm(d)) return (1 / norm(radial)) * radial;
  }
  Vec3 const size = high - low;
  if (size.y < 0.5 * size.z && size.y <= size.x) return {0, 1, 0};
  if (size.x < 0.5 * size.z && size.x < size.y) return {1, 0, 0};
  return {0, 0, 1};
}

bool is_of_machine(BoundaryMotion const& rules) {
  return has_blades(rules.motion()) || !rules.boundary().periodic_transforms().empty();
}

std::vector<Cut> cuts_of(page::PictureMesh const& mesh, bool of_machine, std::optional<Axis> const& axis,
                         page::Surface const& surface, std::vector<Vec3> const& displacement) {
  Coordinates const& at = mesh.mesh().coordinates;
  if (mesh.is_plane()) {
    std::vector<Vec3> nodes;
    for (Index n = 0; n < at.size(); ++n) nodes.push_back(at[n]);
    return {flat_cut(nodes)};
  }
  if (axis && of_machine)
    if (auto cuts = span_cuts(at, *axis, std::array{0.5, 0.9}, nodes_in_focus(surface)); !cuts.empty()) return cuts;
  return plane_cuts(surface, displacement);
}

}  // namespace gridmorph::cli
