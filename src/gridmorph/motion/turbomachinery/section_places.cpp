#include <gridmorph/motion/turbomachinery/section_places.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph {

SectionPlaces::SectionPlaces(Boundary const& boundary, ResolvedMotion const& motion, SectionsRule const& rule,
                             std::vector<int> const& patches, SlipSurfaces const& surfaces,
                             std::vector<std::string>& notes)
    : frame_(rule.sections == SectionsRule::Sections::blade ? blade_frame(boundary, motion, surfaces, patches)
                                                            : wing_frame(boundary, rule, patches)),
      blades_(find_sections(boundary, *frame_, patches, notes)) {}

bool SectionPlaces::have_camber() const {
  return std::all_of(blades_.begin(), blades_.end(), [](auto const& b) { return b.has_camber(); });
}

SectionPlaces::Nearest SectionPlaces::nearest(SectionPoint const& p) const {
  Nearest best;
  double nearest = std::numeric_limits<double>::infinity();
  bool const only = blades_.size() == 1 && blades_.front().images().size() == 1;
  double const period = frame_->period();
  for (SectionGeometry const& blade : blades_) {
    ChordLine const line = blade.chord_line(p.span);
    for (double image : blade.images()) {
      double dt = p.t - image - line.t;
      if (period > 0) dt = std::remainder(dt, period);
      double const x = p.s - line.s, y = line.scale * dt;
      ChordPoint const at{line.cos_stagger * x + line.sin_stagger * y, line.cos_stagger * y - line.sin_stagger * x};
      if (only) return {&blade, line, at};
      double const inside = std::clamp(at.along, 0.0, line.length);
      double const camber = blade.has_camber() ? blade.camber(p.span, line.length, inside / line.length) : 0.0;
      double const off = std::hypot(at.along - inside, at.across - camber);
      if (off < nearest) {
        nearest = off;
        best = {&blade, line, at};
      }
    }
  }
  return best;
}

SurfacePlace SectionPlaces::at(Vec3 const& point) const {
  SectionPoint const p = frame_->at(point);
  auto const [blade, line, at] = nearest(p);
  double const fraction = std::clamp(at.along / line.length, 0.0, 1.0);
  double const camber = blade->has_camber() ? blade->camber(p.span, line.length, fraction) : 0.0;
  SurfacePlace out;
  out.point = point;
  out.span_fraction = p.span;
  out.chord_fraction = fraction;
  out.side = at.across >= camber ? 1 : -1;
  out.chord = line.length;
  out.from_leading_edge = std::hypot(at.along, at.across);
  out.from_trailing_edge = std::hypot(line.length - at.along, at.across);
  return out;
}

}  // namespace gridmorph
