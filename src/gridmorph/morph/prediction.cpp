#include <gridmorph/core/error.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/morph/predictor.hpp>

#include <algorithm>
#include <memory>

namespace gridmorph {

void join(PredictedCells& all, PredictedCells const& some) {
  if (some.cells == 0) return;
  auto const smaller = [](CellValue& a, CellValue const& b) {
    bool const taken = b.zone >= 0 && (a.zone < 0 || b.value < a.value);
    if (taken) a = b;
    return taken;
  };
  if (smaller(all.scaled_jacobian, some.scaled_jacobian)) all.scaled_jacobian_before = some.scaled_jacobian_before;
  if (smaller(all.determinant, some.determinant)) all.determinant_before = some.determinant_before;
  smaller(all.kept, some.kept);
  smaller(all.angle_deg, some.angle_deg);
  for (int d = 0; d < 3; ++d) {
    CellValue& a = all.relative_displacement[d];
    CellValue const& b = some.relative_displacement[d];
    if (a.zone < 0 || b.value > a.value) a = b;
  }
  all.cells += some.cells;
  all.inverted += some.inverted;
}

bool is_worse(PredictedCells const& a, PredictedCells const& b) {
  auto const worst = [](PredictedCells const& cells) {
    return cells.scaled_jacobian.zone >= 0 ? cells.scaled_jacobian.value : cells.kept.value;
  };
  return worst(a) < worst(b);
}

void sort_worst_first(std::vector<PredictedGroup>& groups) {
  std::ranges::stable_sort(groups, is_worse, &PredictedGroup::cells);
}

PredictionOf predictions(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan,
                         PredictionOptions const& options) {
  PreparedMorph const* const blocks = PlanAccess::blocks(plan);
  if (mesh.is_structured() != (blocks != nullptr) || mesh.n_nodes() != plan.n_nodes())
    throw ConfigError("gridmorph::predict: the plan is of another mesh; give the mesh that it was made for");
  if (blocks == nullptr) return predictions_of_elements(host, mesh, plan, options);
  return [plan, of = std::make_shared<Predictor>(host, *blocks, options)](std::span<Vec3 const> boundary) {
    return of->predict(boundary);
  };
}

Prediction predict(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan,
                   std::span<Vec3 const> boundary, PredictionOptions const& options) {
  return predictions(host, mesh, plan, options)(boundary);
}

}  // namespace gridmorph
