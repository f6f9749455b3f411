// Where the Jacobian of a cell is positive: everywhere in it, not at some points alone.
//
// J is a polynomial in local coordinates. Its Bezier coefficients bound it: J is a weighted mean of them with weights
// that are never negative. All positive: the cell is valid everywhere. Coefficients at corners are values of J: one
// negative, and the cell is not. Otherwise the cell is halved, which brings the coefficients closer to J, until one or
// the other holds (A. Johnen, J.-F. Remacle, C. Geuzaine, "Geometrical validity of curvilinear finite elements", J.
// Comput. Phys. 233 (2013) 359; A. Johnen, J.-C. Weill, J.-F. Remacle, "Robust and efficient validation of the linear
// hexahedral element", 2017).
//
// Hexahedron, x trilinear: J = a . (b x c), with a, b, c the tangents along i, j, k, is of degree 2 in each direction.
// Its coefficients at corners (c) and edges (e) come from edge vectors; those of faces (f) and of the centre (m) from
// them, because no term of J is of degree 2 in two directions (both tangents that are linear in those would be the same
// vector):
//
//   f = (2 sum of 4 e - sum of 4 c) / 4,     m = (2 sum of 4 f - sum of 4 e) / 4 in the layer between two sides
//
// In rows of cells a looser bound comes first, J at the centre less what the other terms can take away
// (jacobian_floor()); most cells are that close to parallelepipeds, and nothing else is needed.
//
// Prism: of degree 1 in the triangle and 2 along the columns, so a quadratic along each column decides. Pyramid: the
// factor (1 - t)^2 left out as in element_quality.hpp, of degree 2 in both directions of the base. Tetrahedra have one
// J.
//
// Round-off. Each coefficient is within 100 eps a b c of its exact value for the coordinates as they are, a, b, c being
// the longest edges: what is called valid lies above that. What lies below zero by less than jacobian_tolerance() is
// zero as far as coordinates can tell, as in cell_quality.hpp.
//
// Cost per hexahedron of a row: about 260 flops and its corners read once; 450 more where the looser bound does not
// tell. Others, and those that have to be looked at twice, about 1000, and 600 for each time they are halved.
#pragma once

#include <gridmorph/kernels/cell_row.hpp>
#include <gridmorph/kernels/element_quality.hpp>

namespace gridmorph::kernels {

enum class JacobianSign : std::uint8_t {
  positive,   ///< everywhere
  zero,       ///< negative nowhere, but somewhere zero, as far as coordinates can tell
  negative,   ///< somewhere
  undecided,  ///< halved max_halvings times, and still neither: zero along a surface inside
};

inline constexpr int max_halvings = 18;
/// The share that arithmetic has in a sign: below this share of the product of the longest edges, arithmetic alone may
/// decide about a sign: 2^-44, some 250 eps.
inline constexpr double sign_share = 0x1p-44;

/// Bezier coefficients of degree 2 in three directions: of[i][j][k].
struct BezierCube {
  double of[3][3][3];

