// Quality reports as text and JSON.
#include <gridmorph/report/measure_text.hpp>
#include <gridmorph/report/quality_json.hpp>
#include <gridmorph/report/quality_table.hpp>
#include <gridmorph/report/shortfalls.hpp>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <sstream>
#include <string>

namespace gridmorph {
namespace {

MeasureStatistics statistics(double min, double mean, double max, bool larger, Index3 const& cell) {
  return {min, mean, max, 0, cell, larger ? max : min};
}

QualityRegion region(double aspect_ratio, double determinant, Index3 const& cell) {
  QualityRegion r;
  r.cells = 1000;
  r.measure[int(Measure::aspect_ratio)] = statistics(1, aspect_ratio / 2, aspect_ratio, true, cell);
  r.measure[int(Measure::determinant_2x2x2)] = statistics(determinant + 0.01, 0.9, 1, false, cell);
  r.measure[int(Measure::determinant_3x3x3)] = statistics(determinant, 0.9, 1, false, cell);
  r.measure[int(Measure::minimum_angle_deg)] = statistics(21, 60, 90, false, cell);
  r.measure[int(Measure::equiangle_skewness)] = statistics(0, 0.2, 0.75, true, cell);
  r.measure[int(Measure::volume)] = statistics(1e-9, 1e-6, 1e-5, false, cell);
  r.measure[int(Measure::volume_ratio)] = statistics(1, 1.2, HUGE_VAL, true, cell);
  return r;
}

/// The numbers of the paper's Figure 14.
QualityReport baseline() {
  QualityReport report;
  report.zone_names = {"Zone A"};
  report.near_field = region(688.4, 0.734, {4, 0, 11});
  report.far_field = region(7.5, 0.593, {1, 2, 3});
  return report;
}
QualityReport morphed() {
  QualityReport report = baseline();
  report.against_baseline = true;
  report.near_field = region(688.6, 0.731, {4, 0, 11});
  report.far_field = region(7.9, 0.577, {1, 2, 3});
  report.near_field.measure[int(Measure::relative_displacement)] = statistics(0, 0.01, 0.02, true, {4, 0, 11});
  report.far_field.measure[int(Measure::relative_displacement)] = statistics(0, 0.1, 0.21, true, {1, 2, 3});
  return report;
}

QualityThresholds thresholds(double min_determinant, double max_relative_displacement = 0.25) {
  QualityThresholds out;
  out.cells.min_determinant = min_determinant;
  out.max_relative_displacement = max_relative_displacement;
  return out;
}

/// Cells of the far field that fell, the worst of them at (2, 3, 4) as people count.
void let_fall(QualityReport& report, Fall fall, Index cells, double worst) {
  report.far_field.fallen[std::size_t(fall)] = {cells, 0, {1, 2, 3}, 17, worst};
  if (fall == Fall::inverted) report.far_field.newly_inverted = cells;
}

bool has_line_with(std::string const& text, std::initializer_list<std::string_view> words) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    bool all = true;
    for (auto const& w : words) all = all && line.find(w) != std::string::npos;
    if (all) return true;
  }
  return false;
}

TEST(QualityTable, ShowsNearAndFarFieldBaselineAndMorphedSideBySide) {
  std::string const table = format_table(baseline(), morphed());
  EXPECT_TRUE(has_line_with(table, {"aspect ratio, max", "688.4", "688.6", "7.5", "7.9"}));
  EXPECT_TRUE(has_line_with(table, {"determinant 3x3x3, min", "0.734", "0.731", "0.593", "0.577"}));
  EXPECT_TRUE(has_line_with(table, {"relative displacement, max", "0.02", "0.21"}));
  EXPECT_TRUE(has_line_with(table, {"volume ratio, max", "unbounded"}));
  EXPECT_TRUE(has_line_with(table, {"far field", "determinant 3x3x3", "zone 'Zone A' cell (i 2, j 3, k 4)"}));
  EXPECT_EQ(table.find("falls short"), std::string::npos);
  EXPECT_EQ(table.find('\x1b'), std::string::npos);
}

