// Growth and face area ratios, relative displacements by grid direction, and regions by themselves, against plain loops
// and closed forms.
#include <gridmorph/core/error.hpp>
#include <gridmorph/quality/quality.hpp>

#include "quality/reference_cell.hpp"
#include "quality/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace gridmorph {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;
using Key = std::array<long, 3>;
using test::input_of;

std::vector<double> field(Mesh const& mesh, Measure measure) {
  Measure const wanted[] = {measure};
  auto const view = cell_fields(Exec(), mesh, input_of(mesh), std::span<Measure const>(wanted)).front();
  return {view.data(), view.data() + mesh.n_cells()};
}

Key key(Vec3 const& p) { return {std::lround(p.x * 1e9), std::lround(p.y * 1e9), std::lround(p.z * 1e9)}; }

double area(Vec3 const& a, Vec3 const& b, Vec3 const& c, Vec3 const& d) { return 0.5 * norm(cross(c - a, d - b)); }

/// A cell by its points alone: neighbours are cells that share four of them.
struct PlainCell {
  test::Corners corner;

  [[nodiscard]] std::set<Key> face(int f) const {
    std::set<Key> out;
    for (int const n : test::face_corners[f]) out.insert(key(corner[n]));
    return out;
  }
  /// Length of the edge that leaves the face from one of its points.
  [[nodiscard]] double length_off(std::set<Key> const& face, Key const& from) const {
    for (auto const& e : test::edge_corners)
      for (int side = 0; side < 2; ++side) {
        Vec3 const &p = corner[e[side]], &q = corner[e[1 - side]];
        if (key(p) == from && face.count(key(q)) == 0) return distance(p, q);
      }
    ADD_FAILURE() << "no edge leaves the face";
    return 0;
  }
  /// Area of the other face that has two neighbouring points of this one.
  [[nodiscard]] double area_off(std::set<Key> const& face, Key const& p, Key const& q) const {
    for (auto const& f : test::face_corners) {
      std::set<Key> points;
      for (int const n : f) points.insert(key(corner[n]));
      if (points == face || points.count(p) == 0 || points.count(q) == 0) continue;
      return area(corner[f[0]], corner[f[1]], corner[f[2]], corner[f[3]]);
    }
    ADD_FAILURE() << "no face has that edge";
    return 0;
  }
  [[nodiscard]] bool is_edge(Key const& p, Key const& q) const {
    return std::any_of(test::edge_corners.begin(), test::edge_corners.end(), [&](auto const& e) {
      Key const a = key(corner[e[0]]), b = key(corner[e[1]]);
      return (a == p && b == q) || (a == q && b == p);
    });
  }
};

struct Ratios {
  std::vector<double> growth, area;
};

Ratios ratios_by_matching_points(Mesh const& mesh) {
  std::vector<PlainCell> cells;
  std::map<std::set<Key>, std::vector<std::size_t>> cells_of_face;
  test::each_cell(mesh, [&](int zone, Index3 const& cell) {
    cells.push_back({test::cell_corners(mesh, mesh.coordinates, zone, cell)});
    for (int f = 0; f < 6; ++f) cells_of_face[cells.back().face(f)].push_back(cells.size() - 1);
  });
  Ratios out{std::vector<double>(cells.size(), 1), std::vector<double>(cells.size(), 1)};
  for (auto const& [face, of] : cells_of_face) {
    if (of.size() != 2) continue;
    PlainCell const &a = cells[of[0]], &b = cells[of[1]];
    auto const take = [&](std::vector<double>& ratios, double x, double y) {
      for (std::size_t const c : of) ratios[c] = std::max({ratios[c], x / y, y / x});
    };
    for (Key const& p : face) {
      take(out.growth, a.length_off(face, p), b.length_off(face, p));
      for (Key const& q : face)
        if (p < q && a.is_edge(p, q)) take(out.area, a.area_off(face, p, q), b.area_off(face, p, q));
    }
  }
  return out;
}

