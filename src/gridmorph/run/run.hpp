// One case file from mesh file to morphed meshes, quality and report, for both kinds of mesh:
//
//   read -> rules, plan -> (boundary -> volume -> guard -> quality -> more steps where needed) per moment
//        -> files, report
#pragma once

#include <gridmorph/case/field_check.hpp>
#include <gridmorph/case/ignored_keys.hpp>
#include <gridmorph/quality/newly_inverted.hpp>
#include <gridmorph/report/shortfalls.hpp>
#include <gridmorph/run/case_plan.hpp>
#include <gridmorph/run/clearances.hpp>
#include <gridmorph/run/console.hpp>
#include <gridmorph/run/recipe.hpp>

#include <array>

namespace gridmorph::cli {

/// The mesh file of a case file, once no key of that is without effect on such a mesh and run; where elements may turn
/// out to be blocks, check_keys_of_kind() looks at the keys. Throws ConfigError.
MeshSource checked_mesh_file(CaseFile const& case_file, CaseUse::Run run);
/// The keys once more where blocks were looked for, now that the mesh is read; where they were not, and the mesh may
/// have some, a remark says why. Throws ConfigError.
void check_keys_of_kind(CaseFile const& case_file, MeshSource const& file, CaseUse::Run run, LoadedMesh& mesh);

/// [guard] as thresholds of the quality report.
QualityThresholds thresholds_of(CaseFile const& case_file);
/// Whether a verdict is all that is wanted of the quality of so many cells.
bool wants_verdict(CaseFile const& case_file, Index cells);
/// Adds to a step of that name, the last one where there is none.
void add_time(StepTimes& times, std::string const& step, double seconds, bool every_node = true);

/// Measures of cells for report pages: what histograms show and worst cells are chosen by.
inline constexpr std::array page_measures{Measure::determinant_3x3x3, Measure::minimum_angle_deg,
                                          Measure::aspect_ratio};

/// What came of morphing in steps.
struct TriedSteps {
  std::string text;  ///< how many cells were inverted in one step, and in how many are left; empty: not tried
  std::vector<std::string> notes;  ///< numbers of steps that could not be planned
};

/// How much of a motion leaves every cell valid.
struct ValidShare {
  int percent = 0;     ///< certified
  std::string broken;  ///< the first cell that is not at one per cent more, and where it is
};

/// A mesh with its plan, and what was made of it last.
class Run {
 public:
  /// Reads and plans. The case file must outlive the run.
  Run(CaseFile const& case_file, MeshSource const& file, Console& console);

  /// From here on measurements keep `page_measures` of every cell, of the baseline and of the result, unless a verdict
  /// is all that is wanted.
  void keep_measures() { keep_ = true; }
  /// Unless a verdict is all that is wanted.
  void measure_baseline();
  /// Morphs by the rules as they are at a moment, as they stand where there is none, and smooths around cells that came
  /// out bad. `times`: gets what it took.
  GuardReport morph(Moment const* when = nullptr, StepTimes* times = nullptr);
  /// Makes the meshes of these moments to see where any of them loses its shape: smoothing is then the same in all of
  /// them.
  void freeze_guard(std::vector<Moment> const& moments);
  /// Quality of the result, and fields on the way. verdict: that is all that is wanted.
  void measure(bool verdict = false);
  /// Where the result has cells inverted: the same motion in 2, 3, ... steps, up to [guard] steps, until none is; the
  /// best stays the result.
  TriedSteps try_steps();
  /// Whether other recipes are to be tried for the result. [guard] retry says so where it falls short; where that says
  /// nothing, blocks whose cells are inverted are made again unless they are to be written as they are, or the cause
  /// looks like one that no recipe mends: another unit, another axis.
  [[nodiscard]] bool wants_retry() const;
  /// The motion of the result, which is that of this moment, with other modes and turns of the near field, with the
  /// best of them other laws, of that the predicted order of chains, and of that what smoothing makes, until nothing
  /// falls short. What has the fewest inverted cells, then the fewest beyond a limit, then the largest smallest
  /// determinant stays the result, and its plan that of all moments. `moments`: of a sequence, all. Returns whether
  /// another recipe than the case file's was kept. Cost: a plan, a morph and a measurement each, up to ten of them, and
  /// one smoothing; room for two plans and results.
  bool retry(Moment const* when, Guarded& guarded, std::vector<Moment> const& moments = {});
  /// Makes what the guard did to the result, or does at these moments (at most SmoothingRecord::most of them, evenly
  /// spaced), a linear part of the plan; the result then is what that gives. Cost: a morph and a guard per moment.
  void freeze_into_plan(Guarded& guarded, std::vector<Moment> const& moments = {});
  /// The largest whole percentage of the motion, every rule at that share of its amplitude, at which the certificate
  /// holds, found by halving: at most seven morphs. The result stays as it is.
  ValidShare largest_valid_share();

