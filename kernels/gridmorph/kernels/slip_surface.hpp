// Surfaces that nodes slide on, as kernels see them: project a point, or correct a displacement.
//
// A node that slips keeps its own distance from the surface where the baseline mesh has one (round-off, single
// precision, chord error of the profile): the correction is the *change* of that distance. So zero displacement stays
// exactly zero, and a displacement that already keeps the node on its surface comes back bit for bit.
//
// Cost: plane and axial about 10 flops; revolution two lookups in the profile and two square roots; meridional the same
// across the axis, otherwise some six lookups with derivatives to find the nearest point: eight times revolution;
// facets a search in O(log facets) and about 2000 flops (facet_surface.hpp).
#pragma once

#include <gridmorph/kernels/facet_surface.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <cmath>

namespace gridmorph::kernels {

enum class SlipKind {
  plane,       ///< nodes stay on a plane
  revolution,  ///< nodes stay on a surface of revolution, moved radially at constant axial position and angle
  axial,       ///< nodes keep their axial position; not a surface
  meridional,  ///< surface of revolution whose profile is a function in a turned frame: see MeridionalFrame
  facets       ///< nodes stay on a discrete surface made smooth, moved along its normals
};

/// Which of them a surface may be, and the ends that slide on some.
enum class SlipKinds {
  simple,  ///< neither meridional nor of facets
  smooth,  ///< none of facets
  any
};

/// A frame of the meridional plane: (abscissa, ordinate) is (axial, radius) turned. Walls at constant axial position
/// are functions of the abscissa when it is the radius (cosine 0, sine 1), walls that turn from axial to radial in a
/// frame between the two. Nodes move along the ordinate to a wall across the axis (at constant radius and angle), and
/// along the wall's normal in the meridional plane where the frame is inclined.
struct MeridionalFrame {
  double cosine = 1, sine = 0;
  KOKKOS_INLINE_FUNCTION double abscissa(double axial, double radius) const { return cosine * axial + sine * radius; }
  KOKKOS_INLINE_FUNCTION double ordinate(double axial, double radius) const { return cosine * radius - sine * axial; }
  KOKKOS_INLINE_FUNCTION double axial(double x, double y) const { return cosine * x - sine * y; }
  KOKKOS_INLINE_FUNCTION double radius(double x, double y) const { return sine * x + cosine * y; }
  KOKKOS_INLINE_FUNCTION bool inclined() const { return cosine != 0 && sine != 0; }
  friend bool operator==(MeridionalFrame const&, MeridionalFrame const&) = default;
};

/// What a profile knows at one axial position. All of it lies together: nodes look at few positions each, far apart.
struct ProfileKnot {
  double axial = 0;
  double radius = 0;
  double slope = 0;  ///< d radius / d axial
  /// Second derivatives at the two ends of the piece that begins here; across a knot where the profile has a kink they
  /// differ.
  double curvature[2] = {0, 0};
  friend bool operator==(ProfileKnot const&, ProfileKnot const&) = default;
};

/// A profile at one position: value, first and second derivative.
struct ProfileSample {
  double value = 0, slope = 0, bend = 0;
};

/// Radius as a function of axial position (in a turned frame: ordinate as a function of abscissa): quintic Hermite
/// pieces between `size` knots. Borrows its tables.
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

  /// The value of the profile at an axial position, in differences, so that a constant profile comes back bit for bit;
  /// the end slopes are continued outside.
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

  /// The derivative of the profile with respect to the axial position.
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

