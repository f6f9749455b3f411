#include <gridmorph/report/element_prediction_text.hpp>
#include <gridmorph/report/measure_text.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gridmorph {

namespace {

std::string least_determinant(Mesh const& mesh, PredictedElements const& elements) {
  return fmt::format("{} ({} in the baseline) at {}", format_value(elements.determinant.value),
                     format_value(elements.determinant_before), describe_element(mesh, elements.determinant.element));
}

nlohmann::json element_json(Mesh const& mesh, ElementValue const& at) {
  if (at.element < 0) return nullptr;
  return {{"value", finite_or_null(at.value)}, {"element", describe_element(mesh, at.element)}};
}

nlohmann::json elements_json(Mesh const& mesh, PredictedElements const& elements) {
  nlohmann::json determinant = element_json(mesh, elements.determinant);
  if (!determinant.is_null()) determinant["baseline"] = finite_or_null(elements.determinant_before);
  return {{"elements", elements.elements},
          {"inverted", elements.inverted},
          {"determinant_3x3x3", std::move(determinant)},
          {"kept", element_json(mesh, elements.kept)},
          {"minimum_angle_deg", element_json(mesh, elements.angle_deg)},
          {"relative_displacement", element_json(mesh, elements.relative_displacement)}};
}

}  // namespace

std::string describe(Mesh const& mesh, ElementPrediction const& prediction) {
  PredictedElements const& all = prediction.all;
  if (all.elements == 0) return {};
  std::string text = fmt::format(
      "predicted from {} of {} elements, before any is smoothed around: {} inverted, smallest determinant 3x3x3 {}, "
      "smallest share of it kept {}, angle {} deg; relative displacement {}\n",
      all.elements, prediction.n_elements, all.inverted, least_determinant(mesh, all), format_value(all.kept.value),
      format_value(all.angle_deg.value), format_value(all.relative_displacement.value));
  for (PredictedRegion const& region : prediction.regions)
    text += fmt::format("  {}: {} inverted of {}, smallest share of a determinant kept {}; relative displacement {}\n",
                        region.name, region.elements.inverted, region.elements.elements,
                        format_value(region.elements.kept.value),
                        format_value(region.elements.relative_displacement.value));
  return text;
}

std::vector<std::string> prediction_warnings(Mesh const& mesh, ElementPrediction const& prediction) {
  constexpr double handled_well = 0.25;  // paper, section 3.2
  std::vector<std::string> out;
  PredictedElements const& all = prediction.all;
  if (all.elements == 0) return out;
  if (all.inverted > 0)
    out.push_back(
        fmt::format("predicted: {} of {} elements looked at would be inverted before any is smoothed around; smallest "
                    "determinant {}, most of it lost in the {}",
                    all.inverted, all.elements, least_determinant(mesh, all), prediction.regions.front().name));
  else if (all.relative_displacement.value > handled_well)
    out.push_back(fmt::format(
        "predicted: relative displacement {} at {}, above the {} known to be handled well; smallest determinant {}",
        format_value(all.relative_displacement.value), describe_element(mesh, all.relative_displacement.element),
        handled_well, least_determinant(mesh, all)));
  return out;
}

nlohmann::json prediction_json(Mesh const& mesh, ElementPrediction const& prediction) {
  nlohmann::json out = elements_json(mesh, prediction.all);
  out["every"] = prediction.every;
  out["of"] = prediction.n_elements;
  out["regions"] = nlohmann::json::array();
  for (PredictedRegion const& region : prediction.regions) {
    nlohmann::json one = elements_json(mesh, region.elements);
    one["name"] = region.name;
    out["regions"].push_back(std::move(one));
  }
  return out;
}

}  // namespace gridmorph
