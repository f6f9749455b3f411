// Running clearances under a casing that is of revolution nowhere, of passages, wheels and sequences, against the
// distance from its formula.
#include "support/contoured_wall.hpp"
#include "support/expect_error.hpp"
#include "wheel/wheel_run.hpp"

#include <generators/passage_demo.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>

namespace gridmorph::test {
namespace {

constexpr int n_blades = 8;
constexpr double hub = 0.09, casing = 0.167, inlet = -0.16, outlet = 0.20;

class ContouredClearance : public WheelTest {
 protected:
  void SetUp() override {
    PassageOptions options;
    options.nodes = 60'000;
    options.blades = n_blades;
    options.hub = {hub, hub, 0, 0};
    options.casing = {casing, casing, 0, 0};
    options.tip = BladeTip::flat;
    options.tip_gap = 0.03;
    plain = make_passage(options);
    mesh = plain;
    mesh.coordinates = Coordinates(plain.n_nodes());
    for (Index n = 0; n < mesh.n_nodes(); ++n) mesh.coordinates.set(n, under(wall, plain.coordinates[n]));
    write_mesh(folder.file("blocks.cgns"), mesh);
    write_mesh(folder.file("elements.cgns"), as_hexahedra(mesh));
    write_mesh(folder.file("plain.cgns"), plain);
    for (auto const& patch : plain.patches) {
      if (patch.families.front() != "tip") continue;
      auto const& zone = plain.zones[patch.zone];
      for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
        for (int j = patch.range.begin[1]; j < patch.range.end[1]; ++j)
          for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) tip.push_back(zone.node({i, j, k}));
    }
  }
  /// The annulus stretched to a wall, evenly between hub and casing.
  static Vec3 under(ContouredWall const& to, Vec3 const& x) {
    double const r = std::hypot(x.y, x.z), angle = std::atan2(x.z, x.y), h = (r - hub) / (casing - hub);
    return ContouredWall::at_radius(x.x, angle, r + h * (to.at(x.x, angle) - casing));
  }
  [[nodiscard]] double smallest(Mesh const& of, ContouredWall const& to,
                                std::function<Vec3(Vec3 const&)> const& moved) const {
    double out = std::numeric_limits<double>::infinity();
    for (Index const n : tip) out = std::min(out, to.distance_of(moved(of.coordinates[n])));
    return out;
  }
  static std::string case_of(std::string const& input, bool axis, std::string const& blade) {
    return std::string("[mesh]\n") + (input == "elements.cgns" ? "blocks = \"off\"\n" : "") + "input = \"" + input +
           "\"\noutput = \"morphed.cgns\"\n" + (axis ? "axis = \"x\"\n" : "") +
           "[[motion]]\npatches = [\"blade\", \"tip\"]\nrule = \"formula\"\n" + blade +
           "[[motion]]\npatches = [\"hub\", \"inlet\", \"outlet\"]\nrule = \"fixed\"\n" +
           "[[clearance]]\nname = \"rotor\"\ntips = \"tip\"\nwalls = \"case\"\n";
  }
  [[nodiscard]] nlohmann::json clearance(std::string const& case_text) const {
    folder.write("one.toml", case_text);
    EXPECT_LE(gridmorph("morph one.toml --report one.json"), 1) << text("err");
    return nlohmann::json::parse(text("one.json"))["clearances"][0];
  }

