// The steps between a structured mesh with motion rules and morphed coordinates.
#include <gridmorph/app/block_mesh.hpp>
#include <gridmorph/app/block_stages.hpp>
#include <gridmorph/app/shocks.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/guard/shape_smoothing.hpp>
#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/morph/best_order.hpp>
#include <gridmorph/morph/predictor.hpp>
#include <gridmorph/motion/wake/wake_regions.hpp>
#include <gridmorph/plan/common_parts.hpp>
#include <gridmorph/plan/prepare.hpp>
#include <gridmorph/plan/trim_note.hpp>
#include <gridmorph/report/prediction_text.hpp>
#include <gridmorph/report/target_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace gridmorph::cli {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

/// Those that rules move, and those that are measured alone. mesh: with the patches of the former; notes: gets what
/// there is to say of the latter.
MeasuredRegions measured_regions(Mesh mesh, std::vector<InnerRegion> const& measured, std::vector<std::string>& notes) {
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

class BlockPlan final : public AnyPlan {
 public:
  BlockPlan(BlockMesh const& mesh, CaseFile const& case_file)
      : shocks_(locate_shocks(case_file, mesh.mesh())),
        case_file_(shocks_.case_file),
        file_mesh_(mesh),
        prepared_(prepare(mesh.mesh(), case_file_.motion, case_file_.plan)),
        mesh_(prepared_.mesh),
        near_(near_cells_of(prepared_.mesh, prepared_.plan(), case_file_)),
        regions_(measured_regions(prepared_.mesh,
                                  locate_wakes(prepared_.surface.shared_boundary(), prepared_.surface.motion(),
                                               case_file_.measured_regions, region_notes_),
                                  region_notes_)) {
    split_common();
    VolumeOptions const& volume = case_file_.plan.volume;
    if (volume.by_prediction() || volume.are_automatic()) order_by_prediction();
  }

  std::vector<Vec3> displacement(Moment const* when) override {
    evaluated_ = true;
    if (when == nullptr) {
      auto out = prepared_.boundary_displacement();
      take_trims(trims(prepared_.mesh, prepared_.plan(), prepared_.planned.boundary, prepared_.surface, out),
                 case_file_.guard.max_trim);
      return out;
    }
    BoundaryMotion const now = prepared_.surface.with(motion_at(case_file_, *when));
    auto out = evaluate(prepared_.mesh, prepared_.planned.boundary, now, prepared_.plan().rotations);
    take_trims(trims(prepared_.mesh, prepared_.plan(), prepared_.planned.boundary, now, out),
               case_file_.guard.max_trim);
    return out;
  }

  std::vector<Vec3> displacement(double share) const override {
    return evaluate(prepared_.mesh, prepared_.planned.boundary, prepared_.surface.with(fraction_of(case_file_, share)),
                    prepared_.plan().rotations);
  }

  void morph(std::vector<Vec3> const& displacement, Coordinates& morphed, StepTimes* times) override {
    Stopwatch watch;
    // Made once: tables, workspace and line parameters serve every displacement.
    if (!morpher_)
      morpher_.emplace(exec_, prepared_.plan(), mesh_.coordinates(), MorpherOptions{.smoothing = frozen_map()});
    apply_on_host(*morpher_, displacement, morphed);
    if (times != nullptr) times->push_back({"morph", watch.lap(), true});
  }

  [[nodiscard]] PlanPrediction predict() override {
    auto const [some, step, boundary] = predict_worst(predicted_steps(case_file_));
    Prediction const worst = predict_closely(exec_, prepared_, boundary, some);
    PlanPrediction out{describe(prepared_.mesh, worst), prediction_warnings(prepared_.mesh, worst),
                       prediction_json(prepared_.mesh, worst)};
    if (!case_file_.sequence) return out;
    out.text = worst_step_text(case_file_, step) + out.text;
    out.json["step"] = step + 1;
    return out;
  }

  [[nodiscard]] bool guards() const override { return case_file_.guard.smooth && !frozen_map(); }
  [[nodiscard]] RelaxReport relax(Coordinates& morphed) const override {
    ShapeSmoothingReport const report = frozen_ ? smooth_frozen(exec_, prepared_, mesh_.handedness(), morphed, *frozen_)
                                                : smooth_shapes(exec_, prepared_, mesh_.handedness(), morphed);
    return {report.triggered_before, report.triggered_after, report.rounds, report.inverted_before,
            report.inverted_after};
  }

  void freeze(Coordinates const& morphed) override {
    FrozenSmoothing const lost = lost_shapes(exec_, prepared_, mesh_.handedness(), morphed);
    if (!frozen_) frozen_.emplace();
    frozen_->join(lost);
  }

  [[nodiscard]] QualityReport measure(QualityWanted wanted) const override {
    wanted.near = near_;
    wanted.regions = regions_;
    return mesh_.measure(wanted);
  }

  [[nodiscard]] PlanOutcome outcome(Coordinates const& morphed, bool verdict, bool at_once) const override {
    PlanOutcome out;
    auto const targets = at_once ? prepared_.surface.target_reach(morphed) : std::vector<TargetReach>();
    for (auto const& target : targets) out.notes.push_back(describe_reach(prepared_.mesh, target));
    out.json["targets"] = targets_json(prepared_.mesh, targets);
    out.json["stages"] = nlohmann::json::array();
    if (verdict) return out;
    for (auto const& stage : prepared_.plan().stages) {
      CellValue const worst = min_determinant(exec_, mesh_.mesh(), views(morphed), mesh_.handedness(), stage.cells);
      nlohmann::json json{{"name", stage.name}, {"min_determinant", nullptr}};
      if (worst.zone >= 0) {
        auto const& zone = mesh_.mesh().zones[std::size_t(worst.zone)].name;
        json["min_determinant"] = {{"value", worst.value},
                                   {"zone", zone},
                                   {"cell", {worst.cell[0] + 1, worst.cell[1] + 1, worst.cell[2] + 1}}};
        out.text += fmt::format("stage {}: smallest determinant {:.4g}, {}\n", stage.name, worst.value,
                                describe_cell(zone, worst.cell));
      }
      out.json["stages"].push_back(std::move(json));
    }
    return out;
  }

  void write_stages(std::filesystem::path const& folder, std::vector<Vec3> const& displacement,
                    Coordinates const& morphed) const override {
    write_block_stages(folder, file_mesh_.mesh(), prepared_.plan(), displacement, morphed);
  }

  [[nodiscard]] std::optional<BlockGraph> graph() const override { return block_graph(prepared_); }

  [[nodiscard]] std::vector<std::string> notes() const override {
    std::vector<std::string> out = prepared_.mesh.notes;
    auto const append = [&](auto const& more) { out.insert(out.end(), more.begin(), more.end()); };
    append(shocks_.notes);
    append(region_notes_);
    append(prepared_.surface.motion().notes);
    append(prepared_.surface.notes());
    append(prepared_.plan().notes);
    append(trim_notes());
    if (frozen_ && !frozen_->cells.empty())
      out.push_back(
          fmt::format("{} cells lose their shape in some of the steps; nodes around them are smoothed in all "
                      "of the steps alike",
                      frozen_->cells.size()));
    if (evaluated_) append(mapping_notes(case_file_));
    return out;
  }
  [[nodiscard]] StepTimes times() const override {
    auto const& seconds = prepared_.seconds;
    StepTimes out{{"topology", seconds.topology}, {"rules", seconds.rules}, {"plan", seconds.plan}};
    if (predicting_ > 0) out.push_back({"prediction", predicting_});
    if (ordering_ > 0) out.push_back({"order", ordering_});
    return out;
  }

  [[nodiscard]] std::string text(bool all) const override {
    std::string text;
    for (auto const& note : notes()) text += "note: " + note + "\n";
    if (!text.empty()) text += "\n";
    std::size_t chains = 0;
    for (Stage const& stage : prepared_.plan().stages) chains += stage.lines.chains.size();
    constexpr std::size_t readable = 60, of_stage = 6;
    if (all || chains <= readable) return text + describe(prepared_.plan());
    return text + overview(prepared_.plan()) + "\n" + describe(prepared_.plan(), of_stage) +
           "(all chains: gridmorph plan --all)\n";
  }

  /// Name of each stage, one line per chain, how many cells it morphs; finalize passes at the end.
  [[nodiscard]] nlohmann::json json() const override {
    nlohmann::json list = nlohmann::json::array();
    for (auto const& stage : prepared_.plan().stages) {
      Index cells = 0;
      for (CellBox const& box : stage.cells) {
        Index inside = 1;
        for (int a = 0; a < 3; ++a) inside *= box.cells.extent(a);
        cells += inside;
      }
      list.push_back({{"name", stage.name}, {"chains", stage.description}, {"cells", cells}});
    }
    for (auto const& pass : prepared_.plan().spreads)
      list.push_back({{"name", "slip surfaces"}, {"chains", pass.description}, {"cells", 0}});
    return {{"stages", std::move(list)}};
  }

  [[nodiscard]] MeshForMessages for_messages() const override { return cli::for_messages(prepared_.mesh); }
  [[nodiscard]] BoundaryMotion const& rules() const override { return prepared_.surface; }
  [[nodiscard]] NearCells const& near() const override { return near_; }

 private:
  [[nodiscard]] SmoothingRecord new_record() const override { return SmoothingRecord(prepared_); }
  void drop_morpher() override { morpher_.reset(); }

  struct StepPrediction {
    Prediction prediction;
    int step = 0;
    std::vector<Vec3> boundary;
  };

  /// Of a sequence the displacements are still to come.
  void split_common() {
    split_common_motions(prepared_, [&]() -> std::optional<std::vector<Vec3>> {
      if (case_file_.sequence) return {};
      try {
        return prepared_.boundary_displacement();
      } catch (MotionError const&) {
        return {};  // that the motion cannot be made is said where it is made
      }
    });
  }

  /// Asked for: the order of chains predicted to be best. Left to us: another one where that by priority inverts cells.
  void order_by_prediction() {
    Stopwatch watch;
    bool const asked_for = case_file_.plan.volume.by_prediction();
    constexpr int enough = 8;  // to see whether any is needed
    StepPrediction worst;
    try {
      worst = predict_worst(asked_for ? predicted_steps(case_file_) : predicted_steps(case_file_, enough));
    } catch (MotionError const&) {
      if (asked_for) throw;
      return;  // the plan stands; that the motion cannot be made is said where it is made
    }
    bool const wanted = asked_for || is_inverted_by_priority(exec_, prepared_, worst.boundary, worst.prediction);
    if (!asked_for) predicting_ = watch.lap();
    if (!wanted) return;
    plan_by_prediction(exec_, prepared_, worst.boundary);
    ordering_ = watch.lap();
  }

  /// Of the motion as the rules stand, or of that of these steps of a sequence that comes out worst.
  StepPrediction predict_worst(std::vector<int> const& steps) {
    Predictor predictor(exec_, prepared_, {});
    StepPrediction worst;
    for (int const step : steps) {
      Moment const when = case_file_.sequence ? case_file_.sequence->moment(step) : Moment{};
      StepPrediction now{{}, step, displacement(case_file_.sequence ? &when : nullptr)};
      now.prediction = predictor.predict(now.boundary);
      if (worst.boundary.empty() ||
          now.prediction.all.scaled_jacobian.value < worst.prediction.all.scaled_jacobian.value)
        worst = std::move(now);
    }
    return worst;
  }

  LocatedShocks shocks_;
  CaseFile const& case_file_;
  BlockMesh const& file_mesh_;
  Exec exec_;
  PreparedMorph prepared_;
  BlockMesh mesh_;  ///< with the patches that planning added
  NearCells near_;
  std::vector<std::string> region_notes_;
  MeasuredRegions regions_;
  std::optional<Morpher<Exec>> morpher_;
  std::optional<FrozenSmoothing> frozen_;
  bool evaluated_ = false;
  double predicting_ = 0;  ///< seconds that it took to see whether cells come out inverted
  double ordering_ = 0;    ///< seconds that the order of chains took to be found
};

}  // namespace

