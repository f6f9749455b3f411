// The steps between a mesh with the motion of a case file and morphed coordinates.
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/guard/guard.hpp>
#include <gridmorph/mapping/mapping_report.hpp>
#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/morph/best_order.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/morph/predictor.hpp>
#include <gridmorph/motion/wake/wake_regions.hpp>
#include <gridmorph/plan/planned_elements.hpp>
#include <gridmorph/report/prediction_text.hpp>
#include <gridmorph/report/target_text.hpp>
#include <gridmorph/run/block_stages.hpp>
#include <gridmorph/run/case_plan.hpp>
#include <gridmorph/run/element_stages.hpp>
#include <gridmorph/run/plan_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace gridmorph::cli {

namespace {

MorphPlan planned(LoadedMesh const& mesh, CaseFile const& case_file, PlanOptions const& options) {
  MotionSeries series;
  if (case_file.sequence) {
    series.steps = case_file.sequence->steps;
    series.motion = [&](int step) { return motion_at(case_file, case_file.sequence->moment(step)); };
  }
  try {
    return {HostInstance(), mesh.indexed(), case_file.motion, options, series};
  } catch (MotionError const& e) {  // rules about an axis fail in many ways when it is not the machine's
    if (!mesh.is_structured()) throw;
    auto const cause = axis_mismatch(mesh.mesh(), case_file.motion.axis);
    if (!cause) throw;
    throw MotionError(fmt::format("{}\n  likely cause: {}", e.what(), *cause));
  }
}

/// Regions of blocks that rules move, and those that are measured alone. mesh: with the patches of the former; notes:
/// gets what there is to say of the latter.
MeasuredRegions regions_of_blocks(Mesh mesh, std::vector<InnerRegion> const& measured,
                                  std::vector<std::string>& notes) {
  std::size_t const n_notes = mesh.notes.size();
  add_regions(mesh, measured);
  notes.insert(notes.end(), mesh.notes.begin() + std::ptrdiff_t(n_notes), mesh.notes.end());
  MeasuredRegions out;
  for (Patch const& patch : mesh.patches) {
    if (!is_box(patch)) continue;
    auto at = std::find_if(out.cells.begin(), out.cells.end(), [&](auto const& r) { return r.name == patch.name; });
    if (at == out.cells.end()) at = out.cells.insert(at, {patch.name, {}});
    at->boxes.push_back({patch.zone, patch.range});
    for (int& end : at->boxes.back().cells.end) --end;
  }
  return out;
}

void add_region_of_elements(Mesh const& mesh, InnerRegion const& region, MeasuredRegions& out) {
  auto const in = elements_of_region(mesh, region);
  if (std::none_of(in.begin(), in.end(), [](std::uint8_t n) { return n != 0; })) return;
  Kokkos::View<std::uint8_t*, Kokkos::HostSpace> const mask("gridmorph::cli::region", in.size());
  std::copy(in.begin(), in.end(), mask.data());
  out.elements.push_back({region.name, mask});
}

/// "step 7 of 24 comes out worst: "
std::string worst_step_text(SequenceOptions const& options, int step) {
  int const steps = options.steps;
  auto const looked_at = int(some_steps(steps, most_predicted).size());
  std::string const which = fmt::format("{} {}", options.step_word(), step + 1);
  return looked_at == steps
             ? fmt::format("{} of {} comes out worst: ", which, steps)
             : fmt::format("{} comes out worst of the {} that are looked at of {}: ", which, looked_at, steps);
}

}  // namespace

PlanOptions with_background(CaseFile const& case_file, Mesh const& mesh) {
  PlanOptions options = case_file.plan;
  if (auto const& own = case_file.background; own && !mesh.is_structured())
    options.elements.background =
        std::make_shared<Background const>(make_background(read_mesh(own->path.string()), own->wrap, own->outer));
  return options;
}

CasePlan::CasePlan(LoadedMesh const& mesh, CaseFile const& case_file)
    : mesh_(mesh),
      shocks_(locate_shocks(case_file, mesh.mesh())),
      case_file_(shocks_.case_file),
      options_(with_background(case_file_, mesh.mesh())),
      plan_(planned(mesh, case_file_, options_)),
      near_(plan_.near_cells()) {
  auto const& boundary = rules().shared_boundary();
  if (mesh_.is_structured()) {
    regions_ = regions_of_blocks(
        patched(), locate_wakes(boundary, rules().motion(), case_file_.measured_regions, region_notes_), region_notes_);
    return;
  }
  std::vector<std::string> notes;  // those of the rules come again
  for (auto const* regions : {&case_file_.motion.regions, &case_file_.measured_regions})
    for (InnerRegion const& region : locate_wakes(boundary, rules().motion(), *regions, notes))
      add_region_of_elements(mesh_.mesh(), region, regions_);
}

