#include <gridmorph/app/block_mesh.hpp>
#include <gridmorph/app/casefile/side_file.hpp>
#include <gridmorph/app/cli/output_files.hpp>
#include <gridmorph/boundary/find_interfaces.hpp>
#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/quality/certificate.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

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

}  // namespace

KindTraits const& BlockMesh::traits() {
  static KindTraits const traits{
      .cells = "cells",
      .planning = "connecting zones, applying rules, planning",
      .lost = "cells had corners whose scaled Jacobian was below 0.2 and half of what it was",
      .change =
          "leave order, priority and law out of [volume], so that they are looked for, change [boundary_layer], set "
          "smooth or retry = true in [guard]",
      .change_many = "[volume] or [boundary_layer]",
      .costs = {20, 20, 2, 8, 15, 35}};
  return traits;
}

BlockMesh::BlockMesh(std::filesystem::path const& path, std::optional<std::filesystem::path> const& side_file,
                     std::vector<std::string> const& leave_out)
    : mesh_(load_mesh(path, side_file, leave_out)) {}

std::vector<int> const& BlockMesh::handedness() const {
  if (handedness_.empty()) handedness_ = zone_handedness(Exec(), mesh_, views(mesh_.coordinates));
  return handedness_;
}

QualityReport BlockMesh::measure(QualityWanted const& wanted) const {
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(wanted.morphed != nullptr ? *wanted.morphed : mesh_.coordinates);
  if (wanted.morphed != nullptr) input.baseline = views(mesh_.coordinates);
  input.near_field = wanted.near.cells;
  // All walls: one that stays while its neighbours move can lose its first cells too.
  std::set<int> walls(wanted.near.walls.begin(), wanted.near.walls.end());
  for (int p = 0; p < int(mesh_.patches.size()); ++p)
    if (mesh_.patches[std::size_t(p)].kind == PatchKind::wall) walls.insert(p);
  input.walls = wall_faces(mesh_, std::vector<int>(walls.begin(), walls.end()));
  input.limits = wanted.limits;
  input.fast = wanted.fast;
  input.regions = wanted.regions.cells;
  input.handedness = handedness();
  if (wanted.fields != nullptr)
    input.fields = fields_of(
        *wanted.fields, wanted.measures.empty() ? std::span<Measure const>(block_fields) : wanted.measures, n_cells());
  QualityReport report = measure_quality(Exec(), mesh_, input);
  if (wanted.morphed != nullptr)
    report.certificate = certify(Exec(), mesh_, {input.coordinates, input.baseline, input.handedness});
  return report;
}

Coordinates BlockMesh::coordinates_of(std::filesystem::path const& path,
                                      std::vector<std::string> const& leave_out) const {
  ReadOptions options;
  options.leave_out = leave_out;
  Mesh const other = read_mesh(path.string(), options);
  check_same_zones(mesh_, other);
  return other.coordinates;
}

void BlockMesh::match(MatchOptions const& options) {
  FoundInterfaces const found = find_interfaces(mesh_, {.tolerance = options.tolerance, .periodic = options.periodic});
  int const periodic = int(std::count_if(found.interfaces.begin(), found.interfaces.end(),
                                         [](auto const& f) { return f.periodic.has_value(); }));
  mesh_.notes.push_back(
      fmt::format("{} interfaces found by matching points, {} of them periodic; largest distance {:.3g}",
                  found.interfaces.size(), periodic, found.mismatch));
  mesh_.notes.insert(mesh_.notes.end(), found.notes.begin(), found.notes.end());
  if (options.side_file) PendingFile(*options.side_file, side_file_text(mesh_, found, options.present)).commit();
  mesh_.interfaces.insert(mesh_.interfaces.end(), found.interfaces.begin(), found.interfaces.end());
}

PatchesAsSurface BlockMesh::surface(std::vector<std::string> const& selectors, bool as_facets, int split) const {
  std::vector<int> const patches = select_patches(mesh_, selectors);
  PatchesAsSurface out;
  out.patches = patches.size();
  if (!as_facets) {
    out.nodes = PatchSurface(Boundary(mesh_), patches).points;
    return out;
  }
  Index facets = 0;
  for (int const p : patches) {
    IndexRange const& r = mesh_.patches[std::size_t(p)].range;
    Index cells = 1;
    for (int axis = 0; axis < 3; ++axis) cells *= std::max(1, r.extent(axis) - 1);
    facets += 2 * cells * split * split;
  }
  constexpr Index most = 500'000'000;
  if (facets > most)
    throw ConfigError(fmt::format("the patches would give {} facets, more than {}; lower --split", facets, most));
  out.facets = triangulate(mesh_, patches, split);
  return out;
}

}  // namespace gridmorph::cli
