#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/io/file_kind.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/mapping/mapping_report.hpp>
#include <gridmorph/plan/smoothing_map.hpp>
#include <gridmorph/report/block_graph_text.hpp>
#include <gridmorph/report/json_text.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/report/quality_table.hpp>
#include <gridmorph/run/block_stages.hpp>
#include <gridmorph/run/element_stages.hpp>
#include <gridmorph/run/exit_status.hpp>
#include <gridmorph/run/output_files.hpp>
#include <gridmorph/run/run.hpp>
#include <gridmorph/run/run_files.hpp>
#include <gridmorph/run/run_page.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <gridmorph/motion/rigid_motion.hpp>
#include <system_error>
#include <utility>

namespace gridmorph::cli {

namespace {

/// Mesh and side file that are not there, each with the line that names it.
void refuse_missing_files(CaseFile const& case_file) {
  Problems problems;
  auto const check = [&](char const* key, std::filesystem::path const& path) {
    if (is_there(path.string())) return;
    auto const given = std::find_if(case_file.given.begin(), case_file.given.end(),
                                    [&](GivenKey const& k) { return k.table == "mesh" && k.key == key; });
    std::string const line = given == case_file.given.end() ? "" : fmt::format(":{}", given->line);
    problems.add(fmt::format("{}{}: [mesh] {}: '{}' does not exist; {}", case_file.source.string(), line, key,
                             path.string(), io::looked_for_at(path.string())));
  };
  check("input", case_file.input);
  if (case_file.side_file) check("side_file", *case_file.side_file);
  problems.throw_if_any<ConfigError>();
}

}  // namespace

MeshSource checked_mesh_file(CaseFile const& case_file, CaseUse::Run run) {
  refuse_missing_files(case_file);
  MeshSource file = look_at(case_file.input, case_file.leave_out);
  refuse_ignored_keys(case_file, {file.kind == MeshKind::unstructured, run, file.format});
  return file;
}

QualityThresholds thresholds_of(CaseFile const& case_file) {
  QualityThresholds out;
  out.cells = case_file.guard;
  return out;
}

bool wants_verdict(CaseFile const& case_file, Index cells) {
  constexpr Index many = 1'000'000;
  if (case_file.output_options.quality) return false;
  QualityMode const mode = case_file.guard.quality;
  return mode == QualityMode::fast || (mode == QualityMode::automatic && cells > many);
}

void add_time(StepTimes& times, std::string const& step, double seconds, bool every_node) {
  auto const at = std::find_if(times.begin(), times.end(), [&](StepTime const& t) { return t.step == step; });
  if (at != times.end())
    at->seconds += seconds;
  else
    times.push_back({step, seconds, every_node});
}

Run::Run(CaseFile const& case_file, MeshSource const& file, Console& console)
    : case_file_(case_file), console_(console) {
  Stopwatch watch;
  console.progress("reading " + case_file.input.string());
  mesh_ = std::make_unique<LoadedMesh>(file.path, case_file.side_file, file.leave_out);
  times.push_back({"read", watch.lap(), true});
  console.progress(mesh_->kind().planning);
  check_fields(case_file, mesh_->mesh());
  plan_ = std::make_unique<CasePlan>(*mesh_, case_file);
  notes = plan_->notes();
  for (auto& time : plan_->times()) times.push_back(std::move(time));
  wanted_.limits = case_file.guard;
  wanted_.fast = wants_verdict(case_file, mesh_->n_cells());
  result_.morphed = Coordinates(mesh_->n_nodes());
  result_.fields.displacement = case_file.output_options.displacement;
}

void Run::measure_baseline() {
  if (wanted_.fast) return;
  QualityWanted wanted = wanted_;
  if (keep_) {
    wanted.measures.assign(page_measures.begin(), page_measures.end());
    wanted.fields = &baseline_measures_;
  }
  baseline_ = plan_->measure(wanted);
}

Run::KeptMeasure Run::kept(Measure measure) const {
  auto const in = [&](std::vector<CellField> const& fields) -> std::vector<double> const* {
    auto const at =
        std::find_if(fields.begin(), fields.end(), [&](auto const& f) { return f.name == field_name(measure); });
    return at == fields.end() ? nullptr : &at->values;
  };
  auto const* after = in(result_.measures);
  return {in(baseline_measures_), after != nullptr ? after : in(result_.fields.cells)};
}

GuardReport Run::morph(Moment const* when, StepTimes* took) {
  Stopwatch watch;
  if (took != nullptr) console_.progress("moving the boundary");
  displacement_ = plan_->displacement(when);
  if (took != nullptr) {
    took->push_back({"boundary", watch.lap()});
    console_.progress("morphing the volume");
  }
  plan_->morph(displacement_, result_.morphed, took);
  watch.lap();
  if (!plan_->guards()) return {};
  if (took != nullptr) console_.progress("looking for bad " + mesh_->kind().cells);
  GuardReport const report = plan_->relax(result_.morphed);
  if (took != nullptr) took->push_back({"guard", watch.lap(), true});
  return report;
}

PlanPrediction Run::predict() {
  Stopwatch watch;
  try {
    PlanPrediction out = plan_->predict();
    if (!out.text.empty()) add_time(times, "prediction", watch.lap());
    return out;
  } catch (MotionError const& e) {  // the plan itself stands
    return {{}, {fmt::format("the motion cannot be made, so there is no prediction: {}", e.what())}, {}};
  }
}

void Run::freeze_guard(std::vector<Moment> const& moments) {
  Coordinates moved(mesh_->n_nodes());
  for (Moment const& when : moments) {
    plan_->morph(plan_->displacement(&when), moved, nullptr);
    plan_->freeze(moved);
  }
}

FrozenIntoPlan Run::freeze_into_plan(std::vector<Moment> const& moments) {
  Coordinates plain(mesh_->n_nodes());
  if (moments.empty()) {
    plan_->morph(displacement_, plain, nullptr);
    plan_->record(displacement_, plain, result_.morphed);
  }
  std::size_t const n = std::min(moments.size(), std::size_t(SmoothingRecord::most));
  for (std::size_t k = 0; k < n; ++k) {
    console_.progress(fmt::format("what the guard does in step {} of {}", k + 1, n));
    Moment const& when = moments[n == 1 ? 0 : k * (moments.size() - 1) / (n - 1)];
    std::vector<Vec3> const displacement = plan_->displacement(&when);
    plan_->morph(displacement, plain, nullptr);
    plan_->morph(displacement, result_.morphed, nullptr);
    (void)plan_->relax(result_.morphed);
    plan_->record(displacement, plain, result_.morphed);
  }
  SmoothingMap const& map = plan_->freeze_recorded();
  if (moments.empty()) {
    plan_->morph(displacement_, result_.morphed, nullptr);
    measure();
  }
  return {map.n_modes == 0
              ? std::string("the guard moved no node: there is nothing to freeze into the plan")
              : fmt::format("the guard is frozen into the plan: {} nodes move by a linear function of the "
                            "boundary's displacement, {} of {} displacements, by {:.3g} at most and "
                            "within {:.3g} of where the guard had them",
                            map.n_moved(), map.n_modes == 1 ? "one mode" : fmt::format("{} modes", map.n_modes),
                            map.n_records, map.largest_shift, map.misfit),
          {{"displacements", map.n_records},
           {"modes", map.n_modes},
           {"nodes", map.n_moved()},
           {"largest_shift", map.largest_shift},
           {"largest_distance", map.misfit}}};
}

void Run::measure() {
  QualityWanted wanted = wanted_;
  wanted.morphed = &result_.morphed;
  if (case_file_.output_options.quality) {
    wanted.fields = &result_.fields.cells;
  } else if (keep_ && !wanted_.fast) {
    wanted.measures.assign(page_measures.begin(), page_measures.end());
    wanted.fields = &result_.measures;
  }
  result_.quality = plan_->measure(wanted);
}

TriedSteps Run::try_steps() {
  TriedSteps tried;
  Index const in_one = newly_inverted(result_.quality);
  std::string const& cells = mesh_->kind().cells;
  Result best;
  int best_steps = 1;
  for (int steps = 2; steps <= case_file_.guard.steps && newly_inverted(result_.quality) > 0; ++steps) {
    auto const progress = [&](int step) {
      console_.progress(fmt::format("{} are inverted; morphing in steps, {} of {}", cells, step, steps));
    };
    std::optional<Coordinates> morphed;
    try {
      morphed = plan_->morph_in_steps(displacement_, steps, progress);
      if (!morphed) return tried;
    } catch (Error const& e) {
      // There is a result: a mesh on the way that cannot be planned on is no reason to lose it.
      tried.notes.push_back(fmt::format("in {} steps the motion cannot be planned: {}", steps, e.what()));
      continue;
    }
    best = std::exchange(result_, {std::move(*morphed), {}, {case_file_.output_options.displacement, {}, {}}});
    measure();
    if (newly_inverted(result_.quality) >= newly_inverted(best.quality))
      std::swap(result_, best);
    else
      best_steps = steps;
  }
  if (in_one == 0 || case_file_.guard.steps < 2) return tried;
  Index const left = newly_inverted(result_.quality);
  tried.text =
      best_steps == 1
          ? fmt::format("{} {} are inverted, and up to {} steps leave no fewer", in_one, cells, case_file_.guard.steps)
          : fmt::format("{} {} were inverted in one step; in {} steps, each planned on the mesh before it, {} {}",
                        in_one, cells, best_steps, left == 0 ? "none" : std::to_string(left), left <= 1 ? "is" : "are");
  return tried;
}

ValidShare Run::largest_valid_share() {
  QualityWanted wanted = wanted_;
  wanted.fast = true;
  Coordinates moved(mesh_->n_nodes());
  wanted.morphed = &moved;
  ValidShare out;
  for (int low = 0, high = 100; high - low > 1;) {
    int const percent = (low + high) / 2;
    console_.progress(fmt::format("looking for how much of the motion is valid: {} %", percent));
    plan_->morph(plan_->displacement(percent / 100.0), moved, nullptr);
    if (plan_->guards()) (void)plan_->relax(moved);
    QualityReport const quality = plan_->measure(wanted);
    if (newly_inverted(quality) == 0) {
      low = out.percent = percent;
    } else {
      high = percent;
      out.broken = describe_first_broken(plan_->for_messages(), quality, moved);
    }
  }
  return out;
}

std::vector<Shortfall> Run::shortfalls_of(QualityReport const& quality) const {
  return shortfalls(baseline_, quality, thresholds_of(case_file_));
}

std::vector<Shortfall> Run::shortfalls_of_motion() const {
  std::vector<Shortfall> out = mapping_warnings(case_file_);
  auto const trimmed = plan_->trimmed();
  out.insert(out.end(), trimmed.begin(), trimmed.end());
  return out;
}

std::vector<TipClearance> Run::clearances(Moment const* when) const {
  std::vector<TipClearance> out;
  if (case_file_.clearances.empty()) return out;
  Motion const motion = when == nullptr ? case_file_.motion : motion_at(case_file_, *when);
  if (!clearances_) clearances_.emplace(case_file_, mesh_->boundary());
  auto const by_rule = [&](int r, std::span<Index const> nodes, std::span<Vec3> u) {
    if (r < 0) return false;
    Rule const& rule = motion.rules[std::size_t(r)].rule;
    std::vector<Vec3> at;
    for (Index const n : nodes) at.push_back(mesh_->coordinates()[n]);
    if (auto const* function = std::get_if<FunctionRule>(&rule)) {
      function->function(at, u);
    } else if (auto const* rigid = std::get_if<RigidRule>(&rule)) {
      for (std::size_t n = 0; n < at.size(); ++n) u[n] = displacement(*rigid, at[n]);
    } else {
      return false;
    }
    return true;
  };
  for (std::size_t t = 0; t < clearances_->size(); ++t)
    out.push_back(clearances_->of(t, result_.morphed, [&](std::span<Index const> nodes, std::span<Vec3> u) {
      return by_rule(clearances_->rule_of_tip(t), nodes, u);
    }));
  return out;
}

nlohmann::json Run::json(QualityReport const& quality, PlanOutcome const& outcome) const {
  nlohmann::json json = quality_json(baseline_, quality, thresholds_of(case_file_));
  auto& list = json["shortfalls"];
  auto const of_motion = shortfalls_json(shortfalls_of_motion());
  list.insert(list.begin(), of_motion.begin(), of_motion.end());
  json["gridmorph"] = GRIDMORPH_VERSION;
  json["case_file"] = case_file_.source.string();
  json["input"] = case_file_.input.string();
  json["nodes"] = mesh_->n_nodes();
  json["times"] = times_json(times, mesh_->n_nodes());
  json["notes"] = notes;
  json["fields"] = nlohmann::json::array();
  for (auto const& use : case_file_.fields) {
    json["fields"].push_back(mapping_json(*use.field));
    json["fields"].back()["rule"] = use.where;
    if (use.inverse) json["fields"].back()["inverse"] = inverse_json(*use.inverse);
  }
  json.update(outcome.json);
  return json;
}

std::string Run::head() const {
  std::string text;
  for (auto const& note : notes) text += "note: " + note + "\n";
  for (auto const& s : shortfalls_of_motion())
    text += (s.severity == Shortfall::Severity::failure ? "falls short: " : "warning: ") + s.message + "\n";
  return text + plan_->headline();
}

std::string Run::tables(QualityReport const& quality, PlanOutcome const& outcome) const {
  std::string text = outcome.text + (outcome.text.empty() ? "" : "\n");
  text += format_table(baseline_, quality, thresholds_of(case_file_));
  if (!quality.fast) text += "\n" + format_short_table(baseline_, quality);
  return text + "\n" + format_times(times, mesh_->n_nodes());
}

std::string Run::refusal_of(std::filesystem::path const& output, std::string const& what,
                            std::string const& advice) const {
  return refusal(output.string(), what + " inverted that were not in the baseline",
                 diagnose(case_file_, plan_->for_messages(), result_.quality, result_.morphed), advice);
}

int conclude(Ending const& ending, Console& console) {
  auto const report = [&] {
    nlohmann::json json = ending.json();
    json["output"] = ending.written ? nlohmann::json(ending.output.string()) : nlohmann::json(nullptr);
    return json;
  };
  // The report waits beside its place until the mesh is there: both appear, or none. It has room to spare for the time
  // that writing the mesh takes.
  std::optional<PendingFile> pending, page;
  if (ending.report) pending.emplace(*ending.report, json_text(report()) + std::string(room_for_a_time, '\n'));
  if (ending.page) page.emplace(*ending.page, ending.page_text(report()) + std::string(room_for_a_time, '\n'));
  if (ending.written) console.progress("writing " + ending.output.string());
  ending.write();
  nlohmann::json const json = report();
  if (pending) {
    pending->replace(json_text(json));
    pending->commit();
  }
  if (page) {
    page->replace(ending.page_text(json));
    page->commit();
  }
  console.say(ending.text() + (ending.written ? ending.wrote : std::string()) + ending.also_wrote);
  console.document(json);
  for (auto const& warning : ending.warnings) console.warn(warning);
  if (!ending.written) console.error(ending.refusal());
  return status_of_morph(ending.written, ending.falls_short);
}

std::string wrote_report(std::optional<std::filesystem::path> const& report) {
  return report ? fmt::format("wrote {}\n", report->string()) : std::string();
}

std::vector<std::string> messages_of(std::vector<Shortfall> const& shortfalls) {
  std::vector<std::string> out;
  for (auto const& s : shortfalls) out.push_back(s.message);
  return out;
}

namespace {

/// Files that [output] stages writes, as far as they are known before there is a plan: which stages blocks have is not,
/// so of these what is there already, and what has the name of a stage among the other outputs.
RunFiles stage_files(std::filesystem::path const& folder, MeshKind kind, RunFiles const& others) {
  RunFiles out;
  auto const add = [&](std::filesystem::path const& path) { out.push_back({"stage", path, true}); };
  if (kind == MeshKind::unstructured) {
    for (char const* name : stage_names) add(folder / name);
    return out;
  }
  add(folder / stage_list_name);
  std::error_code error;
  for (auto const& entry : std::filesystem::directory_iterator(folder, error))
    if (is_stage_of_blocks(entry.path())) add(entry.path());
  std::size_t const n_there = out.size();
  for (RunFile const& other : others) {
    auto const at = folder / other.path.filename();
    bool const is_there = std::any_of(out.begin(), out.begin() + std::ptrdiff_t(n_there),
                                      [&](RunFile const& stage) { return stage.path == at; });
    if (!is_there && is_stage_of_blocks(at)) add(at);
  }
  return out;
}

bool is_dot(std::filesystem::path const& path) { return path.extension() == ".dot" || path.extension() == ".gv"; }

}  // namespace

int morph_once(CaseFile const& case_file, MeshSource const& file, Console& console, std::string const& typed) {
  auto const& options = case_file.output_options;
  RunFiles outputs = outputs_of(case_file.output, options.report);
  if (options.stages) {
    auto const stages = stage_files(*options.stages, file.kind, outputs);
    outputs.insert(outputs.end(), stages.begin(), stages.end());
  }
  if (options.page) outputs.push_back({"page", *options.page});
  if (options.vtk) outputs.push_back({"VTK file", *options.vtk});
  check_run_files(inputs_of(case_file, file), outputs);
  console.expect(file.traits().costs);
  std::optional<RunPage> page;
  if (options.page) page.emplace(case_file, typed);
  Run run(case_file, file, console);
  if (page) run.keep_measures();
  GuardReport const relaxed = run.morph(nullptr, &run.times);
  std::vector<std::string> guarded;
  if (relaxed.before > 0)
    guarded.push_back(fmt::format("{} {}; displacements around them are smoothed in {} rounds, {} are left",
                                  relaxed.before, run.mesh().kind().lost, relaxed.rounds, relaxed.after));
  if (relaxed.middles > 0)
    guarded.push_back(
        fmt::format("{} nodes between corners are pulled where they alone broke elements", relaxed.middles));
  console.progress("measuring quality");
  Stopwatch watch;
  run.measure_baseline();
  run.measure();
  run.times.push_back({"quality", watch.lap(), true});
  if (newly_inverted(run.quality()) > 0) {
    console.expect({});  // how many steps it will take is not known
    auto const tried = run.try_steps();
    guarded.insert(guarded.end(), tried.notes.begin(), tried.notes.end());
    if (!tried.text.empty()) {
      guarded.push_back(tried.text);
      run.times.push_back({"steps", watch.lap(), true});
    }
  }
  nlohmann::json retried;
  if (case_file.guard.retry && any_failure(run.shortfalls_of(run.quality()))) {
    console.expect({});
    watch.lap();
    Retried const retry = run.retry();
    retried = retry.json;
    if (!retry.text.empty()) guarded.push_back(retry.text);
    run.times.push_back({"retries", watch.lap(), true});
  }
  nlohmann::json frozen;
  if (case_file.guard.freeze) {
    watch.lap();
    FrozenIntoPlan freeze = run.freeze_into_plan();
    frozen = std::move(freeze.json);
    guarded.push_back(std::move(freeze.text));
    run.times.push_back({"freeze", watch.lap(), true});
  }
  run.notes = run.plan().notes();
  run.notes.insert(run.notes.end(), guarded.begin(), guarded.end());
  watch.lap();
  PlanOutcome const outcome = run.plan().outcome(run.morphed(), run.quality().fast, true);
  auto const clearances = run.clearances();
  run.notes.insert(run.notes.end(), outcome.notes.begin(), outcome.notes.end());
  add_time(run.times, "quality", watch.lap());

  bool const written = newly_inverted(run.quality()) == 0 || case_file.guard.write_inverted;
  std::string advice = "move the boundary less, " + file.traits().change;
  if (!written) {
    ValidShare const share = run.largest_valid_share();
    if (share.percent > 0)
      advice = fmt::format("morph what is valid with --fraction {:.2f}, ", share.percent / 100.0) + advice;
    std::string const valid =
        fmt::format("valid up to {} % of the motion, every cell of that certified", share.percent) +
        (share.broken.empty() ? "" : fmt::format("; at {} % {}", share.percent + 1, share.broken));
    run.notes.push_back(valid);
    advice = valid + ": " + advice;
  }
  auto shortfalls = run.shortfalls_of_motion();
  auto const of_quality = run.shortfalls_of(run.quality());
  shortfalls.insert(shortfalls.end(), of_quality.begin(), of_quality.end());
  if (page) {
    console.progress("drawing the page");
    watch.lap();
    page->begin(run);
    page->finish(run, run.quality());
    run.times.push_back({"page", watch.lap()});
  }
  if (written) run.times.push_back({"write", 0, true});
  std::string const vtk = options.vtk ? fmt::format("wrote {}\n", options.vtk->string()) : std::string();
  std::string stages;
  if (options.stages)
    stages = fmt::format("wrote {} to {}\n",
                         file.kind == MeshKind::structured ? "the mesh after every stage" : "wrap and background mesh",
                         options.stages->string());
  return conclude({.output = case_file.output,
                   .report = options.report,
                   .page = options.page,
                   .written = written,
                   .falls_short = any_failure(shortfalls),
                   .json =
                       [&] {
                         nlohmann::json json = run.json(run.quality(), outcome);
                         if (!clearances.empty()) json["clearances"] = clearance_json(clearances);
                         if (!retried.is_null()) json["retry"] = retried;
                         if (!frozen.is_null()) json["frozen_guard"] = frozen;
                         return json;
                       },
                   .page_text = [&](nlohmann::json const& report) { return page->text(report); },
                   .write =
                       [&] {
                         watch.lap();
                         if (written) {
                           run.mesh().write(case_file.input, case_file.output, run.morphed(),
                                            holds_fields(file.format) ? run.fields() : OutputFields());
                           if (options.vtk) run.mesh().write_vtk(*options.vtk, run.morphed(), run.fields());
                           add_time(run.times, "write", watch.lap());
                           if (page) page->add_output(case_file.output);
                           if (page) add_time(run.times, "page", watch.lap(), false);
                         }
                         if (options.stages) run.write_stages(*options.stages);
                       },
                   .text =
                       [&] {
                         // Notes of a plan without a headline go straight on to what follows.
                         return run.head() + (run.plan().headline().empty() ? "" : "\n") +
                                (clearances.empty() ? "" : clearance_table(clearances) + "\n") +
                                run.tables(run.quality(), outcome);
                       },
                   .wrote = fmt::format("\nwrote {}\n", case_file.output.string()) + vtk,
                   .also_wrote = wrote_report(options.report) + wrote_report(options.page) + stages,
                   .warnings = console.quiet() ? messages_of(shortfalls) : std::vector<std::string>(),
                   .refusal = [&] { return run.refusal_of(case_file.output, file.traits().cells + " are", advice); }},
                  console);
}

void print_plan(CaseFile const& case_file, Console& console, PlanPrinting const& options) {
  auto const& graph = options.graph;
  MeshSource const file =
      checked_mesh_file(case_file, case_file.sequence ? CaseUse::Run::sequence : CaseUse::Run::morph);
  if (graph) {
    if (file.kind == MeshKind::unstructured)
      throw ConfigError(case_file.input.string() + " is unstructured: there are no blocks to draw; leave out --graph");
    check_run_files(inputs_of(case_file, file), {{"drawing", *graph}});
  }
  if (file.kind == MeshKind::unstructured && case_file.plan.volume.order == OrderBy::prediction)
    throw ConfigError(case_file.input.string() +
                      " is unstructured: there are no chains to put in order; leave out --optimise");
  Run run(case_file, file, console);
  PlanPrediction const prediction = run.predict();
  for (auto const& warning : prediction.warnings) console.warn(warning);
  for (auto const& s : run.shortfalls_of_motion()) console.warn(s.message);
  nlohmann::json json = run.plan().json();
  if (!prediction.json.is_null()) json["prediction"] = prediction.json;
  json["gridmorph"] = GRIDMORPH_VERSION;
  json["case_file"] = case_file.source.string();
  json["input"] = case_file.input.string();
  json["nodes"] = run.mesh().n_nodes();
  json["notes"] = run.notes;
  json["times"] = times_json(run.times, run.mesh().n_nodes());
  if (graph) {
    PendingFile drawing(*graph, is_dot(*graph) ? dot_text(*run.plan().graph()) : svg_text(*run.plan().graph()));
    drawing.commit();
  }
  console.document(json);
  if (!console.json())
    console.result(run.plan().text(options.all) + (prediction.text.empty() ? "" : "\n") + prediction.text + "\n" +
                   format_times(run.times, run.mesh().n_nodes()) +
                   (graph ? fmt::format("wrote {}\n", graph->string()) : std::string()));
}

}  // namespace gridmorph::cli
