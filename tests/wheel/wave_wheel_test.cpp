// Wheels over time: blades in a travelling wave of nodal diameters, against wheels and passages made one at a time.
#include "support/expect_error.hpp"
#include "wheel/element_wheel_file.hpp"
#include "wheel/wheel_run.hpp"

#include <generators/passage_demo.hpp>
#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/mesh/block_elements.hpp>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <optional>

namespace gridmorph::test {
namespace {

constexpr int n_blades = 8;
constexpr double pi = 3.14159265358979323846;

class WaveWheel : public WheelTest {
 protected:
  void SetUp() override {
    PassageOptions options;
    options.nodes = 10'000;
    options.blades = n_blades;
    options.hub = {0.09, 0.09, 0, 0};  // cylinders, on which the motions below stay
    options.casing = {0.167, 0.167, 0, 0};
    mesh = make_passage(options);
    write_mesh(folder.file("passage.cgns"), mesh);
    write_mode("bend.csv", [](Vec3 const& x) { return Vec3{0.02 * x.x * x.x, 0, 0}; });
    write_mode("twist.csv", [](Vec3 const& x) {
      return (0.3 * x.x) * Vec3{0, -x.z, x.y};  // along the circles to first order; the end walls take the rest
    });
  }
  /// A mode shape at the nodes of the blade.
  void write_mode(std::string const& name, std::function<Vec3(Vec3 const&)> const& shape) const {
    std::string text = "x,y,z,dx,dy,dz\n";
    for_blade([&](Zone const&, Index n) {
      Vec3 const x = mesh.coordinates[n], u = shape(x);
      text += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", x.x, x.y, x.z, u.x, u.y, u.z);
    });
    folder.write(name, text);
  }
  template <class Visit>
  void for_blade(Visit&& visit) const {
    for (auto const& patch : mesh.patches) {
      if (patch.families.front() != "blade") continue;
      auto const& zone = mesh.zones[patch.zone];
      for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
        for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
          for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) visit(zone, zone.node({i, j, k}));
    }
  }
  /// Where passage p of a wheel has its blade, turned back; in the order of for_blade().
  template <class File>
  [[nodiscard]] std::vector<Vec3> blade(File const& wheel, int p) const {
    std::vector<Vec3> out;
    for_blade([&](Zone const& zone, Index n) {
      out.push_back(
          Turn(Axis{}, -p, n_blades)(wheel.zones.at(name(zone.name, p)).at(std::size_t(n - zone.first_node))));
    });
    return out;
  }
  [[nodiscard]] std::vector<Vec3> blade(Mesh const& passage) const {
    std::vector<Vec3> out;
    for_blade([&](Zone const&, Index n) { out.push_back(passage.coordinates[n]); });
    return out;
  }
  static double largest(std::vector<Vec3> const& a, std::vector<Vec3> const& b) {
    double out = 0;
    for (std::size_t n = 0; n < a.size(); ++n) out = std::max(out, distance(a[n], b[n]));
    return out;
  }
  [[nodiscard]] static std::string head(std::string const& input = "passage.cgns", bool as_elements = false) {
    return "[mesh]\ninput = \"" + input + "\"\noutput = \"morphed.cgns\"\naxis = \"x\"\n" +
           (as_elements ? "blocks = \"off\"\n" : "");
  }
  [[nodiscard]] static std::string blade_rule(std::string const& keys) {
    return "[[motion]]\npatches = \"blade\"\n" + keys + "\n" + followers;
  }
  /// Two modes in time; `ahead`: of a period.
  [[nodiscard]] static std::string modes(double ahead) {
    return fmt::format(
        "rule = \"field\"\nmodes = [ {{ file = \"bend.csv\", amplitude = 0.9, phase_deg = {:.17g} }}, {{ file = "
        "\"twist.csv\", amplitude = 0.5, harmonic = 2, phase_deg = {:.17g} }} ]",
        20 + 360 * ahead, 360 * 2 * ahead);
  }
  int make(std::string const& text) const {
    folder.write("wheel.toml", text);
    int const status = gridmorph("wheel wheel.toml");
    EXPECT_EQ(status, 0) << this->text("out") << this->text("err");
    return status;
  }
  [[nodiscard]] WheelFile step(int number) const { return WheelFile(folder.file(fmt::format("wave_{}.cgns", number))); }
  [[nodiscard]] static std::string sequence(int steps) { return fmt::format("[sequence]\nsteps = {}\n", steps); }
  [[nodiscard]] static std::string wave(int diameters, std::string const& more = "") {
    return fmt::format("\n[wheel]\noutput = \"wave_{{step}}.cgns\"\nnodal_diameters = {}\n{}", diameters, more);
  }
  [[nodiscard]] double size() const { return mesh.size(); }
  Mesh mesh;
};

constexpr char const* turning = R"case(rule = "formula"
dtheta = "0.06 * sin(axial / 0.05) + 0.1 * axial"
daxial = "0.1 * (r - 0.12) * axial"
amplitude = "cos(2 * pi * t)")case";

