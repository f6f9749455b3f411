// Smoothing of blocks: what it may not touch, on one mesh of each kind of topology, and where it has to end up.
#include "invariants/cases.hpp"
#include "support/mesh_builders.hpp"
#include "support/morph_run.hpp"
#include "support/random.hpp"

#include <gridmorph/boundary/link_nodes.hpp>
#include <gridmorph/guard/shape_smoothing.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/quality/validity.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>

namespace gridmorph::test {

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

Coordinates copy_of(Coordinates const& x) {
  Coordinates out(x.size());
  for (Index n = 0; n < x.size(); ++n) out.set(n, x[n]);
  return out;
}

/// A mesh, its plan as guards take it and what came of it.
struct Planned {
  Mesh mesh;
  MorphPlan plan;
  Morphed morphed;

  explicit Planned(Outcome&& of)
      : mesh(of.mesh), plan(PlanAccess::of(std::move(of.prepared))), morphed(std::move(of.morphed)) {}
  [[nodiscard]] PreparedMorph const& prepared() const { return *PlanAccess::blocks(plan); }
};

struct Smoothed {
  Coordinates x;
  ShapeSmoothingReport report;
};

Smoothed smooth(Planned const& run, Coordinates const& morphed, HostInstance const& host = {}) {
  Smoothed out{copy_of(morphed), {}};
  out.report = smooth_shapes(host, IndexedMesh(run.mesh), run.plan, out.x);
  return out;
}

/// Least and largest number of cells that are inside out at a corner, or that the certificate finds broken: it counts
/// most of the others too.
std::pair<Index, Index> inside_out(Mesh const& mesh, Coordinates const& x) {
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(x);
  input.baseline = views(mesh.coordinates);
  QualityReport const quality = measure_quality(Exec(), mesh, input);
  Index const at_corners = quality.far_field.newly_inverted + quality.near_field.newly_inverted;
  Index const broken = certify(Exec(), mesh, {views(x), views(mesh.coordinates)}).broken.cells;
  return {std::max(at_corners, broken), at_corners + broken};
}

/// The case's motion, enlarged until corners lose their shape.
struct Overdone {
  Planned run;
  Smoothed smoothed;
};

/// Emptied after the suite: arrays may not outlive Kokkos.
std::map<std::string, Overdone> known;

Overdone const& overdone(Case const& c) {
  if (auto const found = known.find(c.name); found != known.end()) return found->second;
  double factor = 1;
  for (int n = 0; n < 10; ++n, factor *= 1.5) {
    Planned run(morph(c.mesh(), c.motion(factor), c.options));
    Smoothed smoothed = smooth(run, run.morphed.position);
    if (smoothed.report.triggered_before > 0)
      return known.try_emplace(c.name, Overdone{std::move(run), std::move(smoothed)}).first->second;
  }
  throw std::runtime_error(c.name + " keeps its shape, however far it is moved");
}

class ShapeSmoothing : public testing::TestWithParam<Case> {
 protected:
  static void TearDownTestSuite() {
    known.clear();
    if (tried > 10) {
      EXPECT_GE(3 * helped, 2 * tried);
    }
  }
  static inline int tried = 0, helped = 0;
};

double largest_distance(Coordinates const& a, Coordinates const& b) {
  double largest = 0;
  for (Index n = 0; n < a.size(); ++n) largest = std::max(largest, distance(a[n], b[n]));
  return largest;
}

TEST_P(ShapeSmoothing, WhatIsFrozenFollowsTheMotionWithoutJumps) {
  auto const& [run, smoothed] = overdone(GetParam());
  FrozenSmoothing const frozen = lost_shapes({}, IndexedMesh(run.mesh), copy_of(run.morphed.position));
  EXPECT_EQ(Index(frozen.cells.size()), smoothed.report.triggered_before);
  Coordinates const& home = run.mesh.coordinates;
  auto const at = [&](double share) {
    Coordinates plain(home.size());
    for (Index n = 0; n < home.size(); ++n) plain.set(n, home[n] + share * (run.morphed.position[n] - home[n]));
    Coordinates x = copy_of(plain);
    (void)smooth_frozen({}, IndexedMesh(run.mesh), run.plan, x, frozen);
    return std::pair(plain, x);
  };
  EXPECT_EQ(largest_distance(at(0).second, home), 0);
  auto const little = at(1e-4);
  EXPECT_LT(largest_distance(little.second, home), 100 * largest_distance(little.first, home)) << "from nothing on";
  // Below the amplitude at which the first corner loses its shape, and through it.
  for (double const share : {0.3, 0.6, 0.9}) {
    auto const one = at(share), other = at(share + 1e-4);
    EXPECT_LT(largest_distance(one.second, other.second), 100 * largest_distance(one.first, other.first)) << share;
  }
}

TEST_P(ShapeSmoothing, KeepsWhatItMust) {
  auto const& [run, smoothed] = overdone(GetParam());
  auto const& [x, report] = smoothed;
  Coordinates const& plain = run.morphed.position;
  Mesh const& mesh = run.mesh;
  double const size = run.prepared().plan().mesh_size;
  ++tried;
  helped += report.inverted_after < report.inverted_before || report.smallest_after > report.smallest_before ? 1 : 0;

  EXPECT_LE(report.inverted_after, report.inverted_before);
  if (report.inverted_after == report.inverted_before) {
    EXPECT_GE(report.smallest_after, report.smallest_before);
  }
  if (report.rounds == 0) {
    EXPECT_EQ(different_bits(x, plain), 0);
  }
  auto const expect_within = [](Index count, std::pair<Index, Index> const& bounds) {
    EXPECT_GE(count, bounds.first);
    EXPECT_LE(count, bounds.second);
  };
  expect_within(report.inverted_before, inside_out(mesh, plain));
  expect_within(report.inverted_after, inside_out(mesh, x));

  for (Index const n : run.prepared().plan().boundary_nodes) EXPECT_TRUE(same_bits(x[n], plain[n])) << n;
  for (CellBox const& box : run.prepared().plan().near_field)
    for (int k = box.cells.begin[2]; k <= box.cells.end[2]; ++k)
      for (int j = box.cells.begin[1]; j <= box.cells.end[1]; ++j)
        for (int i = box.cells.begin[0]; i <= box.cells.end[0]; ++i) {
          Index const n = mesh.zones[box.zone].node({i, j, k});
          ASSERT_TRUE(same_bits(x[n], plain[n])) << n;
        }
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    Patch const& patch = mesh.patches[p];
    SlipSurface const* const surface = run.prepared().surface.slip_surface(int(p));
    Zone const& zone = mesh.zones[patch.zone];
    for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
      for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
        for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) {
          Index const n = zone.node({i, j, k});
          if (surface == nullptr) {
            ASSERT_TRUE(same_bits(x[n], plain[n])) << n;
          } else if (!same_bits(x[n], plain[n])) {
            // Already where the surface wants it.
            Vec3 const u = x[n] - mesh.coordinates[n];
            ASSERT_LE(distance(surface->view().constrain(mesh.coordinates[n], u), u), 1e-11 * size) << n;
          }
        }
  }
  for (Link const& link : run.prepared().links.all)
    for_each_pair(mesh, link, [&](Index own, Index donor) {
      double const gap = distance(link.transform(x[own]), x[donor]);
      double const before = distance(link.transform(mesh.coordinates[own]), mesh.coordinates[donor]);
      ASSERT_LE(gap, before + 1e-13 * size);
      if (!link.periodic && same_bits(mesh.coordinates[own], mesh.coordinates[donor])) {
        ASSERT_TRUE(same_bits(x[own], x[donor]));
      }
    });
}

