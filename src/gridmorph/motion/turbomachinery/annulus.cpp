#include <gridmorph/motion/turbomachinery/row_motion.hpp>

#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace gridmorph {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

std::pair<double, double> axial_range(std::vector<MeridionalPoint> const& points) {
  std::pair<double, double> range{inf, -inf};
  for (MeridionalPoint const& p : points) range = {std::min(range.first, p.axial), std::max(range.second, p.axial)};
  return range;
}

bool is_revolution(SlipSurface const& s) {
  return s.kind == SlipSurface::Kind::revolution || s.kind == SlipSurface::Kind::meridional;
}

}  // namespace

Annulus::Annulus(SlipSurfaces const& surfaces, std::vector<int> const& candidates,
                 std::vector<MeridionalPoint> const& blade, Walls const& walls) {
  r_lo_ = inf;
  r_hi_ = -inf;
  for (MeridionalPoint const& p : blade) {
    r_lo_ = std::min(r_lo_, p.radius);
    r_hi_ = std::max(r_hi_, p.radius);
  }
  bool meridional = false;
  for (int s : candidates) {
    SlipSurface const& surface = surfaces.surfaces[s];
    meridional = meridional || surface.kind == SlipSurface::Kind::meridional;
    if (surface.kind != SlipSurface::Kind::revolution) continue;
    // Most of the blade lies outside of the hub and inside of the case.
    auto const outside = std::count_if(blade.begin(), blade.end(),
                                       [&](MeridionalPoint const& p) { return p.radius > surface.profile(p.axial); });
    (2 * std::size_t(outside) > blade.size() ? inner_ : outer_).push_back(&surface.profile);
  }
  // A wall that is no function of the axial position makes a row that turns, unless the blade lies where hub and case
  // both are.
  bool const must_turn = meridional && !(has_walls() && spans(blade));
  bool const may_turn = !has_walls() || is_steep_along(blade);
  if (must_turn || may_turn) {
    std::vector<WallPiece> pieces;
    if (walls) {
      pieces = walls();
    } else {
      for (int s : candidates)
        if (SlipSurface const& surface = surfaces.surfaces[s]; is_revolution(surface))
          pieces.push_back({surface.profile, surface.frame, surface.profile.knots.front().axial,
                            surface.profile.knots.back().axial});
    }
    bool const across =
        std::any_of(pieces.begin(), pieces.end(), [](WallPiece const& p) { return p.frame.cosine == 0; });
    try {
      if (must_turn || has_walls() || across) turn(std::move(pieces), blade);
    } catch (MotionError const&) {
      if (must_turn) throw;
    }
  }
  if (!has_walls() && !(r_hi_ > r_lo_))
    throw MotionError("the blade lies at one radius, " + std::to_string(r_lo_) +
                      ": it has no span; check the axis, or give hub and case "
                      "the rule slip on a surface of revolution");
}

void Annulus::turn(std::vector<WallPiece> pieces, std::vector<MeridionalPoint> const& blade) {
  std::vector<WallCurve> curves = chain_walls(std::move(pieces));
  FlowCoordinates flow(std::move(curves[0]), std::move(curves[1]));
  auto const between = std::count_if(blade.begin(), blade.end(), [&](MeridionalPoint const& p) {
    double const h = flow.position(p).h;
    return h > -0.05 && h < 1.05;
  });
  if (10 * std::size_t(between) < 9 * blade.size())
    throw MotionError(
        "only " + std::to_string(between) + " of " + std::to_string(blade.size()) +
        " nodes of the blade lie between the row's two end walls; check the axis, and which patches of the "
        "row slip on a surface of revolution: they must make up one hub and one case");
  turning_.emplace(std::move(flow));
}

bool Annulus::is_steep_along(std::vector<MeridionalPoint> const& blade) const {
  constexpr double steep = 2;
  auto const [lo, hi] = axial_range(blade);
  bool anywhere = false;
  for (Profiles const* profiles : {&inner_, &outer_})
    for (RevolutionProfile const* profile : *profiles) {
      double const begin = std::max(lo, profile->knots.front().axial), end = std::min(hi, profile->knots.back().axial);
      if (end > begin && std::abs((*profile)(end) - (*profile)(begin)) > steep * (end - begin)) return true;
      for (kernels::ProfileKnot const& knot : profile->knots)
        anywhere = anywhere || (knot.axial > lo && knot.axial < hi && std::abs(knot.slope) > steep);
    }
  return anywhere && !spans(blade);
}

bool Annulus::spans(std::vector<MeridionalPoint> const& blade) const {
  auto const [lo, hi] = axial_range(blade);
  double const margin = 0.01 * (hi - lo);
  for (Profiles const* profiles : {&inner_, &outer_}) {
    double begin = inf, end = -inf;
    for (RevolutionProfile const* profile : *profiles) {
      begin = std::min(begin, profile->knots.front().axial);
      end = std::max(end, profile->knots.back().axial);
    }
    if (begin > lo + margin || end < hi - margin) return false;
  }
  return true;
}