TEST_F(WaveWheel, EveryStepIsTheWheelOfBladesWithTheAmplitudesOfThatTime) {
  int const steps = 5, diameters = 3;
  make(head() + sequence(steps) + blade_rule(turning) + wave(diameters));
  std::string still = turning;
  still = still.substr(0, still.find("\namplitude"));
  for (int s = 0; s < steps; ++s) {
    WheelFile const moving = step(s + 1);
    moving.expect_watertight();
    std::string factors = "factors = [";
    for (int p = 0; p < n_blades; ++p)
      factors += fmt::format("{}{:.17g}", p > 0 ? ", " : "",
                             std::cos(2 * pi * (double(s) / steps + double(p * diameters) / n_blades)));
    make(head() + blade_rule(still) + "\n[wheel]\noutput = \"still.cgns\"\n" + factors + "]\n");
    WheelFile const one(folder.file("still.cgns"));
    for (int p = 0; p < n_blades; ++p)
      EXPECT_LT(distance_between(moving, p, one, p, n_blades), 1e-13 * size()) << "step " << s + 1 << " passage " << p;
  }
}

TEST_F(WaveWheel, EveryBladeIsThatOfThePassageWithItsPhase) {
  int const steps = 4, diameters = -3;
  make(head() + sequence(steps) + blade_rule(modes(0)) + wave(diameters));
  double moved = 0;
  for (int s = 0; s < steps; ++s) {
    WheelFile const moving = step(s + 1);
    for (int p = 0; p < n_blades; ++p) {
      folder.write("one.toml", head() + blade_rule([&] {
                                 std::string rule = modes(double(s) / steps + double(p * diameters) / n_blades);
                                 return rule.erase(rule.find(", harmonic = 2"), 14);  // at time 0 there is none
                               }()));
      ASSERT_EQ(gridmorph("morph one.toml"), 0) << text("err");
      auto const alone = blade(read_mesh(folder.file("morphed.cgns")));
      EXPECT_LT(largest(blade(moving, p), alone), 1e-14 * size()) << "step " << s + 1 << " passage " << p;
      moved = std::max(moved, largest(alone, blade(mesh)));
    }
  }
  EXPECT_GT(moved, 1e-3 * size());
}

TEST_F(WaveWheel, TravelsRoundTheWheel) {
  // As many steps as blades and one nodal diameter: a step later every blade is where the one above it was.
  make(head() + sequence(n_blades) + blade_rule(modes(0)) + wave(1));
  WheelFile const first = step(1);
  for (int s = 1; s < n_blades; s += 3) {
    WheelFile const later = step(s + 1);
    for (int p = 0; p < n_blades; ++p)
      EXPECT_LT(distance_between(later, p, first, (p + s) % n_blades, n_blades), 1e-14 * size()) << s << " " << p;
  }
}

