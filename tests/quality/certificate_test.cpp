// The certificate against J sampled densely, by formulas of its own.
#include "quality/reference_cell.hpp"
#include "quality/test_meshes.hpp"
#include "support/reduced.hpp"

#include <gridmorph/kernels/element_map.hpp>
#include <gridmorph/kernels/jacobian_bounds.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/quality/validity.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;
using kernels::JacobianSign;

/// A box of the given sides whose corners are anywhere around their places.
kernels::HexCell random_cell(std::mt19937& random, double amplitude, Vec3 const& sides = {1, 1, 1}) {
  std::uniform_real_distribution<double> off(-amplitude, amplitude);
  kernels::HexCell cell;
  for (int n = 0; n < 8; ++n)
    cell.corner[n] = {sides.x * ((n & 1) + off(random)), sides.y * ((n >> 1 & 1) + off(random)),
                      sides.z * ((n >> 2) + off(random))};
  return cell;
}

struct Sampled {
  double least = std::numeric_limits<double>::infinity(), least_corner = least;

  void take(double j, bool corner) {
    least = std::min(least, j);
    if (corner) least_corner = std::min(least_corner, j);
  }
};

Sampled sampled(kernels::HexCell const& cell, int n) {
  Corners const c = corners_of(cell);
  Sampled out;
  auto const end = [&](int i) { return i == 0 || i == n; };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k)
        out.take(jacobian(c, double(i) / n, double(j) / n, double(k) / n), end(i) && end(j) && end(k));
  return out;
}

/// Whether a sign and samples of J, which is of order 1, may both be right.
void expect_consistent(JacobianSign sign, Sampled const& samples) {
  if (sign == JacobianSign::positive) {
    EXPECT_GT(samples.least, 0);
  }
  // Between samples J falls below them by little: second differences are of order 10, samples 1/12 apart.
  if (sign == JacobianSign::negative) {
    EXPECT_LT(samples.least, 0.1);
  }
  if (samples.least < -1e-6) {
    EXPECT_EQ(sign, JacobianSign::negative);
  }
  EXPECT_NE(sign, JacobianSign::undecided);
}

TEST(JacobianBounds, OfHexahedraAgreeWithSamples) {
  std::mt19937 random(1);
  int positive = 0, negative = 0, between_corners = 0;
  int const cells = reduced() ? 300 : 1500;
  for (int n = 0; n < cells; ++n) {
    kernels::HexCell const cell = random_cell(random, 0.15 + 0.45 * (n % 7) / 6);
    JacobianSign const sign = kernels::jacobian_sign(cell, 1);
    Sampled const samples = sampled(cell, 12);
    expect_consistent(sign, samples);
    positive += sign == JacobianSign::positive ? 1 : 0;
    negative += sign == JacobianSign::negative ? 1 : 0;
    between_corners += sign == JacobianSign::negative && samples.least_corner > 0 ? 1 : 0;
  }
  EXPECT_GT(positive, cells / 10);
  EXPECT_GT(negative, cells / 5);
  EXPECT_GT(between_corners, 0) << "cells that are sound at all corners and not inside";
}

TEST(JacobianBounds, CoefficientsAreThoseOfThePolynomial) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> inside(0, 1);
  for (int n = 0; n < 200; ++n) {
    kernels::HexCell const cell = random_cell(random, 0.5, {1, 0.5, 2});
    auto const node = [&](int i, int j, int k) {
      Vec3 const& p = cell.corner[i + 2 * j + 4 * k];
      return kernels::LaneVec3<double>(p.x, p.y, p.z);
    };
    auto const plane = [&](int i) {
      return kernels::PlaneNormals<double>({node(i, 1, 0) - node(i, 0, 0), node(i, 1, 1) - node(i, 0, 1),
                                            node(i, 0, 1) - node(i, 0, 0), node(i, 1, 1) - node(i, 1, 0)});
    };
    double b[3][3][3];
    kernels::hex_coefficients(
        kernels::FourVectors<double>{node(1, 0, 0) - node(0, 0, 0), node(1, 1, 0) - node(0, 1, 0),
                                     node(1, 0, 1) - node(0, 0, 1), node(1, 1, 1) - node(0, 1, 1)},
        plane(0), plane(1), [&](int i, int j, int k, double value) { b[i][j][k] = value; });
    double const t[3] = {inside(random), inside(random), inside(random)};
    double weight[3][3];
    for (int d = 0; d < 3; ++d) {
      weight[d][0] = (1 - t[d]) * (1 - t[d]);
      weight[d][1] = 2 * t[d] * (1 - t[d]);
      weight[d][2] = t[d] * t[d];
    }
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) sum += weight[0][i] * weight[1][j] * weight[2][k] * b[i][j][k];
    EXPECT_NEAR(sum, jacobian(corners_of(cell), t[0], t[1], t[2]), 1e-13);
  }
}

