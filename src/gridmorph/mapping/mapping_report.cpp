#include <gridmorph/core/text.hpp>
#include <gridmorph/mapping/mapping_report.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <vector>

namespace gridmorph {

std::string describe_mapping(PointField const& field) {
  auto const m = field.mapping();
  if (m.evaluated == m.coincident)
    return fmt::format("{}: all {} node positions coincide with points of the file (largest distance {:.3g})",
                       field.source(), m.evaluated, m.max);
  std::string text = fmt::format(
      "{}: {} of {} node positions coincide with points of the file, the others are {}; mapping distance mean {:.3g}, "
      "largest {:.3g} at {}",
      field.source(), m.coincident, m.evaluated,
      field.n_elements() > 0 ? fmt::format("mapped from its {} elements", field.n_elements()) : "interpolated", m.mean,
      m.max, to_text(m.farthest, 6));
  if (m.extrapolated > 0)
    text += fmt::format("; {} are beyond its edge, by {:.3g} at most, at {}", m.extrapolated, m.max_beyond,
                        to_text(m.farthest_beyond, 6));
  if (auto const e = field.leave_one_out(); e.tried > 0)
    text += fmt::format("; leave-one-out error {:.2g} % of the largest displacement (rms {:.2g} %), worst at {}",
                        100 * e.max, 100 * e.rms, field.where(e.worst));
  return text;
}

std::string far_from_model(PointField const& field) {
  auto const m = field.mapping();
  std::vector<std::string> what;
  if (lacks_own_nodes(m))
    what.push_back(
        fmt::format("{} of {} nodes are farther than two spacings from its points, {} of which are nodes themselves",
                    m.far_off, m.evaluated, m.coincident));
  else if (m.far_beyond > 0)
    what.push_back(
        fmt::format("{} of {} nodes are beyond the edge of its {} by more than two {} there, by {:.3g} at most, at {}",
                    m.far_beyond, m.evaluated, field.n_elements() > 0 ? "elements" : "points",
                    field.n_elements() > 0 ? "of them" : "spacings", m.max_beyond, to_text(m.farthest_beyond, 6)));
  if (!field.has_max_distance() && m.patches_size > 0 && m.max > MappingLimits::notable * m.patches_size)
    what.push_back(fmt::format("the node at {} is {:.3g} from it, {:.2g} % of the size of its patches",
                               to_text(m.farthest, 6), m.max, 100 * m.max / m.patches_size));
  if (what.empty()) return {};
  return fmt::format("{}: {}; what they take from it may not be what was meant", field.source(),
                     fmt::join(what, ", and "));
}

nlohmann::json mapping_json(PointField const& field) {
  auto const m = field.mapping();
  nlohmann::json json{{"file", field.source()},
                      {"nodes", field.size()},
                      {"elements", field.n_elements()},
                      {"fields", field.n_fields()},
                      {"evaluated", m.evaluated},
                      {"coincident", m.coincident},
                      {"extrapolated", m.extrapolated},
                      {"far_beyond", m.far_beyond},
                      {"far_off", m.far_off},
                      {"largest_extrapolation", m.max_beyond},
                      {"patches_size", m.patches_size > 0 ? nlohmann::json(m.patches_size) : nlohmann::json()},
                      {"mapping_distance", {{"mean", m.mean}, {"max", m.max}}},
                      {"leave_one_out", nullptr}};
  if (m.evaluated == m.coincident) return json;
  if (auto const e = field.leave_one_out(); e.tried > 0)
    json["leave_one_out"] = {{"tried", e.tried}, {"max", e.max}, {"rms", e.rms}};
  return json;
}

std::string describe_inverse(InverseField const& inverse) {
  auto const r = inverse.report();
  std::string text = fmt::format(
      "taken back by iteration: |X + u(X) - x| is at most {:.3g} (tolerance {:.3g}) after {} iterations of {} node "
      "positions",
      r.residual, inverse.tolerance(), r.iterations, r.evaluated);
  if (r.held > 0)
    text += fmt::format("; {} of them went to and fro between elements of the model and were held on one", r.held);
  if (r.jump > 0) text += fmt::format(", where the displacement jumps by up to {:.3g} to the next", r.jump);
  if (r.one_step > 0)
    text += fmt::format("; one step, x - u(x), leaves {:.3g} at {}", r.one_step, to_text(r.worst_of_one_step, 6));
  return text;
}

nlohmann::json inverse_json(InverseField const& inverse) {
  auto const r = inverse.report();
  return {{"evaluated", r.evaluated},
          {"iterations", r.iterations},
          {"tolerance", inverse.tolerance()},
          {"residual", r.residual},
          {"held", r.held},
          {"jump", r.jump},
          {"residual_of_one_step", r.one_step}};
}

}  // namespace gridmorph