RevolutionProfile const& Annulus::at(Profiles const& profiles, double axial) {
  auto const gap = [axial](RevolutionProfile const* p) {
    return std::max({p->knots.front().axial - axial, axial - p->knots.back().axial, 0.0});
  };
  return **std::min_element(profiles.begin(), profiles.end(),
                            [&](auto const* a, auto const* b) { return gap(a) < gap(b); });
}

FlowPosition Annulus::position(MeridionalPoint const& p) const {
  if (turning_) return turning_->position(p);
  double const inner = has_walls() ? at(inner_, p.axial)(p.axial) : r_lo_;
  double const outer = has_walls() ? at(outer_, p.axial)(p.axial) : r_hi_;
  if (!(outer > inner))
    throw MotionError("at axial position " + std::to_string(p.axial) + " the case (radius " + std::to_string(outer) +
                      ") is not outside of the hub (radius " + std::to_string(inner) + "); check the slip rules");
  return {p.axial, (p.radius - inner) / (outer - inner)};
}

double Annulus::height(MeridionalPoint const& p) const {
  if (turning_) return turning_->height(turning_->position(p).m);
  return has_walls() ? at(outer_, p.axial)(p.axial) - at(inner_, p.axial)(p.axial) : r_hi_ - r_lo_;
}

double Annulus::radius_change(MeridionalPoint const& p, double axial) const {
  if (axial == 0 || !has_walls()) return 0;
  double const h = span(p), moved = p.axial + axial;
  return (1 - h) * (at(inner_, moved)(moved) - at(inner_, p.axial)(p.axial)) +
         h * (at(outer_, moved)(moved) - at(outer_, p.axial)(p.axial));
}

CylindricalMotion Annulus::components(MeridionalPoint const& p, CylindricalMotion const& motion) const {
  if (!turning_) return {motion.axial, motion.radial - radius_change(p, motion.axial), motion.angle_rad};
  if (motion.axial == 0 && motion.radial == 0) return motion;
  FlowPosition const from = turning_->position(p),
                     to = turning_->position({p.axial + motion.axial, p.radius + motion.radial});
  return {to.m - from.m, to.h - from.h, motion.angle_rad};
}

CylindricalMotion Annulus::motion(MeridionalPoint const& p, CylindricalMotion const& c) const {
  if (!turning_) return {c.axial, c.radial + radius_change(p, c.axial), c.angle_rad};
  if (c.axial == 0 && c.radial == 0) return c;
  FlowPosition const from = turning_->position(p);
  MeridionalPoint const here = turning_->point(from), there = turning_->point({from.m + c.axial, from.h + c.radial});
  return {there.axial - here.axial, there.radius - here.radius, c.angle_rad};
}

bool ends_row(PatchKind kind) {
  return kind == PatchKind::inflow || kind == PatchKind::outflow || kind == PatchKind::connection;
}

std::vector<WallPiece> walls_of_row(Boundary const& boundary, SlipSurfaces const& surfaces,
                                    std::vector<bool> const& in_row, CylindricalFrame const& frame) {
  struct Extent {
    double lo = inf, hi = -inf;
  };
  constexpr double parallel = 1e-6;
  std::map<int, Extent> extents;
  for (std::size_t p = 0; p < boundary.patches().size(); ++p) {
    int const s = surfaces.of_patch[p];
    Patch const& patch = boundary.patches()[p];
    if (s < 0 || !in_row[patch.zone] || ends_row(patch.kind)) continue;
    SlipSurface const& surface = surfaces.surfaces[s];
    bool const across = surface.kind == SlipSurface::Kind::plane && patch.kind == PatchKind::wall &&
                        norm(cross(surface.direction, frame.direction())) < parallel;
    if (!is_revolution(surface) && !across) continue;
    kernels::MeridionalFrame const own = across ? kernels::MeridionalFrame{0, 1} : surface.frame;
    Extent& e = extents[s];
    for (Vec3 const& point : boundary.points(int(p))) {
      MeridionalPoint const q = frame.meridional(point);
      double const x = own.abscissa(q.axial, q.radius);
      e.lo = std::min(e.lo, x);
      e.hi = std::max(e.hi, x);
    }
  }
  std::vector<WallPiece> pieces;
  for (auto const& [s, e] : extents) {
    if (!(e.hi > e.lo)) continue;
    SlipSurface const& surface = surfaces.surfaces[s];
    if (is_revolution(surface)) {
      pieces.push_back({surface.profile, surface.frame, e.lo, e.hi});
    } else {
      double const axial = frame.meridional(surface.origin).axial;
      pieces.push_back({RevolutionProfile::from_points({{e.lo, -axial}, {e.hi, -axial}}), {0, 1}, e.lo, e.hi});
    }
  }
  return pieces;
}

}  // namespace gridmorph
