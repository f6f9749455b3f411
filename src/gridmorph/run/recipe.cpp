#include <gridmorph/core/error.hpp>
#include <gridmorph/run/recipe.hpp>
#include <gridmorph/run/run.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace gridmorph::cli {

namespace {

using Mode = BoundaryLayer::Mode;

constexpr std::array<char const*, 3> mode_names{"translate", "rotate", "blend"};
constexpr std::array<char const*, 5> law_names{"linear", "c1", "c2", "mixed", "matched"};

nlohmann::json json_of(std::string const& keys, Badness const& badness) {
  return {{"keys", keys},
          {"newly_inverted", badness.inverted},
          {"beyond_limits", badness.fallen},
          {"min_determinant", 1 - badness.lost_determinant}};
}

}  // namespace

CaseFile Recipe::of(CaseFile const& case_file) const {
  CaseFile out = case_file;
  if (mode) {
    if (adds_table && out.plan.boundary_layers.empty()) out.plan.boundary_layers.emplace_back();
    for (BoundaryLayer& layer : out.plan.boundary_layers) layer.mode = *mode;
  }
  if (turn) out.plan.volume.turn = turn;
  if (law) {
    out.plan.volume.law = *law;
    out.plan.volume.laws_by_prediction = false;
  }
  if (by_prediction) out.plan.volume.order = OrderBy::prediction;
  if (smooth) out.guard.smooth = true;
  return out;
}

std::string Recipe::keys(bool unstructured) const {
  std::string out;
  auto const add = [&](std::string const& key) { out += (out.empty() ? "" : ", ") + key; };
  if (mode) add(fmt::format("[boundary_layer] mode = \"{}\"", mode_names.at(std::size_t(*mode))));
  if (turn) add(fmt::format("[volume] turn = {}", *turn));
  if (law)
    add(fmt::format("[{}] law = \"{}\"", unstructured ? "background" : "volume", law_names.at(std::size_t(*law))));
  if (by_prediction) add("[volume] order = \"prediction\"");
  if (smooth) add("[guard] smooth = true");
  return out;
}

std::vector<Recipe> other_near_fields(CaseFile const& case_file, bool unstructured) {
  auto layers = case_file.plan.boundary_layers;
  // Without a table there is the near field of one that says nothing.
  bool const adds_table = layers.empty() && case_file.plan.default_boundary_layer;
  if (adds_table) layers.emplace_back();
  if (layers.empty()) return {};
  auto const all_are = [&](Mode mode) {
    return std::ranges::all_of(layers, [&](BoundaryLayer const& layer) { return layer.mode == mode; });
  };
  std::vector<Recipe> out;
  if (!all_are(Mode::translate)) out.push_back({.mode = Mode::translate});
  if (unstructured) {
    for (Mode const mode : {Mode::rotate, Mode::blend})
      if (!all_are(mode)) out.push_back({.mode = mode});
  } else {
    for (double const turn : {0.0, 0.25, 1.0})
      if (!all_are(Mode::rotate) || case_file.plan.volume.turn != turn)
        out.push_back({.mode = Mode::rotate, .turn = turn});
  }
  for (Recipe& recipe : out) recipe.adds_table = adds_table;
  return out;
}

std::vector<Recipe> other_laws(CaseFile const& case_file, Recipe const& recipe, bool unstructured) {
  VolumeOptions const& volume = case_file.plan.volume;
  std::vector<Recipe> out;
  for (Law const law : {Law::linear, Law::c1, Law::c2, Law::mixed, Law::matched}) {
    if (unstructured && law > Law::c2) break;
    if (recipe.law ? law == *recipe.law : !volume.laws_by_prediction && law == volume.law) continue;
    out.push_back(recipe);
    out.back().law = law;
  }
  return out;
}

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

Retried RecipeSearch::run(Trial const& first) const {
  Retried out;
  Recipe best;
  Trial least = first;
  out.json = {{"first", json_of("", first.badness)}, {"tried", nlohmann::json::array()}, {"kept", nullptr}};
  auto const attempt = [&](Recipe const& recipe) {
    if (!least.falls_short) return;
    std::string const keys = recipe.keys(unstructured);
    progress(keys);
    auto other = std::make_unique<CaseFile>(recipe.of(case_file));
    try {
      Trial const trial = make(*other);
      out.json["tried"].push_back(json_of(keys, trial.badness));
      if (!(trial.badness < least.badness)) return decide(nullptr);
      least = trial;
      best = recipe;
      decide(std::move(other));
    } catch (Error const& e) {
      out.json["tried"].push_back({{"keys", keys}, {"error", e.what()}});
      decide(nullptr);
    }
  };
  for (Recipe const& recipe : other_near_fields(case_file, unstructured)) attempt(recipe);
  for (Recipe const& recipe : other_laws(case_file, best, unstructured)) attempt(recipe);
  if (chains && case_file.plan.volume.order != OrderBy::prediction) {
    Recipe ordered = best;
    ordered.by_prediction = true;
    attempt(ordered);
  }
  if (smoothing && !case_file.guard.smooth) {
    Recipe smoothed = best;
    smoothed.smooth = true;
    attempt(smoothed);
  }
  std::size_t const tried = out.json["tried"].size();
  if (tried == 0) return out;
  if (!(least.badness < first.badness)) {
    out.text = fmt::format("{} other recipes for the same motion were tried, and none is better", tried);
    return out;
  }
  out.json["kept"] = best.keys(unstructured);
  out.text = fmt::format(
      "{} {} were inverted and {} beyond a limit; of {} other recipes {} leaves {} and {}: with these keys a case file "
      "gives this mesh",
      first.badness.inverted, cells, first.badness.fallen, tried, best.keys(unstructured), least.badness.inverted,
      least.badness.fallen);
  return out;
}

}  // namespace gridmorph::cli
