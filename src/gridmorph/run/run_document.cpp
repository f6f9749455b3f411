#include <gridmorph/mapping/mapping_report.hpp>
#include <gridmorph/report/measure_text.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/report/quality_table.hpp>
#include <gridmorph/run/run.hpp>
#include <gridmorph/run/run_document.hpp>
#include <gridmorph/run/step_files.hpp>
#include <gridmorph/run/wheel_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string_view>

namespace gridmorph::cli {

MorphedStep morphed_step(double largest_displacement, QualityReport const& quality,
                         std::vector<TipClearance> clearances) {
  MorphedStep out;
  out.largest_displacement = largest_displacement;
  out.newly_inverted = newly_inverted(quality);
  out.clearances = std::move(clearances);
  QualityRegion const &near = quality.near_field, &far = quality.far_field;
  out.inversion = std::min({0.0, near[Fall::inverted].worst, far[Fall::inverted].worst});
  auto const least = [&](Measure measure) {
    MeasureStatistics const &a = near[measure], &b = far[measure];
    return &(a.worst_zone < 0 || (b.worst_zone >= 0 && b.worst < a.worst) ? b : a);
  };
  out.angle_deg = least(Measure::minimum_angle_deg)->worst;
  MeasureStatistics const* const worst = least(Measure::determinant_3x3x3);
  if (worst->worst_zone < 0) return out;
  out.determinant = worst->worst;
  out.place = worst_place(quality, *worst);
  out.zone = quality.zone_names.at(std::size_t(worst->worst_zone));
  for (int const index : worst->worst_cell) out.cell.push_back(index + 1);
  if (quality.unstructured) out.cell.resize(1);
  return out;
}

double SequenceStep::largest_displacement() const {
  double out = 0;
  for (MorphedStep const& passage : passages) out = std::max(out, passage.largest_displacement);
  return out;
}

Index SequenceStep::newly_inverted() const {
  Index out = 0;
  for (MorphedStep const& passage : passages) out += passage.newly_inverted;
  return out;
}

namespace {

/// "lean 0.01 m, stagger 2.5 deg".
std::string parameters_text(std::vector<Parameter> const& parameters) {
  std::string out;
  for (Parameter const& p : parameters)
    out += fmt::format("{}{} {:.9g}{}", out.empty() ? "" : ", ", p.name, p.value, p.unit.empty() ? "" : " " + p.unit);
  return out;
}

}  // namespace

RunDocument document_of(CaseFile const& case_file) {
  RunDocument out{case_file.source.string(), case_file.input.string()};
  out.thresholds = thresholds_of(case_file);
  out.parameters = case_file.parameters;
  if (bool const varies = case_file.sequence && case_file.sequence->is_sweep(); !varies && !out.parameters.empty())
    out.notes.push_back("parameters: " + parameters_text(out.parameters));
  for (auto const& use : case_file.fields) {
    out.fields.push_back(mapping_json(*use.field));
    out.fields.back()["rule"] = use.where;
    if (use.inverse) out.fields.back()["inverse"] = inverse_json(*use.inverse);
  }
  return out;
}

namespace {

using nlohmann::json;

std::vector<std::string> messages_of(std::vector<Shortfall> const& shortfalls) {
  std::vector<std::string> out;
  for (Shortfall const& s : shortfalls) out.push_back(s.message);
  return out;
}

std::string notes_text(RunDocument const& document) {
  std::string text;
  for (auto const& note : document.notes) text += "note: " + note + "\n";
  return text;
}

json stages_json(std::vector<StageOutcome> const& stages) {
  json out = json::array();
  for (StageOutcome const& stage : stages) {
    out.push_back({{"name", stage.stage}, {"min_determinant", nullptr}});
    Index3 const& cell = stage.determinant.cell;
    if (!stage.zone.empty())
      out.back()["min_determinant"] = {
          {"value", stage.determinant.value}, {"zone", stage.zone}, {"cell", {cell[0] + 1, cell[1] + 1, cell[2] + 1}}};
  }
  return out;
}

std::string stages_text(std::vector<StageOutcome> const& stages) {
  std::string text;
  for (StageOutcome const& stage : stages)
    if (!stage.zone.empty())
      text += fmt::format("stage {}: smallest determinant {:.4g}, {}\n", stage.stage, stage.determinant.value,
                          describe_cell(stage.zone, stage.determinant.cell));
  return text + (text.empty() ? "" : "\n");
}

/// {"value", "zone", "cell" or "element"}; null where nothing was measured.
json min_determinant_json(MorphedStep const& step) {
  if (step.place.empty()) return nullptr;
  return {{"value", step.determinant},
          {"zone", step.zone},
          {step.cell.size() == 1 ? "element" : "cell", step.cell.size() == 1 ? json(step.cell[0]) : json(step.cell)}};
}

json passages_json(std::vector<MorphedStep> const& passages) {
  json out = json::array();
  for (MorphedStep const& now : passages) {
    out.push_back({{"passage", out.size() + 1},
                   {"largest_displacement", now.largest_displacement},
                   {"min_determinant", now.determinant},
                   {"min_angle_deg", now.angle_deg},
                   {"newly_inverted", now.newly_inverted}});
    if (!now.clearances.empty()) out.back()["clearances"] = clearance_json(now.clearances);
  }
  return out;
}

json parameters_json(std::vector<Parameter> const& parameters) {
  json out = json::object();
  for (Parameter const& p : parameters)
    out[p.name] = {{"value", p.value},
                   {"unit", p.unit.empty() ? json() : json(p.unit)},
                   {"range", p.range ? json(*p.range) : json()}};
  return out;
}

json sequence_json(MorphedSequence const& sequence, bool of_wheel) {
  SequenceOptions const& options = sequence.options;
  json list = json::array();
  for (SequenceStep const& step : sequence.steps) {
    MorphedStep const& worst = step.passages[step.worst];
    json now{{"step", list.size() + 1},
             {"largest_displacement", step.largest_displacement()},
             {"newly_inverted", step.newly_inverted()},
             {"shortfall", step.failures.empty() ? json() : json(step.failures.front())},
             {"shortfalls", step.failures},
             {"min_determinant", min_determinant_json(worst)}};
    if (of_wheel) {
      now["worst_passage"] = step.worst + 1;
      now["passages"] = passages_json(step.passages);
    } else if (!worst.clearances.empty()) {
      now["clearances"] = clearance_json(worst.clearances);
    }
    if (options.is_sweep())
      now["parameters"] = options.values_at(int(list.size()));
    else
      now["time"] = step.time;
    if (one_file_per_step(options) && !step.left_out) now["file"] = step_path(options, int(list.size())).string();
    list.push_back(std::move(now));
  }
  json out{{"worst_step", sequence.worst + 1}, {"steps", std::move(list)}};
  if (options.is_sweep())
    out["parameters"] = options.parameters;
  else
    out.update({{"period", options.period}, {"periods", options.periods}});
  if (of_wheel) out["passages"] = passages_over_time_json(sequence.steps);
  return out;
}

/// A row per step, of a wheel with its worst passage; of long sequences evenly spaced steps and the worst.
std::string steps_table(MorphedSequence const& sequence, bool of_wheel) {
  constexpr std::size_t most_rows = 100;
  SequenceOptions const& options = sequence.options;
  std::string when;
  for (std::string const& name : options.is_sweep() ? options.parameters : std::vector<std::string>{"time"})
    when += fmt::format("  {:>12}", name);
  std::string text =
      fmt::format("{:>6}{}  {:>20}  {:>20}  {:>14}  {}at\n", options.step_word(), when, "largest displacement",
                  "smallest determinant", "newly inverted", of_wheel ? "passage  " : "");
  auto const& steps = sequence.steps;
  std::size_t const stride = (steps.size() + most_rows - 1) / most_rows;
  for (std::size_t s = 0; s < steps.size(); ++s) {
    if (s % stride != 0 && s != sequence.worst) continue;
    SequenceStep const& step = steps[s];
    MorphedStep const& at = step.passages[step.worst];
    when.clear();
    std::vector<double> const values = options.is_sweep() ? options.designs[s] : std::vector<double>{step.time};
    for (std::size_t v = 0; v < values.size(); ++v) {
      std::size_t const wide = options.is_sweep() ? options.parameters[v].size() : 0;
      when += fmt::format("  {:>{}.6g}", values[v], std::max<std::size_t>(12, wide));
    }
    text += fmt::format("{:>6}{}  {:>20.6g}  {:>20.4f}  {:>14}  {}{}{}\n", s + 1, when, step.largest_displacement(),
                        at.determinant, step.newly_inverted(), of_wheel ? fmt::format("{:>7}  ", step.worst + 1) : "",
                        at.place, s == sequence.worst ? "  <- worst" : "");
  }
  return text;
}

/// "3 of 24 steps fall short, the first is step 7: ..."; empty where none does.
std::string short_steps_text(MorphedSequence const& sequence) {
  std::vector<SequenceStep> const& steps = sequence.steps;
  auto const falls_short = [](SequenceStep const& step) { return !step.failures.empty(); };
  auto const first = std::find_if(steps.begin(), steps.end(), falls_short);
  if (first == steps.end()) return "";
  auto const count = std::count_if(steps.begin(), steps.end(), falls_short);
  char const* const word = sequence.options.step_word();
  return fmt::format("{} of {} {}s {} short, {} {} {}: {}", count, steps.size(), word, count == 1 ? "falls" : "fall",
                     count == 1 ? "it is" : "the first is", word, first - steps.begin() + 1, first->failures.front());
}

std::string steps_text(MorphedSequence const& sequence) {
  std::vector<std::vector<TipClearance>> clearances;
  for (SequenceStep const& step : sequence.steps) clearances.push_back(step.passages.front().clearances);
  std::string text = steps_table(sequence, false);
  for (std::string const& more : {clearance_steps_table(clearances), short_steps_text(sequence)})
    if (!more.empty()) text += "\n" + more + (more.back() == '\n' ? "" : "\n");
  return text;
}

std::string mesh_text(RunDocument const& document) {
  MorphedMesh const& mesh = *document.mesh;
  std::string text = notes_text(document);
  for (Shortfall const& s : mesh.of_motion)
    text += (s.severity == Shortfall::Severity::failure ? "falls short: " : "warning: ") + s.message + "\n";
  text += mesh.plan.headline;
  if (document.sequence)
    text +=
        (text.empty() ? "" : "\n") + steps_text(*document.sequence) +
        fmt::format("\n{} {}, the worst one\n\n", document.sequence->options.step_word(), document.sequence->worst + 1);
  else  // notes of a plan without a headline go straight on to what follows
    text += (mesh.plan.headline.empty() ? "" : "\n") +
            (mesh.clearances.empty() ? std::string() : clearance_table(mesh.clearances) + "\n");
  if (mesh.plan.stages) text += stages_text(*mesh.plan.stages);
  text += format_table(document.baseline, mesh.quality, document.thresholds);
  if (!mesh.quality.fast) text += "\n" + format_short_table(document.baseline, mesh.quality);
  return text + "\n" + format_times(document.times, document.nodes);
}

std::string planned_text(RunDocument const& document) {
  PlannedMotion const& plan = *document.plan;
  std::string const notes = notes_text(document), &prediction = plan.prediction.text;
  bool const of_blocks = plan.json.contains("stages");
  return notes + (of_blocks && !notes.empty() ? "\n" : "") + plan.text + (prediction.empty() ? "" : "\n") + prediction +
         "\n" + format_times(document.times, document.nodes);
}

json planned_json(PlannedMotion const& plan) {
  json out = plan.json;
  if (!plan.prediction.json.is_null()) out["prediction"] = plan.prediction.json;
  return out;
}

json morphed_json(RunDocument const& document) {
  std::optional<QualityReport> morphed;
  if (document.mesh) morphed = document.mesh->quality;
  json out = quality_json(document.baseline, morphed, document.thresholds);
  out["shortfalls"] = shortfalls_json(shortfalls_of(document));
  out["fields"] = document.fields;
  if (!document.parameters.empty()) out["parameters"] = parameters_json(document.parameters);
  out["output"] = document.output ? json(*document.output) : json();
  if (document.sequence) out["sequence"] = sequence_json(*document.sequence, document.wheel.has_value());
  if (document.wheel) out.update(wheel_json(*document.wheel));
  if (document.mesh) {
    PlanOutcome const& plan = document.mesh->plan;
    if (!plan.plan.is_null()) out.update(plan.plan);
    if (plan.stages) out["stages"] = stages_json(*plan.stages);
    out["targets"] = plan.targets;
    if (!document.mesh->clearances.empty()) out["clearances"] = clearance_json(document.mesh->clearances);
  }
  out.update(document.guarded);
  return out;
}

}  // namespace

json run_json(RunDocument const& document) {
  json out = document.plan ? planned_json(*document.plan) : morphed_json(document);
  out["gridmorph"] = GRIDMORPH_VERSION;
  out["case_file"] = document.case_file;
  out["input"] = document.input;
  out["nodes"] = document.nodes;
  out["notes"] = document.notes;
  out["times"] = times_json(document.times, document.nodes);
  return out;
}

std::string run_text(RunDocument const& document) {
  if (document.plan) return planned_text(document);
  if (document.mesh) return mesh_text(document);
  std::string const wheel = notes_text(document) + wheel_text(*document.wheel, document.baseline) + "\n" +
                            format_times(document.times, document.nodes);
  if (!document.sequence) return wheel;
  return steps_table(*document.sequence, true) + "\nall steps\n\n" +
         passages_over_time_text(document.sequence->steps, document.wheel->passages) +
         fmt::format("\nstep {}, the worst one\n\n", document.sequence->worst + 1) + wheel;
}

std::vector<Shortfall> shortfalls_of(RunDocument const& document) {
  std::vector<Shortfall> out;
  auto const add = [&](std::vector<Shortfall> const& list, std::string const& of) {
    for (Shortfall const& s : list) out.push_back({s.severity, of + s.message});
  };
  if (document.mesh) {
    add(document.mesh->of_motion, "");
    add(shortfalls(document.baseline, document.mesh->quality, document.thresholds), "");
  }
  if (document.wheel) {
    std::string const step = document.sequence ? fmt::format("step {}, ", document.sequence->worst + 1) : "";
    auto const& passages = document.wheel->passages;
    for (std::size_t p = 0; p < passages.size(); ++p)
      add(passages[p].shortfalls, fmt::format("{}passage {}: ", step, p + 1));
  }
  return out;
}

bool misses_thresholds(RunDocument const& document) {
  if (any_failure(shortfalls_of(document))) return true;
  return document.sequence && !short_steps_text(*document.sequence).empty();
}

std::vector<std::string> warnings_of(RunDocument const& document) {
  if (document.wheel)
    return document.sequence ? failures_of(document.sequence->steps) : failures_of(document.wheel->passages);
  std::vector<std::string> out = messages_of(shortfalls_of(document));
  if (std::string const steps = document.sequence ? short_steps_text(*document.sequence) : ""; !steps.empty())
    out.insert(out.begin(), steps);
  return out;
}

}  // namespace gridmorph::cli