TEST_F(WaveWheel, OverAPeriodBladesAreInTheMeanWhereTheyWere) {
  int const steps = 6;
  make(head() + sequence(steps) + blade_rule("rule = \"field\"\nmodes = [ { file = \"bend.csv\", phase_deg = 17 } ]") +
       wave(2));
  for (int p = 0; p < n_blades; p += 3) {
    std::vector<Vec3> sum;
    for (int s = 0; s < steps; ++s) {
      auto const now = blade(step(s + 1), p);
      sum.resize(now.size());
      for (std::size_t n = 0; n < now.size(); ++n) sum[n] += (1.0 / steps) * now[n];
    }
    EXPECT_LT(largest(sum, blade(mesh)), 1e-14 * size());
  }
}

TEST_F(WaveWheel, WithoutNodalDiametersIsTheSequenceOfThePassageTurned) {
  int const steps = 3;
  folder.write("passage.toml",
               "[mesh]\ninput = \"passage.cgns\"\naxis = \"x\"\n[sequence]\nsteps = 3\noutput = "
               "\"one_{step}.cgns\"\n" +
                   blade_rule(modes(0)));
  ASSERT_EQ(gridmorph("morph passage.toml"), 0) << text("err");
  make(head() + sequence(steps) + blade_rule(modes(0)) + wave(0));
  for (int s = 0; s < steps; ++s) {
    Mesh const one = read_mesh(folder.file(fmt::format("one_{}.cgns", s + 1)));
    WheelFile const wheel = step(s + 1);
    wheel.expect_watertight();
    for (int p = 0; p < n_blades; ++p) EXPECT_LT(distance_from(wheel, p, n_blades, one), 1e-14 * size()) << s << p;
  }
}

/// Grid number `step` (from 1) of every zone, in the order of its pointers.
std::map<std::string, std::vector<double>> series_x(std::string const& path, int step, std::vector<double>& times) {
  std::map<std::string, std::vector<double>> out;
  int file = 0, zones = 0, steps = 0;
  std::array<char, 34> name{};
  check_cgns(cg_open(path.c_str(), CG_MODE_READ, &file));
  check_cgns(cg_biter_read(file, 1, name.data(), &steps));
  check_cgns(cg_goto(file, 1, "BaseIterativeData_t", 1, "end"));
  times.resize(steps);
  check_cgns(cg_array_read(1, times.data()));
  check_cgns(cg_nzones(file, 1, &zones));
  for (int z = 1; z <= zones; ++z) {
    std::array<cgsize_t, 9> size{};
    check_cgns(cg_zone_read(file, 1, z, name.data(), size.data()));
    std::string const zone = name.data();
    check_cgns(cg_goto(file, 1, "Zone_t", z, "ZoneIterativeData_t", 1, "end"));
    std::string pointers(std::size_t(32 * steps), ' ');
    check_cgns(cg_array_read(1, pointers.data()));
    std::string grid = pointers.substr(std::size_t(32 * (step - 1)), 32);
    grid.resize(grid.find_last_not_of(' ') + 1);
    check_cgns(cg_goto(file, 1, "Zone_t", z, grid.c_str(), 0, "end"));
    int dimension = 0;
    check_cgns(cg_index_dim(file, 1, z, &dimension));
    out[zone].resize(dimension == 3 ? size[0] * size[1] * size[2] : size[0]);
    check_cgns(cg_array_read(1, out[zone].data()));
  }
  check_cgns(cg_close(file));
  return out;
}