TEST(JacobianBounds, SizeAndStretchMakeNoDifference) {
  std::mt19937 random(3);
  for (int n = 0; n < 300; ++n) {
    std::mt19937 const same = random;
    kernels::HexCell const cell = random_cell(random, 0.35);
    std::mt19937 again = same;
    kernels::HexCell stretched = random_cell(again, 0.35, {0.1, 10, 1});
    EXPECT_EQ(kernels::jacobian_sign(stretched, 1), kernels::jacobian_sign(cell, 1));
    for (Vec3& p : stretched.corner) p = 1e-9 * p;
    EXPECT_EQ(kernels::jacobian_sign(stretched, 1), kernels::jacobian_sign(cell, 1));
    EXPECT_EQ(kernels::jacobian_sign(cell, -1), JacobianSign::negative);
  }
}

TEST(JacobianBounds, OfPrismsAndPyramidsAgreeWithSamples) {
  std::mt19937 random(4);
  for (ElementType const type : {ElementType::prism, ElementType::pyramid, ElementType::tetrahedron}) {
    int seen[4] = {};
    int const elements = reduced() ? 400 : 2000;
    for (int n = 0; n < elements; ++n) {
      double const amplitude = 0.1 + 0.5 * (n % 5) / 4;
      std::uniform_real_distribution<double> off(-amplitude, amplitude);
      kernels::ElementCorners c;
      for (int k = 0; k < n_corners(type); ++k)
        c.at[k] = kernels::corner_local(type, k) + Vec3{off(random), off(random), off(random)};
      JacobianSign const sign = kernels::jacobian_sign(type, c, 1, {});
      Sampled samples;
      int const m = 12;
      for (int i = 0; i <= m; ++i)
        for (int j = 0; j <= m; ++j)
          for (int k = 0; k < m; ++k) {  // not the apex
            double const r = double(i) / m, s = double(j) / m, t = double(k) / m, w = 1 - t;
            Vec3 local{r, s, t};
            if (type == ElementType::pyramid) local = {w * r, w * s, t};
            if (type == ElementType::prism) local = {r, (1 - r) * s, t};
            if (type == ElementType::tetrahedron) local = {0.25, 0.25, 0.25};
            auto const d = kernels::element_jacobian(type, c, local);
            samples.take(dot(cross(d.r, d.s), d.t), false);
          }
      expect_consistent(sign, samples);
      ++seen[int(sign)];
    }
    EXPECT_GT(seen[int(JacobianSign::positive)], elements / 20) << to_string(type);
    EXPECT_GT(seen[int(JacobianSign::negative)], elements / 100) << to_string(type);
  }
}

TEST(JacobianBounds, CollapsedCellsAreZeroAndNotNegative) {
  kernels::HexCell wedge;
  for (int n = 0; n < 8; ++n) wedge.corner[n] = {double(n & 1), double(n >> 1 & 1) * (n & 1), double(n >> 2)};
  EXPECT_EQ(kernels::jacobian_sign(wedge, 1), JacobianSign::zero);
  for (auto& p : wedge.corner) p = 0.1 * p + Vec3{1000, 2000, 3000};
  EXPECT_EQ(kernels::jacobian_sign(wedge, 1), JacobianSign::zero);
  wedge.corner[3].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(kernels::jacobian_sign(wedge, 1), JacobianSign::negative);
}

TEST(JacobianBounds, TheFloorLiesBelowAllSamplesAndOnThemInParallelepipeds) {
  std::mt19937 random(6);
  int told = 0;
  int const cells = reduced() ? 240 : 1200;
  for (int n = 0; n < cells; ++n) {
    double const amplitude = 0.3 * (n % 6) / 5;
    kernels::HexCell const cell = random_cell(random, amplitude, {1, n % 3 == 0 ? 1e-4 : 0.7, n % 2 == 0 ? 30.0 : 2.0});
    auto const edges = kernels::cell_edges<double>([&](int i, int j, int k) {
      Vec3 const& p = cell.corner[i + 2 * j + 4 * k];
      return kernels::LaneVec3<double>(p.x, p.y, p.z);
    });
    for (double const handedness : {1.0, -1.0}) {
      auto const floor = kernels::jacobian_floor(edges, handedness);
      Corners const c = corners_of(cell);
      double least = std::numeric_limits<double>::infinity(), largest = 0;
      for (int m = 0; m < 125; ++m) {
        double const j = jacobian(c, m % 5 / 4.0, m / 5 % 5 / 4.0, m / 25 / 4.0);
        least = std::min(least, handedness * j);
        largest = std::max(largest, std::abs(j));
      }
      EXPECT_LE(floor.least / 64, least + 1e-13 * largest);
      if (amplitude == 0) {
        EXPECT_NEAR(floor.least / 64, least, 1e-13 * largest);
      }
      if (!(floor.least > floor.arithmetic)) continue;
      ++told;
      EXPECT_EQ(kernels::jacobian_sign(cell, handedness), JacobianSign::positive);
    }
  }
  EXPECT_GT(told, cells / 4);
}