  ContouredWall const wall{casing, 0.001, n_blades, inlet, outlet};
  Mesh plain, mesh;
  std::vector<Index> tip;
};

/// What facets are off the wall that they are on, in gaps of 0.0023.
constexpr double facets = 2e-6;
std::string const fixed_case = "[[motion]]\npatches = \"case\"\nrule = \"fixed\"\n";

TEST_F(ContouredClearance, OfAPassageIsTheDistanceFromTheWallAsItIs) {
  // Along the radius of the blade's middle and towards its neighbour: no axis is needed for any of it.
  std::string const blade =
      "dy = \"0.0008 * (sqrt(y^2 + z^2) - 0.09) / 0.077\"\ndz = \"0.002 * (sqrt(y^2 + z^2) - 0.09) / 0.077\"\n";
  auto const moved = [](Vec3 const& x) {
    double const h = (std::hypot(x.y, x.z) - 0.09) / 0.077;
    return x + Vec3{0, 0.0008 * h, 0.002 * h};
  };
  double const before = smallest(mesh, wall, [](Vec3 const&x) { return x; }), after = smallest(mesh, wall, moved);
  EXPECT_LT(after, before - 3e-4);
  for (std::string const input : {"blocks.cgns", "elements.cgns"})
    for (bool const axis : {false, true}) {
      auto const found = clearance(case_of(input, axis, blade) + fixed_case);
      EXPECT_EQ(found["distance"], "surface");
      EXPECT_NEAR(double(found["before"]["smallest"]), before, facets) << input;
      EXPECT_NEAR(double(found["by_rule"]["smallest"]), after, facets) << input;
      EXPECT_NEAR(double(found["after"]["smallest"]), after, facets) << input;
      expect_all_in(text("out"), {"distance", "surface"});
    }
}

TEST_F(ContouredClearance, IsMeridionalUnderACasingOfRevolution) {
  std::string const blade = "dy = \"0.0008 * (sqrt(y^2 + z^2) - 0.09) / 0.077\"\n";
  auto const by_profile = clearance(case_of("plain.cgns", true, blade) + fixed_case),
             by_surface = clearance(case_of("plain.cgns", false, blade) + fixed_case);
  EXPECT_EQ(by_profile["distance"], "meridional");
  EXPECT_EQ(by_surface["distance"], "surface") << "without an axis";
  for (std::string const when : {"before", "by_rule", "after"})
    for (std::string const which : {"smallest", "mean"})
      EXPECT_NEAR(double(by_profile[when][which]), double(by_surface[when][which]), facets) << when << which;
}

TEST_F(ContouredClearance, TakesACasingThatMovesWhereItIsAfterwards) {
  // A casing of revolution becomes contoured: both distances are those to surfaces.
  ContouredWall const round{casing, 0, n_blades, inlet, outlet};
  std::string const blade = "dy = \"0\"\n",
                    casing_moves =
                        "[[motion]]\npatches = \"case\"\nrule = \"formula\"\n"
                        "dr = \"0.001 * cos(8 * theta + 0.4) * sin(pi * (axial + 0.16) / 0.36)\"\n"
                        "[[motion]]\npatches = \"type:periodic\"\nrule = \"free\"\n";
  auto const found = clearance(case_of("plain.cgns", true, blade) + casing_moves);
  auto const still = [](Vec3 const& x) { return x; };
  EXPECT_EQ(found["distance"], "surface");
  EXPECT_NEAR(double(found["before"]["smallest"]), smallest(plain, round, still), facets);
  EXPECT_NEAR(double(found["after"]["smallest"]), smallest(plain, wall, still), facets);
}

TEST_F(ContouredClearance, OfAWheelEveryPassageHasThatOfItsOwnBlade) {
  std::vector<double> const factors{1, 0.5, 0, -1, 1, 1.5, -0.5, 0};
  std::string const blade = "dtheta = \"0.006 * (r - 0.09) / 0.077\"\ndr = \"0.0004 * (r - 0.09) / 0.077\"\n";
  std::vector<double> wanted;
  for (double const f : factors)
    wanted.push_back(smallest(mesh, wall, [&](Vec3 const& x) {
      double const r = std::hypot(x.y, x.z), share = f * (r - 0.09) / 0.077;
      return ContouredWall::at_radius(x.x, std::atan2(x.z, x.y) + 0.006 * share, r + 0.0004 * share);
    }));
  for (std::string const input : {"blocks.cgns", "elements.cgns"}) {
    std::string list;
    for (double const f : factors) list += fmt::format("{}{}", list.empty() ? "" : ", ", f);
    folder.write("wheel.toml", case_of(input, true, blade) + fixed_case +
                                   "[[motion]]\npatches = \"type:periodic\"\nrule = \"fixed\"\n" +
                                   "[wheel]\noutput = \"w.cgns\"\nfactors = [" + list + "]\n");
    ASSERT_LE(gridmorph("wheel wheel.toml --report w.json"), 1) << text("err");
    auto const passages = nlohmann::json::parse(text("w.json"))["passages"];
    ASSERT_EQ(passages.size(), factors.size());
    for (std::size_t p = 0; p < factors.size(); ++p) {
      auto const& found = passages[p]["clearances"][0];
      EXPECT_EQ(found["distance"], "surface");
      EXPECT_NEAR(double(found["by_rule"]["smallest"]), wanted[p], facets) << input << p;
      EXPECT_NEAR(double(found["after"]["smallest"]), wanted[p], facets) << input << p;
      // The place is one of the wheel.
      Vec3 const at{found["after"]["at"][0], found["after"]["at"][1], found["after"]["at"][2]};
      EXPECT_NEAR(wall.distance_of(at), double(found["after"]["smallest"]), facets);
    }
    expect_all_in(text("out"), {"passage 6: rotor", "surface", "smallest of all"});
  }
}

TEST_F(ContouredClearance, GoesOnBehindThePeriodicSide) {
  // The row turns by more than half a pitch: blades end up under the wall of the next passage.
  folder.write("one.toml",
               "[mesh]\ninput = \"blocks.cgns\"\noutput = \"morphed.cgns\"\naxis = \"x\"\n"
               "[[motion]]\npatches = [\"blade\", \"tip\"]\nrule = \"formula\"\ndtheta = \"0.5\"\n"
               "[[motion]]\npatches = \"hub\"\nrule = \"slip\"\nsurface = \"revolution\"\n"
               "[[motion]]\npatches = \"case\"\nrule = \"slip\"\nsurface = \"baseline\"\n" +
                   row_followers + "[[clearance]]\ntips = \"tip\"\nwalls = \"case\"\n[guard]\nwrite_inverted = true\n");
  ASSERT_LE(gridmorph("morph one.toml --report one.json"), 1) << text("err");
  auto const found = nlohmann::json::parse(text("one.json"))["clearances"][0];
  double const turned = smallest(mesh, wall, [](Vec3 const& x) {
    return ContouredWall::at_radius(x.x, std::atan2(x.z, x.y) + 0.5, std::hypot(x.y, x.z));
  });
  EXPECT_NEAR(double(found["by_rule"]["smallest"]), turned, facets);
  EXPECT_GT(std::abs(turned - double(found["before"]["smallest"])), 100 * facets);
}

TEST_F(ContouredClearance, OfASequenceEveryStepHasItsOwn) {
  std::string text_of_case =
      case_of("blocks.cgns", false, "dy = \"0.0006 * sin(2 * pi * t) * (sqrt(y^2 + z^2) - 0.09) / 0.077\"\n");
  text_of_case.erase(text_of_case.find("output"), std::string("output = \"morphed.cgns\"\n").size());
  folder.write("one.toml", text_of_case + fixed_case + "[sequence]\nsteps = 4\noutput = \"step_{step}.cgns\"\n");
  ASSERT_LE(gridmorph("morph one.toml --report one.json"), 1) << text("err");
  auto const steps = nlohmann::json::parse(text("one.json"))["sequence"]["steps"];
  ASSERT_EQ(steps.size(), 4U);
  for (auto const& step : steps) {
    double const now = 0.0006 * std::sin(2 * ContouredWall::pi * double(step["time"]));
    auto const& found = step["clearances"][0];
    EXPECT_NEAR(double(found["after"]["smallest"]),
                smallest(mesh, wall,
                         [&](Vec3 const& x) {
                           return x + Vec3{0, now * (std::hypot(x.y, x.z) - 0.09) / 0.077, 0};
                         }),
                facets);
    EXPECT_EQ(found["distance"], "surface");
  }
  expect_all_in(text("out"), {"in the mesh, step", "distance", "surface"});
}

}  // namespace
}  // namespace gridmorph::test
