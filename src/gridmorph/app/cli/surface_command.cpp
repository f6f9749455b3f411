#include <gridmorph/app/casefile/side_file.hpp>
#include <gridmorph/app/cli/commands.hpp>
#include <gridmorph/app/cli/output_files.hpp>
#include <gridmorph/app/cli/run_files.hpp>
#include <gridmorph/app/cli/unstructured_mesh.hpp>
#include <gridmorph/boundary/boundary_outline.hpp>
#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/file_kind.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/surface/surface_io.hpp>
#include <gridmorph/io/unstructured_io.hpp>
#include <gridmorph/motion/motion.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

namespace gridmorph::cli {

namespace {

/// Facets and nodes of patches; `triangles` only where facets are asked for.
struct Surface {
  std::vector<Vec3> nodes;
  SurfaceTriangles facets;
  std::size_t patches = 0;
};

void refuse_too_many(Index facets) {
  constexpr Index most = 500'000'000;
  if (facets > most)
    throw ConfigError(fmt::format("the patches would give {} facets, more than {}; lower --split", facets, most));
}

Surface surface_of_blocks(CommandLine const& options, bool as_facets) {
  Mesh const mesh = load_mesh(options.input, {}, options.leave_out);
  std::vector<int> const patches = select_patches(mesh, options.patches);
  Surface out;
  out.patches = patches.size();
  if (!as_facets) {
    out.nodes = PatchSurface(mesh, patches).points;
    return out;
  }
  Index facets = 0;
  for (int const p : patches) {
    IndexRange const& r = mesh.patches[p].range;
    Index cells = 1;
    for (int axis = 0; axis < 3; ++axis) cells *= std::max(1, r.extent(axis) - 1);
    facets += 2 * cells * options.split * options.split;
  }
  refuse_too_many(facets);
  out.facets = triangulate(mesh, patches, options.split);
  return out;
}

/// Normals point into the mesh, as those of structured patches do.
Surface surface_of_elements(CommandLine const& options, bool as_facets) {
  LoadedMesh const loaded = load_unstructured(options.input, {}, options.leave_out);
  auto const& mesh = loaded.mesh;
  auto const nodes_of_patch = nodes_of_patches(mesh, loaded.topology, loaded.face_patches);
  auto const patches = select_patches(boundary_outline(mesh, nodes_of_patch), options.patches);
  auto const wanted = [&](int p) { return std::find(patches.begin(), patches.end(), p) != patches.end(); };
  Surface out;
  out.patches = patches.size();
  if (!as_facets) {
    auto const representative = coincident_nodes(mesh);
    std::vector<Index32> nodes;
    for (int const p : patches)
      for (Index32 const n : nodes_of_patch[std::size_t(p)]) nodes.push_back(representative[std::size_t(n)]);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (Index32 const n : nodes) out.nodes.push_back(mesh.coordinates[n]);
    return out;
  }
  if (mesh.dimension == 2)
    throw ConfigError(options.input.string() +
                      ": is 2-D, its boundary has no facets; write its nodes (--output NAME.csv)");
  if (options.split != 1)
    throw ConfigError("--split cuts the quadrilaterals of structured meshes; leave it out for an unstructured one");
  auto const& boundary = loaded.topology.boundary;
  for (Index f = 0; f < boundary.size(); ++f) {
    if (!wanted(loaded.face_patches.patch[std::size_t(f)])) continue;
    auto const face = boundary.nodes[f];
    int const first = int(out.facets.points.size());
    for (Index32 const n : face) out.facets.points.push_back(mesh.coordinates[n]);
    for (int k = 2; k < int(face.size()); ++k) out.facets.triangles.push_back({first, first + k, first + k - 1});
  }
  return out;
}

/// Columns as `field` reads them, with displacements to fill in.
std::string csv_text(std::vector<Vec3> const& nodes) {
  std::string text = "x,y,z,dx,dy,dz\n";
  for (Vec3 const& p : nodes) fmt::format_to(std::back_inserter(text), "{},{},{},0,0,0\n", p.x, p.y, p.z);
  return text;
}

nlohmann::json document(CommandLine const& options, Surface const& surface) {
  return {{"gridmorph", GRIDMORPH_VERSION},
          {"input", options.input.string()},
          {"output", options.output->string()},
          {"patches", surface.patches},
          {"facets", surface.facets.triangles.size()},
          {"nodes", surface.nodes.size()}};
}

}  // namespace

int run_surface_command(CommandLine const& options, Terminal& terminal) {
  check_run_files(inputs_of_mesh(options.input), {{"surface", *options.output}});
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
  bool const elements = mesh_kind(options.input.string(), options.leave_out) == MeshKind::unstructured;
  Surface const surface = elements ? surface_of_elements(options, !nodes) : surface_of_blocks(options, !nodes);
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