TEST_F(WaveWheel, OneFileHoldsTheSameStepsAsOneFileEach) {
  int const steps = 3;
  std::string const text = head() + "[sequence]\nsteps = 3\nperiod = 0.5\n" + blade_rule(modes(0)) + wave(2);
  make(text);
  ASSERT_EQ(gridmorph("wheel wheel.toml -o series.cgns --report r.json"), 0) << this->text("err");
  WheelFile const series(folder.file("series.cgns"));
  series.expect_watertight();
  for (int p = 0; p < n_blades; ++p) EXPECT_LT(distance_from(series, p, n_blades, mesh), 1e-14 * size());
  for (int s = 0; s < steps; ++s) {
    std::vector<double> times;
    auto const x = series_x(folder.file("series.cgns"), s + 1, times);
    ASSERT_EQ(times.size(), 3U);
    EXPECT_DOUBLE_EQ(times[s], 0.5 * s / 3);
    WheelFile const one = step(s + 1);
    ASSERT_EQ(x.size(), one.zones.size());
    for (auto const& [name, zone] : one.zones) EXPECT_EQ(zone.x, x.at(name)) << name;
  }
  auto const json = nlohmann::json::parse(this->text("r.json"));
  auto const& list = json["sequence"]["steps"];
  ASSERT_EQ(list.size(), 3U);
  double lowest = 1;
  for (auto const& now : list) {
    ASSERT_EQ(now["passages"].size(), std::size_t(n_blades));
    for (auto const& passage : now["passages"]) lowest = std::min(lowest, double(passage["min_determinant"]));
  }
  // Passages in phase are alike, and those out of phase are not.
  EXPECT_EQ(list[1]["passages"][0]["min_determinant"], list[1]["passages"][4]["min_determinant"]);
  EXPECT_NE(list[1]["passages"][0]["largest_displacement"], list[1]["passages"][1]["largest_displacement"]);
  int const worst = json["sequence"]["worst_step"];
  EXPECT_EQ(double(list[worst - 1]["passages"][int(list[worst - 1]["worst_passage"]) - 1]["min_determinant"]), lowest);
  expect_all_in(this->text("out"), {"all steps", "the worst one", "90 deg", "series.cgns (3 steps)"});
}

TEST_F(WaveWheel, InPartIsThatPartOfTheWholeAndItsEndsMatch) {
  make(head() + sequence(3) + blade_rule(modes(0)) + wave(2));
  WheelFile const whole = step(2);
  make(head() + sequence(3) + blade_rule(modes(0)) + wave(2, "passages = 4\n"));
  WheelFile const part = step(2);
  for (int p = 0; p < 4; ++p) EXPECT_LT(distance_between(part, p, whole, p, n_blades), 1e-14 * size()) << p;
  double worst = 0;
  part.for_each_pair(
      [&](FileConnection const& c, FileZone const& own, std::size_t p, FileZone const& donor, std::size_t q) {
        if (c.periodic)
          worst = std::max(worst, distance(Turn(Axis{}, c.angle[0] > 0 ? 4 : -4, n_blades)(own.at(p)), donor.at(q)));
      });
  EXPECT_LT(worst, 2e-16);
}

TEST_F(WaveWheel, WithoutASequenceStandsAtTheBeginning) {
  std::string const rule = "rule = \"field\"\nmodes = [ { file = \"bend.csv\", phase_deg = 40 } ]";
  make(head() + sequence(4) + blade_rule(rule) + wave(-1));
  WheelFile const moving = step(1);
  make(head() + blade_rule(rule) + "\n[wheel]\noutput = \"still.cgns\"\nnodal_diameters = -1\n");
  WheelFile const still(folder.file("still.cgns"));
  for (auto const& [name, zone] : moving.zones) EXPECT_EQ(zone.x, still.zones.at(name).x) << name;
}

