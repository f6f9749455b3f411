#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_layout.hpp>
#include <gridmorph/io/file_check.hpp>
#include <gridmorph/io/files_read.hpp>
#include <gridmorph/io/foam/foam_mesh.hpp>
#include <gridmorph/io/gmsh/gmsh_mesh.hpp>
#include <gridmorph/io/mesh_files.hpp>
#include <gridmorph/io/morphed_file.hpp>
#include <gridmorph/io/plot3d/plot3d.hpp>
#include <gridmorph/io/printable.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/io/su2/su2_file.hpp>
#include <gridmorph/io/ugrid/ugrid_file.hpp>
#include <gridmorph/io/vtk/blocks.hpp>
#include <gridmorph/io/vtk/pieces.hpp>
#include <gridmorph/io/vtk/vtk_mesh.hpp>
#include <gridmorph/mesh/coincident_pairs.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>
#include <type_traits>

namespace gridmorph {

namespace {

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

bool has_control(std::string const& name) { return std::any_of(name.begin(), name.end(), is_control); }

/// Control characters in names of patches, families, connections and subsets become '?', with a note: on a terminal a
/// line feed in a name would begin a line of its own that looks like one of ours. Throws IoError for zones named so,
/// which writers find by their name.
void make_names_printable(Mesh& mesh) {
  for (Zone const& zone : mesh.zones)
    if (has_control(zone.name))
      throw IoError(mesh.source + ": the name of zone '" + io::printable(zone.name) +
                    "' holds control characters, shown as '?'; rename the zone");
  Index changed = 0;
  auto const make = [&](std::string& name) {
    if (!has_control(name)) return;
    std::replace_if(name.begin(), name.end(), is_control, '?');
    ++changed;
  };
  for (Patch& patch : mesh.patches) {
    make(patch.name);
    make(patch.bc_type);
    for (auto& family : patch.families) make(family);
  }
  for (auto& interface : mesh.interfaces) {
    make(interface.name);
    for (auto& family : interface.families) make(family);
  }
  for (auto& connection : mesh.connections) {
    make(connection.name);
    for (auto& family : connection.families) make(family);
  }
  for (auto& family : mesh.families) make(family);
  for (Subset& subset : mesh.subsets) make(subset.name);
  if (changed > 0)
    mesh.notes.push_back(mesh.source + ": " + std::to_string(changed) +
                         " names hold control characters, such as line feeds; they stand as '?' here, and a case file "
                         "names them so");
}

/// The kind of mesh in a CGNS file: unstructured where one zone is.
MeshKind kind_of(cgns::File const& file, cgns::Node const& tree, std::vector<std::string> const& leave_out) {
  for (auto const* base : tree.all("CGNSBase_t"))
    for (auto const* zone : base->all("Zone_t"))
      if (!cgns::is_left_out(leave_out, base->name, zone->name) && zone_type(file, *zone) == "Unstructured")
        return MeshKind::unstructured;
  return MeshKind::structured;
}

void collect_linked(cgns::Node const& node, std::set<std::string>& files) {
  if (!node.file.empty()) files.insert(node.file);
  for (auto const& child : node.children) collect_linked(child, files);
}

/// Files of one mesh, without names for parts of it.
template <class Read>
Mesh read_without_names(std::string const& path, char const* format, ReadOptions const& options, Read const& read) {
  if (!options.leave_out.empty())
    throw IoError(path + ": leave_out is for CGNS files, which name bases and zones; remove it for " + format);
  if constexpr (std::is_invocable_v<Read, std::string const&>)
    return read(path);
  else
    return read(path, options);
}

Mesh read_as_named(std::string const& path, ReadOptions const& options) {
  // A side file that says which variant of PLOT3D a file is knows it better than its first bytes.
  bool const guess = options.plot3d_format.empty();
  switch (guess ? mesh_format(path) : cgns::is_cgns(path) ? MeshFormat::cgns : MeshFormat::plot3d) {
    case MeshFormat::su2: return read_without_names(path, "an SU2 mesh", options, su2::read);
    case MeshFormat::openfoam: return read_without_names(path, "an OpenFOAM mesh", options, foam::read);
    case MeshFormat::gmsh: return read_without_names(path, "a Gmsh mesh", options, gmsh::read);
    case MeshFormat::vtk: return read_without_names(path, "a VTK mesh", options, vtk::read);
    case MeshFormat::ugrid: return read_without_names(path, "a UGRID mesh", options, ugrid::read);
    case MeshFormat::plot3d: return read_without_names(path, "a PLOT3D mesh", options, plot3d::read);
    case MeshFormat::cgns: break;
  }
  cgns::File const file(path, cgns::File::Mode::read);
  auto const tree = file.tree();
  return kind_of(file, tree, options.leave_out) == MeshKind::structured ? io::read_blocks(file, tree, options)
                                                                        : io::read_elements(file, tree, options);
}

/// Files that a mesh consists of beside the one that is named, but for those of links.
std::vector<std::string> other_files(std::string const& path, MeshFormat format) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  if (format == MeshFormat::openfoam) files = foam::files_of(path);
  if (format == MeshFormat::ugrid) files = {ugrid::mapbc_of(path)};
  if (format == MeshFormat::vtk) {
    std::string const head = io::read_head(path);
    if (vtk::is_parallel(head)) files = vtk::files_of_pieces(path);
    if (vtk::is_blocks(head)) files = vtk::files_of_blocks(path);
  }
  std::vector<std::string> out;
  for (auto const& file : files)
    if (std::filesystem::exists(file, ignored)) out.push_back(file.string());
  return out;
}

}  // namespace