TEST_P(ShapeSmoothing, GivesTheSameBitsForAnyNumberOfThreads) {
  auto const& [run, smoothed] = overdone(GetParam());
  EXPECT_EQ(different_bits(smooth(run, run.morphed.position, Kokkos::Serial()).x, smoothed.x), 0);
}

TEST_P(ShapeSmoothing, LeavesSoundMeshesAlone) {
  Case const& c = GetParam();
  Planned const run(morph(c.mesh(), c.motion(0.01), c.options));
  auto const [x, report] = smooth(run, run.morphed.position);
  EXPECT_EQ(report.triggered_before, 0);
  EXPECT_EQ(report.rounds, 0);
  EXPECT_EQ(different_bits(x, run.morphed.position), 0);
}

INSTANTIATE_TEST_SUITE_P(Cases, ShapeSmoothing, testing::ValuesIn(make_cases()),
                         [](auto const& info) { return info.param.name; });

/// A box whose faces stay: each corner keeps its baseline shape where all nodes are back in place, and nowhere else.
class TangledBox : public testing::TestWithParam<std::tuple<Shape, double>> {};

TEST_P(TangledBox, GoesBackToTheBaseline) {
  auto const [shape, amplitude] = GetParam();
  Index3 const n{9, 8, 7};
  Planned const run(morph(box(n, shape, 5), motion({rule({"*"}, FixedRule{})})));
  Coordinates const& home = run.mesh.coordinates;
  Coordinates tangled = copy_of(home);
  Random random(11);
  Zone const& zone = run.mesh.zones[0];
  auto const largest = [&](Coordinates const& x) {
    double d = 0;
    for (Index m = 0; m < x.size(); ++m) d = std::max(d, distance(x[m], home[m]));
    return d;
  };
  for (int k = 1; k < n[2] - 1; ++k)
    for (int j = 1; j < n[1] - 1; ++j)
      for (int i = 1; i < n[0] - 1; ++i) {
        double const spacing = distance(home[zone.node({i + 1, j, k})], home[zone.node({i, j, k})]);
        tangled.set(zone.node({i, j, k}), home[zone.node({i, j, k})] + random.vector(amplitude * spacing));
      }
  ASSERT_GT(inside_out(run.mesh, tangled).second, 0);
  auto const [x, report] = smooth(run, tangled);
  EXPECT_EQ(report.inverted_after, 0);
  EXPECT_EQ(inside_out(run.mesh, x).second, 0);
  EXPECT_LT(largest(x), 0.05 * largest(tangled));
}

