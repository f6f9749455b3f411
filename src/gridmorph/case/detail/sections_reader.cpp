#include <gridmorph/case/detail/sections_reader.hpp>
#include <gridmorph/core/suggest.hpp>
#include <gridmorph/mapping/text_table.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace gridmorph::casefile {

namespace {

using mapping::Lines;
using mapping::most_columns;
using mapping::most_problems_per_file;
using mapping::separator_of;
using mapping::split;

constexpr double degree = std::numbers::pi / 180;

/// A key, where its table goes, and the open interval its values lie in.
struct Parameter {
  char const* key;
  SpanwiseTable SectionsRule::*table;
  double factor, above, below;
};

constexpr std::array<Parameter, 8> parameters{{{"chord", &SectionsRule::chord, 1, -1, HUGE_VAL},
                                               {"scale", &SectionsRule::scale, 1, -1, HUGE_VAL},
                                               {"thickness", &SectionsRule::thickness, 1, -1, HUGE_VAL},
                                               {"twist_deg", &SectionsRule::twist_rad, degree, -180, 180},
                                               {"stagger_deg", &SectionsRule::stagger_rad, degree, -90, 90},
                                               {"sweep", &SectionsRule::sweep, 1, -HUGE_VAL, HUGE_VAL},
                                               {"lean", &SectionsRule::lean, 1, -HUGE_VAL, HUGE_VAL},
                                               {"bow_deg", &SectionsRule::bow_rad, degree, -90, 90}}};

std::vector<std::string> parameter_keys() {
  std::vector<std::string> keys;
  for (Parameter const& p : parameters) keys.emplace_back(p.key);
  return keys;
}

std::string_view unquoted(std::string_view text) {
  constexpr char const* blanks = " \t\r\"";
  auto const first = text.find_first_not_of(blanks);
  return first == std::string_view::npos ? std::string_view()
                                         : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  split(line, separator_of(line), cells);
  for (auto& cell : cells) cell = unquoted(cell);
  return cells;
}

void check(TableReader& table, std::string const& where, Parameter const& p,
           std::vector<std::pair<double, double>> const& stations) {
  check_spans(table, where, p.key, stations);
  for (std::size_t n = 0; n < stations.size(); ++n) {
    double const value = stations[n].second;
    if (!(value > p.above && value < p.below))
      table.problem(
          where, p.above == -1
                     ? fmt::format("{}: relative changes are above -1 (-0.1 is 10 % less), found {}", p.key, value)
                     : fmt::format("{}: must lie between {} and {} degrees, found {}", p.key, p.above, p.below, value));
  }
}

std::vector<SpanwiseColumn> read_columns(std::filesystem::path const& path) {
  return parse_spanwise_columns(mapping::read_text_file(path, "table"), path.string(), parameter_keys());
}

}  // namespace

std::vector<std::pair<double, double>> read_stations(TableReader& table, std::string const& key) {
  auto const* value = table.find(key);
  if (!value->is_array()) {
    auto const constant = table.number(key);
    return constant ? std::vector<std::pair<double, double>>{{0, *constant}} : std::vector<std::pair<double, double>>{};
  }
  std::vector<std::pair<double, double>> stations;
  for (auto const& pair : value->as_array()) {
    bool const two = pair.is_array() && pair.as_array().size() == 2;
    auto const span = two ? table.value_of(pair.as_array()[0], key) : std::nullopt;
    auto const v = two ? table.value_of(pair.as_array()[1], key) : std::nullopt;
    if (!span || !v) {
      table.context().problem(
          table.context().line_of(pair),
          fmt::format("[[motion]] {}: expected [span fraction, value], found {}", key, describe_value(pair)));
      return {};
    }
    stations.emplace_back(*span, *v);
  }
  if (stations.empty()) table.problem(key, "the table is empty; write [[span fraction, value], ...] or remove the key");
  return stations;
}

void check_spans(TableReader& table, std::string const& where, std::string const& name,
                 std::vector<std::pair<double, double>> const& stations) {
  for (std::size_t n = 0; n < stations.size(); ++n) {
    double const span = stations[n].first;
    if (span < 0 || span > 1)
      table.problem(
          where, fmt::format("{}: span fractions lie between 0 (root, hub) and 1 (tip, case), found {}", name, span));
    if (n > 0 && !(span > stations[n - 1].first))
      table.problem(
          where, fmt::format("{}: span fractions must ascend, found {} after {}", name, span, stations[n - 1].first));
  }
}

