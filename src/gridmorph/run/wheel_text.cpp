#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/report/measure_text.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/run/run.hpp>
#include <gridmorph/run/wheel_text.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace gridmorph::cli {

namespace {

std::vector<std::string> zone_names(Mesh const& mesh, WheelRow const& row) {
  std::vector<std::string> out;
  for (int const z : row.zones) out.push_back(mesh.zones[z].name);
  return out;
}

std::string blades_text(std::vector<std::string> const& blades) {
  std::string out;
  for (auto const& blade : blades) out += (out.empty() ? "" : ", ") + (blade.empty() ? "-" : blade);
  return out;
}

double smallest(QualityReport const& q, Measure m) {
  return q.near_field.cells == 0 ? q.far_field[m].min : std::min(q.near_field[m].min, q.far_field[m].min);
}

PassageStep passage_step(PassageResult const& passage) {
  QualityReport const& q = passage.quality;
  PassageStep out{passage.largest_displacement,
                  smallest(q, Measure::determinant_3x3x3),
                  smallest(q, Measure::minimum_angle_deg),
                  newly_inverted(q),
                  {},
                  {},
                  {},
                  passage.clearances};
  MeasureStatistics const* worst = nullptr;
  for (auto const* region : {&q.near_field, &q.far_field}) {
    auto const& measure = (*region)[Measure::determinant_3x3x3];
    if (measure.worst_zone >= 0 && (worst == nullptr || measure.worst < worst->worst)) worst = &measure;
  }
  if (worst == nullptr) return out;
  out.place = worst_place(q, *worst);
  out.zone = q.zone_names.at(std::size_t(worst->worst_zone));
  for (int const index : worst->worst_cell) out.cell.push_back(index + 1);
  if (q.unstructured) out.cell.resize(1);
  return out;
}

/// Tips of all passages, named by them. `passages`: whatever has clearances.
template <class Passages>
std::vector<TipClearance> all_tips(Passages const& passages) {
  std::vector<TipClearance> out;
  for (std::size_t p = 0; p < passages.size(); ++p)
    for (TipClearance tip : passages[p].clearances) {
      tip.name = fmt::format("passage {}: {}", p + 1, tip.name);
      out.push_back(std::move(tip));
    }
  return out;
}

double told(TipClearance const& tip) { return tip.by_rule ? tip.by_rule->smallest : tip.after.smallest; }

/// "smallest of all: 0.0012, passage 3: rotor"
std::string smallest_of_all(std::vector<std::vector<TipClearance>> const& steps) {
  TipClearance const* least = nullptr;
  std::size_t at = 0;
  for (std::size_t s = 0; s < steps.size(); ++s)
    for (TipClearance const& tip : steps[s])
      if (least == nullptr || told(tip) < told(*least)) {
        least = &tip;
        at = s;
      }
  if (least == nullptr) return {};
  std::string const step = steps.size() > 1 ? fmt::format("step {}, ", at + 1) : "";
  return fmt::format("smallest of all: {:.4g}, {}{}\n", told(*least), step, least->name);
}

std::string line(std::string const& passage, std::string const& blade, std::size_t width,
                 std::string const& displacement, QualityReport const& q) {
  auto const largest = [&](Measure m) { return std::max(q.near_field[m].max, q.far_field[m].max); };
  std::string const aspect_ratio = q.fast ? "-" : fmt::format("{:.4g}", largest(Measure::aspect_ratio));
  return fmt::format("{:>8}  {:<{}}  {:>12}  {:>8}  {:>11.4g}  {:>9.4g}  {:>12}\n", passage, blade, width, displacement,
                     q.near_field.inverted + q.far_field.inverted, smallest(q, Measure::determinant_3x3x3),
                     smallest(q, Measure::minimum_angle_deg), aspect_ratio);
}

/// {"value", "zone", "cell" or "element"}; null where nothing was measured.
nlohmann::json min_determinant_json(PassageStep const& passage) {
  if (passage.zone.empty()) return nullptr;
  nlohmann::json out{{"value", passage.determinant}, {"zone", passage.zone}};
  if (passage.cell.size() == 1)
    out["element"] = passage.cell[0];
  else
    out["cell"] = passage.cell;
  return out;
}

}  // namespace