  KOKKOS_INLINE_FUNCTION double least() const {
    double m = of[0][0][0];
    for (auto const& plane : of)
      for (auto const& line : plane)
        for (double const b : line) m = b >= m ? m : b;  // what is no number stays
    return m;
  }
  KOKKOS_INLINE_FUNCTION double least_corner() const {
    double m = of[0][0][0];
    for (int n = 1; n < 8; ++n) {
      double const b = of[n & 1 ? 2 : 0][n & 2 ? 2 : 0][n & 4 ? 2 : 0];
      m = b >= m ? m : b;
    }
    return m;
  }
  /// Becomes the lower half along an axis (de Casteljau); returns the upper one.
  KOKKOS_INLINE_FUNCTION BezierCube halve(int axis) {
    BezierCube upper;
    for (int p = 0; p < 3; ++p)
      for (int q = 0; q < 3; ++q) {
        auto const at = [&](BezierCube& c, int n) -> double& {
          return axis == 0 ? c.of[n][p][q] : axis == 1 ? c.of[p][n][q] : c.of[p][q][n];
        };
        double const low = 0.5 * (at(*this, 0) + at(*this, 1)), high = 0.5 * (at(*this, 1) + at(*this, 2));
        double const mid = 0.5 * (low + high);
        at(upper, 0) = mid;
        at(upper, 1) = high;
        at(upper, 2) = at(*this, 2);
        at(*this, 1) = low;
        at(*this, 2) = mid;
      }
    return upper;
  }
};

/// The sign of J by its Bezier coefficients. arithmetic: what rounding may do to a coefficient; tolerance >=
/// arithmetic: what is zero as far as coordinates can tell.
KOKKOS_INLINE_FUNCTION JacobianSign sign_of(BezierCube const& whole, double arithmetic, double tolerance) {
  struct Piece {
    BezierCube b;
    int depth;
  } stack[max_halvings + 1];
  stack[0] = {whole, 0};
  JacobianSign sign = JacobianSign::positive;
  for (int n = 1; n > 0;) {
    Piece& piece = stack[n - 1];
    if (!(piece.b.least_corner() >= -tolerance)) return JacobianSign::negative;
    double const least = piece.b.least();
    if (least >= -tolerance || piece.depth == max_halvings) {
      if (!(least >= -tolerance))
        sign = JacobianSign::undecided;
      else if (!(least > arithmetic) && sign == JacobianSign::positive)
        sign = JacobianSign::zero;
      --n;
      continue;
    }
    int const axis = piece.depth++ % 3;
    stack[n] = {piece.b.halve(axis), piece.depth};
    ++n;
  }
  return sign;
}

/// Normals in a plane of constant i: edges along j at k = 0, 1 and along k at j = 0, 1, their cross products at the
/// corners, and the squares of the longest.
template <class T>
struct PlaneNormals {
  LaneVec3<T> j0, j1, k0, k1;
  LaneVec3<T> n00, n10, n01, n11;  ///< at (j, k)
  T square_j, square_k;

  KOKKOS_FORCEINLINE_FUNCTION explicit PlaneNormals(PlaneEdges<T> const& e)
      : j0(e.j0),
        j1(e.j1),
        k0(e.k0),
        k1(e.k1),
        n00(cross(e.j0, e.k0)),
        n10(cross(e.j0, e.k1)),
        n01(cross(e.j1, e.k0)),
        n11(cross(e.j1, e.k1)),
        square_j(larger(dot(e.j0, e.j0), dot(e.j1, e.j1))),
        square_k(larger(dot(e.k0, e.k0), dot(e.k1, e.k1))) {}
};

/// Coefficients in a plane: 4 at corners, twice those of its edges along j and k, 4 times that of the face.
template <class T>
struct PlaneCoefficients {
  T c00, c10, c01, c11, j0, j1, k0, k1, face;

