// The steps between a mesh with motion rules and morphed coordinates, without files and without quality.
#pragma once

#include <gridmorph/app/casefile/case_file.hpp>
#include <gridmorph/app/cli/terminal.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/motion/target_reach.hpp>
#include <gridmorph/quality/quality.hpp>
#include <gridmorph/report/step_times.hpp>

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// What became of the cells that one stage morphed.
struct StageResult {
  std::string name;
  CellValue min_determinant;  ///< 3x3x3
};

/// A mesh that is connected, checked, and planned for the motion of a case file.
class Engine {
 public:
  /// Connects interfaces, checks coverage, resolves rules, plans. Adds patches that the mesh lacks (poles, open faces) to
  /// `mesh`, which must outlive the engine. Throws MeshError, MotionError or PlanError.
  Engine(Mesh& mesh, CaseFile const& case_file, Terminal& terminal);
  ~Engine();
  Engine(Engine&&) noexcept;
  Engine& operator=(Engine&&) = delete;

  /// The stages and chains in order, with the reason for each rank.
  [[nodiscard]] std::string plan_text() const;
  /// The same as a list: name of each stage, one line per chain, how many cells it morphs; finalize passes at the end.
  [[nodiscard]] nlohmann::json plan_json() const;
  /// Defaults taken, facts found on the way (those of morph() once it has run).
  [[nodiscard]] std::vector<std::string> notes() const;
  /// One number per cell, nonzero in the near field of moving walls; cells as in quality (zone after zone, i fastest).
  [[nodiscard]] std::vector<unsigned char> near_field() const;

  /// Evaluates the rules and moves the mesh. Memory: 24 bytes per node for the result. Throws MotionError.
  [[nodiscard]] Coordinates morph(Terminal& terminal) const;
  /// Moves the mesh from the baseline by other displacements: `motion` has the rules that the engine was made for, and only
  /// the displacements that they give may differ (another time of a sequence). Plan, tables and line parameters are kept.
  /// `morphed`: room for every node. Throws MotionError.
  void morph_into(Motion const& motion, Coordinates const& morphed) const;
  /// How far the nodes of each target rule ended from their target.
  [[nodiscard]] std::vector<TargetReach> target_reach(Coordinates const& morphed) const;
  /// The worst cell of every stage, in order.
  [[nodiscard]] std::vector<StageResult> stage_results(Coordinates const& morphed) const;
  /// How long each step so far took: topology, rules, plan, and boundary and morph once morph() has run.
  [[nodiscard]] StepTimes const& times() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gridmorph::cli
