// Points in unstructured meshes: against brute force over all elements, at all kinds of places, in broken meshes, with
// any number of threads.
#include "support/random.hpp"
#include "support/reduced.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/built_for.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/element_place.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/plan/elements/locate.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>

namespace gridmorph::test {
namespace {

using kernels::ElementCorners;
using kernels::is_finite;
using kernels::unbounded;

using Exec = Kokkos::DefaultHostExecutionSpace;

template <class Space>
std::vector<Location> locate_with(Mesh const& mesh, std::vector<Vec3> const& points,
                                  std::span<Index32 const> candidates) {
  ElementLocator<Space> const locator(Space(), mesh, candidates);
  std::vector<Location> out(points.size());
  locator.locate(Space(), Kokkos::View<Vec3 const*, Kokkos::HostSpace>(points.data(), points.size()),
                 Kokkos::View<Location*, Kokkos::HostSpace>(out.data(), out.size()));
  Space().fence();
  return out;
}

std::vector<Index32> all_of(Mesh const& mesh) {
  std::vector<Index32> all(mesh.n_elements());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::vector<Location> locate(Mesh const& mesh, std::vector<Vec3> const& points) {
  return locate_with<Exec>(mesh, points, all_of(mesh));
}

Mesh mapped(Mesh mesh, std::function<Vec3(Vec3)> const& f) {
  Coordinates c(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) c.set(n, f(mesh.coordinates[n]));
  mesh.coordinates = c;
  return mesh;
}

Vec3 wave(Vec3 p) {
  return p + 0.08 * Vec3{std::sin(2.1 * p.y + p.z), std::sin(1.7 * p.z + 2 * p.x), std::sin(1.9 * p.x - p.y)};
}

/// Every cell a polyhedron that lists the faces of the hexahedron.
Mesh polyhedra_of(Mesh const& mesh) {
  Mesh out = mesh;
  out.polyhedra.first_face.push_back(0);
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    ElementType const type = mesh.elements.type[e];
    auto const corners = mesh.elements.corners(e);
    for (int f = 0; f < n_faces(type); ++f) {
      std::vector<Index32> face;
      for (int k = 0; k < n_face_corners(type, f); ++k) face.push_back(corners[face_corner(type, f, k)]);
      out.polyhedra.faces.add(face);
    }
    out.polyhedra.element.push_back(Index32(e));
    out.polyhedra.first_face.push_back(out.polyhedra.faces.size());
    out.elements.type[e] = ElementType::polyhedron;
  }
  return out;
}

/// Each cell of a box cut into six pyramids around a node at its centre.
Mesh pyramids(Index3 cells) {
  Mesh const boxes = as_hexahedra(unit_box(cells));
  Mesh out;
  out.source = "pyramids";
  out.add_zone("box", boxes.n_nodes() + boxes.n_elements());
  out.coordinates = Coordinates(out.n_nodes());
  for (Index n = 0; n < boxes.n_nodes(); ++n) out.coordinates.set(n, boxes.coordinates[n]);
  for (Index e = 0; e < boxes.n_elements(); ++e) {
    auto const c = boxes.elements.corners(e);
    Index32 const centre = Index32(boxes.n_nodes() + e);
    Vec3 sum;
    for (Index32 const n : c) sum += boxes.coordinates[n];
    out.coordinates.set(centre, 0.125 * sum);
    for (int f = 0; f < 6; ++f) {
      std::array<Index32, 5> nodes{};
      // Bases are counter-clockwise seen from inside: faces turned round.
      for (int k = 0; k < 4; ++k) nodes[k] = c[face_corner(ElementType::hexahedron, f, 3 - k)];
      nodes[4] = centre;
      out.add_element(ElementType::pyramid, nodes);
    }
  }
  return out;
}

struct Case {
  std::string name;
  Mesh mesh;
};

std::vector<Case> cases() {
  auto const flat_wave = [](Vec3 p) { return p + 0.08 * Vec3{std::sin(2.1 * p.y), std::sin(2 * p.x), 0}; };
  // A wall with layers of 1e-5 of its length that turns by a quarter of a circle.
  auto const layers = [](Vec3 p) {
    double const r = 1 + 1e-5 * (std::pow(4.0, p.z) - 1), angle = 0.25 * p.x;
    return Vec3{r * std::cos(angle), r * std::sin(angle), 0.3 * p.y};
  };
  auto const tilted = [&](Vec3 p) {
    Vec3 const q = flat_wave(p);
    return Vec3{0.6 * q.x - 0.8 * q.y, 0.48 * q.x + 0.36 * q.y, 0.64 * q.x + 0.48 * q.y} + Vec3{5, 6, 7};
  };
  auto const mirrored = [](Vec3 p) { return wave({-p.x, p.y, p.z}); };
  return {{"hexahedra", mapped(as_hexahedra(unit_box({6, 5, 7})), wave)},
          {"prisms and tetrahedra", mapped(to_prisms_and_tetrahedra(unit_box({5, 4, 6}), 3), wave)},
          {"pyramids", mapped(pyramids({3, 4, 3}), wave)},
          {"polyhedra", polyhedra_of(mapped(as_hexahedra(unit_box({4, 3, 5})), wave))},
          {"flat prisms", mapped(to_prisms_and_tetrahedra(unit_box({6, 3, 9}), 8), layers)},
          {"inside out", mapped(to_prisms_and_tetrahedra(unit_box({3, 4, 3}), 2), mirrored)},
          {"triangles and quadrilaterals", mapped(flat_box(8, 9, 4), flat_wave)},
          {"tilted plane", mapped(flat_box(6, 5, 2), tilted)}};
}

ElementCorners corners_of(Mesh const& mesh, Index e) {
  ElementCorners c;
  auto const nodes = mesh.elements.corners(e);
  for (std::size_t k = 0; k < nodes.size(); ++k) c.at[k] = mesh.coordinates[nodes[k]];
  return c;
}

double size_of_element(Mesh const& mesh, Index e) {
  double size = 0;
  for (Index32 const a : mesh.elements.corners(e))
    for (Index32 const b : mesh.elements.corners(e))
      size = std::max(size, distance(mesh.coordinates[a], mesh.coordinates[b]));
  return size;
}

/// A place in an element as a random mean of its corners, which lies inside all convex ones.
Vec3 random_mean(Mesh const& mesh, Index e, Random& random) {
  double sum = 0;
  Vec3 p;
  for (Index32 const n : mesh.elements.corners(e)) {
    double const w = std::pow(random.unit(), 3);
    sum += w;
    p += w * mesh.coordinates[n];
  }
  return (1 / sum) * p;
}

TEST(ElementLocator, NodesAndPointsOfElementsAreFoundAndLieWhereTheyAre) {
  Random random(1);
  for (auto const& [name, mesh] : cases()) {
    SCOPED_TRACE(name);
    std::vector<Vec3> points;
    for (Index n = 0; n < mesh.n_nodes(); ++n) points.push_back(mesh.coordinates[n]);
    for (Index e = 0; e < mesh.n_elements(); ++e)
      for (int k = 0; k < (reduced() ? 2 : 10); ++k) points.push_back(random_mean(mesh, e, random));
    auto const found = locate(mesh, points);
    double const size = mesh.size();
    Index outside = 0;
    for (std::size_t n = 0; n < points.size(); ++n) {
      ASSERT_GE(found[n].element, 0);
      // Means of warped elements at the boundary may lie outside by a part of the warp.
      if (found[n].distance > 0) {
        ++outside;
        EXPECT_GE(Index(n), mesh.n_nodes());
        EXPECT_LT(found[n].distance, 0.02 * size_of_element(mesh, found[n].element));
      }
      EXPECT_NEAR(distance(position(mesh, found[n]), points[n]), found[n].distance, 3e-12 * size);
    }
    EXPECT_LT(outside, Index(points.size()) / 20);
  }
}

TEST(ElementLocator, PlacesAreThoseOfASearchThroughAllElements) {
  Random random(2);
  for (auto const& [name, mesh] : cases()) {
    if (name == "polyhedra" || name == "tilted plane") continue;
    SCOPED_TRACE(name);
    std::vector<Vec3> points;
    double const size = mesh.size();
    for (Index n = 0; n < 40; ++n) points.push_back(mesh.coordinates[random.below(int(mesh.n_nodes()))]);
    for (Index n = 0; n < 60; ++n) points.push_back(random_mean(mesh, random.below(int(mesh.n_elements())), random));
    Vec3 const centre = random_mean(mesh, mesh.n_elements() / 2, random);
    for (Index n = 0; n < 150; ++n)
      points.push_back(centre + random.vector(n < 50 ? size : n < 100 ? 0.1 * size : 10 * size));
    if (mesh.dimension == 2)
      for (Vec3& p : points) p.z = 0;
    auto const found = locate(mesh, points);
    int outside = 0;
    double const tolerance = ElementLocator<Exec>(Exec(), mesh).tolerance();
    for (std::size_t n = 0; n < points.size(); ++n) {
      Index32 holding = -1, nearest = -1;
      double least = unbounded;
      for (Index32 e = 0; e < mesh.n_elements() && holding < 0; ++e) {
        ElementType const type = mesh.elements.type[e];
        Vec3 local;
        if (element_contains(type, corners_of(mesh, e), points[n], tolerance, local)) holding = e;
        double d = nearest_in_element(type, corners_of(mesh, e), points[n]).distance;
        if (d <= tolerance) d = 0;
        if (float(d) < float(least)) {
          least = d;
          nearest = e;
        }
      }
      if (holding >= 0) {
        EXPECT_EQ(found[n].element, holding);
        EXPECT_EQ(found[n].distance, 0);
      } else {
        EXPECT_EQ(found[n].element, nearest);
        EXPECT_EQ(found[n].distance, least);
        ++outside;
      }
    }
    EXPECT_GT(outside, 50);
  }
}

bool same_bits(std::vector<Location> const& a, std::vector<Location> const& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t n = 0; n < a.size(); ++n)
    if (a[n].element != b[n].element || a[n].part != b[n].part || a[n].local.x != b[n].local.x ||
        a[n].local.y != b[n].local.y || a[n].local.z != b[n].local.z || a[n].distance != b[n].distance)
      return false;
  return true;
}

TEST(ElementLocator, OrderOfCandidatesAndOfPointsAndTheBackendChangeNothing) {
  Random random(3);
  for (auto const& [name, mesh] : cases()) {
    SCOPED_TRACE(name);
    std::vector<Vec3> points;
    double const size = mesh.size();
    for (int n = 0; n < (reduced() ? 600 : 3000); ++n)
      points.push_back(random_mean(mesh, random.below(int(mesh.n_elements())), random) +
                       random.vector(n % 3 == 0 ? size : 1e-3));
    std::vector<Index32> candidates = all_of(mesh);
    auto const expected = locate_with<Exec>(mesh, points, candidates);
#ifdef GRIDMORPH_WITH_SERIAL
    EXPECT_TRUE(same_bits(locate_with<Kokkos::Serial>(mesh, points, candidates), expected));
#endif
    random.shuffle(candidates);
    EXPECT_TRUE(same_bits(locate_with<Exec>(mesh, points, candidates), expected));
    std::vector<Vec3> reversed(points.rbegin(), points.rend());
    auto backwards = locate_with<Exec>(mesh, reversed, candidates);
    std::reverse(backwards.begin(), backwards.end());
    EXPECT_TRUE(same_bits(backwards, expected));
  }
}

TEST(ElementLocator, SharedPlacesBelongToTheElementWithTheSmallestNumber) {
  for (auto const& [name, mesh] : cases()) {
    SCOPED_TRACE(name);
    std::vector<Vec3> points;
    std::vector<Index32> smallest(mesh.n_nodes(), -1);
    for (Index e = mesh.n_elements() - 1; e >= 0; --e)
      for (Index32 const n : mesh.elements.corners(e)) smallest[n] = Index32(e);
    for (Index n = 0; n < mesh.n_nodes(); ++n) points.push_back(mesh.coordinates[n]);
    auto const found = locate(mesh, points);
    for (std::size_t n = 0; n < points.size(); ++n) EXPECT_EQ(found[n].element, smallest[n]);
  }
}

// On the axis of a round hole all elements around are equally near.
TEST(ElementLocator, OfPlacesEquallyNearTheSameIsTakenHoweverElementsAreNumberedAndInAnyUnit) {
  Random random(4);
  for (double const scale : {1.0, 0.1, 3e3}) {
    auto const round = [&](Vec3 p) {
      double const angle = 2 * std::numbers::pi / 12 * p.x;
      return scale * Vec3{(1 + p.y) * std::cos(angle), (1 + p.y) * std::sin(angle), p.z};
    };
    Mesh const mesh = mapped(as_hexahedra(unit_box({12, 2, 3})), round);
    std::vector<Vec3> const points{scale * Vec3{0, 0, 0.4}, scale * Vec3{0, 0, 1}, scale * Vec3{0, 0, 2.2}};
    auto const expected = locate(mesh, points);
    for (int again = 0; again < 5; ++again) {
      FileOrder order;
      order.node.resize(mesh.n_nodes());
      std::iota(order.node.begin(), order.node.end(), 0);
      order.element = all_of(mesh);
      random.shuffle(order.element);
      Mesh renumbered = mesh;
      reorder(renumbered, std::move(order));
      auto const found = locate(renumbered, points);
      for (std::size_t n = 0; n < points.size(); ++n) {
        EXPECT_LT(distance(position(renumbered, found[n]), position(mesh, expected[n])), 1e-12 * scale) << n;
        EXPECT_LT(position(mesh, expected[n]).x, -0.8 * scale);  // towards the least x
      }
    }
  }
}

TEST(ElementLocator, OnlyCandidatesAreFound) {
  auto const mesh = as_hexahedra(unit_box({4, 1, 1}));
  std::vector<Vec3> const points{{0.5, 0.5, 0.5}, {3.75, 0.25, 0.5}, {2, 0.5, 0.5}};
  std::vector<Index32> const candidates{2};
  auto const found = locate_with<Exec>(mesh, points, candidates);
  for (auto const& place : found) EXPECT_EQ(place.element, 2);
  EXPECT_EQ(found[0].distance, 1.5);
  EXPECT_EQ(found[1].distance, 0.75);
  EXPECT_EQ(found[2].distance, 0);
  auto const none = locate_with<Exec>(mesh, points, {});
  for (auto const& place : none) EXPECT_EQ(place.element, -1);
  std::vector<Index32> const wrong{0, 4};
  EXPECT_THROW(locate_with<Exec>(mesh, points, wrong), MeshError);
}

TEST(ElementLocator, PointsThatAreNoNumbersHaveNoElementAndFarOnesHave) {
  double const nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  auto const mesh = as_hexahedra(unit_box({3, 3, 3}));
  auto const found = locate(mesh, {{nan, 0, 0}, {0, inf, 0}, {1e30, 0, 0}, {-1e100, 1, 1}, {1e200, 0, 0}});
  EXPECT_EQ(found[0].element, -1);
  EXPECT_EQ(found[1].element, -1);
  EXPECT_EQ(found[2].element, 0);  // all are equally near from there
  EXPECT_EQ(found[2].distance, 1e30);
  EXPECT_EQ(found[3].distance, 1e100);
  // Too far away for the square of a distance.
  EXPECT_EQ(found[4].element, -1);
}

TEST(ElementLocator, BrokenMeshesAreSearchedLikeOthers) {
  Random random(4);
  auto const sound = to_prisms_and_tetrahedra(unit_box({6, 6, 6}), 3);
  double const nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::function<Vec3(Vec3)>> const breaks{[](Vec3) {
                                                        return Vec3{1, 2, 3};
                                                      },  // all nodes in one point
                                                      [](Vec3 p) {
                                                        return Vec3{p.x, p.x, p.x};
                                                      },  // on a line
                                                      [](Vec3 p) {
                                                        return Vec3{p.x, p.y, 0};
                                                      },                                               // in a plane
                                                      [&](Vec3 p) { return p + random.vector(1.5); },  // crossed over
                                                      [&](Vec3 p) {
                                                        return random.unit() < 0.05 ? Vec3{nan, 0, 0} : p;
                                                      },  // nodes that are no numbers
                                                      [](Vec3 p) {
                                                        return Vec3{p.x, p.y, p.z < 2 ? 0 : p.z};
                                                      },  // collapsed layers
                                                      [](Vec3 p) {
                                                        return Vec3{p.x * (p.y < 1 ? 0 : p.y), p.y, p.z};
                                                      }};  // a pole
  for (std::size_t b = 0; b < breaks.size(); ++b) {
    SCOPED_TRACE(b);
    auto const mesh = mapped(sound, breaks[b]);
    std::vector<Vec3> points;
    for (int n = 0; n < 2000; ++n)
      points.push_back({random.between(-1, 7), random.between(-1, 7), random.between(-1, 7)});
    auto const found = locate(mesh, points);
    for (std::size_t n = 0; n < points.size(); ++n) {
      ASSERT_GE(found[n].element, 0);
      EXPECT_TRUE(is_finite(found[n].distance));
      EXPECT_NEAR(distance(position(mesh, found[n]), points[n]), found[n].distance, 1e-10);
    }
  }
}

TEST(ElementLocator, SizesThatDifferByTenMillionAreFoundInOneMesh) {
  // Geometric spacing along all three axes, and a sheared copy, whose boxes are larger than its cells.
  Mesh box = unit_box({24, 24, 24});
  for (bool const sheared : {false, true}) {
    auto const mesh = mapped(as_hexahedra(box), [&](Vec3 p) {
      Vec3 const q{std::pow(2.0, p.x), std::pow(2.0, p.y), std::pow(2.0, p.z)};
      return sheared ? Vec3{q.x + q.z, q.y + 0.5 * q.x, q.z} : q;
    });
    Random random(5);
    std::vector<Vec3> points;
    std::vector<Index32> expected;
    for (int n = 0; n < 20000; ++n) {
      auto const e = Index32(random.below(int(mesh.n_elements())));
      Vec3 const local{random.between(0.01, 0.99), random.between(0.01, 0.99), random.between(0.01, 0.99)};
      points.push_back(element_position(ElementType::hexahedron, corners_of(mesh, e), local));
      expected.push_back(e);
    }
    auto const found = locate(mesh, points);
    for (std::size_t n = 0; n < points.size(); ++n) {
      ASSERT_EQ(found[n].distance, 0);
      // The tolerance is a part of the whole mesh, larger than nothing but the smallest cells.
      if (size_of_element(mesh, expected[n]) < 1e-2) continue;
      ASSERT_EQ(found[n].element, expected[n]);
    }
  }
}

double field(Vec3 const& x) { return 1 + 2 * x.x - 3 * x.y + 0.5 * x.z; }

TEST(InterpolationRows, LinearFieldsAndConstantsAreReproducedByAllElements) {
  Random random(6);
  for (auto const& [name, mesh] : cases()) {
    SCOPED_TRACE(name);
    std::vector<Vec3> points;
    std::vector<Index32> targets;
    for (Index e = 0; e < mesh.n_elements(); ++e) points.push_back(random_mean(mesh, e, random));
    for (std::size_t n = 0; n < points.size(); ++n) targets.push_back(Index32(points.size() - 1 - n));
    auto const where = locate(mesh, points);
    InterpolationOperator const rows = interpolation_rows({}, mesh, where, targets);
    ASSERT_EQ(rows.size(), Index(points.size()));
    EXPECT_EQ(rows.target, targets);
    double const size = mesh.size();
    for (std::size_t n = 0; n < points.size(); ++n) {
      auto const exact = corner_weights(mesh, where[n]);
      auto const corners = mesh.elements.corners(where[n].element);
      double value = 0, sum = 0;
      for (std::size_t k = 0; k < exact.size(); ++k) {
        value += exact[k] * field(mesh.coordinates[corners[k]]);
        sum += exact[k];
        EXPECT_GE(exact[k], -1e-15);
      }
      EXPECT_NEAR(sum, 1, 1e-14);
      EXPECT_NEAR(value, field(position(mesh, where[n])), 1e-11 * size);
      double row = 0;
      for (Index k = rows.first[n]; k < rows.first[n + 1]; ++k)
        row += double(rows.weight[k]) * field(mesh.coordinates[rows.item[k]]);
      EXPECT_NEAR(row, value, 2e-6 * size);
    }
  }
}

TEST(InterpolationRows, TrilinearFieldsAreReproducedInBoxes) {
  auto const trilinear = [](Vec3 const& x) { return (1 + x.x) * (2 - 0.3 * x.y) * (1 + 0.5 * x.z); };
  auto const mesh = mapped(as_hexahedra(unit_box({5, 6, 4})), [](Vec3 p) {
    return Vec3{p.x * p.x, 0.1 * p.y, p.z * 3};
  });
  Random random(7);
  std::vector<Vec3> points;
  for (int n = 0; n < 500; ++n) points.push_back({25 * random.unit(), 0.6 * random.unit(), 12 * random.unit()});
  auto const where = locate(mesh, points);
  for (std::size_t n = 0; n < points.size(); ++n) {
    auto const weight = corner_weights(mesh, where[n]);
    auto const corners = mesh.elements.corners(where[n].element);
    double value = 0;
    for (std::size_t k = 0; k < weight.size(); ++k) value += weight[k] * trilinear(mesh.coordinates[corners[k]]);
    EXPECT_NEAR(value, trilinear(points[n]), 1e-12 * 500);
  }
}

TEST(InterpolationRows, NodesAreCopiesOfThemselvesAndOutsideNothingIsExtrapolated) {
  for (auto const& [name, mesh] : cases()) {
    SCOPED_TRACE(name);
    std::vector<Vec3> points;
    std::vector<Index32> targets;
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      points.push_back(mesh.coordinates[n]);
      targets.push_back(Index32(n));
    }
    InterpolationOperator const rows = interpolation_rows({}, mesh, locate(mesh, points), targets);
    ASSERT_EQ(rows.item.size(), rows.target.size());
    EXPECT_EQ(rows.item, targets);
    for (float const w : rows.weight) EXPECT_EQ(w, 1);
    Random random(8);
    std::vector<Vec3> away;
    double const size = mesh.size();
    for (int n = 0; n < 300; ++n) away.push_back(mesh.coordinates[0] + random.vector(3 * size));
    targets.resize(away.size(), 0);
    InterpolationOperator const outside =
        interpolation_rows({}, mesh, locate(mesh, away), std::span<Index32 const>(targets).first(away.size()));
    for (float const w : outside.weight) EXPECT_TRUE(w > 0 && w <= 1);
  }
}

