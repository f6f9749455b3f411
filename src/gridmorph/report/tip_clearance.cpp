#include <gridmorph/core/text.hpp>
#include <gridmorph/report/tip_clearance.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph {

namespace {

/// A share of the distance from the origin: nodes as near as that to the wall are on it.
constexpr double round_off = 1e-9;

nlohmann::json json_of(Clearance const& c) {
  return {{"smallest", c.smallest}, {"mean", c.mean}, {"at", {c.at.x, c.at.y, c.at.z}}};
}

}  // namespace

std::string clearance_table(std::vector<TipClearance> const& tips) {
  std::size_t width = 9;
  for (auto const& tip : tips) width = std::max(width, tip.name.size());
  std::string text = fmt::format("{:<{}}  {:>24}  {:>24}  {:>24}  {:<10}  {}\n{:<{}}", "clearance", width, "before",
                                 "by the rule", "in the mesh", "distance", "smallest at", "", width);
  for (int n = 0; n < 3; ++n) text += fmt::format("  {:>11}  {:>11}", "smallest", "mean");
  text += "\n";
  auto const cells = [](Clearance const& c) { return fmt::format("  {:>11.4g}  {:>11.4g}", c.smallest, c.mean); };
  for (auto const& tip : tips) {
    text += fmt::format("{:<{}}", tip.name, width) + cells(tip.before);
    text += tip.by_rule ? cells(*tip.by_rule) : fmt::format("  {:>11}  {:>11}", "-", "-");
    text += cells(tip.after);
    Clearance const& told = tip.by_rule ? *tip.by_rule : tip.after;
    text += fmt::format("  {:<10}  ", name_of(tip.measure)) + to_text(told.at, 6) +
            (told.smallest < -round_off * norm(told.at) ? ", rubs" : "") + "\n";
  }
  return text;
}

std::string clearance_steps_table(std::vector<std::vector<TipClearance>> const& steps) {
  if (steps.empty() || steps.front().empty()) return {};
  std::size_t width = 9;
  for (auto const& tip : steps.front()) width = std::max(width, tip.name.size());
  std::string text =
      fmt::format("{:<{}}  {:>11}  {:>18}  {:>18}  {:>24}  {:<10}  {}\n", "clearance", width, "before",
                  "by the rule, step", "in the mesh, step", "mean in the mesh", "distance", "smallest at");
  for (std::size_t t = 0; t < steps.front().size(); ++t) {
    std::size_t by_rule = 0, after = 0;
    double least = steps[0][t].after.mean, most = least;
    for (std::size_t s = 0; s < steps.size(); ++s) {
      TipClearance const& tip = steps[s][t];
      if (tip.by_rule && tip.by_rule->smallest < steps[by_rule][t].by_rule->smallest) by_rule = s;
      if (tip.after.smallest < steps[after][t].after.smallest) after = s;
      least = std::min(least, tip.after.mean);
      most = std::max(most, tip.after.mean);
    }
    auto const& rule = steps[by_rule][t].by_rule;
    Clearance const& mesh = steps[after][t].after;
    Clearance const& told = rule ? *rule : mesh;
    text += fmt::format("{:<{}}  {:>11.4g}", steps[0][t].name, width, steps[0][t].before.smallest);
    text += rule ? fmt::format("  {:>11.4g}  {:>5}", rule->smallest, by_rule + 1)
                 : fmt::format("  {:>11}  {:>5}", "-", "-");
    text += fmt::format("  {:>11.4g}  {:>5}  {:>11.4g}  {:>11.4g}  {:<10}  {}{}\n", mesh.smallest, after + 1, least,
                        most, name_of(steps[rule ? by_rule : after][t].measure), to_text(told.at, 6),
                        told.smallest < -round_off * norm(told.at) ? ", rubs" : "");
  }
  return text;
}

nlohmann::json clearance_json(std::vector<TipClearance> const& tips) {
  nlohmann::json out = nlohmann::json::array();
  for (auto const& tip : tips)
    out.push_back({{"name", tip.name},
                   {"nodes", tip.nodes},
                   {"before", json_of(tip.before)},
                   {"by_rule", tip.by_rule ? json_of(*tip.by_rule) : nlohmann::json()},
                   {"after", json_of(tip.after)},
                   {"distance", name_of(tip.measure)},
                   {"scatter_of_wall", tip.scatter}});
  return out;
}

}  // namespace gridmorph