TEST(QualityTable, LeavesOutWhatWasNotMeasured) {
  QualityReport only = baseline();
  only.near_field = {};
  std::string const table = format_table(only);
  EXPECT_EQ(table.find("near field"), std::string::npos);
  EXPECT_EQ(table.find("morphed"), std::string::npos);
  EXPECT_EQ(table.find("Walls"), std::string::npos);
  EXPECT_EQ(table.find("relative displacement"), std::string::npos);
  EXPECT_EQ(table.find("collapsed"), std::string::npos);
}

TEST(QualityTable, ShowsWallsWithTheirLargestChanges) {
  QualityReport before = baseline(), after = morphed();
  before.wall.nodes = after.wall.nodes = 77;
  before.wall.first_height_min = 1.25e-5;
  after.wall.first_height_min = 1.5e-5;
  after.wall.height_change_max = 0.2;
  after.wall.height_change_worst = {0, {6, 7, 0}};
  std::string const table = format_table(before, after);
  EXPECT_TRUE(has_line_with(table, {"Walls (77 nodes)"}));
  EXPECT_TRUE(has_line_with(table, {"first cell height, min", "1.25e-05", "1.5e-05"}));
  EXPECT_TRUE(has_line_with(table, {"20 %", "zone 'Zone A' node (i 7, j 8, k 1)"}));
}

WallGroup group(std::string name, double height, double change) {
  WallGroup g{std::move(name), {}};
  g.quality.nodes = 5;
  g.quality.first_height_min = height;
  g.quality.orthogonality_deg_max = 33.5;
  g.quality.height_change_max = change;
  return g;
}

TEST(QualityTable, ShowsEachWallBaselineAndMorphed) {
  QualityReport before = baseline(), after = morphed();
  before.wall.nodes = after.wall.nodes = 10;
  before.wall_groups = {group("blade", 1.25e-5, 0), group("hub", 3e-4, 0)};
  after.wall_groups = {group("blade", 1.5e-5, 0.2), group("hub", 3.5e-4, 0.07)};
  after.wall_groups[1].quality.orthogonality_change_deg_max = 4.25;
  std::string const table = format_table(before, after);
  EXPECT_TRUE(has_line_with(table, {"blade", "5", "1.25e-05", "1.5e-05", "33.5", "20"}));
  EXPECT_TRUE(has_line_with(table, {"hub", "0.0003", "0.00035", "7", "4.25"}));
  EXPECT_TRUE(has_line_with(format_table(before), {"hub", "0.0003", "33.5"}));
}

TEST(QualityTable, ShowsTheWorstWallsWhereThereAreMany) {
  QualityReport before = baseline(), after = morphed();
  before.wall.nodes = after.wall.nodes = 100;
  for (int n = 0; n < 20; ++n) {
    before.wall_groups.push_back(group("wall" + std::to_string(n) + " of a very long name", 1, 0));
    after.wall_groups.push_back(group("wall" + std::to_string(n) + " of a very long name", 1, 0.01 * n));
  }
  std::string const table = format_table(before, after);
  EXPECT_TRUE(has_line_with(table, {"wall19", " 19 "}));
  EXPECT_TRUE(has_line_with(table, {"wall8", " 8 "}));
  EXPECT_FALSE(has_line_with(table, {"wall7"}));
  EXPECT_LT(table.find("wall19"), table.find("wall18"));
  EXPECT_TRUE(has_line_with(table, {"8 more", "JSON"}));
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
}

TEST(QualityTable, ShortTableIsThatOfFigure14) {
  std::string const table = format_short_table(baseline(), morphed());
  EXPECT_TRUE(has_line_with(table, {"baseline", "688.4", "7.5", "0.734", "0.593"}));
  EXPECT_TRUE(has_line_with(table, {"morphed", "688.6", "7.9", "0.731", "0.577"}));
  QualityReport only = baseline();
  only.near_field = {};
  EXPECT_TRUE(has_line_with(format_short_table(only), {"baseline", "-", "7.5", "0.593"}));
}

TEST(Shortfalls, AreNoneForAGoodMesh) {
  EXPECT_TRUE(shortfalls(baseline(), morphed(), {}).empty());
  EXPECT_TRUE(shortfalls(baseline(), {}, {}).empty());
}