INSTANTIATE_TEST_SUITE_P(Boxes, TangledBox,
                         testing::Combine(testing::Values(Shape::straight, Shape::curved), testing::Values(0.7, 1.0)));

/// Two boxes that have nothing in common: what is made of one is kept, whatever becomes of the other.
class TwoBoxes {
 public:
  static Mesh mesh() {
    MeshBuilder builder("two");
    for (int z = 0; z < 2; ++z) {
      Index3 const n = z == 0 ? Index3{9, 8, 7} : Index3{5, 5, 5};
      builder.zone(z == 0 ? "near" : "far", n, [z](Index3 const& p) {
        return Vec3{double(p[0]) + 20 * z, double(p[1]) + 0.1 * p[0], 1.2 * p[2]};
      });
      for (int axis = 0; axis < 3; ++axis)
        for (int const side : {0, 1}) builder.patch("wall", PatchKind::wall, z, axis, side);
    }
    return builder.finish();
  }

  [[nodiscard]] Coordinates tangled(std::array<double, 2> const& amplitude, unsigned seed) const {
    Coordinates out = copy_of(run.mesh.coordinates);
    Random random(seed);
    for (std::size_t z = 0; z < 2; ++z) {
      Zone const& zone = run.mesh.zones[z];
      for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n) {
        Index3 const p = zone.index(n);
        bool inside = true;
        for (std::size_t axis = 0; axis < 3; ++axis) inside = inside && p[axis] > 0 && p[axis] + 1 < zone.extent[axis];
        // The second one with its faces, so that it has cells that nothing mends.
        if (inside || z == 1) out.set(n, out[n] + random.vector(amplitude[z]));
      }
    }
    return out;
  }

  struct Kept {
    bool changed = false;
    Index inverted = 0;
  };
  /// What became of one box, as the other is at home or not.
  [[nodiscard]] Kept of_box(std::size_t z, Coordinates const& before, Coordinates const& after) const {
    Zone const& zone = run.mesh.zones[z];
    Coordinates x = copy_of(run.mesh.coordinates);
    Kept out;
    for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n) {
      x.set(n, after[n]);
      out.changed = out.changed || !same_bits(before[n], after[n]);
    }
    out.inverted = inside_out(run.mesh, x).first;
    return out;
  }

  Planned run{morph(mesh(), motion({rule({"*"}, FixedRule{})}))};
};

TEST(SmoothingOfParts, IsKeptWhereItHelpsAndTakenBackWhereItDoesNot) {
  TwoBoxes const boxes;
  int mixed = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Coordinates const tangled = boxes.tangled({0.6, 2}, seed);
    auto const [x, report] = smooth(boxes.run, tangled);
    std::array<TwoBoxes::Kept, 2> was, is;
    for (std::size_t z = 0; z < 2; ++z) {
      was[z] = boxes.of_box(z, tangled, tangled);
      is[z] = boxes.of_box(z, tangled, x);
      EXPECT_LE(is[z].inverted, was[z].inverted) << seed << " box " << z;
    }
    EXPECT_TRUE(is[0].changed) << seed;
    EXPECT_LT(is[0].inverted, was[0].inverted) << seed;
    mixed += is[0].changed && !is[1].changed ? 1 : 0;
  }
  EXPECT_GT(mixed, 0) << "no box is made worse";
}

}  // namespace
}  // namespace gridmorph::test
