#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/plan/plane_axes.hpp>
#include <gridmorph/run/block_stages.hpp>
#include <gridmorph/run/element_stages.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::cli {

namespace {

void write_regions(std::string const& path, Mesh const& mesh, PlannedElements const& planned,
                   Coordinates const& morphed) {
  OutputFields fields;
  fields.displacement = true;
  CellField region{"Region", {}};
  for (Region const r : planned.whole.report.regions.element) region.values.push_back(double(2 - int(r)));
  fields.cells.push_back(std::move(region));
  auto const& layer = planned.whole.report.layer;
  fields.nodes.push_back({"Layer", std::vector<double>(layer.begin(), layer.end())});
  write_mesh(path, mesh, morphed, fields);
}

}  // namespace

void write_element_stages(std::filesystem::path const& folder, Mesh const& mesh, PlannedElements const& planned,
                          Morpher<Kokkos::DefaultHostExecutionSpace> const& morpher, Coordinates const& morphed) {
  make_stage_folder(folder);
  auto const path = [&](std::size_t n) { return (folder / stage_names[n]).string(); };
  write_regions(path(0), mesh, planned, morphed);
  // Of several parts the first one with moving walls.
  auto const parts = planned.without_parts();
  auto const part = std::find_if(parts.begin(), parts.end(),
                                 [](PlannedPart const& p) { return p.report.wrap || p.background != nullptr; });
  if (part == parts.end()) return;
  auto const& axes = planned.axes;
  auto const write_stage = [&](std::size_t n, Mesh stage) {
    stage.coordinates = back_from_axes(axes, stage.coordinates);
    write_mesh(path(n), stage);
  };
  if (part->report.wrap) write_stage(1, wrap_mesh(*part->report.wrap));
  if (part->background == nullptr) return;
  Mesh background = part->background->mesh;
  write_stage(2, background);
  Coordinates moved(background.n_nodes());
  auto const u = morpher.background_displacements(part->number);
  for (Index n = 0; n < moved.size(); ++n) moved.set(n, background.coordinates[n] + u.array()[n]);
  background.coordinates = moved;
  write_stage(3, background);
}

}  // namespace gridmorph::cli
