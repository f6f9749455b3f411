// Other ways of making one motion, as keys of a case file: what [guard] retry tries.
#pragma once

#include <gridmorph/app/casefile/case_file.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// How a morph is made; what is not set stays as the case file has it.
struct Recipe {
  std::optional<BoundaryLayer::Mode> mode = {};  ///< of every near field
  std::optional<double> turn = {};
  std::optional<Law> law = {};
  bool by_prediction = false;  ///< order of chains
  bool smooth = false;

  /// The case file with these keys.
  [[nodiscard]] CaseFile of(CaseFile const& case_file) const;
  /// `[boundary_layer] mode = "rotate", [volume] turn = 0.25`: the keys with which a case file gives the same mesh.
  [[nodiscard]] std::string keys(bool unstructured) const;
};

/// Near fields that translate, and that turn and hand on nothing, a quarter and all of it; those that the case file names are left out, and all
/// where it has no near field. Of elements: that translate, rotate or blend.
std::vector<Recipe> other_near_fields(CaseFile const& case_file, bool unstructured);
/// `recipe` with each of the laws that it does not have; elements have three.
std::vector<Recipe> other_laws(CaseFile const& case_file, Recipe const& recipe, bool unstructured);

}  // namespace gridmorph::cli
