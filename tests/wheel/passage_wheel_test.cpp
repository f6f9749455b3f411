// Wheels of the demo passage: its blade stands inside the passage, so that a periodic side lies halfway between two
// blades.
#include "support/expect_error.hpp"
#include "support/scramble.hpp"
#include "support/with_keys.hpp"
#include "wheel/wheel_run.hpp"

#include <generators/passage_demo.hpp>
#include <nlohmann/json.hpp>

namespace gridmorph::test {
namespace {

constexpr int n_blades = 8;
constexpr double pi = 3.14159265358979323846;

class PassageWheel : public WheelTest {
 protected:
  void SetUp() override {
    PassageOptions options;
    options.nodes = 10'000;
    options.blades = n_blades;
    // 8 blades need a small hub. On cylinders the blade's motion below stays exactly on the end walls.
    options.hub = {0.09, 0.09, 0, 0};
    options.casing = {0.167, 0.167, 0, 0};
    mesh = make_passage(options);
    write_mesh(folder.file("passage.cgns"), mesh);
    folder.write("passage.toml", R"([mesh]
input  = "passage.cgns"
output = "morphed.cgns"
axis   = "x"
)" + demo_rules + R"([boundary_layer]
walls  = "blade"
extent = "block"
)");
  }
  [[nodiscard]] Mesh morphed() const {
    EXPECT_EQ(gridmorph("morph passage.toml"), 0) << text("err");
    return read_mesh(folder.file("morphed.cgns"));
  }
  [[nodiscard]] double size() const { return mesh.size(); }

  /// Change of the angle of every node of a patch from the baseline, in passage p.
  template <class Visit>
  void for_angles(WheelFile const& wheel, int p, std::string const& family, Visit&& visit) const {
    for (auto const& patch : mesh.patches) {
      if (patch.families.front() != family) continue;
      auto const& zone = mesh.zones[patch.zone];
      FileZone const& copy = wheel.zones.at(name(zone.name, p));
      for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
        for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
          for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) {
            Index const n = zone.node({i, j, k});
            Vec3 const x = mesh.coordinates[n],
                       y = Turn(Axis{}, -p, n_blades)(copy.at(std::size_t(n - zone.first_node)));
            visit(n, x, y);
          }
    }
  }

