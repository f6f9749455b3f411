// Straight rows: passages whose periodic sides are a translation apart, of blocks, of hexahedra and of plane elements.
#include "support/cascade.hpp"
#include "support/expect_error.hpp"
#include "support/unstructured_meshes.hpp"
#include "wheel/element_wheel_file.hpp"
#include "wheel/wheel_run.hpp"

#include <gridmorph/boundary/coverage.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/repeated_elements.hpp>
#include <gridmorph/wheel/rows.hpp>

namespace gridmorph::test {
namespace {

constexpr int n_blades = 5;
constexpr char const* five = "passages = 5\n";
constexpr char const* three_blades = R"keys(passages = 5
sequence = ["A", "A", "B", "C", "B"]
[[wheel.blade]]
name = "A"
[[wheel.blade]]
name = "B"
factor = -0.5
[[wheel.blade]]
name = "C"
[[wheel.blade.motion]]
patches = "blade"
rule    = "formula"
dx      = "0.02 * x"
dz      = "-0.1 * (x - 0.4)"
)keys";
/// The formulas of A, B and C above.
std::array<std::string, 3> const formulas{"dx = \"-0.03 * y * x\"\ndz = \"0.12 * (x - 0.3)\"\n",
                                          "dx = \"0.015 * y * x\"\ndz = \"-0.06 * (x - 0.3)\"\n",
                                          "dx = \"0.02 * x\"\ndz = \"-0.1 * (x - 0.4)\"\n"};
constexpr std::array<int, n_blades> blade_in{0, 0, 1, 2, 1};

class StraightRow : public WheelTest {
 protected:
  void SetUp() override {
    mesh = cascade();
    write_mesh(folder.file("passage.cgns"), mesh);
    write_mesh(folder.file("hexahedra.cgns"), as_hexahedra(mesh));
    folder.write("passage.toml", case_of("passage.cgns", formulas[0]));
  }
  [[nodiscard]] static std::string case_of(std::string const& input, std::string const& formula) {
    return "[mesh]\ninput = \"" + input + "\"\noutput = \"morphed.cgns\"\naxis = \"x\"\n" +
           "[[motion]]\npatches = \"blade\"\nrule = \"formula\"\n" + formula + row_followers +
           R"(
[[motion]]
patches = ["hub", "case"]
rule    = "slip"
surface = "plane"
)";
  }
  [[nodiscard]] Mesh morphed(std::string const& formula) const {
    folder.write("one.toml", case_of("passage.cgns", formula));
    EXPECT_EQ(gridmorph("morph one.toml"), 0) << text("err");
    return read_mesh(folder.file("morphed.cgns"));
  }
  [[nodiscard]] ElementWheelFile of_elements(std::string const& input, std::string const& keys) const {
    folder.write("wheel.toml", case_of(input, formulas[0]) + "[wheel]\noutput = \"wheel.cgns\"\n" + keys);
    EXPECT_LE(gridmorph("wheel wheel.toml"), 1) << text("out") << text("err");
    return ElementWheelFile(folder.file("wheel.cgns"));
  }
  /// A node of passage p, shifted back.
  template <class File>
  static Vec3 at(File const& wheel, int p, Index n) {
    return wheel.zones.at(name("passage", p)).at(n) - Vec3{0, 0, p * cascade_pitch};
  }
  template <class Visit>
  void for_nodes(std::string const& family, Visit&& visit) const {
    Zone const& zone = mesh.zones.front();
    for (auto const& patch : mesh.patches) {
      if (patch.families.front() != family) continue;
      for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
        for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
          for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) visit(zone.node({i, j, k}), k);
    }
  }
  [[nodiscard]] double size() const { return mesh.size(); }
  [[nodiscard]] int last_k() const { return mesh.zones.front().extent[2] - 1; }

  Mesh mesh;
};

TEST_F(StraightRow, OfEqualBladesIsTheMorphedPassageShifted) {
  WheelFile const row = wheel("passage.toml", five);
  EXPECT_EQ(row.zones.size(), std::size_t(n_blades));
  row.expect_watertight();
  Mesh const one = morphed(formulas[0]);
  double worst = 0;
  for (int p = 0; p < n_blades; ++p)
    for (Index n = 0; n < mesh.n_nodes(); ++n) worst = std::max(worst, distance(at(row, p, n), one.coordinates[n]));
  EXPECT_LT(worst, 1e-14 * size());
}

