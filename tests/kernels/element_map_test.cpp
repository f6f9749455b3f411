// Maps of unstructured elements, their inverses, and nearest places: analytic elements, random ones, broken ones.
#include "support/random.hpp"

#include <gridmorph/kernels/element_place.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

namespace gridmorph::test {
namespace {

using kernels::ElementCorners;
using kernels::ElementInverse;
using kernels::ElementJacobian;
using kernels::ElementPlace;
using kernels::ElementWeights;
using kernels::is_finite;
using kernels::unbounded;

constexpr std::array all_types{ElementType::triangle, ElementType::quadrilateral, ElementType::tetrahedron,
                               ElementType::pyramid,  ElementType::prism,         ElementType::hexahedron};

/// The element whose corners have their local coordinates as positions, moved.
ElementCorners element_of(ElementType type, std::function<Vec3(Vec3)> const& move) {
  ElementCorners c;
  for (int k = 0; k < n_corners(type); ++k) c.at[k] = move(corner_local(type, k));
  return c;
}

Vec3 random_inside(ElementType type, Random& random) {
  for (;;) {
    Vec3 const l{random.unit(), random.unit(), is_surface(type) ? 0 : random.unit()};
    if (kernels::element::excess(type, l) == 0) return l;
  }
}

/// Smallest Jacobian determinant over a lattice of places inside, by central differences of positions.
double smallest_determinant(ElementType type, ElementCorners const& c) {
  double least = unbounded;
  constexpr double h = 1e-5;
  for (int k = 0; k <= 8; ++k)
    for (int j = 0; j <= 8; ++j)
      for (int i = 0; i <= 8; ++i) {
        Vec3 const l{i / 8.0, j / 8.0, is_surface(type) ? 0 : k / 8.0 * 0.98};
        if (kernels::element::excess(type, l) > 0) continue;
        auto const slope = [&](Vec3 const& e) {
          return (0.5 / h) * (element_position(type, c, l + h * e) - element_position(type, c, l - h * e));
        };
        Vec3 const r = slope({1, 0, 0}), s = slope({0, 1, 0});
        least = std::min(least, is_surface(type) ? cross(r, s).z : dot(cross(r, s), slope({0, 0, 1})));
      }
  return least;
}

/// A random element of the given warp with a Jacobian that is positive throughout.
ElementCorners random_sound(ElementType type, double warp, Random& random) {
  for (;;) {
    ElementCorners c = element_of(type, [&](Vec3 l) {
      Vec3 const shift = random.vector(warp);
      return l + (is_surface(type) ? Vec3{shift.x, shift.y, 0} : shift);
    });
    if (smallest_determinant(type, c) > 0.03) return c;
  }
}

double largest(Vec3 const& a) { return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)}); }

TEST(ElementMap, WeightsSumToOneAndAreOneAtTheirCorners) {
  Random random(1);
  for (auto const type : all_types) {
    SCOPED_TRACE(int(type));
    for (int k = 0; k < n_corners(type); ++k) {
      ElementWeights const w = element_weights(type, corner_local(type, k));
      for (int n = 0; n < max_corners; ++n) EXPECT_EQ(w.of[n], n == k ? 1 : 0);
    }
    for (int n = 0; n < 100; ++n) {
      ElementWeights const w = element_weights(type, random_inside(type, random));
      double sum = 0;
      for (double const a : w.of) {
        EXPECT_GE(a, -1e-16);
        sum += a;
      }
      EXPECT_NEAR(sum, 1, 1e-15);
    }
  }
}

TEST(ElementMap, LinearFieldsAreReproduced) {
  // The field is the position in an affinely moved copy.
  Random random(2);
  for (auto const type : all_types) {
    SCOPED_TRACE(int(type));
    ElementCorners const here = random_sound(type, 0.2, random);
    auto const field = [](Vec3 const& x) { return 3 + 2 * x.x - 5 * x.y + 7 * x.z; };
    for (int n = 0; n < 100; ++n) {
      Vec3 const l = random_inside(type, random);
      ElementWeights const w = element_weights(type, l);
      double sum = 0;
      for (int k = 0; k < n_corners(type); ++k) sum += w.of[k] * field(here.at[k]);
      EXPECT_NEAR(sum, field(element_position(type, here, l)), 1e-13);
    }
  }
}

