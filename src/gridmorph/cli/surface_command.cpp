#include <gridmorph/casefile/side_file.hpp>
#include <gridmorph/cli/commands.hpp>
#include <gridmorph/cli/run_files.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/surface_io.hpp>
#include <gridmorph/motion/motion.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace gridmorph::cli {

int run_surface_command(CommandLine const& options, Terminal& terminal) {
  check_run_files(inputs_of_mesh(options.input), {{"output", *options.output}});
  terminal.progress("reading " + options.input.string());
  Mesh const mesh = load_mesh(options.input);
  std::vector<int> const patches = select_patches(mesh, options.patches);
  Index facets = 0;
  for (int const p : patches) {
    IndexRange const& r = mesh.patches[p].range;
    Index cells = 1;
    for (int axis = 0; axis < 3; ++axis) cells *= std::max(1, r.extent(axis) - 1);
    facets += 2 * cells * options.split * options.split;
  }
  constexpr Index most = 500'000'000;
  if (facets > most)
    throw ConfigError(fmt::format("the patches would give {} facets, more than {}; lower --split", facets, most));
  SurfaceTriangles const surface = triangulate(mesh, patches, options.split);
  if (surface.triangles.empty()) throw ConfigError("the patches have no facets with an area");
  write_stl(options.output->string(), surface, options.ascii ? StlFormat::ascii : StlFormat::binary);
  terminal.say(fmt::format("wrote {}: {} facets of {} patches\n", options.output->string(), surface.triangles.size(),
                           patches.size()));
  return done;
}

}  // namespace gridmorph::cli
