// Targets of sections for blades and wings of triangles: cuts through their facets do what rows of nodes do.
#include "motion/target_cases.hpp"
#include "support/cascade.hpp"
#include "support/expect_error.hpp"
#include "support/random.hpp"
#include "support/shared_mesh.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include <generators/passage.hpp>
#include <generators/passage_motion.hpp>
#include <gridmorph/boundary/joined_sides.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/mesh/block_elements.hpp>
#include <gridmorph/motion/target/section_rows.hpp>

#include <gtest/gtest.h>

#include <map>

namespace gridmorph::test {
namespace {

/// A mesh of blocks as tetrahedra: every quadrilateral of a patch becomes two triangles.
UnstructuredCase as_tetrahedra(Mesh const& blocks) {
  Mesh mesh = to_prisms_and_tetrahedra(blocks, 0);
  for (auto const& face : blocks.interfaces) mesh.connections.push_back(node_pairs(blocks, face));
  return UnstructuredCase(std::move(mesh));
}

/// One rule for one family of a mesh of elements.
struct SlicedRun {
  UnstructuredCase mesh;
  BoundaryMotion motion;
  std::vector<int> patches;

  SlicedRun(UnstructuredCase c, std::string const& family, TargetRule const& rule, Axis const& axis = {})
      : mesh(std::move(c)),
        motion(std::make_shared<Boundary const>(mesh.mesh, mesh.topology, mesh.face_patches),
               resolve(mesh.mesh, motion_of(family, rule, axis))),
        patches(select_patches(mesh.mesh, {family})) {}

