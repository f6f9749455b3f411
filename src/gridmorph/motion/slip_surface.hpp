// Surfaces that nodes slide on: planes, surfaces of revolution, and the constraint "axial position kept".
#pragma once

#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/slip_surface.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace gridmorph {

/// Radius of a surface of revolution as a function of axial position: a piecewise quintic through points of the
/// profile (Hermite form, slopes and second derivatives from local polynomials: explicit, no system of equations).
///
/// Built on the host from any set of (axial, radius) points; evaluated on host and device alike.
struct RevolutionProfile {
  std::vector<ProfileKnot> knots;
  std::vector<int> bucket_piece;  ///< see ProfileView
  double deviation = 0;           ///< largest |radius - profile(axial)| over the points it was built from

  /// Sorts, merges near-duplicates, estimates slopes. Between kinks a slope is the derivative of the polynomial through
  /// up to seven neighbouring points (error of the profile of order h^6 at spacing h); stencils never cross a kink,
  /// and at one the smaller of the two one-sided slopes is taken, so that the profile does not overshoot there. A
  /// constant radius comes back bit for bit.
  ///
  /// Throws MotionError, naming the place, when the points are not a function of the axial position: walls at constant
  /// axial position, two surfaces at once, or a surface that is not one of revolution. Cost O(n log n).
  static RevolutionProfile from_points(std::vector<std::pair<double, double>> axial_radius);

  /// Slopes above 10 over more than a thousandth of its extent: a displacement along the radius is no way to come back to
  /// such a wall, it carries nodes far along it.
  [[nodiscard]] bool is_steep() const;

  /// Outside the knots the end slope is continued.
  [[nodiscard]] double operator()(double axial_position) const { return view()(axial_position); }

  /// Borrows the tables: valid on the host while this profile lives unchanged.
  [[nodiscard]] ProfileView view() const {
    return {knots.data(), int(knots.size()), bucket_piece.data(), std::max(0, int(bucket_piece.size()) - 1)};
  }
};

/// A profile and the frame of the meridional plane in which it is a function.
struct TurnedProfile {
  RevolutionProfile profile;
  MeridionalFrame frame;

  /// Of points along one connected wall: radius over axial position where that is a function and not steep; otherwise
  /// axial position over radius (walls across the axis), or in the frame, turned in steps of 15 degrees, in which the slopes
  /// are smallest. Throws MotionError when there is no such frame: a wall that turns by 180 degrees, two surfaces, or no
  /// surface of revolution. Cost O(n log n).
  static TurnedProfile from_points(std::vector<std::pair<double, double>> const& axial_radius);
};

struct SlipSurface {
  using Kind = SlipKind;
  Kind kind = Kind::plane;
  Vec3 origin;     ///< plane: a point on it; otherwise a point on the axis
  Vec3 direction;  ///< unit: plane normal, or axis
  RevolutionProfile profile;
  /// Largest distance of the baseline patch's nodes from the surface.
  double baseline_deviation = 0;
  /// Largest distance of the baseline patch's nodes from `origin`: what round-off and relative tolerances refer to.
  double size = 0;
  MeridionalFrame frame{};  ///< of the profile of a meridional surface

  /// For host code; borrows the profile: valid while this surface lives unchanged.
  [[nodiscard]] SlipSurfaceView view() const {
    return {kind, origin, direction, profile.view(), size, baseline_deviation, frame};
  }
};

/// Slip surfaces in one memory space, for kernels: `surfaces(s)` is a SlipSurfaceView usable where MemorySpace is.
template <class MemorySpace>
struct SlipSurfaceTable {
  Kokkos::View<SlipSurfaceView*, MemorySpace> surfaces;
  Kokkos::View<ProfileKnot*, MemorySpace> knots;  ///< of each profile one after another
  Kokkos::View<int*, MemorySpace> buckets;        ///< bucket_piece of each profile one after another

  SlipSurfaceTable() = default;

  /// Copies on `exec`; fences it, because the host buffers end with the call.
  template <class ExecutionSpace>
  SlipSurfaceTable(ExecutionSpace const& exec, std::vector<SlipSurface> const& host) {
    std::size_t n_knots = 0, n_buckets = 0;
    for (SlipSurface const& s : host) {
      n_knots += s.profile.knots.size();
      n_buckets += s.profile.bucket_piece.size();
    }
    using Kokkos::WithoutInitializing;
    surfaces = Kokkos::View<SlipSurfaceView*, MemorySpace>(
        Kokkos::view_alloc(exec, WithoutInitializing, "gridmorph::SlipSurfaceTable::surfaces"), host.size());
    knots = Kokkos::View<ProfileKnot*, MemorySpace>(
        Kokkos::view_alloc(exec, WithoutInitializing, "gridmorph::SlipSurfaceTable::knots"), n_knots);
    buckets = Kokkos::View<int*, MemorySpace>(
        Kokkos::view_alloc(exec, WithoutInitializing, "gridmorph::SlipSurfaceTable::buckets"), n_buckets);
    auto surfaces_h = Kokkos::create_mirror_view(surfaces);
    auto knots_h = Kokkos::create_mirror_view(knots);
    auto buckets_h = Kokkos::create_mirror_view(buckets);
    std::size_t knot = 0, bucket = 0;
    for (std::size_t s = 0; s < host.size(); ++s) {
      SlipSurfaceView view = host[s].view();
      view.profile.knots = knots.data() + knot;
      view.profile.bucket_piece = buckets.data() + bucket;
      for (ProfileKnot const& k : host[s].profile.knots) knots_h(knot++) = k;
      for (int const piece : host[s].profile.bucket_piece) buckets_h(bucket++) = piece;
      surfaces_h(s) = view;
    }
    Kokkos::deep_copy(exec, surfaces, surfaces_h);
    Kokkos::deep_copy(exec, knots, knots_h);
    Kokkos::deep_copy(exec, buckets, buckets_h);
    compat::fence(exec, "gridmorph::SlipSurfaceTable (host buffers end here)");
  }
};

}  // namespace gridmorph