TEST(ElementMap, FacesDependOnTheirOwnCornersAlone) {
  Random random(3);
  for (auto const type : all_types) {
    for (int f = 0; f < n_faces(type); ++f) {
      // Between the corners of a face every place has weights of those only.
      int const n = n_face_corners(type, f);
      double sum = 0;
      Vec3 l;
      for (int k = 0; k < n; ++k) {
        double const a = random.between(0.1, 1);
        l += a * corner_local(type, face_corner(type, f, k));
        sum += a;
      }
      ElementWeights const w = element_weights(type, (1 / sum) * l);
      for (int c = 0; c < n_corners(type); ++c) {
        bool on_face = false;
        for (int k = 0; k < n; ++k) on_face = on_face || face_corner(type, f, k) == c;
        if (on_face) continue;
        EXPECT_NEAR(w.of[c], 0, 1e-15) << int(type) << " face " << f << " corner " << c;
      }
    }
  }
}

TEST(ElementMap, JacobianIsTheDerivativeOfThePosition) {
  Random random(4);
  constexpr double h = 1e-6;
  for (auto const type : all_types) {
    SCOPED_TRACE(int(type));
    ElementCorners const c = random_sound(type, 0.2, random);
    for (int n = 0; n < 20; ++n) {
      Vec3 const l = 0.9 * random_inside(type, random);
      ElementJacobian const j = element_jacobian(type, c, l);
      auto const slope = [&](Vec3 const& e) {
        return (0.5 / h) * (element_position(type, c, l + h * e) - element_position(type, c, l - h * e));
      };
      EXPECT_LT(largest(j.r - slope({1, 0, 0})), 1e-8);
      EXPECT_LT(largest(j.s - slope({0, 1, 0})), 1e-8);
      EXPECT_LT(largest(j.t - (is_surface(type) ? Vec3{} : slope({0, 0, 1}))), 1e-8);
    }
  }
}

TEST(ElementMap, PointsOfWarpedElementsComeBack) {
  Random random(5);
  for (auto const type : all_types)
    for (double const warp : {0.0, 0.1, 0.25, 0.4}) {
      for (int n = 0; n < 300; ++n) {
        ElementCorners const c = random_sound(type, warp, random);
        for (int m = 0; m < 20; ++m) {
          Vec3 const l = random_inside(type, random);
          Vec3 const p = element_position(type, c, l);
          ElementInverse const found = invert_element(type, c, p, 0);
          ASSERT_TRUE(found.converged) << int(type) << " warp " << warp;
          ASSERT_LT(largest(found.local - l), 2e-12) << int(type) << " warp " << warp;
        }
      }
    }
}

TEST(ElementMap, FlatAndShearedElementsAreNoHarderThanOthers) {
  Random random(6);
  for (auto const type : all_types)
    for (double const height : {1e-4, 1e-7}) {
      for (int n = 0; n < 100; ++n) {
        ElementCorners c = random_sound(type, 0.2, random);
        for (Vec3& x : c.at)
          x = is_surface(type) ? Vec3{x.x + 3 * x.y, height * x.y, 0}
                               : Vec3{x.x + 2 * x.z, 0.5 * x.x + x.y, height * x.z + 0.3 * x.x};
        for (int m = 0; m < 20; ++m) {
          Vec3 const l = random_inside(type, random);
          ElementInverse const found = invert_element(type, c, element_position(type, c, l), 1e-3);
          ASSERT_TRUE(found.converged) << int(type);
          ASSERT_LT(largest(found.local - l), 1e-14 / height) << int(type);
        }
      }
    }
}