  static constexpr char const* two_blades = R"(sequence = ["A", "A", "A", "B", "A", "B", "B", "C"]
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
  Mesh mesh;
};

TEST_F(PassageWheel, OfEqualBladesIsTheMorphedPassageTurned) {
  WheelFile const wheel = this->wheel("passage.toml", "");
  EXPECT_EQ(wheel.zones.size(), n_blades * mesh.zones.size());
  EXPECT_EQ(wheel.n_periodic(), 0);
  wheel.expect_watertight();
  Mesh const one = morphed();
  for (int p = 0; p < n_blades; ++p) EXPECT_LT(distance_from(wheel, p, n_blades, one), 1e-14 * size()) << p;
}

TEST_F(PassageWheel, OtherRecipesAreTriedOnTheWorstPassageAndTheirKeysGiveTheSameWheel) {
  std::string const rest = "[output]\nreport = \"report.json\"\n";
  bool better = false;
  for (int const factor : {6, 9, 13, 19, 28, 42}) {
    std::string const factors = "factors = [1, 1, 1, " + std::to_string(factor) + ", 1, 1, 1, 1]\n" + rest;
    folder.write("wheel.toml", text("passage.toml") + "\n[wheel]\noutput = \"wheel.cgns\"\n" + factors);
    if (gridmorph("wheel wheel.toml") != 4) continue;
    WheelFile const best = wheel("passage.toml", factors + "[guard]\nretry = true\nwrite_inverted = true\n", 1);
    auto const retry = nlohmann::json::parse(text("report.json"))["retry"];
    int const passage = retry["passage"];
    EXPECT_GE(passage, 3);
    EXPECT_LE(passage, 5);
    EXPECT_GT(retry["first"]["newly_inverted"], 0);
    if (retry["kept"].is_null()) continue;
    better = true;
    std::string const kept = retry["kept"];
    EXPECT_NE(text("out").find(kept), std::string::npos) << "the keys are said";
    folder.write("by_hand.toml", with_keys(text("passage.toml"), kept));
    WheelFile const again = wheel("by_hand.toml", factors + "[guard]\nwrite_inverted = true\n", 1);
    EXPECT_FALSE(nlohmann::json::parse(text("report.json")).contains("retry"));
    for (auto const& [name, zone] : best.zones) {
      EXPECT_EQ(zone.x, again.zones.at(name).x) << name;
      EXPECT_EQ(zone.y, again.zones.at(name).y) << name;
      EXPECT_EQ(zone.z, again.zones.at(name).z) << name;
    }
    break;
  }
  EXPECT_TRUE(better) << "no recipe is better than the first";
}

TEST_F(PassageWheel, IsCertifiedAsItIsWritten) {
  std::string const factors = "factors = [1, 1, 1, -40, 1, 1, 1, 1]\n[output]\nreport = \"report.json\"\n";
  for (bool const sound : {true, false}) {
    if (sound)
      (void)wheel("passage.toml", "[output]\nreport = \"report.json\"\n");
    else
      (void)wheel("passage.toml", factors + "[guard]\nwrite_inverted = true\n", 1);
    auto const json = nlohmann::json::parse(text("report.json"));
    auto const& certificate = json["certificate"];
    Index cells = 0, negative = 0;
    for (auto const& passage : json["passages"]) {
      cells += passage["quality"]["certificate"]["cells"].get<Index>();
      negative += passage["quality"]["certificate"]["negative"].get<Index>();
    }
    EXPECT_EQ(certificate["cells"], cells);
    EXPECT_EQ(certificate["negative"], negative);
    EXPECT_EQ(certificate["holds"], sound);
    EXPECT_EQ(negative == 0, sound);
    EXPECT_NE(text("out").find("certificate: the Jacobian of "), std::string::npos);
    if (sound) continue;
    std::string const zone = certificate["broken"]["first"]["zone"];
    EXPECT_TRUE(zone.ends_with("_P03") || zone.ends_with("_P04") || zone.ends_with("_P05")) << zone;
  }
}

TEST_F(PassageWheel, WithoutMotionIsTheBaselineTurned) {
  for (std::string const blades :
       {"factors = [0]", "factors = [0, -0.0]\n",
        "sequence = [\"A\", \"B\"]\n[[wheel.blade]]\nname = \"A\"\nfactor = 0\n[[wheel.blade]]\nname = "
        "\"B\"\n[[wheel.blade.motion]]\npatches = \"blade\"\nrule = \"fixed\"\n"}) {
    WheelFile const wheel = this->wheel("passage.toml", blades);
    wheel.expect_watertight();
    EXPECT_EQ(distance_from(wheel, 0, n_blades, mesh), 0) << blades;
    for (int p = 1; p < n_blades; ++p) EXPECT_LT(distance_from(wheel, p, n_blades, mesh), 2e-15 * size()) << blades;
  }
}

TEST_F(PassageWheel, WithItsSidesOpenedForEqualBladesIsTheSame) {
  WheelFile const closed = wheel("passage.toml", "factors = [0.5]");
  WheelFile const opened = wheel("passage.toml",
                                 "sequence = [\"A\", \"B\"]\n[[wheel.blade]]\nname = \"A\"\nfactor = "
                                 "0.5\n[[wheel.blade]]\nname = \"B\"\nfactor = 0.5000000000000001\n");
  for (int p = 0; p < n_blades; ++p) EXPECT_LT(distance_between(opened, p, closed, p, n_blades), 1e-13 * size()) << p;
}

TEST_F(PassageWheel, FactorsMultiplyTheTablesOfARedesign) {
  std::string const formula = text("passage.toml");
  auto const from = formula.find("rule    = \"formula\""), to = formula.find("[[motion]]", from);
  auto const redesign = [&](std::string const& file, std::string const& tables) {
    folder.write(file, formula.substr(0, from) + "rule = \"sections\"\n" + tables + formula.substr(to));
  };
  redesign("passage.toml", "stagger_deg = 2\nlean = [[0, 0], [1, 0.002]]\n");
  WheelFile const wheel = this->wheel("passage.toml", "factors = [1, -2, 0.5, 0]\n");
  redesign("twice.toml", "stagger_deg = -4\nlean = [[0, 0], [1, -0.004]]\n");
  WheelFile const twice = this->wheel("twice.toml", "");
  WheelFile const once = this->wheel("passage.toml", "");
  auto const blade_differs = [&](int p, WheelFile const& other) {
    double worst = 0;
    for (auto const& patch : mesh.patches) {
      if (patch.families.front() != "blade") continue;
      auto const& zone = mesh.zones[patch.zone];
      for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
        for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
          for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) {
            auto const n = std::size_t(zone.node({i, j, k}) - zone.first_node);
            worst = std::max(
                worst, distance(wheel.zones.at(name(zone.name, p)).at(n), other.zones.at(name(zone.name, p)).at(n)));
          }
    }
    return worst;
  };
  for (int const p : {0, 4}) EXPECT_LT(blade_differs(p, once), 1e-13 * size()) << p;
  for (int const p : {1, 5}) EXPECT_LT(blade_differs(p, twice), 1e-13 * size()) << p;
  for (int const p : {1, 2, 3}) EXPECT_GT(blade_differs(p, once), 1e-4 * size()) << p;
  for_angles(wheel, 3, "blade", [&](Index n, Vec3 const& x, Vec3 const& y) { EXPECT_LT(distance(x, y), 1e-13) << n; });
}

