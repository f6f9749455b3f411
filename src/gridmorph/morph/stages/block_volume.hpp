// The one pass through the volume of a morph of blocks, as its stages have left their fields.
#pragma once

#include <gridmorph/morph/device_plan.hpp>
#include <gridmorph/morph/stages/block_common.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>

namespace gridmorph::stages {

inline Baseline read(kernels::Field<double> const& f) { return {f.x, f.y, f.z, f.stride}; }

/// first: the first of the fields to be written, neighbours in the workspace; the caller adds where they go.
template <class Exec>
kernels::VolumePass<typename Exec::memory_space, kernels::TileShape<Exec>> volume_pass(
    detail::DevicePlan<Exec> const& plan, kernels::VectorArray const& x, StageField<Exec> const& first, bool moves) {
  kernels::VolumePass<typename Exec::memory_space, kernels::TileShape<Exec>> out{
      plan.boxes.entries,
      plan.terms,
      plan.boxes.first_item,
      plan.lines.chains,
      plan.rotations,
      plan.sides,
      plan.t.data(),
      plan.law_knots.data(),
      {read(first.ends), plan.ends.read().stride},
      {read(first.residuals), plan.residuals.read().stride},
      {plan.turns.read_ends(first.number, first.of), plan.turns.ends_stride()},
      x,
      {},
      0,
      moves};
  if (plan.common) out.common = plan.common->of(first);
  return out;
}

}  // namespace gridmorph::stages
