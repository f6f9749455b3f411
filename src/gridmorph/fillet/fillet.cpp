#include <gridmorph/fillet/fillet.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/fillet/arc_patches.hpp>
#include <gridmorph/fillet/corner_lines.hpp>
#include <gridmorph/fillet/corner_stations.hpp>
#include <gridmorph/geometry/cubic_piece.hpp>
#include <gridmorph/geometry/unit.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

/// Distances 0 ... `length` of n cells that begin with `first` and grow geometrically; evenly spaced where `first` is
/// too large for that.
std::vector<double> grown_spacing(int n, double first, double length) {
  auto const total = [&](double growth) {
    double sum = 0, cell = first;
    for (int k = 0; k < n; ++k, cell *= growth) sum += cell;
    return sum;
  };
  std::vector<double> out{0.0};
  if (total(1) >= length || n < 2) {
    for (int k = 1; k <= n; ++k) out.push_back(length * k / n);
    return out;
  }
  double low = 1, high = 2;
  while (total(high) < length) high *= 2;
  for (int step = 0; step < 80; ++step) {
    double const middle = (low + high) / 2;
    (total(middle) < length ? low : high) = middle;
  }
  double cell = first;
  for (int k = 1; k < n; ++k, cell *= low) out.push_back(out.back() + cell);
  out.push_back(length);
  return out;
}

/// Shares 0 ... 1 of a line: the weighted geometric means of those of two others, weight w of `b`. Ascending where both
/// are.
std::vector<double> mean_shares(std::vector<double> const& a, std::vector<double> const& b, double w) {
  std::vector<double> out{0.0};
  for (std::size_t n = 1; n < a.size(); ++n) out.push_back(std::pow(a[n], 1 - w) * std::pow(b[n], w));
  return out;
}

/// Shares t as distances a t / (1 + k t) that end at `length` and begin with `first`. Ascending for any 0 < first <
/// length; multiples of the shares where `first` is not less.
std::vector<double> stretched(std::vector<double> const& shares, double first, double length) {
  std::vector<double> out;
  double const t1 = shares[1];
  bool const fits = shares.size() > 2 && first < length;
  double const k = fits ? (first - length * t1) / (t1 * (length - first)) : 0;
  for (double t : shares) out.push_back(length * (1 + k) * t / (1 + k * t));
  return out;
}

/// The line from a wall to where its layers end: the cubic with these directions, as fast at both ends as the chord is
/// long.
struct LayerLine {
  Vec3 foot, off_foot, end, into_end;

  [[nodiscard]] double chord() const { return distance(foot, end); }
  [[nodiscard]] Vec3 at(double share) const {
    return cubic_piece(foot, end, chord() * off_foot, chord() * into_end, 1, share);
  }
  /// Shares of layers whose first cell is as high as given.
  [[nodiscard]] std::vector<double> places(std::vector<double> const& shares, double first) const {
    double along = first;  // the line bends and is not passed through evenly
    if (first < 0.5 * chord())
      for (int step = 0; step < 4; ++step) along *= first / distance(at(along / chord()), foot);
    std::vector<double> out = stretched(shares, along, chord());
    for (double& s : out) s /= chord();
    return out;
  }
};

/// The layers of an old line of nodes off a wall.
struct OldLayers {
  ArcCurve curve;
  std::vector<double> arcs;  ///< of the layers that are made
  bool same = false;         ///< as many as there were

  OldLayers(std::vector<Vec3> points, int made)
      : curve(curve_through(std::move(points))), same(made == int(curve.size()) - 1) {
    if (same)
      for (std::size_t n = 0; n < curve.size(); ++n) arcs.push_back(curve.arc(n));
    else
      arcs = grown_spacing(made, curve.arc(1), curve.length());
  }
  [[nodiscard]] Vec3 at(std::size_t layer) const {
    return layer == 0                 ? curve.point(0)
           : layer + 1 == arcs.size() ? curve.point(curve.size() - 1)
           : same                     ? curve.point(layer)
                                      : curve.at(arcs[layer]);
  }
  [[nodiscard]] std::vector<double> shares() const {
    std::vector<double> out = arcs;
    for (double& s : out) s /= arcs.back();
    return out;
  }
};

class Layers {
 public:
  Layers(Mesh const& old, WallSheets const& sheets, SheetLayers const& layers, CornerStations const& stations)
      : old_(old), sheets_(sheets), layers_(layers), stations_(stations) {
    for (std::size_t c = 0; c < stations.corners().size(); ++c) mitres_.push_back(mitres_of(c));
    arc_nodes_.resize(mitres_.size());
  }

