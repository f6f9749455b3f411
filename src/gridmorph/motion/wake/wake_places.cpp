#include <gridmorph/motion/wake/wake_places.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace gridmorph {

namespace {

/// Copies whose places differ by less than this share of the chord are as good as each other: the point itself is
/// taken.
constexpr double alike = 1e-9;

double off_middle(WakePlace const& place) { return std::abs(place.across) + std::max(0.0, -place.behind); }

}  // namespace

WakePlaces::WakePlaces(Boundary const& boundary, ResolvedMotion const& motion, SectionsRule const& rule,
                       std::vector<int> const& patches, SlipSurfaces const& surfaces, std::optional<double> angle_rad,
                       std::vector<std::string>& notes)
    : places_(boundary, motion, rule, patches, surfaces, notes), angle_rad_(angle_rad) {
  for (RigidTransform const& to_donor : periodic_transforms_of_row(boundary, patches)) {
    copies_.push_back(to_donor);
    copies_.push_back(to_donor.inverse());
  }
}

WakePlace WakePlaces::at(Vec3 const& point) const {
  WakePlace best = place(point);
  for (RigidTransform const& copy : copies_) {
    WakePlace const other = place(copy(point));
    if (off_middle(other) >= off_middle(best) - alike * best.chord) continue;
    best = other;
    best.image = copy;
  }
  return best;
}

WakePlace WakePlaces::place(Vec3 const& point) const {
  SectionPoint const in_section = places_.frame().at(point);
  auto const [blade, line, at] = places_.nearest(in_section);
  ChordPoint const inner{(1 - last_part) * line.length,
                         blade->has_camber() ? blade->camber(in_section.span, line.length, 1 - last_part) : 0.0};
  ChordPoint const edge{line.length, 0};
  auto const to = [&line = line, &at = at](ChordPoint const& goal) {
    double const x = goal.along - at.along, y = goal.across - at.across;
    return std::array{line.cos_stagger * x - line.sin_stagger * y,
                      (line.sin_stagger * x + line.cos_stagger * y) / line.scale};
  };
  // From the chord line.
  double const angle = angle_rad_ ? *angle_rad_ - std::atan2(line.sin_stagger, line.cos_stagger)
                                  : std::atan2(-inner.across, edge.along - inner.along);
  double const x = at.along - edge.along, y = at.across - edge.across;
  return {{},
          std::cos(angle) * x + std::sin(angle) * y,
          std::cos(angle) * y - std::sin(angle) * x,
          to(edge),
          to(inner),
          line.scale,
          line.length};
}

}  // namespace gridmorph
