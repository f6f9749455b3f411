// Passages with a gap over a flat tip, a squealer or a groove: what the morph has to keep where blade and case come
// close.
//
// A tip lies at a constant span fraction, so the height of the gap after a motion follows from the formula of the
// motion.
#include "support/morph_run.hpp"
#include "support/motions.hpp"
#include "support/periodic_match.hpp"
#include "support/scramble.hpp"

#include <generators/passage.hpp>
#include <generators/passage_motion.hpp>
#include <gridmorph/plan/trim_note.hpp>
#include <gridmorph/quality/quality.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace gridmorph::test {
namespace {

constexpr double size = 0.67;  // largest radius

PassageOptions passage_with(BladeTip tip, PassageOptions::Layout layout) {
  PassageOptions o;
  o.nodes = 24'000;
  o.tip = tip;
  o.layout = layout;
  return o;
}

struct Change {
  char const* name;
  PassageMotion motion;
};

std::vector<Change> changes() {
  return {{"Rotation", rotated_sections()},
          {"Chord", chord_redesign()},
          {"GapHalved", {"gap", 0, {}, 0.5}},
          {"GapToAFifth", {"gap", 0, {}, 0.2}},
          {"GapDoubled", {"gap", 0, {}, 2}},
          {"TurnedAndGapHalved", {"turned", -6, {{0, 1}, {0.5, 1.04}, {1, 0.96}}, 0.5}}};
}

Motion motion_of(PassageOptions const& options, PassageMotion const& change) {
  Motion m = motion({rule(blade_families(options.tip),
                          function_rule([=](Vec3 const& p) { return passage_displacement(options, change, p); })),
                     rule({"inlet", "outlet"}, CircumferentialSlideRule{{"blade"}}),
                     rule({"type:periodic"}, FollowRule{{"blade"}}),
                     rule({"hub", "case"}, SlipRule{SlipRule::Surface::revolution, {}, {}})});
  return m;
}

PlanOptions near_field_of_the_blade() {
  PlanOptions options;
  options.boundary_layers = {{{"blade"}, BoundaryLayer::Extent::block, 0, 0, BoundaryLayer::Mode::rotate}};
  return options;
}

double radius_of(Vec3 const& p) { return std::hypot(p.y, p.z); }

/// By how much heights of cells change over the tips, as a factor on what the gap itself changes by: smallest and
/// largest. Columns are followed from the tip to the case, through all zones.
struct Shares {
  double lowest = 1e9, highest = 0, lowest_gap = 1e9, highest_gap = 0;
  int columns = 0;
};

Shares shares_over_tips(Outcome const& out) {
  Shares s;
  for (Patch const& patch : out.mesh.patches) {
    if (patch.families.front() != "tip") continue;
    Zone const& zone = out.mesh.zones[patch.zone];
    int const step = patch.range.begin[1] == 0 ? 1 : -1;
    for (int k = patch.range.begin[2]; k < patch.range.end[2]; ++k)
      for (int i = patch.range.begin[0]; i < patch.range.end[0]; ++i) {
        auto const height = [&](Coordinates const& x, int a, int b) {
          return std::abs(radius_of(x[zone.node({i, a, k})]) - radius_of(x[zone.node({i, b, k})]));
        };
        int const last = step > 0 ? zone.extent[1] - 1 : 0, first = patch.range.begin[1];
        double const gap = height(out.morphed.position, first, last) / height(out.mesh.coordinates, first, last);
        s.lowest_gap = std::min(s.lowest_gap, gap);
        s.highest_gap = std::max(s.highest_gap, gap);
        for (int j = first; j != last; j += step) {
          double const cell = height(out.morphed.position, j, j + step) / height(out.mesh.coordinates, j, j + step);
          s.lowest = std::min(s.lowest, cell / gap);
          s.highest = std::max(s.highest, cell / gap);
        }
        ++s.columns;
      }
  }
  return s;
}

void expect_nothing_inverted(Outcome const& out) {
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(out.morphed.position);
  input.baseline = views(out.mesh.coordinates);
  EXPECT_EQ(measure_quality(Kokkos::DefaultHostExecutionSpace(), out.mesh, input).far_field.inverted, 0);
}

void expect_periodic_copies_to_match(Outcome const& out) {
  std::map<Index, Vec3> u;
  for (Index n = 0; n < out.mesh.n_nodes(); ++n) u[n] = out.u(n);
  PeriodicMatch const match = periodic_match(out.mesh, u);
  EXPECT_GT(match.pairs, 0);
  EXPECT_LE(match.apart, 1e-12 * size);
}

void expect_nodes_on_hub_and_case(Outcome const& out) {
  for (std::size_t p = 0; p < out.mesh.patches.size(); ++p) {
    Patch const& patch = out.mesh.patches[p];
    if (patch.families.front() != "hub" && patch.families.front() != "case") continue;
    SlipSurface const* const surface = out.prepared.surface.slip_surface(int(p));
    ASSERT_TRUE(surface);
    auto const off = [&](Vec3 const& at) { return radius_of(at) - surface->profile(at.x); };
    IndexRange const& r = patch.range;
    for (int k = r.begin[2]; k < r.end[2]; ++k)
      for (int j = r.begin[1]; j < r.end[1]; ++j)
        for (int i = r.begin[0]; i < r.end[0]; ++i) {
          Index const n = out.mesh.zones[patch.zone].node({i, j, k});
          ASSERT_NEAR(off(out.morphed.position[n]), off(out.mesh.coordinates[n]), 1e-10 * size) << patch.name;
        }
  }
}

/// Largest change of the first cell height off the sides of the blade, relative.
double first_height_change(Outcome const& out) {
  double worst = 0;
  for (Patch const& patch : out.mesh.patches) {
    if (patch.families.front() != "blade") continue;
    Zone const& zone = out.mesh.zones[patch.zone];
    IndexRange const& r = patch.range;
    for (int j = r.begin[1]; j < r.end[1]; ++j)
      for (int i = r.begin[0]; i < r.end[0]; ++i) {
        auto const height = [&](Coordinates const& x) {
          return distance(x[zone.node({i, j, 0})], x[zone.node({i, j, 1})]);
        };
        worst = std::max(worst, std::abs(height(out.morphed.position) / height(out.mesh.coordinates) - 1));
      }
  }
  return worst;
}

struct Case {
  BladeTip tip;
  PassageOptions::Layout layout;
};

class TipGaps : public ::testing::TestWithParam<Case> {
 protected:
  PassageOptions const options = passage_with(GetParam().tip, GetParam().layout);
  Mesh const mesh = make_passage(options);
};

INSTANTIATE_TEST_SUITE_P(Over, TipGaps,
                         ::testing::Values(Case{BladeTip::flat, PassageOptions::Layout::whole_faces},
                                           Case{BladeTip::squealer, PassageOptions::Layout::five_zones},
                                           Case{BladeTip::groove, PassageOptions::Layout::whole_faces},
                                           Case{BladeTip::groove, PassageOptions::Layout::five_zones}),
                         [](auto const& info) {
                           return std::string(name(info.param.tip)) +
                                  (info.param.layout == PassageOptions::Layout::whole_faces ? "_whole_faces"
                                                                                            : "_five_zones");
                         });

TEST_P(TipGaps, CellsShareEvenlyWhatTheGapChangesByAndNoneIsInverted) {
  for (Change const& change : changes()) {
    SCOPED_TRACE(change.name);
    Outcome const out = morph(mesh, motion_of(options, change.motion), near_field_of_the_blade());
    expect_nothing_inverted(out);
    expect_periodic_copies_to_match(out);
    expect_nodes_on_hub_and_case(out);
    Shares const s = shares_over_tips(out);
    ASSERT_GT(s.columns, 20);
    // The case is the smooth curve through its nodes.
    EXPECT_NEAR(s.lowest_gap, change.motion.gap_factor, 0.005);
    EXPECT_NEAR(s.highest_gap, change.motion.gap_factor, 0.005);
    EXPECT_GE(s.lowest, 0.999);
    EXPECT_LE(s.highest, 1.001);
    EXPECT_LE(first_height_change(out), change.motion.chord_factor.size() > 3 ? 0.07 : 0.01);
  }
}

/// What `follow` asks of the sides of the passage beside the blade: to the tip as the blade does, and of the gap above
/// it the same share at all heights. So no node of theirs has to be put back onto the case.
TEST_P(TipGaps, SidesFollowTheBladeToItsTipAndShareTheGapAbove) {
  double const factor = 0.2, gap = options.tip_gap;
  Outcome const out = morph(mesh, motion_of(options, {"gap", 0, {}, factor}), near_field_of_the_blade());
  SlipSurface const *hub = nullptr, *casing = nullptr;
  for (std::size_t p = 0; p < out.mesh.patches.size(); ++p) {
    if (out.mesh.patches[p].families.front() == "hub") hub = out.prepared.surface.slip_surface(int(p));
    if (out.mesh.patches[p].families.front() == "case") casing = out.prepared.surface.slip_surface(int(p));
  }
  ASSERT_TRUE(hub && casing);
  auto const span = [&](Vec3 const& p) {
    return (radius_of(p) - hub->profile(p.x)) / (casing->profile(p.x) - hub->profile(p.x));
  };
  int below = 0, above = 0;
  for (Interface1to1 const& side : out.mesh.interfaces) {
    if (!side.periodic) continue;
    IndexRange const& r = side.range;
    for (int k = r.begin[2]; k < r.end[2]; ++k)
      for (int j = r.begin[1]; j < r.end[1]; ++j)
        for (int i = r.begin[0]; i < r.end[0]; ++i) {
          Index const n = out.mesh.zones[side.zone].node({i, j, k});
          Vec3 const p = out.mesh.coordinates[n];
          if (std::abs(p.x) > 0.03) continue;
          double const h = span(p), tip = 1 - gap;
          double const wanted = h <= tip ? h * (1 - factor * gap) / tip : 1 - factor * (1 - h);
          // The sections of a blade with a groove end at its floor, where it opens at the edges.
          double const tolerance = options.tip == BladeTip::groove ? 5e-4 : 1e-5;
          EXPECT_NEAR(span(out.morphed.position[n]), wanted, tolerance) << h;
          ++(h <= tip ? below : above);
        }
  }
  EXPECT_GT(below, 50);
  EXPECT_GT(above, 20);
  EXPECT_TRUE(trims(out.plan(), out.prepared.planned.boundary, out.prepared.surface, out.boundary).empty());
}

TEST_P(TipGaps, ByDefaultAllMovingWallsGetANearFieldButThoseAtTheGap) {
  Outcome const out = morph(mesh, motion_of(options, gap_halved()), [] {
    PlanOptions all = near_field_of_the_blade();
    all.boundary_layers.front().walls.clear();
    return all;
  }());
  expect_nothing_inverted(out);
  Shares const s = shares_over_tips(out);
  EXPECT_GE(s.lowest, 0.999);
  EXPECT_LE(s.highest, 1.001);
}

TEST_P(TipGaps, NearFieldsOfSoManyLayersLeaveTheGapAlone) {
  PlanOptions layers = near_field_of_the_blade();
  layers.boundary_layers.front() = {{"blade", "tip"}, BoundaryLayer::Extent::layers, 3, 0, BoundaryLayer::Mode::rotate};
  Outcome const out = morph(mesh, motion_of(options, gap_halved()), layers);
  expect_nothing_inverted(out);
  Shares const s = shares_over_tips(out);
  EXPECT_GE(s.lowest, 0.999);
  EXPECT_LE(s.highest, 1.001);
}

TEST_P(TipGaps, AreTheSameHoweverTheMeshIsStored) {
  PassageMotion const change{"turned", -6, {{0, 1}, {0.5, 1.04}, {1, 0.96}}, 0.5};
  Outcome const plain = morph(mesh, motion_of(options, change), near_field_of_the_blade());
  for (unsigned const seed : {2u}) {
    ScrambledMesh scrambled = scramble(mesh, {seed, int(seed), true, true, true});
    Outcome const other = morph(std::move(scrambled.mesh), motion_of(options, change), near_field_of_the_blade());
    double worst = 0;
    for (Index n = 0; n < other.mesh.n_nodes(); ++n)
      worst = std::max(worst, distance(other.u(n), plain.u(scrambled.old_node[n])));
    EXPECT_LE(worst, 1e-12 * plain.plan().mesh_size) << seed;
  }
}

/// The case comes closer, moved by its own rule: lines run from wall to wall, and cells share the change as well.
TEST_P(TipGaps, ClosedByACaseThatMovesAreSharedEvenly) {
  double const closer = 0.5 * options.tip_gap * 0.21;
  auto const to_the_axis = [=](Vec3 const& p) { return -closer / radius_of(p) * Vec3{0, p.y, p.z}; };
  Motion const m = motion({rule(blade_families(options.tip), FixedRule{}), rule({"case"}, function_rule(to_the_axis)),
                           rule({"hub"}, SlipRule{SlipRule::Surface::revolution, {}, {}}),
                           rule({"inlet", "outlet"}, FreeRule{FreeRule::Constraint::axial})});
  Outcome const out = morph(mesh, m, near_field_of_the_blade());
  expect_nothing_inverted(out);
  Shares const s = shares_over_tips(out);
  EXPECT_GE(s.lowest, 0.99);
  EXPECT_LE(s.highest, 1.01);
}

}  // namespace
}  // namespace gridmorph::test
