// Targets that share only their shape with the mesh.
#include <gtest/gtest.h>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/geometry/target_tree.hpp>
#include <gridmorph/motion/target/edge_images.hpp>
#include <gridmorph/motion/target/feature_edges.hpp>
#include <gridmorph/motion/target/feature_path.hpp>
#include <gridmorph/motion/target/target_projection.hpp>

#include <random>

#include "plate_with_holes.hpp"
#include "support/unstructured_meshes.hpp"
#include "target_cases.hpp"

namespace gridmorph::test {
namespace {

using Mapping = TargetRule::Mapping;

Vec3 bent_shell(Vec3 const& x) { return {x.x, x.y, x.z + 0.2 * x.x * x.x - 0.1 * x.x * x.y}; }

TargetGeometry shell_triangles(int n, Map const& map) {
  return triangles_of(n, n / 2, [&](double a, double b) { return map(shell(a, b)); });
}
TargetRule projection(TargetGeometry geometry) { return rule_of(std::move(geometry), Mapping::projection); }

TEST(TargetTree, FindsWhatACheckOfAllTrianglesFinds) {
  TargetGeometry const g = shell_triangles(20, bent_shell);
  TargetTree const tree(g.points, g.triangles);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 3);
  for (int n = 0; n < 500; ++n) {
    Vec3 const p{any(random), any(random), 0.3 * any(random)}, up{0.3, any(random), 1};
    double nearest = 1e300, facing = 1e300;
    for (int t = 0; t < int(g.triangles.size()); ++t) {
      auto const& [a, b, c] = g.triangles[t];
      double const d = distance(p, closest_on_triangle(p, g.points[a], g.points[b], g.points[c]));
      nearest = std::min(nearest, d);
      if (dot(tree.normal(t), up) > 0) facing = std::min(facing, d);
    }
    EXPECT_DOUBLE_EQ(tree.closest(p).distance, nearest);
    EXPECT_DOUBLE_EQ(distance(p, tree.closest(p).point), nearest);
    auto const hit = tree.closest_facing(p, up);
    ASSERT_EQ(hit.triangle >= 0, facing < 1e300);
    if (hit.triangle >= 0) {
      EXPECT_DOUBLE_EQ(hit.distance, facing);
    }
  }
}

TEST(TargetTree, ClosestPointOfATriangleBeatsASampleOfIt) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  auto const point = [&] { return Vec3{any(random), any(random), any(random)}; };
  for (int n = 0; n < 200; ++n) {
    Vec3 const a = point(), b = point(), c = point(), p = 2 * point();
    double const found = distance(p, closest_on_triangle(p, a, b, c));
    double sampled = 1e300;
    for (int i = 0; i <= 40; ++i)
      for (int j = 0; i + j <= 40; ++j)
        sampled = std::min(sampled, distance(p, a + (i / 40.0) * (b - a) + (j / 40.0) * (c - a)));
    EXPECT_LE(found, sampled + 1e-15);
    EXPECT_GE(found, sampled - 0.1);
  }
}

