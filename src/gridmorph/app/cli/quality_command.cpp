#include <gridmorph/app/casefile/side_file.hpp>
#include <gridmorph/app/cli/commands.hpp>
#include <gridmorph/app/cli/unstructured_mesh.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/unstructured_io.hpp>
#include <gridmorph/quality/quality.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/report/quality_table.hpp>

#include <fmt/format.h>
#include <Kokkos_Core.hpp>
#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

namespace {

std::string extent_text(Index3 const& e) { return fmt::format("{} x {} x {}", e[0], e[1], e[2]); }

void check_same_zones(Mesh const& a, Mesh const& b) {
  Problems problems;
  if (a.zones.size() != b.zones.size())
    problems.add(fmt::format("'{}' has {} zones and '{}' has {}; compare a mesh with its own baseline", a.source,
                             a.zones.size(), b.source, b.zones.size()));
  else
    for (std::size_t z = 0; z < a.zones.size(); ++z)
      if (a.zones[z].extent != b.zones[z].extent)
        problems.add(
            fmt::format("zone '{}' of '{}' has {} nodes, zone '{}' of '{}' has {}; compare a mesh with its own "
                        "baseline",
                        a.zones[z].name, a.source, extent_text(a.zones[z].extent), b.zones[z].name, b.source,
                        extent_text(b.zones[z].extent)));
  problems.throw_if_any<MeshError>();
}

bool wants_fast(CommandLine const& options) { return options.quality == "fast"; }

int show(QualityReport const& before, std::optional<QualityReport> const& after, Terminal& terminal) {
  QualityThresholds const thresholds;
  terminal.document(quality_json(before, after, thresholds));
  if (!terminal.json()) terminal.result(format_table(before, after, thresholds));
  // A single mesh cannot have been morphed badly; a morphed one can.
  return after && any_failure(shortfalls(before, after, thresholds)) ? falls_short : done;
}

ReadOptions second_options(CommandLine const& options) {
  ReadOptions out;
  out.leave_out = options.leave_out;
  return out;
}

int quality_of_unstructured(CommandLine const& options, Terminal& terminal) {
  terminal.progress("reading " + options.input.string());
  LoadedMesh const loaded = load_unstructured(options.input, {}, options.leave_out);
  std::optional<Coordinates> morphed;
  if (options.second) {
    terminal.progress("reading " + options.second->string());
    if (mesh_kind(options.second->string(), options.leave_out) != MeshKind::unstructured)
      throw MeshError(fmt::format("'{}' is unstructured and '{}' is not; compare a mesh with its own baseline",
                                  options.input.string(), options.second->string()));
    morphed = coordinates_of_same_mesh(loaded.mesh,
                                       read_unstructured_mesh(options.second->string(), second_options(options)));
  }
  terminal.progress("measuring quality");
  bool const fast = wants_fast(options);
  QualityReport before;
  if (!fast || !morphed) before = measure_mesh(loaded, {}, fast);
  std::optional<QualityReport> after;
  if (morphed) after = measure_mesh(loaded, morphed, fast);
  return show(before, after, terminal);
}

}  // namespace

int run_quality_command(CommandLine const& options, Terminal& terminal) {
  if (mesh_kind(options.input.string(), options.leave_out) == MeshKind::unstructured)
    return quality_of_unstructured(options, terminal);
  terminal.progress("reading " + options.input.string());
  Mesh const mesh = load_mesh(options.input, {}, options.leave_out);
  std::optional<Mesh> morphed;
  if (options.second) {
    terminal.progress("reading " + options.second->string());
    morphed = read_mesh(options.second->string(), second_options(options));
    check_same_zones(mesh, *morphed);
  }

  terminal.progress("measuring quality");
  std::vector<int> walls;
  for (int p = 0; p < int(mesh.patches.size()); ++p)
    if (mesh.patches[p].kind == PatchKind::wall) walls.push_back(p);
  Kokkos::DefaultHostExecutionSpace const exec;
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(mesh.coordinates);
  input.walls = wall_faces(mesh, walls);
  input.fast = wants_fast(options);
  input.handedness = zone_handedness(exec, mesh, input.coordinates);
  QualityReport before;
  if (!input.fast || !morphed) before = measure_quality(exec, mesh, input);
  std::optional<QualityReport> after;
  if (morphed) {
    input.baseline = input.coordinates;
    input.coordinates = views(morphed->coordinates);
    after = measure_quality(exec, mesh, input);
  }

  return show(before, after, terminal);
}

}  // namespace gridmorph::cli