TEST_F(StraightRow, HasItsEndsPeriodicByAllPitches) {
  for (int const passages : {1, 3}) {
    WheelFile const row = wheel("passage.toml", "passages = " + std::to_string(passages) + "\n");
    EXPECT_EQ(row.n_periodic(),
              4);  // before and behind the blade, from both sides
    for (auto const& c : row.connections) {
      if (!c.periodic) continue;
      EXPECT_EQ(c.angle, (std::array<float, 3>{}));
      EXPECT_EQ(c.translation[0], 0);
      EXPECT_EQ(c.translation[1], 0);
      EXPECT_NEAR(std::abs(c.translation[2]), passages * cascade_pitch, 1e-6);
    }
    // The ends as a reader finds them: node by node, to the tolerance of every other mesh.
    Mesh whole = read_mesh(folder.file("wheel.cgns"));
    auto const links = passage_links(whole, connect_and_check(whole, {}), {});
    for (auto const& link : links.all) EXPECT_LT(link.mismatch, 1e-14 * size());
    WheelRows const rows = find_rows(whole, links, Axis{});
    ASSERT_EQ(rows.rows.size(), 1U);
    EXPECT_TRUE(rows.rows.front().pitch.is_straight());
    EXPECT_LT(distance(rows.rows.front().pitch.shift(), {0, 0, passages * cascade_pitch}), 1e-13);
  }
}

TEST_F(StraightRow, HasOnEveryBladeItsOwnMotion) {
  WheelFile const row = wheel("passage.toml", three_blades);
  row.expect_watertight();
  EXPECT_EQ(row.n_periodic(), 4);
  double worst = 0, apart = 0;
  for (int b = 0; b < 3; ++b) {
    Mesh const one = morphed(formulas[b]);
    for (int p = 0; p < n_blades; ++p)
      for_nodes("blade", [&](Index n, int k) {
        int const stands = blade_in[(p + (k == 0 ? 0 : 1)) % n_blades];
        double const gap = distance(at(row, p, n), one.coordinates[n]);
        (stands == b ? worst : apart) = std::max(stands == b ? worst : apart, gap);
      });
  }
  EXPECT_LT(worst, 1e-13 * size());
  EXPECT_GT(apart, 1e-2 * size());
}

/// Blades that move along the pitch as a whole: between them every node moves by the share that its place along the
/// pitch gives.
TEST_F(StraightRow, SharesLinearlyAlongThePitch) {
  folder.write("shift.toml", case_of("passage.cgns", "dx = \"0.04\"\ndz = \"0.1\"\n"));
  std::array<double, n_blades> const factor{1, 0, -0.5, 0.25, 1};
  WheelFile const row = wheel("shift.toml", "passages = 5\nfactors = [1, 0, -0.5, 0.25, 1]\n");
  row.expect_watertight();
  Zone const& zone = mesh.zones.front();
  double worst = 0;
  for (int p = 0; p < n_blades; ++p)
    for (std::string const family : {"inlet", "outlet"})
      for_nodes(family, [&](Index n, int k) {
        Index3 const ijk{family == "inlet" ? 0 : zone.extent[0] - 1, int(n / zone.extent[0]) % zone.extent[1], 0};
        double const w = (mesh.coordinates[n].z - mesh.coordinates[zone.node(ijk)].z) / cascade_pitch;
        double const share = (1 - w) * factor[p] + w * factor[(p + 1) % n_blades];
        EXPECT_TRUE(k != 0 || w == 0);
        worst = std::max(worst, distance(at(row, p, n), mesh.coordinates[n] + Vec3{0, 0, 0.1 * share}));
      });
  EXPECT_LT(worst, 1e-12 * size());
}

TEST_F(StraightRow, ShiftsWithItsSequence) {
  WheelFile const row = wheel("passage.toml", three_blades);
  std::string shifted = three_blades;
  shifted.replace(0, shifted.find(']') + 1, R"(passages = 5
sequence = ["A", "B", "C", "B", "A"])");
  WheelFile const other = wheel("passage.toml", shifted);
  double worst = 0;
  for (int p = 0; p < n_blades; ++p)
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      worst = std::max(worst, distance(at(row, (p + 1) % n_blades, n), at(other, p, n)));
  EXPECT_LT(worst, 1e-14 * size());
}

