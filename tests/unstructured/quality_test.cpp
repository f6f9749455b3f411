// Reports of unstructured meshes: the structured measures where the definitions coincide, analytic values elsewhere.
#include "quality/test_meshes.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/built_for.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>
#include <gridmorph/quality/validity.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gridmorph::test {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;
using Input = UnstructuredQualityInput<Kokkos::HostSpace>;

struct Prepared {
  explicit Prepared(Mesh m) : mesh(std::move(m)) {
    check_mesh(mesh);
    topology = make_topology(mesh);
    face_patches = find_face_patches(mesh, topology);
  }
  template <class E = Exec>
  [[nodiscard]] QualityReport measure(Input const& input) const {
    return measure_quality(E(), mesh, topology, face_patches, input);
  }
  Mesh mesh;
  UnstructuredTopology topology;
  BoundaryFacePatches face_patches;
};

Vec3 swirl(Vec3 const& p) { return p + 0.02 * Vec3{std::sin(9 * p.y), std::sin(7 * p.x * p.z), p.x}; }

void expect_equal(QualityRegion const& a, QualityRegion const& b, bool same_bits) {
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.inverted, b.inverted);
  EXPECT_EQ(a.newly_inverted, b.newly_inverted);
  EXPECT_EQ(a.collapsed, b.collapsed);
  for (std::size_t m = 0; m < n_measures; ++m) {
    if (Measure(m) >= Measure::relative_displacement_i) continue;  // along grid lines of blocks alone
    SCOPED_TRACE(to_string(Measure(m)));
    if (same_bits) {
      EXPECT_EQ(a.measure[m].min, b.measure[m].min);
      EXPECT_EQ(a.measure[m].mean, b.measure[m].mean);
      EXPECT_EQ(a.measure[m].max, b.measure[m].max);
      EXPECT_EQ(a.measure[m].worst_cell, b.measure[m].worst_cell);
    } else {
      double const size = std::max({std::abs(a.measure[m].min), std::abs(a.measure[m].max), 1e-3});
      EXPECT_NEAR(a.measure[m].min, b.measure[m].min, 1e-11 * size);
      EXPECT_NEAR(a.measure[m].mean, b.measure[m].mean, 1e-11 * size);
      EXPECT_NEAR(a.measure[m].max, b.measure[m].max, 1e-11 * size);
    }
    EXPECT_EQ(a.measure[m].worst_zone, b.measure[m].worst_zone);
  }
}

TEST(UnstructuredQuality, HexahedraHaveTheNumbersOfTheStructuredMesh) {
  for (auto const& orientation : all_orientations()) {
    Mesh const structured = two_zones(orientation, true);
    Coordinates const after = moved(structured, swirl);
    Prepared const converted(to_hexahedra(structured));
    Kokkos::View<std::uint8_t*, Kokkos::HostSpace> mask("mask", structured.n_cells());
    for (Index c = 0; c < structured.n_cells(); ++c) mask(c) = c % 5 < 2 ? 1 : 0;
    QualityInput<Kokkos::HostSpace> input;
    input.coordinates = views(after);
    input.baseline = views(structured.coordinates);
    input.near_field = mask;
    Input same;
    same.coordinates = views(after);
    same.baseline = views(structured.coordinates);
    same.near_field = mask;
    QualityReport const expected = measure_quality(Exec(), structured, input);
    QualityReport const found = converted.measure(same);
    expect_equal(found.near_field, expected.near_field, false);
    expect_equal(found.far_field, expected.far_field, false);
    EXPECT_TRUE(found.unstructured);
  }
}

TEST(UnstructuredQuality, WorstElementIsTheWorstCellAndHasItsNumberInTheFile) {
  Mesh structured = unit_box({7, 5, 4});
  structured.coordinates.set(structured.zones[0].node({3, 2, 2}), {3.9, 2.6, 2.2});
  Prepared const converted(to_hexahedra(structured));
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(structured.coordinates);
  Input same;
  same.coordinates = views(converted.mesh.coordinates);
  auto const expected = measure_quality(Exec(), structured, input).far_field;
  auto const found = converted.measure(same).far_field;
  for (auto const m : {Measure::determinant_3x3x3, Measure::minimum_angle_deg, Measure::aspect_ratio}) {
    Index3 const c = expected[m].worst_cell;
    EXPECT_EQ(found[m].worst_cell[0], c[0] + 7 * (c[1] + 5 * c[2]));
  }
}