TEST(LineRatios, AgreeWithCellsMatchedByTheirPointsInEveryOrientation) {
  for (Orientation const& orientation : test::all_orientations())
    for (bool const both_sides : {false, true}) {
      Mesh const mesh = test::two_zones(orientation, both_sides);
      Ratios const expected = ratios_by_matching_points(mesh);
      std::vector<double> const growth = field(mesh, Measure::growth_ratio),
                                areas = field(mesh, Measure::face_area_ratio);
      for (std::size_t c = 0; c < growth.size(); ++c) {
        ASSERT_NEAR(growth[c], expected.growth[c], 1e-12) << "cell " << c;
        ASSERT_NEAR(areas[c], expected.area[c], 1e-12) << "cell " << c;
      }
      QualityReport const report = measure_quality(Exec(), mesh, input_of(mesh));
      EXPECT_EQ(report.far_field[Measure::growth_ratio].max, *std::max_element(growth.begin(), growth.end()));
      EXPECT_EQ(report.far_field[Measure::face_area_ratio].max, *std::max_element(areas.begin(), areas.end()));
    }
}

/// Spacing that grows by a factor along each direction: so do lengths, and areas by that of either of their directions.
TEST(LineRatios, OfAnEvenStretchAreItsFactors) {
  Vec3 const factor{1.25, 1.5, 1};
  auto const place = [](double f, int n) { return f == 1 ? double(n) : (std::pow(f, n) - 1) / (f - 1); };
  Mesh const mesh = test::one_zone({7, 6, 4}, [&](Index3 const& p) {
    return Vec3{place(factor.x, p[0]), place(factor.y, p[1]), place(factor.z, p[2])};
  });
  for (double const r : field(mesh, Measure::growth_ratio)) EXPECT_NEAR(r, 1.5, 1e-13);
  for (double const r : field(mesh, Measure::face_area_ratio)) EXPECT_NEAR(r, 1.5, 1e-13);
  Mesh const even = test::one_zone({7, 6, 4}, [](Index3 const& p) { return Vec3{2.0 * p[0], 0.5 * p[1], 1.0 * p[2]}; });
  for (double const r : field(even, Measure::growth_ratio)) EXPECT_EQ(r, 1);
  for (double const r : field(even, Measure::face_area_ratio)) EXPECT_EQ(r, 1);
}

TEST(LineRatios, AJumpAtAnInterfaceIsThatOfTheCellsBesideIt) {
  Mesh mesh = test::two_zones(test::all_orientations()[21], true, 0);
  // Even spacing in both zones, three times as wide beyond the interface.
  IndexMap const to_second = mesh.interfaces[0].to_donor, back = to_second.inverse();
  auto const place = [](Index3 const& p) {
    return Vec3{p[0] <= 3 ? 1.0 * p[0] : 3.0 + 3.0 * (p[0] - 3), 1.0 * p[1], 1.0 * p[2]};
  };
  test::fill(mesh, 0, place);
  test::fill(mesh, 1, [&](Index3 const& q) { return place(back(q)); });
  std::vector<double> const growth = field(mesh, Measure::growth_ratio), areas = field(mesh, Measure::face_area_ratio);
  std::size_t n = 0;
  test::each_cell(mesh, [&](int zone, Index3 const& cell) {
    auto const corners = test::cell_corners(mesh, mesh.coordinates, zone, cell);
    bool const beside = std::any_of(corners.begin(), corners.end(), [](Vec3 const& p) { return p.x == 3; });
    EXPECT_EQ(growth[n], beside ? 3 : 1) << "zone " << zone;
    EXPECT_EQ(areas[n++], beside ? 3 : 1) << "zone " << zone;
  });
}

/// Cells at the axis are wedges: what has no length and no area there has no ratio.
TEST(LineRatios, LeaveOutWhatIsCollapsed) {
  Mesh const mesh = test::one_zone({4, 6, 3}, [](Index3 const& p) {
    double const angle = 0.2 * p[1];
    return Vec3{p[0] * std::cos(angle), p[0] * std::sin(angle), double(p[2])};
  });
  for (double const r : field(mesh, Measure::growth_ratio)) EXPECT_NEAR(r, 1, 1e-12);
  // Areas of sectors grow by 3 : 1 from the axis on, and of the faces around by 2 : 1.
  std::vector<double> const areas = field(mesh, Measure::face_area_ratio);
  EXPECT_NEAR(*std::max_element(areas.begin(), areas.end()), 3, 1e-12);
}

