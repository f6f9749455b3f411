#include <gridmorph/fillet/root_sections.hpp>

#include <gridmorph/geometry/smoothstep.hpp>
#include <gridmorph/geometry/unit.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph {

namespace {

/// Radii off the new wall up to which layers keep their distance, and from which on nodes stay.
constexpr double kept = 0.3, stays = 0.9;

/// Radii off the farther wall up to which chosen places are brought to the mitre, and from which on they are not.
constexpr double brought = 0.15, left = 1.4;
/// The share by which a place is left alone: 0 where it is brought to the mitre, 1 where it stays.
double left_alone(std::array<double, 2> const& off, double radius) {
  return radius > 0 ? smoothstep((std::max(off[0], off[1]) / radius - brought) / (left - brought)) : 1;
}

double mean_of_powers(double a, double b, double share) { return std::pow(a, 1 - share) * std::pow(b, share); }

Vec3 between(Vec3 const& a, Vec3 const& b, double share) {
  double const angle = std::atan2(norm(cross(a, b)), dot(a, b));
  if (angle < 1e-9) return a;
  return (1 / std::sin(angle)) * (std::sin((1 - share) * angle) * a + std::sin(share * angle) * b);
}

}  // namespace

void Relation::add(double x, double y) {
  if (x <= x_.back() || y <= y_.back()) return;
  x_.push_back(x);
  y_.push_back(y);
}

double Relation::operator()(double x) const {
  if (x >= x_.back()) return y_.back() + (x - x_.back());
  auto const k = std::size_t(std::upper_bound(x_.begin(), x_.end(), x) - x_.begin());
  if (k == 0) return 0;
  return y_[k - 1] + (y_[k] - y_[k - 1]) * (x - x_[k - 1]) / (x_[k] - x_[k - 1]);
}

MitreRelations::MitreRelations(std::vector<MitrePlace> const& places, std::vector<std::array<double, 2>> const& off,
                               double radius) {
  std::size_t count = 0;
  double last = 0;
  for (; count < off.size() && std::max(off[count][0], off[count][1]) < left * radius; ++count)
    last = std::max({last, off[count][0], off[count][1]});
  for (std::size_t k = 0; k < count; ++k) {
    double const share = left_alone(off[k], radius);
    for (std::size_t w = 0; w < 2; ++w) {
      double const own = off[k][w], other = off[k][1 - w];
      double const height = mean_of_powers(std::sqrt(2 / (1 / (own * own) + 1 / (other * other))), own, share);
      if (k == 0 || places[k - 1].layer[w] != places[k].layer[w]) {
        first_[w].add(own, height);
        // A line that comes to the mitre much nearer than it begins would lie flat on the wall.
        start_[1 - w].add(own, own * std::sqrt(std::min(1.0, mean_of_powers(other, own, share) / own)));
      }
      if (k + 1 == count || places[k + 1].layer[w] != places[k].layer[w]) last_[w].add(own, height);
    }
  }
  double const end = std::max(radius, 1.2 * last);
  for (std::size_t w = 0; w < 2; ++w)
    for (Relation* r : {&first_[w], &last_[w], &start_[w]}) r->add(end, end);
}

Vec3 BetweenSections::across() const { return unit(mean(a_.across, b_.across)); }

Vec3 BetweenSections::turned(Vec3 const& a, Vec3 const& b) const {
  Vec3 const v = mean(a, b);
  double const length = norm(v);
  return length > 0 ? (mean(norm(a), norm(b)) / length) * v : v;
}

WallPoint BetweenSections::wall_at(int w, double s) const {
  WallPoint const a = a_.wall[w].at(s), b = b_.wall[w].at(s);
  return {turned(a.point, b.point), unit(mean(a.normal, b.normal))};
}

CornerPoint BetweenSections::point(std::array<double, 2> const& off) const {
  double const angle = mean(a_.angle_rad, b_.angle_rad), c = std::cos(angle), s = std::sin(angle);
  return {off, {(off[1] + off[0] * c) / s, (off[0] + off[1] * c) / s}};
}

BetweenSections::Arc BetweenSections::arc(int w, double share) const {
  WallPoint const contact = wall_at(w, mean(a_.contact[w], b_.contact[w]));
  Vec3 const centre = turned(a_.centre, b_.centre), over_contact = contact.point + radius() * contact.normal;
  return {centre + share * (over_contact - centre),
          between(unit(mean(a_.to_middle, b_.to_middle)), -contact.normal, share)};
}

Vec3 BetweenSections::middle() const {
  Arc const at = arc(0, 0);
  return root() + at.centre + radius() * at.outwards;
}

Vec3 BetweenSections::on_arc(Vec3 const& p, int wall, double arc_share) const {
  Arc const at = arc(wall, arc_share);
  Vec3 const from_centre = p - root() - at.centre, line = across();
  Vec3 const beside = dot(from_centre, line) * line;
  return root() + at.centre + beside + radius() * unit(from_centre - beside);
}

CornerMove BetweenSections::move(Vec3 const& at, CornerPoint const& p, bool in_mitre) const {
  CornerMove out;
  auto const of = [&](Relation const& (MitreRelations::*relation)(int) const, int wall, double x) {
    return mean((a_.mitre.*relation)(wall)(x), (b_.mitre.*relation)(wall)(x));
  };
  std::array<double, 2> const height{of(&MitreRelations::last, 0, p.off[0]), of(&MitreRelations::last, 1, p.off[1])};
  out.wall = height[0] <= height[1] ? 0 : 1;
  auto const w = std::size_t(out.wall);
  double const off = p.off[w], other = p.off[1 - w], along = p.along[w], r = radius(), to = reach();
  if (!(r > 0) || along >= to) return out;
  double const contact = mean(a_.contact[w], b_.contact[w]), half_arc = mean(a_.half_arc, b_.half_arc);

  // Along the new wall from the middle of the arc; lines leave the wall upright and bend towards the mitre.
  double const line_end = of(&MitreRelations::first, 1 - out.wall, other);
  double bent = line_end > 0 ? std::min(height[w] / line_end, 1.0) : 0;
  bent *= bent;
  if (in_mitre) bent += (1 - left_alone(p.off, r)) * (1 - bent);
  double const bend = out.bend = bent * (1 - smoothstep((along - contact) / (to - contact)));
  double const start = out.start = other > 0 ? of(&MitreRelations::start, out.wall, other) / other : 1;
  double const way = start * (along - (contact - half_arc) * smoothstep(along / to)) * (1 - bend);
  // Layers are as far from the new wall as from the old one, and go over to the height of the mitre on the arc.
  double const h = off > 0 ? off * std::pow(height[w] / off, 1 - smoothstep(way / half_arc)) : 0;
  out.still = smoothstep((h / r - kept) / (stays - kept));
  out.on_arc = way < half_arc;
  out.arc_share = std::clamp(way / half_arc, 0.0, 1.0);
  Vec3 to_place;
  if (out.on_arc) {
    Arc const ball = arc(out.wall, out.arc_share);
    to_place = ball.centre + (r - h) * ball.outwards;
  } else {
    WallPoint const foot = wall_at(out.wall, way + (contact - half_arc));
    to_place = foot.point + h * foot.normal;
  }
  // What a node is beside its place between the walls it stays, but on the mitre, where both walls have the same place
  // for it.
  WallPoint const wall = wall_at(out.wall, along);
  Vec3 const from = wall.point + off * wall.normal, beside = at - root() - from;
  out.shift = (1 - out.still) * (to_place - from - bent * beside);
  return out;
}

}  // namespace gridmorph
