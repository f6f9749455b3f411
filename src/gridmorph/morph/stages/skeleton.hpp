// The stages of a morph of blocks: on the skeleton, the faces, edges and corners of all pieces.
#pragma once

#include <gridmorph/morph/detail/block_turns.hpp>
#include <gridmorph/morph/device_plan.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>

#include <cstddef>
#include <memory>
#include <string>

namespace gridmorph::stages {

/// The tables that the stages of a plan share.
template <class Exec>
using BlockTables = std::shared_ptr<detail::DevicePlan<Exec> const>;

inline Baseline read(kernels::Field<double> const& f) { return {f.x, f.y, f.z, f.stride}; }

/// What stages on a skeleton do with the tables they share.
template <class Exec>
class OnSkeleton {
 protected:
  using Memory = typename Exec::memory_space;

  explicit OnSkeleton(BlockTables<Exec> tables) : tables_(std::move(tables)) {}

  [[nodiscard]] detail::DevicePlan<Exec> const& plan() const { return *tables_; }
  void copy(char const* label, Exec const& exec, detail::WorkList<kernels::NodeCopy, Memory> const& list,
            kernels::Field<double> const& from, kernels::Field<double> const& to) const {
    kernels::copy_nodes(exec, label, list, plan().rotations, read(from), to);
  }
  [[nodiscard]] kernels::SideTable<Memory> sides(StageField<Exec> const& f) const {
    kernels::SideTable<Memory> table = plan().sides;
    table.c = read(f.residuals);
    return table;
  }
  template <bool Add>
  void sweep(Exec const& exec, detail::WorkList<kernels::SkeletonSweep, Memory> const& list,
             StageField<Exec> const& f) const {
    kernels::sweep_skeleton<Add>(exec, list, plan().lines.chains, plan().rotations, sides(f), plan().t.data(),
                                 read(f.ends), f.skeleton, plan().law_knots.data(),
                                 plan().turns.of_skeleton(f.number, f.of));
  }

 private:
  BlockTables<Exec> tables_;
};

/// First: the boundary's displacement goes to its slots, and how walls turn is taken from it. Linear where none does.
template <class Exec>
class BoundaryValues : OnSkeleton<Exec> {
 public:
  static inline std::string const region = "gridmorph::stage boundary";

  explicit BoundaryValues(BlockTables<Exec> tables) : OnSkeleton<Exec>(std::move(tables)) {}

  void enqueue(Exec const& exec, Baseline const&, StageField<Exec> const& f) const { set<false>(exec, f); }
  void rate(Exec const& exec, Baseline const&, StageField<Exec> const& f, StageField<Exec> const& r) const {
    set<false>(exec, f);
    set<true>(exec, r);
  }

 private:
  template <bool Rate>
  void set(Exec const& exec, StageField<Exec> const& f) const {
    kernels::scatter_boundary(exec, this->plan().boundary_slots, f.boundary, f.skeleton);
    this->copy("gridmorph::boundary::axis", exec, this->plan().boundary_projections, f.skeleton, f.skeleton);
    detail::BlockTurns<Exec, Rate>(this->plan(), f.number, f.of).of_walls(exec);
  }
};

/// The chains of one Stage of the plan: faces, edges and corners between known ends. Linear where nothing turns.
template <class Exec>
class LineSweep : OnSkeleton<Exec> {
 public:
  std::string region;

  /// The stage with this number.
  LineSweep(BlockTables<Exec> tables, std::size_t number)
      : OnSkeleton<Exec>(std::move(tables)), region(this->plan().stages[number].region), number_(number) {}

  void enqueue(Exec const& exec, Baseline const&, StageField<Exec> const& f) const { run<false>(exec, f); }
  void rate(Exec const& exec, Baseline const&, StageField<Exec> const& f, StageField<Exec> const& r) const {
    run<false>(exec, f);
    run<true>(exec, r);
  }

 private:
  template <bool Rate>
  void run(Exec const& exec, StageField<Exec> const& f) const {
    auto const& stage = this->plan().stages[number_];
    this->copy("gridmorph::chain_ends", exec, stage.ends, f.skeleton, f.ends);
    detail::BlockTurns<Exec, Rate>(this->plan(), f.number, f.of).of_ends(exec, stage);
    if (stage.side_lines.extent(0) > 0) {
      this->copy("gridmorph::side_residual::known", exec, stage.gathers, f.skeleton, f.residuals);
      kernels::fill_sides(exec, this->plan().lines.chains, this->sides(f), stage.side_lines, stage.corrected,
                          read(f.ends), f.residuals, this->plan().law_knots.data(),
                          this->plan().turns.of_skeleton(f.number, f.of));
    }
    this->template sweep<false>(exec, stage.sweeps, f);
  }

  std::size_t number_;
};

/// One SpreadPass of the plan: ends of lines go back onto slip surfaces, and the correction along the lines between.
template <class Exec>
class SlipSpread : OnSkeleton<Exec> {
 public:
  static inline std::string const region = "gridmorph::slip surfaces";

  /// The pass with this number.
  SlipSpread(BlockTables<Exec> tables, std::size_t number) : OnSkeleton<Exec>(std::move(tables)), number_(number) {}

  void enqueue(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    project<false>(exec, f, f);
    this->template sweep<true>(exec, pass().sweeps, f);
  }

  void rate(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& r) const {
    project<true>(exec, f, r);
    enqueue(exec, x, f);
    this->template sweep<true>(exec, pass().sweeps, r);
  }

 private:
  [[nodiscard]] detail::DeviceSpread<Exec> const& pass() const { return this->plan().spreads[number_]; }

  /// End values of `to`, where the displacement is that of `at`; with `Rate`, their derivative.
  template <bool Rate>
  void project(Exec const& exec, StageField<Exec> const& at, StageField<Exec> const& to) const {
    kernels::slip_ends(exec, pass().first_value, pass().n_values,
                       kernels::SlipEndValues<typename Exec::memory_space, Rate>{
                           pass().ends, pass().baselines, this->plan().surfaces.surfaces, this->plan().rotations,
                           read(at.skeleton), read(to.skeleton), to.ends});
  }

  std::size_t number_;
};

}  // namespace gridmorph::stages