TEST_F(WaveWheel, IsRefusedWhereThereIsNoSuchWave) {
  std::string const rules = head() + sequence(4) + blade_rule(modes(0));
  auto const refused = [&](std::string const& text, std::string const& keys) { return refusal(text, keys); };
  expect_all_in(refused(rules, "nodal_diameters = 5\n"),
                {"nodal_diameters", "8 blades", "-4 to 4", "found 5", "that is -3"});
  expect_all_in(refused(rules, "nodal_diameters = -7\n"), {"found -7", "that is 1"});
  expect_all_in(refused(rules, "nodal_diameters = 1.5\n"), {"nodal_diameters", "whole number", "1.5"});
  expect_all_in(refused(rules, "nodal_diameters = 2\npassages = 3\n"), {"3 of 8", "2 nodal diameters", "passages = 4"});
  expect_all_in(refused(head() + sequence(4) +
                            blade_rule("rule = \"field\"\nmodes = [ { file = \"bend.csv\", harmonic = "
                                       "0.5 } ]"),
                        "nodal_diameters = 1\n"),
                {"nodal_diameters", "a period", "repeat"});
  expect_all_in(refused(head() + blade_rule("rule = \"field\"\nfile = \"bend.csv\""), "nodal_diameters = 1\n"),
                {"nodal_diameters", "no blade", "moves with time", "modes"});
}

TEST_F(WaveWheel, BladesHaveRulesOfAnyKind) {
  struct Kind {
    std::string name, keys;
  };
  // A measured blade: the nodes of the blade moved about, as a surface.
  Mesh measured = mesh;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const x = mesh.coordinates[n];
    double const turn = 0.02 * std::sin(40 * x.x);
    measured.coordinates.set(n, {x.x + 0.3 * x.x * (std::hypot(x.y, x.z) - 0.12), x.y - turn * x.z, x.z + turn * x.y});
  }
  write_mesh(folder.file("measured.cgns"), measured);
  std::vector<Kind> const kinds{{"A", ""},
                                {"B", "rule = \"sections\"\ntwist_deg = [[0, 0], [1, 3]]"},
                                {"C", "rule = \"target\"\nfile = \"measured.cgns\"\ntarget_patches = [\"blade\"]"},
                                {"D", "rule = \"inflate\"\nheight = 2e-4"},
                                {"E", "rule = \"field\"\nmodes = [ { file = \"bend.csv\", amplitude = 0.7 } ]"},
                                {"F", "rule = \"field\"\nfile = \"twist.csv\"\nfactor = 0.3"},
                                {"G", "rule = \"rigid\"\nrotation = { angle_deg = 1.5 }"},
                                {"H", "rule = \"fixed\""}};
  std::string const nominal = "rule = \"formula\"\ndtheta = \"0.2 * axial\"";
  std::string keys = "\n[wheel]\noutput = \"kinds.cgns\"\nsequence = [";
  for (auto const& kind : kinds) keys += "\"" + kind.name + "\", ";
  keys += "]\n";
  for (auto const& kind : kinds) {
    keys += "[[wheel.blade]]\nname = \"" + kind.name + "\"\n";
    if (!kind.keys.empty()) keys += "[[wheel.blade.motion]]\npatches = \"blade\"\n" + kind.keys + "\n";
  }
  make(head() + blade_rule(nominal) + keys);
  WheelFile const wheel(folder.file("kinds.cgns"));
  wheel.expect_watertight();
  for (int p = 0; p < n_blades; ++p) {
    auto const& kind = kinds[p];
    folder.write("one.toml", head() + blade_rule(kind.keys.empty() ? nominal : kind.keys));
    ASSERT_EQ(gridmorph("morph one.toml"), 0) << kind.name << text("err");
    auto const alone = blade(read_mesh(folder.file("morphed.cgns")));
    EXPECT_LT(largest(blade(wheel, p), alone), 1e-13 * size()) << kind.name;
    if (kind.name != "H") {
      EXPECT_GT(largest(alone, blade(mesh)), 1e-5 * size()) << kind.name;
    }
  }
}

