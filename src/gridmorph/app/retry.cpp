// Where a morph came out short: other recipes for the same motion.
#include <gridmorph/app/recipe.hpp>
#include <gridmorph/app/run.hpp>
#include <gridmorph/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <compare>

namespace gridmorph::cli {

namespace {

/// How bad a mesh is: less is better, in this order.
struct Badness {
  Index inverted = 0, fallen = 0;
  double lost_determinant = 0;  ///< 1 - the smallest one

  auto operator<=>(Badness const&) const = default;
};

Badness badness_of(QualityReport const& quality) {
  Badness out{newly_inverted(quality), 0, 0};
  for (auto const* region : {&quality.near_field, &quality.far_field}) {
    if (region->cells == 0) continue;
    for (Fall const fall : {Fall::determinant, Fall::angle, Fall::skewness, Fall::loss, Fall::collapsed})
      out.fallen += (*region)[fall].cells;
    out.lost_determinant = std::max(out.lost_determinant, 1 - (*region)[Measure::determinant_3x3x3].min);
  }
  return out;
}

nlohmann::json json_of(std::string const& keys, Badness const& badness) {
  return {{"keys", keys},
          {"newly_inverted", badness.inverted},
          {"beyond_limits", badness.fallen},
          {"min_determinant", 1 - badness.lost_determinant}};
}

}  // namespace

Retried Run::retry() {
  Retried out;
  bool const elements = result_.quality.unstructured;
  Recipe best;
  Badness const at_first = badness_of(result_.quality);
  Badness least = at_first;
  out.json = {{"first", json_of("", at_first)}, {"tried", nlohmann::json::array()}, {"kept", nullptr}};
  auto const wanting = [&] { return least.inverted > 0 || any_failure(shortfalls_of(result_.quality)); };
  auto const attempt = [&](Recipe const& recipe) {
    if (!wanting()) return;
    std::string const keys = recipe.keys(elements);
    terminal_.progress("trying " + keys);
    auto other = std::make_unique<CaseFile>(recipe.of(case_file_));
    Result before = std::move(result_);
    auto displacement = displacement_;
    auto plan = std::exchange(plan_, nullptr);
    auto const put_back = [&] {
      plan_ = std::move(plan);
      result_ = std::move(before);
      displacement_ = std::move(displacement);
    };
    try {
      plan_ = mesh_->plan(*other);
      result_ = {Coordinates(mesh_->n_nodes()), {}, {case_file_.output_options.displacement, {}, {}}};
      (void)morph();
      measure();
    } catch (Error const& e) {
      out.json["tried"].push_back({{"keys", keys}, {"error", e.what()}});
      return put_back();
    }
    Badness const badness = badness_of(result_.quality);
    out.json["tried"].push_back(json_of(keys, badness));
    if (!(badness < least)) return put_back();
    least = badness;
    best = recipe;
    plan.reset();  // it refers to the case file that goes
    recipe_ = std::move(other);
  };
  for (Recipe const& recipe : other_near_fields(case_file_, elements)) attempt(recipe);
  for (Recipe const& recipe : other_laws(case_file_, best, elements)) attempt(recipe);
  if (!elements && case_file_.plan.volume.order != OrderBy::prediction) {
    Recipe ordered = best;
    ordered.by_prediction = true;
    attempt(ordered);
  }
  if (!elements && !case_file_.guard.smooth) {
    Recipe smoothed = best;
    smoothed.smooth = true;
    attempt(smoothed);
  }
  std::size_t const tried = out.json["tried"].size();
  std::string const& cells = mesh_->kind().cells;
  if (tried == 0) return out;
  if (least == at_first) {
    out.text = fmt::format("{} other recipes for the same motion were tried, and none is better", tried);
    return out;
  }
  out.json["kept"] = best.keys(elements);
  out.text = fmt::format(
      "{} {} were inverted and {} beyond a limit; of {} other recipes {} leaves {} and {}: with these keys a case file "
      "gives this mesh",
      at_first.inverted, cells, at_first.fallen, tried, best.keys(elements), least.inverted, least.fallen);
  return out;
}

}  // namespace gridmorph::cli