TEST(JacobianBounds, RowsMarkTheCellsWhoseCoefficientsAreNotAllPositive) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-1, 1);
  int marks = 0, clear = 0, doubtful_floor = 0;
  for (int count = 1; count <= 20; ++count)
    for (double const amplitude : {0.05, 0.2, 0.4}) {
      std::vector<double> x, y, z;
      for (int n = 0; n < 4 * (count + 1); ++n) {
        x.push_back(n % (count + 1) + amplitude * off(random));
        y.push_back(3 * (n / (count + 1) % 2 + amplitude * off(random)));
        z.push_back(0.01 * (n / (count + 1) / 2 + amplitude * off(random)));
      }
      kernels::CellRow const row{x.data(), y.data(), z.data(), count + 1, 2 * (count + 1), count, 1};
      std::vector<double> mark(count, -1), by_one(std::size_t(count), -1);
      kernels::row_jacobian_signs<kernels::native_lanes>(row, mark.data());
      kernels::row_jacobian_signs<1>(row, by_one.data());
      EXPECT_EQ(mark, by_one);
      for (int n = 0; n < count; ++n) {
        auto const floor = kernels::jacobian_floor(row.edges<double>(n), 1.0);
        doubtful_floor += floor.least > floor.arithmetic ? 0 : 1;
        if (mark[n] == 0) {
          EXPECT_EQ(kernels::jacobian_sign(row.cell(n), 1), JacobianSign::positive);
        }
        (mark[n] == 0 ? clear : marks)++;
      }
      x[0] = std::numeric_limits<double>::quiet_NaN();
      kernels::row_jacobian_signs<kernels::native_lanes>(row, mark.data());
      EXPECT_EQ(mark[0], 1) << "a corner that is no number";
    }
  EXPECT_GT(marks, 20);
  EXPECT_GT(clear, 200);
  EXPECT_GT(doubtful_floor, 2 * marks) << "cells of which only the coefficients tell";
}

Coordinates crumpled(Mesh const& mesh, double amplitude) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> off(-amplitude, amplitude);
  Coordinates x(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    x.set(n, mesh.coordinates[n] + Vec3{off(random), off(random), off(random)});
  return x;
}

TEST(Certificate, CountsEveryCellAsTheFunctionForOneCellDoes) {
  Mesh const mesh = two_handed_zones();
  for (double const amplitude : {0.0, 0.02, 0.04, 0.06}) {
    Coordinates const x = crumpled(mesh, amplitude);
    Certificate const found = certify(Exec(), mesh, {views(x), views(mesh.coordinates)});
    Index negative = 0, cells = 0;
    int first_zone = -1;
    Index3 first{};
    for (int z = 0; z < 2; ++z) {
      Zone const& zone = mesh.zones[z];
      for (int k = 0; k + 1 < zone.extent[2]; ++k)
        for (int j = 0; j + 1 < zone.extent[1]; ++j)
          for (int i = 0; i + 1 < zone.extent[0]; ++i, ++cells) {
            kernels::HexCell cell;
            for (int n = 0; n < 8; ++n) cell.corner[n] = x[zone.node({i + (n & 1), j + (n >> 1 & 1), k + (n >> 2)})];
            if (kernels::jacobian_sign(cell, z == 0 ? 1 : -1) != JacobianSign::negative) continue;
            if (negative++ == 0) {
              first_zone = z;
              first = {i, j, k};
            }
          }
    }
    EXPECT_EQ(found.cells, cells);
    EXPECT_EQ(found.negative, negative);
    EXPECT_EQ(found.broken.cells, negative) << "all are sound in the baseline";
    EXPECT_EQ(found.holds(), negative == 0);
    Index by_zone = 0, cells_by_zone = 0;
    for (int z = 0; z < 2; ++z) {
      Certificate const of_zone = certify(Exec(), mesh, {views(x), views(mesh.coordinates), {}, {}, {z}});
      cells_by_zone += of_zone.cells;
      by_zone += of_zone.negative;
      EXPECT_TRUE(of_zone.holds() || of_zone.broken.worst_zone == z);
    }
    EXPECT_EQ(cells_by_zone, cells);
    EXPECT_EQ(by_zone, negative);
    EXPECT_EQ(negative == 0, amplitude < 0.03);
    if (negative == 0) continue;
    EXPECT_EQ(found.broken.worst_zone, first_zone);
    EXPECT_EQ(found.broken.worst_cell, first);
    EXPECT_EQ(certify(Exec(), mesh, {views(x), views(x), {1, -1}}).broken.cells, 0) << "they were no better before";
  }
}

TEST(Certificate, IsTheSameForTheSameCellsAsElements) {
  Mesh const blocks = two_handed_zones();
  Coordinates const x = crumpled(blocks, 0.05);
  Mesh const elements = as_hexahedra(blocks);
  UnstructuredTopology const topology = make_topology(elements);
  Certificate const a = certify(Exec(), blocks, {views(x), views(blocks.coordinates)});
  Certificate const b = certify(Exec(), elements, topology, {views(x), views(blocks.coordinates)});
  EXPECT_GT(a.negative, 10);
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.negative, b.negative);
  EXPECT_EQ(a.zero, b.zero);
  EXPECT_EQ(a.broken.number, b.broken.number);
}

}  // namespace
}  // namespace gridmorph::test
