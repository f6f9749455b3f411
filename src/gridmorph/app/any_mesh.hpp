// A mesh of either kind, as commands and runs see it. What differs by kind stands behind the two classes here: blocks
// are in block_mesh.cpp and block_plan.cpp, elements in element_mesh.cpp and element_plan.cpp.
#pragma once

#include <gridmorph/app/casefile/case_file.hpp>
#include <gridmorph/app/casefile/field_check.hpp>
#include <gridmorph/app/cli/diagnosis.hpp>
#include <gridmorph/app/cli/inspect_text.hpp>
#include <gridmorph/app/page/picture_mesh.hpp>
#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/guard/guard.hpp>
#include <gridmorph/guard/smoothing_record.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/surface/surface_io.hpp>
#include <gridmorph/io/write_series.hpp>
#include <gridmorph/plan/block_graph.hpp>
#include <gridmorph/plan/trim_note.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>
#include <gridmorph/report/shortfalls.hpp>
#include <gridmorph/report/step_times.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// What lies near moving walls.
struct NearCells {
  Kokkos::View<std::uint8_t const*, Kokkos::HostSpace> cells =
      {};                       ///< (n_cells), nonzero near them; empty: all are far
  std::vector<int> walls = {};  ///< patches whose first cells are measured, beside those of walls
};

/// Regions that are measured by themselves, of either kind of mesh.
struct MeasuredRegions {
  std::vector<NamedCells> cells = {};
  std::vector<NamedElements<Kokkos::HostSpace>> elements = {};
};

/// What of a mesh is measured, and against what.
struct QualityWanted {
  Coordinates const* morphed = nullptr;  ///< measured against the mesh, or the mesh itself where there is none
  NearCells near = {};
  MeasuredRegions regions = {};
  CellLimits limits = {};
  bool fast = false;                         ///< a verdict is enough
  std::vector<CellField>* fields = nullptr;  ///< those that go into output meshes, filled on the way
  std::vector<Measure> measures = {};        ///< these as fields; empty: all that a kind of mesh has for output meshes
};

/// Facets of patches, or their nodes.
struct PatchesAsSurface {
  std::vector<Vec3> nodes;
  SurfaceTriangles facets;
  std::size_t patches = 0;
};

/// What to look for where a mesh lacks interfaces.
struct MatchOptions {
  double tolerance = 0.01;
  bool periodic = true;
  std::optional<std::filesystem::path> side_file;  ///< where what was found goes: after `present`, its text so far
  std::string present;
};

/// What became of the plan's stages and targets.
struct PlanOutcome {
  std::string text;                ///< stages, above the quality tables
  std::vector<std::string> notes;  ///< how far targets were missed
  nlohmann::json json;             ///< for the report
};

/// What a motion is predicted to make of cells. Empty where a kind of plan cannot tell.
struct PlanPrediction {
  std::string text;
  std::vector<std::string> warnings;
  nlohmann::json json;
};

/// A mesh that is planned for the motion of a case file. Boundary displacements are in the order of the plan.
class AnyPlan {
 public:
  virtual ~AnyPlan() = default;

  /// Displacement of the boundary by the rules as they are at a moment; null: as they stand. Throws MotionError.
  [[nodiscard]] virtual std::vector<Vec3> displacement(Moment const* when) = 0;
  /// The same for rules at a share of their amplitude (fraction_of()).
  [[nodiscard]] virtual std::vector<Vec3> displacement(double share) const = 0;
  /// Moves the mesh from its baseline. `times`: gets what this took, where it is wanted.
  virtual void morph(std::vector<Vec3> const& displacement, Coordinates& morphed, StepTimes* times) = 0;
  /// Whether relax() does anything.
  [[nodiscard]] virtual bool guards() const { return true; }
  /// Smooths around cells that came out bad.
  [[nodiscard]] virtual RelaxReport relax(Coordinates& morphed) const = 0;
  /// Remembers where a mesh of a sequence lost its shape: relax() then does the same to all of them, so that they do
  /// not jump.
  virtual void freeze(Coordinates const& /*morphed*/) {}
  /// Remembers what became of a displacement that morph() brings to `plain`.
  void record(std::vector<Vec3> const& displacement, Coordinates const& plain, Coordinates const& guarded);
  /// From here on morph() does what was recorded, linear in the displacement (SmoothingRecord), and relax() nothing.
  SmoothingMap const& freeze_recorded();
  /// The same motion in several steps, each planned on the mesh before it; nothing where this plan has but one.
  [[nodiscard]] virtual std::optional<Coordinates> morph_in_steps(
      std::vector<Vec3> const& /*displacement*/, int /*steps*/,
      std::function<void(int step)> const& /*progress*/) const {
    return {};
  }

