// Morphs, measures and turns the passages of a wheel, one at a time, at one time or at several.
#pragma once

#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/run/clearances.hpp>
#include <gridmorph/run/console.hpp>
#include <gridmorph/run/recipe.hpp>
#include <gridmorph/run/wheel_passage.hpp>
#include <gridmorph/run/wheel_text.hpp>
#include <gridmorph/wheel/seams.hpp>
#include <gridmorph/wheel/shared_nodes.hpp>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// A wheel at one time.
struct WheelMade {
  MorphedWheel wheel = {};  ///< less its rows
  std::vector<std::string> notes = {};
  std::optional<Coordinates> worst = {};  ///< of the worst passage, where the sector is; where it was kept
};

/// Takes a zone of the wheel, in the order of its file.
using ZoneSink = std::function<void(int zone, double const* x, double const* y, double const* z)>;

class WheelRun {
 public:
  /// Reads the passage. The case file must outlive the run.
  WheelRun(CaseFile const& case_file, MeshSource const& file, Console& console);

  [[nodiscard]] WheelPassage const& sector() const { return sector_; }
  [[nodiscard]] WheelMesh const& wheel() const { return wheel_; }
  [[nodiscard]] WheelSetup const& setup() const { return setup_; }
  /// What went wrong in the first passage with inverted cells.
  [[nodiscard]] Diagnosis const& diagnosis() const { return worst_of_; }

  /// Plans once for all passages and times, measures the baseline, and tries other recipes and freezes the guard where
  /// the case file says so. Throws MotionError where blades in a wave do not come back after a period.
  void prepare();
  /// From here on make() keeps the mesh of the worst passage. Cost: a copy of it.
  void keep_worst() { keeps_worst_ = true; }
  [[nodiscard]] NearCells const& near() const { return quality_.near; }

  /// The wheel at a step, passage by passage.
  WheelMade make(int step, ZoneSink const& sink);
  /// The passages as they are in the baseline, each in its place and closed to its neighbours.
  void make_baseline(ZoneSink const& sink);
  /// What came out. `made`: the wheel that is told.
  [[nodiscard]] RunDocument document(WheelMade const& made) const;
  /// Adds the time since the last one to a step of that name.
  void time(std::string const& step);

 private:
  [[nodiscard]] std::unique_ptr<PassagePlan> plan_of(CaseFile const& case_file) const {
    return std::make_unique<PassagePlan>(sector_, case_file, setup_);
  }
  /// visit(boundary displacement) for every passage that differs from those before it, of every step. The plan goes to
  /// the step of plan_ in the end.
  template <class Visit>
  void for_each_passage(PassagePlan& plan, Visit const& visit);
  /// Where blocks are smoothed over time: what is smoothed is then the same in all passages and steps.
  void find_lost_shapes(PassagePlan& plan);
  void retry();
  /// What the guard does to passages becomes a part of the plan.
  void freeze();
  void check_wave() const;
  void move_to(int step);
  GuardReport morph(PassagePlan& plan, std::vector<Vec3> const& boundary, Coordinates& morphed);
  PassageResult measure(std::vector<Vec3> const& boundary, Coordinates const& morphed);
  void keep(std::optional<Coordinates>& worst, Coordinates const& morphed) const;
  [[nodiscard]] std::vector<Seams> new_seams() const;
  /// Puts a passage where it stands; `next`: its first zone of the wheel. Returns its zones of the wheel by those of
  /// the sector.
  std::map<int, int> place(int passage, int next, Coordinates const& morphed, std::vector<Seams>& seams, double& gap);
  void give(std::map<int, int> const& zones, ZoneSink const& sink) const;
  void certify_zones(std::map<int, int> const& zones, Certificate& wheel);
  [[nodiscard]] std::vector<std::string> blades_of(int passage) const;
  [[nodiscard]] std::vector<TipClearance> clearances_of(int passage, Coordinates const& morphed) const;

  CaseFile const& case_;
  Console& console_;
  Stopwatch watch_;
  Kokkos::DefaultHostExecutionSpace exec_;
  StepTimes times_;
  std::vector<std::string> notes_;
  QualityReport baseline_;
  Guarded guarded_;
  Diagnosis worst_of_;
  WheelPassage sector_;
  Mesh const& mesh_;             ///< that is morphed
  LinkedSector const& in_file_;  ///< that is turned and written
  WheelSetup setup_;
  WheelMesh wheel_;
  SharedNodes shared_;
  std::optional<Clearances> clearances_;  ///< where the case file asks for them
  QualityWanted quality_;
  std::unique_ptr<CaseFile> recipe_;  ///< that the plan refers to, where it is not the case file
  std::unique_ptr<PassagePlan> plan_;
  int step_ = 0;         ///< that the plan's passages are of
  Coordinates morphed_;  ///< of mesh_
  Coordinates placed_;   ///< of in_file_
  bool keeps_worst_ = false;
};

/// Whether cells are inverted that the baseline has sound.
bool any_inverted(WheelMade const& made);

/// Why a wheel is not written.
std::string wheel_refusal(WheelRun const& run, std::filesystem::path const& output, std::string const& what);

/// `gridmorph wheel` at one time: output of [wheel], report and page as [output] says. typed: the command line, for the
/// page. Returns the exit status. Throws ConfigError before any work when an output cannot be written where it should.
int wheel_once(CaseFile const& case_file, MeshSource const& file, Console& console, std::string const& typed = {});
/// The same at every step of [sequence], into one file per step or one with a series.
int wheel_sequence(CaseFile const& case_file, MeshSource const& file, Console& console, std::string const& typed = {});

}  // namespace gridmorph::cli