TEST(Shortfalls, NameThresholdValueAndCell) {
  QualityReport after = morphed();
  let_fall(after, Fall::determinant, 3, 0.577);
  auto const list = shortfalls(baseline(), after, thresholds(0.58, 0.25));
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].severity, Shortfall::Severity::failure);
  for (char const* words : {"far field", "0.577", "0.58", "zone 'Zone A' cell (i 2, j 3, k 4)", "3 cells"})
    EXPECT_NE(list[0].message.find(words), std::string::npos) << words;
  EXPECT_TRUE(any_failure(list));
}

TEST(Shortfalls, ForgiveWhatTheBaselineAlreadyHadButSaySo) {
  QualityReport const before = baseline();
  QualityReport after = morphed();
  after.far_field.measure[int(Measure::determinant_3x3x3)].min = 0.593;
  auto list = shortfalls(before, after, thresholds(0.6, 0.25));
  ASSERT_EQ(list.size(), 1u);
  EXPECT_FALSE(any_failure(list));
  after.far_field.inverted = 3;
  list = shortfalls(before, after, thresholds(0.1, 0.25));
  ASSERT_EQ(list.size(), 1u);
  EXPECT_FALSE(any_failure(list));
  EXPECT_NE(list[0].message.find("in the baseline already"), std::string::npos);
  let_fall(after, Fall::inverted, 1, -3.5);
  list = shortfalls(before, after, thresholds(0.1, 0.25));
  EXPECT_TRUE(any_failure(list));
  EXPECT_NE(list[0].message.find("-3.5 times"), std::string::npos);
}

TEST(Shortfalls, CellsThatWereFlatAreALineOfTheirOwnAndNone) {
  QualityReport after = morphed();
  EXPECT_EQ(format_table(baseline(), after).find("flat before"), std::string::npos);
  auto const without = shortfalls(baseline(), after, {});
  after.far_field.flat = 90;
  let_fall(after, Fall::flat_before, 90, -1.75e-4);
  EXPECT_EQ(shortfalls(baseline(), after, {}).size(), without.size());
  EXPECT_TRUE(has_line_with(format_table(baseline(), after), {"flat before: 90 cells", "below -0.001", "-0.000175"}));
  nlohmann::json const json = quality_json(baseline(), after, {});
  EXPECT_EQ(json.at("/morphed/far_field/flat_before/cells"_json_pointer), 90);
  EXPECT_EQ(json.at("/morphed/far_field/flat_before/worst/value"_json_pointer), -1.75e-4);
  EXPECT_FALSE(json.at("/morphed/far_field/fallen"_json_pointer).contains("flat_before"));
  EXPECT_EQ(json.at("/morphed/far_field/newly_inverted"_json_pointer), 0);
}

TEST(Shortfalls, WarnOfLargeRelativeDisplacementsWithoutFailing) {
  auto const list = shortfalls(baseline(), morphed(), thresholds(0.05, 0.2));
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].severity, Shortfall::Severity::warning);
  EXPECT_NE(list[0].message.find("0.21"), std::string::npos);
}

TEST(Shortfalls, OfABaselineAloneAreJudgedByTheThresholds) {
  QualityReport alone = baseline();
  EXPECT_TRUE(any_failure(shortfalls(alone, {}, thresholds(0.6, 0.25))));
  alone.near_field.inverted = 1;
  EXPECT_TRUE(any_failure(shortfalls(alone, {}, thresholds(0.05, 0.25))));
}

TEST(Shortfalls, CollapsedEdgesThatMorphingMadeAreAFailure) {
  QualityReport before = baseline(), after = morphed();
  before.far_field.collapsed = after.far_field.collapsed = 12;
  EXPECT_TRUE(shortfalls(before, after, {}).empty());
  let_fall(after, Fall::collapsed, 1, 0);
  EXPECT_TRUE(any_failure(shortfalls(before, after, {})));
}