  KOKKOS_FORCEINLINE_FUNCTION PlaneCoefficients(FourVectors<T> const& a, PlaneNormals<T> const& n)
      : c00(dot(a.v00, n.n00)),
        c10(dot(a.v10, n.n10)),
        c01(dot(a.v01, n.n01)),
        c11(dot(a.v11, n.n11)),
        j0(dot(a.v00, n.n10) + dot(a.v10, n.n00)),
        j1(dot(a.v01, n.n11) + dot(a.v11, n.n01)),
        k0(dot(a.v00, n.n01) + dot(a.v01, n.n00)),
        k1(dot(a.v10, n.n11) + dot(a.v11, n.n10)),
        face(((j0 + j1) + (k0 + k1)) - ((c00 + c10) + (c01 + c11))) {}
};

/// Calls put(i, j, k, b) for all coefficients of a cell. a: its edges along i; low, high: the planes on both sides.
template <class T, class Put>
KOKKOS_FORCEINLINE_FUNCTION void hex_coefficients(FourVectors<T> const& a, PlaneNormals<T> const& low,
                                                  PlaneNormals<T> const& high, Put const& put) {
  PlaneCoefficients<T> const l(a, low), h(a, high);
  auto const plane = [&](int i, PlaneCoefficients<T> const& p) {
    put(i, 0, 0, p.c00);
    put(i, 2, 0, p.c10);
    put(i, 0, 2, p.c01);
    put(i, 2, 2, p.c11);
    put(i, 1, 0, 0.5 * p.j0);
    put(i, 1, 2, 0.5 * p.j1);
    put(i, 0, 1, 0.5 * p.k0);
    put(i, 2, 1, 0.5 * p.k1);
    put(i, 1, 1, 0.25 * p.face);
  };
  plane(0, l);
  plane(2, h);
  // Twice the coefficients of the edges along i.
  T const e00 = dot(a.v00, cross(low.j0, high.k0) + cross(high.j0, low.k0)),
          e10 = dot(a.v10, cross(low.j0, high.k1) + cross(high.j0, low.k1)),
          e01 = dot(a.v01, cross(low.j1, high.k0) + cross(high.j1, low.k0)),
          e11 = dot(a.v11, cross(low.j1, high.k1) + cross(high.j1, low.k1));
  put(1, 0, 0, 0.5 * e00);
  put(1, 2, 0, 0.5 * e10);
  put(1, 0, 2, 0.5 * e01);
  put(1, 2, 2, 0.5 * e11);
  // Four times those of the faces along i.
  T const k0 = ((l.j0 + h.j0) + (e00 + e10)) - ((l.c00 + l.c10) + (h.c00 + h.c10)),
          k1 = ((l.j1 + h.j1) + (e01 + e11)) - ((l.c01 + l.c11) + (h.c01 + h.c11)),
          j0 = ((l.k0 + h.k0) + (e00 + e01)) - ((l.c00 + l.c01) + (h.c00 + h.c01)),
          j1 = ((l.k1 + h.k1) + (e10 + e11)) - ((l.c10 + l.c11) + (h.c10 + h.c11));
  put(1, 1, 0, 0.25 * k0);
  put(1, 1, 2, 0.25 * k1);
  put(1, 0, 1, 0.25 * j0);
  put(1, 2, 1, 0.25 * j1);
  put(1, 1, 1, 0.125 * (((k0 + k1) + (j0 + j1)) - ((e00 + e10) + (e01 + e11))));
}

template <class T>
KOKKOS_FORCEINLINE_FUNCTION T longest_square(FourVectors<T> const& a) {
  return square_extremes(a).max;
}

/// The sign of J in one cell; handedness: +1 or -1.
KOKKOS_INLINE_FUNCTION JacobianSign jacobian_sign(HexCell const& cell, double handedness) {
  auto const node = [&](int i, int j, int k) {
    Vec3 const& p = cell.corner[i + 2 * j + 4 * k];
    return LaneVec3<double>(p.x, p.y, p.z);
  };
  auto const plane = [&](int i) {
    return PlaneNormals<double>({node(i, 1, 0) - node(i, 0, 0), node(i, 1, 1) - node(i, 0, 1),
                                 node(i, 0, 1) - node(i, 0, 0), node(i, 1, 1) - node(i, 1, 0)});
  };
  FourVectors<double> const a{node(1, 0, 0) - node(0, 0, 0), node(1, 1, 0) - node(0, 1, 0),
                              node(1, 0, 1) - node(0, 0, 1), node(1, 1, 1) - node(0, 1, 1)};
  PlaneNormals<double> const low = plane(0), high = plane(1);
  BezierCube b;
  hex_coefficients(a, low, high, [&](int i, int j, int k, double value) { b.of[i][j][k] = handedness * value; });
  using compat::math::sqrt;
  double const la = sqrt(longest_square(a)), lb = sqrt(larger(low.square_j, high.square_j)),
               lc = sqrt(larger(low.square_k, high.square_k));
  return sign_of(b, sign_share * la * lb * lc, jacobian_tolerance(la, lb, lc, largest_component(cell.corner, 8)));
}

/// A lower bound of J, and what rounding may do to it and to the coefficients above; both times 64.
template <class T>
struct JacobianFloor {
  T least, arithmetic;
};

template <class T>
KOKKOS_FORCEINLINE_FUNCTION T absolute(T const& a) {
  return a < 0 ? -a : a;
}
/// |x| + |y| + |z|, no less than the length.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T sum_norm(LaneVec3<T> const& a) {
  return (absolute(a.x) + absolute(a.y)) + absolute(a.z);
}

