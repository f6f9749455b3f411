// Smoothing where elements came out bad: what it repairs, what it must leave alone, and that it counts right although
// it measures only around the nodes that it moves.
#include "support/made_bodies.hpp"
#include "support/random.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/guard/relaxation.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>
#include <gridmorph/quality/validity.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

/// A box of prisms and tetrahedra whose wall k_min is lifted a little, with the mesh moved by `displacement` on top.
struct Box {
  Mesh mesh = to_prisms_and_tetrahedra(unit_box({8, 8, 8}), 2);
  UnstructuredTopology topology = make_topology(mesh);
  BoundaryFacePatches face_patches = find_face_patches(mesh, topology);
  PreparedUnstructured prepared;
  Coordinates morphed;

  Box() {
    Motion motion;
    motion.rules.push_back({{"k_min"}, RigidRule{{}, {0, 0, 0.1}}, 0, "test"});
    motion.rules.push_back({{"i_min", "i_max", "j_min", "j_max"}, SlipRule{}, 0, "test"});
    prepared = prepare(mesh, topology, face_patches, motion, {});
    morphed = Coordinates(mesh.n_nodes());
    for (Index n = 0; n < mesh.n_nodes(); ++n) morphed.set(n, mesh.coordinates[n]);
  }

  [[nodiscard]] Index bad(double share) const {
    UnstructuredQualityInput<Kokkos::HostSpace> input;
    Measure const measure[] = {Measure::determinant_3x3x3};
    input.coordinates = views(mesh.coordinates);
    auto const before = cell_fields(Exec(), mesh, topology, input, measure).front();
    input.coordinates = views(morphed);
    auto const now = cell_fields(Exec(), mesh, topology, input, measure).front();
    Index count = 0;
    for (Index e = 0; e < mesh.n_elements(); ++e) count += now(e) > share * before(e) ? 0 : 1;
    return count;
  }
};

bool inside(Vec3 const& p) { return p.x > 0 && p.x < 8 && p.y > 0 && p.y < 8 && p.z > 3 && p.z < 8; }

TEST(Guard, AnAffineMotionIsLeftAlone) {
  Box box;
  for (Index n = 0; n < box.mesh.n_nodes(); ++n) {
    Vec3 const x = box.mesh.coordinates[n];
    box.morphed.set(n, {x.x + 0.2 * x.y, 1.1 * x.y, x.z + 0.1 * x.x});
  }
  Coordinates before(box.mesh.n_nodes());
  for (Index n = 0; n < box.mesh.n_nodes(); ++n) before.set(n, box.morphed[n]);
  GuardReport const report = relax_bad_elements(box.mesh, box.topology, box.prepared, box.morphed);
  EXPECT_EQ(report.before, 0);
  EXPECT_EQ(report.rounds, 0);
  for (Index n = 0; n < box.mesh.n_nodes(); ++n) EXPECT_EQ(box.morphed[n], before[n]);
}

TEST(Guard, NodesThatWentAstrayAreBroughtBack) {
  Box box;
  Random random(11);
  Index moved = 0;
  for (Index n = 0; n < box.mesh.n_nodes(); ++n)
    if (Vec3 const x = box.mesh.coordinates[n]; inside(x) && random.below(6) == 0) {
      box.morphed.set(n, x + random.vector(1.2));
      ++moved;
    }
  ASSERT_GT(moved, 20);
  RelaxOptions const options;
  Index const bad = box.bad(options.share);
  ASSERT_GT(bad, 50);
  GuardReport const report = relax_bad_elements(box.mesh, box.topology, box.prepared, box.morphed, options);
  EXPECT_EQ(report.before, bad);
  EXPECT_EQ(report.after, box.bad(options.share));
  EXPECT_LT(report.after, bad / 10);
}

TEST(Guard, WhatIsHeldStays) {
  Box box;
  // The wall itself is pushed through the first layer: nothing that may move can repair that.
  Index const n_nodes = box.mesh.n_nodes();
  for (Index n = 0; n < n_nodes; ++n)
    if (Vec3 const x = box.mesh.coordinates[n]; x.z == 0) box.morphed.set(n, x + Vec3{0, 0, 1.5});
  Coordinates before(n_nodes);
  for (Index n = 0; n < n_nodes; ++n) before.set(n, box.morphed[n]);
  GuardReport const report = relax_bad_elements(box.mesh, box.topology, box.prepared, box.morphed);
  EXPECT_GT(report.before, 0);
  EXPECT_EQ(report.after, box.bad(RelaxOptions().share));
  EXPECT_LE(std::pair(report.inverted_after, report.after), std::pair(report.inverted_before, report.before));
  for (Index n = 0; n < n_nodes; ++n) {
    Vec3 const x = box.mesh.coordinates[n];
    bool const on_boundary = x.z == 0 || x.z == 8 || x.x == 0 || x.x == 8 || x.y == 0 || x.y == 8;
    if (on_boundary) {
      EXPECT_EQ(box.morphed[n], before[n]);
    }
  }
}

