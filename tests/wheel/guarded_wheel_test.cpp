// Wheels whose passages are looked after by a guard: smoothed, or morphed with what it did frozen into the plan.
#include "support/expect_error.hpp"
#include "wheel/element_wheel_file.hpp"
#include "wheel/wheel_run.hpp"

#include <generators/passage_demo.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::test {
namespace {

constexpr int n_blades = 8;

class GuardedWheel : public WheelTest {
 protected:
  void SetUp() override {
    PassageOptions options;
    options.nodes = 10'000;
    options.blades = n_blades;
    options.hub = {0.09, 0.09, 0, 0};  // cylinders, on which the motion of the blade stays
    options.casing = {0.167, 0.167, 0, 0};
    mesh = make_passage(options);
    write_mesh(folder.file("passage.cgns"), mesh);
    write_mesh(folder.file("elements.cgns"), as_hexahedra(mesh));
  }
  static inline std::string const without_layer = "boundary_layer = false\n";
  /// The demo's blade times `amplitude`; of blocks without a near field, whose nodes would stay as they are.
  static std::string rules(std::string const& amplitude, std::string const& input = "passage.cgns") {
    std::string motion = demo_rules;
    motion.insert(motion.find("daxial"), "amplitude = " + amplitude + "\n");
    return (input == "passage.cgns" ? without_layer + "[mesh]\n" : "[mesh]\nblocks = \"off\"\n") + "input = \"" +
           input + "\"\noutput = \"morphed.cgns\"\naxis = \"x\"\n" + motion;
  }
  static std::string guard(std::string const& keys) {
    return "\n[guard]\nwrite_inverted = true\nretry = false\n" + keys;
  }
  static std::string wheel_of(std::string const& keys, std::string const& output = "wheel.cgns") {
    return "\n[wheel]\noutput = \"" + output + "\"\n" + keys;
  }
  /// Runs a case file; its report.
  [[nodiscard]] nlohmann::json make(std::string const& case_text) const {
    folder.write("wheel.toml", case_text);
    EXPECT_LE(gridmorph("wheel wheel.toml --report report.json"), 1) << text("out") << text("err");
    return nlohmann::json::parse(text("report.json"));
  }
  [[nodiscard]] WheelFile made() const { return WheelFile(folder.file("wheel.cgns")); }
  static Index inverted(nlohmann::json const& report) {
    Index out = 0;
    for (auto const& passage : report["passages"])
      for (char const* field : {"near_field", "far_field"})
        out += passage["quality"][field]["newly_inverted"].get<Index>();
    return out;
  }
  /// Calls visit(zone, node in it) for the nodes of the periodic sides.
  template <class Visit>
  void for_sides(Visit&& visit) const {
    for (auto const& face : mesh.interfaces) {
      if (!face.periodic) continue;
      Zone const& zone = mesh.zones[face.zone];
      for (int k = face.range.begin[2]; k < face.range.end[2]; ++k)
        for (int j = face.range.begin[1]; j < face.range.end[1]; ++j)
          for (int i = face.range.begin[0]; i < face.range.end[0]; ++i)
            visit(zone, std::size_t(zone.node({i, j, k}) - zone.first_node));
    }
  }
  [[nodiscard]] double size() const { return mesh.size(); }

