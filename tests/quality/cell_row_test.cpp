// Cells measured in rows, several at once: against the plain reference cell by cell, and against the general functions
// of single cells where a cell is degenerate. Every row length, so that whole and partly filled lanes are met.
#include <gridmorph/kernels/arc_cosine.hpp>
#include <gridmorph/kernels/cell_row.hpp>

#include "quality/reference_cell.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {
namespace {

using kernels::arc_cosine;
using kernels::CellMeasures;
using kernels::CellRow;
using kernels::HexCell;
using kernels::larger;
using kernels::native_lanes;
using kernels::RowMeasures;

constexpr int longest_row = 35;
constexpr int two_lanes = native_lanes < 2 ? native_lanes : 2;

/// The nodes of one row of cells, with gaps between its lines as in a mesh.
struct RowNodes {
  std::vector<double> x, y, z;
  int count;
  static constexpr int stride_j = longest_row + 4, stride_k = 2 * stride_j + 3;

  RowNodes(int cells, std::function<Vec3(int, int, int)> const& position)
      : x(2 * stride_k, 1e30), y(x), z(x), count(cells) {
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i <= cells; ++i) set(i, j, k, position(i, j, k));
  }
  void set(int i, int j, int k, Vec3 const& p) {
    int const n = i + j * stride_j + k * stride_k;
    x[n] = p.x;
    y[n] = p.y;
    z[n] = p.z;
  }
  [[nodiscard]] CellRow row(double handedness) const {
    return {x.data(), y.data(), z.data(), stride_j, stride_k, count, handedness};
  }
};

struct Shape {
  std::string name;
  std::function<Vec3(int, int, int)> position;
};

/// Near-cubic and very flat cells, twisted and inverted ones, large ones far from the origin.
std::vector<Shape> shapes() {
  auto const wave = [](double size_j, double size_k, double amplitude, Vec3 const& origin) {
    return [=](int i, int j, int k) {
      double const s = amplitude * std::sin(1.3 * i + 2 * j), c = amplitude * std::cos(0.7 * i - k);
      return origin + Vec3{i + s * size_j * j, size_j * (j + 0.5 * c), size_k * (k + 0.5 * s + 0.2 * c * j)};
    };
  };
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-0.6, 0.6);
  std::vector<Vec3> disturbance(4 * (longest_row + 1));
  for (Vec3& d : disturbance) d = {shift(random), shift(random), shift(random)};
  return {{"cubes", wave(1, 1, 0.1, {0, 0, 0})},
          {"flat", wave(0.7, 2e-5, 0.3, {5, -3, 2})},
          {"thin and far away", wave(1e-3, 40, 0.2, {1e3, 1e3, -1e3})},
          {"disturbed", [=](int i, int j, int k) {
             return Vec3{double(i), double(j), double(k)} + disturbance[i + (longest_row + 1) * (j + 2 * k)];
           }}};
}

/// The same row seen from the other side: j and k exchanged make its cells left-handed.
Shape left_handed(Shape const& shape) {
  return {shape.name + ", left-handed", [position = shape.position](int i, int j, int k) { return position(i, k, j); }};
}

std::vector<std::pair<Shape, double>> shapes_of_both_hands() {
  std::vector<std::pair<Shape, double>> list;
  for (Shape const& s : shapes()) {
    list.emplace_back(s, 1);
    list.emplace_back(left_handed(s), -1);
  }
  return list;
}

using Measures = RowMeasures<longest_row>;

void expect_equal(Measures const& m, int n, CellMeasures const& e) {
  EXPECT_EQ(m.determinant_2x2x2[n], e.determinant_2x2x2);
  EXPECT_EQ(m.determinant_3x3x3[n], e.determinant_3x3x3);
  EXPECT_EQ(m.smallest_corner_jacobian[n], e.smallest_corner_jacobian);
  EXPECT_EQ(m.volume[n], e.volume);
  EXPECT_EQ(m.aspect_ratio[n], e.aspect_ratio);
  EXPECT_EQ(m.minimum_angle_deg[n], e.minimum_angle_deg);
  EXPECT_EQ(m.equiangle_skewness[n], e.equiangle_skewness);
  EXPECT_EQ(m.collapsed[n], e.collapsed);
}

CellMeasures measures_at(Measures const& m, int n) {
  return {m.determinant_2x2x2[n], m.determinant_3x3x3[n], m.smallest_corner_jacobian[n], m.volume[n],
          m.aspect_ratio[n],      m.minimum_angle_deg[n], m.equiangle_skewness[n],       m.collapsed[n]};
}