Mesh const& CasePlan::patched() const {
  Mesh const* const patched = PlanAccess::patched_mesh(plan_);
  return patched != nullptr ? *patched : mesh_.mesh();
}

std::vector<Vec3> CasePlan::displacement(Moment const* when) {
  evaluated_ = true;
  if (when == nullptr) {
    auto const& out = plan_.boundary_displacement();
    take_trims(plan_.trims(out));
    return out;
  }
  Motion const now = motion_at(case_file_, *when);
  auto out = plan_.boundary_displacement(now);
  take_trims(plan_.trims(out));  // their words are those of the rules, whatever these displace by
  return out;
}

std::vector<Vec3> CasePlan::displacement(double share) const {
  return plan_.boundary_displacement(fraction_of(case_file_, share));
}

void CasePlan::take_trims(std::vector<Trim> const& trims) {
  refuse_undone(trims, case_file_.guard.max_trim);
  for (Trim const& trim : trims) {
    auto const known = std::find_if(trims_.begin(), trims_.end(),
                                    [&](Trim const& t) { return t.patch == trim.patch && t.rule == trim.rule; });
    if (known == trims_.end())
      trims_.push_back(trim);
    else if (trim.share() > known->share())
      *known = trim;
  }
}

std::vector<Shortfall> CasePlan::trimmed() const { return trimmed_beyond(case_file_.guard.max_trim, trims_); }

void CasePlan::morph(std::vector<Vec3> const& displacement, Coordinates& morphed, StepTimes* times) {
  Stopwatch watch;
  if (!morpher_) {
    morpher_.emplace(exec_, plan_, mesh_.coordinates());
    // Of blocks the line parameters, which are part of a morph that is made once.
    if (times != nullptr && !mesh_.is_structured()) times->push_back({"upload", watch.lap(), true});
  }
  apply_on_host(*morpher_, displacement, morphed);
  if (times != nullptr) times->push_back({"morph", watch.lap(), true});
}

GuardReport CasePlan::relax(Coordinates& morphed) const {
  if (!frozen_) return guard(exec_, mesh_.indexed(), plan_, morphed);
  return report_of(smooth_frozen(exec_, mesh_.indexed(), plan_, morphed, *frozen_));
}

void CasePlan::freeze(Coordinates const& morphed) {
  if (!mesh_.is_structured()) return;
  FrozenSmoothing const lost = lost_shapes(exec_, mesh_.indexed(), morphed);
  if (!frozen_) frozen_.emplace();
  frozen_->join(lost);
}

void CasePlan::record(std::vector<Vec3> const& displacement, Coordinates const& plain, Coordinates const& guarded) {
  if (!record_) record_.emplace(plan_);
  record_->add(displacement, plain, guarded);
}

SmoothingMap const& CasePlan::freeze_recorded() {
  plan_ = plan_.with(record_->map());
  record_.reset();
  morpher_.reset();
  return *plan_.smoothing();
}

std::optional<Coordinates> CasePlan::morph_in_steps(std::vector<Vec3> const& displacement, int steps,
                                                    std::function<void(int step)> const& progress) const {
  if (mesh_.is_structured() || options_.elements.background) return {};
  StepOptions options;
  options.steps = steps;
  options.plan = options_;
  options.progress = progress;
  return gridmorph::morph_in_steps(mesh_.indexed(), plan_, displacement, options);
}

QualityReport CasePlan::measure(QualityWanted wanted) const {
  wanted.near = near_;
  wanted.regions = regions_;
  return mesh_.measure(wanted, patched());
}

PlanOutcome CasePlan::outcome(Coordinates const& morphed, bool verdict) const {
  PlanOutcome out;
  auto const targets = case_file_.sequence ? std::vector<TargetReach>() : rules().target_reach(morphed);
  for (auto const& target : targets) out.notes.push_back(describe_reach(patched(), target));
  out.targets = targets_json(patched(), targets);
  out.headline = headline();
  if (!mesh_.is_structured())
    out.plan = json();
  else
    out.stages = verdict ? std::vector<StageOutcome>() : judge_stages(morphed);
  return out;
}

/// The smallest determinant of each stage of blocks.
std::vector<StageOutcome> CasePlan::judge_stages(Coordinates const& morphed) const {
  std::vector<StageOutcome> out;
  for (auto const& stage : PlanAccess::chains(plan_)->stages) {
    CellValue const worst =
        min_determinant(exec_, mesh_.mesh(), views(morphed), mesh_.indexed().handedness(), stage.cells);
    out.push_back({stage.name, worst, worst.zone < 0 ? "" : mesh_.mesh().zones[worst.zone].name});
  }
  return out;
}