TEST(FeatureEdges, OfAnOpenBoxAreItsRimAndItsCreases) {
  // A cube without lid, two by two facets a side.
  std::vector<Vec3> points;
  std::vector<GridFacet> facets;
  PointNumbers numbers(1e-9);
  auto const number = [&](Vec3 const& p) {
    int n = numbers.find(p);
    if (n < 0) {
      n = int(points.size());
      points.push_back(p);
      numbers.add(p, n);
    }
    return n;
  };
  auto const side = [&](Vec3 const& o, Vec3 const& u, Vec3 const& v) {
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        auto const at = [&](int a, int b) { return number(o + (0.5 * (i + a)) * u + (0.5 * (j + b)) * v); };
        facets.push_back({at(0, 0), at(1, 0), at(1, 1), at(0, 1)});
      }
  };
  side({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  side({0, 0, 0}, {0, 0, 1}, {1, 0, 0});
  side({0, 1, 0}, {0, 0, 1}, {1, 0, 0});  // turned inside out: edges are found all the same
  side({0, 0, 0}, {0, 1, 0}, {0, 0, 1});
  side({1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  auto const edges = find_feature_edges(points, facets, 40);
  EXPECT_EQ(std::count_if(edges.begin(), edges.end(), [](auto const& e) { return e.boundary; }), 8);
  EXPECT_EQ(edges.size(), 8u + 16u);
  auto const neighbours = feature_neighbours(points.size(), edges);
  auto const chains = feature_chains(neighbours, std::vector<char>(points.size(), 0));
  EXPECT_EQ(chains.size(), 12u);
  for (auto const& chain : chains) EXPECT_EQ(chain.vertices.size(), 3u);
  EXPECT_TRUE(find_feature_edges(points, facets, 95).size() == 8);
}

TEST(TargetProjection, ATargetThatIsTheBaselineMovesNothing) {
  Mesh const mesh = shell_mesh();
  TargetRun const run(mesh, projection(grids_of(mesh, same_place)));
  EXPECT_LT(run.error(same_place), 1e-14 * mesh.size());
  Mesh const closed = wing_mesh();
  EXPECT_LT(TargetRun(closed, projection(grids_of(closed, same_place))).error(same_place), 1e-14 * closed.size());
}

TEST(TargetProjection, AFinerCopyOfTheFacetsMovesNothing) {
  // Points on the baseline's own edges and a split of its facets that has its nodes: the same surface in more pieces.
  Mesh const mesh = shell_mesh();
  TargetGeometry coarse = grids_of(mesh, same_place), fine;
  TargetTree const facets = [&] {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (TargetGrid const& g : coarse.grids) {
      int const first = int(points.size()), n = g.extent[0];
      points.insert(points.end(), g.points.begin(), g.points.end());
      for (int b = 0; b + 1 < g.extent[1]; ++b)
        for (int a = 0; a + 1 < n; ++a) {
          int const v = first + a + n * b;
          triangles.push_back({v, v + 1, v + 1 + n});
          triangles.push_back({v, v + 1 + n, v + n});
        }
    }
    return TargetTree(points, triangles);
  }();
  fine.points = facets.points();
  for (auto const& [a, b, c] : facets.triangles()) {
    int const n = int(fine.points.size());
    for (auto const& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
      fine.points.push_back(0.5 * (facets.points()[p] + facets.points()[q]));
    for (std::array<int, 3> const& t :
         {std::array{a, n, n + 2}, std::array{n, b, n + 1}, std::array{n + 2, n + 1, c}, std::array{n, n + 1, n + 2}})
      fine.triangles.push_back(t);
  }
  EXPECT_LT(TargetRun(mesh, projection(fine)).error(same_place), 1e-13 * mesh.size());
}

TEST(TargetProjection, ARigidlyMovedTargetCarriesEveryNodeAlong) {
  for (bool const closed : {false, true}) {
    Mesh const mesh = closed ? wing_mesh() : shell_mesh();
    RigidTransform turn = rotation_about({0.3, 0.1, 0.2}, {1, 2, 0.5}, 0.2);
    turn.translation += Vec3{0.05, -0.1, 0.2};
    Map const map = [&](Vec3 const& x) { return turn(x); };
    TargetRun const run(mesh, projection(grids_of(mesh, map)));
    EXPECT_LT(run.error(map), 1e-12 * mesh.size()) << run.surface.notes().front();
    EXPECT_LT(run.reach().max, 1e-13 * mesh.size()) << closed;
  }
}

TEST(TargetProjection, ATargetElsewhereIsFoundByItsBox) {
  Mesh const mesh = shell_mesh();
  Map const map = [](Vec3 const& x) { return Vec3{1.5 * x.x + 20, 1.5 * x.y - 7, 1.5 * x.z + 3}; };
  EXPECT_LT(TargetRun(mesh, projection(grids_of(mesh, map))).error(map), 1e-12 * 20);
}

TEST(TargetProjection, EveryNodeEndsOnTheTarget) {
  Mesh const mesh = shell_mesh();
  for (int const n : {9, 32, 61}) {
    TargetRun const run(mesh, projection(shell_triangles(n, bent_shell)));
    EXPECT_LT(run.reach().max, 4e-16 * mesh.size()) << n;
    EXPECT_EQ(run.reach().mapping, Mapping::projection);
  }
}

TEST(TargetProjection, ATargetOfAnotherResolutionConvergesAtSecondOrder) {
  Mesh const mesh = shell_mesh();
  // Distance from the smooth surface that the facets stand for: z is a function of x and y up to the map (a, b).
  auto const off = [&](int n) {
    TargetRun const run(mesh, projection(shell_triangles(n, bent_shell)));
    double worst = 0;
    for (int p = 0; p < 2; ++p) {
      auto const points = nodes_of(mesh, p);
      auto const u = run.displacement(p);
      for (std::size_t k = 0; k < points.size(); ++k) {
        Vec3 const x = points[k] + u[k];
        double a = 0.5 * x.x, b = x.y;
        for (int turn = 0; turn < 50; ++turn) {
          a = (x.x - 0.1 * std::sin(3 * b)) / 2;
          b = x.y - 0.05 * std::sin(4 * a);
        }
        worst = std::max(worst, std::fabs(bent_shell(shell(a, b)).z - x.z));
      }
    }
    return worst;
  };
  double const coarse = off(24), fine = off(48), finest = off(96);
  EXPECT_GT(coarse / fine, 3);
  EXPECT_GT(fine / finest, 3);
  EXPECT_LT(finest, 1e-4);
}

TEST(TargetProjection, CornersGoToCornersAndEdgesToEdgesByArcLength) {
  Mesh const mesh = shell_mesh();
  TargetGeometry const target = shell_triangles(48, bent_shell);
  TargetRun const run(mesh, projection(target));
  auto const left = nodes_of(mesh, 0), moved = run.displacement(0);
  EXPECT_LT(distance(left[0] + moved[0], bent_shell(shell(0, 0))), 1e-15);
  // The edge a = 0: the nodes' shares of the length of the target's edge are those of the baseline's.
  int const n = mesh.patches[0].range.extent(0), m = mesh.patches[0].range.extent(1);
  std::vector<Vec3> edge;
  for (int b = 0; b < 24; ++b) edge.push_back(target.points[std::size_t(48) * b]);
  auto const length = [](std::vector<Vec3> const& line) {
    double sum = 0;
    for (std::size_t k = 1; k < line.size(); ++k) sum += distance(line[k - 1], line[k]);
    return sum;
  };
  std::vector<Vec3> before, after;
  for (int j = 0; j < m; ++j) {
    before.push_back(left[std::size_t(n) * j]);
    after.push_back(left[std::size_t(n) * j] + moved[std::size_t(n) * j]);
    double nearest = 1e300;
    for (std::size_t k = 1; k < edge.size(); ++k)
      nearest =
          std::min(nearest, distance(after.back(), closest_on_triangle(after.back(), edge[k - 1], edge[k], edge[k])));
    EXPECT_LT(nearest, 1e-15);
  }
  double const whole = length(before);
  for (int j = 1; j < m; ++j) {
    std::vector<Vec3> const b(before.begin(), before.begin() + j + 1), a(after.begin(), after.begin() + j + 1);
    EXPECT_NEAR(length(a) / length(after), length(b) / whole, 2e-4) << j;
  }
}

TEST(TargetProjection, TwoPatchesMoveTheirCommonEdgeAlikeBitForBit) {
  Mesh const mesh = shell_mesh();
  TargetRun const run(mesh, projection(shell_triangles(37, bent_shell)));
  auto const left = run.displacement(0), right = run.displacement(1);
  int const n = mesh.patches[0].range.extent(0), m = mesh.patches[1].range.extent(0);
  for (int j = 0; j < mesh.patches[0].range.extent(1); ++j)
    EXPECT_TRUE(left[std::size_t(n) * j + n - 1] == right[std::size_t(m) * j]) << j;
}

TEST(TargetProjection, SpacingIsKept) {
  // Neighbours are as far apart as before, times what the lines as a whole have grown.
  Mesh const mesh = shell_mesh();
  TargetRun const run(mesh, projection(shell_triangles(61, bent_shell)));
  std::vector<double> growth;
  for (int p = 0; p < 2; ++p) {
    auto const points = nodes_of(mesh, p);
    auto const u = run.displacement(p);
    int const n = mesh.patches[p].range.extent(0);
    for (std::size_t k = 0; k + 1 < points.size(); ++k)
      if (int(k + 1) % n != 0)
        growth.push_back(distance(points[k] + u[k], points[k + 1] + u[k + 1]) / distance(points[k], points[k + 1]));
  }
  double mean = 0;
  for (double const g : growth) mean += g / double(growth.size());
  for (double const g : growth) EXPECT_NEAR(g / mean, 1, 0.2);
}

TEST(TargetProjection, ThinTrailingEdgesKeepTheirSides) {
  // Upper nodes must not be caught by the lower side, which is nearer than the own one after a shift across.
  Mesh const mesh = wing_mesh(81, 7);
  Map const map = [](Vec3 const& x) { return Vec3{x.x, x.y + 0.05 * x.z * x.z, x.z}; };
  TargetRun const run(
      mesh, projection(triangles_of(161, 23, [&](double a, double b) { return map(wing(a < 1 ? a : 0, b)); })));
  EXPECT_LT(run.reach().max, 1e-13 * mesh.size());
  EXPECT_LT(run.error(map), 0.02);
}

/// A thin section with a sharp nose and a sharp trailing edge, upper side first.
Vec3 lens(double t, double h) {
  double const x = t <= 0.5 ? 1 - 2 * t : 2 * t - 1, y = (t <= 0.5 ? 0.2 : -0.16) * x * (1 - x);
  return {0.4 * h + (1 - 0.5 * h) * x, (1 - 0.5 * h) * y, 4 * h};
}

/// Twisted by up to 6 degrees and bent, with the square of the span.
Vec3 twisted_lens(Vec3 const& p) {
  double const h = p.z / 4, turn = -0.105 * h * h, c = std::cos(turn), s = std::sin(turn);
  double const x = p.x - 0.4 * h - 0.25, y = p.y;
  return {p.x - x + c * x - s * y, s * x + c * y + 0.6 * h * h, p.z};
}

Mesh lens_mesh(int ni, int nj) {
  MeshBuilder builder("lens");
  int const zone = builder.zone("lens", {ni, nj, 3}, [=](Index3 const& p) {
    double const even = double(p[0] % (ni - 1)) / (ni - 1), h = double(p[1]) / (nj - 1);
    // Nodes close up to both edges.
    double const s = even - std::sin(4 * std::numbers::pi * even) / (4.6 * std::numbers::pi);
    return lens(s, h) + Vec3{0, (s <= 0.5 ? 0.2 : -0.2) * p[2], 0};
  });
  builder.patch("wing", PatchKind::wall, zone, 2, 0);
  return builder.finish();
}

TEST(TargetProjection, NodesBesideSharpEdgesKeepTheirSideAndTheirOrder) {
  // Closest points heap up on the edges of a twisted target: whatever is left over it goes to the edge itself.
  Mesh const mesh = lens_mesh(41, 9);
  TargetRun const run(
      mesh, projection(triangles_of(121, 33, [](double a, double b) { return twisted_lens(lens(a < 1 ? a : 0, b)); })));
  for (auto const& note : run.surface.notes()) EXPECT_EQ(note.find("fold"), std::string::npos) << note;
  auto const points = nodes_of(mesh, 0);
  auto const u = run.displacement(0);
  double const shortest = distance(points[0], points[1]);
  for (int j = 0; j < 9; ++j)
    for (int i = 0; i < 40; ++i) {
      std::size_t const n = std::size_t(i) + 41 * std::size_t(j);
      // Spans differ along the edges, since they keep shares of their length; chordwise nodes stay apart as they were.
      double const before = distance(points[n], points[n + 1]);
      EXPECT_NEAR(distance(points[n] + u[n], points[n + 1] + u[n + 1]) / before, 1, 0.25) << i << " " << j;
    }
  EXPECT_LT(run.error(twisted_lens), 0.05);
  EXPECT_LT(run.reach().max, 1e-13 * mesh.size());
  EXPECT_GT(shortest, 0);
}

/// A lens cut off at the trailing edge: a from 0 in the middle of the base, 0.003 high, over its corner at 1/40, the
/// upper side, the nose at 0.5 and the lower side to the other corner at 39/40. Beside `crowd` 0 nodes close up to both
/// edges.
Vec3 blunt(double a, double h, double crowd) {
  constexpr double corner = 1.0 / 40;
  double const side = a <= 0.5 ? 1 : -1, from_base = std::min(a, 1 - a);
  double const even = std::max(0.0, (from_base - corner) / (0.5 - corner));
  double const x = 1 - even + crowd * std::sin(2 * std::numbers::pi * even);
  double const half_base = 0.0015 * x * std::min(1.0, from_base / corner);
  double const y = side * (half_base + (side > 0 ? 0.2 : 0.16) * x * (1 - x));
  return {0.4 * h + (1 - 0.5 * h) * x, (1 - 0.5 * h) * y, 4 * h};
}

TEST(TargetProjection, TheTwoLinesOfABluntTrailingEdgeStayApart) {
  // They are nearer to one another than the bend of the span takes either of them off the way between its ends: the way
  // of one may cross the base at root and tip and go along the other.
  MeshBuilder builder("blunt");
  int const zone = builder.zone("wing", {41, 9, 3}, [](Index3 const& p) {
    double const a = double(p[0] % 40) / 40;
    return blunt(a, double(p[1]) / 8, 0.06) + Vec3{0, (a <= 0.5 ? 0.2 : -0.2) * p[2], 0};
  });
  builder.patch("wing", PatchKind::wall, zone, 2, 0);
  Mesh const mesh = builder.finish();
  for (double const twist : {0.0, -0.09}) {
    Map const map = [twist](Vec3 const& p) {
      double const h = p.z / 4, c = std::cos(twist * h * h), s = std::sin(twist * h * h);
      double const x = p.x - 0.4 * h - 0.25;
      return Vec3{p.x - x + c * x - s * p.y, s * x + c * p.y + 0.6 * h * h, p.z};
    };
    TargetRun const run(
        mesh, projection(triangles_of(121, 33, [&](double a, double b) { return map(blunt(a < 1 ? a : 0, b, 0)); })));
    for (auto const& note : run.surface.notes()) EXPECT_EQ(note.find("fold"), std::string::npos) << note;
    auto const points = nodes_of(mesh, 0);
    auto const u = run.displacement(0);
    for (int j = 0; j < 9; ++j) {
      std::size_t const upper = 41 * std::size_t(j) + 1, lower = upper + 38;
      Vec3 const base = map(points[upper]) - map(points[lower]);
      Vec3 const found = points[upper] + u[upper] - points[lower] - u[lower];
      EXPECT_LT(norm(found - base), 0.1 * norm(base)) << twist << " " << j;
    }
    EXPECT_LT(run.error(map), 0.05) << twist;
    EXPECT_LT(run.reach().max, 1e-12 * mesh.size()) << "slivers of the base";
  }
}

TEST(FeatureNetwork, NoWayLeadsThroughAClosedPlace) {
  // A ladder of two rungs, 0-1-2 below 3-4-5, narrow: 0-3 and 2-5 join the two sides.
  std::vector<Vec3> points;
  for (double const y : {0.0, 0.1})
    for (double const x : {0.0, 1.0, 2.0}) points.push_back({x, y, 0});
  FeatureNetwork network(points, {{0, 1}, {1, 2}, {3, 4}, {4, 5}, {0, 3}, {2, 5}});
  // Places are numbered as edges bring them: 0, 1, 2 and 3, 4, 5 again.
  Polyline const beside_upper({{0, 0.5, 0}, {2, 0.5, 0}});
  EXPECT_EQ(network.path(0, 2, beside_upper), (std::vector<int>{0, 3, 4, 5, 2}));
  network.close(3);
  EXPECT_EQ(network.path(0, 2, beside_upper), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(network.path(0, 3, beside_upper), (std::vector<int>{0, 3})) << "ways may end there";
  network.close(5);
  EXPECT_FALSE(network.path(0, 4, beside_upper));
  EXPECT_EQ(network.nearest_place({1, 0.1, 0}), 4);
  EXPECT_EQ(network.nearest_place({1, 0.1, 0}, 0), 1) << "of what ways from 0 lead to";
  int const fresh = network.nearest_place({1.5, 0.2, 0}, 0);
  EXPECT_EQ(fresh, 6);
  EXPECT_EQ(network.path(0, fresh, beside_upper), (std::vector<int>{0, 1, fresh}));
}

TEST(TargetProjection, FacetsThatFoldAreSaidSo) {
  // Turned by half a turn between root and tip: no affine displacement is anywhere near.
  auto const wrung = [](double a, double b) {
    Vec3 const p = lens(a < 1 ? a : 0, b);
    double const turn = 3.1 * b, c = std::cos(turn), s = std::sin(turn), x = p.x - 0.4 * b - 0.25;
    return Vec3{p.x - x + c * x - s * p.y, s * x + c * p.y, p.z};
  };
  TargetRun const run(lens_mesh(41, 9), projection(triangles_of(121, 33, wrung)));
  bool said = false;
  for (auto const& note : run.surface.notes())
    said = said || note.find("facets of the patches fold") != std::string::npos;
  EXPECT_TRUE(said);
}

/// Holes move by two and a half of their radii and past one another's places; the sides stay.
Vec3 swept(Vec3 const& p) {
  double const s = std::sin(std::numbers::pi * p.x / 16), t = std::sin(std::numbers::pi * p.y / 10);
  return p + Vec3{2.5 * s * s * t, 0.3 * s * t, 0.5 * s * s * t};
}

// What another rule made of a surface with holes, given as a target: each hole is where it was, the sides too, and
// nothing folds.
TEST(TargetProjection, RimsOfHolesGoToThoseOfTheTarget) {
  Mesh const mesh = plate_with_holes();
  Mesh const elements = to_hexahedra(mesh);
  auto const topology = make_topology(elements);
  for (bool const blocks : {true, false}) {
    SCOPED_TRACE(blocks ? "blocks" : "elements");
    auto const boundary =
        blocks ? std::make_shared<Boundary const>(mesh)
               : std::make_shared<Boundary const>(elements, topology, find_face_patches(elements, topology));
    std::vector<int> const patches = boundary->select_patches({"plate"});
    PatchSurface const surface(*boundary, patches);
    TargetGeometry target;
    for (Vec3 const& x : surface.points) target.points.push_back(swept(x));
    for (GridFacet const& f : surface.facets()) {
      target.triangles.push_back({f[0], f[1], f[2]});
      target.triangles.push_back({f[0], f[2], f[3]});
    }
    Motion motion;
    motion.rules = {{{"plate"}, rule_of(target), 0, "test"}};
    BoundaryMotion const moves(boundary, resolve(boundary->names(), motion));
    std::vector<Vec3> u(surface.points.size());
    moves.displacement(0, surface.points, u);
    auto const is_side = [&](Vec3 const& x) { return x.x < 1e-9 || x.x > 16 - 1e-9 || x.y < 1e-9 || x.y > 10 - 1e-9; };
    for (double const middle : {5.0, 11.0}) {
      std::vector<Vec3> rim;
      for (Vec3 const& x : surface.points)
        if (std::hypot(x.x - middle, x.y - 5) < 1 + 1e-9) rim.push_back(x);
      ASSERT_EQ(rim.size(), 16u);
      std::sort(rim.begin(), rim.end(), [&](Vec3 const& a, Vec3 const& b) {
        return std::atan2(a.y - 5, a.x - middle) < std::atan2(b.y - 5, b.x - middle);
      });
      std::vector<Vec3> line;
      for (std::size_t n = 0; n <= rim.size(); ++n) line.push_back(swept(rim[n % rim.size()]));
      Polyline const there(line);
      for (std::size_t v = 0; v < u.size(); ++v)
        if (std::hypot(surface.points[v].x - middle, surface.points[v].y - 5) < 1 + 1e-9) {
          EXPECT_LT(there.distance_to(surface.points[v] + u[v]), 1e-10);
          EXPECT_LT(distance(surface.points[v] + u[v], swept(surface.points[v])), 0.2);
        }
    }
    for (std::size_t v = 0; v < u.size(); ++v) EXPECT_LT(is_side(surface.points[v]) ? norm(u[v]) : 0, 1e-10);
    for (std::string const& note : moves.notes()) EXPECT_EQ(note.find("fold"), std::string::npos) << note;
  }
}

TEST(FeatureLoops, ArePairedOneToOneWhateverTheyHaveInCommon) {
  auto const loop = [](double x, double length, bool boundary) { return FeatureLoop{{}, {x, 0, 0}, length, boundary}; };
  std::vector<FeatureLoop> from, to;
  for (int k = 0; k < 6; ++k) from.push_back(loop(k, 1, true));
  for (int const k : {3, 0, 5, 1, 4, 2}) to.push_back(loop(k + 1.4, 1.2, true));
  to.push_back(loop(0, 1, false));
  to.push_back(loop(0, 2.5, true));
  EXPECT_EQ(pair_loops(from, to, 10), (std::vector{1, 3, 5, 0, 4, 2}));
  EXPECT_EQ(pair_loops({from[0]}, {to[0], to[6], to[7]}, 1), std::vector{-1});
}

TEST(SurfacePieces, AreWhatCutsLeaveConnected) {
  // A strip of four quadrilaterals and a triangle: 0-1-2-3-4 above 5-6-7-8-9, and the corner 10.
  std::vector<GridFacet> facets;
  for (int n = 0; n < 4; ++n) facets.push_back({n, n + 1, n + 6, n + 5});
  facets.push_back({4, 10, 9, -1});
  EXPECT_EQ(pieces_between(facets, {}), (std::vector<int>{0, 0, 0, 0, 0}));
  EXPECT_EQ(pieces_between(facets, {{2, 7}}), (std::vector<int>{0, 0, 1, 1, 1}));
  EXPECT_EQ(pieces_between(facets, {{2, 7}, {4, 9}, {0, 1}}), (std::vector<int>{0, 0, 1, 1, 2}));
}

TEST(TargetProjection, FacetsTurnedTheOtherWayAreTheSameTarget) {
  Mesh const mesh = wing_mesh();
  Map const map = [](Vec3 const& x) { return Vec3{x.x, x.y + 0.02 * x.z * x.z, x.z}; };
  auto target = triangles_of(121, 21, [&](double a, double b) { return map(wing(a < 1 ? a : 0, b)); });
  TargetRun const one(mesh, projection(target));
  for (auto& t : target.triangles) std::swap(t[0], t[1]);
  TargetRun const other(mesh, projection(target));
  auto const u = one.displacement(0), v = other.displacement(0);
  for (std::size_t n = 0; n < u.size(); ++n) EXPECT_LT(distance(u[n], v[n]), 1e-12);
}

TEST(TargetProjection, UnusableTargetsAreErrors) {
  Mesh const mesh = shell_mesh();
  TargetGeometry bad = shell_triangles(9, bent_shell);
  bad.triangles[3][1] = int(bad.points.size());
  EXPECT_THROW(TargetRun(mesh, projection(bad)), MotionError);
  bad = shell_triangles(9, bent_shell);
  bad.points[5].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(TargetRun(mesh, projection(bad)), MotionError);
  EXPECT_THROW(TargetRun(mesh, projection({})), MotionError);
  bad = grids_of(mesh, bent_shell);
  bad.grids[0].points.pop_back();
  EXPECT_THROW(TargetRun(mesh, projection(bad)), MotionError);
  EXPECT_THROW(TargetRun(mesh, TargetRule{}), MotionError);
}

}  // namespace
}  // namespace gridmorph::test
