// The tables of a plan in one memory space: those of all stages and finalize passes one after another, numbers shifted
// to match, with what a morph needs for work besides.
#pragma once

#include <gridmorph/core/enqueue_copy.hpp>
#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/side_residual.hpp>
#include <gridmorph/kernels/slip_end.hpp>
#include <gridmorph/plan/plan.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace gridmorph::stages {
template <class Exec>
struct BlockCommon;
}

namespace gridmorph::detail {

/// A table of a Morpher; see enqueue_copy().
template <class T, class Exec>
Kokkos::View<T*, typename Exec::memory_space> table(Exec const& exec, std::vector<T> const& host,
                                                    std::string const& what) {
  return enqueue_copy(exec, host, "gridmorph::Morpher::" + what);
}

/// A list of work, each entry good for `items(entry)` work items.
template <class T, class Memory>
struct WorkList : kernels::TileList<T, Memory> {
  WorkList() = default;
  template <class Exec, class Items>
  WorkList(Exec const& exec, std::vector<T> const& list, Items const& items, char const* what) {
    std::vector<Index> first{0};
    for (T const& entry : list) first.push_back(first.back() + items(entry));
    this->entries = table(exec, list, what);
    this->first_item = table(exec, first, std::string(what) + "::first_item");
    this->n_items = first.back();
  }
};

/// Three arrays per field, one field after another.
template <class Memory>
struct Workspace {
  Kokkos::View<double*, Memory> values;
  Index n = 0;

  Workspace() = default;
  template <class Exec>
  Workspace(Exec const& exec, Index size, int fields, char const* what)
      : values(Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, std::string("gridmorph::Morpher::") + what),
               3 * size * fields),
        n(size) {}
  [[nodiscard]] kernels::FieldBatch<double> batch() const {
    return {{values.data(), values.data() + n, values.data() + 2 * n}, 3 * n};
  }
  [[nodiscard]] kernels::FieldBatch<double const> read() const {
    return {{values.data(), values.data() + n, values.data() + 2 * n}, 3 * n};
  }
};

template <class Exec>
struct DeviceStage {
  using Memory = typename Exec::memory_space;
  std::string region;  ///< name in profiles
  /// To what the stage reads: ends of its chains, then known nodes of its sides, which have their places behind all
  /// ends.
  WorkList<kernels::NodeCopy, Memory> copies;
  kernels::TileList<kernels::NodeCopy, Memory> ends;       ///< of `copies`
  Kokkos::View<kernels::NodeCopy const*, Memory> gathers;  ///< of `copies`
  WorkList<kernels::SkeletonSweep, Memory> sweeps;
  WorkList<kernels::SideNodes, Memory> side_nodes;
  Kokkos::View<kernels::SideLine*, Memory> side_lines;
  Kokkos::View<std::int32_t*, Memory> corrected;
  Kokkos::View<kernels::SideLine*, Memory> across;           ///< pieces of sides that rows run across
  bool turns = false;                                        ///< whether rotations come to its ends
  Kokkos::View<kernels::NearFieldLine*, Memory> near_field;  ///< lines that turn with their wall
  Index first_end_value = 0, n_end_values = 0;
};

template <class Exec>
struct DeviceSpread {
  using Memory = typename Exec::memory_space;
  Kokkos::View<kernels::SlipEnd*, Memory> ends;               ///< off the host kind after kind
  Kokkos::View<kernels::SlipEndBaseline*, Memory> baselines;  ///< per end
  Kokkos::View<Index*, Memory> at_rest;                       ///< values of ends that slide on nothing
  kernels::ItemsByKind<kernels::SlipKinds> items;
  WorkList<kernels::SkeletonSweep, Memory> sweeps;
  Index first_value = 0, n_values = 0;
};

/// All stages' and passes' tables put one behind the other on the host, with their numbers shifted.
struct JoinedTables {
  LineTables lines;
  gridmorph::SideTables sides;
  std::vector<kernels::VolumeBox> boxes;
  std::vector<kernels::VolumeTerm> terms;
};

