#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/motion/inflation_heights.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace gridmorph {

namespace {

double shape_of_bulb(Bulb::Shape shape, double r2) {
  switch (shape) {
    case Bulb::Shape::cosine: return 0.5 + 0.5 * std::cos(std::numbers::pi * std::sqrt(r2));
    case Bulb::Shape::parabola: return 1 - r2;
    case Bulb::Shape::bump: return std::exp(1 - 1 / (1 - r2));
  }
  return 0;
}

void check_bulb(Bulb const& bulb, std::string const& name, Problems& problems) {
  std::set<double> stations{0};
  for (SpanwiseTable const* table : {&bulb.position, &bulb.extent, &bulb.height})
    for (auto const& [span, value] : table->stations) {
      if (!std::isfinite(span) || !std::isfinite(value)) {
        problems.add(name + ": a value of its tables is not finite");
        return;
      }
      stations.insert(span);
    }
  if (bulb.span && !(std::isfinite(*bulb.span) && std::isfinite(bulb.span_extent) && bulb.span_extent > 0))
    problems.add(name + ": its extent along the span is " + to_text(bulb.span_extent, 4) + "; it must be positive");
  for (double const h : stations) {
    double const extent = bulb.extent.at(h), reach = std::abs(bulb.position.at(h)) + extent;
    if (!(extent > 0)) {
      problems.add(name + ": its extent along the contour is " + to_text(extent, 4) + " chords at span fraction " +
                   to_text(h, 4) + "; it must be positive");
      return;
    }
    if (reach > 1) {
      problems.add(
          name + ": it reaches " + to_text(reach, 4) + " chords from its edge at span fraction " + to_text(h, 4) +
          ", around the other edge; keep position and extent together within 1, or measure from the other edge");
      return;
    }
  }
}

}  // namespace

double Bulb::at(SurfacePlace const& place) const {
  double const from = edge == Edge::leading ? place.from_leading_edge : place.from_trailing_edge;
  double const along =
      (place.side * from / place.chord - position.at(place.span_fraction)) / extent.at(place.span_fraction);
  double const across = span ? (place.span_fraction - *span) / span_extent : 0.0;
  double const r2 = along * along + across * across;
  return r2 < 1 ? height.at(place.span_fraction) * shape_of_bulb(shape, r2) : 0.0;
}

InflateRule make_bulbs(std::vector<Bulb> bulbs, InflateRule::Sections const& sections) {
  Problems problems;
  for (std::size_t k = 0; k < bulbs.size(); ++k) check_bulb(bulbs[k], "bulb " + std::to_string(k + 1), problems);
  problems.throw_if_any<MotionError>();
  InflateRule rule;
  rule.description = bulbs.size() == 1 ? "a bulb" : std::to_string(bulbs.size()) + " bulbs";
  rule.sections = sections;
  // Around an edge both sides are alike.
  rule.sections->sides = std::any_of(bulbs.begin(), bulbs.end(), [](Bulb const& b) { return !b.position.is_zero(); });
  rule.most_chords = 1;
  rule.height = [bulbs = std::move(bulbs)](std::span<SurfacePlace const> places, std::span<double> height) {
    for (std::size_t n = 0; n < places.size(); ++n) {
      height[n] = 0;
      for (Bulb const& bulb : bulbs) height[n] += bulb.at(places[n]);
    }
  };
  return rule;
}

}  // namespace gridmorph