  /// Quality with the near field and the walls of this plan in `wanted`.
  [[nodiscard]] virtual QualityReport measure(QualityWanted wanted) const = 0;
  /// `verdict`: that is all that is wanted; `at_once`: this is the motion as the rules stand, no step of a sequence.
  [[nodiscard]] virtual PlanOutcome outcome(Coordinates const& morphed, bool verdict, bool at_once) const = 0;
  /// What a mesh goes through on its way, as meshes in a folder, which is made where it is missing. `displacement`: of
  /// the boundary, that came to `morphed`.
  virtual void write_stages(std::filesystem::path const& folder, std::vector<Vec3> const& displacement,
                            Coordinates const& morphed) const = 0;

  /// Defaults taken, facts found on the way, up to now.
  [[nodiscard]] virtual std::vector<std::string> notes() const = 0;
  /// Of the motion as the rules stand; of a sequence, at the step that comes out worst. Moves nothing.
  [[nodiscard]] virtual PlanPrediction predict() { return {}; }
  /// Displacements that the rules gave so far and slip surfaces undo, in part or for the most part. Those of which most
  /// is undone throw.
  [[nodiscard]] std::vector<Shortfall> trimmed() const;
  /// Of planning.
  [[nodiscard]] virtual StepTimes times() const = 0;
  /// For `gridmorph plan`.
  [[nodiscard]] virtual std::string text(bool all) const = 0;
  [[nodiscard]] virtual nlohmann::json json() const = 0;
  /// Its blocks and chains, for drawings; nothing where a kind of plan has none.
  [[nodiscard]] virtual std::optional<BlockGraph> graph() const { return {}; }
  /// A line or two above the results of a morph; may be empty.
  [[nodiscard]] virtual std::string headline() const { return {}; }
  [[nodiscard]] virtual MeshForMessages for_messages() const = 0;
  /// The rules on the boundary; numbers of nodes and of the patches of the file are those of the mesh.
  [[nodiscard]] virtual BoundaryMotion const& rules() const = 0;
  [[nodiscard]] virtual NearCells const& near() const = 0;

 protected:
  /// Of displacements that were given. Throws MotionError for those that are undone for the most part.
  void take_trims(std::vector<Trim> const& trims, double allowed);
  /// Of those that are small.
  [[nodiscard]] std::vector<std::string> trim_notes() const;
  /// Of freeze_recorded(), for the morpher; null before.
  [[nodiscard]] std::shared_ptr<SmoothingMap const> const& frozen_map() const { return frozen_map_; }

 private:
  [[nodiscard]] virtual SmoothingRecord new_record() const = 0;
  /// frozen_map() is another one from here on.
  virtual void drop_morpher() = 0;

  std::vector<Trim> trims_;  ///< the worst of every rule and surface
  double allowed_trim_ = 0;  ///< share
  std::optional<SmoothingRecord> record_;
  std::shared_ptr<SmoothingMap const> frozen_map_;
};

/// "determinant_2x2x2" -> "Determinant2x2x2", as solution fields of CGNS files are called.
std::string field_name(Measure measure);

/// Room for measures as fields of an output mesh, for measure_quality() to fill.
CellFields<Kokkos::HostSpace> fields_of(std::vector<CellField>& out, std::span<Measure const> measures, Index n_cells);

/// Makes the folder of AnyPlan::write_stages(). Throws MachineError.
void make_stage_folder(std::filesystem::path const& folder);

/// Steps of a sequence that AnyPlan::predict() looks at, 0 without one: all, of long ones `most`, spread evenly; 100
/// take the time of a plan.
std::vector<int> predicted_steps(CaseFile const& case_file, int most = 100);
/// "step 7 of 24 comes out worst: "
std::string worst_step_text(CaseFile const& case_file, int step);

