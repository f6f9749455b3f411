#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/geometry/plane_fit.hpp>
#include <gridmorph/motion/detail/facet_groups.hpp>
#include <gridmorph/motion/target/target_sides.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace gridmorph {

namespace {

constexpr double ends_within = 1e-6;   // of the size of the surface
constexpr double counts_as_on = 1e-9;  // of the size of the target: cuts beside a corner are that corner
constexpr double cut_within = 1e-8;    // of the size of the target: how far cuts may be off a curved side

/// Cuts a target: keeps what is above a side.
class Cut {
 public:
  Cut(TargetTree const& target, TargetSide const& side)
      : target_(target), side_(side), points_(target.points()), size_(box_diagonal(target.points())) {
    for (Vec3 const& p : points_) {
      double const h = side.height(p);
      height_.push_back(std::abs(h) <= counts_as_on * size_ ? 0 : h);
    }
  }

  TargetTree run() {
    std::vector<std::array<int, 3>> kept;
    for (std::size_t n = 0; n < target_.triangles().size(); ++n) {
      auto const& t = target_.triangles()[n];
      auto const is_above = [&](int v) { return height_[v] > 0; };
      auto const is_below = [&](int v) { return height_[v] < 0; };
      if (std::none_of(t.begin(), t.end(), is_below)) {
        kept.push_back(t);
        continue;
      }
      // What only touches the side is an edge or a corner of what is kept.
      auto const first = std::find_if(t.begin(), t.end(), is_above);
      if (first == t.end()) continue;
      cut({*first, t[std::size_t(first - t.begin() + 1) % 3], t[std::size_t(first - t.begin() + 2) % 3]},
          target_.normal(int(n)));
      for (std::size_t k = 1; k + 1 < polygon_.size(); ++k) kept.push_back({polygon_[0], polygon_[k], polygon_[k + 1]});
    }
    if (kept.empty()) return target_;
    return with_used_points(kept);
  }

 private:
  /// What is kept of a triangle, from its first corner, which is above the side, on.
  void cut(std::array<int, 3> const& t, Vec3 const& normal) {
    polygon_.clear();
    int left = -1;  // where the corners go below the side
    for (std::size_t k = 0; k < 3; ++k) {
      int const a = t[k], b = t[(k + 1) % 3];
      double const from = height_[a], to = height_[b];
      if (from >= 0) polygon_.push_back(a);
      if (from >= 0 && to < 0) {
        if (from > 0) polygon_.push_back(crossing(a, b));
        left = polygon_.back();
      } else if (from < 0 && to >= 0) {
        int const back = to > 0 ? crossing(a, b) : b;
        for (Vec3 const& p : side_.way(points_[left], points_[back], normal, cut_within * size_)) {
          polygon_.push_back(int(points_.size()));
          points_.push_back(p);
        }
        if (to > 0) polygon_.push_back(back);
      }
    }
  }

  /// Where the edge meets the side: one point, whichever triangle asks.
  int crossing(int a, int b) {
    auto const [at, fresh] = crossings_.try_emplace(std::minmax(a, b), int(points_.size()));
    if (fresh) {
      auto const [first, second] = at->first;
      points_.push_back(side_.crossing(points_[first], points_[second]));
    }
    return at->second;
  }

  [[nodiscard]] TargetTree with_used_points(std::vector<std::array<int, 3>> triangles) const {
    std::vector<int> number(points_.size(), -1);
    std::vector<Vec3> points;
    for (auto& t : triangles)
      for (int& v : t) {
        int& own = number[v];
        if (own < 0) {
          own = int(points.size());
          points.push_back(points_[v]);
        }
        v = own;
      }
    return {std::move(points), std::move(triangles)};
  }

