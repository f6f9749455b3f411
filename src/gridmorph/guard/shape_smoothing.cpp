#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/for_all.hpp>
#include <gridmorph/guard/detail/shape_sweeps.hpp>
#include <gridmorph/guard/shape_smoothing.hpp>
#include <gridmorph/kernels/flat_cells.hpp>
#include <gridmorph/kernels/jacobian_bounds.hpp>
#include <gridmorph/morph/plan_access.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace gridmorph {

namespace {

using detail::BlockCells;
using detail::CellNodes;
using detail::ShapeRegion;

/// What became of a cell's corners, against the baseline.
struct CellShape {
  double smallest =
      1;  ///< scaled Jacobian of corners that can change, positive where they are turned as in the baseline
  bool lost = false, inverted = false;  ///< inverted: at a corner or, by the certificate, elsewhere
};

/// What became of some cells.
struct ShapeCount {
  Index lost = 0, inverted = 0;
  double smallest = 1;  ///< over the corners that can change

  [[nodiscard]] bool better_than(ShapeCount const& other) const {
    if (inverted != other.inverted) return inverted < other.inverted;
    return smallest > other.smallest || (smallest == other.smallest && lost < other.lost);
  }
};

/// Parts of a region that have no cell in common: what becomes of one does not change another.
struct RegionPieces {
  std::size_t count = 0;
  std::vector<Index32> of_cell, of_point;

  explicit RegionPieces(ShapeRegion const& region) {
    DisjointSets<Index32> sets(region.cells.size());
    for (Index p = 0; p < region.n_points(); ++p) {
      auto const corners = region.corners_of(p);
      for (detail::PointCorner const& c : corners) sets.join(corners.front().cell, c.cell);
    }
    std::vector<Index32> number(region.cells.size(), -1);
    for (std::size_t c = 0; c < region.cells.size(); ++c) {
      Index32& piece = number[sets.root(Index32(c))];
      if (piece < 0) piece = Index32(count++);
      of_cell.push_back(piece);
    }
    for (Index p = 0; p < region.n_points(); ++p) of_point.push_back(of_cell[region.corners_of(p).front().cell]);
  }
};

class ShapeSmoothing {
 public:
  ShapeSmoothing(HostInstance const& host, IndexedMesh const& mesh, Coordinates& x,
                 ShapeSmoothingOptions const& options)
      : host_(host),
        mesh_(mesh.mesh()),
        handedness_(mesh.handedness()),
        x_(x),
        options_(options),
        cells_(mesh_),
        looks_at_(mesh_.zones.size(), options.zones.empty() ? 1 : 0) {
    for (int const zone : options.zones) looks_at_[zone] = 1;
  }

  ShapeSmoothingReport run(MorphPlan const& plan) {
    ShapeSmoothingReport report;
    std::vector<Index> lost = find_lost();
    report.triggered_before = report.triggered_after = Index(lost.size());
    if (lost.empty()) return report;
    BlockPoints points = PlanAccess::block_points(plan);
    for (ShapeSmoothingOptions::Round const& round : options_.rounds) {
      ShapeRegion const region = detail::shape_region(host_, cells_, points, lost, round.rings);
      ShapeCount const before = count(region);
      bool const first = &round == &options_.rounds.front();
      if (first) {
        report.inverted_before = report.inverted_after = before.inverted;
        report.smallest_before = report.smallest_after = before.smallest;
      } else if (before.inverted == 0) {
        break;
      }
      RegionPieces const pieces(region);
      std::vector<Vec3> const places = places_of(region);
      std::vector<ShapeCount> const had = count(region, pieces);
      detail::smooth_region(host_, points, region, round.sweeps, round.relaxation, x_);
      if (!put_back_worse(region, pieces, had, places)) continue;
      ShapeCount const after = count(region);
      ++report.rounds;
      report.triggered_after = after.lost;
      report.inverted_after = after.inverted;
      report.smallest_after = after.smallest;
      lost = still_lost(region);
      if (after.inverted == 0) break;
    }
    return report;
  }

  ShapeSmoothingReport run(MorphPlan const& plan, FrozenSmoothing const& frozen) {
    ShapeSmoothingReport report;
    std::vector<Index> cells = frozen.cells;
    std::erase_if(cells, [this](Index cell) { return !looks_at(cells_.zone(cell)); });
    if (cells.empty() || options_.rounds.empty() || is_baseline()) return report;
    ShapeSmoothingOptions::Round const round = frozen.inverted ? options_.rounds.back() : options_.rounds.front();
    BlockPoints points = PlanAccess::block_points(plan);
    ShapeRegion const region = detail::shape_region(host_, cells_, points, cells, round.rings);
    ShapeCount const before = count(region);
    detail::smooth_region(host_, points, region, round.sweeps, round.relaxation, x_, true);
    ShapeCount const after = count(region);
    return {before.lost, after.lost, before.inverted, after.inverted, before.smallest, after.smallest, 1};
  }

