#include <gridmorph/mapping/detail/facet_shape.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph::mapping {

namespace {

constexpr int most_iterations = 50;
/// Steps in the unit square below this do not count.
constexpr double converged = 1e-14;
/// Distances that differ by less than this share are equal: the last steps of Newton's method change the place only.
constexpr double rounding = 1e-12;

double squared(Vec3 const& v) { return dot(v, v); }

}  // namespace

Vec3 FacetShape::at(double a, double b) const {
  auto const& c = corner_;
  if (corners_ == 3) return c[0] + a * (c[1] - c[0]) + b * (c[2] - c[0]);
  return c[0] + a * (c[1] - c[0]) + b * (c[3] - c[0]) + (a * b) * ((c[2] - c[1]) + (c[0] - c[3]));
}

std::array<Vec3, 2> FacetShape::tangents(double a, double b) const {
  auto const& c = corner_;
  if (corners_ == 3) return {c[1] - c[0], c[2] - c[0]};
  Vec3 const twist = (c[2] - c[1]) + (c[0] - c[3]);
  return {c[1] - c[0] + b * twist, c[3] - c[0] + a * twist};
}

std::array<double, 4> FacetShape::shape(double a, double b) const {
  if (corners_ == 3) return {1 - a - b, a, b, 0};
  return {(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b};
}

std::array<double, 4> FacetShape::shape_change(double a, double b, double da, double db) const {
  if (corners_ == 3) return {-da - db, da, db, 0};
  return {-(1 - b) * da - (1 - a) * db, (1 - b) * da - a * db, b * da + a * db, -b * da + (1 - a) * db};
}

bool FacetShape::on_side(FacetPoint const& p, int s) const {
  if (corners_ == 3) return s == 0 ? p.b == 0 : s == 1 ? p.a + p.b >= 1 - rounding : p.a == 0;
  return s == 0 ? p.b == 0 : s == 1 ? p.a == 1 : s == 2 ? p.b == 1 : p.a == 0;
}

Vec3 FacetShape::area_vector() const {
  auto const& c = corner_;
  if (corners_ == 3) return cross(c[1] - c[0], c[2] - c[0]);
  return cross(c[2] - c[0], c[3] - c[1]);
}

/// C. Ericson, "Real-Time Collision Detection" (2005), section 5.1.5: the Voronoi region of the position decides.
FacetPoint FacetShape::closest_on_triangle(Vec3 const& q, int i, int j, int k) const {
  Vec3 const ab = corner_[j] - corner_[i], ac = corner_[k] - corner_[i];
  auto const point = [&](double a, double b) {
    FacetPoint p{a, b, corner_[i] + a * ab + b * ac, 0};
    p.squared = squared(p.position - q);
    return p;
  };
  Vec3 const ap = q - corner_[i], bp = q - corner_[j], cp = q - corner_[k];
  double const d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
               d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return point(0, 0);
  if (d3 >= 0 && d4 <= d3) return point(1, 0);
  double const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return point(d1 / (d1 - d3), 0);
  if (d6 >= 0 && d5 <= d6) return point(0, 1);
  double const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return point(0, d2 / (d2 - d6));
  double const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    double const b = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return point(1 - b, b);
  }
  double const sum = va + vb + vc;
  return point(vb / sum, vc / sum);
}

/// Newton's method for the smallest distance in the unit square, held at its sides, from the closest point of the two
/// triangles on either diagonal.
FacetPoint FacetShape::closest(Vec3 const& q) const {
  if (corners_ == 3) return closest_on_triangle(q, 0, 1, 2);
  auto const point = [&](double a, double b) {
    FacetPoint p{a, b, at(a, b), 0};
    p.squared = squared(p.position - q);
    return p;
  };
  FacetPoint const lower = closest_on_triangle(q, 0, 1, 2), upper = closest_on_triangle(q, 0, 2, 3);
  // Triangle 0 1 2: a along 01, then up with b; triangle 0 2 3: diagonal first.
  FacetPoint const from_lower = point(std::min(1.0, lower.a + lower.b), lower.b),
                   from_upper = point(upper.a, std::min(1.0, upper.a + upper.b));
  FacetPoint best = from_lower.squared <= from_upper.squared ? from_lower : from_upper;
  Vec3 const twist = (corner_[2] - corner_[1]) + (corner_[0] - corner_[3]);
  for (int n = 0; n < most_iterations; ++n) {
    auto const [ta, tb] = tangents(best.a, best.b);
    Vec3 const r = best.position - q;
    double const ga = dot(r, ta), gb = dot(r, tb);
    // A side holds the point as long as the distance would fall beyond it.
    bool const held_a = (best.a == 0 && ga > 0) || (best.a == 1 && ga < 0);
    bool const held_b = (best.b == 0 && gb > 0) || (best.b == 1 && gb < 0);
    double const haa = dot(ta, ta), hbb = dot(tb, tb);
    double hab = dot(ta, tb) + dot(r, twist);
    if (haa * hbb - hab * hab <= 0) hab = dot(ta, tb);
    double da = held_a || haa == 0 ? 0 : -ga / haa, db = held_b || hbb == 0 ? 0 : -gb / hbb;
    if (double const determinant = haa * hbb - hab * hab; !held_a && !held_b && determinant > 0) {
      da = (-ga * hbb + gb * hab) / determinant;
      db = (-gb * haa + ga * hab) / determinant;
    }
    FacetPoint next = best;
    double step = 0;
    for (double share = 1; share > 1e-4; share /= 4) {
      double const a = std::clamp(best.a + share * da, 0.0, 1.0), b = std::clamp(best.b + share * db, 0.0, 1.0);
      FacetPoint const tried = point(a, b);
      if (tried.squared > (1 + rounding) * best.squared) continue;
      step = std::max(std::fabs(a - best.a), std::fabs(b - best.b));
      next = tried;
      break;
    }
    best = next;
    if (step < converged) break;
  }
  return best;
}

}  // namespace gridmorph::mapping
