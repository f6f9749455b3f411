#include <gridmorph/motion/wake/wake_regions.hpp>

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/wake/wake_places.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gridmorph {

namespace {

/// What the places look at lives as long as they do.
struct Wake {
  std::shared_ptr<Boundary const> boundary;
  ResolvedMotion motion;
  std::vector<std::string> notes;
  SlipSurfaces surfaces;
  WakePlaces places;
  double length, half_width;

  Wake(std::shared_ptr<Boundary const> of, ResolvedMotion resolved, InnerRegion::Wake const& wake)
      : boundary(std::move(of)),
        motion(std::move(resolved)),
        surfaces(*boundary, motion, notes),
        places(*boundary, motion, search(wake), boundary->select_patches(wake.of), surfaces, wake.angle_rad, notes),
        length(wake.length),
        half_width(wake.width / 2) {}

  static SectionsRule search(InnerRegion::Wake const& wake) {
    SectionsRule out;
    out.sections = wake.of_wing ? SectionsRule::Sections::wing : SectionsRule::Sections::blade;
    out.span = wake.span;
    out.flow = wake.flow;
    return out;
  }
  [[nodiscard]] bool holds(Vec3 const& point) const {
    WakePlace const at = places.at(point);
    return at.behind >= 0 && at.behind <= length && std::abs(at.across) <= half_width;
  }
};

}  // namespace

bool have_wakes(std::span<InnerRegion const> regions) {
  return std::any_of(regions.begin(), regions.end(), [](InnerRegion const& r) { return r.wake.has_value(); });
}

Motion without_regions(NamedBoundary const& boundary, Motion motion) {
  auto const about_region = [&](std::string const& selector) {
    if (selector == "type:region") return true;
    bool const any = std::any_of(motion.regions.begin(), motion.regions.end(),
                                 [&](InnerRegion const& r) { return glob_match(selector, r.name); });
    return any && boundary.select(selector).empty();
  };
  std::vector<MotionRule> kept;
  for (MotionRule& rule : motion.rules) {
    std::erase_if(rule.patches, about_region);
    if (!rule.patches.empty()) kept.push_back(std::move(rule));
  }
  motion.rules = std::move(kept);
  motion.regions.clear();
  motion.strict = false;
  return motion;
}

std::vector<InnerRegion> locate_wakes(std::shared_ptr<Boundary const> const& boundary, ResolvedMotion const& motion,
                                      std::span<InnerRegion const> regions, std::vector<std::string>& notes) {
  std::vector<InnerRegion> out(regions.begin(), regions.end());
  Problems problems;
  for (InnerRegion& region : out) {
    if (!region.wake) continue;
    try {
      auto const wake = std::make_shared<Wake const>(boundary, motion, *region.wake);
      for (std::string const& note : wake->notes)
        if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
      region.holds = [wake, other = region.holds](Vec3 const& p) { return wake->holds(p) && (!other || other(p)); };
    } catch (MotionError const& e) {
      problems.add("region '" + region.name + "'" + (region.where.empty() ? "" : " (" + region.where + ")") +
                   ": wake: " + e.what());
    }
  }
  problems.throw_if_any<MotionError>();
  return out;
}

}  // namespace gridmorph
