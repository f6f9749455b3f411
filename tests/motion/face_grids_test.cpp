// Grids found again in quadrilaterals that are listed in any order, from any corner on.
#include <gridmorph/boundary/face_grids.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace gridmorph {
namespace {

struct Faces {
  std::vector<GridFacet> faces;
  std::vector<Vec3> points;
};

/// n[0] x n[1] points of a surface; closed: the last points along the first direction are the first ones.
Faces sheet(int n_a, int n_b, bool closed, std::function<Vec3(double, double)> const& at) {
  Faces out;
  int const stored = closed ? n_a - 1 : n_a;
  for (int b = 0; b < n_b; ++b)
    for (int a = 0; a < stored; ++a) out.points.push_back(at(double(a) / (n_a - 1), double(b) / (n_b - 1)));
  auto const node = [&](int a, int b) { return a % stored + stored * b; };
  for (int b = 0; b + 1 < n_b; ++b)
    for (int a = 0; a + 1 < n_a; ++a)
      out.faces.push_back({node(a, b), node(a + 1, b), node(a + 1, b + 1), node(a, b + 1)});
  return out;
}

/// Faces in another order, each from another corner on.
void shuffle(Faces& f, unsigned seed) {
  std::mt19937 draw(seed);
  std::shuffle(f.faces.begin(), f.faces.end(), draw);
  for (GridFacet& face : f.faces) std::rotate(face.begin(), face.begin() + draw() % 4, face.end());
}

/// The faces of grids, each from its smallest corner on: none lost, none turned over.
std::multiset<std::vector<int>> faces_of(FaceGrids const& found) {
  std::multiset<std::vector<int>> out;
  for (FaceGrid const& g : found.grids) {
    auto const at = [&](int a, int b) { return g.point[a + g.extent[0] * b]; };
    for (int b = 0; b + 1 < g.extent[1]; ++b)
      for (int a = 0; a + 1 < g.extent[0]; ++a) {
        std::vector<int> face{at(a, b), at(a + 1, b), at(a + 1, b + 1), at(a, b + 1)};
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
        out.insert(std::move(face));
      }
  }
  return out;
}
std::multiset<std::vector<int>> given(Faces const& f) {
  std::multiset<std::vector<int>> out;
  for (GridFacet const& g : f.faces) {
    if (g[3] < 0) continue;
    std::vector<int> face(g.begin(), g.end());
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    out.insert(std::move(face));
  }
  return out;
}

Vec3 wavy_sheet(double s, double t) { return {s, t, 0.1 * std::sin(5 * s + 3 * t)}; }

TEST(FaceGrids, OneGridComesBackWhole) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    Faces f = sheet(7, 4, false, wavy_sheet);
    shuffle(f, seed);
    FaceGrids const found = find_face_grids(f.faces, f.points);
    EXPECT_EQ(found.left_over, 0u);
    ASSERT_EQ(found.grids.size(), 1u);
    EXPECT_EQ(std::min(found.grids[0].extent[0], found.grids[0].extent[1]), 4);
    EXPECT_EQ(std::max(found.grids[0].extent[0], found.grids[0].extent[1]), 7);
    EXPECT_EQ(faces_of(found), given(f));
  }
}

TEST(FaceGrids, AClosedSurfaceIsCutAcross) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    Faces f = sheet(13, 5, true, [](double s, double t) {
      return Vec3{std::cos(2 * std::numbers::pi * s), std::sin(2 * std::numbers::pi * s), t};
    });
    shuffle(f, seed);
    FaceGrids const found = find_face_grids(f.faces, f.points);
    EXPECT_EQ(found.left_over, 0u);
    ASSERT_EQ(found.grids.size(), 1u);
    FaceGrid const& g = found.grids[0];
    EXPECT_EQ(std::min(g.extent[0], g.extent[1]), 5);
    EXPECT_EQ(std::max(g.extent[0], g.extent[1]), 13);
    EXPECT_EQ(faces_of(found), given(f));
    // Its first line comes again at the end.
    for (int k = 0; k < 5; ++k) {
      int const first = g.extent[0] == 13 ? 13 * k : k, last = g.extent[0] == 13 ? 13 * k + 12 : 12 * 5 + k;
      EXPECT_EQ(g.point[first], g.point[last]);
    }
  }
}

// A box is cut at its corners, where three faces meet, along all its edges.
TEST(FaceGrids, ABoxHasSixSides) {
  Faces box;
  std::map<std::array<int, 3>, int> number;
  constexpr int n = 4;
  auto const node = [&](std::array<int, 3> const& at) {
    auto const [found, fresh] = number.try_emplace(at, int(box.points.size()));
    if (fresh) box.points.push_back({double(at[0]), double(at[1]), double(at[2])});
    return found->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) {
          auto const at = [&](int da, int db) {
            std::array<int, 3> p{};
            p[axis] = side * n;
            p[(axis + 1) % 3] = a + da;
            p[(axis + 2) % 3] = b + db;
            return node(p);
          };
          GridFacet face{at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
          if (side == 0) std::reverse(face.begin(), face.end());
          box.faces.push_back(face);
        }
  for (unsigned seed = 0; seed < 4; ++seed) {
    shuffle(box, seed);
    FaceGrids const found = find_face_grids(box.faces, box.points);
    EXPECT_EQ(found.left_over, 0u);
    EXPECT_EQ(found.grids.size(), 6u);
    for (FaceGrid const& g : found.grids) EXPECT_EQ(g.extent, (std::array{n + 1, n + 1}));
    EXPECT_EQ(faces_of(found), given(box));
  }
}

// An L: from its concave corner cuts go on to the border.
TEST(FaceGrids, AConcaveCornerIsCut) {
  Faces f = sheet(7, 7, false, wavy_sheet);
  std::erase_if(f.faces, [&](GridFacet const& face) { return face[0] % 7 >= 3 && face[0] / 7 >= 4; });
  FaceGrids const found = find_face_grids(f.faces, f.points);
  EXPECT_EQ(found.left_over, 0u);
  EXPECT_EQ(found.grids.size(), 3u);
  EXPECT_EQ(faces_of(found), given(f));
}

TEST(FaceGrids, TrianglesAreLeftOver) {
  Faces f = sheet(5, 5, false, wavy_sheet);
  GridFacet const face = f.faces.back();
  f.faces.back() = {face[0], face[1], face[2], -1};
  f.faces.push_back({face[0], face[2], face[3], -1});
  FaceGrids const found = find_face_grids(f.faces, f.points);
  EXPECT_EQ(found.left_over, 2u);
  EXPECT_EQ(faces_of(found), given(f));
}

TEST(FaceGrids, SidesOfAPlaneMeshMakeLines) {
  std::vector<GridFacet> const sides{{3, 1, -1, -1}, {0, 3, -1, -1}, {4, 5, -1, -1}, {5, 6, -1, -1}, {6, 4, -1, -1}};
  FaceGrids const found = find_face_grids(sides, std::vector<Vec3>(7));
  ASSERT_EQ(found.grids.size(), 2u);
  EXPECT_EQ(found.grids[0].point, (std::vector{0, 3, 1}));
  EXPECT_EQ(found.grids[1].extent, (std::array{4, 1}));
  EXPECT_EQ(found.grids[1].point.front(), found.grids[1].point.back());
}

}  // namespace
}  // namespace gridmorph
