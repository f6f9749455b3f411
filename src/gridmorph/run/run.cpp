#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/io/file_kind.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/plan/smoothing_map.hpp>
#include <gridmorph/report/block_graph_text.hpp>
#include <gridmorph/report/json_text.hpp>
#include <gridmorph/report/smoothing_text.hpp>
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
  file.find_blocks = file.kind == MeshKind::unstructured && why_elements(case_file).empty();
  if (!file.find_blocks) refuse_ignored_keys(case_file, {file.kind == MeshKind::unstructured, run, file.format});
  return file;
}

void check_keys_of_kind(CaseFile const& case_file, MeshSource const& file, CaseUse::Run run, LoadedMesh& mesh) {
  if (file.find_blocks)
    refuse_ignored_keys(case_file, {.unstructured = !mesh.is_structured(),
                                    .run = run,
                                    .format = file.format,
                                    .found_blocks = mesh.is_structured()});
  else if (!case_file.find_blocks && may_have_blocks(mesh.mesh()))
    mesh.remark(fmt::format(
        "no blocks were looked for among the hexahedra, since {}; blocks = \"find\" in [mesh] looks for them",
        why_elements(case_file)));
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
  mesh_ = std::make_unique<LoadedMesh>(file.path, case_file.side_file, file.leave_out, file.find_blocks);
  check_keys_of_kind(case_file, file, case_file.sequence ? CaseUse::Run::sequence : CaseUse::Run::morph, *mesh_);
  times.push_back({"read", watch.lap(), true});
  console.progress(mesh_->kind().planning);
  check_fields(case_file, mesh_->mesh());
  plan_ = std::make_unique<CasePlan>(*mesh_, case_file);
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

void Run::freeze_into_plan(Guarded& guarded, std::vector<Moment> const& moments) {
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
  guarded.notes.push_back(describe(map));
  guarded.json["frozen_guard"] = frozen_guard_json(map);
}

void Run::measure(bool verdict) {
  QualityWanted wanted = wanted_;
  wanted.fast = wanted.fast || verdict;
  wanted.morphed = &result_.morphed;
  if (case_file_.output_options.quality) {
    wanted.fields = &result_.fields.cells;
  } else if (keep_ && !wanted.fast) {
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
    Rule const& rule = motion.rules[r].rule;
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

RunDocument Run::document(QualityReport const& quality, Guarded const& guarded) const {
  RunDocument out = document_of(case_file_);
  out.nodes = mesh_->n_nodes();
  out.times = times;
  out.notes = plan_->notes();
  out.notes.insert(out.notes.end(), guarded.notes.begin(), guarded.notes.end());
  out.guarded = guarded.json;
  out.baseline = baseline_;
  out.mesh = {quality, shortfalls_of_motion(), plan_->outcome(result_.morphed, quality.fast)};
  auto const& targets = out.mesh->plan.notes;
  out.notes.insert(out.notes.end(), targets.begin(), targets.end());
  return out;
}

std::string Run::refusal_of(std::filesystem::path const& output, std::string const& what,
                            std::string const& advice) const {
  return refusal(output.string(), what + " inverted that were not in the baseline",
                 diagnose(case_file_, plan_->for_messages(), result_.quality, result_.morphed), advice);
}

}  // namespace gridmorph::cli
