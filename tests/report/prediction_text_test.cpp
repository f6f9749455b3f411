// What is predicted of blocks and of elements as text, warnings and JSON: one report, in words of each kind.
#include "support/mesh_builders.hpp"

#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/report/prediction_text.hpp>

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <string>

namespace gridmorph {
namespace {

/// Of the second cell of a box, as a block or as hexahedra.
class PredictionText : public testing::TestWithParam<bool> {
 protected:
  static CellValue second(double value) { return {value, 0, {1, 0, 0}}; }

  bool const blocks = GetParam();
  Mesh const box = test::box({4, 4, 4}, test::Shape::straight, 1), mesh = blocks ? box : as_hexahedra(box);
  std::string const at = std::string(" at zone 'box1' ") + (blocks ? "cell (i 2, j 1, k 1)" : "hexahedron 2"),
                    smallest = (blocks ? "smallest scaled Jacobian 0.25 (0.5 in the baseline)"
                                       : "smallest determinant 3x3x3 0.125 (0.75 in the baseline)") +
                               at,
                    name = blocks ? "stage 1, along i" : "near field", cells = blocks ? "cells" : "elements",
                    relative = blocks ? "relative displacement 0.3 along j" : "relative displacement 0.3",
                    before = blocks ? "" : " before any is smoothed around";
  Prediction p{27, 4, {}, {{blocks ? "1" : "", blocks ? "along i" : "near field", {}}}};

  PredictionText() {
    p.all.cells = 8;
    if (blocks) p.all.scaled_jacobian = second(0.25);
    p.all.scaled_jacobian_before = 0.5;
    p.all.determinant = second(0.125);
    p.all.determinant_before = 0.75;
    p.all.kept = second(0.5);
    p.all.angle_deg = second(30);
    if (blocks)
      p.all.relative_displacement = {second(0.1), second(0.3), second(0.2)};
    else
      p.all.relative_displacement[0] = second(0.3);
    p.groups[0].cells = p.all;
  }
};

TEST_P(PredictionText, HasALineForAllAndOneForEachOfTenGroups) {
  std::string const all = "predicted from 8 of 27 " + cells + ": 0 inverted" + before + ", " + smallest +
                          ", smallest share of it kept 0.5, " + (blocks ? "determinant 3x3x3 0.125, " : "") +
                          "angle 30 deg; relative displacement " +
                          (blocks ? "0.1 along i, 0.3 along j, 0.2 along k\n" : "0.3\n"),
                    one = "  " + name + ": 0 inverted of 8, " + smallest + ", smallest share of it kept 0.5; " +
                          relative + "\n";
  EXPECT_EQ(describe(mesh, p), all + one);
  p.groups.resize(13, p.groups.front());
  EXPECT_TRUE(describe(mesh, p).ends_with(one + (blocks ? "  and 3 more chains\n" : "  and 3 more regions\n")));
  EXPECT_EQ(describe(mesh, Prediction{}), "");
}

TEST_P(PredictionText, WarnsOfInvertedCellsOrElseOfLargeRelativeDisplacements) {
  using Warnings = std::vector<std::string>;
  EXPECT_EQ(prediction_warnings(mesh, p),
            Warnings{"predicted: " + relative + at + ", above the 0.25 known to be handled well; " + smallest});
  p.all.inverted = 2;
  EXPECT_EQ(prediction_warnings(mesh, p),
            Warnings{"predicted: 2 of 8 " + cells + " looked at would be inverted" + before + "; " + smallest +
                     "; worst " + (blocks ? "chain: " : "region: ") + name + "; " + relative});
  p.all.inverted = 0;
  for (CellValue& value : p.all.relative_displacement) value.value = 0.25;
  EXPECT_EQ(prediction_warnings(mesh, p), Warnings{});
  EXPECT_EQ(prediction_warnings(mesh, Prediction{}), Warnings{});
}

TEST_P(PredictionText, IsJsonOfTheSameFieldsForBothKinds) {
  auto const json = prediction_json(mesh, p);
  EXPECT_EQ(json["every"], 4);
  EXPECT_EQ(json["of"], 27);
  auto const& group = json[blocks ? "chains" : "regions"][0];
  EXPECT_EQ(group[blocks ? "chain" : "name"], p.groups[0].name);
  for (auto const* of : {&json, &group}) {
    EXPECT_EQ((*of)[cells], 8);
    EXPECT_EQ((*of)["inverted"], 0);
    EXPECT_EQ((*of)["kept"]["value"], 0.5);
    EXPECT_EQ((*of)["minimum_angle_deg"]["value"], 30);
    EXPECT_EQ((*of)["determinant_3x3x3"]["baseline"], 0.75);
    auto const& relative_json = (*of)["relative_displacement"];
    EXPECT_EQ((blocks ? relative_json["j"] : relative_json)["value"], 0.3);
    EXPECT_EQ(of->contains("scaled_jacobian"), blocks);
  }
  if (blocks)
    EXPECT_EQ(json["kept"]["cell"], nlohmann::json({2, 1, 1}));
  else
    EXPECT_EQ(" at " + std::string(json["kept"]["element"]), at);
}

INSTANTIATE_TEST_SUITE_P(Of, PredictionText, testing::Bool(),
                         [](auto const& info) { return info.param ? "blocks" : "elements"; });

}  // namespace
}  // namespace gridmorph
