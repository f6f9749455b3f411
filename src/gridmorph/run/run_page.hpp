// The report page of a run: what it shows is gathered here, how it looks is in page/.
#pragma once

#include <gridmorph/core/for_all.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/page/report_page.hpp>
#include <gridmorph/page/section.hpp>
#include <gridmorph/page/surface_picture.hpp>
#include <gridmorph/run/run.hpp>

#include <Kokkos_Core.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// What the patches of a mesh are, as rules move them.
struct PatchRoles {
  std::vector<signed char> wall;  ///< per patch: 1 a wall that a rule moves, 0 one that stands or slips, -1 none
};

/// A mesh before and after, as a page shows it.
struct PageMeshes {
  Coordinates const &baseline, &morphed;
  NearCells const& near;
  std::function<Run::KeptMeasure(Measure)> kept;  ///< where measures of every cell were kept; empty: nowhere
};

class RunPage {
 public:
  /// Before the run: the case file as it is now. typed: the command line.
  RunPage(CaseFile const& case_file, std::string typed);

  /// What the mesh looks like, once the run has it. Cost: its boundary.
  void begin(Run const& run);
  /// The same of the passage of a wheel, which is one of a machine.
  void begin_passage(std::unique_ptr<page::PictureMesh> pictures, PatchRoles roles, Coordinates const& baseline);
  /// Remembers the surface as the run has it now, of a sequence of `of` steps: of some of them, and of the worst so
  /// far.
  void add_step(Run const& run, int step, int of, bool worst);
  /// All pictures and numbers of the run as it stands. quality: as the report has it. Cost: facets, cells of sections,
  /// pixels.
  void finish(Run const& run, QualityReport const& quality);
  /// Those of one passage of a wheel. cells: "cells" or "elements".
  void finish_passage(PageMeshes const& meshes, QualityReport const& quality, std::string const& cells);

  /// The mesh that the run has written. Cost: reading it.
  void add_output(std::filesystem::path const& output);

  /// The page with this report. Cost: its length.
  [[nodiscard]] std::string text(nlohmann::json const& report);

 private:
  void find_surface(Coordinates const& baseline);
  void add_inputs();
  void describe(PageMeshes const& meshes, std::string const& cells);
  [[nodiscard]] std::vector<Vec3> displacement_of_surface(Coordinates const& morphed) const;
  void make_surfaces(Coordinates const& morphed);
  void make_sections(PageMeshes const& meshes);
  [[nodiscard]] std::vector<page::Colour> colours_of(PageMeshes const& meshes, std::vector<Index> const& cells,
                                                     bool morphed) const;
  void make_steps();

  CaseFile const& case_file_;
  page::ReportPage page_;
  std::unique_ptr<page::PictureMesh> pictures_;
  std::vector<page::Facet> boundary_;
  PatchRoles roles_;
  page::Surface surface_;
  bool of_machine_ = false;  ///< cut at constant span
  struct Step {
    int step = 0;
    std::vector<Vec3> displacement;
  };
  std::vector<Step> steps_;
  std::optional<Step> worst_step_;
};

/// do_it(n) for n below `tasks`, on all threads, whichever is free; what one of them throws is thrown in the end.
template <class Function>
void for_each_task(std::size_t tasks, Function const& do_it) {
  using Policy = Kokkos::RangePolicy<Kokkos::DefaultHostExecutionSpace, Kokkos::Schedule<Kokkos::Dynamic>>;
  detail::Thrown thrown;
  Kokkos::parallel_for("gridmorph::cli::page_task", Policy(0, tasks).set_chunk_size(1),
                       [&](std::size_t n) { thrown.guard(do_it, n); });
  compat::fence(Kokkos::DefaultHostExecutionSpace(), "gridmorph::cli::page_task (all are done)");
  thrown.rethrow();
}

// page_rules.cpp
PatchRoles roles_of(BoundaryMotion const& rules, std::size_t n_patches);
std::vector<page::RuleRow> rule_rows(BoundaryMotion const& rules, Coordinates const& baseline,
                                     Coordinates const& morphed);
/// Periodic match and distance from slip surfaces. Cost: nodes of these.
page::BoundaryCheck boundary_check(BoundaryMotion const& rules, Coordinates const& baseline,
                                   Coordinates const& morphed);

// page_cells.cpp
/// Histograms of near and far field, and the worst cells with drawings.
void fill_quality(PageMeshes const& meshes, QualityReport const& quality, page::PictureMesh const& mesh,
                  page::ReportPage& out);

// page_cuts.cpp
/// Whether rules or periodic boundaries are those of blade rows.
bool is_of_machine(BoundaryMotion const& rules);
/// Where to cut: a plane mesh is itself; a machine at constant span; anything else at three planes through what moves.
std::vector<page::Cut> cuts_of(page::PictureMesh const& mesh, bool of_machine, std::optional<Axis> const& axis,
                               page::Surface const& surface, std::vector<Vec3> const& displacement);

}  // namespace gridmorph::cli
