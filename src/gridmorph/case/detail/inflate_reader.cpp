#include <gridmorph/case/detail/number_table.hpp>
#include <gridmorph/case/detail/rule_kinds.hpp>
#include <gridmorph/case/detail/sections_reader.hpp>
#include <gridmorph/case/formula.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mapping/text_table.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace gridmorph::casefile {

namespace {

/// What a rule says of the height, at a moment.
struct Height {
  std::string description;
  HeightAt at;
  bool on_sections = false, on_sides = false, in_time = false;
};

Height read_expression(TableReader& table, RuleContext const& shared, std::map<std::string, double> const& constants) {
  std::string const expression = table.string("height").value_or("");
  Height out;
  out.description = "height " + expression;
  if (expression.empty()) {
    table.problem("height", "is empty; write a length or an expression");
    return out;
  }
  out.in_time = uses_time(expression);
  if (out.in_time) needs_sequence(table, shared, "height");
  if (uses_axis(expression) && !shared.axis)
    table.problem("height",
                  "uses r, theta or axial, but [mesh] has no axis; add axis = { origin = [0, 0, 0], direction = "
                  "[1, 0, 0] } to [mesh]");
  out.on_sections = uses_sections(expression, constants);
  out.on_sides = uses_side(expression, constants);
  out.at = make_height_formula({"height", expression, table.where("height")}, constants, shared.axis.value_or(Axis{}),
                               table.context().problems);
  return out;
}

Height read_table(TableReader& table, std::string const& file, SpanwiseTable::Interpolation interpolation) {
  Height out;
  out.description = "height " + file;
  out.on_sections = true;
  try {
    auto const path = table.context().input(file);
    auto const heights = std::make_shared<HeightTable const>(
        parse_heights(mapping::read_text_file(path, "table"), path.string()), interpolation);
    out.on_sides = heights->has_sides();
    out.at = [heights](std::span<SurfacePlace const> places, std::span<double> height, Moment const&) {
      for (std::size_t n = 0; n < places.size(); ++n)
        height[n] = heights->at(places[n].span_fraction, places[n].chord_fraction, places[n].side);
    };
  } catch (Error const& e) {
    table.problem("file", e.what());
  }
  return out;
}

Height read_height(TableReader& table, RuleContext const& shared) {
  auto constants = shared.constants;
  read_constants(table, "constants", constants);
  auto interpolation = SpanwiseTable::Interpolation::spline;
  if (auto const word = table.choice("interpolation", {"spline", "linear"}))
    interpolation = SpanwiseTable::Interpolation(*word);
  auto const file = table.string("file");
  auto const* value = table.find("height");
  if (table.has("interpolation") && !file) table.problem("interpolation", "belongs to file; remove it");
  if (value != nullptr && file) table.problem("file", "stands beside height; remove one of the two");
  if (file) return read_table(table, *file, interpolation);
  if (value == nullptr) {
    table.problem(
        "rule",
        "inflate needs height, a length or an expression, or file = \"heights.csv\" with columns span, chord, "
        "height");
    return {};
  }
  if (value->is_string()) return read_expression(table, shared, constants);
  auto const height = table.number("height");
  if (!height) return {};
  return {fmt::format("height {}", *height), [h = *height](std::span<SurfacePlace const>, std::span<double> out,
                                                           Moment const&) { std::fill(out.begin(), out.end(), h); }};
}

}  // namespace

std::vector<HeightTable::Station> parse_heights(std::string_view text, std::string const& source) {
  auto const fraction = [](double value) { return value >= 0 && value <= 1; };
  std::vector<NumberColumn> const columns{
      {"span", "a fraction from 0 to 1", fraction},
      {"chord", "a fraction from 0 to 1", fraction},
      {"height", "a number"},
      {"side", "1 or -1, or empty for both", [](double value) { return std::abs(value) == 1; }, false, 0.0}};
  std::vector<HeightTable::Station> out;
  for (auto const& [where, value] : read_number_table(text, source, columns, "heights"))
    out.push_back({value[0], value[1], value[3], value[2]});
  return out;
}

TimedRule read_inflate(TableReader& table, RuleContext const& shared) {
  Height const height = read_height(table, shared);
  InflateRule rule;
  rule.description = height.description;
  SectionsRule sought;
  if (height.on_sections) {
    read_section_search(table, shared.axis.has_value(), sought);
    rule.sections = InflateRule::Sections{sought.sections, sought.span, sought.flow, height.on_sides};
  } else {
    for (std::string const key : {"kind", "span", "flow"})
      if (table.find(key) != nullptr)
        table.problem(key,
                      "belongs to a height that uses span_fraction, chord_fraction or side, or comes from a file; "
                      "remove it");
  }
  if (auto const angle = table.number("crease_angle_deg")) {
    if (!(*angle > 0 && *angle <= 180))
      table.problem("crease_angle_deg", fmt::format("the angle {} is not above 0 and up to 180 degrees", *angle));
    rule.crease_angle_deg = *angle;
  }
  if (!height.at) return {};
  return {[rule, at = height.at](double share, Moment const& when) {
            InflateRule out = rule;
            out.share = share;
            out.height = [at, when](std::span<SurfacePlace const> places, std::span<double> heights) {
              at(places, heights, when);
            };
            return out;
          },
          {},
          height.in_time};
}

}  // namespace gridmorph::casefile
