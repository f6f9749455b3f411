#include <gridmorph/command/commands.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/run/loaded_mesh.hpp>
#include <gridmorph/run/output_files.hpp>
#include <gridmorph/run/run_files.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <iterator>
#include <string>
#include <vector>

namespace gridmorph::cli {

namespace {

/// Columns as `field` reads them, with displacements to fill in.
std::string csv_text(std::vector<Vec3> const& nodes) {
  std::string text = "x,y,z,dx,dy,dz\n";
  for (Vec3 const& p : nodes) fmt::format_to(std::back_inserter(text), "{},{},{},0,0,0\n", p.x, p.y, p.z);
  return text;
}

nlohmann::json document(CommandLine const& options, PatchesAsSurface const& surface) {
  return {{"gridmorph", GRIDMORPH_VERSION},
          {"input", options.input.string()},
          {"output", options.output->string()},
          {"patches", surface.patches},
          {"facets", surface.facets.triangles.size()},
          {"nodes", surface.nodes.size()}};
}

}  // namespace

int run_surface_command(CommandLine const& options, Terminal& terminal) {
  MeshSource const file = look_at(options.input, options.leave_out);
  check_run_files(inputs_of_mesh(file), {{"surface", *options.output}});
  std::string const output = options.output->string();
  auto const format = format_of_ending(output);
  bool const nodes = format == "CSV";
  if (!nodes && format != "STL")
    throw ConfigError(fmt::format(
        "output '{}': the ending says what is written, .stl (facets) or .csv (nodes, as a rule \"field\" reads them)",
        output));
  if (nodes && (options.split != 1 || options.ascii))
    throw ConfigError("--split and --ascii are for STL; leave them out when nodes are written as CSV");
  terminal.progress("reading " + options.input.string());
  PatchesAsSurface const surface =
      LoadedMesh(file.path, {}, file.leave_out).surface(options.patches, !nodes, options.split);
  if (nodes) {
    PendingFile(*options.output, csv_text(surface.nodes)).commit();
    terminal.say(fmt::format("wrote {}: {} nodes of {} patches\n", output, surface.nodes.size(), surface.patches));
    terminal.document(document(options, surface));
    return done;
  }
  if (surface.facets.triangles.empty()) throw ConfigError("the patches have no facets with an area");
  write_stl(output, surface.facets, options.ascii ? StlFormat::ascii : StlFormat::binary);
  terminal.say(
      fmt::format("wrote {}: {} facets of {} patches\n", output, surface.facets.triangles.size(), surface.patches));
  terminal.document(document(options, surface));
  return done;
}

}  // namespace gridmorph::cli
