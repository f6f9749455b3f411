// Second-order elements: where their Jacobian is positive, everywhere in them, and how much it varies.
//
// The map x(r, s, t) has a node amid each edge, and may have one amid each quadrilateral face and the element itself
// (SIDS: TRI_6, QUAD_8 and 9, TETRA_10, PYRA_13 and 14, PENTA_15 and 18, HEXA_20 and 27). Where those are missing, they
// are put where the element with fewer nodes has these points: amid a face (sum of edge nodes) / 2 - (sum of corners) /
// 4, amid a hexahedron both / 4.
//
// All are looked at over a cube of parameters u, v, w from 0 to 1. Triangles: l1 = u (1 - v), l2 = v; tetrahedra: l1 =
// u (1 - v)(1 - w), l2 = v (1 - w), l3 = w; prisms: a triangle, and w along the columns. Pyramids are hexahedra whose
// top is the apex: halfway up a lateral face has the points of a TRI_6, J has a factor (1 - w)^2, which is left out as
// in element_quality.hpp. So J, by the element's own coordinates, is a polynomial of some degree in each of u, v, w:
//
//   triangle (2, 2)   quadrilateral (3, 3)
//   tetrahedron (3, 3, 3)   prism (4, 4, 5)   pyramid (5, 5, 3)   hexahedron (5, 5, 5)
//
// Its Bezier coefficients, found from as many values, bound it, and those of its parts ever more closely: A. Johnen,
// J.-F. Remacle, C. Geuzaine, "Geometrical validity of curvilinear finite elements", J. Comput. Phys. 233 (2013) 359.
//
// determinant: min J / max J over the 27 (9) points with parameters 0, 1/2, 1, of triangles and tetrahedra sqrt(2)
// (2/sqrt(3)) min J over the largest product of the edges of a corner: what element_quality.hpp says of elements with
// straight edges. Volume: Gauss's rule of 27 points, exact.
//
// Cost: 700 flops per point; 54 of them for the measures, up to 216 for the sign and 8,000 flops for each part.
#pragma once

#include <gridmorph/kernels/jacobian_bounds.hpp>

