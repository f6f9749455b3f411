#include <gridmorph/case/detail/case_parts.hpp>

#include <gridmorph/case/detail/sections_reader.hpp>
#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/motion/shock/shock_search.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>

namespace gridmorph::casefile {

namespace {

using Holds = std::function<bool(Vec3 const&)>;

/// box = { from = [x, y, z], to = [x, y, z] }.
void read_box(TableReader& region, std::vector<Holds>& all) {
  auto table = region.table("box");
  if (!table) return;
  auto const from = table->vector("from"), to = table->vector("to");
  table->require("from", "from = [x, y, z]");
  table->require("to", "to = [x, y, z]");
  table->finish();
  if (!from || !to) return;
  if (!(from->x < to->x && from->y < to->y && from->z < to->z))
    return region.problem("box", "must reach from its smaller to its larger x, y and z");
  all.emplace_back([from = *from, to = *to](Vec3 const& p) {
    return from.x <= p.x && p.x <= to.x && from.y <= p.y && p.y <= to.y && from.z <= p.z && p.z <= to.z;
  });
}

/// sphere = { centre = [x, y, z], radius = r }.
void read_sphere(TableReader& region, std::vector<Holds>& all) {
  auto table = region.table("sphere");
  if (!table) return;
  auto const centre = table->vector("centre");
  auto const radius = table->number("radius");
  table->require("centre", "centre = [x, y, z]");
  table->require("radius", "radius = 0.1");
  if (radius && *radius <= 0) table->problem("radius", fmt::format("must be a positive length, found {}", *radius));
  table->finish();
  if (centre && radius)
    all.emplace_back([centre = *centre, radius = *radius](Vec3 const& p) { return distance(p, centre) <= radius; });
}

/// axial = [from, to] and radius = [from, to], about the machine axis.
void read_annulus(TableReader& region, std::optional<Axis> const& axis, std::vector<Holds>& all) {
  for (char const* key : {"axial", "radius"}) {
    auto const range = region.numbers(key);
    if (!range) continue;
    if (range->size() != 2 || !(range->front() < range->back())) {
      region.problem(key, "must be two numbers, the smaller one first");
      continue;
    }
    if (!axis) {
      region.problem(key, "needs the machine axis; add axis to [mesh]");
      continue;
    }
    bool const axial = key[0] == 'a';
    all.emplace_back(
        [frame = CylindricalFrame(*axis), axial, from = range->front(), to = range->back()](Vec3 const& p) {
          MeridionalPoint const m = frame.meridional(p);
          double const value = axial ? m.axial : m.radius;
          return from <= value && value <= to;
        });
  }
}

/// nodes = { from = [i, j, k], to = [i, j, k] }, numbered from 1.
void read_nodes(TableReader& region, InnerRegion& out) {
  auto table = region.table("nodes");
  if (!table) return;
  std::array<Index3, 2> corner{};
  bool whole = true;
  for (int end = 0; end < 2; ++end) {
    char const* key = end == 0 ? "from" : "to";
    auto const v = table->vector(key);
    table->require(key, fmt::format("{} = [1, 1, 5], i, j and k of a node, counted from 1", key));
    if (!v) {
      whole = false;
      continue;
    }
    for (int a = 0; a < 3; ++a) {
      double const n = a == 0 ? v->x : a == 1 ? v->y : v->z;
      constexpr double most = 1e9;
      if (!(n >= 1 && n <= most) || std::floor(n) != n) {
        table->problem(key, fmt::format("must be whole numbers from 1 on, found {}", n));
        whole = false;
        break;
      }
      corner[end][a] = int(n) - 1;
    }
  }
  table->finish();
  if (!whole) return;
  for (int& n : corner[1]) ++n;
  out.nodes = IndexRange{corner[0], corner[1]};
  for (int a = 0; a < 3; ++a)
    if (corner[1][a] <= corner[0][a])
      return region.problem("nodes", "must reach from the smaller to the larger i, j and k");
}

/// wake = { of = "blade", length = l, width = w }.
void read_wake(TableReader& region, std::optional<Axis> const& axis, InnerRegion& out) {
  auto table = region.table("wake");
  if (!table) return;
  InnerRegion::Wake wake;
  wake.of = table->strings("of").value_or(std::vector<std::string>{});
  table->require("of", "of = \"blade\", the blades or wings that it is behind");
  SectionsRule search;
  read_section_search(*table, axis.has_value(), search);
  wake.of_wing = search.sections == SectionsRule::Sections::wing;
  wake.span = search.span;
  wake.flow = search.flow;
  if (auto const angle = table->number("angle_deg")) {
    wake.angle_rad = *angle * std::numbers::pi / 180;
    if (!(std::abs(*angle) < 90))
      table->problem("angle_deg", fmt::format("must lie between -90 and 90 degrees, found {}", *angle));
  }
  for (auto const& [key, value] : {std::pair("length", &wake.length), std::pair("width", &wake.width)}) {
    auto const given = table->number(key);
    table->require(key, fmt::format("{} = 0.1", key));
    if (given && !(*given > 0)) table->problem(key, fmt::format("must be a positive length, found {}", *given));
    if (given) *value = *given;
  }
  table->finish();
  out.wake = std::move(wake);
}

/// shock = { sensor = "jump", variable = "Pressure", threshold = 0.1 }; an empty table takes the defaults.
void read_shock_search(TableReader& region, InnerRegion& out) {
  auto table = region.table("shock");
  if (!table) return;
  ShockSearch search;
  if (auto const file = table->input("file")) search.file = file->string();
  search.solution = table->string("solution").value_or("");
  auto const sensor = table->choice("sensor", {"normal-mach", "jump"});
  if (sensor) search.sensor = ShockSearch::Sensor(*sensor);
  bool const jump = search.sensor == ShockSearch::Sensor::jump;
  search.variable = table->string("variable").value_or(search.variable);
  if (table->has("variable") && !jump)
    table->problem("variable", "is of sensor = \"jump\"; the normal Mach number is one of pressure and velocity");
  search.threshold = table->number("threshold");
  if (search.threshold && !(*search.threshold > 0))
    table->problem("threshold", fmt::format("must be positive, found {}", *search.threshold));
  search.compression = table->number("compression").value_or(search.compression);
  if (!(search.compression >= 0))
    table->problem("compression", fmt::format("must not be negative, found {}", search.compression));
  if (table->has("compression") && jump)
    table->problem("compression", "is of sensor = \"normal-mach\"; threshold says the same of \"jump\"");
  search.heat_ratio = table->number("heat_ratio").value_or(search.heat_ratio);
  if (!(search.heat_ratio > 1))
    table->problem("heat_ratio", fmt::format("must be larger than 1, found {}", search.heat_ratio));
  search.smallest = table->integer("smallest").value_or(search.smallest);
  if (search.smallest < 1)
    table->problem("smallest", fmt::format("must be 1 cell at least, found {}", search.smallest));
  search.grow = table->integer("grow").value_or(search.grow);
  constexpr int most = 1000;
  if (search.grow < 0 || search.grow > most)
    table->problem("grow", fmt::format("must be 0 to {} layers of cells, found {}", most, search.grow));
  table->finish();
  out.shock = std::make_shared<ShockSearch const>(std::move(search));
}

}  // namespace

InnerRegion read_region(TableReader& table, std::optional<Axis> const& axis) {
  InnerRegion out;
  out.where = table.context().where(table.line());
  out.name = table.string("name").value_or("");
  table.require("name", "name = \"wake\", what rules call it");
  if (table.has("name") && out.name.empty()) table.problem("name", "is empty");
  out.zones = table.strings("zones").value_or(std::vector<std::string>{});
  std::vector<Holds> all;
  read_box(table, all);
  read_sphere(table, all);
  read_annulus(table, axis, all);
  read_nodes(table, out);
  read_wake(table, axis, out);
  read_shock_search(table, out);
  bool has_shape = false;
  for (char const* key : {"box", "sphere", "axial", "radius", "wake", "shock"}) has_shape = has_shape || table.has(key);
  if (out.wake && out.shock) table.problem("shock", "cannot stand beside wake; make two regions of them");
  if (table.has("nodes") && has_shape)
    table.problem(
        "nodes",
        "say which nodes they are, and stand alone beside zones; remove box, sphere, axial, radius, wake and shock");
  if (table.has("nodes") && out.zones.size() != 1)
    table.problem("nodes", "are those of one zone; name it, zones = \"Zone 1\"");
  if (table.has("name") && !table.has("nodes") && !has_shape && out.zones.empty())
    table.problem(
        "name",
        "is all there is: say where the region lies, by zones, nodes, box, sphere, axial, radius, wake or shock");
  out.only_measured = table.boolean("only_measured").value_or(false);
  if (out.only_measured && out.nodes)
    for (int a = 0; a < 3; ++a)
      if (out.nodes->extent(a) == 1) table.problem("only_measured", "is for cells, and a surface of the grid has none");
  table.finish();
  if (!all.empty())
    out.holds = [all = std::move(all)](Vec3 const& p) {
      for (Holds const& holds : all)
        if (!holds(p)) return false;
      return true;
    };
  return out;
}

}  // namespace gridmorph::casefile