TEST_F(WaveWheel, EndWallsMoveAndBladesAreExtendedInEveryPassage) {
  // The same bump before every blade.
  std::string const rules = fmt::format(
      "[[motion]]\npatches = \"hub\"\nrule = \"contour\"\noffset = \"0.002 * (2 + cos({} * theta)) * smoothstep(-0.1, "
      "0, "
      "axial)\"\n"
      "[[motion]]\npatches = \"blade\"\nrule = \"extend\"\nof = \"hub\"\n"
      "[[motion]]\npatches = [\"inlet\", \"outlet\"]\nrule = \"free\"\nconstraint = \"axial\"\n"
      "[[motion]]\npatches = \"type:periodic\"\nrule = \"free\"\n[[motion]]\npatches = \"case\"\nrule = \"fixed\"\n",
      n_blades);
  folder.write("one.toml", head() + rules);
  ASSERT_LE(gridmorph("morph one.toml"), 1) << text("err");
  auto const alone = blade(read_mesh(folder.file("morphed.cgns")));
  EXPECT_GT(largest(alone, blade(mesh)), 0.002);
  make(head() + rules + "[wheel]\noutput = \"walls.cgns\"\n");
  WheelFile const wheel(folder.file("walls.cgns"));
  wheel.expect_watertight();
  for (int p = 0; p < n_blades; ++p) EXPECT_LT(largest(blade(wheel, p), alone), 1e-13 * size()) << p;
}

TEST_F(WaveWheel, PassageTellsTheRunningClearanceOfABladeThatGrows) {
  // The blade ends on the case, a cylinder of radius 0.167: what it grows there is what it rubs; the mesh keeps it on
  // the case.
  double const growth = 4e-4;
  std::string const rule = fmt::format("rule = \"formula\"\ndr = \"{} * (r - 0.09) / (0.167 - 0.09)\"", growth);
  std::string const clearance =
      "[guard]\nmax_trim = 1\n[[clearance]]\nname = \"rotor\"\ntips = \"blade\"\nrim = 0.01\nwalls = \"case\"\n";
  for (bool const elements : {false, true}) {
    std::string const input = elements ? "elements.cgns" : "passage.cgns";
    if (elements) write_mesh(folder.file(input), as_hexahedra(mesh));
    folder.write("one.toml", head(input, elements) + blade_rule(rule) + clearance);
    ASSERT_LE(gridmorph("morph one.toml --report one.json"), 1) << text("err");
    auto const tip = nlohmann::json::parse(text("one.json"))["clearances"][0];
    EXPECT_EQ(tip["name"], "rotor");
    EXPECT_EQ(tip["distance"], "meridional");
    EXPECT_GT(tip["nodes"], 20);
    EXPECT_NEAR(double(tip["before"]["smallest"]), 0, 1e-12);
    EXPECT_NEAR(double(tip["by_rule"]["smallest"]), -growth, 1e-12);
    EXPECT_NEAR(double(tip["by_rule"]["mean"]), -growth, 1e-12);
    EXPECT_NEAR(double(tip["after"]["smallest"]), 0, 1e-12);
    expect_all_in(text("out"), {"clearance", "rotor", "-0.0004", "rubs"});
  }
  // The inlet is a plane across the axis: no radius over the axial position, so its surface is taken.
  folder.write("one.toml", head() + blade_rule(rule) +
                               "[guard]\nmax_trim = 1\n[[clearance]]\ntips = \"blade\"\nwalls = \"inlet\"\n");
  ASSERT_LE(gridmorph("morph one.toml --report one.json"), 1) << text("err");
  double leading = 1;
  for (Vec3 const& x : blade(mesh)) leading = std::min(leading, x.x);
  auto const tip = nlohmann::json::parse(text("one.json"))["clearances"][0];
  EXPECT_EQ(tip["distance"], "surface");
  EXPECT_NEAR(double(tip["before"]["smallest"]), leading - PassageOptions{}.inlet, 1e-12);
}