NearCells near_cells_of(Mesh const& mesh, Plan const& plan, CaseFile const& case_file) {
  Kokkos::View<std::uint8_t*, Kokkos::HostSpace> const mask("gridmorph::cli::near_field", std::size_t(mesh.n_cells()));
  std::vector<Index> const first = first_cells(mesh);
  for (auto const& box : plan.near_field) {
    Zone const& zone = mesh.zones[std::size_t(box.zone)];
    Index const ni = zone.extent[0] - 1, nj = zone.extent[1] - 1;
    for (int k = box.cells.begin[2]; k < box.cells.end[2]; ++k)
      for (int j = box.cells.begin[1]; j < box.cells.end[1]; ++j)
        for (int i = box.cells.begin[0]; i < box.cells.end[0]; ++i)
          mask(first[std::size_t(box.zone)] + i + ni * (j + nj * k)) = 1;
  }
  NearCells out{mask, {}};
  for (auto const& layer : case_file.plan.boundary_layers)
    if (!layer.walls.empty())
      for (int const p : select_patches(mesh, layer.walls)) out.walls.push_back(p);
  return out;
}

std::unique_ptr<AnyPlan> BlockMesh::plan(CaseFile const& case_file) const {
  try {
    return std::make_unique<BlockPlan>(*this, case_file);
  } catch (MotionError const& e) {  // rules about an axis fail in many ways when it is not the machine's
    auto const cause = axis_mismatch(mesh_, case_file.motion.axis);
    if (!cause) throw;
    throw MotionError(fmt::format("{}\n  likely cause: {}", e.what(), *cause));
  }
}

}  // namespace gridmorph::cli
