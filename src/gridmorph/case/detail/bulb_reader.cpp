#include <gridmorph/case/detail/rule_kinds.hpp>
#include <gridmorph/case/detail/sections_reader.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/inflation_heights.hpp>

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace gridmorph::casefile {

namespace {

/// A number for the whole span, or [[span fraction, value], ...].
SpanwiseTable read_values(TableReader& table, std::string const& key) {
  if (table.find(key) == nullptr) return {};
  auto const stations = read_stations(table, key);
  check_spans(table, key, key, stations);
  return {stations, SpanwiseTable::Interpolation::spline};
}

Bulb read_bulb(TableReader& table) {
  Bulb bulb;
  if (auto const edge = table.choice("edge", {"leading", "trailing"})) bulb.edge = Bulb::Edge(*edge);
  if (auto const shape = table.choice("shape", {"cosine", "parabola", "bump"})) bulb.shape = Bulb::Shape(*shape);
  bulb.height = read_values(table, "height");
  bulb.extent = read_values(table, "extent");
  bulb.position = read_values(table, "position");
  table.require("height", "height = 0.004, a length, or [[span fraction, length], ...]");
  table.require("extent", "extent = 0.1, in chords along the contour, or [[span fraction, chords], ...]");
  bulb.span = table.number("span");
  auto const reach = table.number("span_extent");
  if (bulb.span.has_value() != reach.has_value())
    table.problem(bulb.span ? "span" : "span_extent",
                  "span and span_extent belong together: where the bulb is along the span and how far it reaches; "
                  "without both it is a ridge all along the span");
  bulb.span_extent = reach.value_or(0);
  if (!bulb.span || !reach) bulb.span.reset();
  table.finish();
  return bulb;
}

}  // namespace

TimedRule read_bulbs(TableReader& table, RuleContext const& shared) {
  SectionsRule sought;
  read_section_search(table, shared.axis.has_value(), sought);
  auto const crease = table.number("crease_angle_deg");
  if (crease && !(*crease > 0 && *crease <= 180))
    table.problem("crease_angle_deg", fmt::format("the angle {} is not above 0 and up to 180 degrees", *crease));
  std::size_t const problems = table.context().problems.messages().size();
  std::vector<Bulb> bulbs;
  for (auto& bulb : table.tables("bulbs")) bulbs.push_back(read_bulb(bulb));
  if (bulbs.empty())
    table.problem("bulbs",
                  "holds no bulb; give bulbs = [ { height = 0.004, extent = 0.1, span = 0, span_extent = 0.3 } ]");
  if (table.context().problems.messages().size() > problems) return {};
  try {
    InflateRule rule = make_bulbs(std::move(bulbs), {sought.sections, sought.span, sought.flow});
    if (crease) rule.crease_angle_deg = *crease;
    return {[rule](double share, Moment const&) {
              InflateRule out = rule;
              out.share = share;
              return out;
            },
            {}};
  } catch (MotionError const& e) {
    table.problem("bulbs", e.what());
    return {};
  }
}

}  // namespace gridmorph::casefile