TEST(CellRow, MeasuresAgreeWithThePlainReferenceForEveryLengthAndShape) {
  for (auto const& [shape, handedness] : shapes_of_both_hands())
    for (int count = 1; count <= longest_row; ++count) {
      SCOPED_TRACE(shape.name + ", " + std::to_string(count) + " cells");
      RowNodes const nodes(count, shape.position);
      CellRow const row = nodes.row(handedness);
      Measures m;
      row_measures<native_lanes>(row, m);
      double determinant[longest_row], mark[longest_row];
      row_determinants<native_lanes>(row, determinant, mark);
      for (int n = 0; n < count; ++n) {
        test::Corners const corners = test::corners_of(row.cell(n));
        test::ReferenceCell const r = test::reference(corners, handedness);
        // Edges are differences of coordinates: their round-off against the shortest edge is what can be asked for.
        double size = 0, shortest = std::numeric_limits<double>::max(), longest = 0;
        for (Vec3 const& p : corners) size = std::max(size, norm(p));
        for (auto const& e : test::edge_corners) {
          double const length = distance(corners[e[0]], corners[e[1]]);
          shortest = std::min(shortest, length);
          longest = std::max(longest, length);
        }
        double const tolerance = 1e-14 + 4e-16 * size / shortest;
        EXPECT_NEAR(m.determinant_2x2x2[n], r.determinant_2x2x2, 400 * tolerance);
        EXPECT_NEAR(m.determinant_3x3x3[n], r.determinant_3x3x3, 400 * tolerance);
        EXPECT_EQ(determinant[n], m.determinant_3x3x3[n]);
        EXPECT_NEAR(m.volume[n], r.volume, 1e-13 * std::abs(r.volume) + 4e-16 * size * longest * longest);
        EXPECT_NEAR(m.aspect_ratio[n], r.aspect_ratio, 10 * tolerance * r.aspect_ratio);
        EXPECT_NEAR(m.minimum_angle_deg[n], r.minimum_angle_deg, 1e-5);  // the cosine is flat near 0 degrees
        EXPECT_NEAR(m.equiangle_skewness[n], r.equiangle_skewness, 1e-7);
        EXPECT_EQ(m.smallest_corner_jacobian[n] > 0, r.smallest_corner_jacobian > 0);
        EXPECT_FALSE(m.collapsed[n]);
      }
    }
}

TEST(CellRow, MeasuresAgreeWithTheGeneralFunctionToRoundOff) {
  for (auto const& [shape, handedness] : shapes_of_both_hands()) {
    SCOPED_TRACE(shape.name);
    RowNodes const nodes(longest_row, shape.position);
    CellRow const row = nodes.row(handedness);
    Measures m;
    row_measures<native_lanes>(row, m);
    for (int n = 0; n < longest_row; ++n) {
      CellMeasures const e = cell_measures(row.cell(n), handedness);
      EXPECT_NEAR(m.determinant_2x2x2[n], e.determinant_2x2x2, 1e-11);
      EXPECT_NEAR(m.determinant_3x3x3[n], e.determinant_3x3x3, 1e-11);
      EXPECT_NEAR(m.volume[n], e.volume, 1e-12 * (std::abs(e.volume) + std::abs(e.smallest_corner_jacobian)));
      EXPECT_NEAR(m.aspect_ratio[n], e.aspect_ratio, 1e-15 * 4 * e.aspect_ratio);
      EXPECT_NEAR(m.equiangle_skewness[n], e.equiangle_skewness, 1e-9);
    }
  }
}

// Bit for bit: the worst cell of a mesh may not change with the flags of the build or with how rows are cut.
TEST(CellRow, ValuesDependNeitherOnTheNumberOfLanesNorOnThePlaceInTheRow) {
  for (auto const& [shape, handedness] : shapes_of_both_hands()) {
    SCOPED_TRACE(shape.name);
    RowNodes const nodes(longest_row, shape.position);
    Measures one, two, native;
    kernels::RowRelativeDisplacements<longest_row> relative_one, relative_native;
    RowNodes const after(longest_row, [&](int i, int j, int k) {
      return 1.1 * shape.position(i, j, k) + Vec3{0, i * 0.01, 0};
    });
    row_measures<1>(nodes.row(handedness), one);
    row_measures<two_lanes>(nodes.row(handedness), two);
    row_measures<native_lanes>(nodes.row(handedness), native);
    row_relative_displacements<1>(nodes.row(handedness), after.row(handedness), relative_one);
    row_relative_displacements<native_lanes>(nodes.row(handedness), after.row(handedness), relative_native);
    for (int n = 0; n < longest_row; ++n) {
      expect_equal(two, n, measures_at(one, n));
      expect_equal(native, n, measures_at(one, n));
      EXPECT_EQ(relative_native.largest[n], relative_one.largest[n]);
      for (int d = 0; d < 3; ++d) EXPECT_EQ(relative_native.along[d][n], relative_one.along[d][n]);
      CellRow alone = nodes.row(handedness);
      alone.x += n;
      alone.y += n;
      alone.z += n;
      alone.count = 1;
      Measures m;
      row_measures<native_lanes>(alone, m);
      expect_equal(m, 0, measures_at(one, n));
    }
  }
}