TEST(InterpolationRows, WhatCannotBeInterpolatedIsRefused) {
  auto const mesh = as_hexahedra(unit_box({2, 1, 1}));
  std::vector<Location> const nowhere(1);
  std::vector<Index32> const one{0}, two{0, 1};
  EXPECT_THROW(interpolation_rows({}, mesh, nowhere, one), MeshError);
  EXPECT_THROW(interpolation_rows({}, mesh, locate(mesh, {{0.5, 0.5, 0.5}}), two), MeshError);
}

TEST(LocateReport, CountsWhatIsOutsideAndNamesTheWorst) {
  auto const mesh = as_hexahedra(unit_box({2, 2, 2}));
  auto const report = summarise(locate(mesh, {{1, 1, 1}, {0.5, 0.5, 3}, {1, 1, 4}, {-2, 1, 1}, {2, 2, 2}}));
  EXPECT_EQ(report.inside, 2);
  EXPECT_EQ(report.outside, 3);
  EXPECT_EQ(report.largest_distance, 2);
  EXPECT_EQ(report.worst, 2);
  EXPECT_EQ(summarise(locate(mesh, {{1, 1, 1}})).outside, 0);
  std::vector<Location> const nowhere(1);
  EXPECT_EQ(summarise(nowhere).largest_distance, unbounded);
}

TEST(AsHexahedra, LeftHandedZonesAreTurnedAndCellsKeepTheirNumbers) {
  Mesh box = unit_box({3, 4, 2});
  for (bool const mirror : {false, true}) {
    if (mirror)
      for (Index n = 0; n < box.n_nodes(); ++n) box.coordinates.x(n) = -box.coordinates.x(n);
    auto const mesh = as_hexahedra(box);
    check_mesh(mesh);
    ASSERT_EQ(mesh.n_elements(), 24);
    for (Index e = 0; e < mesh.n_elements(); ++e) {
      EXPECT_NEAR(element_volume(ElementType::hexahedron, corners_of(mesh, e), 1, {0, 0, 1}), 1, 1e-14);
      Vec3 mean;
      for (Index32 const n : mesh.elements.corners(e)) mean += 0.125 * mesh.coordinates[n];
      EXPECT_EQ(mean, (Vec3{(mirror ? -1 : 1) * (e % 3 + 0.5), e / 3 % 4 + 0.5, double(e / 12) + 0.5}));
    }
  }
}

}  // namespace
}  // namespace gridmorph::test
