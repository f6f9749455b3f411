#include <generators/passage_geometry.hpp>
#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph {

BladeTip blade_tip(std::string const& wanted) {
  for (BladeTip const tip : {BladeTip::none, BladeTip::flat, BladeTip::squealer, BladeTip::groove})
    if (name(tip) == wanted) return tip;
  throw ConfigError("passage demo: there is no tip '" + wanted + "'; choose 'none', 'flat', 'squealer' or 'groove'");
}

std::string_view name(BladeTip tip) {
  static constexpr std::array<std::string_view, 4> names{"none", "flat", "squealer", "groove"};
  return names[std::size_t(tip)];
}

std::vector<std::string> blade_families(BladeTip tip) {
  std::vector<std::string> families{"blade"};
  if (tip != BladeTip::none) families.emplace_back("tip");
  if (tip == BladeTip::squealer || tip == BladeTip::groove) families.emplace_back(name(tip));
  return families;
}

namespace passage {

namespace {

constexpr double radians(double degrees) { return degrees * std::numbers::pi / 180; }

double sinc(double z) { return std::abs(z) < 1e-8 ? 1 : std::sin(z) / z; }

/// Parabola through the values at span 0, 1/2 and 1.
double along_span(std::array<BladeSection, 3> const& s, double BladeSection::*value, double h) {
  return s[0].*value * (1 - h) * (1 - 2 * h) + s[1].*value * 4 * h * (1 - h) + s[2].*value * h * (2 * h - 1);
}

void check_section(BladeSection const& s, std::string const& where, Problems& problems) {
  if (!(s.chord > 0)) problems.add(where + " chord is " + std::to_string(s.chord) + "; it must be positive");
  if (!(std::abs(s.inlet_angle_deg) <= 70) || !(std::abs(s.outlet_angle_deg) <= 70))
    problems.add(where + " camber angles are " + std::to_string(s.inlet_angle_deg) + " and " +
                 std::to_string(s.outlet_angle_deg) + " degrees; they must lie within -70 and 70");
  if (!(s.thickness > 0 && s.thickness <= 0.3))
    problems.add(where + " thickness is " + std::to_string(s.thickness) + " chords; it must lie within 0 and 0.3");
  if (!(s.leading_radius > 0 && s.leading_radius <= 0.1) || !(s.trailing_radius > 0 && s.trailing_radius <= 0.1))
    problems.add(where + " edge radii are " + std::to_string(s.leading_radius) + " and " +
                 std::to_string(s.trailing_radius) + " chords; they must lie within 0 and 0.1");
}

void check_tip(PassageOptions const& o, Problems& problems) {
  if (!(o.tip_gap > 0 && o.tip_gap <= 0.2))
    problems.add("passage: the tip gap is " + std::to_string(o.tip_gap) + " of the span; it must lie within 0 and 0.2");
  if (!(o.tip_depth > 0 && o.tip_depth <= 0.3))
    problems.add("passage: the depth at the tip is " + std::to_string(o.tip_depth) +
                 " of the span; it must lie within 0 and 0.3");
  if (!(o.tip_core >= 0.1 && o.tip_core <= 0.9))
    problems.add("passage: the width at the tip is " + std::to_string(o.tip_core) +
                 " of the thickness; it must lie within 0.1 and 0.9");
}

}  // namespace

double length(Point2 a) { return std::hypot(a.x, a.y); }

Point2 direction(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

void check(PassageOptions const& o) {
  Problems problems;
  if (o.nodes < 10'000) problems.add("passage: nodes is " + std::to_string(o.nodes) + "; ask for at least 10000");
  if (o.blades < 3) problems.add("passage: blades is " + std::to_string(o.blades) + "; it must be at least 3");
  if (!(o.outlet > o.inlet))
    problems.add("passage: the outlet (axial " + std::to_string(o.outlet) +
                 ") must lie downstream of the inlet (axial " + std::to_string(o.inlet) + ")");
  if (!(o.ring_thickness > 0) || !(o.first_cell > 0) || !(o.first_cell < o.ring_thickness))
    problems.add("passage: the first cell (" + std::to_string(o.first_cell) +
                 " chords) must be positive and thinner than the ring (" + std::to_string(o.ring_thickness) +
                 " chords)");
  if (!(o.end_wall_first_cell > 0 && o.end_wall_first_cell < 0.5))
    problems.add("passage: end_wall_first_cell is " + std::to_string(o.end_wall_first_cell) +
                 " of the span; it must lie within 0 and 0.5");
  if (!(o.max_growth > 1) || !(o.end_wall_max_growth > 1))
    problems.add("passage: max_growth is " + std::to_string(o.max_growth) + " and end_wall_max_growth " +
                 std::to_string(o.end_wall_max_growth) + "; both must exceed 1");
  if (o.tip != BladeTip::none) check_tip(o, problems);
  static constexpr std::array<char const*, 3> place{"passage: hub section", "passage: mid-span section",
                                                    "passage: case section"};
  for (std::size_t n = 0; n < 3; ++n) check_section(o.sections[n], place[n], problems);
  problems.throw_if_any<ConfigError>();

  Annulus const annulus(o);
  for (int n = 0; n <= 20; ++n) {
    double const x = o.inlet + (o.outlet - o.inlet) * n / 20;
    if (!(annulus.hub(x) > 0) || !(annulus.casing(x) > annulus.hub(x))) {
      problems.add("passage: at axial " + std::to_string(x) + " the hub radius is " + std::to_string(annulus.hub(x)) +
                   " and the case radius " + std::to_string(annulus.casing(x)) +
                   "; they must be positive and ascending");
      break;
    }
  }
  for (double const span : {0.0, 0.5, 1.0}) {
    Airfoil const airfoil(o, span);
    double const edge = 0.5 * airfoil.chord() * std::cos(airfoil.stagger());
    double const ring = o.ring_thickness * airfoil.chord();
    if (-edge - 2 * ring < o.inlet || edge + 2 * ring > o.outlet)
      problems.add("passage: at span " + std::to_string(span) + " the blade and its ring reach from axial " +
                   std::to_string(-edge - 2 * ring) + " to " + std::to_string(edge + 2 * ring) +
                   ", beyond inlet or outlet; move these away or shorten the chord");
    double const pitch = 2 * std::numbers::pi * annulus.section_radius(span) / o.blades;
    double const needed = 2 * ring + o.sections[1].thickness * airfoil.chord();
    if (pitch * std::cos(airfoil.stagger()) < 1.5 * needed)
      problems.add("passage: at span " + std::to_string(span) + " the pitch is " + std::to_string(pitch) +
                   ", too narrow for the blade and its ring; use fewer blades, a shorter chord or a thinner ring");
  }
  problems.throw_if_any<ConfigError>();
}

Annulus::Annulus(PassageOptions const& o)
    : hub_(o.hub), casing_(o.casing), inlet_(o.inlet), length_(o.outlet - o.inlet) {}

double Annulus::radius_of(EndWall const& w, double axial) const {
  double const t = (axial - inlet_) / length_;
  double const rise = (1 - w.curving) * t + w.curving * t * t * (3 - 2 * t);
  double const bump = t * (1 - t);
  return w.inlet_radius + (w.outlet_radius - w.inlet_radius) * rise + w.bulge * 16 * bump * bump;
}

double Annulus::span_fraction(double axial, double radius) const {
  double const r = hub(axial);
  return (radius - r) / (casing(axial) - r);
}

Vec3 Annulus::unroll(Point2 p, double span, double section_radius) const {
  double const r = radius(p.x, span), theta = p.y / section_radius;
  return {p.x, r * std::cos(theta), r * std::sin(theta)};
}

Airfoil::Airfoil(PassageOptions const& o, double span) {
  auto const at_span = [&](double BladeSection::*value) { return along_span(o.sections, value, span); };
  chord_ = at_span(&BladeSection::chord);
  inlet_angle_ = radians(at_span(&BladeSection::inlet_angle_deg));
  outlet_angle_ = radians(at_span(&BladeSection::outlet_angle_deg));
  arc_ = chord_ / sinc(0.5 * (outlet_angle_ - inlet_angle_));
  // Near the leading edge half thickness^2 = a^2 u, a circle of radius a^2 / 2; the same with a + b at the other end.
  a_ = std::sqrt(2 * at_span(&BladeSection::leading_radius));
  b_ = std::sqrt(2 * at_span(&BladeSection::trailing_radius)) - a_;
  c_ = 4 * (at_span(&BladeSection::thickness) - (a_ + 0.5 * b_));
}

Point2 Airfoil::camber_point(double u) const {
  // A circular arc whose direction turns evenly: the integral of direction(inlet_angle + turn u).
  double const half_turn = 0.5 * (outlet_angle_ - inlet_angle_) * u;
  return arc_ * u * sinc(half_turn) * direction(inlet_angle_ + half_turn) - 0.5 * chord_ * direction(stagger());
}

double Airfoil::half_thickness(double phi) const {
  double const u = 0.5 * (1 - std::cos(phi));
  return 0.5 * chord_ * std::sin(phi) * (a_ + b_ * u + c_ * u * (1 - u));
}

Point2 Airfoil::off_camber(double u, double distance) const {
  double const angle = inlet_angle_ + (outlet_angle_ - inlet_angle_) * u;
  return camber_point(u) + distance * Point2{-std::sin(angle), std::cos(angle)};
}

Point2 Airfoil::point(double phi) const { return off_camber(0.5 * (1 - std::cos(phi)), half_thickness(phi)); }

Point2 Airfoil::tangent(double phi) const {
  double const u = 0.5 * (1 - std::cos(phi)), du = 0.5 * std::sin(phi);
  double const shape = a_ + b_ * u + c_ * u * (1 - u);
  double const half = 0.5 * chord_ * std::sin(phi) * shape;
  double const dhalf = 0.5 * chord_ * (std::cos(phi) * shape + std::sin(phi) * (b_ + c_ * (1 - 2 * u)) * du);
  double const turn = outlet_angle_ - inlet_angle_, angle = inlet_angle_ + turn * u;
  Point2 const along = direction(angle), across{-along.y, along.x};
  return (arc_ - half * turn) * du * along + dhalf * across;
}

double Airfoil::camber(double axial) const {
  Point2 const edge = -0.5 * chord_ * direction(stagger());
  if (axial <= edge.x) return edge.y + (axial - edge.x) * std::tan(inlet_angle_);
  if (axial >= -edge.x) return -edge.y + (axial + edge.x) * std::tan(outlet_angle_);
  // On the arc sin(angle) is linear in the axial position.
  double const s = std::sin(inlet_angle_) + (outlet_angle_ - inlet_angle_) * (axial - edge.x) / arc_;
  return edge.y + (axial - edge.x) * std::tan(0.5 * (inlet_angle_ + std::asin(std::clamp(s, -1.0, 1.0))));
}

}  // namespace passage

}  // namespace gridmorph