/// Ways to spoil node (i, j, k) of a row; some collapse an edge, some a face, some are no numbers.
using Spoil = std::function<void(RowNodes&, int i)>;
std::vector<std::pair<std::string, Spoil>> spoils() {
  double const nan = std::numeric_limits<double>::quiet_NaN(), infinite = HUGE_VAL;
  auto const copy = [](RowNodes& r, int i, int from_j, int from_k, int to_j, int to_k) {
    int const s = i + from_j * RowNodes::stride_j + from_k * RowNodes::stride_k;
    r.set(i, to_j, to_k, {r.x[s], r.y[s], r.z[s]});
  };
  return {{"edge along j", [=](RowNodes& r, int i) { copy(r, i, 0, 0, 1, 0); }},
          {"edge along k", [=](RowNodes& r, int i) { copy(r, i, 0, 0, 0, 1); }},
          {"face of constant i",
           [=](RowNodes& r, int i) {
             copy(r, i, 0, 0, 1, 0);
             copy(r, i, 0, 0, 0, 1);
             copy(r, i, 0, 0, 1, 1);
           }},
          {"edge along i",
           [](RowNodes& r, int i) {
             int const other = i > 0 ? i - 1 : i + 1;
             r.set(i, 0, 0, {r.x[other], r.y[other], r.z[other]});
           }},
          {"not a number",
           [=](RowNodes& r, int i) {
             r.set(i, 1, 0, {0, nan, 0});
           }},
          {"infinite",
           [=](RowNodes& r, int i) {
             r.set(i, 0, 1, {infinite, 0, 0});
           }},
          {"negative infinite",
           [=](RowNodes& r, int i) {
             r.set(i, 1, 1, {0, 0, -infinite});
           }},
          {"beyond the range of volumes", [](RowNodes& r, int i) {
             r.set(i, 1, 1, {1e200, -1e220, 1e250});
           }}};
}

void expect_near_or_unbounded(double value, double expected) {
  if (std::isfinite(expected))
    EXPECT_NEAR(value, expected, 1e-14 * expected);
  else
    EXPECT_EQ(value, expected);
}

/// Neither collapsed edges nor values that are not finite or beyond 1e100.
bool is_regular(HexCell const& c) {
  for (auto const& e : test::edge_corners)
    if (c.corner[e[0]] == c.corner[e[1]]) return false;
  for (Vec3 const& p : c.corner)
    if (!(std::abs(p.x) < 1e100 && std::abs(p.y) < 1e100 && std::abs(p.z) < 1e100)) return false;
  return true;
}

TEST(CellRow, DegenerateCellsAreThoseOfTheGeneralFunctionsAndLeaveTheirNeighboursAlone) {
  Shape const shape = shapes()[0];
  for (int const count : {1, 2, 3, 7, 8, 9, 17})
    for (auto const& [name, spoil] : spoils())
      for (int i = 0; i <= count; ++i) {
        SCOPED_TRACE(name + " at node " + std::to_string(i) + " of " + std::to_string(count) + " cells");
        RowNodes const sound(count, shape.position);
        RowNodes nodes = sound;
        spoil(nodes, i);
        Measures m, expected;
        row_measures<native_lanes>(nodes.row(1), m);
        row_measures<native_lanes>(sound.row(1), expected);
        double determinant[longest_row], mark[longest_row];
        kernels::RowRelativeDisplacements<longest_row> before, after;
        row_determinants<native_lanes>(nodes.row(1), determinant, mark);
        row_relative_displacements<native_lanes>(nodes.row(1), sound.row(1), before);
        row_relative_displacements<native_lanes>(sound.row(1), nodes.row(1), after);
        int degenerate = 0;
        for (int n = 0; n < count; ++n) {
          HexCell const cell = nodes.row(1).cell(n), sound_cell = sound.row(1).cell(n);
          EXPECT_EQ(determinant[n], m.determinant_3x3x3[n]);
          if (n != i && n != i - 1) {
            expect_equal(m, n, measures_at(expected, n));
            EXPECT_EQ(before.largest[n], 0);
            EXPECT_EQ(after.largest[n], 0);
            continue;
          }
          if (!is_regular(cell))
            expect_equal(m, n, cell_measures(cell, 1));
          else  // only the neighbour lost an edge
            EXPECT_NEAR(m.determinant_3x3x3[n], cell_measures(cell, 1).determinant_3x3x3, 1e-13);
          degenerate += is_regular(cell) ? 0 : 1;
          Vec3 const b = relative_displacement(cell, sound_cell), a = relative_displacement(sound_cell, cell);
          expect_near_or_unbounded(before.largest[n], larger(b.x, larger(b.y, b.z)));
          expect_near_or_unbounded(after.largest[n], larger(a.x, larger(a.y, a.z)));
          double const b_along[3] = {b.x, b.y, b.z}, a_along[3] = {a.x, a.y, a.z};
          for (int d = 0; d < 3; ++d) {
            expect_near_or_unbounded(before.along[d][n], b_along[d]);
            expect_near_or_unbounded(after.along[d][n], a_along[d]);
          }
        }
        EXPECT_GT(degenerate, 0);
      }
}

