// Surfaces that nodes slide on, as kernels see them: project a point, or correct a displacement.
//
// A node that slips keeps its own distance from the surface where the baseline mesh has one (round-off, single
// precision, chord error of the profile): the correction is the *change* of that distance. So zero displacement stays
// exactly zero, and a displacement that already keeps the node on its surface comes back bit for bit.
//
// Cost: plane and axial about 10 flops; revolution two lookups in the profile and two square roots; facets a search in
// O(log facets) and about 2000 flops (facet_surface.hpp).
#pragma once

#include <gridmorph/kernels/facet_surface.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <cmath>

namespace gridmorph {

enum class SlipKind {
  plane,       ///< nodes stay on a plane
  revolution,  ///< nodes stay on a surface of revolution, moved radially at constant axial position and angle
  axial,       ///< nodes keep their axial position; not a surface
  facets       ///< nodes stay on a discrete surface made smooth, moved along its normals
};

/// What a profile knows at one axial position. All of it lies together: nodes look at few positions each, far apart.
struct ProfileKnot {
  double axial = 0;
  double radius = 0;
  double slope = 0;  ///< d radius / d axial
  /// Second derivatives at the two ends of the piece that begins here; across a knot where the profile has a kink they differ.
  double curvature[2] = {0, 0};
  friend bool operator==(ProfileKnot const&, ProfileKnot const&) = default;
};

/// Radius as a function of axial position: quintic Hermite pieces between `size` knots. Borrows its tables.
struct ProfileView {
  ProfileKnot const* knots = nullptr;  ///< (size), axial positions strictly increasing
  int size = 0;
  /// (n_buckets + 1): the piece that holds the lower end of each of n_buckets equal parts of the axial range.
  int const* bucket_piece = nullptr;
  int n_buckets = 0;

  /// The piece that holds an axial position inside the range: a bisection among those of its bucket.
  KOKKOS_INLINE_FUNCTION int piece(double a) const {
    int lo = 0, hi = size - 1;
    if (n_buckets > 0) {
      double const place = (a - knots[0].axial) / (knots[size - 1].axial - knots[0].axial) * n_buckets;
      int const bucket = place < n_buckets ? int(place) : n_buckets - 1;
      // One piece more on either side, for positions that round into the neighbouring bucket.
      lo = bucket_piece[bucket] > 0 ? bucket_piece[bucket] - 1 : 0;
      hi = bucket_piece[bucket + 1] + 2 < size - 1 ? bucket_piece[bucket + 1] + 2 : size - 1;
    }
    while (hi - lo > 1) {
      int const mid = (lo + hi) / 2;
      (knots[mid].axial <= a ? lo : hi) = mid;
    }
    return lo;
  }

  /// Written in differences, so that a constant profile comes back bit for bit; the end slopes are continued outside.
  KOKKOS_INLINE_FUNCTION double operator()(double a) const {
    ProfileKnot const &first = knots[0], &last = knots[size - 1];
    if (a <= first.axial) return first.radius + first.slope * (a - first.axial);
    if (a >= last.axial) return last.radius + last.slope * (a - last.axial);
    int const p = piece(a);
    ProfileKnot const &lo = knots[p], &hi = knots[p + 1];
    double const h = hi.axial - lo.axial;
    double const t = (a - lo.axial) / h, t2 = t * t, t3 = t2 * t;
    double const rise = (hi.radius - lo.radius) * t3 * (10 + t * (6 * t - 15));
    double const slopes = lo.slope * (t + t3 * (-6 + t * (8 - 3 * t))) + hi.slope * t3 * (-4 + t * (7 - 3 * t));
    double const bends = lo.curvature[0] * t2 * (0.5 + t * (-1.5 + t * (1.5 - 0.5 * t))) +
                         lo.curvature[1] * t3 * (0.5 + t * (-1 + 0.5 * t));
    return lo.radius + (rise + h * (slopes + h * bends));
  }

  /// Its derivative with respect to the axial position.
  KOKKOS_INLINE_FUNCTION double derivative(double a) const {
    if (a <= knots[0].axial) return knots[0].slope;
    if (a >= knots[size - 1].axial) return knots[size - 1].slope;
    int const p = piece(a);
    ProfileKnot const &lo = knots[p], &hi = knots[p + 1];
    double const h = hi.axial - lo.axial;
    double const t = (a - lo.axial) / h, t2 = t * t;
    double const rise = (hi.radius - lo.radius) * 30 * t2 * (1 - t) * (1 - t);
    double const slopes = lo.slope * (1 + t2 * (-18 + t * (32 - 15 * t))) + hi.slope * t2 * (-12 + t * (28 - 15 * t));
    double const bends =
        lo.curvature[0] * t * (1 + t * (-4.5 + t * (6 - 2.5 * t))) + lo.curvature[1] * t2 * (1.5 + t * (-4 + 2.5 * t));
    return rise / h + slopes + h * bends;
  }
};

struct SlipSurfaceView {
  SlipKind kind = SlipKind::plane;
  Vec3 origin;                    ///< plane: a point on it; facets: one near them; otherwise a point on the axis
  Vec3 direction;                 ///< unit: plane normal, or axis
  ProfileView profile;            ///< revolution only
  double size = 0;                ///< length that "1e-14 of the size" refers to
  double baseline_deviation = 0;  ///< offsets up to this are the baseline mesh's own and are kept
  FacetSurfaceView facets{};      ///< facets only