TEST(Shortfalls, AnglesSkewnessAndLossesFailOnlyWhereTheMorphMadeThem) {
  QualityReport after = morphed();
  QualityThresholds limits;
  limits.cells.min_angle_deg = 25;  // the baseline has 21
  limits.cells.max_skewness = 0.7;  // and 0.75
  auto list = shortfalls(baseline(), after, limits);
  EXPECT_EQ(list.size(), 4u);  // two regions
  EXPECT_FALSE(any_failure(list));
  for (auto const& s : list) EXPECT_NE(s.message.find("in the baseline"), std::string::npos) << s.message;
  for (Fall const fall : {Fall::angle, Fall::skewness, Fall::loss}) {
    after = morphed();
    let_fall(after, fall, 2, 0.93);
    EXPECT_TRUE(any_failure(shortfalls(baseline(), after, limits))) << to_string(fall);
  }
  EXPECT_TRUE(has_line_with(format_table(baseline(), after, limits), {"falls short", "far field", "93 %"}));
  EXPECT_TRUE(any_failure(shortfalls(baseline(), {}, limits)));  // a mesh alone is judged as it is
}

TEST(QualityTable, AVerdictHasNoBaselineAndNoRowsForWhatWasNotMeasured) {
  QualityReport after = morphed();
  after.fast = true;
  after.near_field = {};
  after.far_field.flat = 12;
  for (auto const m : {Measure::aspect_ratio, Measure::determinant_2x2x2, Measure::equiangle_skewness, Measure::volume,
                       Measure::volume_ratio, Measure::relative_displacement})
    after.far_field.measure[std::size_t(m)] = {};
  std::string const table = format_table({}, after);
  EXPECT_TRUE(has_line_with(table, {"determinant 3x3x3, min", "0.577"}));
  EXPECT_TRUE(has_line_with(table, {"flat cells", "12"}));
  EXPECT_EQ(table.find("aspect ratio"), std::string::npos) << table;
  EXPECT_EQ(table.find("baseline"), std::string::npos) << table;
  nlohmann::json const json = quality_json({}, after, {});
  EXPECT_FALSE(json.contains("baseline"));
  EXPECT_EQ(json.at("/morphed/verdict_only"_json_pointer), true);
  EXPECT_EQ(json.at("/morphed/far_field/flat"_json_pointer), 12);
}

/// A wake beside near and far field.
QualityReport with_wake(QualityReport report, double determinant, double relative_j) {
  report.regions.push_back({"wake", region(3.5, determinant, {7, 8, 9})});
  QualityRegion& wake = report.regions.back().quality;
  wake.cells = 321;
  wake.measure[int(Measure::growth_ratio)] = statistics(1, 1.1, 1.37, true, {7, 8, 9});
  wake.measure[int(Measure::face_area_ratio)] = statistics(1, 1.1, 1.63, true, {7, 8, 9});
  if (report.against_baseline)
    wake.measure[int(Measure::relative_displacement_j)] = statistics(0, 0, relative_j, true, {7, 8, 9});
  return report;
}

TEST(QualityTable, RegionsHaveARowEach) {
  std::string const table = format_table(with_wake(baseline(), 0.81, 0), with_wake(morphed(), 0.79, 0.123));
  EXPECT_TRUE(has_line_with(table, {"Regions", "cells", "growth", "area", "displ."}));
  EXPECT_TRUE(has_line_with(table, {"wake", "baseline", "321", "0.81", "1.37", "1.63"}));
  EXPECT_TRUE(has_line_with(table, {"wake", "morphed", "321", "0.79", "0.123"}));
  EXPECT_TRUE(has_line_with(table, {"near field", "morphed", "1000", "0.731"}));
  EXPECT_EQ(format_table(baseline(), morphed()).find("Regions"), std::string::npos) << "where there are none";
  nlohmann::json const json = quality_json(with_wake(baseline(), 0.81, 0), with_wake(morphed(), 0.79, 0.123), {});
  EXPECT_EQ(json.at("/baseline/regions/wake/cells"_json_pointer), 321);
  EXPECT_EQ(json.at("/morphed/regions/wake/measures/relative_displacement_j/max"_json_pointer), 0.123);
  EXPECT_EQ(json.at("/morphed/regions/wake/measures/growth_ratio/worst/cell"_json_pointer),
            (std::vector<int>{8, 9, 10}));
}