  /// Nodes of a zone that is the layers of a sheet.
  void fill(SplitZone const& part, Zone const& zone, Coordinates& to) {
    Sheet const& sheet = sheets_.all[part.sheet];
    int const u = (sheet.axis + 1) % 3, v = (sheet.axis + 2) % 3;
    std::vector<std::size_t> corners;
    for (std::size_t c = 0; c < stations_.corners().size(); ++c)
      if (stations_.corners()[c].sheet[std::size_t(sheet.wall)] == &sheet) corners.push_back(c);
    for (int b = part.box.begin[v]; b < part.box.end[v]; ++b)
      for (int a = part.box.begin[u]; a < part.box.end[u]; ++a) {
        Index3 column{0, 0, 0};
        column[u] = a;
        column[v] = b;
        std::vector<Vec3> const nodes = line(sheet, corners, column);
        for (int n = 0; n <= layers_.made; ++n) {
          Index3 p{0, 0, 0};
          p[u] = a - part.box.begin[u];
          p[v] = b - part.box.begin[v];
          p[sheet.axis] = sheet.side == 0 ? n : layers_.made - n;
          to.set(zone.node(p), nodes[n]);
        }
      }
  }

  [[nodiscard]] double wall_deviation() const { return wall_deviation_; }
  [[nodiscard]] bool first_cells_kept() const { return first_cells_kept_; }
  /// Where the walls' faces have nodes on arcs; after all of fill().
  [[nodiscard]] std::vector<ArcFaces> arcs() const {
    std::vector<ArcFaces> out;
    for (std::size_t c = 0; c < arc_nodes_.size(); ++c) {
      CornerFrame const& corner = stations_.corners()[c];
      for (int wall = 0; wall < 2; ++wall) {
        ArcNodes const& nodes = arc_nodes_[c][wall];
        if (nodes.last < 0) continue;
        // Faces beside the last node and beside the outermost stations have nodes of both.
        out.push_back({c, wall, nodes.last + 1 - stations_.station(c, 0).line[wall].layers,
                       std::max(0, nodes.first_station - 1), std::min(corner.stations() - 1, nodes.last_station + 1)});
      }
    }
    return out;
  }

 private:
  /// Wall nodes on the arcs of a corner.
  struct ArcNodes {
    int last = -1;  ///< the farthest from the corner
    int first_station = std::numeric_limits<int>::max(), last_station = -1;
  };

  /// How layers are spaced in the face where those of both walls meet.
  struct Mitre {
    std::vector<double> shares;
    double first = 0;
  };

  /// Old nodes off a wall, from the one on it on.
  [[nodiscard]] std::vector<Vec3> nodes_off(Sheet const& sheet, Index3 p, int cells) const {
    Zone const& zone = old_.zones[sheet.zone];
    std::vector<Vec3> out;
    for (int n = 0; n <= cells; ++n) {
      p[sheet.axis] = sheet.side == 0 ? n : zone.extent[sheet.axis] - 1 - n;
      out.push_back(old_.coordinates[zone.node(p)]);
    }
    return out;
  }
  [[nodiscard]] int layers_of(Sheet const& sheet) const { return layers_.old[std::size_t(sheet.wall)]; }

  std::vector<Mitre> mitres_of(std::size_t c) const {
    CornerFrame const& corner = stations_.corners()[c];
    std::vector<Mitre> out;
    for (int a = 0; a < corner.stations(); ++a) {
      std::array<std::vector<double>, 2> shares;
      double first = 1;
      for (std::size_t w = 0; w < 2; ++w) {
        OldLayers const own(nodes_off(*corner.sheet[w], corner.index(a, layers_.old), layers_.old[w]), layers_.made);
        shares[w] = own.shares();
        first *= own.arcs[1];
      }
      out.push_back({mean_shares(shares[0], shares[1], 0.5), std::sqrt(first)});
    }
    return out;
  }

