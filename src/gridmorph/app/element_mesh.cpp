#include <gridmorph/app/casefile/side_file.hpp>
#include <gridmorph/app/element_mesh.hpp>
#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/boundary/contradicted_periodics.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/file_kind.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/undeclared_connections.hpp>
#include <gridmorph/quality/certificate.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace gridmorph::cli {

namespace {

constexpr std::array element_fields{Measure::aspect_ratio, Measure::determinant_3x3x3, Measure::minimum_angle_deg,
                                    Measure::equiangle_skewness, Measure::relative_displacement};

}  // namespace

KindTraits const& ElementMesh::traits() {
  static KindTraits const traits{.cells = "elements",
                                 .planning = "finding wrap and layers, making the background mesh, locating nodes",
                                 .lost = "elements had lost four fifths of their determinant or more",
                                 .change = "change [near_field], set steps",
                                 .change_many = "[near_field] or [boundary_layer]",
                                 .costs = {25, 40, 1, 2, 8, 10, 15}};
  return traits;
}

ElementMesh::ElementMesh(std::filesystem::path const& path, std::optional<std::filesystem::path> const& side_file,
                         std::vector<std::string> const& leave_out)
    : ElementMesh(load_mesh(path, side_file, leave_out)) {}

ElementMesh::ElementMesh(Mesh as_read)
    : mesh(std::move(as_read)),
      by_faces_(mesh.polyhedra.element.size() > 0 || mesh_format(mesh.source) == MeshFormat::openfoam) {
  if (is_scattered(mesh)) reorder(mesh, order_by_position(mesh));
  topology = make_topology(mesh);
  face_patches = find_face_patches(mesh, topology);
  problems = face_patches.problems;
  auto const volumes = volume_signs(mesh);
  signs = numbering_signs(mesh, topology.sides, volumes);
  for (auto const& negative : negative_elements(mesh, volumes))
    remarks.push_back(mesh.source + ": " + describe(mesh, negative));
  if (Vec3 const up = plane_normal(mesh);
      mesh.dimension == 2 && std::max({std::fabs(up.x), std::fabs(up.y), std::fabs(up.z)}) != 1)
    problems.push_back(mesh.source + ": is 2-D but does not lie in a plane x, y or z = constant; turn it into one");
  // As for connections of a file.
  double const tolerance = place_tolerance(1e-6, mesh.size(), coordinate_resolution(mesh));
  for (auto const& pair : undeclared_connections(mesh, tolerance))
    mesh.notes.push_back(mesh.source + ": " + describe(mesh, pair));
}

std::vector<std::string> ElementMesh::notes() const {
  auto out = mesh.notes;
  out.insert(out.end(), face_patches.notes.begin(), face_patches.notes.end());
  auto const contradicted = contradicted_periodics(mesh, mesh.size());
  out.insert(out.end(), contradicted.begin(), contradicted.end());
  return out;
}

QualityReport ElementMesh::measure(QualityWanted const& wanted) const {
  UnstructuredQualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(wanted.morphed != nullptr ? *wanted.morphed : mesh.coordinates);
  if (wanted.morphed != nullptr) input.baseline = views(mesh.coordinates);
  input.near_field = wanted.near.cells;
  std::set<int> walls(wanted.near.walls.begin(), wanted.near.walls.end());
  for (int p = 0; p < int(mesh.patches.size()); ++p)
    if (mesh.patches[std::size_t(p)].kind == PatchKind::wall) walls.insert(p);
  input.walls.assign(walls.begin(), walls.end());
  input.signs = signs;
  input.limits = wanted.limits;
  input.fast = wanted.fast;
  input.regions = wanted.regions.elements;
  input.faces = by_faces_;
  if (wanted.fields != nullptr)
    input.fields =
        fields_of(*wanted.fields, wanted.measures.empty() ? std::span<Measure const>(element_fields) : wanted.measures,
                  mesh.n_elements());
  Kokkos::DefaultHostExecutionSpace const exec;
  QualityReport report = measure_quality(exec, mesh, topology, face_patches, input);
  if (wanted.morphed != nullptr)
    report.certificate = certify(exec, mesh, topology, {input.coordinates, input.baseline, {}, signs});
  return report;
}

Coordinates ElementMesh::coordinates_of(std::filesystem::path const& path,
                                        std::vector<std::string> const& leave_out) const {
  if (look_at(path, leave_out).kind != MeshKind::unstructured)
    throw MeshError(fmt::format("'{}' is unstructured and '{}' is not; compare a mesh with its own baseline",
                                mesh.source, path.string()));
  ReadOptions options;
  options.leave_out = leave_out;
  Mesh other = read_mesh(path.string(), options);
  bool same = mesh.zones.size() == other.zones.size();
  for (std::size_t z = 0; same && z < mesh.zones.size(); ++z)
    same = mesh.zones[z].size() == other.zones[z].size() && mesh.zones[z].n_elements == other.zones[z].n_elements;
  if (same) {
    if (!mesh.file_order.element.empty()) reorder(other, {node_places(mesh), mesh.file_order.element});
    same = mesh.elements.type == other.elements.type && mesh.elements.nodes.item == other.elements.nodes.item;
  }
  if (!same)
    throw MeshError(
        fmt::format("'{}' ({} nodes, {} elements) and '{}' ({} nodes, {} elements) are not the same mesh; "
                    "compare a mesh with its own baseline",
                    mesh.source, mesh.n_nodes(), mesh.n_elements(), other.source, other.n_nodes(), other.n_elements()));
  return other.coordinates;
}

void ElementMesh::match(MatchOptions const& /*options*/) {
  throw MeshError(mesh.source + ": is an unstructured mesh; --match and --write-side-file are for structured ones");
}

PatchesAsSurface ElementMesh::surface(std::vector<std::string> const& selectors, bool as_facets, int split) const {
  auto const patches = select_patches(mesh, selectors);
  PatchesAsSurface out;
  out.patches = patches.size();
  if (!as_facets) {
    auto const representative = coincident_nodes(mesh);
    Boundary const boundary(mesh, topology, face_patches);
    std::vector<Index32> nodes;
    for (int const p : patches)
      for (Index const n : boundary.surface(p).nodes) nodes.push_back(representative[std::size_t(n)]);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (Index32 const n : nodes) out.nodes.push_back(mesh.coordinates[n]);
    return out;
  }
  if (mesh.dimension == 2)
    throw ConfigError(mesh.source + ": is 2-D, its boundary has no facets; write its nodes (--output NAME.csv)");
  if (split != 1)
    throw ConfigError("--split cuts the quadrilaterals of structured meshes; leave it out for an unstructured one");
  auto const& boundary = topology.boundary;
  for (Index f = 0; f < boundary.size(); ++f) {
    if (std::find(patches.begin(), patches.end(), face_patches.patch[std::size_t(f)]) == patches.end()) continue;
    auto const face = boundary.nodes[f];
    int const first = int(out.facets.points.size());
    for (Index32 const n : face) out.facets.points.push_back(mesh.coordinates[n]);
    for (int k = 2; k < int(face.size()); ++k) out.facets.triangles.push_back({first, first + k, first + k - 1});
  }
  return out;
}

}  // namespace gridmorph::cli
