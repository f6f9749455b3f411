#include <gridmorph/casefile/mapping_report.hpp>
#include <gridmorph/cli/commands.hpp>
#include <gridmorph/cli/morph_command.hpp>
#include <gridmorph/cli/output_files.hpp>
#include <gridmorph/cli/unstructured_mesh.hpp>
#include <gridmorph/cli/unstructured_morph.hpp>
#include <gridmorph/cli/workflow.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/io/unstructured_io.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/report/quality_table.hpp>
#include <gridmorph/report/step_times.hpp>
#include <gridmorph/unstructured/guard.hpp>
#include <gridmorph/unstructured/unstructured_morpher.hpp>

#include <fmt/format.h>
#include <Kokkos_Core.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

namespace gridmorph::cli {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

kernels::Field<double const> field(Coordinates const& c) { return {c.x.data(), c.y.data(), c.z.data()}; }
kernels::Field<double> writable(Coordinates const& c) { return {c.x.data(), c.y.data(), c.z.data()}; }

struct Result {
  LoadedMesh loaded;
  std::optional<PreparedUnstructured> prepared;
  Coordinates morphed;
  std::optional<Coordinates> background;  ///< morphed
  QualityReport before, after;
  std::vector<Shortfall> shortfalls;
  std::vector<std::string> notes;
  StepTimes times;
};

void read_and_plan(CaseFile const& case_file, Terminal& terminal, Result& out) {
  Stopwatch watch;
  terminal.progress("reading " + case_file.input.string());
  out.loaded = load_unstructured(case_file.input);
  out.times.push_back({"read", watch.lap(), true});
  terminal.progress("finding wrap and layers, making the background mesh, locating nodes");
  UnstructuredOptions options = case_file.unstructured;
  options.boundary_layers = case_file.plan.boundary_layers;
  out.prepared = prepare(out.loaded.mesh, out.loaded.topology, out.loaded.claims, case_file.motion, options);
  out.times.push_back({"plan", watch.lap(), true});
  out.notes = out.loaded.mesh.notes;
  for (auto const* more : {&out.loaded.claims.notes, &out.prepared->notes})
    out.notes.insert(out.notes.end(), more->begin(), more->end());
  add_mapping_notes(case_file, out.notes);
}

void move_nodes(Result& out, Terminal& terminal, bool keep_background) {
  Stopwatch watch;
  auto const boundary = out.prepared->boundary_displacement(out.loaded.mesh);
  out.times.push_back({"boundary", watch.lap(), false});
  terminal.progress("morphing");
  Exec const exec;
  UnstructuredMorpher<Exec> const morpher(exec, out.prepared->plan);
  out.morphed = Coordinates(out.loaded.mesh.n_nodes());
  Kokkos::View<Vec3 const*, Exec::memory_space, Kokkos::MemoryTraits<Kokkos::Unmanaged>> const given(boundary.data(),
                                                                                                     boundary.size());
  out.times.push_back({"upload", watch.lap(), true});
  morpher.apply(exec, given, field(out.loaded.mesh.coordinates), writable(out.morphed));
  exec.fence();
  out.times.push_back({"morph", watch.lap(), true});
  if (!keep_background || !out.prepared->plan.background) return;
  Coordinates const& x = out.prepared->plan.background->mesh.coordinates;
  auto const u = morpher.background_displacement();
  out.background = Coordinates(x.size());
  for (Index n = 0; n < x.size(); ++n) out.background->set(n, x[n] + u[n]);
}

UnstructuredQualityInput<Kokkos::HostSpace> quality_input(Result const& out) {
  auto const& regions = out.prepared->report.regions.element;
  Kokkos::View<std::uint8_t*, Kokkos::HostSpace> near("gridmorph::cli::near_field", regions.size());
  for (std::size_t e = 0; e < regions.size(); ++e) near(e) = regions[e] == Region::far ? 0 : 1;
  UnstructuredQualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(out.loaded.mesh.coordinates);
  input.near_field = near;
  input.orientation = out.loaded.orientation;
  std::set<int> walls(out.prepared->boundary.driving_patches.begin(), out.prepared->boundary.driving_patches.end());
  for (std::size_t p = 0; p < out.loaded.mesh.patches.size(); ++p)
    if (out.loaded.mesh.patches[p].kind == PatchKind::wall) walls.insert(int(p));
  input.walls.assign(walls.begin(), walls.end());
  return input;
}

/// Smooths around elements that came out bad, and says so.
void relax(Result& out, Terminal& terminal) {
  terminal.progress("looking for bad elements");
  Stopwatch watch;
  RelaxReport const report = relax_bad_elements(out.loaded.mesh, out.loaded.topology, *out.prepared, out.morphed);
  if (report.before > 0)
    out.notes.push_back(fmt::format(
        "{} elements had lost four fifths of their determinant or more; displacements around them are smoothed in {} "
        "rounds, {} are left",
        report.before, report.rounds, report.after));
  out.times.push_back({"guard", watch.lap(), true});
}

void measure(CaseFile const& case_file, Result& out, Terminal& terminal) {
  terminal.progress("measuring quality");
  Stopwatch watch;
  auto input = quality_input(out);
  auto const& l = out.loaded;
  out.before = measure_quality(Exec(), l.mesh, l.topology, l.claims, input);
  input.baseline = input.coordinates;
  input.coordinates = views(out.morphed);
  out.after = measure_quality(Exec(), l.mesh, l.topology, l.claims, input);
  out.shortfalls = shortfalls(out.before, out.after, thresholds_of(case_file));
  out.times.push_back({"quality", watch.lap(), true});
}

OutputFields fields_of(CaseFile const& case_file, Result const& out) {
  OutputFields fields;
  fields.displacement = case_file.output_options.displacement;
  if (!case_file.output_options.quality) return fields;
  constexpr std::array measures{Measure::aspect_ratio, Measure::determinant_3x3x3, Measure::minimum_angle_deg,
                                Measure::equiangle_skewness, Measure::relative_displacement};
  auto input = quality_input(out);
  input.baseline = input.coordinates;
  input.coordinates = views(out.morphed);
  auto const values = cell_fields(Exec(), out.loaded.mesh, out.loaded.topology, input, measures);
  for (std::size_t m = 0; m < measures.size(); ++m)
    fields.cells.push_back(
        {field_name(measures[m]), std::vector<double>(values[m].data(), values[m].data() + values[m].extent(0))});
  return fields;
}

/// The morphed mesh with its regions (0 near, 1 fence, 2 far), layers and displacements.
void write_regions(std::string const& path, Result const& out) {
  UnstructuredMesh const& mesh = out.loaded.mesh;
  if (mesh.polyhedra.element.size() > 0) return;  // they cannot be written anew
  auto const& report = out.prepared->report;
  OutputFields fields;
  fields.displacement = true;
  CellField region{"Region", {}};
  for (Region const r : report.regions.element) region.values.push_back(double(2 - int(r)));
  fields.cells.push_back(std::move(region));
  fields.nodes.push_back({"Layer", std::vector<double>(report.layer.begin(), report.layer.end())});
  write_mesh(path, mesh);
  write_morphed(path, path, mesh, out.morphed, fields);
}

void write_stages(std::filesystem::path const& folder, Result const& out) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw MachineError(
        fmt::format("the folder '{}' for the stages cannot be made: {}", folder.string(), error.message()));
  auto const& prepared = *out.prepared;
  write_regions((folder / "regions.cgns").string(), out);
  if (prepared.report.wrap) write_mesh((folder / "wrap.cgns").string(), wrap_mesh(*prepared.report.wrap));
  if (!prepared.plan.background) return;
  Mesh background = prepared.plan.background->mesh;
  write_mesh((folder / "background.cgns").string(), background);
  if (!out.background) return;
  background.coordinates = *out.background;
  write_mesh((folder / "background_morphed.cgns").string(), background);
}

