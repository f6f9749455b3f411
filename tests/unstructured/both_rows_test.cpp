// Blade rows as blocks and as hexahedra: rules about sections find the same blades in both, and give the same
// displacements.
#include "support/cascade.hpp"
#include "support/unstructured_case.hpp"
#include "support/unstructured_meshes.hpp"

#include "../io/io_support.hpp"

#include <generators/passage.hpp>
#include <generators/passage_motion.hpp>
#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/case/case_file.hpp>
#include <gridmorph/geometry/rotation.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/motion/boundary_motion.hpp>
#include <gridmorph/motion/target/section_rows.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace gridmorph::test {
namespace {

/// A mesh of blocks, and rules for it.
struct Row {
  Mesh blocks;
  Motion motion;
  PlanOptions plan;
};

Row of_example(std::string const& case_file, std::string const& mesh) {
  std::string const path = shared_mesh(mesh);
  if (path.empty()) return {};
  CaseFile const file = read_case_file(std::string(GRIDMORPH_EXAMPLES "/") + case_file);
  PlanOptions options;  // the blocks' own say how far the near field goes in layers
  options.boundary_layers = file.plan.boundary_layers;
  return {read_mesh(path), file.motion, options};
}

Row passage(bool sections) {
  PassageOptions options;
  options.nodes = 20'000;
  Row row{make_passage(options), {}, {}};
  if (sections) {
    SectionsRule rule;
    rule.chord = {{{0.15, -0.1}, {0.5, 0.1}, {0.9, -0.1}}};
    rule.twist_rad = {{{0, 0.05}, {1, -0.1}}};
    row.motion.rules = {{{"blade"}, rule, 0, "blade"}};
  } else {
    row.motion.rules = {
        {{"blade"},
         FunctionRule{"turned sections",
                      [options, motion = rotated_sections()](std::span<Vec3 const> points, std::span<Vec3> out) {
                        std::transform(points.begin(), points.end(), out.begin(),
                                       [&](Vec3 const& p) { return passage_displacement(options, motion, p); });
                      }},
         0,
         "blade"}};
  }
  row.motion.rules.push_back({{"inlet", "outlet"}, CircumferentialSlideRule{{"blade"}}, 0, "ends"});
  row.motion.rules.push_back({{"type:periodic"}, FollowRule{{"blade"}}, 0, "periodics"});
  row.motion.rules.push_back({{"hub", "case"}, SlipRule{.surface = SlipRule::Surface::revolution}, 0, "walls"});
  return row;
}

Row linear_cascade() {
  Row row{cascade(), {}, {}};
  SectionsRule rule;
  rule.stagger_rad = {{{0, 0.05}, {1, -0.1}}};
  rule.lean = {{{0, 0}, {0.5, 0.03}, {1, 0.01}}};
  row.motion.rules = {{{"blade"}, rule, 0, "blade"},
                      {{"inlet", "outlet"}, CircumferentialSlideRule{{"blade"}}, 0, "ends"},
                      {{"type:periodic"}, FollowRule{{"blade"}}, 0, "sides"},
                      {{"hub", "case"}, SlipRule{.surface = SlipRule::Surface::plane}, 0, "walls"}};
  return row;
}

struct Named {
  std::string name;
  double least_determinant;  ///< that the morphed hexahedra have
  Row (*make)();
};
void PrintTo(Named const& n, std::ostream* out) { *out << n.name; }

class BothRows : public testing::TestWithParam<Named> {
 protected:
  void SetUp() override {
    row_ = GetParam().make();
    if (row_.blocks.zones.empty()) GTEST_SKIP() << "its mesh is not there; a stand-in is tested";
  }
  Row row_;
};
INSTANTIATE_TEST_SUITE_P(
    Meshes, BothRows,
    testing::Values(
        Named{"stage_redesign", 0.27, [] { return of_example("stage_redesign.toml", "axial_turbine_stage_H.cgns"); }},
        Named{"turbine_stage", 0.45, [] { return of_example("turbine_stage.toml", "axial_turbine_stage_H.cgns"); }},
        Named{"kaplan_redesign", 0.4, [] { return of_example("kaplan_redesign.toml", "axialTurbine_7blk.cgns"); }},
        Named{"kaplan_7_blocks", 0.32, [] { return of_example("kaplan_7_blocks.toml", "axialTurbine_7blk.cgns"); }},
        Named{"kaplan_stand_in", 0.45, [] { return of_example("kaplan_redesign.toml", "water_turbine.cgns"); }},
        Named{"passage", 0.5, [] { return passage(false); }}, Named{"linear_cascade", 0.3, linear_cascade},
        Named{"wing_redesign", 0.1, [] { return of_example("wing_redesign.toml", "mdo_tutorial_000_vol.cgns"); }},
        Named{"passage_sections", 0.5, [] { return passage(true); }}),
    [](auto const& info) { return info.param.name; });

/// Displacements that each rule of the motion gives to the nodes of its patches and periodic connections, as numbers of
/// nodes.
std::vector<std::map<Index, Vec3>> displacements(Boundary const& boundary, BoundaryMotion const& motion,
                                                 std::size_t n_rules) {
  ResolvedMotion const& resolved = motion.motion();
  std::vector<std::set<Index>> nodes(n_rules);
  for (std::size_t p = 0; p < resolved.patch.size(); ++p)
    if (auto const r = std::size_t(resolved.patch[p].rule); r < n_rules) {
      auto const& own = boundary.surface(int(p)).nodes;
      nodes[r].insert(own.begin(), own.end());
    }
  for (AnyConnection const& c : boundary.connections())
    if (int const r = resolved.interface[c.number].rule; c.periodic && r >= 0 && r < int(n_rules))
      for (auto const& [own, donor] : boundary.pairs(c.number)) nodes[r].insert(own);
  std::vector<std::map<Index, Vec3>> out(n_rules);
  for (std::size_t r = 0; r < n_rules; ++r) {
    if (!motion.is_explicit(int(r))) continue;
    std::vector<Vec3> points, u(nodes[r].size());
    for (Index const n : nodes[r]) points.push_back(boundary.coordinates()[n]);
    motion.displacement(int(r), points, u);
    std::size_t at = 0;
    for (Index const n : nodes[r]) out[r][n] = u[at++];
  }
  return out;
}

TEST_P(BothRows, RulesGiveTheSameDisplacements) {
  UnstructuredCase const hexahedra(as_hexahedra(row_.blocks));
  Boundary const of_blocks(row_.blocks);
  auto const of_elements = std::make_shared<Boundary const>(hexahedra.mesh, hexahedra.topology, hexahedra.face_patches);
  BoundaryMotion const blocks(row_.blocks, resolve(row_.blocks, row_.motion));
  BoundaryMotion const elements(of_elements, resolve(hexahedra.mesh, row_.motion));
  auto const a = displacements(of_blocks, blocks, row_.motion.rules.size());
  auto const b = displacements(*of_elements, elements, row_.motion.rules.size());
  double largest = 0, apart = 0;
  std::size_t compared = 0;
  for (std::size_t r = 0; r < a.size(); ++r) {
    ASSERT_EQ(a[r].size(), b[r].size()) << r;
    for (auto const& [n, u] : a[r]) {
      largest = std::max(largest, norm(u));
      apart = std::max(apart, distance(u, b[r].at(n)));
      ++compared;
    }
  }
  EXPECT_GT(compared, 500u);
  EXPECT_GT(largest, 0);
  EXPECT_LT(apart, 1e-12 * largest);
}

/// Own nodes of a connection onto the donor's.
RigidTransform fit_of(Coordinates const& x, Connection const& c) {
  std::vector<Vec3> from, to;
  for (std::size_t n = 0; n < c.nodes.size(); ++n) {
    from.push_back(x[c.nodes[n]]);
    to.push_back(x[c.donor_nodes[n]]);
  }
  return fit_rigid_transform(from, to);
}

/// Distance of the nodes of patches that slip from their surfaces: the change from the baseline, at most.
double off_walls(UnstructuredCase const& c, UnstructuredMorphed const& m) {
  double worst = 0;
  BoundaryMotion const& motion = *m.prepared.boundary.motion;
  for (std::size_t p = 0; p < c.mesh.patches.size(); ++p)
    if (SlipSurface const* surface = motion.slip_surface(int(p)))
      for (Index const n : motion.boundary().surface(int(p)).nodes) {
        auto const off = [&](Vec3 const& x) { return distance(x, surface->view().project(x)); };
        worst = std::max(worst, std::abs(off(m.x[n]) - off(c.mesh.coordinates[n])));
      }
  return worst;
}

TEST_P(BothRows, HexahedraMorphWithTheirRow) {
  UnstructuredCase const hexahedra(as_hexahedra(row_.blocks));
  UnstructuredMorphed const morphed = hexahedra.guarded_morph(row_.motion, row_.plan);
  EXPECT_EQ(hexahedra.largest_miss(morphed), 0);
  EXPECT_EQ(hexahedra.inverted(morphed.x), 0);
  double const size = hexahedra.mesh.size();
  EXPECT_LT(off_walls(hexahedra, morphed), 1e-10 * size);
  EXPECT_GT(hexahedra.quality(morphed.x)[Measure::determinant_3x3x3].min, GetParam().least_determinant);
  // Both sides of every periodic connection have moved alike.
  double apart = 0, before = 0;
  for (auto const& c : hexahedra.mesh.connections) {
    RigidTransform const there = c.periodic ? fit_of(hexahedra.mesh.coordinates, c) : RigidTransform{};
    for (std::size_t n = 0; n < c.nodes.size(); ++n) {
      before = std::max(before, distance(there(hexahedra.mesh.coordinates[c.nodes[n]]),
                                         hexahedra.mesh.coordinates[c.donor_nodes[n]]));
      Vec3 const own = morphed.x[c.nodes[n]] - hexahedra.mesh.coordinates[c.nodes[n]];
      Vec3 const other = morphed.x[c.donor_nodes[n]] - hexahedra.mesh.coordinates[c.donor_nodes[n]];
      apart = std::max(apart, distance(there.rotation * own, other));
    }
  }
  // The formulas of the two sides of its blades are 72 degrees apart, the sides of the mesh to ten digits.
  double const alike = GetParam().name == "kaplan_7_blocks" ? 1e-10 : 1e-12;
  EXPECT_LT(apart, alike * size + 2 * before);
}

TEST_P(BothRows, ABladeThatDoesNotMoveMovesNothing) {
  UnstructuredCase const hexahedra(as_hexahedra(row_.blocks));
  Motion still = row_.motion;
  for (MotionRule& rule : still.rules) {
    if (std::holds_alternative<SectionsRule>(rule.rule)) rule.rule = SectionsRule{};
    if (auto* function = std::get_if<FunctionRule>(&rule.rule))
      function->function = [](std::span<Vec3 const>, std::span<Vec3> out) {
        std::fill(out.begin(), out.end(), Vec3{});
      };
  }
  UnstructuredMorphed const morphed = hexahedra.morph(still, row_.plan);
  for (Index n = 0; n < hexahedra.mesh.n_nodes(); ++n) ASSERT_EQ(morphed.x[n], hexahedra.mesh.coordinates[n]) << n;
}

// Faces cut into triangles have no grid lines: sections are cut from facets, and off by what a facet is off the blade.
TEST_P(BothRows, FacetsGiveNearlyTheSameDisplacements) {
  Mesh split = to_prisms_and_tetrahedra(row_.blocks, 0);
  split.connections = as_hexahedra(row_.blocks).connections;
  UnstructuredCase const tetrahedra(std::move(split));
  Boundary const of_blocks(row_.blocks);
  auto const of_elements =
      std::make_shared<Boundary const>(tetrahedra.mesh, tetrahedra.topology, tetrahedra.face_patches);
  BoundaryMotion const blocks(row_.blocks, resolve(row_.blocks, row_.motion));
  BoundaryMotion const elements(of_elements, resolve(tetrahedra.mesh, row_.motion));
  auto const a = displacements(of_blocks, blocks, row_.motion.rules.size());
  auto const b = displacements(*of_elements, elements, row_.motion.rules.size());
  for (std::size_t r = 0; r < a.size(); ++r) {
    ASSERT_EQ(a[r].size(), b[r].size()) << r;
    double largest = 0, apart = 0;
    for (auto const& [n, u] : a[r]) {
      largest = std::max(largest, norm(u));
      apart = std::max(apart, distance(u, b[r].at(n)));
    }
    EXPECT_LE(apart, 0.02 * largest) << r;
  }
}

// The blade turns about the axis: inlet, outlet and periodic sides turn with it, as hexahedra and as tetrahedra.
TEST(BothRows, TurnAsAWholeWithTheirBlade) {
  Row row = passage(false);
  RigidTransform const turn = rotation_about({0, 0, 0}, {1, 0, 0}, 0.1);
  row.motion.rules[0].rule = FunctionRule{"turn", [turn](std::span<Vec3 const> points, std::span<Vec3> out) {
                                            for (std::size_t n = 0; n < points.size(); ++n)
                                              out[n] = turn(points[n]) - points[n];
                                          }};
  Mesh split = to_prisms_and_tetrahedra(row.blocks, 0);
  split.connections = as_hexahedra(row.blocks).connections;
  for (Mesh const& mesh : {as_hexahedra(row.blocks), split}) {
    UnstructuredCase const c(mesh);
    auto const boundary = std::make_shared<Boundary const>(c.mesh, c.topology, c.face_patches);
    BoundaryMotion const motion(boundary, resolve(c.mesh, row.motion));
    auto const all = displacements(*boundary, motion, row.motion.rules.size());
    double worst = 0;
    std::size_t compared = 0;
    for (std::size_t r = 0; r < 3; ++r)
      for (auto const& [n, u] : all[r]) {
        Vec3 const p = c.mesh.coordinates[n];
        worst = std::max(worst, distance(u, turn(p) - p));
        ++compared;
      }
    EXPECT_GT(compared, 1000u);
    EXPECT_LT(worst, 1e-13);
  }
}

/// A mesh of hexahedra with all its zones in one, coincident nodes one node, the patches of a family one patch: as
/// programs for unstructured meshes store what was made of blocks. `number`: per node of the mesh its node there.
Mesh in_one_zone(Mesh const& mesh, std::vector<Index32>& number) {
  Mesh out;
  out.source = mesh.source + " in one zone";
  PointNumbers places(1e-9 * mesh.size());
  std::vector<Vec3> points;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    number.push_back(Index32(places.find_or_add(mesh.coordinates[n], int(points.size()))));
    if (number.back() == Index32(points.size())) points.push_back(mesh.coordinates[n]);
  }
  out.add_zone("all", Index(points.size()));
  out.coordinates = Coordinates(Index(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n) out.coordinates.set(Index(n), points[n]);
  std::vector<Index32> corners;
  auto const renumbered = [&](auto const& nodes) {
    corners.clear();
    for (Index32 const n : nodes) corners.push_back(number[n]);
    return std::span<Index32 const>(corners);
  };
  for (Index e = 0; e < mesh.elements.size(); ++e)
    out.add_element(ElementType::hexahedron, renumbered(mesh.elements.corners(e)));
  std::map<std::string, int> families;
  for (Patch const& patch : mesh.patches) {
    std::string const& family = patch.families.front();
    auto const [at, fresh] = families.try_emplace(family, int(out.patches.size()));
    if (fresh) {
      out.patches.push_back({family, patch.bc_type, patch.kind, {family}, 0, {}, {}, {}});
    }
    for (Index f = 0; f < patch.faces.size(); ++f) out.patches[at->second].faces.add(renumbered(patch.faces[f]));
  }
  for (Connection const& c : mesh.connections) {
    if (!c.periodic) continue;
    Connection own = c;
    own.zone = own.donor_zone = 0;
    for (auto* list : {&own.nodes, &own.donor_nodes})
      for (Index32& n : *list) n = number[n];
    out.connections.push_back(std::move(own));
  }
  return out;
}

TEST(BothRows, AreTheSameInOneZone) {
  for (bool const sections : {false, true}) {
    Row const row = passage(sections);
    Mesh const hexahedra = as_hexahedra(row.blocks);
    std::vector<Index32> number;
    UnstructuredCase const one(in_one_zone(hexahedra, number));
    Boundary const of_blocks(row.blocks);
    auto const of_one = std::make_shared<Boundary const>(one.mesh, one.topology, one.face_patches);
    auto const a =
        displacements(of_blocks, BoundaryMotion(row.blocks, resolve(row.blocks, row.motion)), row.motion.rules.size());
    BoundaryMotion const motion(of_one, resolve(one.mesh, row.motion));
    auto const b = displacements(*of_one, motion, row.motion.rules.size());
    for (std::size_t r = 0; r < a.size(); ++r) {
      double largest = 0, apart = 0;
      for (auto const& [n, u] : a[r]) {
        largest = std::max(largest, norm(u));
        apart = std::max(apart, distance(u, b[r].at(number[n])));
      }
      EXPECT_LE(apart, 1e-12 * largest) << r;
    }
  }
}

// Sections of the blade as it shall be: its rows of nodes, moved. Nodes go where they went, in both kinds of mesh.
TEST(BothRows, GoToTheSectionsOfATarget) {
  PassageOptions options;
  options.nodes = 20'000;
  Mesh const blocks = make_passage(options);
  Boundary const of_blocks(blocks);
  PatchSurface const surface(of_blocks, select_patches(blocks, {"blade"}));
  auto target = std::make_shared<TargetGeometry>();
  auto const radius = [](Vec3 const& p) { return std::hypot(p.y, p.z); };
  for (auto const& row : find_section_rows(surface, radius, "blade").rows) {
    TargetSection& section = target->sections.emplace_back();
    section.name = std::to_string(target->sections.size());
    for (std::size_t n = 0; n + 1 < row.size(); ++n) {
      Vec3 const p = surface.points[row[n]];
      section.points.push_back(p + passage_displacement(options, rotated_sections(), p));
    }
  }
  TargetRule rule;
  rule.target = target;
  rule.mapping = TargetRule::Mapping::sections;
  Motion motion;
  motion.rules = {{{"blade"}, rule, 0, "blade"}};
  UnstructuredCase const hexahedra(as_hexahedra(blocks));
  auto const of_elements = std::make_shared<Boundary const>(hexahedra.mesh, hexahedra.topology, hexahedra.face_patches);
  auto const a = displacements(of_blocks, BoundaryMotion(blocks, resolve(blocks, motion)), 1);
  auto const b = displacements(*of_elements, BoundaryMotion(of_elements, resolve(hexahedra.mesh, motion)), 1);
  ASSERT_EQ(a[0].size(), b[0].size());
  double largest = 0, apart = 0, off = 0;
  for (auto const& [n, u] : a[0]) {
    largest = std::max(largest, norm(u));
    apart = std::max(apart, distance(u, b[0].at(n)));
    off = std::max(off, distance(u, passage_displacement(options, rotated_sections(), blocks.coordinates[n])));
  }
  EXPECT_LT(apart, 1e-12 * largest);
  // Equal shares of arc length: nodes slide a little along sections that have changed their length.
  EXPECT_LT(off, 0.05 * largest);
}

}  // namespace
}  // namespace gridmorph::test