  /// The layers over one node of a wall. `corners`: those of the sheet.
  std::vector<Vec3> line(Sheet const& sheet, std::vector<std::size_t> const& corners, Index3 const& column) {
    int const cells = layers_of(sheet);
    auto const w = std::size_t(sheet.wall);
    std::vector<Vec3> points = nodes_off(sheet, column, cells + 1);
    if (corners.empty() && cells == layers_.made) {
      points.pop_back();
      return points;
    }
    Vec3 const off_wall = unit(points[1] - points[0]);
    Vec3 const into_end = unit(points[cells + 1] - points[cells - 1]);
    points.pop_back();
    OldLayers const old(std::move(points), layers_.made);
    if (old.arcs[1] < 0.98 * old.curve.arc(1)) first_cells_kept_ = false;

    std::vector<Vec3> out;
    for (std::size_t n = 0; n < old.arcs.size(); ++n) out.push_back(old.at(n));
    for (std::size_t c : corners) {
      CornerFrame const& corner = stations_.corners()[c];
      Sheet const& other = *corner.sheet[1 - w];
      int const depth = other.side == 0 ? column[other.axis] : corner.cells(int(1 - w)) - column[other.axis];
      int const a = column[corner.along()];
      CornerStation const& station = stations_.station(c, a);
      if (depth >= int(station.line[w].curve.size())) continue;
      double const g = station.line[w].share(depth);
      if (g == 0) continue;
      WallPlace const middle = station.middle();
      WallPlace const foot = depth == station.line[w].layers ? middle : station.place(int(w), depth, off_wall);
      if (foot.rounded && !station.sharp()) {
        ArcNodes& arc = arc_nodes_[c][w];
        arc.last = std::max(arc.last, depth);
        arc.first_station = std::min(arc.first_station, a);
        arc.last_station = std::max(arc.last_station, a);
      }
      if (!foot.rounded && (w == 1 || !station.sharp()))  // where the corner is bare its line is on no blade
        wall_deviation_ = std::max(wall_deviation_, station.surface[w]->closest_point(foot.point).distance);
      LayerLine const before{old.at(0), off_wall, old.at(old.arcs.size() - 1), into_end};
      LayerLine const after{foot.point, foot.normal, before.end,
                            unit(g * unit(station.inner - middle.point) + (1 - g) * into_end)};
      Mitre const& mitre = mitres_[c][a];
      auto const own_shares = old.shares();
      auto const places_before = before.places(own_shares, old.arcs[1]);
      auto const places_after = after.places(mean_shares(own_shares, mitre.shares, g),
                                             std::pow(old.arcs[1], 1 - g) * std::pow(mitre.first, g));
      for (std::size_t n = 0; n + 1 < out.size(); ++n)
        out[n] = after.at(places_after[n]) + (1 - g) * (out[n] - before.at(places_before[n]));
    }
    return out;
  }

  Mesh const& old_;
  WallSheets const& sheets_;
  SheetLayers const& layers_;
  CornerStations const& stations_;
  std::vector<std::vector<Mitre>> mitres_;
  std::vector<std::array<ArcNodes, 2>> arc_nodes_;  ///< per corner and wall
  double wall_deviation_ = 0;
  bool first_cells_kept_ = true;
};

}  // namespace

void FilletFacts::add_station(double radius, double half_angle_rad) {
  double const angle = 360 / std::numbers::pi * half_angle_rad;
  bool const first = stations++ == 0;
  smallest_radius = first ? radius : std::min(smallest_radius, radius);
  largest_radius = std::max(largest_radius, radius);
  arc_angle_deg[0] = first ? angle : std::min(arc_angle_deg[0], angle);
  arc_angle_deg[1] = std::max(arc_angle_deg[1], angle);
}

FilletResult make_fillet(Mesh const& mesh, Links const& links, FilletOptions const& options) {
  WallSheets const sheets = find_wall_sheets(mesh, links, options.blade, options.end_wall);
  FilletResult out;
  out.layers = choose_layers(mesh, sheets, options);
  out.split = split_corners(mesh, sheets, out.layers);
  CornerStations const stations(mesh, links, sheets, out.layers, options);
  stations.describe(out);

  Mesh& made = out.split.mesh;
  made.coordinates = Coordinates(made.n_nodes());
  Layers layers(mesh, sheets, out.layers, stations);
  for (std::size_t z = 0; z < made.zones.size(); ++z) {
    SplitZone const& part = out.split.zones[z];
    Zone const &zone = made.zones[z], &from = mesh.zones[part.zone];
    if (part.sheet >= 0) {
      layers.fill(part, zone, made.coordinates);
      continue;
    }
    for (int k = 0; k < zone.extent[2]; ++k)
      for (int j = 0; j < zone.extent[1]; ++j)
        for (int i = 0; i < zone.extent[0]; ++i)
          made.coordinates.set(
              zone.node({i, j, k}),
              mesh.coordinates[from.node({i + part.box.begin[0], j + part.box.begin[1], k + part.box.begin[2]})]);
  }
  out.wall_deviation = layers.wall_deviation();
  out.first_cells_kept = layers.first_cells_kept();
  separate_arcs(mesh, options, sheets, out.layers, layers.arcs(), out.split);
  return out;
}

}  // namespace gridmorph
