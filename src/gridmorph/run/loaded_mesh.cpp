#include <gridmorph/boundary/contradicted_periodics.hpp>
#include <gridmorph/boundary/find_interfaces.hpp>
#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/case/side_file.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/file_kind.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/undeclared_connections.hpp>
#include <gridmorph/run/loaded_mesh.hpp>
#include <gridmorph/run/output_files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <utility>

namespace gridmorph::cli {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

constexpr std::array block_fields{Measure::aspect_ratio,
                                  Measure::determinant_2x2x2,
                                  Measure::determinant_3x3x3,
                                  Measure::minimum_angle_deg,
                                  Measure::equiangle_skewness,
                                  Measure::growth_ratio,
                                  Measure::face_area_ratio,
                                  Measure::relative_displacement,
                                  Measure::relative_displacement_i,
                                  Measure::relative_displacement_j,
                                  Measure::relative_displacement_k};

constexpr std::array element_fields{Measure::aspect_ratio, Measure::determinant_3x3x3, Measure::minimum_angle_deg,
                                    Measure::equiangle_skewness, Measure::relative_displacement};

/// Room for measures as fields of an output mesh, for measure_quality() to fill.
CellFields<Kokkos::HostSpace> fields_of(std::vector<CellField>& out, std::span<Measure const> measures, Index n_cells) {
  CellFields<Kokkos::HostSpace> fields;
  out.clear();
  for (Measure const m : measures) {
    auto const unit = m == Measure::minimum_angle_deg ? FieldUnit::degree : FieldUnit::number;
    auto& values = out.emplace_back(CellField{field_name(m), std::vector<double>(std::size_t(n_cells)), unit}).values;
    fields[m] = Kokkos::View<double*, Kokkos::HostSpace>(values.data(), values.size());
  }
  return fields;
}

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

/// Elements in order by position, and what is to say of them.
Mesh in_order(Mesh mesh) {
  if (mesh.is_structured()) return mesh;
  if (is_scattered(mesh)) reorder(mesh, order_by_position(mesh));
  // As for connections of a file.
  double const tolerance = place_tolerance(1e-6, mesh.size(), coordinate_resolution(mesh));
  for (auto const& pair : undeclared_connections(mesh, tolerance))
    mesh.notes.push_back(mesh.source + ": " + describe(mesh, pair));
  return mesh;
}

/// Walls whose first cells are measured: all, since one that stays while its neighbours move can lose its first cells
/// too, and those that a near field names.
std::vector<int> measured_walls(Mesh const& mesh, NearCells const& near) {
  std::set<int> walls(near.walls.begin(), near.walls.end());
  for (int p = 0; p < int(mesh.patches.size()); ++p)
    if (mesh.patches[p].kind == PatchKind::wall) walls.insert(p);
  return {walls.begin(), walls.end()};
}

/// What both kinds of measure_quality() are given.
template <class Input>
Input quality_input(QualityWanted const& wanted, Mesh const& mesh, std::span<Measure const> all, Index n_cells) {
  Input input;
  input.coordinates = views(wanted.morphed != nullptr ? *wanted.morphed : mesh.coordinates);
  if (wanted.morphed != nullptr) input.baseline = views(mesh.coordinates);
  input.near_field = wanted.near.cells;
  input.limits = wanted.limits;
  input.fast = wanted.fast;
  if (wanted.fields != nullptr)
    input.fields = fields_of(*wanted.fields, wanted.measures.empty() ? all : wanted.measures, n_cells);
  return input;
}

PatchesAsSurface surface_of_blocks(Mesh const& mesh, std::vector<int> const& patches, bool as_facets, int split) {
  PatchesAsSurface out;
  out.patches = patches.size();
  if (!as_facets) {
    out.nodes = PatchSurface(Boundary(mesh), patches).points;
    return out;
  }
  Index facets = 0;
  for (int const p : patches) {
    IndexRange const& r = mesh.patches[p].range;
    Index cells = 1;
    for (int axis = 0; axis < 3; ++axis) cells *= std::max(1, r.extent(axis) - 1);
    facets += 2 * cells * split * split;
  }
  constexpr Index most = 500'000'000;
  if (facets > most)
    throw ConfigError(fmt::format("the patches would give {} facets, more than {}; lower --split", facets, most));
  out.facets = triangulate(mesh, patches, split);
  return out;
}

PatchesAsSurface surface_of_elements(IndexedMesh const& indexed, std::vector<int> const& patches, bool as_facets,
                                     int split) {
  Mesh const& mesh = indexed.mesh();
  PatchesAsSurface out;
  out.patches = patches.size();
  if (!as_facets) {
    auto const representative = coincident_nodes(mesh);
    Boundary const boundary = indexed.boundary();
    std::vector<Index32> nodes;
    for (int const p : patches)
      for (Index const n : boundary.surface(p).nodes) nodes.push_back(representative[n]);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (Index32 const n : nodes) out.nodes.push_back(mesh.coordinates[n]);
    return out;
  }
  if (mesh.dimension == 2)
    throw ConfigError(mesh.source + ": is 2-D, its boundary has no facets; write its nodes (--output NAME.csv)");
  if (split != 1)
    throw ConfigError("--split cuts the quadrilaterals of structured meshes; leave it out for an unstructured one");
  auto const& boundary = indexed.topology().boundary;
  for (Index f = 0; f < boundary.size(); ++f) {
    if (std::find(patches.begin(), patches.end(), indexed.face_patches().patch[f]) == patches.end()) continue;
    auto const face = boundary.nodes[f];
    int const first = int(out.facets.points.size());
    for (Index32 const n : face) out.facets.points.push_back(mesh.coordinates[n]);
    for (int k = 2; k < int(face.size()); ++k) out.facets.triangles.push_back({first, first + k, first + k - 1});
  }
  return out;
}

Coordinates coordinates_of_blocks(Mesh const& mesh, std::filesystem::path const& path,
                                  std::vector<std::string> const& leave_out) {
  ReadOptions options;
  options.leave_out = leave_out;
  Mesh const other = read_mesh(path.string(), options);
  check_same_zones(mesh, other);
  return other.coordinates;
}

Coordinates coordinates_of_elements(Mesh const& mesh, std::filesystem::path const& path,
                                    std::vector<std::string> const& leave_out) {
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

}  // namespace

std::string field_name(Measure measure) {
  std::string out;
  bool upper = true;
  for (char const c : to_string(measure)) {
    if (c != '_') out += upper && c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
    upper = c == '_';
  }
  return out;
}

KindTraits const& traits_of(MeshKind kind) {
  static KindTraits const blocks{
      .cells = "cells",
      .planning = "connecting zones, applying rules, planning",
      .lost = "cells had corners whose scaled Jacobian was below 0.2 and half of what it was",
      .change =
          "leave order, priority and law out of [volume], so that they are looked for, change [boundary_layer], set "
          "smooth = true in [guard]",
      .change_many = "[volume] or [boundary_layer]",
      .costs = {20, 20, 2, 8, 15, 35}};
  static KindTraits const elements{.cells = "elements",
                                   .planning = "finding wrap and layers, making the background mesh, locating nodes",
                                   .lost = "elements had lost four fifths of their determinant or more",
                                   .change = "change [near_field], set steps",
                                   .change_many = "[near_field] or [boundary_layer]",
                                   .costs = {25, 40, 1, 2, 8, 10, 15}};
  return kind == MeshKind::unstructured ? elements : blocks;
}

LoadedMesh::LoadedMesh(std::filesystem::path const& path, std::optional<std::filesystem::path> const& side_file,
                       std::vector<std::string> const& leave_out, bool find_blocks)
    : LoadedMesh(load_mesh(path, side_file, leave_out)) {
  if (find_blocks) take_blocks();
}

void LoadedMesh::take_blocks() {
  if (!may_have_blocks(mesh()) || !problems_.empty()) return;
  auto found = std::make_shared<ElementsAsBlocks>(std::move(indexed_), ElementsAsBlocks::Lines::long_ones);
  if (!found->why_none().empty()) return remark(found->why_none() + "; they are morphed as elements");
  *this = LoadedMesh(found->take_blocks());
  as_elements_ = std::move(found);
}

LoadedMesh::LoadedMesh(Mesh as_read)
    : indexed_(in_order(std::move(as_read))),
      problems_(indexed_.face_patches().problems),
      by_faces_(mesh().polyhedra.element.size() > 0 || mesh_format(mesh().source) == MeshFormat::openfoam) {
  if (is_structured() || mesh().dimension != 2) return;
  if (Vec3 const up = plane_normal(mesh()); std::max({std::fabs(up.x), std::fabs(up.y), std::fabs(up.z)}) != 1)
    problems_.push_back(mesh().source + ": is 2-D but does not lie in a plane x, y or z = constant; turn it into one");
}

std::vector<std::string> LoadedMesh::remarks() const {
  std::vector<std::string> out;
  if (is_structured()) return out;
  for (auto const& negative : negative_elements(mesh()))
    out.push_back(mesh().source + ": " + describe(mesh(), negative));
  return out;
}

std::vector<std::string> LoadedMesh::notes() const {
  auto out = mesh().notes;
  if (is_structured()) return out;
  auto const& faces = indexed_.face_patches().notes;
  out.insert(out.end(), faces.begin(), faces.end());
  out.insert(out.end(), added_notes_.begin(), added_notes_.end());
  auto const contradicted = contradicted_periodics(mesh(), mesh().size());
  out.insert(out.end(), contradicted.begin(), contradicted.end());
  return out;
}

QualityReport LoadedMesh::measure(QualityWanted const& wanted, Mesh const& patched) const {
  QualityReport report;
  std::vector<int> const walls = measured_walls(patched, wanted.near);
  if (is_structured()) {
    auto input = quality_input<QualityInput<Kokkos::HostSpace>>(wanted, patched, block_fields, n_cells());
    input.walls = wall_faces(patched, walls);
    input.regions = wanted.regions.cells;
    input.handedness = indexed_.handedness();
    report = measure_quality(Exec(), patched, input);
  } else {
    auto input = quality_input<UnstructuredQualityInput<Kokkos::HostSpace>>(wanted, patched, element_fields, n_cells());
    input.walls = walls;
    input.signs = indexed_.signs();
    input.regions = wanted.regions.elements;
    input.faces = by_faces_;
    report = measure_quality(Exec(), patched, indexed_.topology(), indexed_.face_patches(), input);
  }
  if (wanted.morphed != nullptr) report.certificate = certify(indexed_, *wanted.morphed);
  return report;
}

Coordinates LoadedMesh::coordinates_of(std::filesystem::path const& path,
                                       std::vector<std::string> const& leave_out) const {
  return is_structured() ? coordinates_of_blocks(mesh(), path, leave_out)
                         : coordinates_of_elements(mesh(), path, leave_out);
}

void LoadedMesh::match(MatchOptions const& options) {
  if (!is_structured())
    throw MeshError(mesh().source + ": is an unstructured mesh; --match and --write-side-file are for structured ones");
  FoundInterfaces const found = find_interfaces(mesh(), {.tolerance = options.tolerance, .periodic = options.periodic});
  Mesh matched = mesh();
  int const periodic = int(std::count_if(found.interfaces.begin(), found.interfaces.end(),
                                         [](auto const& f) { return f.periodic.has_value(); }));
  matched.notes.push_back(
      fmt::format("{} interfaces found by matching points, {} of them periodic; largest distance {:.3g}",
                  found.interfaces.size(), periodic, found.mismatch));
  matched.notes.insert(matched.notes.end(), found.notes.begin(), found.notes.end());
  if (options.side_file) PendingFile(*options.side_file, side_file_text(mesh(), found, options.present)).commit();
  matched.interfaces.insert(matched.interfaces.end(), found.interfaces.begin(), found.interfaces.end());
  complete(std::move(matched));
}

MeshSummary LoadedMesh::summary() const { return is_structured() ? summarize(mesh()) : summarize_elements(*this); }

std::string LoadedMesh::text(MeshSummary const& summary, std::string const& quality,
                             SnippetOptions const& options) const {
  return is_structured() ? inspect_text(summary, quality, options)
                         : inspect_elements_text(*this, summary, quality, options);
}

nlohmann::json LoadedMesh::json(MeshSummary const& summary, SnippetOptions const& options) const {
  return is_structured() ? inspect_json(summary, options) : inspect_elements_json(*this, summary, options);
}

PatchesAsSurface LoadedMesh::surface(std::vector<std::string> const& selectors, bool as_facets, int split) const {
  std::vector<int> const patches = select_patches(mesh(), selectors);
  return is_structured() ? surface_of_blocks(mesh(), patches, as_facets, split)
                         : surface_of_elements(indexed_, patches, as_facets, split);
}

std::unique_ptr<page::PictureMesh> LoadedMesh::pictures() const {
  return is_structured() ? page::picture_mesh(mesh(), indexed_.handedness())
                         : page::picture_mesh(mesh(), indexed_.topology(), indexed_.face_patches(), indexed_.signs());
}

MeshSource look_at(std::filesystem::path const& path, std::vector<std::string> const& leave_out) {
  return {look_at_mesh(path.string(), leave_out), path, leave_out};
}

}  // namespace gridmorph::cli
