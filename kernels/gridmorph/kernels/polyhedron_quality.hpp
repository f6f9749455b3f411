// Quality of an element that is known by its faces; the counterpart of element_quality.hpp.
//
// It has no map from a cube of its own, so that what others take from its Jacobian is taken from the pyramids between
// its centre x_c and its faces (face_geometry.hpp), by which solvers on such meshes work:
//
//   volume         sum of the pyramids' volumes
//   inverted       a pyramid has negative volume: S . (f - x_c) < 0. (OpenFOAM's checkMesh: "face pyramids")
//   determinant    both: the smallest S . (f - x_c) / (A |f - x_c|) over the faces, A the sum of the areas of a face's
//                  triangles: 1 where faces are flat and across the lines from the centre, whatever the lengths, as
//                  determinants of hexahedra are
//   aspect ratio   longest / shortest edge
//   angles         between the edges in each corner of each face, above 180 degrees where a face has a dent
//   skewness       (a - amin) / a, a = 180 - 360 / n degrees in faces with n corners; of triangles and quadrilaterals
//                  the larger of that and (amax - a) / (180 - a), of others of that and (amax - 180) / 180: nodes of
//                  finer neighbours amid an edge are no fault of a face. Not above 1
//   relative       largest |u_p - u_q| over the edges pq / their mean baseline length
//   displacement
//
// Cost: 150 flops and 3 square roots per corner of a face.
#pragma once

#include <gridmorph/kernels/element_quality.hpp>
#include <gridmorph/kernels/face_geometry.hpp>
#include <gridmorph/kernels/jacobian_bounds.hpp>

