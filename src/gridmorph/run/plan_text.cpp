#include <gridmorph/report/block_graph_text.hpp>
#include <gridmorph/run/plan_text.hpp>

#include <fmt/format.h>

#include <utility>

namespace gridmorph::cli {

std::string block_plan_text(Plan const& plan, bool all) {
  std::size_t chains = 0;
  for (Stage const& stage : plan.stages) chains += stage.lines.chains.size();
  constexpr std::size_t readable = 60, of_stage = 6;
  if (all || chains <= readable) return describe(plan);
  return overview(plan) + "\n" + describe(plan, of_stage) + "(all chains: gridmorph plan --all)\n";
}

nlohmann::json block_plan_json(Plan const& plan) {
  nlohmann::json list = nlohmann::json::array();
  for (auto const& stage : plan.stages) {
    Index cells = 0;
    for (CellBox const& box : stage.cells) {
      Index inside = 1;
      for (int a = 0; a < 3; ++a) inside *= box.cells.extent(a);
      cells += inside;
    }
    list.push_back({{"name", stage.name}, {"chains", stage.description}, {"cells", cells}});
  }
  for (auto const& pass : plan.spreads)
    list.push_back({{"name", "slip surfaces"}, {"chains", pass.description}, {"cells", 0}});
  return {{"stages", std::move(list)}};
}

namespace {

/// What the background mesh fills.
std::string shape(UnstructuredReport const& r) {
  if (!r.wrap) return "read from a file";
  if (r.wrap->tube) return "O-type around a tube";
  std::string text = r.wrap->domain.chart.name();
  int sliding = 0, along = 0;
  for (int axis = 0; axis < r.wrap->dimension; ++axis)
    for (int const side : {0, 1}) {
      auto const is = r.wrap->domain.side[axis][side];
      bool const slides = r.wrap->slides(axis, side);
      sliding += slides ? 1 : 0;
      bool const reached = r.wrap->reaches[axis][side];
      along += !slides && is != ChartedDomain::Side::open && (is != ChartedDomain::Side::stands || reached) ? 1 : 0;
    }
  for (auto const& [count, what] : {std::pair(sliding, "on which nodes slide"), std::pair(along, "that go along")})
    if (count > 0) text += fmt::format(", {} {} {}", count, count == 1 ? "side" : "sides", what);
  return text;
}

nlohmann::json part_json(PlannedPart const& p) {
  UnstructuredReport const& r = p.report;
  return {
      {"offset", r.offset},
      {"columns", r.n_columns},
      {"layer_height", r.layer_height},
      {"elements", {{"near", r.regions.n_near}, {"partially_wrapped", r.regions.n_partial}, {"far", r.regions.n_far}}},
      {"layers", r.n_layers},
      {"background",
       {{"shape", r.by_least_squares ? "none: least squares" : shape(r)},
        {"zones", p.background ? p.background->mesh.zones.size() : 0},
        {"nodes", p.background ? p.background->mesh.n_nodes() : 0}}},
      {"wrap_nodes", r.wrap_nodes},
      {"wrap_nodes_outside", r.wrap_outside},
      {"wrap_largest_distance", r.wrap_distance},
      {"far_nodes", r.far_nodes},
      {"far_nodes_outside", r.far_outside},
      {"unreached_nodes", r.unreached},
      {"seconds",
       {{"boundary", r.seconds.boundary},
        {"columns", r.seconds.columns},
        {"distances", r.seconds.distances},
        {"wrap", r.seconds.wrap},
        {"layers", r.seconds.layers},
        {"background", r.seconds.background},
        {"location", r.seconds.location},
        {"residual", r.seconds.residual}}}};
}

std::string part_headline(PlannedPart const& p) {
  UnstructuredReport const& r = p.report;
  if (r.by_least_squares)
    return fmt::format(
        "near field: least squares at the scale of the distance from the walls, for all nodes; {} columns up to {:.4g} "
        "high, {} layers beyond them; {} elements nearer than {:.4g}, {} partly, {} farther{}\n",
        r.n_columns, r.layer_height, r.n_layers, r.regions.n_near, r.offset, r.regions.n_partial, r.regions.n_far,
        r.with_sides ? "; all of the passage goes with its sides" : "");
  std::string text = fmt::format(
      "near field: {}, {} columns up to {:.4g} high, {} near elements, {} partially wrapped, {} far; {} layers\n",
      r.wrap ? fmt::format("offset {:.4g}", r.offset) : std::string("the hole of the background mesh"), r.n_columns,
      r.layer_height, r.regions.n_near, r.regions.n_partial, r.regions.n_far, r.n_layers);
  if (p.background)
    text += fmt::format(
        "background mesh: {}, {} zones, {} nodes; {} on the wrap; {} nodes of the mesh take their displacement from "
        "it\n",
        shape(r), p.background->mesh.zones.size(), p.background->mesh.n_nodes(), r.wrap_nodes, r.far_nodes);
  return text;
}

}  // namespace

std::string element_plan_text(PlannedElements const& planned) {
  if (planned.parts.empty()) return part_headline(planned.whole);
  std::string text;
  Index at_rest = 0, n_at_rest = 0;
  for (PlannedPart const& part : planned.parts) {
    bool const common = part.has_common_motion;
    if (!part.has_moving_walls && !common) {
      ++at_rest;
      n_at_rest += part.n_nodes;
      continue;
    }
    text += fmt::format("part {} of {}, {} nodes{}\n", part.number + 1, planned.parts.size(), part.n_nodes,
                        common ? ": the motion that its boundaries have in common, and what is left of theirs" : "");
    if (part.has_moving_walls) text += part_headline(part);
  }
  if (at_rest > 0)
    text += fmt::format("{} part{} without moving walls, {} nodes: the motions of other boundaries alone\n", at_rest,
                        at_rest == 1 ? "" : "s", n_at_rest);
  return text;
}

nlohmann::json element_plan_json(PlannedElements const& planned, Index n_elements) {
  nlohmann::json plan = part_json(planned.whole);
  if (!planned.parts.empty()) {
    nlohmann::json parts = nlohmann::json::array();
    for (PlannedPart const& part : planned.parts) {
      parts.push_back(part_json(part));
      parts.back()["nodes"] = part.n_nodes;
      parts.back()["common_motion"] = part.has_common_motion;
    }
    plan["parts"] = std::move(parts);
  }
  return {{"elements", n_elements}, {"plan", std::move(plan)}};
}

}  // namespace gridmorph::cli
