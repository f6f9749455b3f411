#include <gridmorph/app/cli/morph_command.hpp>
#include <gridmorph/app/cli/unstructured_run.hpp>
#include <gridmorph/app/cli/workflow.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/guard/stepped_morph.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mapping/mapping_report.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/report/quality_table.hpp>

#include <fmt/format.h>
#include <Kokkos_Core.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <utility>

namespace gridmorph::cli {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

/// Size of the largest displacement in any step.
double largest_motion(CaseFile const& case_file, LoadedMesh const& loaded, BoundaryConditions const& boundary) {
  double largest = 0;
  auto const& sequence = *case_file.sequence;
  for (int step = 0; step < sequence.steps; ++step)
    for (Vec3 const& u : evaluate(loaded.mesh, boundary, motion_at(case_file, sequence.moment(step))))
      largest = std::max(largest, norm(u));
  return largest;
}

PreparedUnstructured plan_sequence(CaseFile const& case_file, LoadedMesh const& l, UnstructuredOptions options) {
  NodeGraph graph = make_node_graph(l.mesh, l.topology.elements_of_nodes);
  auto boundary = boundary_conditions(l.mesh, l.topology, l.face_patches, graph, case_file.motion, options.walls,
                                      Displacements::any);
  options.motion = largest_motion(case_file, l, boundary);
  return prepare(l.mesh, l.topology, l.face_patches, std::move(graph), std::move(boundary), options);
}

}  // namespace

nlohmann::json plan_json(PreparedUnstructured const& prepared) {
  auto const& r = prepared.report;
  auto const& p = prepared.plan;
  return {{"offset", r.offset},
          {"columns", r.n_columns},
          {"layer_height", r.layer_height},
          {"elements", {{"near", r.regions.n_near}, {"fence", r.regions.n_partial}, {"far", r.regions.n_far}}},
          {"layers", p.near.n_layers()},
          {"background",
           {{"zones", p.background ? p.background->mesh.zones.size() : 0},
            {"nodes", p.background ? p.background->mesh.n_nodes() : 0}}},
          {"wrap_nodes", r.wrap_nodes},
          {"wrap_nodes_outside", r.wrap_outside},
          {"wrap_largest_distance", r.wrap_distance},
          {"far_nodes", r.far_nodes},
          {"far_nodes_outside", r.far_outside},
          {"unreached_nodes", r.unreached},
          {"seconds",
           {{"boundary", r.seconds.boundary},
            {"columns", r.seconds.columns},
            {"distances", r.seconds.distances},
            {"wrap", r.seconds.wrap},
            {"layers", r.seconds.layers},
            {"background", r.seconds.background},
            {"location", r.seconds.location},
            {"residual", r.seconds.residual}}}};
}

void read_and_plan(CaseFile const& case_file, Terminal& terminal, UnstructuredRun& out) {
  Stopwatch watch;
  terminal.progress("reading " + case_file.input.string());
  out.loaded = load_unstructured(case_file.input, case_file.side_file, case_file.leave_out);
  out.times.push_back({"read", watch.lap(), true});
  terminal.progress("finding wrap and layers, making the background mesh, locating nodes");
  UnstructuredOptions options = case_file.unstructured;
  options.boundary_layers = case_file.plan.boundary_layers;
  if (auto const& own = case_file.background)
    options.background =
        std::make_shared<Background const>(make_background(read_mesh(own->path.string()), own->wrap, own->outer));
  auto const& l = out.loaded;
  out.prepared = case_file.sequence ? plan_sequence(case_file, l, options)
                                    : prepare(l.mesh, l.topology, l.face_patches, case_file.motion, options);
  out.options = std::move(options);
  out.times.push_back({"plan", watch.lap(), true});
  out.notes = out.loaded.mesh.notes;
  for (auto const* more : {&out.loaded.face_patches.notes, &out.prepared->notes})
    out.notes.insert(out.notes.end(), more->begin(), more->end());
  add_mapping_notes(case_file, out.notes);
}

UnstructuredQualityInput<Kokkos::HostSpace> quality_of_baseline(UnstructuredRun const& out) {
  auto const& regions = out.prepared->report.regions.element;
  Kokkos::View<std::uint8_t*, Kokkos::HostSpace> near("gridmorph::cli::near_field", regions.size());
  for (std::size_t e = 0; e < regions.size(); ++e) near(e) = regions[e] == Region::far ? 0 : 1;
  UnstructuredQualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(out.loaded.mesh.coordinates);
  input.near_field = near;
  input.signs = out.loaded.signs;
  std::set<int> walls(out.prepared->boundary.driving_patches.begin(), out.prepared->boundary.driving_patches.end());
  for (std::size_t p = 0; p < out.loaded.mesh.patches.size(); ++p)
    if (out.loaded.mesh.patches[p].kind == PatchKind::wall) walls.insert(int(p));
  input.walls.assign(walls.begin(), walls.end());
  return input;
}

UnstructuredQualityInput<Kokkos::HostSpace> quality_of_morphed(UnstructuredRun const& out) {
  auto input = quality_of_baseline(out);
  input.baseline = input.coordinates;
  input.coordinates = views(out.result.morphed);
  return input;
}

