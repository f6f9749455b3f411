// Surfaces that nodes slide on: planes, surfaces of revolution, discrete surfaces, and the constraint "axial position
// kept".
#pragma once

#include <gridmorph/core/enqueue_copy.hpp>
#include <gridmorph/geometry/facet_surface.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/slip_surface.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

using kernels::SlipKind;

/// Radius of a surface of revolution as a function of axial position: a piecewise quintic through points of the
/// profile (Hermite form, slopes and second derivatives from local polynomials: explicit, no system of equations).
///
/// Built on the host from any set of (axial, radius) points; evaluated on host and device alike.
struct RevolutionProfile {
  std::vector<kernels::ProfileKnot> knots;
  std::vector<int> bucket_piece;  ///< see ProfileView
  double deviation = 0;           ///< largest |radius - profile(axial)| over the points it was built from

  /// Sorts, merges near-duplicates, estimates slopes. Between kinks a slope is the derivative of the polynomial through
  /// up to seven neighbouring points (error of the profile of order h^6 at spacing h), or of one that fits more of them
  /// beside clusters of points, weighted by their noise and distance; stencils never cross a kink, and at one the
  /// smaller of the two one-sided slopes is taken, so that the profile does not overshoot there. A constant radius
  /// comes back bit for bit.
  ///
  /// Throws MotionError, naming the place, when the points are not a function of the axial position: walls at constant
  /// axial position, two surfaces at once, or a surface that is not one of revolution. Cost O(n log n).
  static RevolutionProfile from_points(std::vector<std::pair<double, double>> axial_radius);

  /// Slopes above 10 over more than a thousandth of its extent: a displacement along the radius is no way to come back
  /// to such a wall, it carries nodes far along it.
  [[nodiscard]] bool is_steep() const;

  /// Outside the knots the end slope is continued.
  [[nodiscard]] double operator()(double axial_position) const { return view()(axial_position); }

  /// The profile as kernels see it. Borrows the tables: valid on the host while this profile lives unchanged.
  [[nodiscard]] kernels::ProfileView view() const {
    return {knots.data(), int(knots.size()), bucket_piece.data(), std::max(0, int(bucket_piece.size()) - 1)};
  }
};

/// A profile and the frame of the meridional plane in which it is a function.
struct TurnedProfile {
  RevolutionProfile profile;
  kernels::MeridionalFrame frame;

  /// The profile of points along one connected wall: radius over axial position where that is a function and not steep;
  /// otherwise axial position over radius (walls across the axis), or in the frame, turned in steps of 15 degrees, in
  /// which the slopes are smallest. Throws MotionError when there is no such frame: a wall that turns by 180 degrees,
  /// two surfaces, or no surface of revolution. Cost O(n log n).
  static TurnedProfile from_points(std::vector<std::pair<double, double>> const& axial_radius);
};

struct SlipSurface {
  using Kind = SlipKind;
  Kind kind = Kind::plane;
  Vec3 origin;     ///< plane: a point on it; facets: a corner of their box; otherwise a point on the axis
  Vec3 direction;  ///< unit: plane normal, or axis
  RevolutionProfile profile;
  /// Largest distance of the baseline patch's nodes from the surface.
  double baseline_deviation = 0;
  /// Largest distance of the baseline patch's nodes from `origin`: what round-off and relative tolerances refer to.
  double size = 0;
  kernels::MeridionalFrame frame{};  ///< of the profile of a meridional surface
  FacetSurface facets{};             ///< kind facets only

  /// The surface as kernels see it, for host code. It borrows profile and facets: valid while this surface lives
  /// unchanged.
  [[nodiscard]] kernels::SlipSurfaceView view() const {
    return {kind, origin, direction, profile.view(), size, baseline_deviation, frame, facets.view()};
  }
};

/// Slip surfaces in one memory space, for kernels: `surfaces(s)` is a SlipSurfaceView usable where MemorySpace is.
template <class MemorySpace>
struct SlipSurfaceTable {
  Kokkos::View<kernels::SlipSurfaceView*, MemorySpace> surfaces;
  // Tables of all surfaces, each one after another.
  Kokkos::View<kernels::ProfileKnot*, MemorySpace> knots;
  Kokkos::View<int*, MemorySpace> buckets;  ///< bucket_piece of each profile
  Kokkos::View<Vec3*, MemorySpace> facet_points, facet_normals, facet_bends;
  Kokkos::View<kernels::Facet*, MemorySpace> facets;
  Kokkos::View<kernels::FacetBox*, MemorySpace> facet_boxes;

  SlipSurfaceTable() = default;

  /// Copies on `exec`; fences it, because the host buffers end with the call.
  template <class ExecutionSpace>
  SlipSurfaceTable(ExecutionSpace const& exec, std::vector<SlipSurface> const& host) {
    std::vector<kernels::SlipSurfaceView> views;
    std::vector<kernels::ProfileKnot> all_knots;
    std::vector<int> all_buckets;
    std::vector<Vec3> all_points, all_normals, all_bends;
    std::vector<kernels::Facet> all_facets;
    std::vector<kernels::FacetBox> all_boxes;
    auto const append = [](auto& to, auto const& from) { to.insert(to.end(), from.begin(), from.end()); };
    for (SlipSurface const& s : host) {
      append(all_knots, s.profile.knots);
      append(all_buckets, s.profile.bucket_piece);
      append(all_points, s.facets.points);
      append(all_normals, s.facets.normals);
      append(all_bends, s.facets.bends);
      append(all_facets, s.facets.facets);
      append(all_boxes, s.facets.boxes);
    }
    fill(exec, knots, all_knots, "knots");
    fill(exec, buckets, all_buckets, "buckets");
    fill(exec, facet_points, all_points, "facet_points");
    fill(exec, facet_normals, all_normals, "facet_normals");
    fill(exec, facet_bends, all_bends, "facet_bends");
    fill(exec, facets, all_facets, "facets");
    fill(exec, facet_boxes, all_boxes, "facet_boxes");
    std::size_t knot = 0, bucket = 0, point = 0, normal = 0, bend = 0, facet = 0, box = 0;
    auto const next = [](auto const& all, std::size_t& first, auto const& own) {
      auto const* at = all.data() + first;
      first += own.size();
      return at;
    };
    for (SlipSurface const& s : host) {
      kernels::SlipSurfaceView view = s.view();
      view.profile.knots = next(knots, knot, s.profile.knots);
      view.profile.bucket_piece = next(buckets, bucket, s.profile.bucket_piece);
      view.facets.tree.points = next(facet_points, point, s.facets.points);
      view.facets.normals = next(facet_normals, normal, s.facets.normals);
      view.facets.bends = next(facet_bends, bend, s.facets.bends);
      view.facets.tree.facets = next(facets, facet, s.facets.facets);
      view.facets.tree.boxes = next(facet_boxes, box, s.facets.boxes);
      views.push_back(view);
    }
    fill(exec, surfaces, views, "surfaces");
    compat::fence(exec, "gridmorph::SlipSurfaceTable (host buffers end here)");
  }

 private:
  template <class ExecutionSpace, class T>
  static void fill(ExecutionSpace const& exec, Kokkos::View<T*, MemorySpace>& to, std::vector<T> const& from,
                   char const* what) {
    to = detail::enqueue_copy(exec, from, std::string("gridmorph::SlipSurfaceTable::") + what);
  }
};

}  // namespace gridmorph