TEST_F(PassageWheel, AFactorOfNothingIsRefused) {
  std::string still = text("passage.toml");
  auto const from = still.find("rule    = \"formula\""), to = still.find("[[motion]]", from);
  still.replace(from, to - from, "rule = \"fixed\"\n");
  EXPECT_NE(refusal(still, "factors = [1, 3]\n").find("nothing to multiply"), std::string::npos);
}

TEST_F(PassageWheel, OfDifferentBladesIsWatertight) {
  WheelFile const wheel = this->wheel("passage.toml", two_blades);
  EXPECT_EQ(wheel.n_periodic(), 0);
  wheel.expect_watertight();
}

TEST_F(PassageWheel, GivesEveryBladeItsOwnMotion) {
  WheelFile const wheel = this->wheel("passage.toml", two_blades);
  std::string const sequence = "AAABABBC";
  for (int p = 0; p < n_blades; ++p)
    for_angles(wheel, p, "blade", [&](Index n, Vec3 const& x, Vec3 const& y) {
      auto const a = cylindrical(x), b = cylindrical(y);
      double const f = sequence[p] == 'A' ? 1 : 0.5;
      bool const c = sequence[p] == 'C';
      EXPECT_NEAR(b.angle - a.angle, c ? -0.3 * a.axial : f * (0.06 * std::sin(a.axial / 0.05) + 0.1 * a.axial), 1e-14)
          << n;
      EXPECT_NEAR(b.axial - a.axial, c ? 0 : f * 0.1 * (a.radius - 0.12) * a.axial, 1e-15) << n;
    });
}

TEST_F(PassageWheel, SharesTheMotionOfAPeriodicSideEvenly) {
  WheelFile const all_a = wheel("passage.toml", ""), all_b = wheel("passage.toml", "factors = [0.5]");
  WheelFile const mixed = wheel("passage.toml", two_blades);
  auto const sides_of = [&](int p, int side, auto const& visit) {
    for (auto const& face : mesh.interfaces) {
      if (!face.periodic || (face.periodic->rotation_angle_rad.x > 0) != (side == 0)) continue;
      auto const& zone = mesh.zones[face.zone];
      for (int k = face.range.begin[2]; k < face.range.end[2]; ++k)
        for (int j = face.range.begin[1] + 1; j < face.range.end[1] - 1; ++j)  // end walls correct the radius
          for (int i = face.range.begin[0]; i < face.range.end[0]; ++i) {
            auto const n = std::size_t(zone.node({i, j, k}) - zone.first_node);
            auto const at = [&](WheelFile const& w) {
              return cylindrical(Turn(Axis{}, -p, n_blades)(w.zones.at(name(zone.name, p)).at(n)));
            };
            visit(at(all_a), at(all_b), at(mixed));
          }
    }
  };
  int checked = 0;
  sides_of(3, 0, [&](auto const& a, auto const& b, auto const& m) {  // between an A and a B
    ++checked;
    EXPECT_NEAR(m.angle, 0.5 * (a.angle + b.angle), 1e-9);
    EXPECT_NEAR(m.axial, 0.5 * (a.axial + b.axial), 1e-9);
  });
  sides_of(1, 1, [&](auto const& a, auto const&, auto const& m) {  // between two As
    ++checked;
    EXPECT_NEAR(m.angle, a.angle, 1e-14);
    EXPECT_NEAR(m.axial, a.axial, 1e-14);
  });
  EXPECT_GT(checked, 100);
}