void CasePlan::write_stages(std::filesystem::path const& folder, std::vector<Vec3> const& displacement,
                            Coordinates const& morphed) const {
  if (auto const elements = PlanAccess::planned_elements(plan_))
    write_element_stages(folder, mesh_.mesh(), *elements, *morpher_, morphed);
  else
    write_block_stages(folder, mesh_.mesh(), *PlanAccess::chains(plan_), displacement, morphed);
}

std::vector<std::string> CasePlan::notes() const {
  std::vector<std::string> out;
  auto const append = [&](std::vector<std::string> const& more) { out.insert(out.end(), more.begin(), more.end()); };
  if (!mesh_.is_structured()) append(mesh_.notes());
  append(shocks_.notes);
  append(region_notes_);
  append(plan_.notes());
  for (Trim const& trim : trims_)
    if (trim.share() <= case_file_.guard.max_trim) out.push_back(describe(trim));
  if (frozen_ && !frozen_->cells.empty())
    out.push_back(
        fmt::format("{0} cells lose their shape in some of the {1}s; nodes around them are smoothed in all "
                    "of the {1}s alike",
                    frozen_->cells.size(), case_file_.sequence ? case_file_.sequence->step_word() : "step"));
  if (evaluated_ || !mesh_.is_structured()) append(mapping_notes(case_file_));
  return out;
}

PlanPrediction CasePlan::predict() {
  std::vector<int> const steps =
      case_file_.sequence ? some_steps(case_file_.sequence->steps, most_predicted) : std::vector<int>{0};
  auto const displacement_at = [&](int step) {
    if (!case_file_.sequence) return displacement(nullptr);
    Moment const when = case_file_.sequence->moment(step);
    return displacement(&when);
  };
  WorstPrediction worst(predictions(exec_, mesh_.indexed(), plan_));
  for (int const step : steps) worst.look_at(step, displacement_at(step));
  Prediction const closely = predict_closely(exec_, plan_, worst.boundary(), worst.prediction());
  PlanPrediction out{describe(patched(), closely), prediction_warnings(patched(), closely),
                     prediction_json(patched(), closely)};
  if (!case_file_.sequence) return out;
  out.text = worst_step_text(*case_file_.sequence, worst.step()) + out.text;
  out.json["step"] = worst.step() + 1;
  return out;
}

StepTimes CasePlan::times() const {
  StepTimes out;
  for (PlanSeconds const& took : plan_.seconds()) out.push_back({took.part, took.seconds, !mesh_.is_structured()});
  return out;
}

std::string CasePlan::text(bool all) const {
  return mesh_.is_structured() ? block_plan_text(*PlanAccess::chains(plan_), all) : headline();
}

nlohmann::json CasePlan::json() const {
  if (auto const elements = PlanAccess::planned_elements(plan_)) return element_plan_json(*elements, mesh_.n_cells());
  return block_plan_json(*PlanAccess::chains(plan_));
}

std::optional<BlockGraph> CasePlan::graph() const { return PlanAccess::block_graph(plan_); }

std::string CasePlan::headline() const {
  auto const elements = PlanAccess::planned_elements(plan_);
  return elements ? element_plan_text(*elements) : std::string();
}

MeshForMessages CasePlan::for_messages() const {
  return mesh_.is_structured() ? cli::for_messages(patched()) : cli::for_messages(mesh_.mesh(), rules().boundary());
}

std::vector<Shortfall> trimmed_beyond(double allowed, std::vector<Trim> const& trims) {
  std::vector<Shortfall> out;
  for (Trim const& trim : trims)
    if (trim.share() > allowed) out.push_back({Shortfall::Severity::failure, describe(trim)});
  return out;
}

std::vector<Shortfall> mapping_warnings(CaseFile const& case_file) {
  std::vector<Shortfall> out;
  for (auto const& use : case_file.fields) {
    try {
      use.field->judge();
    } catch (MotionError const& e) {
      throw MotionError(use.where + ": " + e.what());
    }
    if (auto const text = far_from_model(*use.field); !text.empty() && !use.inverse)
      out.push_back({Shortfall::Severity::warning, use.where + ": " + text});
  }
  return out;
}

std::vector<std::string> mapping_notes(CaseFile const& case_file) {
  std::vector<std::string> notes = case_file.notes;
  for (auto const& use : case_file.fields) {
    notes.insert(notes.end(), use.field->notes().begin(), use.field->notes().end());
    notes.push_back(use.where + ": " + describe_mapping(*use.field));
    if (use.inverse) notes.push_back(use.where + ": " + describe_inverse(*use.inverse));
  }
  return notes;
}

}  // namespace gridmorph::cli