TEST(CellRow, DirectionOfCollapsedEdgesHasNoRelativeDisplacement) {
  // Flat cells: the four edges along k have no length.
  RowNodes const flat(9, [](int i, int j, int) { return Vec3{double(i), double(j), 0}; });
  RowNodes const longer(9, [](int i, int j, int k) { return Vec3{1.5 * i, double(j), 0.1 * k}; });
  kernels::RowRelativeDisplacements<longest_row> relative;
  row_relative_displacements<native_lanes>(flat.row(1), longer.row(1), relative);
  for (int n = 0; n < 9; ++n) {
    EXPECT_EQ(relative.largest[n], 0.5);
    EXPECT_EQ(relative.along[0][n], 0.5);
    EXPECT_EQ(relative.along[2][n], 0);
  }
}

TEST(CellRow, RelativeDisplacementsAgreeWithThePlainReference) {
  for (Shape const& shape : shapes())
    for (int count = 1; count <= longest_row; ++count) {
      RowNodes const before(count, shape.position);
      RowNodes const after(count, [&](int i, int j, int k) {
        Vec3 const p = shape.position(i, j, k);
        return p + 0.1 * Vec3{std::sin(i + 3.0 * j), 0.3 * std::cos(2.0 * i + k), 0.2 * std::sin(k + 2.0 * i * j)};
      });
      kernels::RowRelativeDisplacements<longest_row> relative;
      row_relative_displacements<native_lanes>(before.row(1), after.row(1), relative);
      for (int n = 0; n < count; ++n) {
        auto const from = test::corners_of(before.row(1).cell(n)), to = test::corners_of(after.row(1).cell(n));
        double const expected = test::reference_relative_displacement(from, to);
        EXPECT_NEAR(relative.largest[n], expected, 1e-9 * expected)
            << shape.name;  // differences of coordinates up to 1e3
        auto const along = test::reference_relative_displacements(from, to);
        for (int d = 0; d < 3; ++d) EXPECT_NEAR(relative.along[d][n], along[d], 1e-9 * expected) << shape.name;
      }
    }
}

TEST(CellRow, OrientationCountsCornersOfEitherSign) {
  auto const box = [](int i, int j, int k) { return Vec3{double(i), double(j), double(k)}; };
  EXPECT_EQ(row_orientation(RowNodes(11, box).row(1)), 11);
  EXPECT_EQ(row_orientation(RowNodes(11, left_handed({"", box}).position).row(1)), -11);
  EXPECT_EQ(row_orientation(RowNodes(11, [](int i, int j, int) { return Vec3{double(i), double(j), 0}; }).row(1)), 0);
}

TEST(ArcCosine, IsWithinTwoUnitsOfTheExactAngleAndClampsRoundOff) {
  double const unit = std::numeric_limits<double>::epsilon() * std::acos(-1.0);
  for (int n = -20000; n <= 20000; ++n) {
    double const x = n / 20000.0;
    EXPECT_NEAR(arc_cosine(x), double(std::acos((long double)(x))), 2 * unit) << x;
  }
  for (double const d : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
    double const angle = std::acos(1 - d);
    EXPECT_NEAR(arc_cosine(1 - d), angle, 1e-15 * angle);
  }
  EXPECT_EQ(arc_cosine(1.0), 0);
  EXPECT_EQ(arc_cosine(1 + 1e-15), 0);
  EXPECT_EQ(arc_cosine(-1 - 1e-15), std::acos(-1.0));
  EXPECT_EQ(arc_cosine(0.0), std::acos(0.0));
}

}  // namespace
}  // namespace gridmorph
