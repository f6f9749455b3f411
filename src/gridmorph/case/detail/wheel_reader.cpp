#include <gridmorph/case/detail/case_parts.hpp>
#include <gridmorph/core/suggest.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gridmorph::casefile {

namespace {

WheelBlade read_blade(TableReader& table, RuleContext const& shared, CaseFile& out) {
  WheelBlade blade;
  blade.where = table.context().where(table.line());
  blade.name = table.string("name").value_or("");
  table.require("name", "name = \"A\", which sequence can name");
  blade.factor = table.number("factor").value_or(1);
  CaseFile fragment;
  fragment.sequence = out.sequence;
  for (auto& rule : table.tables("motion")) read_motion_rule(rule, shared, fragment);
  for (std::size_t r = 0; r < fragment.timed.size(); ++r)
    if (fragment.timed[r].end_wall)
      table.problem("motion", "a blade does not move the walls it stands on; the rule contour belongs to [[motion]]");
  for (std::size_t r = 0; r < fragment.timed.size(); ++r) {
    Rule const& rule = fragment.motion.rules[r].rule;
    if (!fragment.timed[r].at && !std::holds_alternative<FixedRule>(rule))
      table.problem("motion",
                    fmt::format("a blade can have the rules fixed, rigid, formula, field, sections, target, "
                                "inflate, bulb and ffd, found {}; what follows from the blade belongs to [[motion]]",
                                rule_name(rule)));
  }
  blade.rules = std::move(fragment.motion.rules);
  blade.timed = std::move(fragment.timed);
  out.fields.insert(out.fields.end(), fragment.fields.begin(), fragment.fields.end());
  table.finish();
  return blade;
}

/// The keys that [wheel] and [[wheel.row]] have in common.
WheelRowCase read_row(TableReader& table, std::vector<WheelBlade> const& blades) {
  WheelRowCase row;
  row.where = table.context().where(table.line());
  row.zones = table.strings("zones").value_or(std::vector<std::string>{});
  if (auto const passages = table.integer("passages")) {
    row.passages = *passages;
    if (*passages < 1)
      table.problem("passages", fmt::format("must be at least 1, found {}; remove it for the whole "
                                            "wheel; a straight row needs a number",
                                            *passages));
  }
  std::vector<std::string> names;
  for (auto const& blade : blades) names.push_back(blade.name);
  row.sequence = table.strings("sequence").value_or(std::vector<std::string>{});
  for (auto const& name : row.sequence)
    if (std::find(names.begin(), names.end(), name) == names.end())
      table.problem("sequence",
                    fmt::format("\"{}\" is the name of no [[wheel.blade]]{}", name, suggestion(name, names)));
  row.nodal_diameters = table.integer("nodal_diameters");
  row.where_diameters = table.where("nodal_diameters");
  row.factors = table.numbers("factors").value_or(std::vector<double>{});
  return row;
}

}  // namespace

void read_wheel(TableReader& root, RuleContext const& shared, CaseFile& out) {
  if (!root.has("wheel")) return;
  auto wheel = root.table("wheel");
  if (!wheel) return;
  WheelCase& value = out.wheel.emplace();
  if (auto const output = wheel->string("output"))
    value.output = (wheel->context().directory / *output).lexically_normal();
  if (!value.output.empty() && value.output == out.input)
    wheel->problem("output", "is the input; give another file name, the baseline is never overwritten");
  value.suffix_families = wheel->choice("families", {"shared", "suffixed"}).value_or(0) == 1;
  for (auto& table : wheel->tables("blade")) {
    WheelBlade blade = read_blade(table, shared, out);
    if (std::any_of(value.blades.begin(), value.blades.end(), [&](auto const& b) { return b.name == blade.name; }))
      table.problem("name", fmt::format("\"{}\" is the name of another blade already", blade.name));
    value.blades.push_back(std::move(blade));
  }
  WheelRowCase const own = read_row(*wheel, value.blades);
  bool const given = wheel->has("zones") || wheel->has("passages") || wheel->has("sequence") || wheel->has("factors") ||
                     wheel->has("nodal_diameters");
  for (auto& table : wheel->tables("row")) {
    table.require("zones", "zones = [\"rotor*\"], the zones of the row");
    value.rows.push_back(read_row(table, value.blades));
    table.finish();
  }
  if (given && !value.rows.empty())
    wheel->problem("row",
                   "stands beside zones, passages, sequence, factors or nodal_diameters of [wheel]; give every row a "
                   "[[wheel.row]] of its own");
  if (value.rows.empty()) value.rows.push_back(own);
  if (!out.axis)
    wheel->problem("output",
                   "a wheel needs the machine axis, a straight row the way of the flow; "
                   "add axis = { origin = [0, 0, 0], direction = [1, 0, 0] } to [mesh]");
  wheel->finish();
}

}  // namespace gridmorph::casefile