TEST_F(StraightRow, MovesInWavesOfAnyNumberOfItsBlades) {
  std::string const moving = case_of("passage.cgns", "dz = \"0.05 * cos(2 * pi * t) * (1 + x)\"\n");
  for (int const diameters : {1, -2}) {
    folder.write("wheel.toml", moving +
                                   "[sequence]\nsteps = 5\n[wheel]\noutput = "
                                   "\"wave_{step}.cgns\"\npassages = 5\n" +
                                   "nodal_diameters = " + std::to_string(diameters) + "\n");
    ASSERT_EQ(gridmorph("wheel wheel.toml"), 0) << text("err");
    std::vector<WheelFile> steps;
    for (int s = 1; s <= n_blades; ++s) steps.emplace_back(folder.file("wave_" + std::to_string(s) + ".cgns"));
    double worst = 0;
    for (int s = 0; s < n_blades; ++s)
      for (int p = 0; p < n_blades; ++p) {
        int const as = ((s + p * diameters) % n_blades + n_blades) % n_blades;
        for (Index n = 0; n < mesh.n_nodes(); ++n)
          worst = std::max(worst, distance(at(steps[s], p, n), at(steps[as], 0, n)));
      }
    EXPECT_LT(worst, 1e-13 * size()) << diameters;
  }
  expect_all_in(refusal(moving + "[sequence]\nsteps = 5\n", "passages = 5\nnodal_diameters = 3\n"),
                {"nodal_diameters", "has 5 blades", "-2 to 2"});
}

TEST_F(StraightRow, NeedsANumber) {
  expect_all_in(refusal(text("passage.toml"), ""),
                {"wheel.toml:", "passages: is missing", "'passage'", "is straight", "passages = 5"});
}

TEST_F(StraightRow, OfHexahedraMovesItsBoundariesAsThatOfBlocks) {
  ElementWheelFile const elements = of_elements("hexahedra.cgns", three_blades);
  elements.expect_same_bits();
  EXPECT_EQ(elements.count_faces().open, 0);
  expect_same_boundaries(mesh, {"hub", "case"}, wheel("passage.toml", three_blades), elements);
}

TEST_F(StraightRow, OfEqualHexahedraIsTheMorphedPassageShifted) {
  ElementWheelFile const row = of_elements("hexahedra.cgns", five);
  row.expect_same_bits();
  EXPECT_LE(gridmorph("morph wheel.toml"), 1) << text("err");
  Mesh const one = read_mesh(folder.file("morphed.cgns"));
  double worst = 0;
  for (int p = 0; p < n_blades; ++p)
    for (Index n = 0; n < mesh.n_nodes(); ++n) worst = std::max(worst, distance(at(row, p, n), one.coordinates[n]));
  EXPECT_LT(worst, 1e-14 * size());
}

PassageLinks links_of(Mesh& mesh) { return passage_links(mesh, connect_and_check(mesh, {}), {}); }

TEST(StraightRows, CountUpwardsWhicheverSideTheFileNamesFirst) {
  for (double const way : {1.0, -1.0}) {
    Mesh mesh = cascade();
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      Vec3 const p = mesh.coordinates[n];
      mesh.coordinates.set(n, {p.x, way * p.y, way * p.z});
    }
    for (auto& face : mesh.interfaces)
      if (face.periodic) face.periodic = periodic_translation(way * face.periodic->translation);
    PassageLinks const links = links_of(mesh);
    WheelRows const rows = find_rows(mesh, links, Axis{});
    EXPECT_EQ(rows.rows.front().passages, 0);
    EXPECT_LT(distance(rows.rows.front().pitch.shift(), {0, 0, cascade_pitch}), 1e-14);
    for (std::size_t l = 0; l < links.all.size(); ++l) {
      auto const& [own, donor] = links.all[l].pairs.front();
      EXPECT_EQ(rows.pitches_of_link[l], mesh.coordinates[donor].z > mesh.coordinates[own].z ? 1 : -1);
    }
  }
}

