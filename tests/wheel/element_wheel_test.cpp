// Wheels of passages of elements: the demo passage as hexahedra, against the wheel of its blocks, and as prisms and
// tetrahedra.
#include "support/cascade.hpp"
#include "support/expect_error.hpp"
#include "support/made_bodies.hpp"
#include "support/unstructured_meshes.hpp"
#include "unstructured/hybrid_file.hpp"
#include "wheel/element_wheel_file.hpp"
#include "wheel/wheel_run.hpp"

#include <generators/passage.hpp>
#include <gridmorph/mesh/block_elements.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <nlohmann/json.hpp>

namespace gridmorph::test {
namespace {

constexpr int n_blades = 8;
constexpr double pi = 3.14159265358979323846;

class ElementWheel : public WheelTest {
 protected:
  void SetUp() override {
    PassageOptions options;
    options.nodes = 10'000;
    options.blades = n_blades;
    // 8 blades need a small hub. On cylinders the blade's motion stays exactly on the end walls.
    options.hub = {0.09, 0.09, 0, 0};
    options.casing = {0.167, 0.167, 0, 0};
    blocks = make_passage(options);
    put("hexahedra", as_hexahedra(blocks));
  }
  /// A mesh and its case file in the folder.
  void put(std::string const& name, Mesh const& mesh) const {
    write_mesh(folder.file(name + ".cgns"), mesh);
    case_of(name, demo_rules);
  }
  /// Of elements as such; `blocks_found`: as the blocks found in them.
  void case_of(std::string const& name, std::string const& motion, bool blocks_found = false) const {
    folder.write(name + ".toml", "[mesh]\ninput = \"" + name + ".cgns\"\noutput = \"morphed.cgns\"\naxis = \"x\"\n" +
                                     (name == "blocks" || blocks_found ? "" : "blocks = \"off\"\n") + motion);
  }
  [[nodiscard]] Mesh morphed(std::string const& name) const {
    EXPECT_LE(gridmorph("morph " + name + ".toml"), 1) << text("err");  // 1: quality falls short of its limits
    return read_mesh(folder.file("morphed.cgns"));
  }
  [[nodiscard]] ElementWheelFile element_wheel(std::string const& case_file, std::string const& keys) const {
    folder.write("wheel.toml", text(case_file + ".toml") + "\n[wheel]\noutput = \"wheel.cgns\"\n" + keys);
    std::filesystem::remove(folder / "wheel.cgns");
    EXPECT_LE(gridmorph("wheel wheel.toml"), 1) << text("out") << text("err");
    return ElementWheelFile(folder.file("wheel.cgns"));
  }
  [[nodiscard]] double size() const { return blocks.size(); }

