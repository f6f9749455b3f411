#include <generators/passage.hpp>
#include <generators/passage_section.hpp>
#include <generators/passage_zones.hpp>
#include <generators/spacing.hpp>
#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

using namespace passage;

int at_least(int minimum, double value) { return std::max(minimum, int(std::lround(value))); }

/// Cells at a linear scale, 1 being some 200,000 nodes; the span takes its own factor to meet the wanted number.
PassageCounts counts_at(double scale, double span_factor, CornerFractions const& corner) {
  PassageCounts c;
  double const half = 48 * scale;  // cells from leading to trailing edge on either side
  c.leading_upper = at_least(2, half * corner.leading_upper);
  c.leading_lower = at_least(2, half * corner.leading_lower);
  c.trailing_upper = at_least(2, half * corner.trailing_upper);
  c.trailing_lower = at_least(2, half * corner.trailing_lower);
  double const corners = corner.leading_upper + corner.leading_lower + corner.trailing_upper + corner.trailing_lower;
  c.side = at_least(6, half * (1 - 0.5 * corners));
  c.layers = at_least(6, 20 * scale);
  c.upper = c.lower = at_least(4, 12 * scale);
  c.inlet = at_least(5, 14 * scale);
  c.outlet = at_least(6, 18 * scale);
  c.span = at_least(8, 48 * scale * span_factor);
  return c;
}

Index nodes_of(PassageOptions const& options, PassageCounts const& counts) {
  Index n = 0;
  for (ZoneLayout const& zone : zone_layouts(options.layout, counts))
    n += Index(zone.cells[0] + 1) * (counts.span + 1) * (zone.cells[1] + 1);
  return n;
}

}  // namespace

PassageCounts passage_counts(PassageOptions const& options) {
  check(options);
  CornerFractions const corner = corner_fractions(options);
  double const guess = std::cbrt(double(options.nodes) / 200'000);
  PassageCounts best;
  double best_error = std::numeric_limits<double>::infinity();
  for (int s = -60; s <= 60; ++s)
    for (int f = -4; f <= 4; ++f) {
      PassageCounts const counts = counts_at(guess * (1 + 0.005 * s), 1 + 0.02 * f, corner);
      double const error = std::abs(double(nodes_of(options, counts)) / double(options.nodes) - 1) + 1e-4 * std::abs(f);
      if (error < best_error) {
        best_error = error;
        best = counts;
      }
    }
  return best;
}

Mesh make_passage(PassageOptions const& options) {
  PassageCounts const counts = passage_counts(options);
  double const pitch = 2 * std::numbers::pi / options.blades;
  RigidTransform const& placement = options.placement;

  Mesh mesh;
  mesh.source = "passage demo";
  // Lower periodic onto upper periodic, in the frame of the mesh.
  RigidTransform const turn = placement.inverse().then(rotation_about({0, 0, 0}, {1, 0, 0}, pitch)).then(placement);
  std::vector<ZoneLayout> const layouts = zone_layouts(options.layout, counts);
  add_zones(mesh, layouts, counts);
  add_patches(mesh, layouts, counts, options.left_handed);
  add_interfaces(mesh, layouts, counts, turn, placement.translation);

  mesh.coordinates = Coordinates(mesh.n_nodes());
  Annulus const annulus(options);
  SectionMesher section(options, counts);
  double const first = std::max(options.end_wall_first_cell,
                                0.5 * demo::first_of_geometric((counts.span + 1) / 2, options.end_wall_max_growth));
  std::vector<double> const spans = demo::tanh_spacing(counts.span, first);
  for (int station = 0; station <= counts.span; ++station) {
    double const span = spans[station], section_radius = annulus.section_radius(span);
    auto const& pieces = section(span);
    int const j = options.left_handed ? counts.span - station : station;
    for (int z = 0; z < int(layouts.size()); ++z)
      for (PiecePlace const& place : layouts[z].pieces) {
        PieceNodes const& nodes = pieces[place.piece];
        for (int k = 0; k < nodes.nk; ++k)
          for (int i = 0; i < nodes.ni; ++i)
            mesh.coordinates.set(mesh.zones[z].node({place.i + i, j, place.k + k}),
                                 placement(annulus.unroll(nodes.at(i, k), span, section_radius)));
      }
  }
  // Upper periodic nodes are rotated lower ones and nothing else, so the copies are exact.
  for (Interface1to1 const& connection : mesh.interfaces) {
    if (!connection.periodic || connection.range.begin[2] != 0) continue;
    IndexRange const& r = connection.range;
    for (int j = r.begin[1]; j < r.end[1]; ++j)
      for (int i = r.begin[0]; i < r.end[0]; ++i) {
        Vec3 const low = mesh.coordinates[mesh.zones[connection.zone].node({i, j, 0})];
        mesh.coordinates.set(mesh.zones[connection.donor_zone].node(connection.to_donor(Index3{i, j, 0})), turn(low));
      }
  }
  return mesh;
}

}  // namespace gridmorph
