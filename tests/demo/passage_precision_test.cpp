// The demo passage as meshers and solvers hand it over: in single precision, converted from it, with few digits.
#include "support/morph_run.hpp"
#include "support/motions.hpp"

#include <generators/passage.hpp>
#include <generators/passage_motion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace gridmorph::test {
namespace {

PassageOptions precision_passage() {
  PassageOptions options;
  options.nodes = 10'000;
  options.hub = {0.45, 0.45, 0, 0};
  options.casing = {0.66, 0.66, 0, 0};
  return options;
}

Motion precision_motion(PassageOptions const& options, PassageMotion const& change) {
  auto const blade = function_rule([=](Vec3 const& p) { return passage_displacement(options, change, p); });
  return motion({rule({"blade"}, blade), rule({"inlet", "outlet"}, CircumferentialSlideRule{{"blade"}}),
                 rule({"type:periodic"}, FollowRule{{"blade"}}),
                 rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution})});
}

/// Largest distance of two sets of nodes from each other.
double precision_gap(Coordinates const& a, Coordinates const& b) {
  double most = 0;
  for (Index n = 0; n < a.size(); ++n) most = std::max(most, distance(a[n], b[n]));
  return most;
}

/// Largest distance of nodes on hub and case from their cylinders.
double off_end_walls(Outcome const& run) {
  double most = 0;
  for (Patch const& patch : run.mesh.patches) {
    auto const& family = patch.families.front();
    if (family != "hub" && family != "case") continue;
    Zone const& zone = run.mesh.zones[patch.zone];
    IndexRange const& r = patch.range;
    for (int k = r.begin[2]; k < r.end[2]; ++k)
      for (int j = r.begin[1]; j < r.end[1]; ++j)
        for (int i = r.begin[0]; i < r.end[0]; ++i) {
          Vec3 const p = run.morphed.position[zone.node({i, j, k})];
          most = std::max(most, std::abs(std::hypot(p.y, p.z) - (family == "hub" ? 0.45 : 0.66)));
        }
  }
  return most;
}

TEST(PassagePrecision, RulesOfSeveralPatchesAgreeWithinTheRoundingOfCoordinates) {
  PassageOptions const options = precision_passage();
  for (PassageMotion const& change : {chord_redesign(), rotated_sections()}) {
    Outcome const exact = morph(make_passage(options), precision_motion(options, change));
    for (char const* const kind : {"single", "converted", "digits"}) {
      Mesh mesh = make_passage(options);
      auto const round = [&](double v) {
        if (kind[0] != 'd') return double(float(v));
        char text[40];
        std::snprintf(text, sizeof text, "%.7g", v);
        return std::strtod(text, nullptr);
      };
      for (Index n = 0; n < mesh.n_nodes(); ++n) {
        Vec3 const p = mesh.coordinates[n];
        mesh.coordinates.set(n, {round(p.x), round(p.y), round(p.z)});
      }
      for (Zone& zone : mesh.zones) zone.single_precision = kind[0] == 's';
      double const rounding = precision_gap(mesh.coordinates, exact.mesh.coordinates);
      Outcome const rounded = morph(mesh, precision_motion(options, change));
      EXPECT_LT(precision_gap(rounded.morphed.position, exact.morphed.position), 1e-4) << kind;
      EXPECT_LT(off_end_walls(rounded), 1.5 * rounding) << kind;
    }
  }
}

}  // namespace
}  // namespace gridmorph::test
