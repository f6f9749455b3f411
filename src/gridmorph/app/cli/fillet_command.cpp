#include <gridmorph/app/block_mesh.hpp>
#include <gridmorph/app/casefile/formula.hpp>
#include <gridmorph/app/casefile/side_file.hpp>
#include <gridmorph/app/cli/commands.hpp>
#include <gridmorph/app/cli/output_files.hpp>
#include <gridmorph/app/cli/run_files.hpp>
#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/fillet/fillet.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/report/quality_table.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <span>
#include <string>
#include <utility>

namespace gridmorph::cli {

namespace {

/// A number, or an expression of x, y, z.
std::function<double(Vec3 const&)> radius_of(std::string const& text) {
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

std::string summary_text(FilletResult const& result, Mesh const& before, double seconds) {
  Mesh const& after = result.split.mesh;
  std::string text = fmt::format(
      "fillet along {} nodes of the corner: radius {:.5g}{}, arcs of {:.1f} to {:.1f} degrees\n", result.stations,
      result.smallest_radius,
      result.largest_radius > result.smallest_radius ? fmt::format(" to {:.5g}", result.largest_radius) : std::string(),
      result.arc_angle_deg[0], result.arc_angle_deg[1]);
  text += fmt::format(
      "layers taken from the corner: {} off the blade, {} off the end wall; {} made of both\n"
      "moved wall nodes off the arc are {:.2g} from the walls as they were, at most\n",
      result.layers.old[0], result.layers.old[1], result.layers.made, result.wall_deviation);
  if (!result.first_cells_kept)
    text +=
        "note: first cells off the wall with fewer layers become smaller, all along it: the layers of the other wall "
        "do not fit otherwise\n";
  if (result.open_ends > 0)
    text += fmt::format(
        "note: the corner goes on where the blade ends, at {} nodes; the fillet runs out before them, and does not go "
        "around the "
        "edges of the blade\n",
        result.open_ends);
  text +=
      fmt::format("zones {} -> {}, cells {} -> {}, nodes {} -> {}; {:.2f} s\n\n", before.zones.size(),
                  after.zones.size(), before.n_cells(), after.n_cells(), before.n_nodes(), after.n_nodes(), seconds);
  return text;
}

nlohmann::json document(CommandLine const& options, FilletResult const& result, QualityReport const& quality) {
  return {
      {"gridmorph", GRIDMORPH_VERSION},
      {"input", options.input.string()},
      {"output", options.output->string()},
      {"stations", result.stations},
      {"radius", {result.smallest_radius, result.largest_radius}},
      {"arc_deg", {result.arc_angle_deg[0], result.arc_angle_deg[1]}},
      {"layers", {{"blade", result.layers.old[0]}, {"end_wall", result.layers.old[1]}, {"made", result.layers.made}}},
      {"wall_deviation", result.wall_deviation},
      {"open_ends", result.open_ends},
      {"zones", result.split.mesh.zones.size()},
      {"cells", result.split.mesh.n_cells()},
      {"quality", quality}};
}

}  // namespace

int run_fillet_command(CommandLine const& options, Terminal& terminal) {
  MeshSource const file = look_at(options.input, options.leave_out);
  if (file.kind != MeshKind::structured)
    throw ConfigError(
        options.input.string() +
        ": a fillet takes blocks out of a mesh, and this is one of elements; morph it with a rule \"formula\" or "
        "\"target\" instead");
  check_run_files(inputs_of_mesh(file), {{"mesh", *options.output}});
  terminal.progress("reading " + options.input.string());
  Mesh mesh = load_mesh(options.input, {}, options.leave_out);
  if (mesh.dimension != 3)
    throw MeshError(options.input.string() + ": a mesh of two dimensions has no corners to fill");
  Stopwatch watch;
  terminal.progress("filling corners");
  Links const links = connect_and_check(mesh, options.topology);
  FilletOptions wanted;
  wanted.blade = select_patches(mesh, options.patches);
  wanted.end_wall = select_patches(mesh, options.end_walls);
  wanted.radius = radius_of(options.radius);
  wanted.layers = {options.blade_layers, options.end_wall_layers};
  wanted.run_out = options.run_out;
  FilletResult const result = make_fillet(mesh, links, wanted);
  double const seconds = watch.lap();

  terminal.progress("checking connections, measuring quality");
  BlockMesh const after(result.split.mesh);
  Mesh checked = after.mesh();
  (void)connect_and_check(checked, options.topology);
  QualityReport const quality = after.measure({});
  Index const inverted = quality.far_field.inverted + quality.near_field.inverted;
  if (inverted > 0) {
    terminal.say(format_table(quality));
    terminal.error(
        fmt::format("{} was not written: {} cells are inverted, with {} layers off the blade and {} off the end wall; "
                    "give a smaller "
                    "radius, other --blade-layers and --wall-layers, or a longer --run-out",
                    options.output->string(), inverted, result.layers.old[0], result.layers.old[1]));
    return not_written;
  }
  terminal.progress("writing " + options.output->string());
  write_mesh(options.output->string(), after.mesh());
  terminal.say(summary_text(result, mesh, seconds) + format_table(quality) +
               fmt::format("\nwrote {}\n", options.output->string()));
  terminal.document(document(options, result, quality));
  return done;
}

}  // namespace gridmorph::cli
