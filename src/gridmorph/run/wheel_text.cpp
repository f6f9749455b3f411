#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/quality/newly_inverted.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/report/quality_table.hpp>
#include <gridmorph/run/recipe.hpp>
#include <gridmorph/run/wheel_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace gridmorph::cli {

namespace {

std::string blades_text(std::vector<std::string> const& blades) {
  std::string out;
  for (auto const& blade : blades) out += (out.empty() ? "" : ", ") + (blade.empty() ? "-" : blade);
  return out;
}

std::size_t width_of_blades(std::vector<PassageResult> const& passages) {
  std::size_t width = 5;
  for (auto const& p : passages) width = std::max(width, blades_text(p.blades).size());
  return width;
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

/// A table of tips and "smallest of all: 0.0012, passage 3: rotor"; empty without tips.
std::string clearances_text(std::string const& table, std::vector<std::vector<TipClearance>> const& steps) {
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
  return "\n" + table + fmt::format("smallest of all: {:.4g}, {}{}\n", told(*least), step, least->name);
}

std::string rows_text(std::vector<RowOfPassages> const& rows) {
  std::string text;
  for (RowOfPassages const& row : rows) {
    auto const zones = quote_list(row.zones, 6);
    if (row.pitch)
      text += fmt::format("straight row of {}: {} passages, each shifted by {}\n", zones, row.passages,
                          to_text(*row.pitch, 6));
    else
      text += row.passages_of_wheel != 1
                  ? fmt::format("row of {}: {} of {} passages\n", zones, row.passages, row.passages_of_wheel)
                  : fmt::format("{}: no periodic interface, kept as it is\n", zones);
  }
  return text;
}

/// One line per passage: blades, displacement, worst cells; near and far field together.
std::string passage_table(std::vector<PassageResult> const& passages, QualityReport const& baseline) {
  std::size_t const width = width_of_blades(passages);
  std::string text = fmt::format("{:>8}  {:<{}}  {:>12}  {:>8}  {:>11}  {:>9}  {:>12}\n", "passage", "blade", width,
                                 "displacement", "inverted", "determinant", "angle", "aspect ratio");
  auto const add = [&](std::string const& passage, std::string const& blade, std::string const& displacement,
                       QualityReport const& q) {
    auto const worst = morphed_step(0, q, {});
    double const aspect_ratio =
        std::max(q.near_field[Measure::aspect_ratio].max, q.far_field[Measure::aspect_ratio].max);
    text += fmt::format("{:>8}  {:<{}}  {:>12}  {:>8}  {:>11.4g}  {:>9.4g}  {:>12}\n", passage, blade, width,
                        displacement, q.near_field.inverted + q.far_field.inverted, worst.determinant, worst.angle_deg,
                        q.fast ? "-" : fmt::format("{:.4g}", aspect_ratio));
  };
  add("baseline", "", "", baseline);
  for (std::size_t p = 0; p < passages.size(); ++p)
    add(std::to_string(p + 1), blades_text(passages[p].blades), fmt::format("{:.4g}", passages[p].largest_displacement),
        passages[p].quality);
  return text;
}

/// Which of two passages is the worse one: inverted cells first.
bool is_worse(MorphedStep const& a, MorphedStep const& b) {
  return std::pair(-a.newly_inverted, a.determinant) < std::pair(-b.newly_inverted, b.determinant);
}

/// What a passage comes to in all steps, which count from 1 on.
struct OverTime {
  double displacement = 0;  ///< largest
  double determinant = 0;   ///< of the worst step
  std::size_t farthest = 1, worst = 1;
  Index newly_inverted = 0;
};
OverTime over_time(std::vector<SequenceStep> const& steps, std::size_t passage) {
  auto const at = [&](std::size_t step) -> MorphedStep const& { return steps[step - 1].passages[passage]; };
  OverTime out;
  for (std::size_t s = 1; s <= steps.size(); ++s) {
    if (at(s).largest_displacement > at(out.farthest).largest_displacement) out.farthest = s;
    if (is_worse(at(s), at(out.worst))) out.worst = s;
    out.newly_inverted = std::max(out.newly_inverted, at(s).newly_inverted);
  }
  out.displacement = at(out.farthest).largest_displacement;
  out.determinant = at(out.worst).determinant;
  return out;
}

}  // namespace

SequenceStep wheel_step(double time, std::vector<PassageResult> const& passages) {
  SequenceStep out{time, {}, failures_of(passages)};
  for (PassageResult const& passage : passages) {
    out.passages.push_back(morphed_step(passage.largest_displacement, passage.quality, passage.clearances));
    if (is_worse(out.passages.back(), out.passages[out.worst])) out.worst = out.passages.size() - 1;
  }
  return out;
}

bool is_worse(SequenceStep const& a, SequenceStep const& b) {
  return is_worse(a.passages[a.worst], b.passages[b.worst]);
}

std::size_t worst_passage(std::vector<PassageResult> const& passages) {
  auto const better = [](auto const& a, auto const& b) { return badness_of(a.quality) < badness_of(b.quality); };
  return std::size_t(std::max_element(passages.begin(), passages.end(), better) - passages.begin());
}

std::vector<std::string> failures_of(std::vector<PassageResult> const& passages) {
  std::vector<std::string> out;
  for (std::size_t p = 0; p < passages.size(); ++p)
    for (auto const& s : passages[p].shortfalls)
      if (s.severity == Shortfall::Severity::failure) out.push_back(fmt::format("passage {}: {}", p + 1, s.message));
  return out;
}

std::vector<std::string> failures_of(std::vector<SequenceStep> const& steps) {
  std::vector<std::string> out;
  for (std::size_t s = 0; s < steps.size(); ++s)
    for (auto const& failure : steps[s].failures) out.push_back(fmt::format("step {}, {}", s + 1, failure));
  constexpr std::size_t most = 16;
  if (out.size() > most) {
    std::size_t const more = out.size() - most;
    out.resize(most);
    out.push_back(fmt::format("{} more; the report has them", more));
  }
  return out;
}

std::string wheel_text(MorphedWheel const& wheel, QualityReport const& baseline) {
  auto const tips = all_tips(wheel.passages);
  return rows_text(wheel.rows) + "\n" + passage_table(wheel.passages, baseline) + certificate_text(wheel.whole) +
         flat_text(wheel.whole) +
         fmt::format("\nlargest distance of coincident nodes before one took over the other's position: {:.3g}\n",
                     wheel.largest_seam_gap) +
         clearances_text(clearance_table(tips), {tips});
}

std::string passages_over_time_text(std::vector<SequenceStep> const& steps,
                                    std::vector<PassageResult> const& passages) {
  std::size_t const width = width_of_blades(passages);
  std::string text =
      fmt::format("{:>8}  {:<{}}  {:>20}  {:>7}  {:>20}  {:>7}  {:>14}\n", "passage", "blade", width,
                  "largest displacement", "at step", "smallest determinant", "at step", "newly inverted");
  for (std::size_t p = 0; p < passages.size(); ++p) {
    OverTime const all = over_time(steps, p);
    text += fmt::format("{:>8}  {:<{}}  {:>20.6g}  {:>7}  {:>20.4f}  {:>7}  {:>14}\n", p + 1,
                        blades_text(passages[p].blades), width, all.displacement, all.farthest, all.determinant,
                        all.worst, all.newly_inverted);
  }
  std::vector<std::vector<TipClearance>> tips;
  for (SequenceStep const& step : steps) tips.push_back(all_tips(step.passages));
  return text + clearances_text(clearance_steps_table(tips), tips);
}

nlohmann::json passages_over_time_json(std::vector<SequenceStep> const& steps) {
  nlohmann::json out = nlohmann::json::array();
  for (std::size_t p = 0; p < steps.front().passages.size(); ++p) {
    OverTime const all = over_time(steps, p);
    out.push_back({{"passage", p + 1},
                   {"largest_displacement", all.displacement},
                   {"farthest_step", all.farthest},
                   {"min_determinant", all.determinant},
                   {"worst_step", all.worst},
                   {"newly_inverted", all.newly_inverted}});
  }
  return out;
}

nlohmann::json wheel_json(MorphedWheel const& wheel) {
  nlohmann::json json{{"worst_passage", worst_passage(wheel.passages) + 1},
                      {"certificate", certificate_json(wheel.whole)},
                      {"largest_seam_gap", wheel.largest_seam_gap}};
  auto& rows = json["rows"] = nlohmann::json::array();
  for (RowOfPassages const& row : wheel.rows) {
    rows.push_back({{"zones", row.zones}, {"passages", row.passages}});
    if (row.pitch)
      rows.back()["pitch"] = {row.pitch->x, row.pitch->y, row.pitch->z};
    else
      rows.back()["passages_of_wheel"] = row.passages_of_wheel;
  }
  auto& passages = json["passages"] = nlohmann::json::array();
  for (PassageResult const& passage : wheel.passages) {
    passages.push_back({{"passage", passages.size() + 1},
                        {"blades", passage.blades},
                        {"largest_displacement", passage.largest_displacement},
                        {"newly_inverted", newly_inverted(passage.quality)},
                        {"quality", passage.quality},
                        {"shortfalls", shortfalls_json(passage.shortfalls)}});
    if (!passage.clearances.empty()) passages.back()["clearances"] = clearance_json(passage.clearances);
  }
  return json;
}

}  // namespace gridmorph::cli