  /// The point of the surface that p slides to: orthogonally (plane), along the normals (facets), or radially at constant axial position and angle
  /// (revolution). A point on the axis has no radial direction and stays. Kind axial: p itself.
  KOKKOS_INLINE_FUNCTION Vec3 project(Vec3 const& p) const {
    if (kind == SlipKind::facets) return facets.slide(facets.closest_point(p), p);
    Vec3 const d = p - origin;
    double const a = dot(d, direction);
    if (kind == SlipKind::plane) return p - a * direction;
    if (kind == SlipKind::axial) return p;
    Vec3 const radial = d - a * direction;
    double const r = norm(radial);
    return r > 0 ? p + ((profile(a) - r) / r) * radial : p;
  }

  /// Distance of a baseline node from a surface of revolution or of facets that is the baseline mesh's own and is kept; 0
  /// for other kinds and for nodes that are farther off.
  KOKKOS_INLINE_FUNCTION double own_offset(Vec3 const& baseline) const {
    if (kind == SlipKind::facets) {
      FacetFoot const foot = facets.closest_point(baseline);
      double const off = dot(baseline - foot.point, foot.normal);
      return is_own(off) ? off : 0;
    }
    if (kind != SlipKind::revolution) return 0;
    Vec3 const d = baseline - origin;
    double const a = dot(d, direction);
    double const offset = norm(d - a * direction) - profile(a);
    return is_own(offset) ? offset : 0;
  }

  /// The displacement of a baseline node, corrected so that the moved node is where the surface wants it.
  KOKKOS_INLINE_FUNCTION Vec3 constrain(Vec3 const& baseline, Vec3 const& u) const {
    return constrain(baseline, own_offset(baseline), u);
  }
  KOKKOS_INLINE_FUNCTION Vec3 constrain(Vec3 const& baseline, double own, Vec3 const& u) const {
    if (u.x == 0 && u.y == 0 && u.z == 0) return u;
    double const tolerance = 1e-14 * size;
    if (kind == SlipKind::facets) {
      Vec3 const p = baseline + u;
      FacetFoot const foot = facets.closest_point(p);
      Vec3 const change = (facets.slide(foot, p) - p) + own * foot.normal;
      return norm(change) <= tolerance ? u : u + change;
    }
    double const du = dot(u, direction);
    if (kind == SlipKind::axial) return small(du, tolerance) ? u : u - du * direction;

    Vec3 const d = baseline - origin;
    double const a = dot(d, direction);
    if (kind == SlipKind::plane) {
      double const excess = du + (is_own(a) ? 0.0 : a);
      return small(excess, tolerance) ? u : u - excess * direction;
    }
    Vec3 const radial = d - a * direction;
    Vec3 const moved = radial + (u - du * direction);
    double const r = norm(moved);
    if (!(r > 0)) return u;
    double const excess = r - (profile(a + du) + own);
    return small(excess, tolerance) ? u : u - (excess / r) * moved;
  }

  /// How constrain(baseline, own, u) changes where u changes by `rate` per unit of time. Facets: the derivative of the foot,
  /// without the change of the normal along which `own` is kept; beyond a rim, the part of `rate` in its tangent plane.
  KOKKOS_INLINE_FUNCTION Vec3 constrain_rate(Vec3 const& baseline, double own, Vec3 const& u, Vec3 const& rate) const {
    if (kind == SlipKind::facets) return facets.foot_rate(facets.closest_point(baseline + u), baseline + u, rate);
    double const axial_rate = dot(rate, direction);
    if (kind != SlipKind::revolution) return rate - axial_rate * direction;
    Vec3 const d = baseline - origin;
    double const a = dot(d, direction), du = dot(u, direction);
    Vec3 const radial = d - a * direction;
    Vec3 const moved = radial + (u - du * direction), moved_rate = rate - axial_rate * direction;
    double const r = norm(moved);
    if (!(r > 0)) return rate;
    double const excess = r - (profile(a + du) + own);
    double const r_rate = dot(moved, moved_rate) / r;
    double const excess_rate = r_rate - profile.derivative(a + du) * axial_rate;
    return rate - ((excess_rate - excess * r_rate / r) / r) * moved - (excess / r) * moved_rate;
  }

  /// How far a displaced node is from where the surface wants it, 0 there, and the gradient of that in `gradient`.
  KOKKOS_INLINE_FUNCTION double excess(Vec3 const& baseline, double own, Vec3 const& u, Vec3& gradient) const {
    if (kind == SlipKind::facets) {
      Vec3 const p = baseline + u;
      FacetFoot const foot = facets.closest_point(p);
      bool const off_edge = foot.place == FacetFoot::Place::crease && foot.distance > 1e-14 * size;
      gradient = off_edge ? (1 / foot.distance) * (p - foot.point) : foot.normal;
      return off_edge ? foot.distance : dot(p - foot.point, gradient) - own;
    }
    Vec3 const d = baseline - origin;
    double const a = dot(d, direction), du = dot(u, direction);
    gradient = direction;
    if (kind == SlipKind::axial) return du;
    if (kind == SlipKind::plane) return du + (is_own(a) ? 0.0 : a);
    Vec3 const moved = (d - a * direction) + (u - du * direction);
    double const r = norm(moved);
    if (!(r > 0)) return 0;
    gradient = (1 / r) * moved - profile.derivative(a + du) * direction;
    return r - (profile(a + du) + own);
  }

 private:
  KOKKOS_INLINE_FUNCTION static bool small(double v, double tolerance) { return v <= tolerance && v >= -tolerance; }
  KOKKOS_INLINE_FUNCTION bool is_own(double offset) const {
    return small(offset, baseline_deviation * (1 + 1e-6) + 1e-14 * size);
  }
};

}  // namespace gridmorph
