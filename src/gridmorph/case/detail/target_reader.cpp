#include <gridmorph/case/detail/rule_kinds.hpp>
#include <gridmorph/case/target_file.hpp>

#include <fmt/format.h>

#include <memory>
#include <utility>

namespace gridmorph::casefile {

namespace {

/// "x", "y", "z" or [x, y, z]; other words as `words` say.
std::optional<Vec3> read_direction(TableReader& table, std::string const& key, std::vector<std::string> words,
                                   std::optional<std::size_t>& word) {
  auto const* value = table.find(key);
  if (value == nullptr) return std::nullopt;
  if (value->is_string()) {
    words.insert(words.begin(), {"x", "y", "z"});
    word = table.choice(key, words);
    if (!word || *word > 2) return std::nullopt;
    return Vec3{*word == 0 ? 1.0 : 0.0, *word == 1 ? 1.0 : 0.0, *word == 2 ? 1.0 : 0.0};
  }
  auto const direction = table.vector(key);
  if (direction && norm(*direction) == 0) {
    table.problem(key, "the direction [0, 0, 0] has no length");
    return std::nullopt;
  }
  return direction;
}

void read_sections_keys(TableReader& table, RuleContext const& shared, bool sections, TargetRule& rule) {
  std::optional<std::size_t> word;
  rule.span = read_direction(table, "span", {"radius"}, word);
  bool const radius = word && *word == 3;
  if (sections && !table.has("span") && !shared.axis)
    table.problem("span",
                  "is missing and [mesh] has no axis; add span = \"z\" (or another direction) for a wing, or the "
                  "axis to [mesh] for a blade");
  if (radius && !shared.axis) table.problem("span", "\"radius\" needs the machine axis; add axis to [mesh]");
  if (auto const match = table.choice("span_match", {"fraction", "position"}))
    rule.span_match = TargetRule::SpanMatch(*match);
  word.reset();
  auto const flow = read_direction(table, "flow", {}, word);
  rule.flow = flow ? *flow : shared.axis && (radius || !rule.span) ? shared.axis->direction : Vec3{1, 0, 0};
  if (!sections)
    for (char const* key : {"span", "span_match", "flow"})
      if (table.has(key)) table.problem(key, "belongs to targets given by sections; remove it");
}

}  // namespace

Rule read_target_rule(TableReader& table, RuleContext const& shared) {
  TargetRule rule;
  TargetSource source;
  auto const file = table.string("file");
  table.require("file", "file = \"new_wing.stl\" (or .cgns, or a text file of sections)");
  auto const mapping = table.choice("mapping", {"automatic", "nodes", "sections", "projection"});
  if (mapping) rule.mapping = TargetRule::Mapping(*mapping);
  source.nodes = rule.mapping == TargetRule::Mapping::nodes;
  source.patches = table.strings("target_patches").value_or(std::vector<std::string>{});
  if (auto const s = table.number("length_scale")) {
    source.length_scale = *s;
    if (*s <= 0) table.problem("length_scale", fmt::format("must be positive, found {}", *s));
  }
  if (auto const angle = table.number("crease_angle_deg")) {
    rule.crease_angle_deg = *angle;
    if (*angle <= 0 || *angle >= 180)
      table.problem("crease_angle_deg", fmt::format("must be between 0 and 180 degrees, found {}", *angle));
  }
  std::shared_ptr<TargetGeometry> target = std::make_shared<TargetGeometry>();
  if (file) {
    rule.description = *file;
    source.file = table.context().input(*file);
    try {
      *target = read_target(source);
    } catch (ConfigError const& e) {
      table.problem("file", e.what());
    }
  }
  bool const sections = rule.mapping == TargetRule::Mapping::sections || !target->sections.empty();
  if (table.has("crease_angle_deg") && (sections || rule.mapping == TargetRule::Mapping::nodes))
    table.problem("crease_angle_deg", "belongs to mapping = \"projection\"; remove it or change the mapping");
  if (file && !target->sections.empty() && rule.mapping == TargetRule::Mapping::projection)
    table.problem("mapping", "\"projection\" needs a surface (STL or CGNS), the file holds sections");
  read_sections_keys(table, shared, sections, rule);
  rule.target = std::move(target);
  return rule;
}

}  // namespace gridmorph::casefile