namespace gridmorph::kernels {

namespace polyhedron {

/// The smallest and largest S . (f - x_c), what they are against A |f - x_c|, and the volume.
struct Pyramids {
  double least = unbounded, largest = -unbounded;
  double share = unbounded;  ///< smallest S . (f - x_c) / (A |f - x_c|)
  double volume = 0;
};

/// The geometry of a face of p, which has n_faces(), n_corners(face), at(face, corner).
template <class Points>
KOKKOS_INLINE_FUNCTION FaceGeometry face_of(Points const& p, int face) {
  return face_geometry(
      p.n_corners(face), [&](int k) { return p.at(face, k); }, Vec3{});
}

template <class Points>
KOKKOS_INLINE_FUNCTION ElementCentre centre_of(Points const& p) {
  return element_centre(
      p.n_faces(), [&](int f) { return face_of(p, f); }, true);
}

/// The pyramids between the centre and the faces. sign: -1 where faces point inwards.
template <class Points>
KOKKOS_INLINE_FUNCTION Pyramids pyramids(Points const& p, double sign) {
  ElementCentre const centre = centre_of(p);
  Pyramids out;
  out.volume = sign * centre.volume;
  for (int f = 0; f < p.n_faces(); ++f) {
    FaceGeometry const face = face_of(p, f);
    Vec3 const arm = face.centre - centre.at;
    double const length = norm(arm), scale = face.size * length;
    if (!(face.size > 0)) continue;  // a face without area leaves no trace
    double x = 0;
    for (int k = 0; k < p.n_corners(f); ++k) {
      Vec3 const corner = p.at(f, k);
      x = larger(x, largest_component(&corner, 1));
    }
    double const zero = flat_fraction * scale + 0x1p-46 * x * (face.size + compat::math::sqrt(face.size) * length);
    double const j = without_noise(sign * dot(face.area, arm), zero);
    out.least = smaller(out.least, j);
    out.largest = larger(out.largest, j);
    out.share = smaller(out.share, scale > 0 ? j / scale : 0.0);
  }
  if (!(out.largest >= out.least)) out.least = out.largest = out.share = 0;
  return out;
}

/// Edges in the order of the faces; all but those on one face alone come twice.
template <class Points, class TakeEdge>
KOKKOS_INLINE_FUNCTION void for_each_edge(Points const& p, TakeEdge const& take) {
  for (int f = 0; f < p.n_faces(); ++f)
    for (int k = 0, n = p.n_corners(f); k < n; ++k) take(f, k, k + 1 < n ? k + 1 : 0);
}

/// Smallest angle and skewness of one face.
template <class Points>
KOKKOS_INLINE_FUNCTION void add_angles(Points const& p, int face, double limit, double& smallest, double& skewness) {
  int const n = p.n_corners(face);
  double const ideal = 180 - 360.0 / n;
  Vec3 const area = face_of(p, face).area;
  constexpr double degrees = 57.295779513082320877;
  for (int k = 0; k < n; ++k) {
    Vec3 const here = p.at(face, k), u = p.at(face, (k + 1) % n) - here, v = p.at(face, (k + n - 1) % n) - here;
    double const uu = dot(u, u), vv = dot(v, v);
    if (uu <= limit || vv <= limit) continue;
    double const inner = degrees * arc_cosine(dot(u, v) / compat::math::sqrt(uu * vv));
    double const angle = dot(cross(u, v), area) < 0 && inner < 179 ? 360 - inner : inner;
    smallest = smaller(smallest, angle);
    double const above = n > 4 ? (angle - 180) / 180 : (angle - ideal) / (180 - ideal);
    skewness = larger(skewness, larger(above, (ideal - angle) / ideal));
  }
}

}  // namespace polyhedron

/// All measures; faces point outwards, or with sign -1 inwards.
template <class Points>
KOKKOS_INLINE_FUNCTION CellMeasures polyhedron_measures(Points const& p, double sign) {
  polyhedron::Pyramids const j = polyhedron::pyramids(p, sign);
  if (!is_finite(j.volume)) return invalid_cell();
  CellMeasures m;
  m.volume = j.volume;
  m.smallest_corner_jacobian = j.least;
  m.largest_corner_jacobian = j.largest;
  m.determinant_2x2x2 = m.determinant_3x3x3 = larger(-1.0, smaller(1.0, j.share));
  double longest = 0, shortest = unbounded;
  polyhedron::for_each_edge(p, [&](int f, int a, int b) {
    Vec3 const edge = p.at(f, b) - p.at(f, a);
    longest = larger(longest, dot(edge, edge));
  });
  double const limit = collapsed_fraction * collapsed_fraction * longest;
  polyhedron::for_each_edge(p, [&](int f, int a, int b) {
    Vec3 const edge = p.at(f, b) - p.at(f, a);
    double const square = dot(edge, edge);
    if (square <= limit)
      m.collapsed = true;
    else
      shortest = smaller(shortest, square);
  });
  if (is_finite(shortest) && shortest > 0) m.aspect_ratio = compat::math::sqrt(longest / shortest);
  double angle = unbounded, skewness = -unbounded;
  for (int f = 0; f < p.n_faces(); ++f) polyhedron::add_angles(p, f, limit, angle, skewness);
  if (is_finite(angle)) {
    m.minimum_angle_deg = angle;
    m.equiangle_skewness = smaller(1.0, skewness);
  }
  return m;
}

/// Measure determinant_3x3x3 alone; -1 where a corner is not finite.
template <class Points>
KOKKOS_INLINE_FUNCTION double polyhedron_determinant(Points const& p, double sign) {
  polyhedron::Pyramids const j = polyhedron::pyramids(p, sign);
  return is_finite(j.volume) ? larger(-1.0, smaller(1.0, j.share)) : -1.0;
}

/// The sign of all pyramids together: whether they have volume.
template <class Points>
KOKKOS_INLINE_FUNCTION JacobianSign polyhedron_sign(Points const& p, double sign) {
  polyhedron::Pyramids const j = polyhedron::pyramids(p, sign);
  if (!is_finite(j.volume) || j.least < 0) return JacobianSign::negative;
  return j.least > 0 ? JacobianSign::positive : JacobianSign::zero;
}

/// The relative displacement of a polyhedron that moved from `baseline` to `morphed`; `unbounded` where a corner is not
/// finite.
template <class From, class To>
KOKKOS_INLINE_FUNCTION double polyhedron_relative_displacement(From const& baseline, To const& morphed) {
  double worst = 0, length = 0;
  int edges = 0;
  polyhedron::for_each_edge(baseline, [&](int f, int a, int b) {
    Vec3 const before = baseline.at(f, b) - baseline.at(f, a);
    double const difference = norm((morphed.at(f, b) - morphed.at(f, a)) - before);
    worst = is_finite(difference) ? larger(worst, difference) : unbounded;
    length += norm(before);
    ++edges;
  });
  double const ratio = length > 0 ? worst * edges / length : 0;
  return is_finite(ratio) ? ratio : unbounded;
}

}  // namespace gridmorph::kernels