  static Motion motion_of(std::string const& family, TargetRule const& rule, Axis const& axis) {
    Motion out;
    out.axis = axis;
    out.rules = {{{family}, rule, 0, "test"}};
    return out;
  }
  /// Displacement of every node of the patches.
  [[nodiscard]] std::map<Index, Vec3> displacement() const {
    std::map<Index, Vec3> out;
    for (int const p : patches) {
      auto const& nodes = motion.boundary().surface(p).nodes;
      std::vector<Vec3> points, u(nodes.size());
      for (Index const n : nodes) points.push_back(mesh.mesh.coordinates[n]);
      motion.displacement(0, points, u);
      for (std::size_t n = 0; n < nodes.size(); ++n) out[nodes[n]] = u[n];
    }
    return out;
  }
  [[nodiscard]] double error(Map const& map) const {
    double worst = 0;
    for (auto const& [n, u] : displacement()) {
      Vec3 const x = mesh.mesh.coordinates[n];
      worst = std::max(worst, distance(x + u, map(x)));
    }
    return worst;
  }
  [[nodiscard]] TargetReach reach() const {
    Coordinates moved(mesh.mesh.n_nodes());
    for (Index n = 0; n < moved.size(); ++n) moved.set(n, mesh.mesh.coordinates[n]);
    for (auto const& [n, u] : displacement()) moved.set(n, mesh.mesh.coordinates[n] + u);
    return motion.target_reach(moved).at(0);
  }
};

/// Sections of the wing of target_cases.hpp at given spans, n points each, moved.
TargetGeometry wing_sections(std::vector<double> const& spans, int n, Map const& map) {
  TargetGeometry out;
  for (double const h : spans) {
    TargetSection s{"z " + std::to_string(h), {}};
    for (int k = 0; k < n; ++k) s.points.push_back(map(wing(double(k % (n - 1)) / (n - 1), h)));
    out.sections.push_back(std::move(s));
  }
  return out;
}

std::vector<double> even_spans(int n) {
  std::vector<double> out;
  for (int k = 0; k <= n; ++k) out.push_back(double(k) / n);
  return out;
}

TargetRule along_z(TargetGeometry geometry) {
  TargetRule rule = rule_of(std::move(geometry), TargetRule::Mapping::sections);
  rule.span = Vec3{0, 0, 1};
  return rule;
}

/// Sections twist about their quarter chord and grow, both along the span.
Vec3 twisted(Vec3 const& x) {
  double const h = x.z / 3, angle = 0.2 * h, size = 1 + 0.1 * h, x0 = 0.5 * h + 0.25;
  double const c = size * std::cos(angle), s = size * std::sin(angle);
  return {x0 + c * (x.x - x0) - s * x.y, s * (x.x - x0) + c * x.y, x.z};
}

/// The wing's surface as triangles whose nodes stand in no rows: inner nodes are off them at random by `scatter` cells,
/// each quadrilateral is cut along its shorter diagonal, and a layer of prisms stands on it.
Mesh scattered_wing(int ni, int nj, double scatter) {
  Random random(7);
  Mesh mesh;
  mesh.source = "scattered wing";
  mesh.add_zone("wing", Index(2) * (ni - 1) * nj);
  mesh.coordinates = Coordinates(mesh.n_nodes());
  auto const node = [&](int i, int j, int k) { return Index32((i % (ni - 1)) + (ni - 1) * (j + nj * k)); };
  for (int j = 0; j < nj; ++j)
    for (int i = 0; i + 1 < ni; ++i) {
      bool const end = j == 0 || j + 1 == nj;
      double const s = (i + (i == 0 ? 0 : scatter * random.between(-0.5, 0.5))) / (ni - 1),
                   h = (j + (end ? 0 : scatter * random.between(-0.5, 0.5))) / (nj - 1);
      Vec3 const x = wing(s, h), middle = wing(0.5, h);
      mesh.coordinates.set(node(i, j, 0), x);
      mesh.coordinates.set(node(i, j, 1), x + 0.2 * (x - middle));
    }
  Patch wall, other;
  wall.name = "wing";
  wall.kind = PatchKind::wall;
  other.name = "other";
  wall.zone = other.zone = 0;
  for (int j = 0; j + 1 < nj; ++j)
    for (int i = 0; i + 1 < ni; ++i) {
      Index32 const a = node(i, j, 0), b = node(i + 1, j, 0), c = node(i + 1, j + 1, 0), d = node(i, j + 1, 0);
      auto const apart = [&](Index32 m, Index32 n) { return distance(mesh.coordinates[m], mesh.coordinates[n]); };
      Index32 const up = node(0, 0, 1);
      auto const add = [&](Index32 p, Index32 q, Index32 r) {
        mesh.add_element(ElementType::prism, std::array{p, q, r, p + up, q + up, r + up});
        wall.faces.add(std::array{p, q, r});
        other.faces.add(std::array{p + up, q + up, r + up});
      };
      if (apart(a, c) < apart(b, d)) {
        add(a, b, c);
        add(a, c, d);
      } else {
        add(a, b, d);
        add(b, c, d);
      }
    }
  mesh.patches = {wall, other};
  return mesh;
}

TEST(TargetSlices, ABladeMovedToItselfStays) {
  Mesh const blocks = wing_mesh();
  TargetGeometry same;
  auto const nodes = nodes_of(blocks, 0);
  for (int j = 0; j < 11; ++j)
    same.sections.push_back({std::to_string(j), {nodes.begin() + 61 * j, nodes.begin() + 61 * (j + 1)}});
  SlicedRun const run(as_tetrahedra(blocks), "wing", along_z(same));
  for (auto const& [n, u] : run.displacement()) EXPECT_TRUE(u == Vec3{}) << n << " " << norm(u);
  EXPECT_EQ(run.reach().mapping, TargetRule::Mapping::sections);
  EXPECT_LT(run.reach().max, 1e-15);
}

TEST(TargetSlices, RowsOfNodesCutIntoTrianglesGoWhereTheQuadrilateralsGo) {
  Mesh const blocks = wing_mesh();
  TargetRule const rule = along_z(wing_sections(even_spans(10), 81, twisted));
  TargetRun const quadrilaterals(blocks, rule);
  SlicedRun const triangles(as_tetrahedra(blocks), "wing", rule);
  auto const u = triangles.displacement();
  auto const nodes = nodes_of(blocks, 0);
  auto const expected = quadrilaterals.displacement(0);
  double apart = 0, largest = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    apart = std::max(apart, distance(u.at(Index(n)), expected[n]));
    largest = std::max(largest, norm(expected[n]));
  }
  EXPECT_GT(largest, 0.08);
  EXPECT_LT(apart, 1e-12);
}

TEST(TargetSlices, ScatteredTrianglesConvergeAtSecondOrder) {
  auto const error = [](int n) {
    SlicedRun const run(UnstructuredCase(scattered_wing(3 * n / 2 + 1, n / 4 + 1, 0.4)), "wing",
                        along_z(wing_sections(even_spans(40), 641, twisted)));
    EXPECT_LT(run.reach().max, 2e-5) << "what is off slides along the target";
    return run.error(twisted);
  };
  double const coarse = error(40), fine = error(80), finest = error(160);
  EXPECT_LT(finest, 1.5e-4);
  EXPECT_GT(coarse / fine, 3.5) << coarse << " " << fine;
  EXPECT_GT(fine / finest, 3.5) << fine << " " << finest;
}

TEST(TargetSlices, ScatteredTrianglesMovedToTheirOwnShapeStayButForTheirFacets) {
  SlicedRun const run(UnstructuredCase(scattered_wing(121, 21, 0.4)), "wing",
                      along_z(wing_sections(even_spans(40), 641, same_place)));
  EXPECT_LT(run.error(same_place), 5e-4);
  EXPECT_LT(run.reach().max, 2e-5);
}

TEST(TargetSlices, ATipGoesAlongWithItsRim) {
  Mesh mesh = scattered_wing(61, 11, 0.4);
  // A fan over the end of the span: faces that gain none, with a node of their own.
  Index32 const middle = Index32(mesh.n_nodes());
  std::vector<Index32> rim;
  for (Index32 i = 0; i < 60; ++i) rim.push_back(i + 60 * 10);
  Mesh capped;
  capped.source = mesh.source;
  capped.add_zone("wing", mesh.n_nodes() + 2);
  capped.coordinates = Coordinates(capped.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) capped.coordinates.set(n, mesh.coordinates[n]);
  Vec3 const tip = wing(0.03, 1) + 0.5 * (wing(0.5, 1) - wing(0.03, 1));
  capped.coordinates.set(middle, tip);
  capped.coordinates.set(middle + 1, tip + Vec3{0, 0, 0.2});
  for (Index e = 0; e < mesh.n_elements(); ++e) capped.add_element(mesh.elements.type[e], mesh.elements.nodes[e]);
  capped.patches = mesh.patches;
  for (std::size_t k = 0; k < rim.size(); ++k) {
    std::array const face{rim[k], rim[(k + 1) % rim.size()], middle};
    capped.add_element(ElementType::tetrahedron, std::array{face[0], face[1], face[2], middle + 1});
    capped.patches[0].faces.add(face);
  }
  SlicedRun const run(UnstructuredCase(std::move(capped)), "wing",
                      along_z(wing_sections(even_spans(20), 321, twisted)));
  auto const u = run.displacement();
  ASSERT_TRUE(u.contains(middle));
  EXPECT_LT(distance(tip + u.at(middle), twisted(tip)), 5e-3);
  EXPECT_NE(run.motion.notes().back().find("1 of 661 nodes are in no section"), std::string::npos)
      << run.motion.notes().back();
}

TEST(TargetSlices, TwoWingsAreRefused) {
  Mesh one = scattered_wing(61, 11, 0.4);
  Mesh two;
  two.source = "two wings";
  for (int w = 0; w < 2; ++w) two.add_zone("wing" + std::to_string(w), one.n_nodes());
  two.coordinates = Coordinates(two.n_nodes());
  for (Index n = 0; n < two.n_nodes(); ++n)
    two.coordinates.set(n, one.coordinates[n % one.n_nodes()] + Vec3{0, n < one.n_nodes() ? 0.0 : 5.0, 0});
  two.zones[0].n_elements = two.zones[1].n_elements = two.zones[1].first_element = one.n_elements();
  for (int w = 0; w < 2; ++w) {
    Patch wall = one.patches[0];
    wall.zone = w;
    wall.faces = {};
    std::vector<Index32> nodes;
    for (Index f = 0; f < one.patches[0].faces.size(); ++f) {
      nodes.clear();
      for (Index32 const n : one.patches[0].faces[f]) nodes.push_back(n + Index32(w * one.n_nodes()));
      wall.faces.add(nodes);
    }
    two.patches.push_back(wall);
    for (Index e = 0; e < one.n_elements(); ++e) {
      nodes.clear();
      for (Index32 const n : one.elements.nodes[e]) nodes.push_back(n + Index32(w * one.n_nodes()));
      two.elements.type.push_back(one.elements.type[e]);
      two.elements.nodes.add(nodes);
    }
  }
  UnstructuredCase const mesh(std::move(two));
  expect_all_in(message_of<MotionError>([&] {
                  SlicedRun(UnstructuredCase(mesh.mesh), "wing", along_z(wing_sections(even_spans(4), 81, twisted)));
                }),
                {"2 surfaces with sections", "one blade or wing"});
}

/// Rows of nodes of a blade of blocks, moved, as a target; and what quadrilaterals and triangles make of it.
struct BothWays {
  double largest = 0;  ///< displacement of the quadrilaterals
  double apart = 0;    ///< of the triangles from it
  double reach = 0;    ///< how far the nodes of the triangles ended from the target
};
BothWays both_ways(Mesh const& blocks, std::string const& family, Axis const& axis, Map const& map, int every = 1) {
  Boundary const of_blocks(blocks);
  PatchSurface const given(of_blocks, select_patches(blocks, {family}));
  JoinedSides const joined = join_sides(of_blocks, given, given.points.front());
  auto target = std::make_shared<TargetGeometry>();
  auto const radius = [&](Vec3 const& p) {
    return norm(cross(p - axis.origin, axis.direction)) / norm(axis.direction);
  };
  auto const rows = find_section_rows(joined.surface, radius, family).rows;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (k % std::size_t(every) != 0 && k + 1 < rows.size()) continue;
    TargetSection& section = target->sections.emplace_back();
    section.name = std::to_string(k);
    for (std::size_t n = 0; n + 1 < rows[k].size(); ++n)
      section.points.push_back(map(joined.surface.points[rows[k][n]]));
  }
  TargetRule rule;
  rule.target = target;
  rule.mapping = TargetRule::Mapping::sections;
  rule.flow = axis.direction;
  SlicedRun const triangles(as_tetrahedra(blocks), family, rule, axis);
  BoundaryMotion const quadrilaterals(blocks, resolve(blocks, SlicedRun::motion_of(family, rule, axis)));
  BothWays out;
  for (auto const& [n, u] : triangles.displacement()) {
    std::array<Vec3, 1> const at{blocks.coordinates[n]};
    std::array<Vec3, 1> expected;
    quadrilaterals.displacement(0, at, expected);
    out.largest = std::max(out.largest, norm(expected[0]));
    out.apart = std::max(out.apart, distance(u, expected[0]));
  }
  out.reach = triangles.reach().max;
  return out;
}

