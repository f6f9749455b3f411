#include <gridmorph/report/step_times.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <numeric>

namespace gridmorph {

namespace {

double total(StepTimes const& times) {
  return std::accumulate(times.begin(), times.end(), 0.0,
                         [](double sum, StepTime const& t) { return sum + t.seconds; });
}

/// A clock that did not move says nothing about a rate.
bool has_rate(StepTime const& time) { return time.every_node && time.seconds > 0; }

}  // namespace

std::string format_times(StepTimes const& times, Index nodes) {
  double const sum = total(times);
  std::string out = fmt::format("{:<26}{:>10}{:>8}{:>18}\n", fmt::format("Time, {} nodes", nodes), "seconds", "share",
                                "million nodes/s");
  for (StepTime const& t : times)
    out += fmt::format("{:<26}{:>10.4f}{:>7.1f}%{:>18}\n", t.step, t.seconds, sum > 0 ? 100 * t.seconds / sum : 0.0,
                       has_rate(t) ? fmt::format("{:.1f}", 1e-6 * double(nodes) / t.seconds) : "-");
  return out + fmt::format("{:<26}{:>10.4f}\n", "total", sum);
}

nlohmann::json times_json(StepTimes const& times, Index nodes) {
  nlohmann::json steps = nlohmann::json::array();
  for (StepTime const& t : times) {
    nlohmann::json json{{"step", t.step}, {"seconds", t.seconds}, {"nodes_per_second", nullptr}};
    if (has_rate(t)) json["nodes_per_second"] = double(nodes) / t.seconds;
    steps.push_back(std::move(json));
  }
  return {{"nodes", nodes}, {"steps", std::move(steps)}, {"total_seconds", total(times)}};
}

}  // namespace gridmorph