  TargetTree const& target_;
  TargetSide const& side_;
  std::vector<Vec3> points_;
  double size_;
  std::vector<double> height_;  ///< of the points of the target; zero on the side
  std::vector<int> polygon_;
  std::map<std::pair<int, int>, int> crossings_;
};

/// The side that a surface ends on, where it ends on this one.
std::optional<TargetSide> as_side(SlipSurface const& surface, PatchSurface const& moves) {
  if (surface.kind == SlipKind::axial || surface.kind == SlipKind::facets) return std::nullopt;
  double const near =
      ends_within * moves.size + (surface.kind == SlipKind::plane ? 0.0 : 2 * surface.baseline_deviation);
  double low = 0, high = 0;
  int on = 0;
  kernels::SlipSurfaceView const view = surface.view();
  for (Vec3 const& p : moves.points) {
    double const h = view.offset(p);
    low = std::min(low, h);
    high = std::max(high, h);
    on += std::abs(h) <= near ? 1 : 0;
  }
  // Both nodes of an edge at least, of a line its end; what is across the side, or within it, does not end there.
  if (on < (moves.lines ? 1 : 2) || (low < -near) == (high > near)) return std::nullopt;
  return TargetSide(surface, high > near ? 1 : -1, near);
}

/// The plane, or the surface of revolution about the axis, that points lie on to 1e-6 of their size.
std::optional<SlipSurface> surface_through(std::vector<Vec3> const& points, Axis const& axis) {
  PlaneFit const fit = fit_plane(points);
  if (!fit.determined) return std::nullopt;
  SlipSurface out;
  if (double const off = deviation_from_plane(points, fit.origin, fit.normal); off <= ends_within * fit.extent) {
    out.origin = fit.origin;
    out.direction = fit.normal;
    out.baseline_deviation = off;
    return out;
  }
  CylindricalFrame const frame(axis);
  std::vector<std::pair<double, double>> meridional;
  for (Vec3 const& p : points) {
    auto const [a, r] = frame.meridional(p);
    meridional.emplace_back(a, r);
  }
  try {
    TurnedProfile profile = TurnedProfile::from_points(meridional);
    if (!(profile.profile.deviation <= ends_within * fit.extent)) return std::nullopt;
    out.kind = profile.frame == kernels::MeridionalFrame{} ? SlipKind::revolution : SlipKind::meridional;
    out.origin = frame.origin();
    out.direction = frame.direction();
    out.baseline_deviation = profile.profile.deviation;
    out.profile = std::move(profile.profile);
    out.frame = profile.frame;
    return out;
  } catch (MotionError const&) {
    return std::nullopt;
  }
}

/// Whether a surface meets a side at more than 45 degrees, in the mean over its facets there.
bool is_steep(PatchSurface const& surface, TargetSide const& side) {
  double along = 0, all = 0;
  auto const add = [&](Vec3 const& p, Vec3 const& normal) {
    double const length = norm(normal);
    if (!(length > 0)) return;
    Vec3 const step = (1e-3 * surface.size / length) * normal;
    along += std::abs(side.height(p + step) - side.height(p - step)) / 2e-3;
    all += surface.size;
  };
  auto const on = [&](int v) { return v >= 0 && std::abs(side.height(surface.points[v])) <= side.within(); };
  if (surface.lines) {
    for (PatchGrid const& grid : surface.grids)
      for (GridFacet const& f : grid.faces)
        for (int const end : {0, 1})
          if (on(f[end])) {
            Vec3 const t = surface.points[f[1]] - surface.points[f[0]];
            add(surface.points[f[end]], {-t.y, t.x, 0});
          }
  } else {
    for (GridFacet const& f : surface.facets())
      if (std::count_if(f.begin(), f.end(), on) >= 2)
        for (int const v : f)
          if (on(v)) add(surface.points[v], facet_normal(surface.points, f));
  }
  return along < 0.7 * all;
}

}  // namespace

Vec3 TargetSide::crossing(Vec3 const& p, Vec3 const& q) const {
  double from = height(p), to = height(q);
  if (surface_.kind == SlipKind::plane) {
    Vec3 const at = p + (from / (from - to)) * (q - p);
    return at - surface_.view().offset(at) * surface_.direction;
  }
  // Regula falsi, the height of an end that stays halved (Illinois).
  double low = 0, high = 1, share = 0;
  int stays = 0;
  for (int n = 0; n < 60 && high - low > 1e-16; ++n) {
    share = (low * to - high * from) / (to - from);
    double const h = height(p + share * (q - p));
    if (h == 0) break;
    bool const is_low = (h > 0) == (from > 0);
    (is_low ? low : high) = share;
    (is_low ? from : to) = h;
    if (stays == (is_low ? 1 : -1)) (is_low ? to : from) *= 0.5;
    stays = is_low ? 1 : -1;
  }
  return p + share * (q - p);
}

