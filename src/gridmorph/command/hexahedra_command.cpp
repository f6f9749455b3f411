#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/case/side_file.hpp>
#include <gridmorph/command/commands.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/run/run_files.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <string>
#include <utility>

namespace gridmorph::cli {

int run_hexahedra_command(CommandLine const& options, Terminal& terminal) {
  MeshSource const file = look_at(options.input, options.leave_out);
  if (file.kind != MeshKind::structured)
    throw ConfigError(options.input.string() + ": is a mesh of elements already; `gridmorph morph` takes it as it is");
  check_run_files(inputs_of_mesh(file), {{"mesh", *options.output}});
  std::string const output = options.output->string();
  auto const format = format_of_ending(output);
  if (format != "CGNS" && format != "VTK")
    throw ConfigError(fmt::format("output '{}': the ending says what is written, .cgns or .vtu", output));
  terminal.progress("reading " + options.input.string());
  Mesh blocks = load_mesh(options.input, {}, options.leave_out);
  (void)connect_and_check(blocks, options.topology);
  Mesh const mesh = as_hexahedra(blocks);
  terminal.progress("writing " + output);
  if (format == "VTK")
    write_vtk(output, mesh, mesh.coordinates);
  else
    write_mesh(output, mesh);
  terminal.say(fmt::format("wrote {}: {} hexahedra, {} nodes, {} patches, {} connections\n", output, mesh.n_elements(),
                           mesh.n_nodes(), mesh.patches.size(), mesh.connections.size()));
  terminal.document({{"gridmorph", GRIDMORPH_VERSION},
                     {"input", options.input.string()},
                     {"output", output},
                     {"hexahedra", mesh.n_elements()},
                     {"nodes", mesh.n_nodes()},
                     {"patches", mesh.patches.size()},
                     {"connections", mesh.connections.size()}});
  return done;
}

}  // namespace gridmorph::cli