std::string describe_rows(Mesh const& mesh, WheelRows const& rows, WheelSetup const& setup) {
  std::string text;
  for (std::size_t r = 0; r < rows.rows.size(); ++r) {
    auto const zones = quote_list(zone_names(mesh, rows.rows[r]), 6);
    if (RowPitch const& pitch = rows.rows[r].pitch; pitch.is_straight()) {
      text += fmt::format("straight row of {}: {} passages, each shifted by {}\n", zones, setup.blades[r].passages,
                          to_text(pitch.shift(), 6));
      continue;
    }
    text += rows.rows[r].periodic()
                ? fmt::format("row of {}: {} of {} passages\n", zones, setup.blades[r].passages, rows.rows[r].passages)
                : fmt::format("{}: no periodic interface, kept as it is\n", zones);
  }
  return text;
}

std::string passage_table(WheelResult const& result) {
  std::size_t width = 5;
  for (auto const& p : result.passages) width = std::max(width, blades_text(p.blades).size());
  std::string text = fmt::format("{:>8}  {:<{}}  {:>12}  {:>8}  {:>11}  {:>9}  {:>12}\n", "passage", "blade", width,
                                 "displacement", "inverted", "determinant", "angle", "aspect ratio");
  text += line("baseline", "", width, "", result.baseline);
  for (std::size_t p = 0; p < result.passages.size(); ++p)
    text += line(std::to_string(p + 1), blades_text(result.passages[p].blades), width,
                 fmt::format("{:.4g}", result.passages[p].largest_displacement), result.passages[p].quality);
  return text;
}

std::string wheel_clearances(WheelMade const& made) {
  auto const tips = all_tips(made.passages);
  return tips.empty() ? std::string() : clearance_table(tips) + smallest_of_all({tips});
}

std::string wheel_clearances(std::vector<WheelStep> const& steps) {
  std::vector<std::vector<TipClearance>> tips;
  for (WheelStep const& step : steps) tips.push_back(all_tips(step.passages));
  return clearance_steps_table(tips) + smallest_of_all(tips);
}

WheelStep wheel_step(double time, WheelMade const& made) {
  WheelStep out{time, {}, failures_of(made)};
  for (auto const& passage : made.passages) {
    out.passages.push_back(passage_step(passage));
    if (out.passages.back().worse_than(out.passages[out.worst])) out.worst = out.passages.size() - 1;
  }
  return out;
}

double WheelStep::largest_displacement() const {
  double out = 0;
  for (PassageStep const& passage : passages) out = std::max(out, passage.largest_displacement);
  return out;
}

Index WheelStep::newly_inverted() const {
  Index out = 0;
  for (PassageStep const& passage : passages) out += passage.newly_inverted;
  return out;
}

std::size_t worst_step(std::vector<WheelStep> const& steps) {
  std::size_t worst = 0;
  for (std::size_t s = 1; s < steps.size(); ++s)
    if (steps[s].worse_than(steps[worst])) worst = s;
  return worst;
}

std::vector<std::string> failures_of(WheelMade const& made) {
  std::vector<std::string> out;
  for (std::size_t p = 0; p < made.passages.size(); ++p)
    for (auto const& s : made.passages[p].shortfalls)
      if (s.severity == Shortfall::Severity::failure) out.push_back(fmt::format("passage {}: {}", p + 1, s.message));
  return out;
}

std::string wheel_steps_table(std::vector<WheelStep> const& steps) {
  constexpr std::size_t most_rows = 100;
  std::string text = fmt::format("{:>6}  {:>12}  {:>20}  {:>20}  {:>14}  {:>7}  {}\n", "step", "time",
                                 "largest displacement", "smallest determinant", "newly inverted", "passage", "at");
  std::size_t const stride = (steps.size() + most_rows - 1) / most_rows, worst = worst_step(steps);
  for (std::size_t s = 0; s < steps.size(); ++s) {
    if (s % stride != 0 && s != worst) continue;
    WheelStep const& step = steps[s];
    PassageStep const& at = step.passages[step.worst];
    text += fmt::format("{:>6}  {:>12.6g}  {:>20.6g}  {:>20.4f}  {:>14}  {:>7}  {}{}\n", s + 1, step.time,
                        step.largest_displacement(), at.determinant, step.newly_inverted(), step.worst + 1, at.place,
                        s == worst ? "  <- worst" : "");
  }
  return text;
}