namespace gridmorph::kernels {

inline constexpr int max_curved_nodes = 27;

/// How many nodes an element of second order has where it has all of them.
KOKKOS_INLINE_FUNCTION constexpr int n_curved_nodes(ElementType type) {
  constexpr int n[n_element_types] = {6, 9, 10, 14, 18, 27, 0};
  return n[int(type)];
}

/// Whether an element with that many nodes is of second order.
KOKKOS_INLINE_FUNCTION constexpr bool is_second_order(ElementType type, Index n_nodes) {
  if (type == ElementType::polyhedron) return false;
  Index const fewest = n_corners(type) + n_edges(type);
  return n_nodes == fewest || n_nodes == n_curved_nodes(type);
}

struct CurvedElement {
  ElementType type;
  Vec3 at[max_curved_nodes];
};

namespace curved {

/// The place in the list of nodes of the node amid two corners.
KOKKOS_INLINE_FUNCTION int middle_of(ElementType type, int a, int b) {
  for (int e = 0; e < n_edges(type); ++e) {
    int const p = edge_corner(type, e, 0), q = edge_corner(type, e, 1);
    if ((p == a && q == b) || (p == b && q == a)) return n_corners(type) + e;
  }
  return -1;
}

/// Puts the nodes amid faces and element where there are none.
KOKKOS_INLINE_FUNCTION void complete(CurvedElement& c) {
  ElementType const type = c.type;
  int place = n_corners(type) + n_edges(type);
  if (type == ElementType::quadrilateral) {
    c.at[place] =
        0.5 * ((c.at[4] + c.at[5]) + (c.at[6] + c.at[7])) - 0.25 * ((c.at[0] + c.at[1]) + (c.at[2] + c.at[3]));
    return;
  }
  if (is_surface(type)) return;
  for (int f = 0; f < n_faces(type); ++f) {
    if (n_face_corners(type, f) != 4) continue;
    Vec3 corners, middles;
    for (int k = 0; k < 4; ++k) {
      int const a = face_corner(type, f, k), b = face_corner(type, f, (k + 1) % 4);
      corners += c.at[a];
      middles += c.at[middle_of(type, a, b)];
    }
    c.at[place++] = 0.5 * middles - 0.25 * corners;
  }
  if (type != ElementType::hexahedron) return;
  Vec3 corners, middles;
  for (int k = 0; k < 8; ++k) corners += c.at[k];
  for (int k = 8; k < 20; ++k) middles += c.at[k];
  c.at[26] = 0.25 * middles - 0.25 * corners;
}

/// Nodes of a hexahedron at (a, b, c) / 2, number a + 3 b + 9 c; those of a quadrilateral are the first nine of its
/// table.
KOKKOS_INLINE_FUNCTION constexpr int hexahedron_node(int k) {
  constexpr std::int8_t node[27] = {0,  8,  1,  11, 20, 9,  3, 10, 2,  12, 21, 13, 24, 26,
                                    22, 15, 23, 14, 4,  16, 5, 19, 25, 17, 7,  18, 6};
  return node[k];
}
KOKKOS_INLINE_FUNCTION constexpr int quadrilateral_node(int k) {
  constexpr std::int8_t node[9] = {0, 4, 1, 7, 8, 5, 3, 6, 2};
  return node[k];
}

/// A pyramid as a hexahedron with its top in the apex, in the order of hexahedron_node()'s numbers.
KOKKOS_INLINE_FUNCTION Vec3 pyramid_node(CurvedElement const& c, int k) {
  constexpr std::int8_t base[9] = {0, 5, 1, 8, 13, 6, 3, 7, 2};
  if (k >= 18) return c.at[4];
  if (k < 9) return c.at[base[k]];
  // Halfway up: of a lateral edge its node; of a face with corners p, q the point of a TRI_6 at (1/4, 1/4, 1/2); amid
  // them as complete() does.
  auto const edge = [&](int corner) { return c.at[9 + corner]; };
  auto const face = [&](int p, int q) {
    return 0.5 * (edge(p) + edge(q)) + 0.25 * c.at[5 + p] - 0.125 * (c.at[p] + c.at[q]);
  };
  switch (k - 9) {
    case 0: return edge(0);
    case 2: return edge(1);
    case 6: return edge(3);
    case 8: return edge(2);
    case 1: return face(0, 1);
    case 5: return face(1, 2);
    case 7: return face(2, 3);
    case 3: return face(3, 0);
    default: break;
  }
  return 0.5 * ((face(0, 1) + face(1, 2)) + (face(2, 3) + face(3, 0))) -
         0.25 * ((edge(0) + edge(1)) + (edge(2) + edge(3)));
}

/// Quadratics through 0, 1/2, 1 and their slopes.
struct Line {
  double n[3], d[3];
  KOKKOS_INLINE_FUNCTION explicit Line(double u)
      : n{(1 - u) * (1 - 2 * u), 4 * u * (1 - u), u * (2 * u - 1)}, d{4 * u - 3, 4 - 8 * u, 4 * u - 1} {}
};

/// dx/dl_j of a simplex, its coordinates taken as independent: (4 l_j - 1) x_j + 4 sum of l_k x_jk. node(j, k): amid
/// corners, node(j, j): at one.
template <int Corners, class Node>
KOKKOS_INLINE_FUNCTION void simplex_slopes(double const (&l)[Corners], Node const& node, Vec3 (&slope)[Corners]) {
  for (int j = 0; j < Corners; ++j) {
    slope[j] = (4 * l[j] - 1) * node(j, j);
    for (int k = 0; k < Corners; ++k)
      if (k != j) slope[j] += (4 * l[k]) * node(j, k);
  }
}

KOKKOS_INLINE_FUNCTION double jacobian_of_lines(CurvedElement const& c, Vec3 const& p, Vec3 const& normal) {
  Line const u(p.x), v(p.y), w(p.z);
  bool const flat = c.type == ElementType::quadrilateral;
  Vec3 r, s, t;
  for (int k = 0; k < (flat ? 9 : 27); ++k) {
    int const a = k % 3, b = k / 3 % 3, h = k / 9;
    Vec3 const x = flat                                ? c.at[quadrilateral_node(k)]
                   : c.type == ElementType::hexahedron ? c.at[hexahedron_node(k)]
                                                       : pyramid_node(c, k);
    double const nw = flat ? 1 : w.n[h];
    r += (u.d[a] * v.n[b] * nw) * x;
    s += (u.n[a] * v.d[b] * nw) * x;
    if (!flat) t += (u.n[a] * v.n[b] * w.d[h]) * x;
  }
  return dot(cross(r, s), flat ? normal : t);
}

KOKKOS_INLINE_FUNCTION double jacobian_of_triangle(CurvedElement const& c, Vec3 const& p, Vec3 const& normal) {
  double const l[3] = {(1 - p.x) * (1 - p.y), p.x * (1 - p.y), p.y};
  Vec3 d[3];
  simplex_slopes<3>(
      l, [&](int j, int k) { return j == k ? c.at[j] : c.at[middle_of(c.type, j, k)]; }, d);
  return dot(cross(d[1] - d[0], d[2] - d[0]), normal);
}

KOKKOS_INLINE_FUNCTION double jacobian_of_tetrahedron(CurvedElement const& c, Vec3 const& p) {
  double const top = 1 - p.z;
  double const l[4] = {(1 - p.x) * (1 - p.y) * top, p.x * (1 - p.y) * top, p.y * top, p.z};
  Vec3 d[4];
  simplex_slopes<4>(
      l, [&](int j, int k) { return j == k ? c.at[j] : c.at[middle_of(c.type, j, k)]; }, d);
  return dot(cross(d[1] - d[0], d[2] - d[0]), d[3] - d[0]);
}

KOKKOS_INLINE_FUNCTION double jacobian_of_prism(CurvedElement const& c, Vec3 const& p) {
  double const l[3] = {(1 - p.x) * (1 - p.y), p.x * (1 - p.y), p.y};
  Line const w(p.z);
  // Corners and middles of edges 01, 12, 20 at the bottom, halfway up and at the top.
  constexpr std::int8_t corner[3][3] = {{0, 1, 2}, {9, 10, 11}, {3, 4, 5}};
  constexpr std::int8_t middle[3][3] = {{6, 7, 8}, {15, 16, 17}, {12, 13, 14}};
  Vec3 r, s, t;
  for (int h = 0; h < 3; ++h) {
    auto const node = [&](int j, int k) {
      if (j == k) return c.at[corner[h][j]];
      int const edge = j + k == 1 ? 0 : j + k == 3 ? 1 : 2;
      return c.at[middle[h][edge]];
    };
    Vec3 d[3];
    simplex_slopes<3>(l, node, d);
    r += w.n[h] * (d[1] - d[0]);
    s += w.n[h] * (d[2] - d[0]);
    Vec3 x;
    for (int j = 0; j < 3; ++j) {
      x += (l[j] * (2 * l[j] - 1)) * node(j, j);
      x += (4 * l[j] * l[(j + 1) % 3]) * node(j, (j + 1) % 3);
    }
    t += w.d[h] * x;
  }
  return dot(cross(r, s), t);
}

/// The value of J at a point of the cube; of pyramids with the factor (1 - w)^2.
KOKKOS_INLINE_FUNCTION double jacobian(CurvedElement const& c, Vec3 const& p, Vec3 const& normal) {
  switch (c.type) {
    case ElementType::triangle: return jacobian_of_triangle(c, p, normal);
    case ElementType::tetrahedron: return jacobian_of_tetrahedron(c, p);
    case ElementType::prism: return jacobian_of_prism(c, p);
    default: return jacobian_of_lines(c, p, normal);
  }
}

/// The ratio of J dV / (du dv dw) to J.
KOKKOS_INLINE_FUNCTION double collapse(ElementType type, Vec3 const& p) {
  switch (type) {
    case ElementType::triangle:
    case ElementType::prism: return 1 - p.y;
    case ElementType::tetrahedron: return (1 - p.y) * (1 - p.z) * (1 - p.z);
    default: return 1;
  }
}

inline constexpr int max_degree = 5;

struct Degrees {
  int of[3];
};
/// The degrees of J in u, v, w, of pyramids with their factor; 0 along w in 2-D.
KOKKOS_INLINE_FUNCTION Degrees degrees(ElementType type) {
  switch (type) {
    case ElementType::triangle: return {{2, 2, 0}};
    case ElementType::quadrilateral: return {{3, 3, 0}};
    case ElementType::tetrahedron: return {{3, 3, 3}};
    case ElementType::prism: return {{4, 4, 5}};
    default: return {{5, 5, 5}};
  }
}

/// Rows: Bezier coefficient i of the polynomial of a degree that has given values at 0, 1 / degree, ..., 1.
struct BezierOfValues {
  double of[max_degree + 1][max_degree + 1];
};
KOKKOS_INLINE_FUNCTION constexpr BezierOfValues bezier_of_values(int degree) {
  constexpr double binomial[max_degree + 1][max_degree + 1] = {{1, 0, 0, 0, 0, 0}, {1, 1, 0, 0, 0, 0},
                                                               {1, 2, 1, 0, 0, 0}, {1, 3, 3, 1, 0, 0},
                                                               {1, 4, 6, 4, 1, 0}, {1, 5, 10, 10, 5, 1}};
  double a[max_degree + 1][max_degree + 1] = {};
  BezierOfValues inverse{};
  for (int row = 0; row <= degree; ++row) {
    double const u = degree == 0 ? 0 : double(row) / degree;
    for (int k = 0; k <= degree; ++k) {
      double value = binomial[degree][k];
      for (int m = 0; m < k; ++m) value *= u;
      for (int m = 0; m < degree - k; ++m) value *= 1 - u;
      a[row][k] = value;
    }
    inverse.of[row][row] = 1;
  }
  // A table of constants, by elimination; Bernstein polynomials on even points need no pivoting.
  for (int p = 0; p <= degree; ++p)
    for (int row = 0; row <= degree; ++row) {
      if (row == p) continue;
      double const factor = a[row][p] / a[p][p];
      for (int k = 0; k <= degree; ++k) {
        a[row][k] -= factor * a[p][k];
        inverse.of[row][k] -= factor * inverse.of[p][k];
      }
    }
  for (int row = 0; row <= degree; ++row)
    for (int k = 0; k <= degree; ++k) inverse.of[row][k] /= a[row][row];
  return inverse;
}

/// Bezier coefficients over a box of parameters.
struct BezierBox {
  Degrees degree;
  double of[max_degree + 1][max_degree + 1][max_degree + 1];