/// A lower bound of J in cells. With coordinates from -1 to 1, 8 x = ... + A xi + B eta + C zeta + P xi eta + Q xi zeta
/// + R eta zeta + S xi eta zeta. Then 64 J is A . (B x C) and monomials, none of them larger anywhere than its
/// coefficient: those of xi, eta, zeta as they are, others no larger than the norms of their vectors allow. Loose where
/// cells are far from parallelepipeds; 200 flops.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION JacobianFloor<T> jacobian_floor(CellEdges<T> const& e, T const& handedness) {
  LaneVec3<T> const i0 = e.i.v00 + e.i.v10, i1 = e.i.v01 + e.i.v11, d0 = e.i.v10 - e.i.v00, d1 = e.i.v11 - e.i.v01;
  LaneVec3<T> const j0 = e.j.v00 + e.j.v10, j1 = e.j.v01 + e.j.v11;
  LaneVec3<T> const a = i0 + i1, b = j0 + j1, c = (e.k.v00 + e.k.v10) + (e.k.v01 + e.k.v11);
  LaneVec3<T> const p = d0 + d1, q = i1 - i0, r = j1 - j0, s = d1 - d0;
  LaneVec3<T> const bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  T const na = sum_norm(a), nb = sum_norm(b), nc = sum_norm(c);
  T const np = sum_norm(p), nq = sum_norm(q), nr = sum_norm(r), ns = sum_norm(s);
  T const first =
      (absolute(dot(ca, p) + dot(ab, q)) + absolute(dot(bc, p) + dot(ab, r))) + absolute(dot(bc, q) + dot(ca, r));
  T const with_s = (absolute(dot(bc, s)) + absolute(dot(ca, s))) + absolute(dot(ab, s));
  T const higher = ((na + nb) + (nc + ns)) * (np * (nq + nr) + nq * nr) + 2 * np * nq * nr +
                   ns * (na * (np + nq) + nb * (np + nr) + nc * (nq + nr));
  // Edges are (A +- P +- Q +- S) / 4 and so on.
  T const edges = ((na + np) + (nq + ns)) * ((nb + np) + (nr + ns)) * ((nc + nq) + (nr + ns));
  return {handedness * dot(a, bc) - ((first + with_s) + higher), broadcast<T>(16 * sign_share) * edges};
}

/// A mark for cells: 0 where all coefficients of cells are positive, 1 where one is not or may be round-off.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION T doubtful_coefficients(CellEdges<T> const& e, T const& handedness) {
  PlaneNormals<T> const low({e.j.v00, e.j.v01, e.k.v00, e.k.v01}), high({e.j.v10, e.j.v11, e.k.v10, e.k.v11});
  FourVectors<T> const a{handedness * e.i.v00, handedness * e.i.v10, handedness * e.i.v01, handedness * e.i.v11};
  T least = dot(a.v00, low.n00), centre = least;
  hex_coefficients(a, low, high, [&](int i, int j, int k, T const& value) {
    least = smaller(least, value);
    if (i == 1 && j == 1 && k == 1) centre = value;
  });
  // All corners enter the centre; extremes may drop what is no number.
  T const squares = longest_square(e.i) * larger(low.square_j, high.square_j) * larger(low.square_k, high.square_k) +
                    (centre - centre);
  T const clear = least > 0 ? least * least : broadcast<T>(-1);
  // What is no number compares as false.
  return clear > broadcast<T>(sign_share * sign_share) * squares ? broadcast<T>(0) : broadcast<T>(1);
}

/// mark[n]: 0 where the Jacobian of cell n is positive everywhere, 1 where jacobian_sign() has to tell.
template <int W>
KOKKOS_INLINE_FUNCTION void row_jacobian_signs(CellRow const& row, double* mark) {
  for_each_lanes<W>(row.count, [&]<class T>(int n) {
    CellEdges<T> const edges = row.edges<T>(n);
    T const handedness = broadcast<T>(row.handedness);
    JacobianFloor<T> const floor = jacobian_floor(edges, handedness);
    store_lanes(mark + n, floor.least > floor.arithmetic ? broadcast<T>(0) : broadcast<T>(1));
    double marked = 0;
    for (int m = 0; m < lane_count<T>; ++m) marked += mark[n + m];
    if (marked != 0) store_lanes(mark + n, doubtful_coefficients(row.edges<T>(n), handedness));
  });
}