/// Those of a larger share than is allowed.
std::vector<Shortfall> trimmed_beyond(double allowed, std::vector<Trim> const& trims);
/// Models of `field` rules that are far from some of the nodes: a warning each. Throws MotionError where they lie
/// elsewhere, by all nodes.
std::vector<Shortfall> mapping_warnings(CaseFile const& case_file);
/// How far nodes were from the models of `field` rules, and what was left out of these.
std::vector<std::string> mapping_notes(CaseFile const& case_file);

/// Words and shares of time that differ by kind.
struct KindTraits {
  std::string cells;        ///< "cells" or "elements"
  std::string planning;     ///< what is said while planning
  std::string lost;         ///< what relax() finds: "elements had lost ..."
  std::string change;       ///< what helps where cells are inverted: in one morph
  std::string change_many;  ///< and in a sequence
  std::vector<double>
      costs;  ///< of reading, planning, boundary, volume, (guard,) quality, writing: measured with millions of nodes
};

class AnyMesh {
 public:
  virtual ~AnyMesh() = default;

  [[nodiscard]] virtual KindTraits const& kind() const = 0;
  [[nodiscard]] virtual Coordinates const& coordinates() const = 0;
  [[nodiscard]] Index n_nodes() const { return coordinates().size(); }
  [[nodiscard]] virtual Index n_cells() const = 0;

  [[nodiscard]] virtual QualityReport measure(QualityWanted const& wanted) const = 0;
  /// Those of another file of this mesh, as this one numbers them. Throws MeshError where it holds another mesh.
  [[nodiscard]] virtual Coordinates coordinates_of(std::filesystem::path const& path,
                                                   std::vector<std::string> const& leave_out) const = 0;
  /// Adds interfaces that points say. Throws MeshError where this kind of mesh has none.
  virtual void match(MatchOptions const& options) = 0;

  [[nodiscard]] virtual MeshSummary summary() const = 0;
  /// What inspect shows; `quality`: a table in it.
  [[nodiscard]] virtual std::string text(MeshSummary const& summary, std::string const& quality,
                                         SnippetOptions const& options) const = 0;
  [[nodiscard]] virtual nlohmann::json json(MeshSummary const& summary, SnippetOptions const& options) const = 0;
  /// Facets with normals into the mesh, `split` pieces along each side; or nodes, each once.
  [[nodiscard]] virtual PatchesAsSurface surface(std::vector<std::string> const& selectors, bool as_facets,
                                                 int split) const = 0;

  /// Its patches with nodes and facets.
  [[nodiscard]] virtual Boundary boundary() const = 0;

  /// The file `input`, which this was read from, with other coordinates: write_morphed(), SeriesWriter.
  virtual void write(std::filesystem::path const& input, std::filesystem::path const& output,
                     Coordinates const& morphed, OutputFields const& fields) const = 0;
  /// For viewers: write_vtk().
  virtual void write_vtk(std::filesystem::path const& output, Coordinates const& morphed,
                         OutputFields const& fields) const = 0;
  [[nodiscard]] virtual SeriesWriter series(std::filesystem::path const& input, std::filesystem::path const& output,
                                            std::vector<double> const& times) const = 0;

  /// As pictures see it; the mesh must outlive it.
  [[nodiscard]] virtual std::unique_ptr<page::PictureMesh> pictures() const = 0;

  /// check_fields() of a case file on this mesh.
  virtual void check_fields(CaseFile const& case_file) const = 0;
  /// Connects, checks, resolves rules, plans. The mesh must outlive the plan. Throws MeshError, MotionError, PlanError.
  [[nodiscard]] virtual std::unique_ptr<AnyPlan> plan(CaseFile const& case_file) const = 0;
};

/// What is known of a mesh file before it is read.
struct MeshSource : MeshFileFacts {
  std::filesystem::path path;
  std::vector<std::string> leave_out;

  [[nodiscard]] KindTraits const& traits() const;
};

/// The one place that asks what kind a mesh is. Throws IoError.
MeshSource look_at(std::filesystem::path const& path, std::vector<std::string> const& leave_out);

/// Reads the mesh with its side file: the one given, or that beside it.
std::unique_ptr<AnyMesh> load(MeshSource const& file, std::optional<std::filesystem::path> const& side_file);
inline std::unique_ptr<AnyMesh> load(std::filesystem::path const& path,
                                     std::optional<std::filesystem::path> const& side_file,
                                     std::vector<std::string> const& leave_out) {
  return load(look_at(path, leave_out), side_file);
}

}  // namespace gridmorph::cli