TEST(LineRatios, AreUnboundedWhereANodeIsNotFinite) {
  for (double const bad : {std::nan(""), HUGE_VAL}) {
    Mesh mesh = test::one_zone({6, 5, 4}, [](Index3 const& p) { return Vec3{1.0 * p[0], 1.0 * p[1], 1.0 * p[2]}; });
    mesh.coordinates.x(mesh.zones[0].node({1, 1, 1})) = bad;
    for (Measure const m : {Measure::growth_ratio, Measure::face_area_ratio}) {
      std::vector<double> const values = field(mesh, m);
      EXPECT_EQ(values[0], HUGE_VAL);
      EXPECT_EQ(values.back(), 1) << "far from it";
      for (double const v : values) EXPECT_FALSE(std::isnan(v));
    }
  }
}

std::vector<NamedCells> zones_as_regions(Mesh const& mesh) {
  std::vector<NamedCells> out;
  for (int z = 0; z < int(mesh.zones.size()); ++z) {
    Index3 cells = mesh.zones[z].extent;
    for (int& n : cells) --n;
    out.push_back({mesh.zones[z].name, {{z, {{0, 0, 0}, cells}}}});
  }
  return out;
}

/// The paper's measure, of a displacement that grows by a quarter of x and half of z: 1/4 and 1/2 along these, nothing
/// along y.
TEST(RelativeDisplacement, HasAValuePerIndexDirectionOfEachZone) {
  for (Orientation const& orientation : test::all_orientations()) {
    Mesh const mesh = test::two_zones(orientation, true, 0);
    Coordinates const after = test::moved(mesh, [](Vec3 const& p) { return Vec3{1.25 * p.x, p.y, 1.5 * p.z}; });
    auto input = input_of(mesh);
    input.coordinates = views(after);
    input.baseline = views(mesh.coordinates);
    input.regions = zones_as_regions(mesh);
    QualityReport const report = measure_quality(Exec(), mesh, input);
    ASSERT_EQ(report.regions.size(), 2U);
    double const along[3] = {0.25, 0, 0.5};
    for (int a = 0; a < 3; ++a) {
      int const second = orientation.axis[a];
      for (auto const& s : {report.regions[0].quality[relative_displacement_along(a)],
                            report.regions[1].quality[relative_displacement_along(second)]}) {
        EXPECT_NEAR(s.max, along[a], 1e-13);
        EXPECT_NEAR(s.min, along[a], 1e-13);
      }
    }
    EXPECT_NEAR(report.far_field[Measure::relative_displacement].max, 0.5, 1e-13);
  }
}

TEST(RelativeDisplacement, OfATranslationIsZeroAlongEveryDirection) {
  Mesh const mesh = test::two_zones(test::all_orientations()[40], true);
  Coordinates const after = test::moved(mesh, [](Vec3 const& p) { return p + Vec3{0.5, -3, 2}; });
  auto input = input_of(mesh);
  input.coordinates = views(after);
  input.baseline = views(mesh.coordinates);
  QualityReport const report = measure_quality(Exec(), mesh, input);
  for (int d = 0; d < 3; ++d) EXPECT_LT(report.far_field[relative_displacement_along(d)].max, 1e-13);
}

