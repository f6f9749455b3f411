#include <gridmorph/core/for_all.hpp>
#include <gridmorph/guard/detail/shape_step.hpp>
#include <gridmorph/guard/detail/shape_sweeps.hpp>
#include <gridmorph/kernels/node_copy.hpp>
#include <gridmorph/kernels/slip_edge.hpp>

namespace gridmorph::detail {

namespace {

using kernels::CornerChange;

class Sweeps {
 public:
  Sweeps(BlockPoints const& points, ShapeRegion const& region, Coordinates const& x)
      : points_(points), baseline_(points.baseline()), region_(region), x_(x) {
    for (SlipSurface const& surface : points.slip_surfaces()) surfaces_.push_back(surface.view());
  }

  /// How the corners of a point change with its displacement.
  void changes(Index point, std::vector<CornerChange>& out) const {
    out.clear();
    for (PointCorner const& at : region_.corners_of(point)) {
      kernels::BaselineCorner const& corner = region_.corners[at.cell][at.corner];
      if (corner.inverse_det == 0) continue;
      Vec3 edge[3];
      corner_edges(x_, region_.cells[at.cell], at.corner, edge);
      double share[3];
      for (int d = 0; d < 3; ++d) share[d] = double(at.roles >> (1 + d) & 1) - double(at.roles & 1);
      CornerChange change = corner_change(corner, edge, share);
      if (at.matrix >= 0) {
        Mat3 const back = transpose(rotation(at.matrix));
        change.half_slope = back * change.half_slope;
        change.volume_slope = back * change.volume_slope;
      }
      out.push_back(change);
    }
  }

  void move(Index point, double delta, double relaxation, std::vector<CornerChange>& corners) {
    changes(point, corners);
    Vec3 const u = displacement(point);
    SlidingPoint const* const slide = slide_of(point);
    make_shape_step(
        corners, u, delta, relaxation,
        [&](kernels::ShapeSum& sum) {
          if (slide != nullptr) restrict(*slide, u, sum);
        },
        [&](Vec3 const& there) { return slide != nullptr ? slid(*slide, there) : there; },
        [&](Vec3 const& there) { place(point, there); });
  }

  [[nodiscard]] double smallest_volume(Index cell) const {
    double smallest = HUGE_VAL;
    for (int c = 0; c < 8; ++c) {
      double const inverse = region_.corners[cell][c].inverse_det;
      if (inverse == 0) continue;
      Vec3 edge[3];
      corner_edges(x_, region_.cells[cell], c, edge);
      smallest = std::min(smallest, inverse * dot(cross(edge[0], edge[1]), edge[2]));
    }
    return smallest;
  }

 private:
  [[nodiscard]] Mat3 const& rotation(std::int32_t matrix) const { return points_.rotation(matrix); }
  [[nodiscard]] Vec3 to_node(std::int32_t matrix, Vec3 const& v) const { return matrix < 0 ? v : rotation(matrix) * v; }
  [[nodiscard]] Vec3 to_point(std::int32_t matrix, Vec3 const& v) const {
    return matrix < 0 ? v : transpose(rotation(matrix)) * v;
  }
  [[nodiscard]] Vec3 displacement(Index point) const {
    PointNode const& n = region_.nodes_of(point).front();
    return to_point(n.matrix, x_[n.node] - baseline_[n.node]);
  }
  [[nodiscard]] SlidingPoint const* slide_of(Index point) const {
    Index32 const number = region_.sliding[point];
    return number < 0 ? nullptr : &region_.slides[number];
  }
  void place(Index point, Vec3 const& u) {
    for (PointNode const& n : region_.nodes_of(point))
      x_.set(n.node, kernels::moved(baseline_[n.node], to_node(n.matrix, u)));
  }

  /// Leaves the directions that all surfaces of the point allow.
  void restrict(SlidingPoint const& slide, Vec3 const& u, kernels::ShapeSum& sum) const {
    Vec3 across[3];
    int count = 0;
    for (int m = 0; m < slide.count; ++m) {
      Vec3 normal;
      surface(slide, m).excess(baseline_[slide.node.node], slide.own_offset[m], to_node(slide.node.matrix, u), normal);
      normal = to_point(slide.node.matrix, normal);
      double const size = norm(normal);
      for (int k = 0; k < count; ++k) normal = normal - dot(normal, across[k]) * across[k];
      // Surfaces that meet at less than 0.01 rad are one, as in slip_edge.hpp.
      if (norm(normal) > 0.01 * size) across[count++] = (1 / norm(normal)) * normal;
    }
    restrict_to_tangents(sum, across, count);
  }
  /// The surfaces of one point, as constrain_to_all() asks for them.
  struct Surfaces {
    kernels::SlipSurfaceView const* all;
    int const* which;
    KOKKOS_INLINE_FUNCTION kernels::SlipSurfaceView const& operator()(int m) const { return all[which[m]]; }
  };
  [[nodiscard]] Vec3 slid(SlidingPoint const& slide, Vec3 const& u) const {
    Vec3 out = to_node(slide.node.matrix, u), unused;
    kernels::constrain_to_all<false>(slide.count, Surfaces{surfaces_.data(), slide.surface.data()},
                                     kernels::Listed<double>{slide.own_offset.data()}, baseline_[slide.node.node], out,
                                     unused);
    return to_point(slide.node.matrix, out);
  }
  [[nodiscard]] kernels::SlipSurfaceView const& surface(SlidingPoint const& slide, int m) const {
    return surfaces_[slide.surface[m]];
  }

  BlockPoints const& points_;
  Coordinates const& baseline_;
  ShapeRegion const& region_;
  Coordinates x_;  ///< the same memory as the caller's
  std::vector<kernels::SlipSurfaceView> surfaces_;
};

double smallest_volume(HostInstance const& host, ShapeRegion const& region, Sweeps const& sweeps) {
  std::vector<double> of_cell(region.cells.size());
  for_all(host, "gridmorph::shape_smoothing::smallest_volume", Index(of_cell.size()),
          [&](Index n) { of_cell[n] = sweeps.smallest_volume(n); });
  return of_cell.empty() ? HUGE_VAL : *std::min_element(of_cell.begin(), of_cell.end());
}

}  // namespace

void smooth_region(HostInstance const& host, BlockPoints const& points, ShapeRegion const& region, int sweeps,
                   double relaxation, Coordinates& x, bool gradual) {
  Sweeps all(points, region, x);
  UntanglingSchedule schedule(sweeps, gradual);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    double const delta = schedule.delta(sweep, [&] { return smallest_volume(host, region, all); });
    for (std::vector<Index32> const& colour : region.colours)
      sweep_colour(host, "gridmorph::shape_smoothing::sweep", colour,
                   [&](Index32 point, auto& corners) { all.move(point, delta, relaxation, corners); });
  }
}

}  // namespace gridmorph::detail
