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
PassageCounts counts_at(double scale, double span_factor, CornerFractions const& corner, BladeTip tip) {
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
  if (tip == BladeTip::none) return c;
  c.gap = at_least(4, 14 * scale);
  c.cavity = tip == BladeTip::flat ? 0 : at_least(4, 12 * scale);
  c.rim = at_least(4, 16 * scale);
  c.span += c.gap + c.cavity;
  // The core has as many cells at the one end as at the other.
  int const more = c.leading_upper + c.leading_lower - c.trailing_upper - c.trailing_lower;
  (more > 0 ? c.trailing_upper : c.leading_upper) += std::abs(more) / 2;
  (more > 0 ? c.trailing_lower : c.leading_lower) += (std::abs(more) + 1) / 2;
  return c;
}

/// Stations along the span, clustered at hub and case, and at the tip and the floor of what is cut into it.
std::vector<double> span_stations(PassageOptions const& options, PassageCounts const& c) {
  auto const first_of = [&](int cells, double height) {
    return std::max(options.end_wall_first_cell / height,
                    0.5 * demo::first_of_geometric((cells + 1) / 2, options.end_wall_max_growth));
  };
  if (options.tip == BladeTip::none) return demo::tanh_spacing(c.span, first_of(c.span, 1));
  std::vector<double> stations;
  auto const append = [&](std::vector<double> const& part, double from, double to) {
    for (double const t : part)
      if (t > 0 || stations.empty()) stations.push_back(t == 1 ? to : from + t * (to - from));
  };
  double const tip = 1 - options.tip_gap, floor = c.cavity > 0 ? tip - options.tip_depth : tip;
  int const below = c.span - c.gap - c.cavity;
  double const in_gap = first_of(c.gap, options.tip_gap);
  double const in_cavity = c.cavity > 0 ? first_of(c.cavity, options.tip_depth) : 0;
  double const next = c.cavity > 0 ? in_cavity * options.tip_depth : in_gap * options.tip_gap;
  append(demo::two_sided_spacing(below, first_of(below, floor), next / floor), 0, floor);
  if (c.cavity > 0) append(demo::tanh_spacing(c.cavity, in_cavity), floor, tip);
  append(demo::tanh_spacing(c.gap, in_gap), tip, 1);
  return stations;
}

}  // namespace

void set_first_cells(PassageOptions& options, double share_of_span) {
  if (!(share_of_span > 0 && share_of_span < 0.01))
    throw ConfigError("passage: the first cells are " + std::to_string(share_of_span) +
                      " of the span; they must be more than 0 and less than 0.01");
  Annulus const annulus(options);
  double const height = annulus.section_radius(1) - annulus.section_radius(0);
  options.end_wall_first_cell = share_of_span;
  options.first_cell = share_of_span * height / options.sections[1].chord;
  // Growth as it has to be: what is asked for stands.
  constexpr double any = 1000;
  options.max_growth = options.end_wall_max_growth = any;
}

PassageCounts passage_counts(PassageOptions const& options) {
  check(options);
  CornerFractions const corner = corner_fractions(options);
  double const guess = std::cbrt(double(options.nodes) / 200'000);
  PassageCounts best;
  double best_error = std::numeric_limits<double>::infinity();
  for (int s = -60; s <= 60; ++s)
    for (int f = -4; f <= 4; ++f) {
      PassageCounts const counts = counts_at(guess * (1 + 0.005 * s), 1 + 0.02 * f, corner, options.tip);
      double const nodes = double(PassageLayout(options, counts).n_nodes());
      double const error = std::abs(nodes / double(options.nodes) - 1) + 1e-4 * std::abs(f);
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
  PassageLayout const layout(options, counts);
  add_zones(mesh, layout);
  add_patches(mesh, layout);
  add_interfaces(mesh, layout, turn, placement.translation);

  mesh.coordinates = Coordinates(mesh.n_nodes());
  Annulus const annulus(options);
  SectionMesher section(options, counts);
  std::vector<double> const spans = span_stations(options, counts);
  for (int station = 0; station <= counts.span; ++station) {
    double const span = spans[station], section_radius = annulus.section_radius(span);
    auto const& pieces = section(span);
    for (std::size_t z = 0; z < layout.zones.size(); ++z) {
      ZoneLayout const& zone = layout.zones[z];
      if (station < zone.bottom || station > zone.top) continue;
      int const j = layout.j_of(zone, station);
      for (PiecePlace const& place : zone.pieces) {
        PieceNodes const& nodes = pieces[place.piece];
        for (int k = 0; k < nodes.nk; ++k)
          for (int i = 0; i < nodes.ni; ++i)
            mesh.coordinates.set(mesh.zones[z].node({place.i + i, j, place.k + k}),
                                 placement(annulus.unroll(nodes.at(i, k), span, section_radius)));
      }
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