/// Two components of the pitch are as large as each other but for round-off, which differs from side to side.
TEST(StraightRows, OfPitchesAtFortyFiveDegreesGoOneWay) {
  Mesh mesh = cascade();
  PassageLinks links = links_of(mesh);
  std::erase_if(links.all, [](PassageLink const& link) { return !link.periodic; });
  links.all.resize(1);
  PassageLink &one = links.all.front(), other = one;
  auto const half = one.pairs.begin() + std::ptrdiff_t(one.pairs.size() / 2);
  other.pairs.assign(half, one.pairs.end());
  one.pairs.erase(half, one.pairs.end());
  links.all.push_back(other);
  for (double const noise : {1e-13, -1e-13}) {
    Mesh skew = mesh;
    skew.coordinates = Coordinates(mesh.n_nodes());
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      Vec3 const p = mesh.coordinates[n];
      skew.coordinates.set(n, {p.x, p.y - p.z, p.z});
    }
    for (auto const& [own, donor] : links.all.back().pairs) {
      Vec3 const p = skew.coordinates[donor];
      skew.coordinates.set(donor, {p.x, p.y + noise, p.z});
    }
    WheelRows const rows = find_rows(skew, links, Axis{});
    EXPECT_EQ(rows.pitches_of_link[0], rows.pitches_of_link[1]);
    EXPECT_NEAR(norm(rows.rows.front().pitch.shift()), std::sqrt(2) * cascade_pitch, 1e-12);
  }
}

TEST(StraightRows, HaveOnePitch) {
  Mesh mesh = cascade();
  PassageLinks links = links_of(mesh);
  for (auto& pair : links.all.front().pairs) pair[1] = pair[0];  // a shift by nothing
  expect_all_in(message_of<MeshError>([&] { find_rows(mesh, links, Axis{}); }), {"periodic interface", "no shift"});
}

/// A plane passage with its blade on the floor: straight, or a sector of an annulus about z.
Mesh plane_passage(int sectors, int layers = 3) {
  constexpr int across = 12, high = 8;
  Mesh mesh = flat_box(across, high, layers);
  double const angle = sectors > 0 ? 2 * std::acos(-1.0) / sectors : 0;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    double const x = mesh.coordinates.x(n) / across, y = 0.5 * mesh.coordinates.y(n) / high;
    mesh.coordinates.set(n, sectors > 0 ? (1 + y) * Vec3{std::cos(angle * x), -std::sin(angle * x), 0} : Vec3{x, y, 0});
  }
  Patch floor = mesh.patches[2], blade = floor;
  floor.name = "floor";
  blade.name = "blade";
  CsrGraph const faces = std::exchange(floor.faces, {});
  blade.faces = {};
  for (Index f = 0; f < faces.size(); ++f) (f >= 4 && f < 8 ? blade : floor).faces.add(faces[f]);
  Patch const roof = mesh.patches[3];
  mesh.patches = {blade, floor, roof};
  Connection sides{"sides", {}, 0, 0, {}, {}, {}};
  sides.periodic = sectors > 0 ? periodic_rotation({0, 0, 0}, {0, 0, 1}, -angle) : periodic_translation({1, 0, 0});
  for (int j = 0; j <= high; ++j) {
    sides.nodes.push_back(Index32(j * (across + 1)));
    sides.donor_nodes.push_back(Index32(j * (across + 1) + across));
  }
  mesh.connections = {sides};
  return mesh;
}

class PlaneRow : public WheelTest, public ::testing::WithParamInterface<int> {};