  [[nodiscard]] LoadedMesh const& mesh() const { return *mesh_; }
  [[nodiscard]] CasePlan const& plan() const { return *plan_; }
  [[nodiscard]] Coordinates const& morphed() const { return result_.morphed; }
  /// [output] stages of the result.
  void write_stages(std::filesystem::path const& folder) const {
    plan_->write_stages(folder, displacement_, result_.morphed);
  }
  [[nodiscard]] OutputFields const& fields() const { return result_.fields; }
  [[nodiscard]] QualityReport const& quality() const { return result_.quality; }
  /// One of `page_measures` in every cell of the baseline and of the result; null where it was not kept.
  struct KeptMeasure {
    std::vector<double> const *before = nullptr, *after = nullptr;
  };
  [[nodiscard]] KeptMeasure kept(Measure measure) const;

  /// [[clearance]] of the result, of a moment of a sequence where one is given. Throws MotionError for walls without an
  /// area.
  [[nodiscard]] std::vector<TipClearance> clearances(Moment const* when = nullptr) const;

  /// What the motion would make of cells.
  PlanPrediction predict();

  /// The shortfalls of this quality against the baseline.
  [[nodiscard]] std::vector<Shortfall> shortfalls_of(QualityReport const& quality) const;
  /// Those of the motion, whatever became of cells: models that lie far from their nodes, displacements that slip
  /// surfaces undo. Throws MotionError where models lie elsewhere.
  [[nodiscard]] std::vector<Shortfall> shortfalls_of_motion() const;
  /// What came out, of this quality.
  [[nodiscard]] RunDocument document(QualityReport const& quality, Guarded const& guarded) const;
  /// Why the result is not written. `what` is inverted, `advice`: what to do.
  [[nodiscard]] std::string refusal_of(std::filesystem::path const& output, std::string const& what,
                                       std::string const& advice) const;

  StepTimes times;

 private:
  /// What other recipes are tried for.
  [[nodiscard]] bool falls_short(QualityReport const& quality) const;

  struct Result {
    Coordinates morphed;
    QualityReport quality;
    OutputFields fields;
    std::vector<CellField> measures = {};  ///< kept ones, where they are not among the fields
  };

  CaseFile const& case_file_;
  Console& console_;
  std::unique_ptr<LoadedMesh> mesh_;
  std::unique_ptr<CaseFile> recipe_;  ///< that the plan refers to, where it is not the case file
  std::unique_ptr<CasePlan> plan_;
  QualityWanted wanted_;
  bool keep_ = false;
  std::vector<CellField> baseline_measures_;
  QualityReport baseline_;  ///< without cells where only a verdict was asked for
  std::vector<Vec3> displacement_;
  mutable std::optional<Clearances> clearances_;  ///< once they are asked for
  Result result_;
};

/// `gridmorph morph`: one mesh. Writes it and the report, prints the tables. Throws ConfigError before any work when an
/// output cannot be written where it should. typed: the command line, for the page.
int morph_once(CaseFile const& case_file, MeshSource const& file, Console& console, std::string const& typed = {});
/// The same for every step of [sequence] from one plan: a table of the steps, the quality of the worst. Nothing is
/// written when a step has cells inverted that were not in the baseline, unless the case file says so.
int morph_sequence(CaseFile const& case_file, MeshSource const& file, Console& console, std::string const& typed = {});

struct PlanPrinting {
  std::optional<std::filesystem::path>
      graph{};       ///< a drawing of blocks and chains goes there (SVG, or DOT of Graphviz)
  bool all = false;  ///< every chain, however many there are
};
/// `gridmorph plan`: the plan of a case file, notes first.
void print_plan(CaseFile const& case_file, Console& console, PlanPrinting const& options = {});

}  // namespace gridmorph::cli