// A neighbour that is nowhere else, or 1e-16 away, is one among others: nothing overflows, and all come home.
TEST(Guard, NodesAtOnePlaceAreSmoothedToo) {
  constexpr int n_cells = 12;
  Mesh mesh = flat_box(n_cells, n_cells, 2);
  auto const is_inside = [](Vec3 const& p) { return p.x > 0 && p.x < n_cells && p.y > 3 && p.y < n_cells; };
  std::vector<Index> free;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const x = mesh.coordinates[n];
    if (is_inside(x)) free.push_back(n);
    // Edges of no length along y = 7, and of one that is round-off.
    bool const collapsed = is_inside(x) && x.y == 7 && x.x > 3;
    mesh.coordinates.set(n, (1 / 3.0) * (collapsed ? Vec3{x.x, x.x == 6 ? 8 - 1e-15 : 8, 0} : x));
  }
  UnstructuredTopology const topology = make_topology(mesh);
  Motion motion;
  motion.rules.push_back({{"j_min"}, RigidRule{{}, {0, 0.1, 0}}, 0, "test"});
  motion.rules.push_back({{"i_min", "i_max"}, SlipRule{}, 0, "test"});
  PreparedUnstructured const prepared = prepare(mesh, topology, find_face_patches(mesh, topology), motion, {});
  Coordinates x(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) x.set(n, mesh.coordinates[n]);
  Random random(12);
  for (Index const n : free) x.set(n, x[n] + Vec3{random.between(-0.3, 0.3), random.between(-0.3, 0.3), 0});
  GuardReport const report = relax_bad_elements(mesh, topology, prepared, x);
  EXPECT_GT(report.before, 20);
  EXPECT_LT(report.after, report.before / 2);
  for (Index const n : free) EXPECT_LT(distance(x[n], mesh.coordinates[n]), 1) << n;
}

enum class Cells { hexahedra, prisms_and_tetrahedra, polyhedra };

Mesh box_of(Cells kind) {
  Mesh const box = unit_box({7, 7, 7});
  switch (kind) {
    case Cells::hexahedra: return to_hexahedra(box);
    case Cells::prisms_and_tetrahedra: return to_prisms_and_tetrahedra(box, 2);
    case Cells::polyhedra: return as_polyhedra(to_hexahedra(box));
  }
  return {};
}

/// Boxes whose free nodes are thrown about by up to so much of an edge.
class TangledElements : public testing::TestWithParam<std::tuple<Cells, double>> {};

TEST_P(TangledElements, ComeHome) {
  auto const [kind, amplitude] = GetParam();
  Mesh const mesh = box_of(kind);
  UnstructuredTopology const topology = make_topology(mesh);
  BoundaryFacePatches const face_patches = find_face_patches(mesh, topology);
  Motion motion;
  motion.rules.push_back({{"k_min"}, RigidRule{{}, {0, 0, 0.1}}, 0, "test"});
  motion.rules.push_back({{"i_min", "i_max", "j_min", "j_max"}, SlipRule{}, 0, "test"});
  PlanOptions options;
  options.boundary_layers = {{{"k_min"}, BoundaryLayer::Extent::layers, 1, 0, BoundaryLayer::Mode::rotate}};
  PreparedUnstructured const prepared = prepare(mesh, topology, face_patches, motion, options);
  std::vector<std::uint8_t> held(mesh.n_nodes(), 0);
  for (auto const* list : {&prepared.plan.known, &prepared.plan.residual_nodes, &prepared.plan.columns.node})
    for (Index32 const n : *list) held[n] = 1;
  Random random(5);
  Coordinates tangled(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const move = held[n] != 0 ? Vec3{} : random.vector(amplitude);
    tangled.set(n, mesh.coordinates[n] + move);
  }
  auto const relaxed = [&](GuardReport& report) {
    Coordinates x(mesh.n_nodes());
    for (Index n = 0; n < mesh.n_nodes(); ++n) x.set(n, tangled[n]);
    report = relax_bad_elements(mesh, topology, prepared, x);
    return x;
  };
  GuardReport report;
  Coordinates const x = relaxed(report);
  EXPECT_GT(report.inverted_before, kind == Cells::polyhedra ? 1 : 20);  // by pyramids fewer are inside out
  EXPECT_EQ(report.inverted_before,
            certify(Exec(), mesh, topology, {views(tangled), views(mesh.coordinates)}).broken.cells);
  EXPECT_EQ(report.inverted_after, 0);
  EXPECT_TRUE(certify(Exec(), mesh, topology, {views(x), views(mesh.coordinates)}).holds());
  EXPECT_LT(report.after, report.before / 10);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (held[n] != 0) {
      EXPECT_EQ(x[n], tangled[n]);
    }
}

INSTANTIATE_TEST_SUITE_P(Boxes, TangledElements,
                         testing::Combine(testing::Values(Cells::hexahedra, Cells::prisms_and_tetrahedra,
                                                          Cells::polyhedra),
                                          testing::Values(0.6, 0.9)));

}  // namespace
}  // namespace gridmorph::test
