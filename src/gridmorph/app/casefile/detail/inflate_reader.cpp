#include <gridmorph/app/casefile/detail/inflate_reader.hpp>
#include <gridmorph/app/casefile/detail/sections_reader.hpp>
#include <gridmorph/app/casefile/formula.hpp>
#include <gridmorph/app/casefile/suggest.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mapping/text_table.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
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
  std::vector<std::string> const known{"span", "chord", "height", "side"};
  std::array<int, 4> column{-1, -1, -1, -1};
  std::size_t columns = 0;
  std::vector<HeightTable::Station> out;
  std::vector<std::string_view> cells;
  Problems problems;
  for (mapping::Lines lines(text); problems.messages().size() < mapping::most_problems_per_file && lines.next();) {
    std::string const where = fmt::format("{}:{}", source, lines.number());
    mapping::split(lines.line(), mapping::separator_of(lines.line()), cells);
    if (columns == 0) {
      columns = cells.size();
      if (columns > mapping::most_columns)
        throw ConfigError(fmt::format("{}: more than {} columns; is it a table?", where, mapping::most_columns));
      for (std::size_t c = 0; c < columns; ++c) {
        std::string const name = mapping::plain_name(cells[c]);
        auto const at = std::find(known.begin(), known.end(), name);
        if (at == known.end())
          problems.add(fmt::format("{}: the header names a column '{}', which is none of span, chord, height, side{}",
                                   where, name.substr(0, 40), suggestion(name, known)));
        else if (std::exchange(column[std::size_t(at - known.begin())], int(c)) >= 0)
          problems.add(fmt::format("{}: the header names column '{}' twice", where, name));
      }
      for (std::size_t k = 0; k < 3; ++k)
        if (column[k] < 0) problems.add(fmt::format("{}: the header names no column '{}'", where, known[k]));
      problems.throw_if_any<ConfigError>();
      continue;
    }
    if (cells.size() != columns) {
      problems.add(fmt::format("{}: expected {} columns, found {}", where, columns, cells.size()));
      continue;
    }
    std::array<double, 4> value{};
    bool good = true;
    for (std::size_t k = 0; k < 4; ++k) {
      if (column[k] < 0) continue;
      auto const cell = cells[std::size_t(column[k])];
      if (k == 3 && cell.empty()) continue;
      auto const number = finite_number(cell);
      bool const fits = number && (k == 2 || (k < 2 ? *number >= 0 && *number <= 1 : std::abs(*number) == 1));
      if (!fits) {
        static constexpr std::array wanted{"a fraction from 0 to 1", "a fraction from 0 to 1", "a number",
                                           "1 or -1, or empty for both"};
        problems.add(fmt::format("{}: {} = \"{}\" is not {}", where, known[k], cell.substr(0, 40), wanted[k]));
        good = false;
        continue;
      }
      value[k] = *number;
    }
    if (good) out.push_back({value[0], value[1], value[3], value[2]});
  }
  problems.throw_if_any<ConfigError>();
  if (columns == 0 || out.empty())
    throw ConfigError(source +
                      ": holds no heights; expected a header line such as span,chord,height and lines of numbers");
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