TEST(QualityTable, RelativeDisplacementHasARowPerDirection) {
  QualityReport after = morphed();
  for (int d = 0; d < 3; ++d)
    after.far_field.measure[std::size_t(relative_displacement_along(d))] =
        statistics(0, 0, 0.01 * (d + 1), true, {1, 2, 3});
  std::string const table = format_table(baseline(), after);
  EXPECT_TRUE(has_line_with(table, {"relative displacement i, max", "0.01"}));
  EXPECT_TRUE(has_line_with(table, {"relative displacement j, max", "0.02"}));
  EXPECT_TRUE(has_line_with(table, {"relative displacement k, max", "0.03"}));
}

TEST(QualityJson, CarriesValuesPlacesAndFormulas) {
  QualityReport after = morphed();
  let_fall(after, Fall::determinant, 1, 0.577);
  nlohmann::json const written = quality_json(baseline(), after, thresholds(0.58, 0.25));
  nlohmann::json const json = nlohmann::json::parse(written.dump());
  EXPECT_EQ(json.at("/baseline/near_field/measures/aspect_ratio/max"_json_pointer), 688.4);
  EXPECT_EQ(json.at("/morphed/far_field/measures/determinant_3x3x3/min"_json_pointer), 0.577);
  EXPECT_EQ(json.at("/morphed/far_field/measures/determinant_3x3x3/worst/zone"_json_pointer), "Zone A");
  EXPECT_EQ(json.at("/morphed/far_field/measures/determinant_3x3x3/worst/cell"_json_pointer),
            (std::vector<int>{2, 3, 4}));
  EXPECT_TRUE(json.at("/baseline/far_field/measures/volume_ratio/max"_json_pointer).is_null());
  EXPECT_FALSE(json.at("baseline").at("far_field").at("measures").contains("relative_displacement"));
  for (std::size_t m = 0; m < n_measures; ++m) {
    auto const& definition = json.at("definitions").at(std::string(to_string(Measure(m))));
    EXPECT_FALSE(definition.at("formula").get<std::string>().empty());
    EXPECT_EQ(definition.at("worse"), larger_is_worse(Measure(m)) ? "larger" : "smaller");
  }
  ASSERT_EQ(json.at("shortfalls").size(), 1u);
  EXPECT_EQ(json.at("/shortfalls/0/severity"_json_pointer), "failure");
  EXPECT_EQ(json.at("/thresholds/min_determinant"_json_pointer), 0.58);
  EXPECT_EQ(json.at("/morphed/far_field/fallen/determinant/worst/cell"_json_pointer), (std::vector<int>{2, 3, 4}));
  EXPECT_FALSE(quality_json(baseline(), {}, {}).contains("morphed"));
}

TEST(QualityJson, HoldsEveryWallGroup) {
  QualityReport before = baseline(), after = morphed();
  for (int n = 0; n < 20; ++n) {
    before.wall_groups.push_back(group("wall" + std::to_string(n), 1, 0));
    after.wall_groups.push_back(group("wall" + std::to_string(n), 2, 0.01 * n));
  }
  nlohmann::json const json = quality_json(before, after, {});
  EXPECT_EQ(json.at("/baseline/walls/groups"_json_pointer).size(), 20u);
  EXPECT_EQ(json.at("/baseline/walls/groups/wall7/first_height/min"_json_pointer), 1);
  EXPECT_EQ(json.at("/morphed/walls/groups/wall7/first_height/min"_json_pointer), 2);
  EXPECT_EQ(json.at("/morphed/walls/groups/wall7/first_height_change/max"_json_pointer), 0.07);
  EXPECT_FALSE(json.at("/baseline/walls/groups/wall7"_json_pointer).contains("first_height_change"));
}

TEST(QualityJson, WallChangesAppearOnlyAgainstABaseline) {
  QualityReport after = morphed();
  after.wall.height_change_max = 0.5;
  after.wall.height_change_worst = {0, {0, 1, 2}};
  nlohmann::json const json = quality_json(baseline(), after, {});
  EXPECT_FALSE(json.at("baseline").at("walls").contains("first_height_change"));
  EXPECT_EQ(json.at("/morphed/walls/first_height_change/max"_json_pointer), 0.5);
  EXPECT_EQ(json.at("/morphed/walls/first_height_change/worst/node"_json_pointer), (std::vector<int>{1, 2, 3}));
  EXPECT_TRUE(json.at("/morphed/walls/orthogonality_deg/worst"_json_pointer).is_null());
}

}  // namespace
}  // namespace gridmorph