  /// Value and derivatives by one lookup; the end slopes are continued outside.
  KOKKOS_FORCEINLINE_FUNCTION ProfileSample sample(double a) const {
    ProfileKnot const &first = knots[0], &last = knots[size - 1];
    if (a <= first.axial) return {first.radius + first.slope * (a - first.axial), first.slope, 0};
    if (a >= last.axial) return {last.radius + last.slope * (a - last.axial), last.slope, 0};
    int const p = piece(a);
    ProfileKnot const &lo = knots[p], &hi = knots[p + 1];
    double const h = hi.axial - lo.axial, rise = hi.radius - lo.radius;
    double const t = (a - lo.axial) / h, t2 = t * t, t3 = t2 * t, c0 = lo.curvature[0], c1 = lo.curvature[1];
    double const slopes[3] = {
        lo.slope * (t + t3 * (-6 + t * (8 - 3 * t))) + hi.slope * t3 * (-4 + t * (7 - 3 * t)),
        lo.slope * (1 + t2 * (-18 + t * (32 - 15 * t))) + hi.slope * t2 * (-12 + t * (28 - 15 * t)),
        lo.slope * t * (-36 + t * (96 - 60 * t)) + hi.slope * t * (-24 + t * (84 - 60 * t))};
    double const bends[3] = {c0 * t2 * (0.5 + t * (-1.5 + t * (1.5 - 0.5 * t))) + c1 * t3 * (0.5 + t * (-1 + 0.5 * t)),
                             c0 * t * (1 + t * (-4.5 + t * (6 - 2.5 * t))) + c1 * t2 * (1.5 + t * (-4 + 2.5 * t)),
                             c0 * (1 + t * (-9 + t * (18 - 10 * t))) + c1 * t * (3 + t * (-12 + 10 * t))};
    return {lo.radius + (rise * t3 * (10 + t * (6 * t - 15)) + h * (slopes[0] + h * bends[0])),
            rise / h * 30 * t2 * (1 - t) * (1 - t) + slopes[1] + h * bends[1],
            (rise / h * 60 * t * (1 + t * (-3 + 2 * t)) + slopes[2]) / h + bends[2]};
  }

  /// Abscissa of the profile's point nearest to (x, y), by Newton's method from the point at x; where the distance is
  /// not convex there, steps of Gauss and Newton. Meant for points nearer to the profile than its radius of curvature.
  KOKKOS_INLINE_FUNCTION double nearest(double x, double y) const {
    constexpr int most_steps = 30;
    double const length = knots[size - 1].axial - knots[0].axial;
    double at = x;
    for (int n = 0; n < most_steps; ++n) {
      ProfileSample const s = sample(at);
      double const metric = 1 + s.slope * s.slope, second = metric + (s.value - y) * s.bend;
      double const step = (x - at + (y - s.value) * s.slope) / (second > 0.25 * metric ? second : metric);
      at += step;
      if (step <= 1e-15 * length && step >= -1e-15 * length) break;
    }
    return at;
  }
};

/// A point's place relative to a meridional profile.
struct MeridionalFoot {
  double away = 0;               ///< signed distance from the profile, along (axial, radial)
  double axial = 0, radial = 0;  ///< unit, in the direction in which `away` grows: the way back to the profile
  double slope = 0, bend = 0;    ///< of the profile there
};

struct SlipSurfaceView {
  SlipKind kind = SlipKind::plane;
  Vec3 origin;                    ///< plane: a point on it; facets: one near them; otherwise a point on the axis
  Vec3 direction;                 ///< unit: plane normal, or axis
  ProfileView profile;            ///< revolution and meridional only
  double size = 0;                ///< length that "1e-14 of the size" refers to
  double baseline_deviation = 0;  ///< offsets up to this are the baseline mesh's own and are kept
  MeridionalFrame frame{};        ///< meridional only
  FacetSurfaceView facets{};      ///< facets only

  /// The point of the surface that p slides to: orthogonally (plane), along the normals (facets), radially at constant
  /// axial position and angle (revolution), or as MeridionalFrame says. A point on the axis has no radial direction: it
  /// stays, or goes along the axis to a wall across it. Kind axial: p itself.
  KOKKOS_INLINE_FUNCTION Vec3 project(Vec3 const& p) const {
    if (kind == SlipKind::facets) return facets.slide(facets.closest_point(p), p);
    Vec3 const d = p - origin;
    double const a = dot(d, direction);
    if (kind == SlipKind::plane) return p - a * direction;
    if (kind == SlipKind::axial) return p;
    Vec3 const radial = d - a * direction;
    double const r = norm(radial);
    if (!(r > 0)) {
      if (!lies_across()) return p;
      MeridionalFoot const f = foot(a, 0);
      return p - (f.away * f.axial) * direction;
    }
    if (kind == SlipKind::meridional) {
      MeridionalFoot const f = foot(a, r);
      return p - f.away * (f.axial * direction + (f.radial / r) * radial);
    }
    return p + ((profile(a) - r) / r) * radial;
  }

  /// Distance of a baseline node from a surface of revolution or of facets that is the baseline mesh's own and is kept;
  /// 0 for other kinds and for nodes that are farther off.
  KOKKOS_INLINE_FUNCTION double own_offset(Vec3 const& baseline) const {
    if (kind == SlipKind::plane || kind == SlipKind::axial) return 0;
    double const off = offset(baseline);
    return is_own(off) ? off : 0;
  }