/// Of 7 blades each: a wheel of that many sectors, and a row of that many passages.
TEST_P(PlaneRow, IsAPlaneMeshOfPassagesEachAsMorphed) {
  constexpr int n = 7;
  bool const round = GetParam() > 0;
  Mesh const mesh = plane_passage(GetParam());
  write_mesh(folder.file("plane.cgns"), mesh);
  // Nothing at the ends of the blade, a third and two thirds of the passage.
  std::string const bump =
      round ? "dr = \"-h * sin(10.5 * (theta + 2 * pi / 21))\"\n" : "dy = \"-h * sin(3 * pi * x)\"\n";
  auto const case_of = [&](double h) {
    return std::string("[mesh]\ninput = \"plane.cgns\"\noutput = \"morphed.cgns\"\naxis = ") +
           (round ? "\"z\"" : "\"y\"") + "\n[[motion]]\npatches = \"blade\"\nrule = \"formula\"\n" + bump +
           "constants = { h = " + std::to_string(h) + " }\n[[motion]]\npatches = \"type:periodic\"\nrule = \"fixed\"\n";
  };
  folder.write("wheel.toml", case_of(0.06) + "[wheel]\noutput = \"wheel.cgns\"\n" + (round ? "" : "passages = 7\n") +
                                 "factors = [1, 0.5, 0, -0.5, 1, 1, 0]\n");
  ASSERT_LE(gridmorph("wheel wheel.toml"), 1) << text("out") << text("err");
  Mesh const row = read_mesh(folder.file("wheel.cgns"));
  EXPECT_EQ(row.dimension, 2);
  ASSERT_EQ(row.zones.size(), std::size_t(n));
  EXPECT_EQ(row.n_elements(), n * mesh.n_elements());
  int periodic = 0;
  for (auto const& c : row.connections) {
    periodic += c.periodic ? 1 : 0;
    for (std::size_t k = 0; k < c.nodes.size() && !c.periodic; ++k)
      EXPECT_TRUE(row.coordinates[c.nodes[k]] == row.coordinates[c.donor_nodes[k]]);
  }
  EXPECT_EQ(periodic, round ? 0 : 2);
  RowPitch const pitch = round ? RowPitch(Axis{{0, 0, 0}, {0, 0, 1}}, n) : RowPitch(Vec3{1, 0, 0});
  std::array<double, n> const factor{1, 0.5, 0, -0.5, 1, 1, 0};
  for (int p = 0; p < n; ++p) {
    folder.write("one.toml", case_of(0.06 * factor[p]));
    ASSERT_LE(gridmorph("morph one.toml"), 1) << text("err");
    Mesh const one = read_mesh(folder.file("morphed.cgns"));
    for (Index f = 0; f < mesh.patches.front().faces.size(); ++f)
      for (Index32 const node : mesh.patches.front().faces[f]) {
        Vec3 const back = pitch.times(-p)(row.coordinates[row.zones[p].first_node + node]);
        EXPECT_LT(distance(back, one.coordinates[node]), 1e-13) << p;
      }
  }
}

INSTANTIATE_TEST_SUITE_P(StraightAndRound, PlaneRow, ::testing::Values(0, 7));

/// As SU2 does it: a row of cells beyond the lower side, which are those below the upper side.
TEST(StraightRows, LeaveOutElementsThatRepeatOthersAPitchAway) {
  constexpr int across = 12, high = 8;
  Mesh const mesh = plane_passage(0, high);
  std::vector<Index32> beyond;
  Mesh twice;
  twice.dimension = 2;
  twice.source = "twice";
  twice.add_zone("plane", mesh.n_nodes() + high + 1);
  twice.coordinates = Coordinates(twice.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) twice.coordinates.set(n, mesh.coordinates[n]);
  for (int j = 0; j <= high; ++j) {
    beyond.push_back(Index32(mesh.n_nodes() + j));
    twice.coordinates.set(beyond.back(), mesh.coordinates[j * (across + 1) + across - 1] - Vec3{1, 0, 0});
  }
  for (Index e = 0; e < mesh.n_elements(); ++e) twice.add_element(mesh.elements.type[e], mesh.elements.nodes[e]);
  for (int j = 0; j < high; ++j) {
    auto const at = [&](int k) { return Index32(k * (across + 1)); };
    twice.add_element(ElementType::quadrilateral, std::array{beyond[j], at(j), at(j + 1), beyond[j + 1]});
  }
  twice.patches = mesh.patches;
  twice.connections = mesh.connections;
  Connection inner{"inner", {}, 0, 0, {}, beyond, periodic_translation({-1, 0, 0})};
  for (int j = 0; j <= high; ++j) inner.nodes.push_back(Index32(j * (across + 1) + across - 1));
  twice.connections.push_back(inner);
  EXPECT_EQ(leave_out_repeated_elements(twice), high);
  expect_same_mesh(twice, mesh);
  EXPECT_EQ(leave_out_repeated_elements(twice), 0);
}

}  // namespace
}  // namespace gridmorph::test