nlohmann::json plan_json(PreparedUnstructured const& prepared) {
  auto const& r = prepared.report;
  auto const& p = prepared.plan;
  return {{"offset", r.offset},
          {"columns", r.n_columns},
          {"layer_height", r.layer_height},
          {"elements", {{"near", r.regions.n_near}, {"fence", r.regions.n_fence}, {"far", r.regions.n_far}}},
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

std::string report_text(CaseFile const& case_file, Result const& out, bool written) {
  nlohmann::json json = quality_json(out.before, out.after, thresholds_of(case_file));
  json["gridmorph"] = GRIDMORPH_VERSION;
  json["case_file"] = case_file.source.string();
  json["input"] = case_file.input.string();
  json["nodes"] = out.loaded.mesh.n_nodes();
  json["elements"] = out.loaded.mesh.n_elements();
  json["times"] = times_json(out.times, out.loaded.mesh.n_nodes());
  json["notes"] = out.notes;
  json["plan"] = plan_json(*out.prepared);
  json["output"] = written ? nlohmann::json(case_file.output.string()) : nlohmann::json(nullptr);
  json["fields"] = nlohmann::json::array();
  for (auto const& use : case_file.fields) {
    json["fields"].push_back(mapping_json(*use.field));
    json["fields"].back()["rule"] = use.where;
  }
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string regions_text(PreparedUnstructured const& prepared) {
  auto const& r = prepared.report;
  auto const& p = prepared.plan;
  std::string text = fmt::format(
      "near field: offset {:.4g}, {} columns up to {:.4g} high, {} near elements, {} on the fence, {} far; {} layers\n",
      r.offset, r.n_columns, r.layer_height, r.regions.n_near, r.regions.n_fence, r.regions.n_far, p.near.n_layers());
  if (p.background)
    text += fmt::format(
        "background mesh: {} zones, {} nodes; {} on the wrap; {} nodes of the mesh take their displacement from it\n",
        p.background->mesh.zones.size(), p.background->mesh.n_nodes(), r.wrap_nodes, r.far_nodes);
  return text;
}

}  // namespace

int morph_unstructured(CaseFile const& case_file, Terminal& terminal) {
  auto const& report = case_file.output_options.report;
  check_outputs(case_file.output, report, case_file.input);
  Result out;
  read_and_plan(case_file, terminal, out);
  move_nodes(out, terminal, case_file.output_options.stages.has_value());
  relax(out, terminal);
  measure(case_file, out, terminal);
  bool const written = newly_inverted(out.after) == 0 || case_file.guard.write_inverted;
  std::optional<PendingFile> pending;
  if (report) pending.emplace(*report, report_text(case_file, out, written) + std::string(room_for_a_time, '\n'));
  if (written) {
    Stopwatch watch;
    terminal.progress("writing " + case_file.output.string());
    write_morphed(case_file.input.string(), case_file.output.string(), out.loaded.mesh, out.morphed,
                  fields_of(case_file, out));
    out.times.push_back({"write", watch.lap(), true});
  }
  if (case_file.output_options.stages) write_stages(*case_file.output_options.stages, out);
  if (pending) {
    pending->replace(report_text(case_file, out, written));
    pending->commit();
  }
  std::string text;
  for (auto const& note : out.notes) text += "note: " + note + "\n";
  text += regions_text(*out.prepared);
  text += "\n" + format_table(out.before, out.after, thresholds_of(case_file));
  text += "\n" + format_short_table(out.before, out.after);
  text += "\n" + format_times(out.times, out.loaded.mesh.n_nodes());
  if (written) text += fmt::format("\nwrote {}\n", case_file.output.string());
  if (report) text += fmt::format("wrote {}\n", report->string());
  if (auto const& stages = case_file.output_options.stages)
    text += fmt::format("wrote wrap and background mesh to {}\n", stages->string());
  terminal.say(text);
  if (terminal.quiet())
    for (auto const& s : out.shortfalls) terminal.warn(s.message);
  if (!written)
    terminal.error(fmt::format(
        "'{}' is not written, because elements are inverted that were not in the baseline; move the boundary less, "
        "change [near_field], or set write_inverted = true in [guard]",
        case_file.output.string()));
  return any_failure(out.shortfalls) || !written ? falls_short : done;
}

std::string unstructured_plan_text(CaseFile const& case_file, Terminal& terminal) {
  Result out;
  read_and_plan(case_file, terminal, out);
  std::string text;
  for (auto const& note : out.notes) text += "note: " + note + "\n";
  return text + regions_text(*out.prepared) + "\n" + format_times(out.times, out.loaded.mesh.n_nodes());
}

}  // namespace gridmorph::cli
