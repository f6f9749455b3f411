// What `gridmorph plan`, reports and headlines say of a plan, by kind of mesh.
#pragma once

#include <gridmorph/plan/plan.hpp>
#include <gridmorph/plan/planned_elements.hpp>

#include <nlohmann/json.hpp>

#include <string>

namespace gridmorph::cli {

/// The stages of blocks with their chains; of very many chains, unless `all` are wanted, an overview and the first ones
/// of each stage.
std::string block_plan_text(Plan const& plan, bool all);
/// The name of each stage, one line per chain, how many cells it morphs; finalize passes at the end.
nlohmann::json block_plan_json(Plan const& plan);

/// One line or two: near field and background mesh, of each part with moving walls.
std::string element_plan_text(PlannedElements const& planned);
nlohmann::json element_plan_json(PlannedElements const& planned, Index n_elements);

}  // namespace gridmorph::cli
