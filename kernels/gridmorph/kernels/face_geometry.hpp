// Faces, centres and volumes of elements of any shape, as finite-volume solvers take them, and what they say about its
// quality.
//
// A face with corners p_k: c = mean of its corners, triangles (p_k, p_k+1, c) with normals n_k (half of the cross
// product);
//
//   S = sum of n_k,   f = sum of |n_k| (p_k + p_k+1 + c) / 3 / sum of |n_k|
//
// An element: c_0 = mean of its faces' f, pyramids of volume V_f = S . (f - c_0) / 3 from c_0 to its faces;
//
//   V = sum of V_f,   x_c = sum of V_f (3 f + c_0) / 4 / V
//
// In 2-D sides are edges: f in their middle, S across them, V_f = S . (f - c_0) / 2,
//
//   x_c = sum of V_f (2 f + c_0) / 3 / V
//
//   non-orthogonality  of an inner face between elements at x and y: the angle between S and d = y - x
//   face skewness      |s| / h, s = (f - x) - (S . (f - x) / S . d) d, where the line between the centres misses f;
//                      h = the largest of 0.2 |d| and |s . (p_k - f)| / |s|. On the boundary
//                      d = S (S . (f - x)) / |S|^2, and 0.4 |d| in place of 0.2 |d|
//
// These are the definitions by which OpenFOAM builds and checks meshes (its user guide, checkMesh; H. Jasak, "Error
// analysis and estimation for the finite volume method", thesis, Imperial College 1996, section 3.2). Cost: 45 flops
// and a square root per corner of a face.
#pragma once

#include <gridmorph/kernels/cell_quality.hpp>

namespace gridmorph::kernels {

/// S, f and the sum of the areas of its triangles (in 2-D: of its length), of which |S| is a share where a face is
/// warped.
struct FaceGeometry {
  Vec3 area, centre;
  double size = 0;
};

/// at(k): corner k < n. plane_normal: of a 2-D mesh, where n == 2.
template <class CornerAt>
KOKKOS_INLINE_FUNCTION FaceGeometry face_geometry(int n, CornerAt const& at, Vec3 const& plane_normal) {
  FaceGeometry face;
  if (n == 2) {
    Vec3 const a = at(0), b = at(1);
    face.centre = 0.5 * (a + b);
    face.area = cross(b - a, plane_normal);
    face.size = norm(face.area);
    return face;
  }
  Vec3 mean;
  for (int k = 0; k < n; ++k) mean += at(k);
  mean = (1.0 / n) * mean;
  // A triangle is one triangle, not three around its mean.
  if (n == 3) {
    face.area = 0.5 * cross(at(1) - at(0), at(2) - at(0));
    face.centre = mean;
    face.size = norm(face.area);
    return face;
  }
  Vec3 p = at(0);
  Vec3 const first = p;
  for (int k = 0; k < n; ++k) {
    Vec3 const q = k + 1 < n ? at(k + 1) : first;
    Vec3 const normal = 0.5 * cross(q - p, mean - p);
    double const size = norm(normal);
    face.area += normal;
    face.size += size;
    face.centre += (size / 3) * ((p - mean) + (q - mean));
    p = q;
  }
  face.centre = face.size > 0 ? mean + (1 / face.size) * face.centre : mean;
  return face;
}

struct ElementCentre {
  Vec3 at;
  double volume = 0;
};

/// The centre and volume of an element: faces(f) is the geometry of face f < n_faces; solid: 3-D.
template <class Faces>
KOKKOS_INLINE_FUNCTION ElementCentre element_centre(int n_faces, Faces const& faces, bool solid) {
  Vec3 mean;
  for (int f = 0; f < n_faces; ++f) mean += faces(f).centre;
  mean = (1.0 / n_faces) * mean;
  ElementCentre out;
  double const share = solid ? 0.75 : 2.0 / 3, part = solid ? 1.0 / 3 : 0.5;
  double size = 0;
  for (int f = 0; f < n_faces; ++f) {
    FaceGeometry const face = faces(f);
    Vec3 const arm = face.centre - mean;
    double const volume = part * dot(face.area, arm);
    out.volume += volume;
    out.at += (volume * share) * arm;
    size += volume < 0 ? -volume : volume;
  }
  // An element without volume has no centre of its volume.
  bool const has_volume = out.volume > 1e-12 * size || out.volume < -1e-12 * size;
  out.at = has_volume ? mean + (1 / out.volume) * out.at : mean;
  return out;
}

/// Degrees between the normal of an inner face and the line between the centres on both sides of it.
KOKKOS_INLINE_FUNCTION double non_orthogonality_deg(FaceGeometry const& face, Vec3 const& own, Vec3 const& other) {
  Vec3 const d = other - own;
  double const lengths = norm(face.area) * norm(d);
  if (!(lengths > 0)) return 0;
  constexpr double degrees = 57.295779513082320877;
  return degrees * arc_cosine(dot(face.area, d) / lengths);
}

/// d: between the centres on both sides, or on the boundary from the element's centre straight to the face; least: 0.2
/// or 0.4.
template <class CornerAt>
KOKKOS_INLINE_FUNCTION double face_skewness(FaceGeometry const& face, Vec3 const& own, Vec3 const& d, double least,
                                            int n, CornerAt const& at) {
  constexpr double tiny = 1e-150;
  Vec3 const arm = face.centre - own;
  double const across = dot(face.area, d);
  Vec3 const s = arm - (dot(face.area, arm) / (across + tiny)) * d;
  double const length = norm(s);
  Vec3 const direction = (1 / (length + tiny)) * s;
  double reach = least * norm(d) + tiny;
  for (int k = 0; k < n; ++k) {
    double const r = dot(direction, at(k) - face.centre);
    reach = larger(reach, r < 0 ? -r : r);
  }
  double const skewness = length / reach;
  return is_finite(skewness) ? skewness : unbounded;
}

}  // namespace gridmorph::kernels
