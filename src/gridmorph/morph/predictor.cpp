#include <gridmorph/morph/predictor.hpp>

#include <gridmorph/kernels/cell_quality.hpp>
#include <gridmorph/kernels/flat_cells.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/morph/morpher_access.hpp>
#include <gridmorph/plan/boundary_size.hpp>

#include <algorithm>
#include <map>
#include <string>

namespace gridmorph {
namespace {

kernels::HexCell cell_of(Coordinates const& x, Zone const& zone, Index first) {
  auto const step = zone.strides();
  kernels::HexCell cell;
  for (int n = 0; n < 8; ++n)
    cell.corner[n] = x[first + (n & 1) * step[0] + (n >> 1 & 1) * step[1] + (n >> 2) * step[2]];
  return cell;
}

double scaled_jacobian(kernels::HexCell const& cell, double handedness) {
  kernels::HexEdges const edges = hex_edges(cell);
  return kernels::scaled_jacobian(edges, collapsed_edges(edges), handedness);
}

}  // namespace

Predictor::Predictor(HostInstance const& host, PreparedMorph const& prepared, PredictionOptions const& options)
    : host_(host),
      prepared_(prepared),
      planner_(host, prepared, options.every),
      handedness_(host.visit([&](auto const& exec) {
        Mesh const& mesh = planner_.coarse().mesh;
        return zone_handedness(exec, mesh, views(mesh.coordinates));
      })) {}

Prediction Predictor::predict(std::span<Vec3 const> boundary) {
  Plan const plan = planner_.plan(prepared_.planned.order).plan;
  return measure(plan, prepared_.plan(), morphed(plan, boundary));
}

OrderTrial Predictor::try_order(ChainOrder const& first, std::span<Vec3 const> boundary, ChainChoice choice) {
  OrderTrial out;
  PlannedMorph planned = planner_.plan(first, &out.next, choice);
  out.prediction = measure(planned.plan, planned.plan, morphed(planned.plan, boundary));
  out.order = std::move(planned.order);
  return out;
}

Coordinates Predictor::morphed(Plan const& plan, std::span<Vec3 const> boundary) const {
  require_boundary_size("gridmorph::predict", boundary.size(), prepared_.plan().boundary_nodes.size(),
                        "MorphPlan::boundary_nodes()");
  Coordinates const& baseline = planner_.coarse().mesh.coordinates;
  Plan const with_common = planner_.with_common_motions(plan, boundary);
  Coordinates out(baseline.size());
  std::vector<Vec3> const given = planner_.displacement(plan, boundary);
  host_.visit([&](auto const& exec) {
    auto const morpher = MorpherAccess::of(exec, with_common, baseline);
    morpher.positions(exec, Kokkos::View<Vec3 const*, Kokkos::HostSpace>(given.data(), given.size()), out);
    compat::fence(exec, "gridmorph::predict (read by the host)");
  });
  return out;
}

void Predictor::add(CellBox const& box, Coordinates const& morphed, std::vector<char>& seen,
                    PredictedCells& out) const {
  CoarseMesh const& coarse = planner_.coarse();
  Zone const& zone = coarse.mesh.zones[box.zone];
  double const handedness = handedness_[box.zone];
  Index3 p{};
  for (p[2] = box.cells.begin[2]; p[2] < box.cells.end[2]; ++p[2])
    for (p[1] = box.cells.begin[1]; p[1] < box.cells.end[1]; ++p[1])
      for (p[0] = box.cells.begin[0]; p[0] < box.cells.end[0]; ++p[0]) {
        Index const first = zone.node(p);
        if (seen[first] != 0 || !coarse.is_cell(box.zone, p)) continue;
        seen[first] = 1;
        kernels::HexCell const before = cell_of(coarse.mesh.coordinates, zone, first);
        kernels::HexCell const after = cell_of(morphed, zone, first);
        kernels::CellMeasures const measures = kernels::cell_measures(after, handedness);
        Vec3 const relative = kernels::relative_displacement(before, after);
        Index3 const cell = coarse.fine_index(box.zone, p);
        auto const value = [&](double v) { return CellValue{v, box.zone, cell}; };
        PredictedCells one;
        one.cells = 1;
        one.inverted =
            measures.smallest_corner_jacobian < 0 && !flat_cell(before, after, handedness).stays_flat() ? 1 : 0;
        one.scaled_jacobian = value(scaled_jacobian(after, handedness));
        one.scaled_jacobian_before = scaled_jacobian(before, handedness);
        if (one.scaled_jacobian_before > 0)
          one.kept = value(std::min(1.0, one.scaled_jacobian.value / one.scaled_jacobian_before));
        one.determinant = value(measures.determinant_3x3x3);
        if (out.determinant.zone < 0 || one.determinant.value < out.determinant.value)  // or it is not kept
          one.determinant_before = kernels::determinant_3x3x3(before, handedness);
        one.angle_deg = value(measures.minimum_angle_deg);
        one.relative_displacement = {value(relative.x), value(relative.y), value(relative.z)};
        join(out, one);
      }
}

Prediction Predictor::measure(Plan const& plan, Plan const& names, Coordinates const& morphed) const {
  Prediction out;
  out.n_cells = prepared_.mesh.n_cells();
  out.every = planner_.every();
  std::vector<char> seen(plan.n_nodes, 0);
  auto const take = [&](PredictedGroup& group) {
    join(out.all, group.cells);
    if (group.cells.cells > 0) out.groups.push_back(std::move(group));
  };
  for (std::size_t s = 0; s < plan.stages.size(); ++s) {
    Stage const& stage = plan.stages[s];
    std::vector<PredictedGroup> chains;
    for (std::string const& name : names.stages[s].description) chains.push_back({names.stages[s].name, name, {}});
    for (std::size_t b = 0; b < stage.cells.size(); ++b)
      add(stage.cells[b], morphed, seen, chains[stage.chain_of_cells[b]].cells);
    for (PredictedGroup& chain : chains) take(chain);
  }
  std::map<std::string, PredictedGroup> regions;
  for (std::size_t r = 0; r < plan.regions.size(); ++r) {
    std::string const& name = plan.region_names[r];
    add(plan.regions[r], morphed, seen,
        regions.try_emplace(name, PredictedGroup{"given", name, {}}).first->second.cells);
  }
  for (auto& [name, region] : regions) take(region);
  sort_worst_first(out.groups);
  return out;
}

}  // namespace gridmorph
