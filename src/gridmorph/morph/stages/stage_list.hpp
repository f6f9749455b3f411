// A plan of either kind as what a Morpher runs: a list of stages, the fields they work on, and who writes the nodes.
#pragma once

#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/listed_nodes.hpp>
#include <gridmorph/mesh/vector_view.hpp>
#include <gridmorph/morph/stages/block_volume.hpp>
#include <gridmorph/morph/stages/frozen_shifts.hpp>
#include <gridmorph/morph/stages/joint_slip.hpp>
#include <gridmorph/morph/stages/mesh_parts.hpp>
#include <gridmorph/morph/stages/skeleton.hpp>
#include <gridmorph/morph/stages/transposed_tables.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace gridmorph::stages {

/// Nodes of blocks: those of the skeleton from their slots, those inside pieces by the one pass through the volume.
template <class Exec>
class WriteBlocks {
 public:
  using Out = VectorView<typename Exec::memory_space>;

  explicit WriteBlocks(BlockTables<Exec> tables) : tables_(std::move(tables)) {}

  /// The fields are neighbours in the workspace.
  template <bool Move>
  void write(Exec const& exec, Baseline const&, kernels::VectorArray const& x, std::span<StageField<Exec> const> fields,
             std::span<Out const> out) const {
    for (std::size_t done = 0; done < out.size(); done += kernels::most_fields_at_once) {
      std::size_t const n = std::min<std::size_t>(out.size() - done, kernels::most_fields_at_once);
      write_at_once<Move>(exec, x, fields.subspan(done, n), out.subspan(done, n));
    }
  }

  /// Gradients of the skeleton, from those of its nodes; nodes inside pieces hand theirs to the stages.
  void transpose(Exec const& exec, StageField<Exec> const& g) const {
    using kernels::ClearVectors;
    auto const& plan = *tables_;
    kernels::launch("gridmorph::transposed::clear", exec, 0, plan.skeleton.n, ClearVectors{g.skeleton});
    kernels::copy_back<true>("gridmorph::transposed::skeleton", exec, plan.transposed->skeleton_nodes, plan.rotations,
                             g.nodes, g.skeleton);
    detail::BlockTurnGradients<Exec>(plan, 0, g.number).clear(exec);
  }

 private:
  template <bool Move>
  void write_at_once(Exec const& exec, kernels::VectorArray const& x, std::span<StageField<Exec> const> fields,
                     std::span<Out const> out) const {
    auto const& plan = *tables_;
    auto volume = volume_pass(plan, x, fields.front(), Move);
    for (Out const& field : out) {
      kernels::write_skeleton_nodes<Move>(exec, plan.skeleton_nodes, plan.rotations,
                                          read(fields[volume.n_fields].skeleton), field.array(), x);
      volume.out[volume.n_fields++] = field.array();
    }
    kernels::pass_volume(exec, plan.volume_items, volume);
  }

  BlockTables<Exec> tables_;
};

/// Nodes of elements, each with its displacement in StageField::u.
template <class Exec>
struct WriteElements {
  using Out = VectorView<typename Exec::memory_space>;

  template <bool Move>
  void write(Exec const& exec, Baseline const& x, kernels::VectorArray const&, std::span<StageField<Exec> const> fields,
             std::span<Out const> out) const {
    for (std::size_t f = 0; f < out.size(); ++f)
      kernels::launch(Move ? "gridmorph::move" : "gridmorph::write", exec, 0, out[f].size(),
                      kernels::WriteNodes<Move>{fields[f].u.data(), x, out[f].array()});
  }

  void transpose(Exec const& exec, StageField<Exec> const& g) const {
    kernels::launch("gridmorph::transposed::nodes", exec, 0, Index(g.u.extent(0)),
                    kernels::ReadNodes{g.nodes, g.u.data()});
    clear<Vec3>(exec, g.given);
    clear<kernels::AffineMotion>(exec, g.frames);
  }
};

/// Visited by the host, once per stage and call.
template <class Exec>
using Stage = std::variant<BoundaryValues<Exec>, LineSweep<Exec>, AddCommon<Exec>, SlipSpread<Exec>, WallMotion<Exec>,
                           TakePassage<Exec>, TakeTurns<Exec>, NearField<Exec>, NearLayers<Exec>, NearFit<Exec>,
                           FarField<Exec>, AddTurns<Exec>, AddPassage<Exec>, StartResidual<Exec>,
                           PrescribeAtBoundary<Exec>, MeanOfImages<Exec>, JointNodes<Exec>, GoAlong<Exec>,
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
      field.u = room_for<Vec3>(exec, plan.n_nodes, "gridmorph::Morpher::u");
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
