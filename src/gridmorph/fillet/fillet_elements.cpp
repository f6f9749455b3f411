#include <gridmorph/fillet/fillet_elements.hpp>

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/fillet/arc_patches.hpp>
#include <gridmorph/fillet/corner_lines.hpp>
#include <gridmorph/fillet/corners.hpp>
#include <gridmorph/geometry/smoothstep.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace gridmorph {

namespace {

/// Radii along a line: as asked for, less towards ends inside the mesh, which lie at edges of the blade.
std::vector<double> radii_along(JoinedElements const& elements, WallEdges const& edges, RootLine const& line,
                                FilletOptions const& options, std::vector<Index32>& open_ends) {
  std::size_t const n = line.places.size();
  std::vector<double> out, from_start(n, std::numeric_limits<double>::infinity()), to_end = from_start;
  for (int const end : {0, 1}) {
    if (line.closed || !faces_across_end(elements, edges, line, end).empty()) continue;
    auto& way = end == 0 ? from_start : to_end;
    auto const place = [&](std::size_t k) { return line.places[end == 0 ? k : n - 1 - k]; };
    double length = 0;
    for (std::size_t k = 0; k < n; ++k) {
      if (k > 0) length += distance(elements.position(place(k - 1)), elements.position(place(k)));
      way[end == 0 ? k : n - 1 - k] = length;
    }
    open_ends.push_back(place(0));
  }
  for (std::size_t k = 0; k < n; ++k) {
    double const radius = checked_radius(options, elements.position(line.places[k])), over = options.run_out * radius;
    out.push_back(over > 0 ? radius * smoothstep(std::min(from_start[k], to_end[k]) / over) : radius);
  }
  return out;
}

}  // namespace

ElementFillet make_fillet(Mesh const& mesh, UnstructuredTopology const& topology,
                          BoundaryFacePatches const& face_patches, FilletOptions const& options) {
  for (Index e = 0; e < mesh.n_elements(); ++e)
    if (mesh.elements.nodes[e].size() != mesh.elements.corners(e).size())
      throw MeshError(mesh.source + ": " + describe_element(mesh, e) +
                      " is of second order; fillets are made of elements of first order");
  JoinedElements const elements(mesh, topology);
  WallEdges const edges(elements, face_patches, options.blade, options.end_wall);
  auto const lines = find_root_lines(elements, edges);
  CornerLattice const lattice(elements, edges);

  ElementFillet out;
  std::vector<std::vector<double>> radii;
  std::vector<Mitre> mitres;
  std::vector<CornerCell> cut;
  std::vector<Index32> open_ends;
  for (RootLine const& line : lines) {
    radii.push_back(radii_along(elements, edges, line, options, open_ends));
    mitres.push_back(find_mitre(lattice, edges, line, {radii.back(), options.layers}));
    cut.insert(cut.end(), mitres.back().cut.begin(), mitres.back().cut.end());
    for (std::size_t w = 0; w < 2; ++w) out.layers.old[w] = std::max(out.layers.old[w], mitres.back().layers[w]);
  }

  std::sort(open_ends.begin(), open_ends.end());
  out.open_ends = int(std::unique(open_ends.begin(), open_ends.end()) - open_ends.begin());

  Boundary const boundary(mesh, topology, face_patches);
  auto const blade = FacetSurface::from_facets(boundary.facets(options.blade));
  auto const end_wall = FacetSurface::from_facets(boundary.facets(options.end_wall));
  RootSections const sections(elements, face_patches, edges, lines, mitres, radii, blade, end_wall);
  for (auto const& line : sections.all())
    for (RootSection const& s : line)
      if (s.radius > 0) out.add_station(s.radius, s.half_arc / s.radius);
  std::vector<std::uint8_t> on_arc;
  Coordinates rounded = round_corners(elements, edges, sections, {&blade, &end_wall}, on_arc);
  out.mesh = cut.empty() ? mesh : cut_corners(lattice, cut);
  out.cut_elements = out.mesh.n_elements() - mesh.n_elements();
  out.mesh.coordinates = std::move(rounded);
  if (out.cut_elements > 0) separate_arcs(options, on_arc, out.mesh);
  return out;
}

}  // namespace gridmorph
