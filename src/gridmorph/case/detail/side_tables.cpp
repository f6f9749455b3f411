#include <gridmorph/case/detail/rule_reader.hpp>
#include <gridmorph/case/detail/side_tables.hpp>
#include <gridmorph/core/suggest.hpp>

#include <fmt/format.h>

#include <array>
#include <numbers>

namespace gridmorph::casefile {

std::vector<std::string> const side_file_kinds{"wall",     "inflow",     "outflow",    "symmetry",
                                               "farfield", "degenerate", "connection", "other"};

std::string bc_type_of(PatchKind kind) {
  constexpr std::array<char const*, 8> types{"BCWall",     "BCInflow",         "BCOutflow", "BCSymmetryPlane",
                                             "BCFarfield", "BCDegenerateLine", "",          ""};
  return std::size_t(kind) < types.size() ? types[std::size_t(kind)] : "";
}

void SidePeriodics::read(TableReader& table) {
  Periodic out;
  auto const name = table.string("name");
  table.require("name", "name = \"pitch\", which interfaces refer to");
  auto const axis = read_axis(table, "axis");
  auto const angle = table.number("angle_deg");
  auto const shift = table.vector("translation");
  if (table.has("translation") == (table.has("axis") || table.has("angle_deg")) ||
      table.has("axis") != table.has("angle_deg"))
    table.context().problem(table.line(), "[[periodic]] needs axis and angle_deg, or translation = [x, y, z]");
  else if (angle && *angle == 0)
    table.problem("angle_deg", "is zero; give the angle from the interface's own side to its donor");
  else if (shift && norm(*shift) == 0)
    table.problem("translation", "is zero; give the way from the interface's own side to its donor");
  if (axis && angle)
    out = periodic_rotation(axis->origin, axis->direction, *angle * std::numbers::pi / 180);
  else if (shift)
    out = periodic_translation(*shift);
  table.finish();
  if (name && !all_.emplace(*name, out).second)
    table.problem("name", fmt::format("'{}' is used twice; give each its own", *name));
}

std::optional<Periodic> SidePeriodics::of(TableReader& table) const {
  auto const name = table.string("periodic");
  if (!name) return std::nullopt;
  if (auto const found = all_.find(*name); found != all_.end()) return found->second;
  std::vector<std::string> names;
  for (auto const& [word, value] : all_) names.push_back(word);
  table.problem("periodic", fmt::format("there is no [[periodic]] named '{}'{}", *name, suggestion(*name, names)));
  return std::nullopt;
}

}  // namespace gridmorph::casefile