  static constexpr char const* three_blades = R"(sequence = ["A", "A", "A", "B", "A", "B", "B", "C"]
[[wheel.blade]]
name = "A"
[[wheel.blade]]
name = "B"
factor = 0.5
[[wheel.blade]]
name = "C"
[[wheel.blade.motion]]
patches = "blade"
rule    = "formula"
dr      = "0"
dtheta  = "-0.3 * axial"
)";
  Mesh blocks;
};

TEST_F(ElementWheel, WithoutMotionIsTheWheelOfTheBlocksBitForBit) {
  write_mesh(folder.file("blocks.cgns"), blocks);
  case_of("blocks", demo_rules);
  for (std::string const blades : {"factors = [0]\n", "factors = [0, -0.0]\n"}) {
    WheelFile const of_blocks = wheel("blocks.toml", blades);
    ElementWheelFile const of_elements = element_wheel("hexahedra", blades);
    EXPECT_EQ(distance_from(of_elements, 0, n_blades, blocks), 0);
    ASSERT_EQ(of_elements.zones.size(), of_blocks.zones.size());
    for (auto const& [name, zone] : of_blocks.zones) {
      EXPECT_EQ(zone.x, of_elements.zones.at(name).x) << name;
      EXPECT_EQ(zone.y, of_elements.zones.at(name).y) << name;
      EXPECT_EQ(zone.z, of_elements.zones.at(name).z) << name;
      EXPECT_EQ(zone.family_of_bc, of_elements.zones.at(name).family_of_bc) << name;
    }
    EXPECT_EQ(std::set(of_blocks.families.begin(), of_blocks.families.end()),
              std::set(of_elements.families.begin(), of_elements.families.end()));
  }
}

TEST_F(ElementWheel, OfEqualBladesIsTheMorphedPassageTurned) {
  ElementWheelFile const wheel = element_wheel("hexahedra", "");
  EXPECT_EQ(wheel.zones.size(), n_blades * blocks.zones.size());
  EXPECT_EQ(wheel.n_periodic(), 0);
  wheel.expect_same_bits();
  Mesh const one = morphed("hexahedra");
  for (int p = 0; p < n_blades; ++p) EXPECT_LT(distance_from(wheel, p, n_blades, one), 1e-14 * size()) << p;
}

/// Blades, inlet, outlet and periodic sides of different blades: what the rules say of them is the same whatever the
/// cells are.
TEST_F(ElementWheel, MovesBoundariesAsTheWheelOfTheBlocks) {
  write_mesh(folder.file("blocks.cgns"), blocks);
  case_of("blocks", demo_rules);
  WheelFile const of_blocks = wheel("blocks.toml", three_blades);
  ElementWheelFile const of_elements = element_wheel("hexahedra", three_blades);
  expect_same_boundaries(blocks, {"hub", "case"}, of_blocks, of_elements);
}

/// By default hexahedra are the blocks found in them, and all nodes are where those of the blocks of the file are.
TEST_F(ElementWheel, OfBlocksFoundInElementsIsTheWheelOfTheBlocks) {
  write_mesh(folder.file("blocks.cgns"), blocks);
  case_of("blocks", demo_rules);
  case_of("hexahedra", demo_rules, true);
  for (std::string const& keys : {std::string(three_blades), std::string("passages = 3\nfactors = [0.5]\n"),
                                  three_blades + std::string("[guard]\nsmooth = true\n")}) {
    WheelFile const of_blocks = wheel("blocks.toml", keys);
    ElementWheelFile const of_elements = element_wheel("hexahedra", keys);
    EXPECT_NE(text("out").find("blocks found in"), std::string::npos) << text("out");
    of_elements.expect_same_bits();
    EXPECT_EQ(of_elements.n_periodic(), of_blocks.n_periodic());
    FaceCount const faces = of_elements.count_faces();
    EXPECT_EQ(faces.open + faces.claimed, 0);
    expect_same_nodes(of_blocks, of_elements, 1e-9 * size());
  }
}

TEST_F(ElementWheel, OfDifferentBladesIsClosedFaceByFace) {
  ElementWheelFile const wheel = element_wheel("hexahedra", three_blades);
  EXPECT_EQ(wheel.n_periodic(), 0);
  wheel.expect_same_bits();
  FaceCount const faces = wheel.count_faces();
  Index patches = 0, joined = 0;
  Mesh const hexahedra = as_hexahedra(blocks);
  for (auto const& patch : hexahedra.patches) patches += patch.faces.size();
  UnstructuredTopology const topology = make_topology(hexahedra);
  joined = topology.boundary.size() - patches;
  EXPECT_EQ(faces.patches, n_blades * patches);
  EXPECT_EQ(faces.seams, n_blades * joined / 2);
  EXPECT_EQ(faces.open, 0);
  EXPECT_EQ(faces.ends, 0);
  EXPECT_EQ(faces.claimed, 0);
}

TEST_F(ElementWheel, InPartStaysPeriodicByTheAngleOfThePart) {
  std::string const blades =
      "sequence = [\"A\", \"B\", \"B\"]\n[[wheel.blade]]\nname = \"A\"\n[[wheel.blade]]\nname = \"B\"\nfactor = 0.2\n";
  ElementWheelFile const part = element_wheel("hexahedra", "passages = 3\n" + blades);
  EXPECT_EQ(part.zones.size(), 3 * blocks.zones.size());
  part.expect_same_bits();
  EXPECT_EQ(part.n_periodic(), 6);  // three zones on either side
  double worst = 0;
  for (auto const& c : part.connections) {
    if (!c.periodic) continue;
    EXPECT_NEAR(std::abs(c.angle[0]), 2 * pi * 3 / n_blades, 1e-6);
    Turn const turn(Axis{}, c.angle[0] > 0 ? 3 : -3, n_blades);
    for (std::size_t n = 0; n < c.nodes.size(); ++n)
      worst = std::max(worst, distance(turn(part.zones.at(c.zone).at(std::size_t(c.nodes[n] - 1))),
                                       part.zones.at(c.donor).at(std::size_t(c.donor_nodes[n] - 1))));
  }
  EXPECT_LT(worst, 2e-16);
  FaceCount const faces = part.count_faces();
  EXPECT_EQ(faces.open, 0);
  EXPECT_GT(faces.ends, 0);
  // A part is a mesh like any other: it is looked at, measured and morphed as it is, and made into the whole wheel
  // again.
  EXPECT_EQ(gridmorph("inspect wheel.cgns --json"), 0) << text("err");
  EXPECT_EQ(gridmorph("quality wheel.cgns"), 0) << text("err");
  std::filesystem::copy_file(folder / "wheel.cgns", folder / "part.cgns");
  case_of("part",
          "[[motion]]\npatches = \"blade\"\nrule = \"formula\"\ndtheta = \"0.02 * axial\"\n"
          "[[motion]]\npatches = [\"hub\", \"case\"]\nrule = \"slip\"\nsurface = \"revolution\"\n");
  Mesh const again = morphed("part");
  Index moved = 0;
  Mesh const before = read_mesh(folder.file("part.cgns"));
  for (Index n = 0; n < again.n_nodes(); ++n) moved += again.coordinates[n] == before.coordinates[n] ? 0 : 1;
  EXPECT_GT(moved, again.n_nodes() / 4);
}

/// An H mesh of one zone, its blade on the periodic sides, as blocks, hexahedra, prisms and tetrahedra, or hexahedra
/// and polyhedra.
class CascadeWheel : public ElementWheel {
 protected:
  void SetUp() override {
    blocks = cascade(cascade_pitch * n_blades / (2 * pi));
    put("hexahedra", as_hexahedra(blocks));
    write_mesh(folder.file("blocks.cgns"), blocks);
    Mesh mixed = to_prisms_and_tetrahedra(blocks, 4);
    for (auto const& face : blocks.interfaces) mixed.connections.push_back(node_pairs(blocks, face));
    put("mixed", mixed);
    put("polyhedra", with_joined_elements(as_hexahedra(blocks), 3));
    std::string gentle = demo_rules;
    gentle.replace(gentle.find("0.06 * sin(axial / 0.05) + 0.1 * axial"), 38, "0.04 * sin(2 * axial) + 0.01 * axial");
    gentle.replace(gentle.find("0.1 * (r - 0.12) * axial"), 24, "0.02 * (r - 1.2) * axial");
    for (std::string const kind : {"blocks", "hexahedra", "mixed", "polyhedra"}) case_of(kind, gentle);
  }
  static constexpr char const* blades = "factors = [1, 1, 1, 0.5, 1, 0.5, 0.5, -1]\n";
};

TEST_F(CascadeWheel, MovesBoundariesAsTheWheelOfTheBlocks) {
  WheelFile const of_blocks = wheel("blocks.toml", blades);
  for (std::string const kind : {"hexahedra", "mixed", "polyhedra"}) {
    ElementWheelFile const of_elements = element_wheel(kind, blades);
    expect_same_boundaries(blocks, {"hub", "case"}, of_blocks, of_elements);
  }
}

TEST_F(CascadeWheel, OfAnyElementsIsClosedFaceByFace) {
  for (std::string const kind : {"hexahedra", "mixed", "polyhedra"}) {
    ElementWheelFile const wheel = element_wheel(kind, blades);
    EXPECT_EQ(wheel.n_periodic(), 0);
    wheel.expect_same_bits();
    Mesh const passage = read_mesh(folder.file(kind + ".cgns"));
    Index patches = 0;
    for (auto const& patch : passage.patches) patches += patch.faces.size();
    FaceCount const faces = wheel.count_faces();
    EXPECT_EQ(faces.patches, n_blades * patches) << kind;
    EXPECT_EQ(faces.seams, n_blades * (make_topology(passage).boundary.size() - patches) / 2) << kind;
    EXPECT_EQ(faces.open, 0) << kind;
    EXPECT_EQ(faces.ends, 0) << kind;
    EXPECT_EQ(faces.claimed, 0) << kind;
    ElementWheelFile const equal = element_wheel(kind, "");
    Mesh const one = morphed(kind);
    for (int p = 0; p < n_blades; ++p)
      EXPECT_LT(distance_from(equal, p, n_blades, one), 1e-14 * size()) << kind << " " << p;
  }
}

/// As SU2 files have them: the sides are patches, and a rule names these.
TEST_F(CascadeWheel, HasPatchesOfItsSidesAtTheEndsOfAPartAlone) {
  Mesh passage = as_hexahedra(blocks);
  UnstructuredTopology const topology = make_topology(passage);
  std::set<Index32> lower, upper;
  for (auto const& c : passage.connections) {
    lower.insert(c.nodes.begin(), c.nodes.end());
    upper.insert(c.donor_nodes.begin(), c.donor_nodes.end());
  }
  for (auto const* side : {&lower, &upper}) {
    Patch patch;
    patch.name = side == &lower ? "lower_side" : "upper_side";
    patch.zone = 0;
    for (Index f = 0; f < topology.boundary.size(); ++f) {
      auto const face = topology.boundary.nodes[f];
      if (std::all_of(face.begin(), face.end(), [&](Index32 n) { return side->contains(n); })) patch.faces.add(face);
    }
    passage.patches.push_back(patch);
  }
  write_mesh(folder.file("sides.cgns"), passage);
  std::string by_patch = text("hexahedra.toml");
  by_patch.replace(by_patch.find("hexahedra.cgns"), 14, "sides.cgns");
  by_patch.replace(by_patch.find("\"type:periodic\""), 15, "[\"lower_side\", \"upper_side\"]");
  folder.write("sides.toml", by_patch);

  ElementWheelFile const whole = element_wheel("sides", blades), without = element_wheel("hexahedra", blades);
  for (auto const& [name, zone] : whole.zones)
    for (auto const& [bc, family] : zone.family_of_bc) EXPECT_EQ(bc.find("_side"), std::string::npos) << name;
  FaceCount const faces = whole.count_faces();
  EXPECT_EQ(faces.open + faces.claimed + faces.ends, 0);
  for (int p = 0; p < n_blades; ++p) EXPECT_EQ(distance_between(whole, p, without, p, n_blades), 0) << p;

  (void)element_wheel("sides", "passages = 3\n");
  Mesh const part = read_mesh(folder.file("wheel.cgns"));
  std::vector<std::string> sides;
  for (auto const& patch : part.patches)
    if (patch.name.ends_with("_side")) sides.push_back(part.zones[patch.zone].name + " " + patch.name);
  EXPECT_EQ(sides, (std::vector<std::string>{"passage_P01 lower_side", "passage_P03 upper_side"}));
}

TEST_F(ElementWheel, OfBlocksBesideElementsIsTheWheelOfElements) {
  std::set<std::string> some;
  for (std::size_t z = 0; z < blocks.zones.size(); z += 2) some.insert(blocks.zones[z].name);
  HybridFile(folder.file("hybrid.cgns"), blocks, as_hexahedra(blocks), some);
  case_of("hybrid", demo_rules);
  ElementWheelFile const hybrid = element_wheel("hybrid", three_blades),
                         plain = element_wheel("hexahedra", three_blades);
  hybrid.expect_same_bits();
  FaceCount const faces = hybrid.count_faces();
  EXPECT_EQ(faces.open + faces.ends + faces.claimed, 0);
  for (int p = 0; p < n_blades; ++p) EXPECT_LT(distance_between(hybrid, p, plain, p, n_blades), 1e-12 * size()) << p;
}

/// Edges have a node amid them, and connections pair these as all others.
TEST_F(CascadeWheel, OfSecondOrderElementsHasTheSameBitsAmidEdges) {
  Mesh mesh = second_order(to_prisms_and_tetrahedra(blocks, 4));
  mesh.zones[0].name = "passage";
  mesh.families = blocks.families;
  Connection c;
  c.name = "sides";
  c.zone = c.donor_zone = 0;
  c.periodic = blocks.interfaces.front().periodic;
  std::vector<Index32> all(mesh.n_nodes());
  std::iota(all.begin(), all.end(), Index32(0));
  auto const partner = match_points(mesh.coordinates, all, all, 1e-9, c.periodic);
  Index amid = 0;
  for (std::size_t n = 0; n < all.size(); ++n)
    if (partner[n] >= 0) {
      c.nodes.push_back(all[n]);
      c.donor_nodes.push_back(partner[n]);
      amid += Index(n) >= blocks.n_nodes() ? 1 : 0;
    }
  ASSERT_GT(amid, 100);
  mesh.connections.push_back(c);
  // Amid an edge that is straight the sides follow a curved blade, and the blade goes first.
  std::string ranked = text("mixed.toml");
  auto const follow = ranked.find("rule    = \"follow\"");
  folder.write("mixed.toml", ranked.insert(follow, "rank = 1\n"));
  write_mesh(folder.file("mixed.cgns"), mesh);
  ElementWheelFile const wheel = element_wheel("mixed", blades);
  EXPECT_EQ(wheel.n_periodic(), 0);
  wheel.expect_same_bits();
  FaceCount const faces = wheel.count_faces();
  EXPECT_EQ(faces.open + faces.ends + faces.claimed, 0);
}

TEST_F(ElementWheel, TurnsWithItsSequence) {
  ElementWheelFile const wheel = element_wheel("hexahedra", three_blades);
  std::string shifted = three_blades;
  shifted.replace(0, shifted.find(']') + 1, R"(sequence = ["A", "A", "B", "A", "B", "B", "C", "A"])");
  ElementWheelFile const other = element_wheel("hexahedra", shifted);
  for (int p = 0; p < n_blades; ++p)
    EXPECT_LT(distance_between(wheel, (p + 1) % n_blades, other, p, n_blades), 1e-14 * size()) << p;
}

TEST_F(ElementWheel, WithItsSidesKnownForEqualBladesIsTheSame) {
  ElementWheelFile const closed = element_wheel("hexahedra", "factors = [0.5]\n");
  ElementWheelFile const opened = element_wheel("hexahedra", "factors = [0.5, 0.5000000000000001]\n");
  for (int p = 0; p < n_blades; ++p) EXPECT_LT(distance_between(opened, p, closed, p, n_blades), 1e-9 * size()) << p;
}

TEST_F(ElementWheel, IsTheSameBitsOnOneThread) {
  ElementWheelFile const two = element_wheel("hexahedra", three_blades);
  EXPECT_EQ(gridmorph("--threads 1 wheel wheel.toml"), 0);
  ElementWheelFile const one(folder.file("wheel.cgns"));
  for (auto const& [zone, values] : two.zones) {
    EXPECT_EQ(values.x, one.zones.at(zone).x);
    EXPECT_EQ(values.y, one.zones.at(zone).y);
    EXPECT_EQ(values.z, one.zones.at(zone).z);
  }
}

TEST_F(ElementWheel, IsMeasuredAndCertifiedPassageByPassage) {
  (void)element_wheel("hexahedra", std::string(three_blades) + "[output]\nreport = \"report.json\"\n");
  auto const json = nlohmann::json::parse(text("report.json"));
  EXPECT_EQ(json["rows"][0]["passages_of_wheel"], n_blades);
  ASSERT_EQ(json["passages"].size(), std::size_t(n_blades));
  EXPECT_EQ(json["passages"][7]["blades"][0], "C");
  EXPECT_EQ(json["certificate"]["cells"], n_blades * blocks.n_cells());
  EXPECT_TRUE(json["certificate"]["holds"]);
  expect_all_in(text("out"), {"8 of 8 passages", "certificate: the Jacobian of ", "wrote wheel.cgns"});
}

TEST_F(ElementWheel, OfDifferentBladesNeedsARuleForItsSides) {
  std::string free = demo_rules;
  auto const begin = free.find("[[motion]]\npatches = \"type:periodic\""), end = free.find("[[motion]]", begin + 1);
  free.erase(begin, end - begin);
  case_of("hexahedra", free);
  expect_all_in(refusal(text("hexahedra.toml"), three_blades), {"between passages with different blades", "follow"});
  element_wheel("hexahedra", "factors = [0.2]\n").expect_same_bits();  // equal blades need none
}

TEST_F(ElementWheel, CanNameFamiliesByPassage) {
  ElementWheelFile const suffixed = element_wheel("hexahedra", "families = \"suffixed\"\n");
  EXPECT_EQ(suffixed.families.size(), n_blades * blocks.families.size());
  for (auto const& [name, zone] : suffixed.zones)
    for (auto const& [bc, family] : zone.family_of_bc)
      EXPECT_EQ(family.substr(family.size() - 4), name.substr(name.size() - 4));
}

}  // namespace
}  // namespace gridmorph::test
