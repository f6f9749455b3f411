#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/case/formula.hpp>
#include <gridmorph/case/side_file.hpp>
#include <gridmorph/command/commands.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/fillet/fillet_elements.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/report/quality_table.hpp>
#include <gridmorph/report/shortfalls.hpp>
#include <gridmorph/run/loaded_mesh.hpp>
#include <gridmorph/run/output_files.hpp>
#include <gridmorph/run/run_files.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::cli {

namespace {

/// A number, or an expression of x, y, z.
std::function<double(Vec3 const&)> radius_of(std::string const& text) {
  if (text.find_first_not_of(" \t") == std::string::npos)
    throw ConfigError("--radius is empty; give a number, such as 0.004, or an expression of x, y and z");
  if (uses_axis(text) || uses_time(text))
    throw ConfigError("--radius '" + text + "': it may depend on x, y and z, not on r, theta, axial, t or step");
  Problems problems;
  FunctionRule const rule = make_formula(FormulaFrame::cartesian,
                                         {FormulaComponent{"radius", text, "--radius"}, {}, {}}, {}, Axis{}, problems);
  problems.throw_if_any<ConfigError>();
  return [rule](Vec3 const& p) {
    Vec3 out;
    rule.function(std::span(&p, 1), std::span(&out, 1));
    return out.x;
  };
}

std::string facts_text(FilletFacts const& facts) {
  std::string text = fmt::format(
      "fillet along {} nodes of the corner: radius {:.5g}{}, arcs of {:.1f} to {:.1f} degrees\n", facts.stations,
      facts.smallest_radius,
      facts.largest_radius > facts.smallest_radius ? fmt::format(" to {:.5g}", facts.largest_radius) : std::string(),
      facts.arc_angle_deg[0], facts.arc_angle_deg[1]);
  if (facts.open_ends > 0)
    text += fmt::format(
        "note: the corner goes on where the blade ends, at {} nodes; the fillet runs out before them, and does not go "
        "around the edges of the blade\n",
        facts.open_ends);
  return text;
}

std::string summary_text(FilletResult const& result, Mesh const& before, double seconds) {
  Mesh const& after = result.split.mesh;
  std::string text =
      facts_text(result) + fmt::format(
                               "layers taken from the corner: {} off the blade, {} off the end wall; {} made of both\n"
                               "moved wall nodes off the arc are {:.2g} from the walls as they were, at most\n",
                               result.layers.old[0], result.layers.old[1], result.layers.made, result.wall_deviation);
  if (!result.first_cells_kept)
    text +=
        "note: first cells off the wall with fewer layers become smaller, all along it: the layers of the other wall "
        "do not fit otherwise\n";
  text +=
      fmt::format("zones {} -> {}, cells {} -> {}, nodes {} -> {}; {:.2f} s\n\n", before.zones.size(),
                  after.zones.size(), before.n_cells(), after.n_cells(), before.n_nodes(), after.n_nodes(), seconds);
  return text;
}

std::string summary_text(ElementFillet const& result, Mesh const& before, double seconds) {
  std::string const elements =
      result.cut_elements > 0
          ? fmt::format(
                "layers up to which hexahedra are cut in the mitre: {} off the blade, {} off the end wall\n"
                "elements {} -> {}, ",
                result.layers.old[0], result.layers.old[1], before.n_elements(), result.mesh.n_elements())
          : fmt::format("layers of both walls meet in a mitre already: no element is cut\nelements {}, ",
                        before.n_elements());
  return facts_text(result) + elements + fmt::format("nodes {}; {:.2f} s\n\n", before.n_nodes(), seconds);
}

nlohmann::json document(CommandLine const& options, FilletFacts const& facts, QualityReport const& quality) {
  return {{"gridmorph", GRIDMORPH_VERSION},
          {"input", options.input.string()},
          {"output", options.output->string()},
          {"stations", facts.stations},
          {"radius", {facts.smallest_radius, facts.largest_radius}},
          {"arc_deg", {facts.arc_angle_deg[0], facts.arc_angle_deg[1]}},
          {"layers", {{"blade", facts.layers.old[0]}, {"end_wall", facts.layers.old[1]}}},
          {"open_ends", facts.open_ends},
          {"quality", quality}};
}

FilletOptions options_of(CommandLine const& options, Mesh const& mesh) {
  FilletOptions wanted;
  wanted.blade = select_patches(mesh, options.patches);
  wanted.end_wall = select_patches(mesh, options.end_walls);
  wanted.radius = radius_of(options.radius);
  wanted.layers = {options.blade_layers, options.end_wall_layers};
  wanted.run_out = options.run_out;
  return wanted;
}

/// What the filled mesh falls short of that the mesh without a fillet did not already.
std::vector<Shortfall> shortfalls_of(QualityReport const& before, QualityReport const& after) {
  QualityThresholds limits;
  auto const loosen = [](double& limit, double had, bool larger_is_worse) {
    if (larger_is_worse ? had > limit : had < limit) limit = had;
  };
  for (QualityRegion const* region : {&before.near_field, &before.far_field}) {
    if (region->cells == 0) continue;
    loosen(limits.cells.min_determinant, (*region)[Measure::determinant_3x3x3].min, false);
    loosen(limits.cells.min_angle_deg, (*region)[Measure::minimum_angle_deg].min, false);
    loosen(limits.cells.max_skewness, (*region)[Measure::equiangle_skewness].max, true);
  }
  return shortfalls(after, std::nullopt, limits);
}

/// Says what the filled mesh falls short of, and which status that is.
int conclude(Terminal& terminal, nlohmann::json json, std::vector<Shortfall> const& list) {
  auto& texts = json["shortfalls"] = nlohmann::json::array();
  for (Shortfall const& s : list)
    texts.push_back(
        {{"severity", s.severity == Shortfall::Severity::failure ? "failure" : "warning"}, {"message", s.message}});
  terminal.document(json);
  for (Shortfall const& s : list) terminal.warn(s.message);
  return status_of_morph(true, any_failure(list));
}

/// Says so, and what would change that.
int refuse(CommandLine const& options, Terminal& terminal, QualityReport const& quality, std::string const& remedy) {
  terminal.say(format_table(quality));
  terminal.error(fmt::format("{} was not written: {} cells are inverted{}", options.output->string(),
                             quality.far_field.inverted + quality.near_field.inverted, remedy));
  return not_written;
}

std::string remedy_of(FilletResult const& result) {
  return fmt::format(
      ", with {} layers off the blade and {} off the end wall; give a smaller radius, other --blade-layers and "
      "--wall-layers, or a longer --run-out",
      result.layers.old[0], result.layers.old[1]);
}

/// What helps elements, most often too coarse ones: nodes beyond the fillet stay.
std::string remedy_of(ElementFillet const& result) {
  return fmt::format(
      "; three cells along either wall at least have to be within the radius of the corner{}: give a larger radius, "
      "finer cells, or a longer --run-out",
      result.cut_elements > 0 ? fmt::format(" (there are {} off the blade and {} off the end wall)",
                                            result.layers.old[0], result.layers.old[1])
                              : std::string());
}

void throw_if_any(std::vector<std::string> const& problems) {
  Problems all;
  for (auto const& problem : problems) all.add(problem);
  all.throw_if_any<MeshError>();
}

bool any_inverted(QualityReport const& quality) { return quality.far_field.inverted + quality.near_field.inverted > 0; }

/// Blocks whose layers meet in a mitre stay; their nodes move as those of hexahedra do.
int move_blocks(CommandLine const& options, Terminal& terminal, Mesh const& mesh, FilletOptions const& wanted) {
  Stopwatch watch;
  Mesh const hexahedra = as_hexahedra(mesh);
  UnstructuredTopology const topology = make_topology(hexahedra);
  ElementFillet const result = make_fillet(hexahedra, topology, find_face_patches(hexahedra, topology), wanted);
  double const seconds = watch.lap();
  terminal.progress("measuring quality");
  LoadedMesh const before(mesh);
  Coordinates const& morphed = result.mesh.coordinates;
  QualityReport const quality = before.measure({.morphed = &morphed});
  if (any_inverted(quality)) return refuse(options, terminal, quality, remedy_of(result));
  terminal.progress("writing " + options.output->string());
  before.write(options.input, *options.output, morphed, {});
  terminal.say(facts_text(result) +
               fmt::format("layers of both walls meet in a mitre already: blocks stay, nodes move\n"
                           "zones {}, cells {}, nodes {}; {:.2f} s\n\n",
                           mesh.zones.size(), mesh.n_cells(), mesh.n_nodes(), seconds) +
               format_table(quality) + fmt::format("\nwrote {}\n", options.output->string()));
  nlohmann::json json = document(options, result, quality);
  json["zones"] = mesh.zones.size();
  json["cells"] = mesh.n_cells();
  return conclude(terminal, std::move(json), shortfalls_of(before.measure({}), before.measure({.morphed = &morphed})));
}

int fill_blocks(CommandLine const& options, Terminal& terminal) {
  Mesh mesh = load_mesh(options.input, {}, options.leave_out);
  if (mesh.dimension != 3)
    throw MeshError(options.input.string() + ": a mesh of two dimensions has no corners to fill");
  Stopwatch watch;
  terminal.progress("filling corners");
  Links const links = connect_and_check(mesh, options.topology);
  FilletOptions const wanted = options_of(options, mesh);
  if (!meet_in_corners(mesh, wanted.blade, wanted.end_wall)) return move_blocks(options, terminal, mesh, wanted);
  FilletResult const result = make_fillet(mesh, links, wanted);
  double const seconds = watch.lap();

  terminal.progress("checking connections, measuring quality");
  LoadedMesh const after(result.split.mesh);
  Mesh checked = after.mesh();
  (void)connect_and_check(checked, options.topology);
  QualityReport const quality = after.measure({});
  if (any_inverted(quality)) return refuse(options, terminal, quality, remedy_of(result));
  terminal.progress("writing " + options.output->string());
  write_mesh(options.output->string(), after.mesh());
  terminal.say(summary_text(result, mesh, seconds) + format_table(quality) +
               fmt::format("\nwrote {}\n", options.output->string()));
  nlohmann::json json = document(options, result, quality);
  json["layers"]["made"] = result.layers.made;
  json["wall_deviation"] = result.wall_deviation;
  json["zones"] = result.split.mesh.zones.size();
  json["cells"] = result.split.mesh.n_cells();
  return conclude(terminal, std::move(json), shortfalls_of(LoadedMesh(mesh).measure({}), quality));
}

int fill_elements(CommandLine const& options, Terminal& terminal) {
  LoadedMesh const before(options.input, {}, options.leave_out);
  Mesh const& mesh = before.mesh();
  if (mesh.dimension != 3)
    throw MeshError(options.input.string() + ": a mesh of two dimensions has no corners to fill");
  throw_if_any(before.problems());
  Stopwatch watch;
  terminal.progress("filling corners");
  ElementFillet const result =
      make_fillet(mesh, before.indexed().topology(), before.indexed().face_patches(), options_of(options, mesh));
  double const seconds = watch.lap();

  terminal.progress("checking the elements, measuring quality");
  LoadedMesh const after(result.mesh);
  throw_if_any(after.problems());
  QualityReport const quality = after.measure({});
  if (any_inverted(quality)) return refuse(options, terminal, quality, remedy_of(result));
  terminal.progress("writing " + options.output->string());
  if (result.cut_elements > 0)
    write_mesh(options.output->string(), result.mesh);
  else  // with all that the file has beside coordinates
    before.write(options.input, *options.output, result.mesh.coordinates, {});
  terminal.say(summary_text(result, mesh, seconds) + format_table(quality) +
               fmt::format("\nwrote {}\n", options.output->string()));
  nlohmann::json json = document(options, result, quality);
  json["elements"] = result.mesh.n_elements();
  json["cut_elements"] = result.cut_elements;
  return conclude(terminal, std::move(json), shortfalls_of(before.measure({}), quality));
}

}  // namespace

int run_fillet_command(CommandLine const& options, Terminal& terminal) {
  MeshSource const file = look_at(options.input, options.leave_out);
  check_run_files(inputs_of_mesh(file), {{"mesh", *options.output}});
  terminal.progress("reading " + options.input.string());
  return file.kind == MeshKind::structured ? fill_blocks(options, terminal) : fill_elements(options, terminal);
}

}  // namespace gridmorph::cli