  [[nodiscard]] FrozenSmoothing lost() const {
    FrozenSmoothing out{find_lost(), false};
    for (Index const cell : out.cells)
      out.inverted = out.inverted || shape(cells_.nodes(cell), handedness(cell)).inverted;
    return out;
  }

 private:
  [[nodiscard]] bool is_baseline() const {
    for (std::size_t z = 0; z < looks_at_.size(); ++z) {
      Zone const& zone = mesh_.zones[z];
      for (Index n = zone.first_node; looks_at(int(z)) && n < zone.first_node + zone.size(); ++n)
        if (!(x_[n] == mesh_.coordinates[n])) return false;
    }
    return true;
  }
  [[nodiscard]] bool looks_at(int zone) const { return looks_at_[zone] != 0; }
  [[nodiscard]] double handedness(Index cell) const { return handedness_[cells_.zone(cell)]; }

  static kernels::HexCell corners(Coordinates const& x, CellNodes const& nodes) {
    kernels::HexCell cell;
    for (int c = 0; c < 8; ++c) cell.corner[c] = x[nodes.node(c)];
    return cell;
  }
  /// As cell_edges() asks for them.
  struct CornersOf {
    kernels::HexCell cell;
    KOKKOS_INLINE_FUNCTION kernels::LaneVec3<double> operator()(int i, int j, int k) const {
      Vec3 const& p = cell.corner[i + 2 * j + 4 * k];
      return {p.x, p.y, p.z};
    }
  };
  /// Inside out somewhere, by the certificate, and not in the baseline.
  [[nodiscard]] bool broken(CellNodes const& nodes, double handedness) const {
    auto const edges = kernels::cell_edges<double>(CornersOf{corners(x_, nodes)});
    auto const floor = kernels::jacobian_floor(edges, handedness);
    if (floor.least > floor.arithmetic) return false;
    auto const negative = [&](Coordinates const& x) {
      return kernels::jacobian_sign(corners(x, nodes), handedness) >= kernels::JacobianSign::negative;
    };
    Coordinates const& baseline = mesh_.coordinates;
    return negative(x_) && !negative(baseline) &&
           !kernels::flat_cell(corners(baseline, nodes), corners(x_, nodes), handedness).stays_flat();
  }

  [[nodiscard]] CellShape shape(CellNodes const& nodes, double handedness, unsigned changing = 0) const {
    CellShape out;
    for (int c = 0; c < 8; ++c) {
      Vec3 now[3], before[3];
      detail::corner_edges(mesh_.coordinates, nodes, c, before);
      double const was = scaled_jacobian(before);
      if (!(std::abs(was) > kernels::flat_before)) continue;  // collapsed or flat: the certificate tells
      detail::corner_edges(x_, nodes, c, now);
      double const is = std::copysign(1.0, was) * scaled_jacobian(now);
      if ((changing >> c & 1u) != 0) out.smallest = std::min(out.smallest, is);
      if (!(is > kernels::flat_fraction)) out.inverted = true;
      if (!(is >= options_.least_sine) && !(is >= options_.share * std::abs(was))) out.lost = true;
    }
    if (!out.inverted && broken(nodes, handedness)) out.inverted = out.lost = true;
    return out;
  }
  static double scaled_jacobian(Vec3 const (&edge)[3]) {
    double const lengths = std::sqrt(dot(edge[0], edge[0]) * dot(edge[1], edge[1]) * dot(edge[2], edge[2]));
    return lengths > 0 ? dot(cross(edge[0], edge[1]), edge[2]) / lengths : 0;
  }

  /// Without a look at the baseline: most cells are far from the limit.
  [[nodiscard]] bool suspicious(CellNodes const& nodes, double handedness) const {
    double const least = options_.least_sine * options_.least_sine;
    for (int c = 0; c < 8; ++c) {
      Vec3 edge[3];
      detail::corner_edges(x_, nodes, c, edge);
      // Edges at a corner with an odd number of far sides are mirrored.
      double const sign = ((c ^ (c >> 1) ^ (c >> 2)) & 1) == 0 ? handedness : -handedness;
      double const volume = sign * dot(cross(edge[0], edge[1]), edge[2]);
      double const lengths = dot(edge[0], edge[0]) * dot(edge[1], edge[1]) * dot(edge[2], edge[2]);
      if (!(volume > 0 && volume * volume >= least * lengths)) return true;
    }
    return false;
  }

  [[nodiscard]] std::vector<Index> find_lost() const {
    constexpr Index part = 4096;
    Index const n_parts = (cells_.size() + part - 1) / part;
    std::vector<std::vector<Index>> found(std::max<Index>(n_parts, 0));
    detail::for_all_parts(host_, "gridmorph::shape_smoothing::trigger", n_parts, [&](Index n) {
      for (Index cell = n * part; cell < std::min(cells_.size(), (n + 1) * part); ++cell) {
        if (!looks_at(cells_.zone(cell))) continue;
        CellNodes const nodes = cells_.nodes(cell);
        double const hand = handedness(cell);
        if ((suspicious(nodes, hand) || broken(nodes, hand)) && shape(nodes, hand).lost) found[n].push_back(cell);
      }
    });
    std::vector<Index> lost;
    for (auto const& list : found) lost.insert(lost.end(), list.begin(), list.end());
    return lost;
  }