/// How near fields turn, and what their turn needs for work (kernels/root_turn.hpp, turned_ends.hpp). Empty where none
/// does.
template <class Exec>
struct DeviceTurns {
  using Memory = typename Exec::memory_space;
  kernels::RootTable<Memory> table;
  kernels::BodyWalls<Memory> bodies;                        ///< whose nodes are roots
  Kokkos::View<kernels::VectorMoments*, Memory> body_sums;  ///< of one field at a time
  Workspace<Memory> slots, free, raw, outer;                ///< per slot; per root
  Workspace<Memory> mean;                                   ///< per body
  Workspace<Memory> at_end, end_turns;                      ///< 3 per end wall; per line end
  Kokkos::View<double*, Memory> ends;                       ///< of fields, each as kernels::TurnedEnds has them
  Workspace<Memory> end_position, end_pivot, swept_position, side_position;
  Index n_ends = 0;

  [[nodiscard]] bool any() const { return table.roots.extent(0) > 0; }
  [[nodiscard]] Index ends_stride() const { return kernels::TurnedEnds<double>::components * n_ends; }
  [[nodiscard]] kernels::TurnedEnds<double> ends_of(int f) const { return {ends.data() + f * ends_stride(), n_ends}; }
  /// Of field f; where f holds the rates of field `of`, both.
  [[nodiscard]] kernels::TurnedEndsWithRates read_ends(int f, int of) const {
    auto const values = ends_of(of), rates = ends_of(f);
    kernels::TurnedEndsWithRates both{{values.first, n_ends}};
    if (f != of) both.rates = {rates.first, n_ends};
    return both;
  }
  /// What sweeps and residuals of field f ask for.
  [[nodiscard]] kernels::SkeletonTurns of_skeleton(int f, int of) const {
    if (!any()) return {};
    return {read_ends(f, of), end_turns.read()[f], slots.batch()[f], swept_position.read()[0], side_position.read()[0]};
  }
};

template <class Exec>
struct TransposedPlan;

template <class Exec>
struct DevicePlan {
  using Memory = typename Exec::memory_space;
  using Shape = kernels::TileShape<Exec>;
  using Copy = kernels::CopyNodes<Memory, Shape::row>;
  using SideResidual = kernels::SideResidual<Memory, Shape::row>;
  using Sweep = kernels::SweepSkeleton<Memory, Shape::row, false>;
  using Volume = kernels::VolumePass<Memory, Shape>;
  using Parameters = kernels::LineParameters<Memory, Shape::lines>;

  kernels::LineTable<Memory> lines;
  kernels::SideTable<Memory> sides;
  Kokkos::View<Mat3*, Memory> rotations;
  SlipSurfaceTable<Memory> surfaces;
  Kokkos::View<Index*, Memory> boundary_slots;
  WorkList<kernels::NodeCopy, Memory> boundary_projections, skeleton_nodes;
  std::vector<DeviceStage<Exec>> stages;
  std::vector<DeviceSpread<Exec>> spreads;
  WorkList<kernels::VolumeBox, Memory> boxes;  ///< off the host kind after kind
  kernels::ItemsByKind<kernels::VolumeKind> volume_items;
  Kokkos::View<kernels::VolumeTerm*, Memory> terms;
  Kokkos::View<double*, Memory> t;          ///< line parameters
  Kokkos::View<double*, Memory> law_knots;  ///< of laws that are tables
  Workspace<Memory> skeleton, residuals;
  Workspace<Memory> ends;  ///< of lines, then displacements of known nodes of sides, side by side in one list of copies
  Index n_end_values = 0;
  DeviceTurns<Exec> turns;
  int fields = 1;
  std::shared_ptr<TransposedPlan<Exec> const> transposed;   ///< where gradients are asked for
  std::shared_ptr<stages::BlockCommon<Exec> const> common;  ///< where parts have motions in common

  /// Displacements of known nodes of sides, as side arrays have them, in what `ends` has of a field.
  [[nodiscard]] kernels::Field<double> known_sides(kernels::Field<double> const& ends_of_field) const {
    auto const& [x, y, z, stride] = ends_of_field;
    return {x + n_end_values, y + n_end_values, z + n_end_values, stride};
  }

  DevicePlan(Exec const& exec, Plan const& plan, kernels::Field<double const> x, int n_fields);
};

}  // namespace gridmorph::detail
