// What `gridmorph plan`, reports and headlines say of a plan, by kind of mesh.
#pragma once

#include <gridmorph/plan/plan.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace gridmorph::cli {

/// The stages of blocks with their chains; of very many chains, unless `all` are wanted, an overview and the first ones
/// of each stage.
std::string block_plan_text(Plan const& plan, bool all);
/// The name of each stage, one line per chain, how many cells it morphs; finalize passes at the end.
nlohmann::json block_plan_json(Plan const& plan);

/// One line or two: near field and background mesh, of each part with moving walls.
std::string element_plan_text(PreparedUnstructured const& prepared);
nlohmann::json element_plan_json(PreparedUnstructured const& prepared, Index n_elements);

/// A plan of elements without parts, with what was found on the way.
struct PlannedPart {
  UnstructuredReport const& report;
  UnstructuredPlan const& plan;
  std::size_t number;
};
/// The parts of a plan, or the plan itself where it has none.
std::vector<PlannedPart> planned_parts(PreparedUnstructured const& prepared);

}  // namespace gridmorph::cli