TEST(ElementMap, ApexOfAPyramidIsAPlaceLikeOthers) {
  Random random(7);
  for (int n = 0; n < 100; ++n) {
    ElementCorners const c = random_sound(ElementType::pyramid, 0.25, random);
    ElementWeights w;
    Vec3 local;
    ASSERT_TRUE(element_contains(ElementType::pyramid, c, c.at[4], 1e-14, local));
    w = element_weights(ElementType::pyramid, local);
    EXPECT_NEAR(w.of[4], 1, 1e-14);
    for (double const below : {1e-3, 1e-6, 1e-9, 1e-12}) {
      Vec3 const l{below * random.unit(), below * random.unit(), 1 - below};
      Vec3 const p = element_position(ElementType::pyramid, c, l);
      ASSERT_TRUE(element_contains(ElementType::pyramid, c, p, 1e-14, local));
      EXPECT_LT(largest(local - l), 1e-13);
      EXPECT_LT(distance(element_position(ElementType::pyramid, c, local), p), 1e-14);
    }
  }
}

/// The nearest of many places on all faces, each found by dividing the face around the best place so far.
double sampled_distance(ElementType type, ElementCorners const& c, Vec3 const& p) {
  double best = unbounded;
  int const faces = is_surface(type) ? 1 : n_faces(type);
  for (int f = 0; f < faces; ++f) {
    int const n = is_surface(type) ? n_corners(type) : n_face_corners(type, f);
    auto const corner = [&](int k) { return corner_local(type, is_surface(type) ? k : face_corner(type, f, k)); };
    auto const at = [&](double u, double v) {
      if (n == 3 && u + v > 1) return unbounded;
      Vec3 const l = corner(0) + u * (corner(1) - corner(0)) + v * (corner(n - 1) - corner(0));
      return distance(element_position(type, c, l), p);
    };
    double u = 0.5, v = 0.5, width = 1, least = unbounded;
    for (int level = 0; level < 8; ++level, width *= 0.3) {
      double const cu = u, cv = v;
      for (int i = -6; i <= 6; ++i)
        for (int j = -6; j <= 6; ++j) {
          double const tu = std::clamp(cu + i * width / 6, 0.0, 1.0), tv = std::clamp(cv + j * width / 6, 0.0, 1.0);
          double const d = at(tu, tv);
          if (d >= least) continue;
          least = d;
          u = tu;
          v = tv;
        }
    }
    best = std::min(best, least);
  }
  return best;
}

TEST(ElementPlace, NearestPlaceIsAsNearAsAnyOnTheFaces) {
  Random random(8);
  for (auto const type : all_types)
    for (double const warp : {0.0, 0.2, 0.4}) {
      int outside = 0;
      for (int n = 0; n < 80; ++n) {
        ElementCorners const c = random_sound(type, warp, random);
        Vec3 p = Vec3{0.5, 0.5, 0.5} + random.vector(2);
        if (is_surface(type)) p.z = 0;
        Vec3 local;
        if (element_contains(type, c, p, 1e-12, local)) continue;
        ++outside;
        ElementPlace const place = nearest_in_element(type, c, p);
        EXPECT_EQ(kernels::element::excess(type, place.local), 0);
        EXPECT_NEAR(distance(element_position(type, c, place.local), p), place.distance, 1e-14);
        EXPECT_LT(place.distance, 1.01 * sampled_distance(type, c, p) + 1e-9) << int(type) << " warp " << warp;
      }
      EXPECT_GT(outside, 30);
    }
}

TEST(ElementPlace, PlaneAndStraightElementsAreExact) {
  // Beside a unit cube, above a face, an edge and a corner of it.
  ElementCorners const cube = element_of(ElementType::hexahedron, [](Vec3 l) { return l; });
  EXPECT_EQ(nearest_in_element(ElementType::hexahedron, cube, {0.25, 0.75, 3}).distance, 2);
  EXPECT_EQ(nearest_in_element(ElementType::hexahedron, cube, {0.25, 0.75, 3}).local, (Vec3{0.25, 0.75, 1}));
  EXPECT_EQ(nearest_in_element(ElementType::hexahedron, cube, {4, 5, 0.5}).distance, 5);
  EXPECT_EQ(nearest_in_element(ElementType::hexahedron, cube, {4, 5, 0.5}).local, (Vec3{1, 1, 0.5}));
  EXPECT_EQ(nearest_in_element(ElementType::hexahedron, cube, {-1, -2, -2}).distance, 3);
  EXPECT_EQ(nearest_in_element(ElementType::hexahedron, cube, {-1, -2, -2}).local, (Vec3{0, 0, 0}));
}