  /// How far p is from the surface, along the way that project() takes and with the sign of its normal: outward for
  /// surfaces of revolution, or downstream where they lie across the axis. Kind axial: 0.
  KOKKOS_INLINE_FUNCTION double offset(Vec3 const& p) const {
    if (kind == SlipKind::axial) return 0;
    if (kind == SlipKind::facets) {
      FacetFoot const foot = facets.closest_point(p);
      return dot(p - foot.point, foot.normal);
    }
    Vec3 const d = p - origin;
    double const a = dot(d, direction);
    if (kind == SlipKind::plane) return a;
    double const r = norm(d - a * direction);
    return kind == SlipKind::revolution ? r - profile(a) : foot(a, r).away;
  }

  /// The displacement of a baseline node, corrected so that the moved node is where the surface wants it.
  KOKKOS_INLINE_FUNCTION Vec3 constrain(Vec3 const& baseline, Vec3 const& u) const {
    return constrain(baseline, own_offset(baseline), u);
  }
  /// Of, here and below: which kinds it may be of; code that knows more is much smaller.
  template <SlipKinds Of = SlipKinds::any>
  KOKKOS_INLINE_FUNCTION Vec3 constrain(Vec3 const& baseline, double own, Vec3 const& u) const {
    // What does not move stays to the bit, also where the baseline is off the surface.
    if (u.x == 0 && u.y == 0 && u.z == 0) return u;
    double const tolerance = 1e-14 * size;
    if (Of == SlipKinds::any && kind == SlipKind::facets) {
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
    // On the axis no radial direction leads back: only a wall across the axis has something to say there.
    if (!(r > 0)) {
      if (Of == SlipKinds::simple || !lies_across()) return u;
      MeridionalFoot const f = foot(a + du, 0);
      return small(f.away - own, tolerance) ? u : u - ((f.away - own) * f.axial) * direction;
    }
    if (Of != SlipKinds::simple && kind == SlipKind::meridional) {
      MeridionalFoot const f = foot(a + du, r);
      double const too_far = f.away - own;
      return small(too_far, tolerance) ? u : u - too_far * (f.axial * direction + (f.radial / r) * moved);
    }
    double const excess = r - (profile(a + du) + own);
    return small(excess, tolerance) ? u : u - (excess / r) * moved;
  }

  /// How constrain(baseline, own, u) changes where u changes by `rate` per unit of time. Facets: the derivative of the
  /// foot, without the change of the normal along which `own` is kept; beyond a rim, the part of `rate` in its tangent
  /// plane.
  template <SlipKinds Of = SlipKinds::any>
  KOKKOS_INLINE_FUNCTION Vec3 constrain_rate(Vec3 const& baseline, double own, Vec3 const& u, Vec3 const& rate) const {
    if (Of == SlipKinds::any && kind == SlipKind::facets)
      return facets.foot_rate(facets.closest_point(baseline + u), baseline + u, rate);
    double const axial_rate = dot(rate, direction);
    if (kind != SlipKind::revolution && kind != SlipKind::meridional) return rate - axial_rate * direction;
    Vec3 const d = baseline - origin;
    double const a = dot(d, direction), du = dot(u, direction);
    Vec3 const radial = d - a * direction;
    Vec3 const moved = radial + (u - du * direction), moved_rate = rate - axial_rate * direction;
    double const r = norm(moved);
    if (!(r > 0)) return Of != SlipKinds::simple && lies_across() ? moved_rate : rate;
    double const r_rate = dot(moved, moved_rate) / r;
    if (Of != SlipKinds::simple && kind == SlipKind::meridional)
      return rate - meridional_rate(a + du, moved, axial_rate, moved_rate, r_rate, own);
    ProfileSample const wall = profile.sample(a + du);
    double const excess = r - (wall.value + own), excess_rate = r_rate - wall.slope * axial_rate;
    return rate - ((excess_rate - excess * r_rate / r) / r) * moved - (excess / r) * moved_rate;
  }

  /// Whether nodes come back along the axis: then those on it do too.
  KOKKOS_INLINE_FUNCTION bool lies_across() const { return kind == SlipKind::meridional && frame.cosine == 0; }

  /// Where a point of the meridional plane is relative to the profile. Kind meridional.
  KOKKOS_INLINE_FUNCTION MeridionalFoot foot(double axial, double radius) const {
    using std::sqrt;
    double const x = frame.abscissa(axial, radius), y = frame.ordinate(axial, radius);
    double const at = frame.inclined() ? profile.nearest(x, y) : x;
    ProfileSample const s = profile.sample(at);
    if (!frame.inclined()) return {y - s.value, frame.axial(0, 1), frame.radius(0, 1), s.slope, s.bend};
    double const stretch = 1 / sqrt(1 + s.slope * s.slope), nx = -s.slope * stretch;
    return {(x - at) * nx + (y - s.value) * stretch, frame.axial(nx, stretch), frame.radius(nx, stretch), s.slope,
            s.bend};
  }

  /// How far a displaced node is from where the surface wants it, 0 there, and the gradient of that in `gradient`.
  template <SlipKinds Of = SlipKinds::any>
  KOKKOS_INLINE_FUNCTION double excess(Vec3 const& baseline, double own, Vec3 const& u, Vec3& gradient) const {
    if (Of == SlipKinds::any && kind == SlipKind::facets) {
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
    if (!(r > 0)) {
      if (Of == SlipKinds::simple || !lies_across()) return 0;
      MeridionalFoot const f = foot(a + du, 0);
      gradient = f.axial * direction;
      return f.away - own;
    }
    if (Of != SlipKinds::simple && kind == SlipKind::meridional) {
      MeridionalFoot const f = foot(a + du, r);
      // Away is measured along the ordinate where the frame is not inclined, and falls along the abscissa by the slope.
      double const fall = frame.inclined() ? 0.0 : f.slope;
      double const axial = f.axial - fall * frame.axial(1, 0), outward = f.radial - fall * frame.radius(1, 0);
      gradient = axial * direction + (outward / r) * moved;
      return f.away - own;
    }
    gradient = (1 / r) * moved - profile.derivative(a + du) * direction;
    return r - (profile(a + du) + own);
  }

 private:
  /// Derivative of the correction that constrain() subtracts. Along the profile's normal n with tangent t, of a point q
  /// whose foot moves at t . q' / (1 - curvature away): away' = n . q', n' = -curvature t (t . q') / (1 - curvature
  /// away).
  KOKKOS_INLINE_FUNCTION Vec3 meridional_rate(double axial, Vec3 const& moved, double axial_rate,
                                              Vec3 const& moved_rate, double r_rate, double own) const {
    using std::sqrt;
    double const r = norm(moved);
    MeridionalFoot const f = foot(axial, r);
    double const too_far = f.away - own;
    double away_rate = f.axial * axial_rate + f.radial * r_rate, turn = 0;
    if (frame.inclined()) {
      double const metric = 1 + f.slope * f.slope, curvature = f.bend / (metric * sqrt(metric));
      // (n, t) is right-handed the other way round: t = (n_radial, -n_axial).
      double const along = f.radial * axial_rate - f.axial * r_rate;
      turn = -curvature * along / (1 - curvature * f.away);
    } else {
      away_rate -= f.slope * frame.abscissa(axial_rate, r_rate);
    }
    Vec3 const outwards = (1 / r) * moved, outwards_rate = (1 / r) * (moved_rate - r_rate * outwards);
    Vec3 const normal = f.axial * direction + f.radial * outwards;
    Vec3 const normal_rate = turn * (f.radial * direction - f.axial * outwards) + f.radial * outwards_rate;
    return away_rate * normal + too_far * normal_rate;
  }
  KOKKOS_INLINE_FUNCTION static bool small(double v, double tolerance) { return v <= tolerance && v >= -tolerance; }
  KOKKOS_INLINE_FUNCTION bool is_own(double offset) const {
    return small(offset, baseline_deviation * (1 + 1e-6) + 1e-14 * size);
  }
};

/// A surface of these kinds, as one of any. Borrows it.
template <SlipKinds Of>
struct SlipSurfaceOf {
  SlipSurfaceView const& surface;
  double size;

  KOKKOS_INLINE_FUNCTION explicit SlipSurfaceOf(SlipSurfaceView const& of) : surface(of), size(of.size) {}
  KOKKOS_INLINE_FUNCTION Vec3 constrain(Vec3 const& baseline, double own, Vec3 const& u) const {
    return surface.constrain<Of>(baseline, own, u);
  }
  KOKKOS_INLINE_FUNCTION Vec3 constrain_rate(Vec3 const& baseline, double own, Vec3 const& u, Vec3 const& rate) const {
    return surface.constrain_rate<Of>(baseline, own, u, rate);
  }
  KOKKOS_INLINE_FUNCTION double excess(Vec3 const& baseline, double own, Vec3 const& u, Vec3& gradient) const {
    return surface.excess<Of>(baseline, own, u, gradient);
  }
};

}  // namespace gridmorph::kernels