TEST_F(PassageWheel, KeepsInletAndOutletInPlaceAndOnEndWalls) {
  WheelFile const wheel = this->wheel("passage.toml", two_blades);
  for (int p = 0; p < n_blades; ++p)
    for (std::string const end : {"inlet", "outlet"})
      for_angles(wheel, p, end, [&](Index n, Vec3 const& x, Vec3 const& y) {
        EXPECT_NEAR(y.x, x.x, 1e-15) << n;
        EXPECT_NEAR(cylindrical(y).radius, cylindrical(x).radius, 1e-14) << n;
      });
}

TEST_F(PassageWheel, TurnsWithItsSequence) {
  WheelFile const wheel = this->wheel("passage.toml", two_blades);
  std::string shifted = two_blades;
  shifted.replace(0, shifted.find(']') + 1, R"(sequence = ["A", "A", "B", "A", "B", "B", "C", "A"])");
  WheelFile const other = this->wheel("passage.toml", shifted);
  for (int p = 0; p < n_blades; ++p)
    EXPECT_LT(distance_between(wheel, (p + 1) % n_blades, other, p, n_blades), 1e-14 * size()) << p;
}

TEST_F(PassageWheel, IsTheSameBitsOnOneThread) {
  WheelFile const two = wheel("passage.toml", two_blades);
  std::string const bytes = text("wheel.cgns");
  EXPECT_EQ(gridmorph("--threads 1 wheel wheel.toml"), 0);
  WheelFile const one(folder.file("wheel.cgns"));
  for (auto const& [zone, values] : two.zones) {
    EXPECT_EQ(values.x, one.zones.at(zone).x);
    EXPECT_EQ(values.y, one.zones.at(zone).y);
    EXPECT_EQ(values.z, one.zones.at(zone).z);
  }
}

TEST_F(PassageWheel, InPartStaysPeriodicByTheAngleOfThePart) {
  WheelFile const part = wheel("passage.toml",
                               "passages = 3\nsequence = [\"A\", \"B\", \"B\"]\n[[wheel.blade]]\nname = "
                               "\"A\"\n[[wheel.blade]]\nname = \"B\"\nfactor = 0.2\n");
  EXPECT_EQ(part.zones.size(), 3 * mesh.zones.size());
  part.expect_watertight();
  EXPECT_EQ(part.n_periodic(), 6);  // three zones on either side
  double worst = 0;
  part.for_each_pair(
      [&](FileConnection const& c, FileZone const& own, std::size_t p, FileZone const& donor, std::size_t q) {
        if (!c.periodic) return;
        EXPECT_NEAR(std::abs(c.angle[0]), 2 * pi * 3 / n_blades, 1e-6);
        worst = std::max(worst, distance(Turn(Axis{}, c.angle[0] > 0 ? 3 : -3, n_blades)(own.at(p)), donor.at(q)));
      });
  EXPECT_LT(worst, 2e-16);
  // The whole wheel of the same blades, repeated, where the part does not end; 3 does not go into 8, so the ends
  // differ.
  WheelFile const whole = wheel("passage.toml",
                                "sequence = [\"A\", \"B\", \"B\", \"A\", \"B\", \"B\", \"A\", "
                                "\"B\"]\n[[wheel.blade]]\nname = \"A\"\n[[wheel.blade]]\nname = \"B\"\nfactor = 0.2\n");
  EXPECT_LT(distance_between(part, 1, whole, 1, n_blades), 1e-15 * size());
  EXPECT_LT(distance_between(part, 0, whole, 3, n_blades), 1e-14 * size());
}