std::string passages_over_time(std::vector<WheelStep> const& steps, WheelMade const& made) {
  std::size_t width = 5;
  for (auto const& p : made.passages) width = std::max(width, blades_text(p.blades).size());
  std::string text =
      fmt::format("{:>8}  {:<{}}  {:>20}  {:>7}  {:>20}  {:>7}  {:>14}\n", "passage", "blade", width,
                  "largest displacement", "at step", "smallest determinant", "at step", "newly inverted");
  for (std::size_t p = 0; p < made.passages.size(); ++p) {
    std::size_t farthest = 0, worst = 0;
    Index inverted = 0;
    for (std::size_t s = 0; s < steps.size(); ++s) {
      PassageStep const& now = steps[s].passages[p];
      if (now.largest_displacement > steps[farthest].passages[p].largest_displacement) farthest = s;
      if (now.worse_than(steps[worst].passages[p])) worst = s;
      inverted = std::max(inverted, now.newly_inverted);
    }
    text += fmt::format("{:>8}  {:<{}}  {:>20.6g}  {:>7}  {:>20.4f}  {:>7}  {:>14}\n", p + 1,
                        blades_text(made.passages[p].blades), width, steps[farthest].passages[p].largest_displacement,
                        farthest + 1, steps[worst].passages[p].determinant, worst + 1, inverted);
  }
  return text;
}

nlohmann::json wheel_steps_json(std::vector<WheelStep> const& steps) {
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t s = 0; s < steps.size(); ++s) {
    nlohmann::json passages = nlohmann::json::array();
    for (std::size_t p = 0; p < steps[s].passages.size(); ++p) {
      PassageStep const& now = steps[s].passages[p];
      passages.push_back({{"passage", p + 1},
                          {"largest_displacement", now.largest_displacement},
                          {"min_determinant", now.determinant},
                          {"min_angle_deg", now.angle_deg},
                          {"newly_inverted", now.newly_inverted}});
      if (!now.clearances.empty()) passages.back()["clearances"] = clearance_json(now.clearances);
    }
    WheelStep const& step = steps[s];
    list.push_back({{"step", s + 1},
                    {"time", step.time},
                    {"largest_displacement", step.largest_displacement()},
                    {"newly_inverted", step.newly_inverted()},
                    {"worst_passage", step.worst + 1},
                    {"min_determinant", min_determinant_json(step.passages[step.worst])},
                    {"shortfall", step.failures.empty() ? nlohmann::json() : nlohmann::json(step.failures.front())},
                    {"shortfalls", step.failures},
                    {"passages", std::move(passages)}});
  }
  return list;
}

nlohmann::json wheel_json(Mesh const& mesh, WheelRows const& rows, WheelSetup const& setup, WheelResult const& result) {
  nlohmann::json json{{"gridmorph", GRIDMORPH_VERSION}, {"nodes", result.nodes}, {"notes", result.notes}};
  json["rows"] = nlohmann::json::array();
  for (std::size_t r = 0; r < rows.rows.size(); ++r) {
    nlohmann::json row{{"zones", zone_names(mesh, rows.rows[r])}, {"passages", setup.blades[r].passages}};
    if (Vec3 const& shift = rows.rows[r].pitch.shift(); rows.rows[r].pitch.is_straight())
      row["pitch"] = {shift.x, shift.y, shift.z};
    else
      row["passages_of_wheel"] = rows.rows[r].passages;
    json["rows"].push_back(std::move(row));
  }
  json["baseline"] = result.baseline;
  json["passages"] = nlohmann::json::array();
  for (std::size_t p = 0; p < result.passages.size(); ++p) {
    auto const& passage = result.passages[p];
    json["passages"].push_back({{"passage", p + 1},
                                {"blades", passage.blades},
                                {"largest_displacement", passage.largest_displacement},
                                {"quality", passage.quality},
                                {"shortfalls", shortfalls_json(passage.shortfalls)}});
    if (!passage.clearances.empty()) json["passages"].back()["clearances"] = clearance_json(passage.clearances);
  }
  json["certificate"] = certificate_json(result.whole);
  json["largest_seam_gap"] = result.gap.distance;
  json["times"] = times_json(result.times, result.nodes);
  return json;
}

}  // namespace gridmorph::cli