  Mesh mesh;
};

/// Two blades in turn, of a part of the wheel; each turns over cells where nothing is smoothed.
constexpr char const* different = "passages = 2\nfactors = [1, 0.9]\n";
constexpr char const* large = "10.0";

TEST_F(GuardedWheel, SmoothedHasFewerCellsInvertedAndNeighboursMeet) {
  std::string const text = rules(large);
  auto const plain = make(text + guard("") + wheel_of(different));
  WheelFile const before = made();
  auto const smoothed = make(text + guard("smooth = true\n") + wheel_of(different));
  WheelFile const after = made();
  ASSERT_GT(inverted(plain), 0) << "the motion is too small";
  EXPECT_LT(inverted(smoothed), inverted(plain));
  EXPECT_NE(this->text("out").find("passage 1: "), std::string::npos) << "a note says what was smoothed";
  EXPECT_NE(this->text("out").find("displacements around them are smoothed in "), std::string::npos);
  after.expect_watertight();
  EXPECT_LT(smoothed["largest_seam_gap"].get<double>(), 1e-13 * size());
  for (int const p : {0, 1})
    for_sides([&](Zone const& zone, std::size_t n) {
      EXPECT_EQ(after.zones.at(name(zone.name, p)).at(n), before.zones.at(name(zone.name, p)).at(n)) << zone.name << n;
    });
  EXPECT_GT(distance_between(after, 0, before, 0, n_blades), 1e-5 * size());
}

TEST_F(GuardedWheel, OfEqualBladesIsTheSmoothedPassageTurned) {
  std::string const text = rules("9.0") + guard("smooth = true\n");
  (void)make(text + wheel_of(""));
  WheelFile const wheel = made();
  wheel.expect_watertight();
  folder.write("one.toml", text);
  ASSERT_LE(gridmorph("morph one.toml"), 1) << this->text("err");
  EXPECT_NE(this->text("out").find("displacements around them are smoothed in "), std::string::npos);
  Mesh const one = read_mesh(folder.file("morphed.cgns"));
  for (int p = 0; p < n_blades; ++p) EXPECT_LT(distance_from(wheel, p, n_blades, one), 1e-9 * size()) << p;
}

TEST_F(GuardedWheel, FrozenIsTheSmoothedWheelOfAsManyPassagesAsModes) {
  std::string const text = rules(large);
  (void)make(text + guard("smooth = true\n") + wheel_of(different));
  WheelFile const smoothed = made();
  auto const report = make(text + guard("smooth = true\nfreeze = true\n") + wheel_of(different));
  WheelFile const frozen = made();
  frozen.expect_watertight();
  auto const& map = report["frozen_guard"];
  EXPECT_EQ(map["displacements"], 2);
  EXPECT_EQ(map["modes"], 2);
  EXPECT_GT(map["nodes"], 0);
  EXPECT_NE(this->text("out").find("the guard is frozen into the plan"), std::string::npos);
  EXPECT_EQ(this->text("out").find("are smoothed in"), std::string::npos) << "nothing is smoothed any more";
  for (int p = 0; p < n_blades; ++p) EXPECT_LT(distance_between(frozen, p, smoothed, p, n_blades), 1e-9 * size()) << p;
}

TEST_F(GuardedWheel, OverTimeIsSmoothedAlikeInAllPassagesAndSteps) {
  // Of two steps, with the blades of a passage and of its neighbours half a period apart.
  std::string const head = rules("\"6 + 1.6 * cos(2 * pi * t)\"") + "\n[sequence]\nsteps = 2\n";
  auto const steps = [&](std::string const& keys, std::string const& output) {
    auto report = make(head + guard(keys) + wheel_of("passages = 2\nnodal_diameters = 4\n", output + "_{step}.cgns"));
    EXPECT_NE(text("out").find("smoothed in all of them alike"), std::string::npos);
    std::vector<WheelFile> files;
    for (int const step : {1, 2}) files.emplace_back(folder.file(fmt::format("{}_{}.cgns", output, step)));
    for (WheelFile const& file : files) file.expect_watertight();
    for (int const p : {0, 1}) EXPECT_LT(distance_between(files[1], p, files[0], 1 - p, n_blades), 1e-12 * size()) << p;
    return std::pair(std::move(report), std::move(files));
  };
  auto const [plain, smoothed] = steps("smooth = true\n", "smoothed");
  auto const [report, frozen] = steps("smooth = true\nfreeze = true\n", "frozen");
  EXPECT_FALSE(plain.contains("frozen_guard"));
  EXPECT_EQ(report["frozen_guard"]["displacements"], 4);
  EXPECT_EQ(report["frozen_guard"]["modes"], 2) << "two passages are those of the other step";
  for (std::size_t const step : {0, 1})
    for (int const p : {0, 1})
      EXPECT_LT(distance_between(frozen[step], p, smoothed[step], p, n_blades), 1e-9 * size()) << step << p;
}

TEST_F(GuardedWheel, FrozenIntoThePlanRestsWhereNothingMoves) {
  auto const report = make(rules("\"4.5 * (1 - cos(2 * pi * t))\"") + "\n[sequence]\nsteps = 2\n" +
                           guard("smooth = true\nfreeze = true\n") + wheel_of("passages = 1\n", "still_{step}.cgns"));
  EXPECT_EQ(report["frozen_guard"]["displacements"], 2);
  EXPECT_GT(report["frozen_guard"]["nodes"], 0);
  EXPECT_EQ(distance_from(WheelFile(folder.file("still_1.cgns")), 0, n_blades, mesh), 0);
  EXPECT_GT(distance_from(WheelFile(folder.file("still_2.cgns")), 0, n_blades, mesh), 1e-3 * size());
}

/// The passage, and another row of them downstream whose families end in "_2"; periodic sides are "sides" and
/// "sides_2".
Mesh two_rows(Mesh const& one) {
  Mesh out = one;
  int const n_zones = int(one.zones.size());
  for (Zone const& zone : one.zones) out.add_zone(zone.name + "_2", zone.extent);
  for (Patch patch : one.patches) {
    patch.zone += n_zones;
    for (auto& family : patch.families) family += "_2";
    out.patches.push_back(std::move(patch));
  }
  out.interfaces.clear();
  for (int const row : {0, 1})
    for (Interface1to1 face : one.interfaces) {
      face.zone += row * n_zones;
      face.donor_zone += row * n_zones;
      if (face.periodic) face.families = {row == 0 ? "sides" : "sides_2"};
      out.interfaces.push_back(std::move(face));
    }
  for (auto const& family : one.families) out.families.push_back(family + "_2");
  for (std::string const family : {"sides", "sides_2"}) out.families.push_back(family);
  out.coordinates = Coordinates(2 * one.n_nodes());
  for (Index n = 0; n < one.n_nodes(); ++n) {
    out.coordinates.set(n, one.coordinates[n]);
    out.coordinates.set(one.n_nodes() + n, one.coordinates[n] + Vec3{1, 0, 0});
  }
  return out;
}

/// What the blade of a row does, and all that goes along with it.
std::string rules_of_row(std::string const& end, std::string const& dtheta) {
  auto const names = [&](std::string const& one, std::string const& other) {
    return "patches = [\"" + one + end + "\", \"" + other + end + "\"]\n";
  };
  std::string const blade = "\"blade" + end + "\"\n";
  return "[[motion]]\npatches = " + blade + "rule = \"formula\"\ndtheta = \"" + dtheta + "\"\n[[motion]]\n" +
         names("inlet", "outlet") + "rule = \"circumferential-slide\"\nof = " + blade +
         "[[motion]]\npatches = \"sides" + end + "\"\nrule = \"follow\"\nof = " + blade + "[[motion]]\n" +
         names("hub", "case") + "rule = \"slip\"\nsurface = \"revolution\"\n";
}

TEST_F(GuardedWheel, RowsOfEqualBladesAreAlikeWhateverOtherRowsDo) {
  write_mesh(folder.file("rows.cgns"), two_rows(mesh));
  std::string const text = without_layer + "[mesh]\ninput = \"rows.cgns\"\naxis = \"x\"\n" +
                           rules_of_row("", "0.54 * sin(axial / 0.05) + 0.9 * axial") +
                           rules_of_row("_2", "0.54 * sin((axial - 1) / 0.05) + 0.9 * (axial - 1)");
  std::string const keys = wheel_of(
      "[[wheel.row]]\nzones = \"ring_le\"\npassages = 2\nfactors = [1, 0.6]\n"
      "[[wheel.row]]\nzones = \"ring_le_2\"\npassages = 2\n");
  (void)make(text + guard("") + keys);
  WheelFile const plain = made();
  for (std::string const of_guard : {"smooth = true\n", "smooth = true\nfreeze = true\n"}) {
    auto const report = make(text + guard(of_guard) + keys);
    WheelFile const wheel = made();
    wheel.expect_watertight();
    EXPECT_LT(report["largest_seam_gap"].get<double>(), 1e-12 * size()) << of_guard;
    double moved = 0;
    for (Zone const& zone : mesh.zones)
      for (int const p : {0, 1}) {
        FileZone const& first = wheel.zones.at(name(zone.name + "_2", 0));
        FileZone const& now = wheel.zones.at(name(zone.name + "_2", p));
        FileZone const& before = plain.zones.at(name(zone.name + "_2", 0));
        for (std::size_t n = 0; n < first.x.size(); ++n) {
          ASSERT_LT(distance(Turn(Axis{}, -p, n_blades)(now.at(n)), first.at(n)), 1e-12 * size()) << zone.name << p;
          moved = std::max(moved, distance(first.at(n), before.at(n)));
        }
      }
    EXPECT_GT(moved, 1e-5 * size()) << "the row of equal blades is smoothed too";
  }
}

TEST_F(GuardedWheel, OfElementsIsFrozenAsItIsSmoothed) {
  std::string const text = rules(large, "elements.cgns");
  auto const plain = make(text + guard("") + wheel_of(different));
  ElementWheelFile const smoothed(folder.file("wheel.cgns"));
  ASSERT_NE(this->text("out").find("are smoothed in"), std::string::npos) << "the motion is too small";
  auto const report = make(text + guard("freeze = true\n") + wheel_of(different));
  ElementWheelFile const frozen(folder.file("wheel.cgns"));
  frozen.expect_same_bits();
  EXPECT_EQ(report["frozen_guard"]["displacements"], 2);
  EXPECT_EQ(report["frozen_guard"]["modes"], 2);
  EXPECT_EQ(inverted(report), inverted(plain));
  for (int p = 0; p < n_blades; ++p) EXPECT_LT(distance_between(frozen, p, smoothed, p, n_blades), 1e-9 * size()) << p;
}

}  // namespace
}  // namespace gridmorph::test