void measure_baseline(CaseFile const& case_file, UnstructuredRun& out) {
  if (wants_verdict(case_file, out.loaded.mesh.n_elements())) return;
  auto const& l = out.loaded;
  out.before = measure_quality(Exec(), l.mesh, l.topology, l.face_patches, quality_of_baseline(out));
}

void measure_result(CaseFile const& case_file, UnstructuredRun& out) {
  auto const& l = out.loaded;
  auto& result = out.result;
  auto input = quality_of_morphed(out);
  input.limits = case_file.guard;
  input.fast = wants_verdict(case_file, l.mesh.n_elements());
  result.fields = {case_file.output_options.displacement, {}, {}};
  if (case_file.output_options.quality)
    for (Measure const m : {Measure::aspect_ratio, Measure::determinant_3x3x3, Measure::minimum_angle_deg,
                            Measure::equiangle_skewness, Measure::relative_displacement}) {
      auto& values = result.fields.cells.emplace_back(field_name(m), std::vector<double>(), field_unit(m)).values;
      values.resize(std::size_t(l.mesh.n_elements()));
      input.fields[m] = Kokkos::View<double*, Kokkos::HostSpace>(values.data(), values.size());
    }
  result.after = measure_quality(Exec(), l.mesh, l.topology, l.face_patches, input);
  result.shortfalls = shortfalls(out.before, result.after, thresholds_of(case_file));
}

TriedSteps try_steps(CaseFile const& case_file, UnstructuredRun& out, std::vector<Vec3> const& displacement,
                     Terminal& terminal) {
  TriedSteps tried;
  Index const in_one = newly_inverted(out.result.after);
  if (in_one == 0 || case_file.guard.steps < 2 || out.options.background) return tried;
  auto& l = out.loaded;
  UnstructuredRun::Result best = std::move(out.result);
  int best_steps = 1;
  for (int steps = 2; steps <= case_file.guard.steps && newly_inverted(best.after) > 0; ++steps) {
    auto const progress = [&](int step) {
      terminal.progress(fmt::format("elements are inverted; morphing in steps, {} of {}", step, steps));
    };
    try {
      out.result.morphed = morph_in_steps(l.mesh, l.topology, l.face_patches, *out.prepared, displacement,
                                          {steps, out.options, {.signs = l.signs}, progress});
    } catch (Error const& e) {
      // There is a result: a mesh on the way that cannot be planned on is no reason to lose it.
      tried.notes.push_back(fmt::format("in {} steps the motion cannot be planned: {}", steps, e.what()));
      continue;
    }
    measure_result(case_file, out);
    if (newly_inverted(out.result.after) >= newly_inverted(best.after)) continue;
    best = std::move(out.result);
    best_steps = steps;
  }
  out.result = std::move(best);
  Index const left = newly_inverted(out.result.after);
  tried.text =
      best_steps == 1
          ? fmt::format("{} elements are inverted, and up to {} steps leave no fewer", in_one, case_file.guard.steps)
          : fmt::format(
                "{} elements were inverted in one step; in {} steps, each planned on the "
                "mesh before it, {} {}",
                in_one, best_steps, left == 0 ? "none" : std::to_string(left), left <= 1 ? "is" : "are");
  return tried;
}

nlohmann::json report_json(CaseFile const& case_file, UnstructuredRun const& out) {
  nlohmann::json json = quality_json(out.before, out.result.after, thresholds_of(case_file));
  json["gridmorph"] = GRIDMORPH_VERSION;
  json["case_file"] = case_file.source.string();
  json["input"] = case_file.input.string();
  json["nodes"] = out.loaded.mesh.n_nodes();
  json["elements"] = out.loaded.mesh.n_elements();
  json["times"] = times_json(out.times, out.loaded.mesh.n_nodes());
  json["notes"] = out.notes;
  json["plan"] = plan_json(*out.prepared);
  json["fields"] = nlohmann::json::array();
  for (auto const& use : case_file.fields) {
    json["fields"].push_back(mapping_json(*use.field));
    json["fields"].back()["rule"] = use.where;
  }
  return json;
}

std::string regions_text(PreparedUnstructured const& prepared) {
  auto const& r = prepared.report;
  auto const& p = prepared.plan;
  std::string text = fmt::format(
      "near field: {}, {} columns up to {:.4g} high, {} near elements, {} on the fence, {} far; {} layers\n",
      r.wrap ? fmt::format("offset {:.4g}", r.offset) : std::string("the hole of the background mesh"), r.n_columns,
      r.layer_height, r.regions.n_near, r.regions.n_partial, r.regions.n_far, p.near.n_layers());
  if (p.background)
    text += fmt::format(
        "background mesh: {} zones, {} nodes; {} on the wrap; {} nodes of the mesh take their displacement from it\n",
        p.background->mesh.zones.size(), p.background->mesh.n_nodes(), r.wrap_nodes, r.far_nodes);
  return text;
}

std::string format_result(CaseFile const& case_file, UnstructuredRun const& out) {
  std::string text = format_table(out.before, out.result.after, thresholds_of(case_file));
  if (!out.result.after.fast) text += "\n" + format_short_table(out.before, out.result.after);
  return text + "\n" + format_times(out.times, out.loaded.mesh.n_nodes());
}

}  // namespace gridmorph::cli