TEST(ElementPlace, PointsOnFacesAndCornersAreInside) {
  Random random(9);
  for (auto const type : all_types)
    for (int n = 0; n < 200; ++n) {
      ElementCorners const c = random_sound(type, 0.2, random);
      Vec3 local;
      for (int k = 0; k < n_corners(type); ++k) {
        ASSERT_TRUE(element_contains(type, c, c.at[k], 1e-14, local)) << int(type) << " corner " << k;
        EXPECT_LT(largest(local - corner_local(type, k)), 1e-14);
      }
      for (int f = 0; f < n_faces(type); ++f) {
        int const m = n_face_corners(type, f);
        double const u = random.unit() * 0.5, v = random.unit() * 0.5;
        Vec3 const a = corner_local(type, face_corner(type, f, 0)), b = corner_local(type, face_corner(type, f, 1)),
                   d = corner_local(type, face_corner(type, f, m - 1));
        Vec3 const l = m == 2 ? a + u * (b - a) : a + u * (b - a) + v * (d - a);
        ASSERT_TRUE(element_contains(type, c, element_position(type, c, l), 1e-13, local)) << int(type);
        EXPECT_LT(largest(local - l), 1e-12);
      }
    }
}

bool sane(ElementType type, Vec3 const& l) {
  return is_finite(l.x) && is_finite(l.y) && is_finite(l.z) && kernels::element::excess(type, l) <= 1e-12;
}

TEST(ElementPlace, BrokenElementsGiveNumbersAndEnd) {
  Random random(10);
  for (auto const type : all_types)
    for (int n = 0; n < 3000; ++n) {
      ElementCorners c = element_of(type, [&](Vec3 l) { return l; });
      int const kind = n % 6;
      for (int k = 0; k < n_corners(type); ++k) {
        if (kind == 0) c.at[k] = random.vector(1);                        // inside out here and there
        if (kind == 1) c.at[k] = {random.unit(), 0, 0};                   // a line
        if (kind == 2) c.at[k] = {1, 2, 3};                               // a point
        if (kind == 3 && random.coin()) c.at[k] = c.at[0];                // collapsed edges
        if (kind == 4) c.at[k].z = 0.3 * c.at[k].x;                       // a plane
        if (kind == 5) c.at[k] = 1e150 * c.at[k] + random.vector(1e149);  // squares that overflow
      }
      double const size = kind == 5 ? 1e150 : 1;
      Vec3 const p = n % 2 == 0 ? c.at[random.below(n_corners(type))] : size * random.vector(1.5);
      Vec3 local;
      bool const contained = element_contains(type, c, p, 1e-13 * size, local);
      EXPECT_TRUE(!contained || sane(type, local));
      ElementPlace const place = nearest_in_element(type, c, p);
      EXPECT_TRUE(sane(type, place.local)) << int(type) << " kind " << kind;
      double corner = unbounded;
      for (int k = 0; k < n_corners(type); ++k) corner = std::min(corner, distance(c.at[k], p));
      EXPECT_LE(place.distance, corner * (1 + 1e-15));
    }
}

TEST(ElementPlace, CollapsedHexahedraContainTheirPoints) {
  // A wedge: two corners of the bottom and two of the top coincide, as cells at a pole.
  Random random(11);
  ElementCorners c = element_of(ElementType::hexahedron, [](Vec3 l) { return Vec3{l.x * (1 - 0.2 * l.y), l.y, l.z}; });
  c.at[3] = c.at[2];
  c.at[7] = c.at[6];
  for (int n = 0; n < 2000; ++n) {
    Vec3 l = random_inside(ElementType::hexahedron, random);
    if (n % 4 == 0) l.y = 1;  // on the collapsed edge, where one place has many names
    if (n % 4 == 1) l.y = 1 - 1e-9 * random.unit();
    Vec3 const p = element_position(ElementType::hexahedron, c, l);
    Vec3 found;
    ASSERT_TRUE(element_contains(ElementType::hexahedron, c, p, 1e-13, found));
    EXPECT_LT(distance(element_position(ElementType::hexahedron, c, found), p), 1e-13);
  }
}

}  // namespace
}  // namespace gridmorph::test