TEST_F(PassageWheel, InPartIsWatertightHoweverItsZonesAreNumbered) {
  for (unsigned const seed : {1U, 2U, 3U}) {
    write_mesh(folder.file("passage.cgns"), scramble(mesh, {.seed = seed, .cuts = 2}).mesh);
    this->wheel("passage.toml", "passages = 3\n").expect_watertight();
  }
}

TEST_F(PassageWheel, CanNameFamiliesByPassage) {
  WheelFile const shared = wheel("passage.toml", ""), suffixed = wheel("passage.toml", "families = \"suffixed\"\n");
  EXPECT_EQ(shared.families.size(), mesh.families.size());
  EXPECT_EQ(suffixed.families.size(), n_blades * mesh.families.size());
  int blades = 0;
  for (auto const& [name, zone] : suffixed.zones)
    for (auto const& [bc, family] : zone.family_of_bc) {
      EXPECT_EQ(family.substr(family.size() - 4), name.substr(name.size() - 4));
      blades += family == "blade_P03" ? 1 : 0;
    }
  EXPECT_EQ(blades, 4);  // the ring's four zones
}

TEST_F(PassageWheel, IsMeasuredPassageByPassage) {
  wheel("passage.toml", std::string(two_blades));
  EXPECT_EQ(gridmorph("wheel wheel.toml --report report.json"), 0);
  std::string const report = text("report.json");
  expect_all_in(report, {"\"passages_of_wheel\": 8", "\"passage\": 8", "\"largest_seam_gap\"", "determinant_3x3x3"});
  expect_all_in(text("out"), {"8 of 8 passages", "wrote", "wheel.cgns"});
}

TEST_F(PassageWheel, IsRefusedWithALineForEveryMistake) {
  std::string const rules = text("passage.toml");
  expect_all_in(refusal(rules, "sequence = [\"A\"]\n"), {"wheel.toml:", "sequence", "\"A\" is the name of no"});
  expect_all_in(refusal(rules, "factors = [1, 2, 3]\n"), {"factors", "3 entries", "8 passages"});
  expect_all_in(refusal(rules, "passages = 9\n"), {"passages: 9", "8 in 360 degrees"});
  expect_all_in(refusal(rules, "zones = \"rotor*\"\n"), {"no zone of a row", "ring_le"});
  expect_all_in(refusal(rules, "sequense = [\"A\"]\n"), {"sequense", "sequence"});
  expect_all_in(refusal(rules,
                        "sequence = [\"A\"]\n[[wheel.blade]]\nname = \"A\"\n[[wheel.blade.motion]]\npatches = "
                        "\"hub\"\nrule = \"fixed\"\n"),
                {"'hub'", "same patches"});
  expect_all_in(
      refusal(rules, "[[wheel.blade]]\nname = \"A\"\n[[wheel.blade.motion]]\npatches = \"hub\"\nrule = \"free\"\n"),
      {"found free"});
}

TEST_F(PassageWheel, OfDifferentBladesNeedsARuleForItsSides) {
  std::string rules = text("passage.toml");
  auto const begin = rules.find("[[motion]]\npatches = \"type:periodic\""), end = rules.find("[[motion]]", begin + 1);
  rules.erase(begin, end - begin);
  expect_all_in(refusal(rules, two_blades), {"between passages with different blades", "follow"});
  folder.write("free.toml", rules);
  wheel("free.toml", "").expect_watertight();  // equal blades need none
}

TEST_F(PassageWheel, WithCellsTurnedOverIsNotWritten) {
  folder.write("wheel.toml",
               text("passage.toml") + "\n[wheel]\noutput = \"wheel.cgns\"\nfactors = [1, 1, 1, 40, 1, 1, 1, 1]\n");
  EXPECT_EQ(gridmorph("wheel wheel.toml"), 4) << text("err");
  EXPECT_FALSE(std::filesystem::exists(folder / "wheel.cgns"));
  expect_all_in(text("err"), {"passage 4", "is not written"});
}

TEST_F(PassageWheel, NeedsItsTableInTheCaseFile) {
  EXPECT_EQ(gridmorph("wheel passage.toml"), 2);
  expect_all_in(text("err"), {"no [wheel]"});
}

}  // namespace
}  // namespace gridmorph::test