TEST_F(WaveWheel, EveryPassageHasTheRunningClearanceOfItsOwnBlade) {
  double const growth = 4e-4;
  std::string const rule = fmt::format("rule = \"formula\"\ndr = \"{} * (r - 0.09) / (0.167 - 0.09)\"", growth);
  std::string const clearance =
      "[guard]\nmax_trim = 1\n[[clearance]]\nname = \"rotor\"\ntips = \"blade\"\nrim = 0.01\nwalls = \"case\"\n";
  std::vector<double> const factors{1, 0.5, 0, -0.5, 1, 1.5, 0.25, 1};
  std::string list;
  for (double const f : factors) list += fmt::format("{}{}", list.empty() ? "" : ", ", f);
  for (bool const elements : {false, true}) {
    std::string const input = elements ? "elements.cgns" : "passage.cgns";
    if (elements) write_mesh(folder.file(input), as_hexahedra(mesh));
    folder.write("wheel.toml", head(input, elements) + blade_rule(rule) + clearance +
                                   "[wheel]\noutput = \"w.cgns\"\nfactors = [" + list + "]\n");
    ASSERT_LE(gridmorph("wheel wheel.toml --report w.json"), 1) << text("err");
    auto const passages = nlohmann::json::parse(text("w.json"))["passages"];
    ASSERT_EQ(passages.size(), factors.size());
    WheelFile const* blocks = nullptr;
    std::optional<WheelFile> file;
    if (!elements) blocks = &file.emplace(folder.file("w.cgns"));
    for (int p = 0; p < n_blades; ++p) {
      auto const& tip = passages[p]["clearances"][0];
      double const grown = growth * factors[p];
      EXPECT_EQ(tip["name"], "rotor");
      EXPECT_NEAR(double(tip["before"]["smallest"]), 0, 1e-12);
      EXPECT_NEAR(double(tip["by_rule"]["smallest"]), -grown, 1e-12) << p;
      EXPECT_NEAR(double(tip["by_rule"]["mean"]), -grown, 1e-12) << p;
      EXPECT_NEAR(double(tip["after"]["smallest"]), 0, 1e-12) << p;
      // The place is one of the wheel: of that passage's blade.
      Vec3 const at{tip["after"]["at"][0], tip["after"]["at"][1], tip["after"]["at"][2]};
      if (blocks == nullptr) continue;
      double nearest = 1;
      for (Vec3 const& x : blade(*blocks, p)) nearest = std::min(nearest, distance(Turn(Axis{}, p, n_blades)(x), at));
      EXPECT_LT(nearest, 1e-12) << p;
    }
    expect_all_in(text("out"), {"passage 6: rotor", "-0.0006", "smallest of all: -0.0006, passage 6: rotor", "rubs"});
  }
}

TEST_F(WaveWheel, OverTimeTheSmallestClearanceIsToldWithItsStepAndPassage) {
  double const growth = 4e-4;
  std::string const rule = fmt::format(
      "rule = \"formula\"\ndr = \"{} * (r - 0.09) / (0.167 - 0.09)\"\namplitude = \"sin(2 * pi * t)\"", growth);
  int const steps = 5;
  folder.write(
      "wheel.toml",
      head() + sequence(steps) + blade_rule(rule) +
          "[guard]\nmax_trim = 1\n[[clearance]]\nname = \"rotor\"\ntips = \"blade\"\nrim = 0.01\nwalls = \"case\"\n" +
          wave(1));
  ASSERT_LE(gridmorph("wheel wheel.toml --report w.json"), 1) << text("err");
  auto const list = nlohmann::json::parse(text("w.json"))["sequence"]["steps"];
  ASSERT_EQ(list.size(), std::size_t(steps));
  double least = 1;
  std::string told;
  for (int s = 0; s < steps; ++s)
    for (int p = 0; p < n_blades; ++p) {
      double const now = -growth * std::sin(2 * pi * (double(s) / steps + double(p) / n_blades));
      auto const& tip = list[s]["passages"][p]["clearances"][0];
      EXPECT_NEAR(double(tip["by_rule"]["smallest"]), now, 1e-12) << s << " " << p;
      EXPECT_NEAR(double(tip["after"]["smallest"]), 0, 1e-12);
      if (now > least - 1e-12) continue;
      least = now;
      told = fmt::format("smallest of all: {:.4g}, step {}, passage {}: rotor", now, s + 1, p + 1);
    }
  expect_all_in(text("out"), {told, "by the rule, step", "passage 8: rotor"});
}

