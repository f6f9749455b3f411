// Other ways of making one motion, as keys of a case file: what [guard] retry tries.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/quality/quality.hpp>

#include <nlohmann/json.hpp>

#include <compare>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// How a morph is made; what is not set stays as the case file has it.
struct Recipe {
  std::optional<BoundaryLayer::Mode> mode = {};  ///< of every near field
  std::optional<double> turn = {};
  std::optional<Law> law = {};
  bool adds_table = false;  ///< the mode is that of a near field of all moving walls, where the case file has no table
  bool by_prediction = false;  ///< order of chains
  bool smooth = false;

  /// The case file with these keys.
  [[nodiscard]] CaseFile of(CaseFile const& case_file) const;
  /// `[boundary_layer] mode = "rotate", [volume] turn = 0.25`: the keys with which a case file gives the same mesh.
  [[nodiscard]] std::string keys(bool unstructured) const;
};

/// Near fields that translate, and that turn and hand on nothing, a quarter and all of it; those that the case file has
/// are left out, and all where it has `boundary_layer = false`. Of elements: that translate, rotate or blend, of all
/// moving walls where it has no [boundary_layer].
std::vector<Recipe> other_near_fields(CaseFile const& case_file, bool unstructured);
/// `recipe` with each of the laws that it does not have; elements have three.
std::vector<Recipe> other_laws(CaseFile const& case_file, Recipe const& recipe, bool unstructured);

/// How bad a mesh is: less is better, in this order.
struct Badness {
  Index inverted = 0, fallen = 0;
  double lost_determinant = 0;  ///< 1 - the smallest one

  auto operator<=>(Badness const&) const = default;
};
Badness badness_of(QualityReport const& quality);

/// What came of other recipes.
struct Retried {
  std::string text;  ///< for people: what was tried, and with which keys it comes out as it did; empty: nothing was
  nlohmann::json
      json;  ///< "first", "tried": {"keys", "newly_inverted", "beyond_limits", "min_determinant"}, "kept": keys or null
};

/// What guards, other recipes and freezing did to a run.
struct Guarded {
  std::vector<std::string> notes;                  ///< for people
  nlohmann::json json = nlohmann::json::object();  ///< "retry", "frozen_guard" of reports, where there is any
};

/// A mesh made by some recipe.
struct Trial {
  Badness badness;
  bool falls_short = true;
};

/// Tries recipes until one does not fall short: near fields, with the best of them laws, and (`chains`, `smoothing`)
/// with the best of these the predicted order of chains and smoothing. make(case file): makes the mesh so, throws Error
/// where it cannot be made; decide(case file): null where what was made is not better than what was there before it, or
/// the case file that it was made by.
struct RecipeSearch {
  CaseFile const& case_file;
  bool unstructured, chains, smoothing;
  std::string cells;  ///< "cells" or "elements"
  std::function<void(std::string const& keys)> progress;
  std::function<Trial(CaseFile const&)> make;
  std::function<void(std::unique_ptr<CaseFile>)> decide;

  [[nodiscard]] Retried run(Trial const& first) const;
};

}  // namespace gridmorph::cli