TEST(UnstructuredQuality, VolumeIsKeptBySplitting) {
  Mesh const structured = one_zone({9, 7, 6}, [](Index3 const& p) {
    return wavy({0.1 * p[0], 0.2 * p[1], 0.1 * p[2] * (1 + 0.2 * p[2])}, 0.01);
  });
  auto const total = [](QualityReport const& r) {
    return r.far_field[Measure::volume].mean * double(r.far_field.cells);
  };
  Prepared const tetrahedra(to_prisms_and_tetrahedra(structured, 0));
  Prepared const mixed(to_prisms_and_tetrahedra(structured, 3));
  Input a, b;
  a.coordinates = views(tetrahedra.mesh.coordinates);
  b.coordinates = views(mixed.mesh.coordinates);
  auto const ra = tetrahedra.measure(a), rb = mixed.measure(b);
  EXPECT_EQ(ra.far_field.inverted, 0);
  EXPECT_EQ(rb.far_field.inverted, 0);
  EXPECT_EQ(ra.cells(), 6 * 8 * 6 * 5);
  EXPECT_EQ(rb.cells(), 2 * 8 * 6 * 3 + 6 * 8 * 6 * 2);
  // Faces of the two splittings differ where they are warped, so only the box of the mesh is known: compare loosely.
  EXPECT_NEAR(total(ra), total(rb), 2e-3 * total(ra));
}

