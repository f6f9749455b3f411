#include <gridmorph/app/casefile/ignored_keys.hpp>
#include <gridmorph/app/casefile/side_file.hpp>
#include <gridmorph/app/cli/unstructured_morph.hpp>
#include <gridmorph/app/cli/workflow.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/io/file_check.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/su2/su2_file.hpp>
#include <gridmorph/io/unstructured_io.hpp>
#include <gridmorph/mapping/mapping_report.hpp>
#include <gridmorph/motion/motion.hpp>
#include <gridmorph/report/target_text.hpp>

#include <Kokkos_Core.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <set>
#include <utility>

namespace gridmorph::cli {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

}  // namespace

/// All walls: a wall that stays while its neighbours move can lose its first cells too.
std::vector<int> measured_walls(Mesh const& mesh, CaseFile const& case_file) {
  std::set<int> out;
  for (int p = 0; p < int(mesh.patches.size()); ++p)
    if (mesh.patches[p].kind == PatchKind::wall) out.insert(p);
  for (auto const& layer : case_file.plan.boundary_layers)
    if (!layer.walls.empty())
      for (int const p : select_patches(mesh, layer.walls)) out.insert(p);
  return {out.begin(), out.end()};
}

Kokkos::View<std::uint8_t const*, Kokkos::HostSpace> mask_view(std::vector<unsigned char> const& mask) {
  Kokkos::View<std::uint8_t*, Kokkos::HostSpace> view("gridmorph::cli::near_field", mask.size());
  std::copy(mask.begin(), mask.end(), view.data());
  return view;
}

QualityReport measure_mesh(Mesh const& mesh) {
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(mesh.coordinates);
  input.walls = wall_faces(mesh, measured_walls(mesh, {}));
  return measure_quality(Exec(), mesh, input);
}

QualityThresholds thresholds_of(CaseFile const& case_file) {
  QualityThresholds out;
  out.cells = case_file.guard;
  return out;
}

bool wants_verdict(CaseFile const& case_file, Index cells) {
  constexpr Index many = 1'000'000;
  if (case_file.output_options.quality) return false;
  QualityMode const mode = case_file.guard.quality;
  return mode == QualityMode::fast || (mode == QualityMode::automatic && cells > many);
}

void set_quality(CaseFile& case_file, std::optional<std::string> const& mode) {
  if (mode)
    case_file.guard.quality = *mode == "full"   ? QualityMode::full
                              : *mode == "fast" ? QualityMode::fast
                                                : QualityMode::automatic;
}

void add_mapping_notes(CaseFile const& case_file, std::vector<std::string>& notes) {
  for (auto const& use : case_file.fields) {
    notes.insert(notes.end(), use.field->notes().begin(), use.field->notes().end());
    notes.push_back(use.where + ": " + describe_mapping(*use.field));
  }
}

QualityMeter::QualityMeter(Mesh const& mesh, CaseFile const& case_file, Engine const& engine) : mesh_(mesh) {
  input_.coordinates = views(mesh.coordinates);
  input_.near_field = mask_view(engine.near_field());
  input_.walls = wall_faces(mesh, measured_walls(mesh, case_file));
  input_.limits = case_file.guard;
  input_.fast = wants_verdict(case_file, first_cells(mesh).back());
  input_.handedness = zone_handedness(Exec(), mesh, input_.coordinates);
}

QualityReport QualityMeter::baseline() const {
  return input_.fast ? QualityReport() : measure_quality(Exec(), mesh_, input_);
}

QualityReport QualityMeter::morphed(Coordinates const& morphed) const {
  QualityInput<Kokkos::HostSpace> input = input_;
  input.baseline = input_.coordinates;
  input.coordinates = views(morphed);
  return measure_quality(Exec(), mesh_, input);
}

MorphResult read_baseline(CaseFile const& case_file) {
  MorphResult out;
  out.mesh = load_mesh(case_file.input, case_file.side_file, case_file.leave_out);
  auto const& wanted = case_file.output_options;
  if (!out.mesh.file_variant.empty() && (wanted.displacement || wanted.quality))
    throw ConfigError(
        case_file.source.string() +
        ": [output] displacement and quality: PLOT3D files have no place for solutions; set both to false");
  return out;
}

MorphResult run_morph(CaseFile const& case_file, Terminal& terminal) {
  Stopwatch watch;
  // Reading, planning, boundary, volume, quality, writing: measured with five million nodes.
  terminal.expect({20, 20, 2, 8, 15, 35});
  terminal.progress("reading " + case_file.input.string());
  MorphResult out = read_baseline(case_file);
  out.times.push_back({"read", watch.lap(), true});
  Engine const engine(out.mesh, case_file, terminal);
  out.morphed = engine.morph(terminal);
  out.notes = engine.notes();
  add_mapping_notes(case_file, out.notes);

  out.targets = engine.target_reach(out.morphed);
  for (auto const& target : out.targets) out.notes.push_back(describe_reach(out.mesh, target));

  out.times.insert(out.times.end(), engine.times().begin(), engine.times().end());
  watch.lap();
  terminal.progress("measuring quality");
  QualityMeter const meter(out.mesh, case_file, engine);
  out.before = meter.baseline();
  out.after = meter.morphed(out.morphed);
  if (!out.after.fast) out.stages = engine.stage_results(out.morphed);
  out.shortfalls = shortfalls(out.before, out.after, thresholds_of(case_file));
  out.times.push_back({"quality", watch.lap(), true});
  return out;
}

MeshKind check_keys(CaseFile const& case_file) {
  std::string const input = case_file.input.string();
  CaseUse use;
  MeshKind const kind = mesh_kind(input, case_file.leave_out);
  use.unstructured = kind == MeshKind::unstructured;
  use.run = case_file.sequence ? CaseUse::Run::sequence : CaseUse::Run::morph;
  use.format = cgns::is_cgns(input) ? CaseUse::Format::cgns
               : su2::is_su2(input) ? CaseUse::Format::su2
                                    : CaseUse::Format::plot3d;
  refuse_ignored_keys(case_file, use);
  return kind;
}

void print_plan(CaseFile const& case_file, Terminal& terminal) {
  nlohmann::json json{
      {"gridmorph", GRIDMORPH_VERSION}, {"case_file", case_file.source.string()}, {"input", case_file.input.string()}};
  if (check_keys(case_file) == MeshKind::unstructured) {
    print_unstructured_plan(case_file, std::move(json), terminal);
    return;
  }
  terminal.progress("reading " + case_file.input.string());
  Mesh mesh = load_mesh(case_file.input, case_file.side_file, case_file.leave_out);
  Engine const engine(mesh, case_file, terminal);
  json["nodes"] = mesh.n_nodes();
  json["notes"] = engine.notes();
  json["stages"] = engine.plan_json();
  json["times"] = times_json(engine.times(), mesh.n_nodes());
  terminal.document(json);
  std::string text;
  for (auto const& note : engine.notes()) text += "note: " + note + "\n";
  if (!text.empty()) text += "\n";
  if (!terminal.json()) terminal.result(text + engine.plan_text());
}

}  // namespace gridmorph::cli