TEST(RelativeDisplacement, AlongEachDirectionAgreesWithThePlainFormula) {
  Mesh const mesh = test::two_handed_zones();
  Coordinates const after = test::moved(mesh, [](Vec3 const& p) {
    return p + 0.03 * Vec3{std::sin(6 * p.y), p.x * p.z, std::cos(5 * p.x + p.y)};
  });
  auto input = input_of(mesh);
  input.coordinates = views(after);
  input.baseline = views(mesh.coordinates);
  std::array const wanted{Measure::relative_displacement_i, Measure::relative_displacement_j,
                          Measure::relative_displacement_k, Measure::relative_displacement};
  auto const fields = cell_fields(Exec(), mesh, input, std::span<Measure const>(wanted));
  std::size_t n = 0;
  test::each_cell(mesh, [&](int zone, Index3 const& cell) {
    auto const expected = test::reference_relative_displacements(test::cell_corners(mesh, mesh.coordinates, zone, cell),
                                                                 test::cell_corners(mesh, after, zone, cell));
    for (std::size_t d = 0; d < 3; ++d) ASSERT_NEAR(fields[d](n), expected[d], 1e-12);
    ASSERT_EQ(fields[3](n), std::max({fields[0](n), fields[1](n), fields[2](n)}));
    ++n;
  });
}

/// Every measure of some boxes in two zones is that of their cells, whatever the rest of the mesh has.
TEST(Regions, AreMeasuredByThemselves) {
  Mesh const mesh = test::two_zones(test::all_orientations()[13], true);
  Coordinates const after = test::moved(mesh, [](Vec3 const& p) {
    return p + 0.03 * Vec3{std::sin(6 * p.y), p.x * p.z, std::cos(5 * p.x + p.y)};
  });
  auto input = input_of(mesh);
  input.coordinates = views(after);
  input.baseline = views(mesh.coordinates);
  QualityReport const plain = measure_quality(Exec(), mesh, input);
  input.regions = {{"wake", {{0, {{1, 0, 1}, {3, 4, 3}}}, {1, {{0, 1, 0}, {2, 3, 2}}}}},
                   {"tip", {{0, {{0, 0, 0}, {1, 1, 1}}}}}};
  std::vector<Measure> all;
  for (std::size_t m = 0; m < n_measures; ++m) all.push_back(Measure(m));
  auto const fields = cell_fields(Exec(), mesh, input, std::span<Measure const>(all));
  QualityReport const report = measure_quality(Exec(), mesh, input);
  ASSERT_EQ(report.regions.size(), 2U);
  std::vector<Index> const first = first_cells(mesh);
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_EQ(report.regions[r].name, input.regions[r].name);
    QualityRegion const& region = report.regions[r].quality;
    for (std::size_t m = 0; m < n_measures; ++m) {
      if (region.measure[m].worst_zone < 0) continue;
      double low = HUGE_VAL, high = -HUGE_VAL, sum = 0;
      Index cells = 0;
      for (CellBox const& box : input.regions[r].boxes) {
        Index3 const n = mesh.zones[box.zone].extent;
        for (int k = box.cells.begin[2]; k < box.cells.end[2]; ++k)
          for (int j = box.cells.begin[1]; j < box.cells.end[1]; ++j)
            for (int i = box.cells.begin[0]; i < box.cells.end[0]; ++i, ++cells) {
              double const v =
                  fields[m](std::size_t(first[box.zone] + i + Index(n[0] - 1) * (j + Index(n[1] - 1) * k)));
              low = std::min(low, v);
              high = std::max(high, v);
              sum += v;
            }
      }
      EXPECT_EQ(region.cells, cells);
      EXPECT_EQ(region.measure[m].min, low) << to_string(Measure(m));
      EXPECT_EQ(region.measure[m].max, high) << to_string(Measure(m));
      EXPECT_NEAR(region.measure[m].mean, sum / double(cells), 1e-12 * std::abs(high)) << to_string(Measure(m));
    }
    EXPECT_GE(region[Measure::growth_ratio].worst_zone, 0);
  }
  for (std::size_t m = 0; m < n_measures; ++m) {
    EXPECT_EQ(report.far_field.measure[m].max, plain.far_field.measure[m].max) << "near and far field are as without";
    EXPECT_EQ(report.far_field.measure[m].mean, plain.far_field.measure[m].mean);
  }
  EXPECT_EQ(report.cells(), mesh.n_cells());
  input.regions[0].boxes[0].zone = 7;
  EXPECT_THROW(measure_quality(Exec(), mesh, input), MeshError);
}

}  // namespace
}  // namespace gridmorph