TEST(TargetSlices, ABladeBetweenCurvedWallsGoesWhereItsRowsGo) {
  for (int const nodes : {20'000, 80'000}) {
    PassageOptions options;
    options.nodes = nodes;
    Mesh const blocks = make_passage(options);
    BothWays const moved = both_ways(
        blocks, "blade", {}, [&](Vec3 const& p) { return p + passage_displacement(options, rotated_sections(), p); });
    EXPECT_GT(moved.largest, 0.01);
    EXPECT_LT(moved.apart, 1e-12);
    BothWays const still = both_ways(blocks, "blade", {}, same_place);
    EXPECT_EQ(still.largest, 0);
    EXPECT_EQ(still.apart, 0);
    EXPECT_EQ(still.reach, 0);
  }
}

TEST(TargetSlices, SidesAPitchApartGoWhereTheirRowsGo) {
  Mesh const blocks = cascade(cascade_pitch * 8 / (2 * std::numbers::pi));
  RigidTransform const turn = rotation_about({}, {1, 0, 0}, 0.05);
  BothWays const moved = both_ways(blocks, "blade", {}, turn);
  EXPECT_GT(moved.largest, 0.05);
  EXPECT_LT(moved.apart, 1e-12);
}

TEST(TargetSlices, BladesOfOthersGoWhereTheirRowsGo) {
  struct Blade {
    char const *mesh, *family;
    Axis axis;
  };
  for (Blade const& blade :
       {Blade{"axial_turbine_stage_H.cgns", "BLADE1", {}}, Blade{"axial_turbine_stage_H.cgns", "BLADE2", {}},
        Blade{"water_turbine.cgns", "BLADE_RU", {{}, {0, 0, 1}}},
        Blade{"axialTurbine_7blk.cgns", "BLADE_GV", {{}, {0, 0, 1}}}}) {
    std::string const path = shared_mesh(blade.mesh);
    if (path.empty()) continue;
    Mesh const blocks = read_mesh(path);
    RigidTransform const turn = rotation_about({}, blade.axis.direction, 0.02);
    BothWays const moved = both_ways(blocks, blade.family, blade.axis, turn);
    EXPECT_GT(moved.largest, 1e-3 * blocks.size()) << blade.family;
    EXPECT_LT(moved.apart, 1e-12 * blocks.size()) << blade.mesh << " " << blade.family;
    BothWays const still = both_ways(blocks, blade.family, blade.axis, same_place);
    EXPECT_LT(still.apart, 1e-12 * blocks.size()) << blade.mesh << " " << blade.family;
    EXPECT_LT(still.reach, 1e-12 * blocks.size()) << blade.mesh << " " << blade.family;
  }
}

}  // namespace
}  // namespace gridmorph::test