std::vector<Vec3> TargetSide::way(Vec3 const& p, Vec3 const& q, Vec3 const& normal, double tolerance) const {
  double const length = distance(p, q);
  if (surface_.kind == SlipKind::plane || !(length > 0) || !(norm(normal) > 0)) return {};
  Vec3 const across = (1 / norm(normal)) * cross(normal, (1 / length) * (q - p));
  // The place beside the straight way at which the side is met, by secants.
  auto const on_side = [&](Vec3 const& from) {
    double at = 0, h = height(from), last = 0, last_h = h;
    for (int n = 0; n < 30 && std::abs(h) > 1e-3 * tolerance; ++n) {
      double const slope = n == 0 ? 1 : (h - last_h) / (at - last);
      if (!(std::abs(slope) > 1e-3)) break;
      last = std::exchange(at, at - h / slope);
      last_h = std::exchange(h, height(from + at * across));
      if (!(std::abs(at) < length)) return from;
    }
    return std::abs(h) > tolerance ? from : from + at * across;
  };
  Vec3 const middle = 0.5 * (p + q);
  double const sag = distance(on_side(middle), middle);
  constexpr double most = 256;
  int const pieces = int(std::min(most, std::ceil(std::sqrt(sag / tolerance))));
  std::vector<Vec3> out;
  for (int k = 1; k < pieces; ++k) out.push_back(on_side(p + (double(k) / pieces) * (q - p)));
  return out;
}

std::vector<TargetSide> sides_beside(Boundary const& boundary, PatchSurface const& surface, BesideTarget const& beside,
                                     Axis const& axis) {
  std::vector<TargetSide> out;
  for (SlipSurface const& slide : beside.slides)
    if (auto side = as_side(slide, surface)) out.push_back(std::move(*side));
  for (auto const* patches : {&beside.fixed, &beside.free})
    for (int const p : *patches) {
      auto pieces = flat_pieces(boundary, p);
      if (pieces.empty()) pieces.push_back(boundary.surface(p).nodes);
      for (auto const& nodes : pieces) {
        auto const points = boundary.points_of(nodes);
        auto const has = [&](Vec3 const& x) { return surface.numbers.find(x) >= 0; };
        if (std::none_of(points.begin(), points.end(), has)) continue;
        auto const through = surface_through(points, axis);
        auto side = through ? as_side(*through, surface) : std::nullopt;
        if (side && is_steep(surface, *side)) out.push_back(std::move(*side));
      }
    }
  return out;
}

std::vector<char> vertices_on(Boundary const& boundary, PatchSurface const& surface, std::vector<int> const& patches) {
  std::vector<char> out(surface.points.size(), 0);
  for (int const p : patches)
    for (Index const n : boundary.surface(p).nodes)
      if (int const v = surface.numbers.find(boundary.coordinates()[n]); v >= 0) out[v] = 1;
  return out;
}

TargetTree cut_at_sides(TargetTree target, std::vector<TargetSide> const& sides) {
  for (TargetSide const& side : sides) {
    auto const is_beyond = [&](Vec3 const& p) { return side.height(p) < -side.within(); };
    if (std::any_of(target.points().begin(), target.points().end(), is_beyond)) target = Cut(target, side).run();
  }
  return target;
}

std::vector<std::pair<Vec3, Vec3>> cut_at_sides(std::vector<std::pair<Vec3, Vec3>> lines,
                                                std::vector<TargetSide> const& sides) {
  for (TargetSide const& side : sides) {
    std::vector<std::pair<Vec3, Vec3>> kept;
    for (auto const& [p, q] : lines) {
      double const from = side.height(p), to = side.height(q);
      if (from <= side.within() && to <= side.within()) continue;
      kept.emplace_back(from < -side.within() ? side.crossing(p, q) : p, to < -side.within() ? side.crossing(p, q) : q);
    }
    if (!kept.empty()) lines = std::move(kept);
  }
  return lines;
}

}  // namespace gridmorph
