// A plan of either kind as what a Morpher runs: a list of stages, the fields they work on, and who writes the nodes.
#pragma once

#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/morph/stages/frozen_shifts.hpp>
#include <gridmorph/morph/stages/joint_slip.hpp>
#include <gridmorph/morph/stages/mesh_parts.hpp>
#include <gridmorph/morph/stages/skeleton.hpp>
#include <gridmorph/morph/stages/write_nodes.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace gridmorph::stages {

/// Visited by the host, once per stage and call.
template <class Exec>
using Stage = std::variant<BoundaryValues<Exec>, LineSweep<Exec>, AddCommon<Exec>, SlipSpread<Exec>, WallMotion<Exec>,
                           TakeTurns<Exec>, NearField<Exec>, NearLayers<Exec>, FarField<Exec>, AddTurns<Exec>,
                           StartResidual<Exec>, AskBoundary<Exec>, MeanOfImages<Exec>, JointNodes<Exec>, GoAlong<Exec>,
                           SpreadResidual<Exec>, FollowCorners<Exec>, CopyNodes<Exec>, MorphParts<Exec>>;

template <class Exec>
struct StageList {
  std::vector<Stage<Exec>> stages;
  std::vector<StageField<Exec>> fields;  ///< that one pass through the stages may have
  std::variant<WriteBlocks<Exec>, WriteElements<Exec>> writer;
  std::optional<FrozenShifts<Exec>> shifts;  ///< after it
  std::optional<GivenSlip<Exec>> given{};    ///< before all stages; shifts know what is given as the caller gives it
};

/// x: only while the list is made.
template <class Exec>
StageList<Exec> stage_list(Exec const& exec, Plan const& plan, Baseline const& x, MorpherOptions const& options) {
  int const n_fields = std::max(options.fields, options.velocity || options.transpose ? 2 : 1);
  auto const tables = std::make_shared<detail::DevicePlan<Exec>>(exec, plan, x, n_fields);
  if (options.transpose) tables->transposed = std::make_shared<detail::TransposedPlan<Exec> const>(exec, *tables);
  if (!plan.common.empty())
    tables->common = std::make_shared<BlockCommon<Exec> const>(exec, plan, n_fields, options.transpose,
                                                               options.velocity || options.transpose);
  StageList<Exec> out{{}, {}, WriteBlocks<Exec>(tables), {}};
  out.stages.emplace_back(BoundaryValues<Exec>(tables));
  for (std::size_t n = 0; n < tables->stages.size(); ++n) out.stages.emplace_back(LineSweep<Exec>(tables, n));
  if (tables->common) out.stages.emplace_back(AddCommon<Exec>(tables));
  for (std::size_t n = 0; n < tables->spreads.size(); ++n) out.stages.emplace_back(SlipSpread<Exec>(tables, n));
  for (int f = 0; f < n_fields; ++f) {
    StageField<Exec> field;
    field.number = field.of = f;
    field.skeleton = tables->skeleton.batch()[f];
    field.ends = tables->ends.batch()[f];
    field.residuals = tables->residuals.batch()[f];
    out.fields.push_back(field);
  }
  if (options.smoothing && options.smoothing->n_modes > 0)
    out.shifts.emplace(exec, *options.smoothing, Index(plan.boundary_nodes.size()), plan.n_nodes, tables->rotations,
                       options.transpose);
  return out;
}

template <class Exec>
StageList<Exec> stage_list(Exec const& exec, UnstructuredPlan const& plan, Baseline const& x,
                           MorpherOptions const& options) {
  std::vector<Vec3> const positions = options.transpose ? host_positions(exec, x, plan.n_nodes) : std::vector<Vec3>();
  // Stages make what their transposes need where positions come with them.
  auto const* const back = options.transpose ? &positions : nullptr;
  StageList<Exec> out{{}, {}, WriteElements<Exec>(), {}};
  bool const two = options.velocity || options.transpose;
  if (plan.parts.empty()) {
    ElementStages<Exec> made(exec, plan, options.velocity, back);
    for (auto* const list : {&made.walls, &made.others})
      for (auto& any : *list) std::visit([&](auto& stage) { out.stages.emplace_back(std::move(stage)); }, any);
  } else {
    out.stages.emplace_back(MorphParts<Exec>(exec, plan, x, options.velocity, back));
  }
  if (!plan.given_slip.empty()) out.given.emplace(exec, plan);
  for (int f = 0; f < (two ? 2 : 1); ++f) {
    StageField<Exec> field;
    if (plan.parts.empty()) {
      field = element_field(exec, plan, f == 1, options.transpose);
    } else {
      field.u = room_for<Vec3>(exec, std::size_t(plan.n_nodes), "gridmorph::Morpher::u");
      if (options.transpose && f == 1)
        field.given = room_for<Vec3>(exec, plan.known.size(), "gridmorph::Morpher::given");
    }
    if (out.given) field.kept_given = room_for<Vec3>(exec, plan.known.size(), "gridmorph::Morpher::kept_given");
    out.fields.push_back(field);
  }
  if (options.smoothing && options.smoothing->n_modes > 0)
    out.shifts.emplace(exec, *options.smoothing, Index(plan.known.size()), plan.n_nodes,
                       Kokkos::View<Mat3*, typename Exec::memory_space>(), options.transpose);
  compat::fence(exec, "gridmorph::Morpher (host tables of the plan may go)");
  return out;
}

}  // namespace gridmorph::stages