namespace element {

/// The sign of J of a prism, by J along column k, per half of the triangle's edges at corner k.
KOKKOS_INLINE_FUNCTION JacobianSign prism_sign(ElementCorners const& c, double sign, double arithmetic, double zero) {
  Vec3 const r0 = c.at[1] - c.at[0], s0 = c.at[2] - c.at[0], r1 = c.at[4] - c.at[3], s1 = c.at[5] - c.at[3];
  Vec3 const n[3] = {sign * cross(r0, s0), 0.5 * sign * (cross(r0, s1) + cross(r1, s0)), sign * cross(r1, s1)};
  JacobianSign of_all = JacobianSign::positive;
  for (int k = 0; k < 3; ++k) {
    Vec3 const column = c.at[k + 3] - c.at[k];
    BezierCube b;
    for (int t = 0; t < 3; ++t)
      for (auto& line : b.of[t])
        for (double& value : line) value = dot(n[t], column);
    JacobianSign const s = sign_of(b, arithmetic, zero);
    if (s == JacobianSign::negative) return s;
    of_all = s > of_all ? s : of_all;
  }
  return of_all;
}

KOKKOS_INLINE_FUNCTION JacobianSign pyramid_sign(ElementCorners const& c, double sign, double arithmetic, double zero) {
  Vec3 const r[2] = {c.at[1] - c.at[0], c.at[2] - c.at[3]}, s[2] = {c.at[3] - c.at[0], c.at[2] - c.at[1]};
  Vec3 const axis[2][2] = {{c.at[4] - c.at[0], c.at[4] - c.at[3]}, {c.at[4] - c.at[1], c.at[4] - c.at[2]}};
  double sum[3][3] = {};
  // Products of what is linear in s (r, axis) and in r (s, axis): each falls on the coefficient with the sum of its
  // numbers.
  for (int i = 0; i < 2; ++i)      // of axis in r
    for (int j = 0; j < 2; ++j)    // of axis in s
      for (int m = 0; m < 2; ++m)  // of s in r
        for (int n = 0; n < 2; ++n) sum[i + m][j + n] += sign * dot(cross(r[n], s[m]), axis[i][j]);
  BezierCube b;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (double& value : b.of[i][j]) value = sum[i][j] * (i == 1 ? 0.5 : 1) * (j == 1 ? 0.5 : 1);
  return sign_of(b, arithmetic, zero);
}

/// The sign of J in an element of one type that is no hexahedron. In 2-D, corners decide: J is linear along each edge
/// of a quadrilateral.
template <ElementType type>
KOKKOS_INLINE_FUNCTION JacobianSign sign_of_type(ElementCorners const& c, double sign, Vec3 const& plane_normal) {
  EdgeLengths const e = edge_lengths<type>(c);
  double const zero = tolerance<type>(c, e), l = compat::math::sqrt(e.longest);
  double const arithmetic = smaller(zero, sign_share * l * l * (is_surface(type) ? 1 : l));
  if constexpr (type == ElementType::prism) {
    return prism_sign(c, sign, arithmetic, zero);
  } else if constexpr (type == ElementType::pyramid) {
    return pyramid_sign(c, sign, arithmetic, zero);
  } else {
    double least;
    if constexpr (type == ElementType::quadrilateral) {
      least = unbounded;
      for (int k = 0; k < 4; ++k) {
        Vec3 const u = c.at[(k + 1) % 4] - c.at[k], v = c.at[(k + 3) % 4] - c.at[k];
        double const j = sign * dot(cross(u, v), plane_normal);
        least = j >= least ? least : j;
      }
    } else {
      Vec3 const third = type == ElementType::tetrahedron ? c.at[3] - c.at[0] : plane_normal;
      least = sign * dot(cross(c.at[1] - c.at[0], c.at[2] - c.at[0]), third);
    }
    if (!(least >= -zero)) return JacobianSign::negative;
    return least > arithmetic ? JacobianSign::positive : JacobianSign::zero;
  }
}

}  // namespace element

/// The sign of J in an element that is no polyhedron; sign and plane_normal as in element_measures().
KOKKOS_INLINE_FUNCTION JacobianSign jacobian_sign(ElementType type, ElementCorners const& c, double sign,
                                                  Vec3 const& plane_normal) {
  switch (type) {
    case ElementType::triangle: return element::sign_of_type<ElementType::triangle>(c, sign, plane_normal);
    case ElementType::quadrilateral: return element::sign_of_type<ElementType::quadrilateral>(c, sign, plane_normal);
    case ElementType::tetrahedron: return element::sign_of_type<ElementType::tetrahedron>(c, sign, plane_normal);
    case ElementType::pyramid: return element::sign_of_type<ElementType::pyramid>(c, sign, plane_normal);
    case ElementType::prism: return element::sign_of_type<ElementType::prism>(c, sign, plane_normal);
    case ElementType::hexahedron: return jacobian_sign(hex_cell(c), sign);
    case ElementType::polyhedron: break;
  }
  return JacobianSign::undecided;
}

}  // namespace gridmorph::kernels
