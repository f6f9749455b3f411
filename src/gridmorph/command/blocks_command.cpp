#include <gridmorph/case/side_file.hpp>
#include <gridmorph/command/commands.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/run/elements_as_blocks.hpp>
#include <gridmorph/run/run_files.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace gridmorph::cli {

int run_blocks_command(CommandLine const& options, Terminal& terminal) {
  MeshSource const file = look_at(options.input, options.leave_out);
  if (file.kind == MeshKind::structured)
    throw ConfigError(options.input.string() + ": is a mesh of blocks already; `gridmorph morph` takes it as it is");
  check_run_files(inputs_of_mesh(file), {{"mesh", *options.output}});
  std::string const output = options.output->string();
  if (format_of_ending(output) != "CGNS")
    throw ConfigError(fmt::format("output '{}': blocks are written as CGNS, NAME.cgns", output));
  terminal.progress("reading " + options.input.string());
  Mesh elements = load_mesh(options.input, {}, options.leave_out);
  terminal.progress("looking for blocks");
  ElementsAsBlocks found(IndexedMesh(std::move(elements)), ElementsAsBlocks::Lines::any);
  if (!found.why_none().empty()) throw MeshError(found.why_none() + ", so that it is no mesh of blocks");
  Mesh const blocks = found.take_blocks();
  terminal.progress("writing " + output);
  write_mesh(output, blocks);
  auto const periodic = std::count_if(blocks.interfaces.begin(), blocks.interfaces.end(),
                                      [](Interface1to1 const& i) { return i.periodic.has_value(); });
  std::string list;
  for (Zone const& zone : blocks.zones)
    list += fmt::format("  {}: {} x {} x {}\n", zone.name, zone.extent[0], zone.extent[1], zone.extent[2]);
  terminal.say(fmt::format("wrote {}: {} blocks, {} cells, {} nodes, {} patches, {} interfaces ({} periodic)\n{}",
                           output, blocks.zones.size(), blocks.n_cells(), blocks.n_nodes(), blocks.patches.size(),
                           blocks.interfaces.size(), periodic, list));
  nlohmann::json zones = nlohmann::json::array();
  for (Zone const& zone : blocks.zones) zones.push_back({{"name", zone.name}, {"nodes", zone.extent}});
  terminal.document({{"gridmorph", GRIDMORPH_VERSION},
                     {"input", options.input.string()},
                     {"output", output},
                     {"blocks", std::move(zones)},
                     {"cells", blocks.n_cells()},
                     {"nodes", blocks.n_nodes()},
                     {"patches", blocks.patches.size()},
                     {"interfaces", blocks.interfaces.size()}});
  return done;
}

}  // namespace gridmorph::cli