  [[nodiscard]] std::vector<CellShape> shapes(ShapeRegion const& region) const {
    std::vector<CellShape> out(region.cells.size());
    detail::for_all(host_, "gridmorph::shape_smoothing::shapes", Index(out.size()), [&](Index n) {
      out[n] = shape(region.cells[n], handedness(region.numbers[n]), region.changing[n]);
    });
    return out;
  }
  [[nodiscard]] ShapeCount count(ShapeRegion const& region) const {
    ShapeCount out;
    auto const add = [&](CellShape const& s) {
      out.lost += s.lost ? 1 : 0;
      out.inverted += s.inverted ? 1 : 0;
    };
    for (CellShape const& s : shapes(region)) {
      add(s);
      out.smallest = std::min(out.smallest, s.smallest);
    }
    for (Index const cell : region.others) add(shape(cells_.nodes(cell), handedness(cell)));
    return out;
  }
  [[nodiscard]] std::vector<Index> still_lost(ShapeRegion const& region) const {
    std::vector<Index> out = region.others;
    std::vector<CellShape> const all = shapes(region);
    for (std::size_t n = 0; n < all.size(); ++n)
      if (all[n].lost) out.push_back(region.numbers[n]);
    std::sort(out.begin(), out.end());
    return out;
  }

  [[nodiscard]] std::vector<Vec3> places_of(ShapeRegion const& region) const {
    std::vector<Vec3> places;
    places.reserve(region.nodes.size());
    for (PointNode const& n : region.nodes) places.push_back(x_[n.node]);
    return places;
  }
  [[nodiscard]] std::vector<ShapeCount> count(ShapeRegion const& region, RegionPieces const& pieces) const {
    std::vector<ShapeCount> out(pieces.count);
    std::vector<CellShape> const all = shapes(region);
    for (std::size_t n = 0; n < all.size(); ++n) {
      ShapeCount& piece = out[pieces.of_cell[n]];
      piece.lost += all[n].lost ? 1 : 0;
      piece.inverted += all[n].inverted ? 1 : 0;
      piece.smallest = std::min(piece.smallest, all[n].smallest);
    }
    return out;
  }
  /// Puts back pieces that are not better than they were; whether any is.
  bool put_back_worse(ShapeRegion const& region, RegionPieces const& pieces, std::vector<ShapeCount> const& had,
                      std::vector<Vec3> const& places) {
    std::vector<ShapeCount> const has = count(region, pieces);
    std::vector<std::uint8_t> better;
    for (std::size_t p = 0; p < pieces.count; ++p) better.push_back(has[p].better_than(had[p]) ? 1 : 0);
    for (Index point = 0; point < region.n_points(); ++point) {
      if (better[pieces.of_point[point]] != 0) continue;
      for (Index n = region.first_node[point]; n < region.first_node[point + 1]; ++n)
        x_.set(region.nodes[n].node, places[n]);
    }
    return std::find(better.begin(), better.end(), 1) != better.end();
  }

  HostInstance const& host_;
  Mesh const& mesh_;
  std::vector<int> const& handedness_;
  Coordinates& x_;
  ShapeSmoothingOptions const& options_;
  BlockCells cells_;
  std::vector<std::uint8_t> looks_at_;  ///< per zone
};

}  // namespace

void FrozenSmoothing::join(FrozenSmoothing const& other) {
  std::vector<Index> all;
  std::ranges::set_union(cells, other.cells, std::back_inserter(all));
  cells = std::move(all);
  inverted = inverted || other.inverted;
}

FrozenSmoothing lost_shapes(HostInstance const& host, IndexedMesh const& mesh, Coordinates const& morphed,
                            ShapeSmoothingOptions const& options) {
  Coordinates x = morphed;  // the same memory, which is only looked at
  return ShapeSmoothing(host, mesh, x, options).lost();
}

ShapeSmoothingReport smooth_frozen(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan,
                                   Coordinates& morphed, FrozenSmoothing const& frozen,
                                   ShapeSmoothingOptions const& options) {
  return ShapeSmoothing(host, mesh, morphed, options).run(plan, frozen);
}

ShapeSmoothingReport smooth_shapes(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan,
                                   Coordinates& morphed, ShapeSmoothingOptions const& options) {
  return ShapeSmoothing(host, mesh, morphed, options).run(plan);
}

GuardReport report_of(ShapeSmoothingReport const& report) {
  return {.before = report.triggered_before,
          .after = report.triggered_after,
          .rounds = report.rounds,
          .inverted_before = report.inverted_before,
          .inverted_after = report.inverted_after};
}

}  // namespace gridmorph
