// A mesh that is planned for the motion of a case file: MorphPlan with the moments of a sequence, what is measured, and
// the words of a report.
#pragma once

#include <gridmorph/guard/guard.hpp>
#include <gridmorph/guard/shape_smoothing.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/plan/block_graph.hpp>
#include <gridmorph/plan/trim_note.hpp>
#include <gridmorph/run/diagnosis.hpp>
#include <gridmorph/run/loaded_mesh.hpp>
#include <gridmorph/run/run_document.hpp>
#include <gridmorph/run/shocks.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// Boundary displacements are in the order of MorphPlan::boundary_nodes().
class CasePlan {
 public:
  /// Connects, checks, resolves rules, plans; reads solutions with shocks and a background mesh where the case file
  /// names them. Mesh and case file must outlive the plan. Throws MeshError, MotionError, PlanError.
  CasePlan(LoadedMesh const& mesh, CaseFile const& case_file);

  /// Displacement of the boundary by the rules as they are at a moment; null: as they stand. Throws MotionError.
  [[nodiscard]] std::vector<Vec3> displacement(Moment const* when);
  /// The same for rules at a share of their amplitude (fraction_of()).
  [[nodiscard]] std::vector<Vec3> displacement(double share) const;
  /// Moves the mesh from its baseline. `times`: gets what this took, where it is wanted.
  void morph(std::vector<Vec3> const& displacement, Coordinates& morphed, StepTimes* times);
  /// Whether relax() does anything.
  [[nodiscard]] bool guards() const {
    return !plan_.smoothing() && (!mesh_.is_structured() || case_file_.guard.smooth);
  }
  /// Smooths around cells that came out bad: guard(), after freeze() smooth_frozen().
  [[nodiscard]] GuardReport relax(Coordinates& morphed) const;
  /// Remembers where a mesh of a sequence of blocks lost its shape: relax() then does the same to all of them, so that
  /// they do not jump.
  void freeze(Coordinates const& morphed);
  /// Remembers what became of a displacement that morph() brings to `plain`.
  void record(std::vector<Vec3> const& displacement, Coordinates const& plain, Coordinates const& guarded);
  /// From here on morph() does what was recorded, linear in the displacement (SmoothingRecord), and relax() nothing.
  SmoothingMap const& freeze_recorded();
  /// The same motion of elements in several steps, each planned on the mesh before it; nothing where this plan has but
  /// one.
  [[nodiscard]] std::optional<Coordinates> morph_in_steps(std::vector<Vec3> const& displacement, int steps,
                                                          std::function<void(int step)> const& progress) const;

  /// Quality with the near field and the walls of this plan in `wanted`.
  [[nodiscard]] QualityReport measure(QualityWanted wanted) const;
  /// `verdict`: that is all that is wanted. Targets are those of a motion as the rules stand, no step of a sequence.
  [[nodiscard]] PlanOutcome outcome(Coordinates const& morphed, bool verdict) const;
  /// What a mesh goes through on its way, as meshes in a folder, which is made where it is missing. `displacement`: of
  /// the boundary, that came to `morphed`.
  void write_stages(std::filesystem::path const& folder, std::vector<Vec3> const& displacement,
                    Coordinates const& morphed) const;

  /// Defaults taken, facts found on the way, up to now.
  [[nodiscard]] std::vector<std::string> notes() const;
  /// The prediction of the motion as the rules stand; of a sequence, at the step that comes out worst.
  [[nodiscard]] PlanPrediction predict();
  /// Displacements that the rules gave so far and slip surfaces undo, in part or for the most part. Those of which most
  /// is undone throw.
  [[nodiscard]] std::vector<Shortfall> trimmed() const;
  /// The times of planning.
  [[nodiscard]] StepTimes times() const;
  /// For `gridmorph plan`, without notes.
  [[nodiscard]] std::string text(bool all) const;
  [[nodiscard]] nlohmann::json json() const;
  /// The blocks and chains, for drawings; nothing of elements.
  [[nodiscard]] std::optional<BlockGraph> graph() const;
  /// A line or two above the results of a morph of elements; empty of blocks.
  [[nodiscard]] std::string headline() const;
  [[nodiscard]] MeshForMessages for_messages() const;
  [[nodiscard]] MorphPlan const& morph_plan() const { return plan_; }
  /// The rules on the boundary; numbers of nodes and of the patches of the file are those of the mesh.
  [[nodiscard]] BoundaryMotion const& rules() const { return plan_.rules(); }
  [[nodiscard]] NearCells const& near() const { return near_; }

 private:
  using Exec = Kokkos::DefaultHostExecutionSpace;

  void take_trims(std::vector<Trim> const& trims);
  /// The mesh with the patches that planning added.
  [[nodiscard]] Mesh const& patched() const;
  [[nodiscard]] std::vector<StageOutcome> judge_stages(Coordinates const& morphed) const;

  LoadedMesh const& mesh_;
  LocatedShocks shocks_;
  CaseFile const& case_file_;
  PlanOptions options_;
  Exec exec_;
  MorphPlan plan_;
  NearCells near_;
  std::vector<std::string> region_notes_;
  MeasuredRegions regions_;
  std::optional<Morpher<Exec>> morpher_;  ///< once it is needed; it serves every displacement
  std::optional<FrozenSmoothing> frozen_;
  std::optional<SmoothingRecord> record_;
  std::vector<Trim> trims_;  ///< the worst of every rule and surface
  bool evaluated_ = false;
};

/// The plan options of a case file with its background mesh, read where it has one and the mesh is one of elements.
PlanOptions with_background(CaseFile const& case_file, Mesh const& mesh);

/// Those of a larger share than is allowed.
std::vector<Shortfall> trimmed_beyond(double allowed, std::vector<Trim> const& trims);
/// Models of `field` rules that are far from some of the nodes: a warning each. Throws MotionError where they lie
/// elsewhere, by all nodes.
std::vector<Shortfall> mapping_warnings(CaseFile const& case_file);
/// How far nodes were from the models of `field` rules, and what was left out of these.
std::vector<std::string> mapping_notes(CaseFile const& case_file);

}  // namespace gridmorph::cli