std::string_view to_string(FileFormat format) { return format == FileFormat::cgns_hdf5 ? "CGNS/HDF5" : "CGNS/ADF"; }

MeshFileFacts look_at_mesh(std::string const& path, std::vector<std::string> const& leave_out) {
  MeshFileFacts out;
  out.format = mesh_format(path);
  if (out.format != MeshFormat::plot3d) out.kind = MeshKind::unstructured;
  if (out.format == MeshFormat::cgns) {
    cgns::File const file(path, cgns::File::Mode::read);
    auto const tree = file.tree();
    std::set<std::string> linked;
    collect_linked(tree, linked);
    out.linked.assign(linked.begin(), linked.end());
    out.kind = kind_of(file, tree, leave_out);
  } else {
    out.linked = other_files(path, out.format);
  }
  io::FilesRead::note(path);
  for (auto const& file : out.linked) io::FilesRead::note(file);
  return out;
}

std::vector<std::string> files_to_write(std::string const& input, std::string const& output,
                                        std::vector<double> const& times) {
  std::vector<std::filesystem::path> files{output};
  MeshFormat const format = mesh_format(input);
  if (format == MeshFormat::openfoam) {
    auto const more = foam::files_to_write(input, output, times);
    files.insert(files.end(), more.begin(), more.end());
  }
  if (format == MeshFormat::vtk)
    for (auto const& file : vtk::files_beside(input, output)) files.push_back(file);
  std::vector<std::string> out;
  for (auto const& file : files) out.push_back(file.string());
  return out;
}

MeshKind mesh_kind(std::string const& path, std::vector<std::string> const& leave_out) {
  return look_at_mesh(path, leave_out).kind;
}

Mesh read_mesh(std::string const& path, ReadOptions const& options) {
  Mesh mesh = read_as_named(path, options);
  make_names_printable(mesh);
  if (Index const unused = leave_out_unused_nodes(mesh); unused > 0)
    mesh.notes.push_back(path + ": " + std::to_string(unused) + (unused == 1 ? " node belongs" : " nodes belong") +
                         " to no element of the mesh and " +
                         (unused == 1 ? "stays where it is" : "stay where they are"));
  // Nodes in text have six digits and more.
  constexpr double same_place = 1e-5;
  pair_middle_nodes(mesh, same_place * mesh.size());
  return mesh;
}

NodesOfFile io::nodes_of_file(std::string const& path, Mesh const& mesh) {
  NodesOfFile out;
  if (mesh_format(path) != MeshFormat::cgns) {
    Mesh const all = read_as_named(path, {});
    for (Zone const& zone : all.zones) out.n_nodes.push_back(zone.size());
    out.coordinates = all.coordinates;
    return out;
  }
  cgns::File const file(path, cgns::File::Mode::read);
  auto const tree = file.tree();
  auto const layout = cgns::zones_of(file, tree, mesh);
  Index n_nodes = 0;
  for (auto const& zone : layout.zones) n_nodes += out.n_nodes.emplace_back(zone.nodes_in_file());
  out.coordinates = io::read_coordinates(file, layout, n_nodes);
  return out;
}

}  // namespace gridmorph
