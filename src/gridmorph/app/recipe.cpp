#include <gridmorph/app/recipe.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace gridmorph::cli {

namespace {

using Mode = BoundaryLayer::Mode;

constexpr std::array<char const*, 3> mode_names{"translate", "rotate", "blend"};
constexpr std::array<char const*, 5> law_names{"linear", "c1", "c2", "mixed", "matched"};

}  // namespace

CaseFile Recipe::of(CaseFile const& case_file) const {
  CaseFile out = case_file;
  if (mode)
    for (BoundaryLayer& layer : out.plan.boundary_layers) layer.mode = *mode;
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
  auto const& layers = case_file.plan.boundary_layers;
  if (layers.empty()) return {};
  auto const all_are = [&](Mode mode) {
    return std::ranges::all_of(layers, [&](BoundaryLayer const& layer) { return layer.mode == mode; });
  };
  std::vector<Recipe> out;
  if (!all_are(Mode::translate)) out.push_back({.mode = Mode::translate});
  if (unstructured) {
    for (Mode const mode : {Mode::rotate, Mode::blend})
      if (!all_are(mode)) out.push_back({.mode = mode});
    return out;
  }
  for (double const turn : {0.0, 0.25, 1.0})
    if (!all_are(Mode::rotate) || case_file.plan.volume.turn != turn)
      out.push_back({.mode = Mode::rotate, .turn = turn});
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

}  // namespace gridmorph::cli
