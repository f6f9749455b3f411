#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/report/tip_clearance.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph {

namespace {

/// Of the extent of a wall: nodes as near as that along it are one point of the profile.
constexpr double same_station = 1e-9;
/// Of its size: nodes farther from the profile than that are on no surface of revolution.
constexpr double largest_scatter = 1e-3;

/// Of the distance from the origin: nodes as near as that to the wall are on it.
constexpr double round_off = 1e-9;

nlohmann::json json_of(Clearance const& c) {
  return {{"smallest", c.smallest}, {"mean", c.mean}, {"at", {c.at.x, c.at.y, c.at.z}}};
}

}  // namespace

ClearanceWall::ClearanceWall(Axis const& axis, std::vector<Vec3> const& nodes)
    : axis_{axis.origin, (1 / norm(axis.direction)) * axis.direction} {
  std::vector<std::pair<double, double>> all;
  for (Vec3 const& node : nodes) all.push_back(meridional(node));
  std::sort(all.begin(), all.end());
  if (all.empty()) throw MotionError("clearance: the wall has no nodes");
  double const extent = all.back().first - all.front().first;
  double size = extent;
  for (std::size_t first = 0; first < all.size();) {
    std::size_t last = first;
    double low = all[first].second, high = low, sum = 0;
    for (; last < all.size() && all[last].first - all[first].first <= same_station * extent; ++last) {
      low = std::min(low, all[last].second);
      high = std::max(high, all[last].second);
      sum += all[last].second;
    }
    double const mean = low == high ? low : sum / double(last - first);
    scatter_ = std::max({scatter_, high - mean, mean - low});
    size = std::max(size, high);
    points_.emplace_back(all[first].first, mean);
    first = last;
  }
  if (scatter_ > largest_scatter * size || points_.size() < 2)
    throw MotionError(fmt::format(
        "clearance: the nodes of the wall are up to {:.3g} off one radius over the axial position, and clearances are "
        "those to walls of revolution; name one such wall in walls",
        scatter_));
  refine();
}

/// Nodes slide on the smooth profile through the wall's nodes, not on the chords between them.
void ClearanceWall::refine() {
  constexpr int parts = 16;  // of a chord: its error falls by their square
  auto const profile = RevolutionProfile::from_points(points_);
  std::vector<std::pair<double, double>> fine;
  for (std::size_t n = 0; n + 1 < points_.size(); ++n) {
    fine.push_back(points_[n]);
    double const first = points_[n].first, step = (points_[n + 1].first - first) / parts;
    for (int p = 1; p < parts; ++p) fine.emplace_back(first + p * step, profile(first + p * step));
  }
  fine.push_back(points_.back());
  points_ = std::move(fine);
}

std::pair<double, double> ClearanceWall::meridional(Vec3 const& point) const {
  Vec3 const d = point - axis_.origin;
  double const along = dot(d, axis_.direction);
  return {along, norm(d - along * axis_.direction)};
}

double ClearanceWall::distance(Vec3 const& point) const {
  auto const [axial, radius] = meridional(point);
  // Nearest place on the line through the points, from the station of the point outwards.
  double best = std::numeric_limits<double>::infinity(), sign = 1;
  auto const look = [&](std::size_t n) {
    auto const [a, r] = points_[n];
    double const da = points_[n + 1].first - a, dr = points_[n + 1].second - r;
    double const t = std::clamp(((axial - a) * da + (radius - r) * dr) / (da * da + dr * dr), 0.0, 1.0);
    double const gap = std::hypot(axial - a - t * da, radius - r - t * dr);
    if (gap >= best) return;
    best = gap;
    sign = (axial - a) * dr - (radius - r) * da < 0 ? -1 : 1;
  };
  auto const above =
      std::upper_bound(points_.begin(), points_.end(), std::pair(axial, std::numeric_limits<double>::infinity()));
  std::size_t const pieces = points_.size() - 1;
  std::size_t const start = std::min(pieces - 1, std::size_t(std::max<std::ptrdiff_t>(0, above - points_.begin() - 1)));
  for (std::size_t n = start; n < pieces && points_[n].first - axial <= best; ++n) look(n);
  for (std::size_t n = start; n > 0 && axial - points_[n].first <= best; --n) look(n - 1);
  return sign * best;
}

Clearance ClearanceWall::of(std::vector<Vec3> const& nodes, double outwards) const {
  Clearance out;
  out.smallest = std::numeric_limits<double>::infinity();
  for (Vec3 const& node : nodes) {
    double const gap = outwards * distance(node);
    out.mean += gap / double(nodes.size());
    if (gap >= out.smallest) continue;
    out.smallest = gap;
    out.at = node;
  }
  return out;
}

std::vector<std::size_t> tip_nodes(ClearanceWall const& wall, std::vector<Vec3> const& blade, double share) {
  std::vector<double> gap;
  for (Vec3 const& node : blade) gap.push_back(std::abs(wall.distance(node)));
  std::vector<std::size_t> out;
  if (blade.empty()) return out;
  auto const [low, high] = std::minmax_element(gap.begin(), gap.end());
  double const limit = *low + share * (*high - *low);
  for (std::size_t n = 0; n < blade.size(); ++n)
    if (gap[n] <= limit) out.push_back(n);
  return out;
}

std::string clearance_table(std::vector<TipClearance> const& tips) {
  std::size_t width = 9;
  for (auto const& tip : tips) width = std::max(width, tip.name.size());
  std::string text = fmt::format("{:<{}}  {:>24}  {:>24}  {:>24}  {}\n{:<{}}", "clearance", width, "before",
                                 "by the rule", "in the mesh", "smallest at", "", width);
  for (int n = 0; n < 3; ++n) text += fmt::format("  {:>11}  {:>11}", "smallest", "mean");
  text += "\n";
  auto const cells = [](Clearance const& c) { return fmt::format("  {:>11.4g}  {:>11.4g}", c.smallest, c.mean); };
  for (auto const& tip : tips) {
    text += fmt::format("{:<{}}", tip.name, width) + cells(tip.before);
    text += tip.by_rule ? cells(*tip.by_rule) : fmt::format("  {:>11}  {:>11}", "-", "-");
    text += cells(tip.after);
    Clearance const& told = tip.by_rule ? *tip.by_rule : tip.after;
    text += "  " + to_text(told.at, 6) + (told.smallest < -round_off * norm(told.at) ? ", rubs" : "") + "\n";
  }
  return text;
}

std::string clearance_steps_table(std::vector<std::vector<TipClearance>> const& steps) {
  if (steps.empty() || steps.front().empty()) return {};
  std::size_t width = 9;
  for (auto const& tip : steps.front()) width = std::max(width, tip.name.size());
  std::string text = fmt::format("{:<{}}  {:>11}  {:>18}  {:>18}  {:>24}  {}\n", "clearance", width, "before",
                                 "by the rule, step", "in the mesh, step", "mean in the mesh", "smallest at");
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
    text += fmt::format("  {:>11.4g}  {:>5}  {:>11.4g}  {:>11.4g}  {}{}\n", mesh.smallest, after + 1, least, most,
                        to_text(told.at, 6), told.smallest < -round_off * norm(told.at) ? ", rubs" : "");
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
                   {"scatter_of_wall", tip.scatter}});
  return out;
}

}  // namespace gridmorph