std::vector<SpanwiseColumn> parse_spanwise_columns(std::string_view text, std::string const& source,
                                                   std::vector<std::string> const& known) {
  std::vector<SpanwiseColumn> columns;
  std::size_t span_column = 0;
  Problems problems;
  for (Lines lines(text); problems.messages().size() < most_problems_per_file && lines.next();) {
    std::string const where = fmt::format("{}:{}", source, lines.number());
    auto const cells = cells_of(lines.line());
    if (columns.empty()) {
      if (cells.size() > most_columns)
        throw ConfigError(fmt::format("{}: more than {} columns; is it a table?", where, most_columns));
      for (auto const& cell : cells) {
        std::string const name(cell);
        bool const twice = std::any_of(columns.begin(), columns.end(), [&](auto const& c) { return c.name == name; });
        if (twice) problems.add(fmt::format("{}: the header names column '{}' twice", where, name));
        if (name != "span" && std::find(known.begin(), known.end(), name) == known.end())
          problems.add(fmt::format("{}: the header names a column '{}', which is no parameter{}", where,
                                   name.substr(0, 40), suggestion(name, known)));
        columns.push_back({name, {}});
      }
      auto const span = std::find_if(columns.begin(), columns.end(), [](auto const& c) { return c.name == "span"; });
      if (span == columns.end())
        problems.add(where +
                     ": the first line must name the columns, one of them 'span'; for example span,chord,twist_deg");
      problems.throw_if_any<ConfigError>();
      span_column = std::size_t(span - columns.begin());
      continue;
    }
    if (cells.size() != columns.size()) {
      problems.add(fmt::format("{}: expected {} columns, found {}", where, columns.size(), cells.size()));
      continue;
    }
    auto const span = finite_number(cells[span_column]);
    if (!span) problems.add(fmt::format("{}: span = \"{}\" is not a number", where, cells[span_column].substr(0, 40)));
    for (std::size_t c = 0; c < cells.size() && span; ++c) {
      if (c == span_column || cells[c].empty()) continue;
      auto const value = finite_number(cells[c]);
      if (!value)
        problems.add(fmt::format("{}: {} = \"{}\" is not a number (decimal point, not comma)", where, columns[c].name,
                                 cells[c].substr(0, 40)));
      else if (!columns[c].stations.empty() && !(*span > columns[c].stations.back().first))
        problems.add(fmt::format("{}: span fractions must ascend, found {} after {}", where, *span,
                                 columns[c].stations.back().first));
      else
        columns[c].stations.emplace_back(*span, *value);
    }
  }
  problems.throw_if_any<ConfigError>();
  if (columns.empty())
    throw ConfigError(source + ": holds no table; expected a header line such as span,chord,twist_deg");
  columns.erase(columns.begin() + std::ptrdiff_t(span_column));
  return columns;
}

void read_section_search(TableReader& table, bool has_axis, SectionsRule& rule) {
  auto const kind = table.choice("kind", {"blade", "wing"});
  rule.sections = (kind ? *kind == 0 : has_axis) ? SectionsRule::Sections::blade : SectionsRule::Sections::wing;
  bool const wing = rule.sections == SectionsRule::Sections::wing;
  if (!wing && !has_axis)
    table.problem(
        "kind", "\"blade\" needs the machine axis; add axis = { origin = [0, 0, 0], direction = [1, 0, 0] } to [mesh]");
  for (std::string const key : {"span", "flow"}) {
    auto const direction = table.vector(key);
    if (direction && !wing) table.problem(key, "belongs to kind = \"wing\"; remove it");
    if (direction && norm(*direction) == 0) table.problem(key, "the direction [0, 0, 0] has no length");
    if (direction && key == "span") rule.span = direction;
    if (direction && key == "flow") rule.flow = *direction;
  }
  if (rule.span && norm(cross(*rule.span, rule.flow)) < 1e-3 * norm(*rule.span) * norm(rule.flow))
    table.problem("span", "runs along the flow; give flow = [x, y, z], the way from leading to trailing edge");
}

SectionsRule read_sections(TableReader& table, bool has_axis) {
  SectionsRule rule;
  read_section_search(table, has_axis, rule);
  rule.pivot = table.number("pivot").value_or(rule.pivot);
  auto interpolation = SpanwiseTable::Interpolation::spline;
  if (auto const word = table.choice("interpolation", {"spline", "linear"}))
    interpolation = SpanwiseTable::Interpolation(*word);

  std::vector<SpanwiseColumn> columns;
  if (auto const file = table.string("file")) {
    try {
      columns = read_columns(table.context().input(*file));
    } catch (ConfigError const& e) {
      table.problem("file", e.what());
    }
  }
  bool any = table.has("file");
  for (Parameter const& p : parameters) {
    auto const column = std::find_if(columns.begin(), columns.end(), [&](auto const& c) { return c.name == p.key; });
    std::vector<std::pair<double, double>> stations;
    std::string where = "file";
    if (column != columns.end()) stations = column->stations;
    if (table.find(p.key) != nullptr) {
      any = true;
      where = p.key;
      if (column != columns.end()) table.problem(p.key, "is given here and as a column of the file; remove one");
      stations = read_stations(table, p.key);
    }
    check(table, where, p, stations);
    SpanwiseTable& out = rule.*p.table;
    out.interpolation = interpolation;
    for (auto const& [span, value] : stations) out.stations.emplace_back(span, p.factor * value);
  }
  if (!any)
    table.problem(
        "rule",
        "sections needs at least one of chord, scale, thickness, twist_deg, stagger_deg, sweep, lean, bow_deg, "
        "each a number or [[span fraction, value], ...], or file = \"redesign.csv\"");
  return rule;
}

SectionsRule share_of(SectionsRule rule, double share) {
  for (SpanwiseTable* table : {&rule.chord, &rule.scale, &rule.thickness, &rule.twist_rad, &rule.stagger_rad,
                               &rule.sweep, &rule.lean, &rule.bow_rad})
    for (auto& [span, value] : table->stations) value *= share;
  return rule;
}

}  // namespace gridmorph::casefile
