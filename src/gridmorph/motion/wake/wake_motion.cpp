#include <gridmorph/motion/along_walls.hpp>

#include <gridmorph/geometry/smoothstep.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace gridmorph {

namespace {

SectionsRule section_search(WakeRule const& rule) {
  SectionsRule out;
  out.sections = rule.sections;
  out.span = rule.span;
  out.flow = rule.flow;
  return out;
}

}  // namespace

WakeMotion::WakeMotion(Boundary const& boundary, ResolvedMotion const& motion, WakeRule const& rule,
                       std::vector<int> const& patches, SlipSurfaces const& surfaces,
                       WallFaces::Displacement const& displacement, std::vector<std::string>& notes, Beside beside)
    : rule_(rule),
      places_(boundary, motion, section_search(rule), patches, surfaces, {}, notes),
      walls_(boundary, patches, displacement),
      beside_(std::move(beside)) {}

Vec3 WakeMotion::displacement(Vec3 const& point) const {
  WakePlace const place = places_.at(point);
  Vec3 const x = place.image ? (*place.image)(point) : point;
  Vec3 u = behind_edge(x, place);
  double const reach = WakePlaces::last_part * place.chord;
  if (auto const wall = nearest_within(x, reach)) {
    double const share = 1 - smoothstep(distance(x, wall->point) / reach);
    u += share * (wall->displacement - behind_edge(wall->point, places_.at(wall->point)));
  }
  return place.image ? place.image->inverse().rotation * u : u;
}

std::optional<WallFaces::Place> WakeMotion::nearest_within(Vec3 const& x, double reach) const {
  std::optional<WallFaces::Place> best = walls_.nearest_within(x, reach);
  for (RigidTransform const& copy : places_.copies()) {
    // Of places at equal distances that of the walls themselves.
    double const so_far = best ? (1 - 1e-9) * distance(x, best->point) : reach;
    auto const other = walls_.nearest_within(copy(x), so_far);
    if (!other) continue;
    RigidTransform const back = copy.inverse();
    best = {back(other->point), back.rotation * other->displacement};
  }
  return best;
}

WallFaces::Place WakeMotion::nearest(Vec3 const& x) const {
  return *nearest_within(x, std::numeric_limits<double>::infinity());
}

Vec3 WakeMotion::behind_edge(Vec3 const& x, WakePlace const& place) const {
  double const share = rule_.fade ? 1 - smoothstep(place.behind / *rule_.fade) : 1.0;
  Vec3 const beside = share < 1 && beside_ ? (1 - share) * beside_(x) : Vec3{};
  if (share == 0) return beside;
  SectionFrame const& frame = places_.frame();
  WallFaces::Place const edge = nearest(x + frame.displacement(x, place.to_edge[0], place.to_edge[1]));
  WallFaces::Place const camber = nearest(x + frame.displacement(x, place.to_camber[0], place.to_camber[1]));
  // In the plane of the section, from the camber line to the edge.
  auto const way = [&](Vec3 const& from, Vec3 const& to) {
    SectionPoint const a = frame.at(from), b = frame.at(to);
    double const dt = frame.period() > 0 ? std::remainder(b.t - a.t, frame.period()) : b.t - a.t;
    return std::array{b.s - a.s, place.scale * dt};
  };
  auto const before = way(camber.point, edge.point),
             after = way(camber.point + camber.displacement, edge.point + edge.displacement);
  double const angle =
      rule_.turn * std::atan2(before[0] * after[1] - before[1] * after[0], before[0] * after[0] + before[1] * after[1]);
  double const s = -place.to_edge[0], y = -place.scale * place.to_edge[1];
  double const c = std::cos(angle) - 1, d = std::sin(angle);
  return beside + share * (frame.carried(edge.point, edge.displacement, x) +
                           frame.displacement(x, c * s - d * y, (d * s + c * y) / place.scale));
}

}  // namespace gridmorph