  /// line(entry(k)) for all lines along an axis.
  template <class Function>
  KOKKOS_INLINE_FUNCTION void for_each_line(int axis, Function const& line) {
    int const a = (axis + 1) % 3, b = (axis + 2) % 3;
    int at[3];
    for (at[a] = 0; at[a] <= degree.of[a]; ++at[a])
      for (at[b] = 0; at[b] <= degree.of[b]; ++at[b]) {
        auto const entry = [&](int k) -> double& {
          at[axis] = k;
          return of[at[0]][at[1]][at[2]];
        };
        line(entry);
      }
  }
  /// Becomes that of the part from `low` to `high` along an axis (de Casteljau).
  KOKKOS_INLINE_FUNCTION void restrict(int axis, double low, double high) {
    int const n = degree.of[axis];
    for_each_line(axis, [&](auto const& entry) {
      for (int level = 1; level <= n; ++level)  // to [0, high]
        for (int k = n; k >= level; --k) entry(k) = (1 - high) * entry(k - 1) + high * entry(k);
      double const t = high > 0 ? low / high : 0;
      for (int level = 1; level <= n; ++level)  // to [low, high]
        for (int k = 0; k <= n - level; ++k) entry(k) = (1 - t) * entry(k) + t * entry(k + 1);
    });
  }
  template <class Take>
  KOKKOS_INLINE_FUNCTION void for_each(Take const& take) const {
    for (int i = 0; i <= degree.of[0]; ++i)
      for (int j = 0; j <= degree.of[1]; ++j)
        for (int k = 0; k <= degree.of[2]; ++k) {
          auto const end = [](int at, int n) { return at == 0 || at == n; };
          take(of[i][j][k], end(i, degree.of[0]) && end(j, degree.of[1]) && end(k, degree.of[2]));
        }
  }
};

/// Bezier coefficients of J of the whole element, of pyramids without their factor.
KOKKOS_INLINE_FUNCTION BezierBox bezier_box(CurvedElement const& c, double sign, Vec3 const& normal) {
  BezierBox b;
  b.degree = degrees(c.type);
  int const* const n = b.degree.of;
  for (int i = 0; i <= n[0]; ++i)
    for (int j = 0; j <= n[1]; ++j)
      for (int k = 0; k <= n[2]; ++k)
        b.of[i][j][k] =
            sign * jacobian(c, {double(i) / n[0], double(j) / n[1], n[2] == 0 ? 0 : double(k) / n[2]}, normal);
  constexpr BezierOfValues tables[max_degree + 1] = {bezier_of_values(0), bezier_of_values(1), bezier_of_values(2),
                                                     bezier_of_values(3), bezier_of_values(4), bezier_of_values(5)};
  for (int axis = 0; axis < 3; ++axis) {
    BezierOfValues const& table = tables[n[axis]];
    b.for_each_line(axis, [&](auto const& entry) {
      double value[max_degree + 1];
      for (int k = 0; k <= n[axis]; ++k) value[k] = entry(k);
      for (int k = 0; k <= n[axis]; ++k) {
        double sum = 0;
        for (int m = 0; m <= n[axis]; ++m) sum += table.of[k][m] * value[m];
        entry(k) = sum;
      }
    });
  }
  if (c.type == ElementType::pyramid) {
    // Divided by (1 - w)^2: binomials of degree 5 over those of degree 3.
    constexpr double ratio[4] = {1, 5.0 / 3, 10.0 / 3, 10};
    b.for_each_line(2, [&](auto const& entry) {
      for (int k = 0; k < 4; ++k) entry(k) *= ratio[k];
    });
    b.degree.of[2] = 3;
  }
  return b;
}

}  // namespace curved

namespace curved {

/// Size of Jacobians that mean zero, of the element with the same corners and straight edges.
KOKKOS_INLINE_FUNCTION double tolerance(ElementType type, ElementCorners const& c) {
  switch (type) {
    case ElementType::triangle:
      return element::tolerance<ElementType::triangle>(c, element::edge_lengths<ElementType::triangle>(c));
    case ElementType::quadrilateral:
      return element::tolerance<ElementType::quadrilateral>(c, element::edge_lengths<ElementType::quadrilateral>(c));
    case ElementType::tetrahedron:
      return element::tolerance<ElementType::tetrahedron>(c, element::edge_lengths<ElementType::tetrahedron>(c));
    case ElementType::pyramid:
      return element::tolerance<ElementType::pyramid>(c, element::edge_lengths<ElementType::pyramid>(c));
    case ElementType::prism:
      return element::tolerance<ElementType::prism>(c, element::edge_lengths<ElementType::prism>(c));
    default: {
      HexEdges const edges = hex_edges(hex_cell(c));
      double longest[3] = {0, 0, 0};
      for (int d = 0; d < 3; ++d)
        for (int e = 0; e < 4; ++e) longest[d] = larger(longest[d], norm(edges.of[d][e]));
      return jacobian_tolerance(longest[0], longest[1], longest[2], largest_component(c.at, 8));
    }
  }
}

}  // namespace curved

/// Whether J is positive everywhere; c: complete, corners: its first nodes.
KOKKOS_INLINE_FUNCTION JacobianSign curved_sign(CurvedElement const& c, ElementCorners const& corners, double sign,
                                                Vec3 const& plane_normal) {
  constexpr int deepest = 6;
  curved::BezierBox const whole = curved::bezier_box(c, sign, plane_normal);
  double size = 0, sum = 0;
  whole.for_each([&](double b, bool) {
    size = larger(size, b < 0 ? -b : b);
    sum += b;
  });
  if (!is_finite(sum)) return JacobianSign::negative;
  double const zero = curved::tolerance(c.type, corners);
  double const arithmetic = 0x1p-34 * size, tolerance = larger(zero, arithmetic);
  int const dimension = whole.degree.of[2] == 0 ? 2 : 3, all = (1 << dimension) - 1;
  JacobianSign found = JacobianSign::positive;
  // Parts of parts in the order of their codes, `dimension` bits for each level.
  Index code = 0;
  int level = 0;
  while (true) {
    curved::BezierBox part = whole;
    double const width = 1.0 / double(Index(1) << level);
    for (int axis = 0; axis < dimension && level > 0; ++axis) {
      Index at = 0;
      for (int l = 0; l < level; ++l) at |= (code >> (l * dimension + axis) & 1) << l;
      part.restrict(axis, double(at) * width, double(at + 1) * width);
    }
    double least = unbounded, least_corner = unbounded;
    part.for_each([&](double b, bool corner) {
      least = smaller(least, b);
      if (corner) least_corner = smaller(least_corner, b);
    });
    if (least_corner < -tolerance) return JacobianSign::negative;
    if (least < -tolerance && level < deepest) {
      code <<= dimension;
      ++level;
      continue;
    }
    if (least < -tolerance)
      found = JacobianSign::undecided;
    else if (!(least > arithmetic) && found == JacobianSign::positive)
      found = JacobianSign::zero;
    while (level > 0 && (code & all) == all) {
      code >>= dimension;
      --level;
    }
    if (level == 0) return found;
    ++code;
  }
}

/// Smallest and largest J over the points with parameters 0, 1/2, 1, over the corners among them, and its integral.
struct CurvedRange {
  double corner_min = unbounded, corner_max = -unbounded, all_min = unbounded, all_max = -unbounded, volume = 0;
};

KOKKOS_INLINE_FUNCTION CurvedRange curved_range(CurvedElement const& c, double sign, Vec3 const& plane_normal) {
  bool const flat = is_surface(c.type);
  CurvedRange r;
  for (int n = 0; n < (flat ? 9 : 27); ++n) {
    int const at[3] = {n % 3, n / 3 % 3, flat ? 0 : n / 9};
    // Of pyramids the two levels where the factor is not zero: at the base and halfway up.
    bool const pyramid = c.type == ElementType::pyramid;
    if (pyramid && at[2] == 2) continue;
    double const factor = pyramid ? (at[2] == 0 ? 1.0 : 4.0) : 1.0;
    double const j = factor * sign * curved::jacobian(c, {0.5 * at[0], 0.5 * at[1], 0.5 * at[2]}, plane_normal);
    r.all_min = j >= r.all_min ? r.all_min : j;  // what is no number stays
    r.all_max = larger(r.all_max, j);
    if (at[0] == 1 || at[1] == 1 || at[2] == 1) continue;
    r.corner_min = smaller(r.corner_min, j);
    r.corner_max = larger(r.corner_max, j);
  }
  constexpr double point[3] = {0.11270166537925831148, 0.5, 0.88729833462074168852};
  constexpr double weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  for (int n = 0; n < (flat ? 9 : 27); ++n) {
    int const a = n % 3, b = n / 3 % 3, d = n / 9;
    Vec3 const p{point[a], point[b], flat ? 0 : point[d]};
    double const w = weight[a] * weight[b] * (flat ? 1 : weight[d]);
    r.volume += w * sign * curved::collapse(c.type, p) * curved::jacobian(c, p, plane_normal);
  }
  return r;
}

/// All measures: determinants, Jacobians and volume of the curved element, all else by its corners.
KOKKOS_INLINE_FUNCTION CellMeasures curved_measures(CurvedElement const& c, ElementCorners const& corners, double sign,
                                                    Vec3 const& plane_normal) {
  CellMeasures m = element_measures(c.type, corners, sign, plane_normal);
  CurvedRange const j = curved_range(c, sign, plane_normal);
  if (!is_finite(m.volume) || !is_finite(j.volume) || !is_finite(j.all_min)) return invalid_cell();
  double const zero = curved::tolerance(c.type, corners);
  double const least = without_noise(j.all_min, zero), most = without_noise(j.all_max, zero);
  m.volume = j.volume;
  m.smallest_corner_jacobian = least;  // nodes amid edges count like corners
  m.largest_corner_jacobian = most;
  if (c.type == ElementType::triangle || c.type == ElementType::tetrahedron) {
    m.determinant_3x3x3 = c.type == ElementType::triangle
                              ? element::scaled_simplex<ElementType::triangle>(
                                    element::edge_lengths<ElementType::triangle>(corners), least)
                              : element::scaled_simplex<ElementType::tetrahedron>(
                                    element::edge_lengths<ElementType::tetrahedron>(corners), least);
    m.determinant_2x2x2 = m.determinant_3x3x3;
  } else {
    m.determinant_2x2x2 = determinant_ratio(without_noise(j.corner_min, zero), without_noise(j.corner_max, zero));
    m.determinant_3x3x3 = determinant_ratio(least, most);
  }
  return m;
}

}  // namespace gridmorph::kernels
