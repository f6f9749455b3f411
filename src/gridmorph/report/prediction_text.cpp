#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/report/measure_text.hpp>
#include <gridmorph/report/prediction_text.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace gridmorph {

namespace {

constexpr char const* direction_name[3] = {"i", "j", "k"};

/// Words and fields for the cells of a mesh.
class Words {
 public:
  explicit Words(Mesh const& mesh) : mesh_(mesh), of_blocks_(mesh.is_structured()) {}

  [[nodiscard]] char const* cells() const { return of_blocks_ ? "cells" : "elements"; }
  [[nodiscard]] std::string group() const { return of_blocks_ ? "chain" : "region"; }
  [[nodiscard]] std::string name(PredictedGroup const& group) const {
    return of_blocks_ ? fmt::format("stage {}, {}", group.stage, group.name) : group.name;
  }
  /// Elements are smoothed around by default.
  [[nodiscard]] char const* before() const { return of_blocks_ ? "" : " before any is smoothed around"; }
  [[nodiscard]] std::string place(CellValue const& at) const {
    Zone const& zone = mesh_.zones[at.zone];
    return of_blocks_ ? describe_cell(zone.name, at.cell) : describe_element(mesh_, zone.first_element + at.cell[0]);
  }

  [[nodiscard]] std::string smallest(PredictedCells const& cells) const {
    CellValue const& at = of_blocks_ ? cells.scaled_jacobian : cells.determinant;
    return fmt::format("smallest {} {} ({} in the baseline) at {}",
                       of_blocks_ ? "scaled Jacobian" : "determinant 3x3x3", format_value(at.value),
                       format_value(of_blocks_ ? cells.scaled_jacobian_before : cells.determinant_before), place(at));
  }
  [[nodiscard]] std::string determinant(PredictedCells const& cells) const {
    return of_blocks_ ? fmt::format("determinant 3x3x3 {}, ", format_value(cells.determinant.value)) : std::string();
  }
  /// Along one direction of the grid lines.
  [[nodiscard]] std::string relative(PredictedCells const& cells, int direction) const {
    return format_value(cells.relative_displacement[direction].value) +
           (of_blocks_ ? fmt::format(" along {}", direction_name[direction]) : std::string());
  }
  [[nodiscard]] std::string relative(PredictedCells const& cells) const {
    return of_blocks_ ? fmt::format("{}, {}, {}", relative(cells, 0), relative(cells, 1), relative(cells, 2))
                      : relative(cells, 0);
  }
  [[nodiscard]] std::string largest_relative(PredictedCells const& cells) const {
    return "relative displacement " + relative(cells, worst_direction(cells));
  }
  static int worst_direction(PredictedCells const& cells) {
    return int(std::ranges::max_element(cells.relative_displacement, {}, &CellValue::value) -
               cells.relative_displacement.begin());
  }

  [[nodiscard]] nlohmann::json json(CellValue const& at) const {
    if (at.zone < 0) return nullptr;
    nlohmann::json out{{"value", finite_or_null(at.value)}};
    if (of_blocks_) {
      out["zone"] = mesh_.zones[at.zone].name;
      out["cell"] = {at.cell[0] + 1, at.cell[1] + 1, at.cell[2] + 1};
    } else {
      out["element"] = place(at);
    }
    return out;
  }
  [[nodiscard]] nlohmann::json json(CellValue const& at, double before) const {
    nlohmann::json out = json(at);
    if (!out.is_null()) out["baseline"] = finite_or_null(before);
    return out;
  }
  [[nodiscard]] nlohmann::json json(PredictedCells const& of) const {
    nlohmann::json out{{cells(), of.cells},
                       {"inverted", of.inverted},
                       {"determinant_3x3x3", json(of.determinant, of.determinant_before)},
                       {"kept", json(of.kept)},
                       {"minimum_angle_deg", json(of.angle_deg)}};
    nlohmann::json& relative = out["relative_displacement"];
    if (!of_blocks_) {
      relative = json(of.relative_displacement[0]);
      return out;
    }
    out["scaled_jacobian"] = json(of.scaled_jacobian, of.scaled_jacobian_before);
    for (int d = 0; d < 3; ++d) relative[direction_name[d]] = json(of.relative_displacement[d]);
    return out;
  }
  [[nodiscard]] nlohmann::json json(PredictedGroup const& group) const {
    nlohmann::json out = json(group.cells);
    if (of_blocks_) out["stage"] = group.stage;
    out[of_blocks_ ? "chain" : "name"] = group.name;
    return out;
  }

 private:
  Mesh const& mesh_;
  bool of_blocks_;
};

}  // namespace

std::string describe(Mesh const& mesh, Prediction const& prediction) {
  constexpr std::size_t most = 10;
  Words const words(mesh);
  PredictedCells const& all = prediction.all;
  std::vector<PredictedGroup> const& groups = prediction.groups;
  if (all.cells == 0) return {};
  std::string text = fmt::format(
      "predicted from {} of {} {}: {} inverted{}, {}, smallest share of it kept {}, {}angle {} deg; relative "
      "displacement {}\n",
      all.cells, prediction.n_cells, words.cells(), all.inverted, words.before(), words.smallest(all),
      format_value(all.kept.value), words.determinant(all), format_value(all.angle_deg.value), words.relative(all));
  for (std::size_t n = 0; n < std::min(most, groups.size()); ++n) {
    PredictedCells const& cells = groups[n].cells;
    text += fmt::format("  {}: {} inverted of {}, {}, smallest share of it kept {}; {}\n", words.name(groups[n]),
                        cells.inverted, cells.cells, words.smallest(cells), format_value(cells.kept.value),
                        words.largest_relative(cells));
  }
  if (groups.size() > most) text += fmt::format("  and {} more {}\n", groups.size() - most, words.group() + "s");
  return text;
}

std::vector<std::string> prediction_warnings(Mesh const& mesh, Prediction const& prediction) {
  constexpr double handled_well = 0.25;  // paper, section 3.2
  Words const words(mesh);
  PredictedCells const& all = prediction.all;
  if (all.inverted > 0)
    return {fmt::format("predicted: {} of {} {} looked at would be inverted{}; {}; worst {}: {}; {}", all.inverted,
                        all.cells, words.cells(), words.before(), words.smallest(all), words.group(),
                        words.name(prediction.groups.front()), words.largest_relative(all))};
  CellValue const& relative = all.relative_displacement[Words::worst_direction(all)];
  if (all.cells == 0 || !(relative.value > handled_well)) return {};
  return {fmt::format("predicted: {} at {}, above the {} known to be handled well; {}", words.largest_relative(all),
                      words.place(relative), handled_well, words.smallest(all))};
}

nlohmann::json prediction_json(Mesh const& mesh, Prediction const& prediction) {
  Words const words(mesh);
  nlohmann::json out = words.json(prediction.all);
  out["every"] = prediction.every;
  out["of"] = prediction.n_cells;
  nlohmann::json& groups = out[words.group() + "s"] = nlohmann::json::array();
  for (PredictedGroup const& group : prediction.groups) groups.push_back(words.json(group));
  return out;
}

}  // namespace gridmorph