TEST(UnstructuredQuality, SplitUnitCubesHaveKnownValues) {
  Prepared const mixed(to_prisms_and_tetrahedra(unit_box({3, 3, 4}), 2));
  Input input;
  input.coordinates = views(mixed.mesh.coordinates);
  auto const r = mixed.measure(input).far_field;
  EXPECT_NEAR(r[Measure::volume].min, 1.0 / 6, 1e-15);  // a tetrahedron
  EXPECT_NEAR(r[Measure::volume].max, 0.5, 1e-15);      // a prism
  EXPECT_NEAR(r[Measure::volume_ratio].max, 3, 1e-14);  // where the two meet
  EXPECT_NEAR(r[Measure::aspect_ratio].max, std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(r[Measure::minimum_angle_deg].min, std::asin(1 / std::sqrt(3.0)) * 180 / std::acos(-1.0), 1e-10);
  EXPECT_NEAR(r[Measure::determinant_2x2x2].max, 1, 1e-14);
  // Edges 1, sqrt(2), sqrt(3) at the ends of the diagonal: sqrt(2) * 1 / sqrt(6).
  EXPECT_NEAR(r[Measure::determinant_2x2x2].min, 1 / std::sqrt(3.0), 1e-14);
}

TEST(UnstructuredQuality, FirstHeightsAndAnglesAreThoseOfTheLayers) {
  // Layers of height 0.1 over the plane k = 0, their lines leaning by 30 degrees.
  double const lean = std::tan(std::acos(-1.0) / 6);
  Mesh structured = unit_box({4, 3, 5});
  for (Index n = 0; n < structured.n_nodes(); ++n) {
    Vec3 const p = structured.coordinates[n];
    structured.coordinates.set(n, {p.x + 0.1 * lean * p.z, p.y, 0.1 * p.z});
  }
  for (auto const& mesh : {to_hexahedra(structured), to_prisms_and_tetrahedra(structured, 2)}) {
    Prepared const p(mesh);
    Input input;
    input.coordinates = views(p.mesh.coordinates);
    input.walls = {4};  // k_min
    auto const wall = p.measure(input);
    EXPECT_EQ(wall.wall.nodes, 5 * 4);
    EXPECT_NEAR(wall.wall.first_height_min, 0.1, 1e-15);
    EXPECT_NEAR(wall.wall.first_height_max, 0.1, 1e-15);
    EXPECT_NEAR(wall.wall.orthogonality_deg_mean, 30, 1e-10);
    ASSERT_EQ(wall.wall_groups.size(), 1u);
    EXPECT_EQ(wall.wall_groups[0].name, "k_min");
    Coordinates higher(p.mesh.n_nodes());
    for (Index n = 0; n < p.mesh.n_nodes(); ++n) {
      Vec3 const x = p.mesh.coordinates[n];
      higher.set(n, {x.x, x.y, 1.5 * x.z});
    }
    input.baseline = input.coordinates;
    input.coordinates = views(higher);
    EXPECT_NEAR(p.measure(input).wall.height_change_max, 0.5, 1e-14);
  }
  // Tetrahedra have no layers.
  Prepared const tetrahedra(to_prisms_and_tetrahedra(structured, 0));
  Input input;
  input.coordinates = views(tetrahedra.mesh.coordinates);
  input.walls = {4};
  EXPECT_EQ(tetrahedra.measure(input).wall.nodes, 0);
}

TEST(UnstructuredQuality, FlatMeshesAreMeasuredAsAreas) {
  Prepared const flat(flat_box(6, 5, 2));
  Input input;
  input.coordinates = views(flat.mesh.coordinates);
  input.walls = {2};  // j_min
  auto const r = flat.measure(input);
  EXPECT_EQ(r.cells(), 6 * 2 + 2 * 6 * 3);
  EXPECT_EQ(r.far_field.inverted, 0);
  EXPECT_NEAR(r.far_field[Measure::volume].mean * double(r.cells()), 30, 1e-12);
  EXPECT_NEAR(r.far_field[Measure::minimum_angle_deg].min, 45, 1e-10);
  EXPECT_EQ(r.wall.nodes, 7);
  EXPECT_NEAR(r.wall.first_height_mean, 1, 1e-15);
  EXPECT_NEAR(r.wall.orthogonality_deg_max, 0, 1e-6);
}

TEST(UnstructuredQuality, ElementsNumberedInsideOutAreFoundAndNotRepaired) {
  auto mesh = to_prisms_and_tetrahedra(unit_box({3, 3, 4}), 2);
  auto const before = mesh.elements.nodes.item;
  EXPECT_TRUE(negative_elements(mesh).empty());
  for (Index const e : {4, 9}) {
    auto const first = std::size_t(mesh.elements.nodes.first[e]);
    std::swap(mesh.elements.nodes.item[first + 1], mesh.elements.nodes.item[first + 2]);
    std::swap(mesh.elements.nodes.item[first + 4], mesh.elements.nodes.item[first + 5]);
  }
  auto const negative = negative_elements(mesh);
  ASSERT_EQ(negative.size(), 1u);
  EXPECT_EQ(negative[0].type, ElementType::prism);
  EXPECT_EQ(negative[0].count, 2);
  EXPECT_EQ(negative[0].of, 2 * 3 * 3 * 2);
  EXPECT_EQ(negative[0].first, 4);
  EXPECT_NE(describe(mesh, negative[0]).find("2 of 36 elements of type prism are numbered inside out"),
            std::string::npos);
  Prepared const p(mesh);
  EXPECT_NE(p.mesh.elements.nodes.item, before);
  Input input;
  input.coordinates = views(p.mesh.coordinates);
  EXPECT_EQ(p.measure(input).far_field.inverted, 0);  // numbered the other way than the rest, and sound
}

/// Numbers an element the other way round.
void reverse(Mesh& mesh, Index e) {
  auto const first = mesh.elements.nodes.item.begin() + mesh.elements.nodes.first[e];
  std::reverse(first, first + n_corners(mesh.elements.type[e]));
}

// Quadrilaterals one way and triangles the other, as hybrid meshes in 2-D are.
TEST(UnstructuredQuality, AFlippedElementIsInvertedAndAHealedOneIsSoundHoweverElementsAreNumbered) {
  for (int const way : {0, 1, 2, 3}) {
    auto mesh = flat_box(6, 5, 2);
    for (Index e = 0; e < mesh.n_elements(); ++e) {
      bool const triangle = mesh.elements.type[e] == ElementType::triangle;
      if ((way == 1 && triangle) || (way == 2 && !triangle) || (way == 3 && e % 3 == 1)) reverse(mesh, e);
    }
    Prepared const p(mesh);
    Input input;
    input.coordinates = views(p.mesh.coordinates);
    EXPECT_EQ(p.measure(input).far_field.inverted, 0) << way;
    // A node among the triangles goes through the side across.
    Coordinates torn(p.mesh.n_nodes());
    Index node = -1;
    for (Index n = 0; n < p.mesh.n_nodes(); ++n) {
      torn.set(n, p.mesh.coordinates[n]);
      if (distance(p.mesh.coordinates[n], {3, 4, 0}) < 1e-9) node = n;
    }
    ASSERT_GE(node, 0);
    torn.set(node, {4.4, 4.2, 0});
    input.baseline = input.coordinates;
    input.coordinates = views(torn);
    for (bool const fast : {false, true}) {
      input.fast = fast;
      QualityRegion const r = p.measure(input).far_field;
      EXPECT_GT(r.inverted, 0) << way;
      EXPECT_EQ(r.newly_inverted, r.inverted) << way;
    }
    // The other way round: what was torn is whole again. Signs come from the mesh, so it is the baseline.
    Mesh torn_mesh = p.mesh;
    torn_mesh.coordinates = torn;
    Prepared const q(torn_mesh);
    Input healed;
    healed.coordinates = views(q.mesh.coordinates);
    EXPECT_GT(q.measure(healed).far_field.inverted, 0) << way;
    healed.baseline = healed.coordinates;
    healed.coordinates = views(p.mesh.coordinates);
    EXPECT_EQ(q.measure(healed).far_field.inverted, 0) << way;
    EXPECT_EQ(q.measure(healed).far_field.newly_inverted, 0) << way;
  }
}

TEST(UnstructuredQuality, SignsOfNumberingAreThoseThatEachElementWasGivenInEveryKindOfMesh) {
  for (auto const& original : {to_prisms_and_tetrahedra(unit_box({4, 3, 5}), 2), to_hexahedra(unit_box({4, 4, 3})),
                               to_prisms_and_tetrahedra(unit_box({3, 3, 3}), 0)}) {
    auto mesh = original;
    std::vector<signed char> expected;
    for (Index e = 0; e < mesh.n_elements(); ++e) {
      bool const turned = e % 5 < 2;
      expected.push_back(turned ? -1 : 1);
      if (!turned) continue;
      auto const first = std::size_t(mesh.elements.nodes.first[e]);
      auto* const n = mesh.elements.nodes.item.data() + first;
      switch (mesh.elements.type[e]) {
        case ElementType::tetrahedron: std::swap(n[0], n[1]); break;
        case ElementType::prism:
          std::swap(n[0], n[1]);
          std::swap(n[3], n[4]);
          break;
        default:
          for (int k = 0; k < 4; ++k) std::swap(n[k], n[k + 4]);
      }
    }
    EXPECT_EQ(numbering_signs(mesh, element_sides(mesh)), expected);
  }
}

TEST(UnstructuredQuality, FlatElementsOfEveryTypeAreNeitherInvertedNorSound) {
  Mesh structured = unit_box({3, 3, 4});
  for (Index n = 0; n < structured.n_nodes(); ++n)
    if (Vec3 const x = structured.coordinates[n]; x.z == 4)
      structured.coordinates.set(n, {100 + x.x, x.y, 3 + 1e-14 * ((n % 3) - 1.0)});
    else
      structured.coordinates.set(n, {100 + x.x, x.y, x.z});
  for (auto const& mesh :
       {to_hexahedra(structured), to_prisms_and_tetrahedra(structured, 0), to_prisms_and_tetrahedra(structured, 4)}) {
    Prepared const p(mesh);
    Input input;
    input.coordinates = views(p.mesh.coordinates);
    QualityRegion const r = p.measure(input).far_field;
    EXPECT_EQ(r.flat, r.cells / 4);
    EXPECT_EQ(r.inverted, 0);
    Coordinates after(p.mesh.n_nodes());
    for (Index n = 0; n < p.mesh.n_nodes(); ++n) {
      Vec3 const x = p.mesh.coordinates[n];
      after.set(n, {x.x + 0.01 * x.y, x.y, x.z > 2.5 ? 3 - (x.z - 3) : x.z});
    }
    input.baseline = input.coordinates;
    input.coordinates = views(after);
    for (bool const fast : {false, true}) {
      input.fast = fast;
      EXPECT_EQ(p.measure(input).far_field.newly_inverted, 0);
      EXPECT_EQ(p.measure(input).far_field.flat, r.flat);
    }
  }
}

TEST(UnstructuredQuality, FlatCellsTurnedByLittleAreFlatBeforeInBlocksAndElements) {
  // A collapsed tip: the nodes of the last plane lie in the one before it, half a cell aside, so that no edge is short.
  Mesh structured = unit_box({10, 9, 5});
  std::vector<double> share(structured.n_nodes());
  for (Index n = 0; n < structured.n_nodes(); ++n) {
    Vec3 const x = structured.coordinates[n];
    share[n] = x.z / 5;
    if (x.z == 5) structured.coordinates.set(n, {x.x + 0.5, x.y, 4});
  }
  // Pitched about the middle of the tip, less and less towards the other end.
  auto const pitched = [&](double degrees) {
    Coordinates out(structured.n_nodes());
    for (Index n = 0; n < out.size(); ++n) {
      Vec3 const x = structured.coordinates[n];
      double const angle = share[n] * degrees * std::acos(-1.0) / 180, c = std::cos(angle), s = std::sin(angle);
      out.set(n, {5 + c * (x.x - 5) + s * (x.z - 4), x.y, 4 - s * (x.x - 5) + c * (x.z - 4)});
    }
    return out;
  };
  Coordinates const little = pitched(0.01), much = pitched(0.1);
  auto const expect = [&](Index flat, auto const& measure, auto const& certify_it) {
    for (bool const fast : {false, true}) {
      QualityRegion const at_rest = measure(structured.coordinates, fast), now = measure(little, fast);
      EXPECT_EQ(at_rest.flat, flat);
      EXPECT_EQ(at_rest[Fall::flat_before].cells, 0);
      FallenCells const& before = now[Fall::flat_before];
      EXPECT_GT(before.cells, flat / 4);
      EXPECT_LE(before.cells, flat);
      EXPECT_GE(now.flat, before.cells);
      EXPECT_LT(before.worst, -1e-4);
      EXPECT_GT(before.worst, -1e-3);
      EXPECT_EQ(now.inverted, 0);
      EXPECT_EQ(now.newly_inverted, 0);
      // Ten times as far those that were beyond a tenth of the allowance are inverted.
      QualityRegion const far = measure(much, fast);
      EXPECT_GT(far.newly_inverted, flat / 8);
      EXPECT_EQ(far.inverted, far.newly_inverted);
      EXPECT_GT(far[Fall::flat_before].worst, -1e-3);
    }
    Certificate const now = certify_it(little), far = certify_it(much);
    EXPECT_TRUE(now.holds());
    EXPECT_GT(now.flat_before, flat / 4);
    EXPECT_EQ(now.negative, 0);
    EXPECT_FALSE(far.holds());
    EXPECT_EQ(far.broken.cells, far.negative);
    EXPECT_GT(far.flat_before, 0);
  };
  auto const input_for = [&](auto input, Coordinates const& x, bool fast) {
    input.coordinates = views(x);
    input.baseline = views(structured.coordinates);
    input.fast = fast;
    return input;
  };
  expect(
      90,
      [&](Coordinates const& x, bool fast) {
        return measure_quality(Exec(), structured, input_for(QualityInput<Kokkos::HostSpace>(), x, fast)).far_field;
      },
      [&](Coordinates const& x) {
        return certify(Exec(), structured, {views(x), views(structured.coordinates)});
      });
  struct Kind {
    Mesh mesh;
    Index flat;
  };
  for (auto const& [mesh, flat] :
       {Kind{to_hexahedra(structured), 90}, Kind{to_prisms_and_tetrahedra(structured, 5), 180},
        Kind{to_prisms_and_tetrahedra(structured, 0), 540}}) {
    Prepared const p(mesh);
    expect(
        flat, [&](Coordinates const& x, bool fast) { return p.measure(input_for(Input(), x, fast)).far_field; },
        [&](Coordinates const& x) {
          return certify(Exec(), p.mesh, p.topology, {views(x), views(structured.coordinates)});
        });
  }
}

TEST(UnstructuredQuality, FlatElementsOfAPlaneTurnedByLittleAreFlatBefore) {
  // The triangles and quadrilaterals beside i = 3 have all their corners on one line.
  for (int const layers : {0, 4}) {
    Mesh mesh = flat_box(6, 4, layers);
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      if (Vec3 const x = mesh.coordinates[n]; x.x == 3) mesh.coordinates.set(n, {2, x.y + 0.25, 0});
    Prepared const p(std::move(mesh));
    Input input;
    auto const turned = [&](double by) {
      Coordinates out(p.mesh.n_nodes());
      for (Index n = 0; n < out.size(); ++n) {
        Vec3 const x = p.mesh.coordinates[n];
        bool const moves = x.x == 2 && x.y != std::floor(x.y);
        out.set(n, {x.x - (moves ? by : 0), x.y, 0});
      }
      return out;
    };
    Coordinates const little = turned(1e-4), much = turned(1e-2);
    input.baseline = views(p.mesh.coordinates);
    for (bool const fast : {false, true}) {
      input.fast = fast;
      input.coordinates = views(little);
      QualityRegion const r = p.measure(input).far_field;
      EXPECT_EQ(r[Fall::flat_before].cells, layers == 0 ? 8 : 4);
      EXPECT_EQ(r.inverted, 0);
      EXPECT_EQ(r.newly_inverted, 0);
      input.coordinates = views(much);
      EXPECT_EQ(p.measure(input).far_field.newly_inverted, layers == 0 ? 8 : 4);
    }
    EXPECT_TRUE(certify(Exec(), p.mesh, p.topology, {views(little), input.baseline}).holds());
    EXPECT_FALSE(certify(Exec(), p.mesh, p.topology, {views(much), input.baseline}).holds());
  }
}

TEST(UnstructuredQuality, AVerdictSaysWhatTheFullMeasurementSays) {
  Prepared const p(to_prisms_and_tetrahedra(unit_box({6, 5, 7}), 3));
  Coordinates after(p.mesh.n_nodes());
  for (Index n = 0; n < p.mesh.n_nodes(); ++n) {
    Vec3 const x = p.mesh.coordinates[n];
    after.set(n, x + Vec3{x.z > 3.5 ? 4.0 : 0.0, 0, x.x == 3 && x.y == 2 ? 0.9 : 0.0});
  }
  Input input;
  input.coordinates = views(after);
  input.baseline = views(p.mesh.coordinates);
  input.limits = {0.3, 9, 0.8, 0.5};
  QualityRegion const full = p.measure(input).far_field;
  input.fast = true;
  QualityRegion const fast = p.measure(input).far_field;
  EXPECT_GT(full[Fall::angle].cells, 0);
  EXPECT_GT(full[Fall::loss].cells, 0);
  EXPECT_EQ(fast.inverted, full.inverted);
  for (std::size_t f = 0; f < n_falls; ++f) {
    EXPECT_EQ(fast.fallen[f].cells, full.fallen[f].cells) << to_string(Fall(f));
    EXPECT_EQ(fast.fallen[f].worst_cell, full.fallen[f].worst_cell) << to_string(Fall(f));
  }
  for (Measure const m : {Measure::determinant_3x3x3, Measure::minimum_angle_deg}) {
    EXPECT_EQ(fast[m].min, full[m].min);
    EXPECT_EQ(fast[m].worst_cell, full[m].worst_cell);
  }
}

TEST(UnstructuredQuality, AZoneThatIsNumberedInsideOutIsSoundButCounted) {
  auto mesh = to_hexahedra(unit_box({3, 3, 3}));
  for (std::size_t at = 0; at < mesh.elements.nodes.item.size(); at += 8)
    for (std::size_t k = 0; k < 4; ++k)
      std::swap(mesh.elements.nodes.item[at + k], mesh.elements.nodes.item[at + k + 4]);
  Prepared const p(mesh);
  Input input;
  input.coordinates = views(p.mesh.coordinates);
  auto const r = p.measure(input);
  EXPECT_EQ(r.far_field.inverted, 0);
  EXPECT_EQ(r.left_handed_zones, 1);
  EXPECT_EQ(negative_elements(mesh).front().count, 27);
}

TEST(UnstructuredQuality, FieldsAreTheValuesBehindTheReport) {
  Prepared const p(to_prisms_and_tetrahedra(one_zone({9, 7, 6},
                                                     [](Index3 const& q) {
                                                       return wavy({0.1 * q[0], 0.2 * q[1], 0.15 * q[2]}, 0.01);
                                                     }),
                                            2));
  Coordinates const after = [&] {
    Coordinates x(p.mesh.n_nodes());
    for (Index n = 0; n < p.mesh.n_nodes(); ++n) x.set(n, swirl(p.mesh.coordinates[n]));
    return x;
  }();
  Input input;
  input.coordinates = views(after);
  input.baseline = views(p.mesh.coordinates);
  input.faces = true;
  std::vector<Measure> all;
  for (std::size_t m = 0; m < n_measures; ++m) all.push_back(Measure(m));
  auto const fields = cell_fields(Exec(), p.mesh, p.topology, input, all);
  auto const report = p.measure(input).far_field;
  for (std::size_t m = 0; m < n_measures; ++m) {
    double low = HUGE_VAL, high = -HUGE_VAL, sum = 0;
    for (std::size_t e = 0; e < fields[m].extent(0); ++e) {
      low = std::min(low, fields[m](e));
      high = std::max(high, fields[m](e));
      sum += fields[m](e);
    }
    EXPECT_EQ(low, report.measure[m].min);
    EXPECT_EQ(high, report.measure[m].max);
    EXPECT_NEAR(sum / double(report.cells), report.measure[m].mean, 1e-10 * std::abs(high));
  }
}

/// A region is what the near field would be of which its elements are.
TEST(UnstructuredQuality, RegionsAreMeasuredByThemselves) {
  Prepared const p(to_prisms_and_tetrahedra(one_zone({7, 6, 5},
                                                     [](Index3 const& q) {
                                                       return wavy({0.1 * q[0], 0.1 * q[1], 0.1 * q[2]}, 0.01);
                                                     }),
                                            2));
  Coordinates after(p.mesh.n_nodes());
  for (Index n = 0; n < p.mesh.n_nodes(); ++n) after.set(n, swirl(p.mesh.coordinates[n]));
  Input input;
  input.coordinates = views(after);
  input.baseline = views(p.mesh.coordinates);
  Kokkos::View<std::uint8_t*, Kokkos::HostSpace> const some("some", std::size_t(p.mesh.n_elements()));
  for (Index e = 0; e < p.mesh.n_elements(); ++e) some(std::size_t(e)) = e % 5 == 1 ? 1 : 0;
  input.near_field = some;
  QualityReport const split = p.measure(input);
  input.near_field = {};
  input.regions = {{"wake", some}};
  QualityReport const report = p.measure(input);
  EXPECT_EQ(report.near_field.cells, 0);
  EXPECT_EQ(report.far_field.cells, p.mesh.n_elements());
  ASSERT_EQ(report.regions.size(), 1U);
  EXPECT_EQ(report.regions[0].name, "wake");
  ASSERT_GT(split.near_field.cells, 0);
  expect_equal(report.regions[0].quality, split.near_field, true);
}

#if defined(GRIDMORPH_WITH_SERIAL) && defined(GRIDMORPH_WITH_OPENMP)
TEST(UnstructuredQuality, SerialAndOpenMPAgreeBitForBit) {
  Prepared const p(to_prisms_and_tetrahedra(
      one_zone({31, 22, 13},
               [](Index3 const& q) {
                 return wavy({0.05 * q[0], 0.06 * q[1], 0.01 * q[2] * (1 + 0.3 * q[2])}, 0.003);
               }),
      5));
  Coordinates after(p.mesh.n_nodes());
  for (Index n = 0; n < p.mesh.n_nodes(); ++n) after.set(n, swirl(p.mesh.coordinates[n]));
  Input input;
  input.coordinates = views(after);
  input.baseline = views(p.mesh.coordinates);
  auto const serial = p.measure<Kokkos::Serial>(input), openmp = p.measure<Kokkos::OpenMP>(input);
  expect_equal(serial.near_field, openmp.near_field, true);
  expect_equal(serial.far_field, openmp.far_field, true);
}
#endif

TEST(UnstructuredQuality, ViewsThatAreTooShortAreRefused) {
  Prepared const p(to_hexahedra(unit_box({2, 2, 2})));
  Coordinates const few(5);
  Input input;
  input.coordinates = views(few);
  EXPECT_THROW(p.measure(input), MeshError);
  input.coordinates = views(p.mesh.coordinates);
  input.near_field = Kokkos::View<std::uint8_t*, Kokkos::HostSpace>("mask", 3);
  EXPECT_THROW(p.measure(input), MeshError);
}

}  // namespace
}  // namespace gridmorph::test
