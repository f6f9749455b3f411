// The kernels that run under a plan, each by itself: what to launch for a plan, on how many nodes, moving how many
// bytes.
#pragma once

#include "node_arrays.hpp"

#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/morph/device_plan.hpp>
#include <gridmorph/morph/morpher_access.hpp>
#include <gridmorph/morph/stages/block_volume.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <functional>
#include <memory>
#include <vector>

namespace gridmorph::bench {

/// What a benchmark times, and what it has touched then.
struct Timed {
  std::function<void()> launch;
  std::int64_t nodes = 0;
  double bytes_per_node = 0;
};

/// The tables of a plan in an execution space, all displacements of its workspace small and alike, as all rotations.
template <class Exec>
std::shared_ptr<detail::DevicePlan<Exec>> device_plan(Exec const& exec, Plan const& plan,
                                                      kernels::Field<double const> const& x) {
  auto device = std::make_shared<detail::DevicePlan<Exec>>(exec, plan, x, 1);
  for (auto const* work : {&device->skeleton, &device->ends, &device->residuals})
    Kokkos::deep_copy(exec, work->values, 1e-9);
  Kokkos::deep_copy(exec, device->turns.ends, 1e-9);
  return device;
}

struct Touched {
  std::int64_t nodes = 0, parameters = 0;
};

/// Nodes inside pieces, and the line parameters that the pass over them reads.
inline Touched touched_by_volume(Plan const& plan) {
  Touched sum;
  auto const size = [&](int box) {
    auto const& n = plan.boxes[box].n;
    return std::int64_t(n[0]) * n[1] * n[2];
  };
  for (int box = 0; box < int(plan.boxes.size()); ++box) sum.nodes += size(box);
  auto const add = [&](std::vector<VolumePart> const& parts) {
    for (VolumePart const& part : parts)
      if (part.term.t >= 0) sum.parameters += size(part.box);
  };
  for (Stage const& stage : plan.stages) add(stage.volume);
  for (SpreadPass const& pass : plan.spreads) add(pass.volume);
  return sum;
}

struct Volume {
  template <class Exec>
  Timed operator()(Exec const& exec, PreparedMorph const& prepared,
                   NodeArrays<typename Exec::memory_space> const& x) const {
    using Memory = typename Exec::memory_space;
    auto const d = device_plan(exec, prepared.plan(), x.read());
    VectorView<Memory> const nodes(x);
    stages::StageField<Exec> field;
    field.ends = d->ends.batch()[0];
    field.residuals = d->residuals.batch()[0];
    auto kernel = stages::volume_pass(*d, nodes.array(), field, true);
    kernel.out[kernel.n_fields++] = nodes.array();
    Touched const touched = touched_by_volume(prepared.plan());
    return {[=] { kernels::pass_volume(exec, d->volume_items, kernel); }, touched.nodes,
            48 + 8 * double(touched.parameters) / double(touched.nodes)};
  }
};

struct Apply {
  template <class Exec>
  Timed operator()(Exec const& exec, PreparedMorph const& prepared,
                   NodeArrays<typename Exec::memory_space> const& x) const {
    Plan const& plan = prepared.plan();
    auto const morpher = MorpherAccess::of(exec, plan, x);
    Kokkos::View<Vec3*, typename Exec::memory_space> const boundary("gridmorph::bench::boundary",
                                                                    plan.boundary_nodes.size());
    Kokkos::deep_copy(exec, boundary, Vec3{1e-9, 2e-9, 3e-9});
    return {[=] { morpher.positions(exec, boundary, x); }, plan.n_nodes,
            48 + 8 * double(touched_by_volume(plan).parameters) / double(plan.n_nodes)};
  }
};

struct SkeletonSweep {
  template <class Exec>
  Timed operator()(Exec const& exec, PreparedMorph const& prepared,
                   NodeArrays<typename Exec::memory_space> const& x) const {
    auto const d = device_plan(exec, prepared.plan(), x.read());
    auto const& list = d->stages.front().sweeps;
    typename detail::DevicePlan<Exec>::Sweep const kernel{
        list.entries, list.first_item, d->lines.chains,      d->rotations,
        d->sides,     d->t.data(),     d->ends.read().first, d->skeleton.batch().first};
    std::int64_t nodes = 0;
    for (auto const& sweep : prepared.plan().stages.front().sweeps) nodes += std::int64_t(sweep.n_p) * sweep.n_q;
    return {
        [=] { kernels::launch("gridmorph::bench::skeleton_sweep", exec, 0, d->stages.front().sweeps.n_items, kernel); },
        nodes, 32};
  }
};

struct NodeCopies {
  template <class Exec>
  Timed operator()(Exec const& exec, PreparedMorph const& prepared,
                   NodeArrays<typename Exec::memory_space> const& x) const {
    using Memory = typename Exec::memory_space;
    auto const d = device_plan(exec, prepared.plan(), x.read());
    VectorView<Memory> const field(x);
    kernels::CopyNodes<Memory, kernels::TileShape<Exec>::row, kernels::VectorArray, true> const kernel{
        d->skeleton_nodes.entries,
        d->skeleton_nodes.first_item,
        d->rotations,
        d->skeleton.read().first,
        field.array(),
        field.array()};
    std::int64_t nodes = 0;
    for (auto const& copy : prepared.plan().skeleton_nodes) nodes += std::int64_t(copy.n_p) * copy.n_q;
    return {[=] { kernels::launch("gridmorph::bench::node_copy", exec, 0, d->skeleton_nodes.n_items, kernel); }, nodes,
            72};
  }
};

struct SideResiduals {
  template <class Exec>
  Timed operator()(Exec const& exec, PreparedMorph const& prepared,
                   NodeArrays<typename Exec::memory_space> const& x) const {
    auto const d = device_plan(exec, prepared.plan(), x.read());
    auto const& stage = d->stages.front();
    typename detail::DevicePlan<Exec>::Copy const gather{stage.copies.entries, stage.copies.first_item, d->rotations,
                                                         d->skeleton.read().first, d->ends.batch().first};
    return {[=] {
              auto const& s = d->stages.front();
              kernels::launch("gridmorph::bench::side_residual::known", exec, s.ends.n_items, s.copies.n_items, gather);
              kernels::fill_sides(exec, s.side_nodes, d->lines.chains, d->sides, s.across, d->ends.read().first,
                                  d->known_sides(d->ends.batch().first), d->residuals.batch().first,
                                  d->law_knots.data(), d->turns.of_skeleton(0, 0), s.turns);
            },
            std::int64_t(prepared.plan().stages.front().sides.t.size()), 152};
  }
};

}  // namespace gridmorph::bench