TEST_F(WaveWheel, PassageTellsTheSmallestClearanceOfASequence) {
  double const growth = 4e-4;
  std::string const rule =
      fmt::format("rule = \"formula\"\ndr = \"{} * sin(2 * pi * t) * (r - 0.09) / (0.167 - 0.09)\"", growth);
  std::string mesh_table = head();
  mesh_table.erase(mesh_table.find("output"), std::string("output = \"morphed.cgns\"\n").size());
  folder.write(
      "one.toml",
      mesh_table + "[sequence]\nsteps = 4\noutput = \"step_{step}.cgns\"\n" + blade_rule(rule) +
          "[guard]\nmax_trim = 1\n[[clearance]]\nname = \"rotor\"\ntips = \"blade\"\nrim = 0.01\nwalls = \"case\"\n");
  ASSERT_LE(gridmorph("morph one.toml --report one.json"), 1) << text("err");
  auto const steps = nlohmann::json::parse(text("one.json"))["sequence"]["steps"];
  ASSERT_EQ(steps.size(), 4U);
  double least = 1;
  for (auto const& step : steps) {
    double const now = growth * std::sin(2 * pi * double(step["time"]));
    EXPECT_NEAR(double(step["clearances"][0]["by_rule"]["smallest"]), -now, 1e-12);
    EXPECT_NEAR(double(step["clearances"][0]["after"]["smallest"]), 0, 1e-12);
    least = std::min(least, -now);
  }
  EXPECT_NEAR(least, -growth, 1e-12);
  expect_all_in(text("out"), {"by the rule, step", "rotor", "-0.0004", "rubs"});
}

TEST_F(WaveWheel, OfElementsMovesTheSameBlades) {
  write_mesh(folder.file("elements.cgns"), as_hexahedra(mesh));
  int const steps = 2;
  // Along the end walls: what puts nodes back on them is spread along the span otherwise by elements.
  std::string const rule = "rule = \"field\"\nmodes = [ { file = \"bend.csv\", phase_deg = 20 } ]";
  make(head() + sequence(steps) + blade_rule(rule) + wave(3));
  std::vector<std::vector<Vec3>> wanted;
  for (int s = 0; s < steps; ++s)
    for (int p = 0; p < n_blades; ++p) wanted.push_back(blade(step(s + 1), p));
  for (auto const& [as_elements, series] : {std::pair(false, false), {true, false}, {true, true}}) {
    folder.write("elements.toml", head("elements.cgns", as_elements) + sequence(steps) + blade_rule(rule) + wave(3));
    ASSERT_LE(gridmorph(std::string("wheel elements.toml") + (series ? " -o series.cgns" : "")), 1) << text("err");
    if (series) {
      for (int s = 0; s < steps; ++s) {
        std::vector<double> times;
        auto const x = series_x(folder.file("series.cgns"), s + 1, times);
        for (auto const& [name, zone] : ElementWheelFile(folder.file(fmt::format("wave_{}.cgns", s + 1))).zones)
          EXPECT_EQ(x.at(name), zone.x);
      }
      continue;
    }
    for (int s = 0; s < steps; ++s) {
      ElementWheelFile const wheel(folder.file(fmt::format("wave_{}.cgns", s + 1)));
      wheel.expect_same_bits();
      for (int p = 0; p < n_blades; ++p)
        EXPECT_LT(largest(blade(wheel, p), wanted[s * n_blades + p]), 1e-9 * size()) << s << " " << p;
    }
  }
}

}  // namespace
}  // namespace gridmorph::test
