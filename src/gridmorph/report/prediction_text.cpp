#include <gridmorph/report/measure_text.hpp>
#include <gridmorph/report/prediction_text.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace gridmorph {

namespace {

constexpr char direction_name[3] = {'i', 'j', 'k'};

std::string place(Mesh const& mesh, CellValue const& at) { return describe_cell(mesh.zones[at.zone].name, at.cell); }

std::string smallest(Mesh const& mesh, PredictedCells const& cells) {
  return fmt::format("{} ({} in the baseline) at {}", format_value(cells.scaled_jacobian.value),
                     format_value(cells.scaled_jacobian_before), place(mesh, cells.scaled_jacobian));
}

int worst_direction(PredictedCells const& cells) {
  auto const& relative = cells.relative_displacement;
  return int(std::max_element(relative.begin(), relative.end(),
                              [](CellValue const& a, CellValue const& b) { return a.value < b.value; }) -
             relative.begin());
}

std::string largest_relative(PredictedCells const& cells) {
  int const d = worst_direction(cells);
  return fmt::format("relative displacement {} along {}", format_value(cells.relative_displacement[d].value),
                     direction_name[d]);
}

std::string name_of(PredictedChain const& chain) { return fmt::format("stage {}, {}", chain.stage, chain.chain); }

nlohmann::json value_json(Mesh const& mesh, CellValue const& at) {
  if (at.zone < 0) return nullptr;
  return {{"value", finite_or_null(at.value)},
          {"zone", mesh.zones[at.zone].name},
          {"cell", {at.cell[0] + 1, at.cell[1] + 1, at.cell[2] + 1}}};
}

nlohmann::json cells_json(Mesh const& mesh, PredictedCells const& cells) {
  nlohmann::json jacobian = value_json(mesh, cells.scaled_jacobian);
  if (!jacobian.is_null()) jacobian["baseline"] = finite_or_null(cells.scaled_jacobian_before);
  nlohmann::json relative;
  for (int d = 0; d < 3; ++d)
    relative[std::string(1, direction_name[d])] = value_json(mesh, cells.relative_displacement[d]);
  return {{"cells", cells.cells},
          {"inverted", cells.inverted},
          {"scaled_jacobian", std::move(jacobian)},
          {"determinant_3x3x3", value_json(mesh, cells.determinant)},
          {"minimum_angle_deg", value_json(mesh, cells.angle_deg)},
          {"relative_displacement", std::move(relative)}};
}

}  // namespace

std::string describe(Mesh const& mesh, Prediction const& prediction) {
  constexpr std::size_t most = 10;
  PredictedCells const& all = prediction.all;
  if (all.cells == 0) return {};
  std::string text = fmt::format(
      "predicted from {} cells: {} inverted, smallest scaled Jacobian {}, determinant 3x3x3 {}, angle {} deg; relative "
      "displacement {} along i, {} along j, {} along k\n",
      all.cells, all.inverted, smallest(mesh, all), format_value(all.determinant.value),
      format_value(all.angle_deg.value), format_value(all.relative_displacement[0].value),
      format_value(all.relative_displacement[1].value), format_value(all.relative_displacement[2].value));
  for (std::size_t n = 0; n < std::min(most, prediction.chains.size()); ++n) {
    PredictedChain const& chain = prediction.chains[n];
    text += fmt::format("  {}: smallest scaled Jacobian {}; {}\n", name_of(chain), smallest(mesh, chain.cells),
                        largest_relative(chain.cells));
  }
  if (prediction.chains.size() > most) text += fmt::format("  and {} more chains\n", prediction.chains.size() - most);
  return text;
}

std::vector<std::string> prediction_warnings(Mesh const& mesh, Prediction const& prediction) {
  constexpr double handled_well = 0.25;  // paper, section 3.2
  std::vector<std::string> out;
  PredictedCells const& all = prediction.all;
  if (all.cells == 0) return out;
  if (all.inverted > 0)
    out.push_back(fmt::format(
        "predicted: {} of {} cells looked at would be inverted; smallest scaled Jacobian {}, {}; {}", all.inverted,
        all.cells, smallest(mesh, all), name_of(prediction.chains.front()), largest_relative(all)));
  int const d = worst_direction(all);
  CellValue const& relative = all.relative_displacement[d];
  if (all.inverted == 0 && relative.value > handled_well)
    out.push_back(fmt::format("predicted: {} at {}, above the {} known to be handled well; smallest scaled Jacobian {}",
                              largest_relative(all), place(mesh, relative), handled_well, smallest(mesh, all)));
  return out;
}

nlohmann::json prediction_json(Mesh const& mesh, Prediction const& prediction) {
  nlohmann::json out = cells_json(mesh, prediction.all);
  out["every"] = prediction.every;
  out["chains"] = nlohmann::json::array();
  for (PredictedChain const& chain : prediction.chains) {
    nlohmann::json one = cells_json(mesh, chain.cells);
    one["stage"] = chain.stage;
    one["chain"] = chain.chain;
    out["chains"].push_back(std::move(one));
  }
  return out;
}

}  // namespace gridmorph
