#include <gridmorph/core/error.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/morph/detail/baseline.hpp>
#include <gridmorph/morph/detail/block_turns.hpp>
#include <gridmorph/morph/device_plan.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/morph/unstructured_morpher.hpp>
#include <gridmorph/plan/boundary_size.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <algorithm>
#include <string>

namespace gridmorph {
namespace {

using detail::FlatBaseline;
using detail::ProfilingRegion;
using detail::require_all_nodes;
using detail::require_as_many;

kernels::Field<double const> read(kernels::Field<double> const& f) { return {f.x, f.y, f.z, f.stride}; }

/// Regions that are not of one stage.
struct {
  std::string slip = "gridmorph::slip surfaces", volume = "gridmorph::all nodes";
} const region_names;

}  // namespace

template <class Exec>
struct Morpher<Exec>::State : detail::DevicePlan<Exec> {
  using Base = detail::DevicePlan<Exec>;
  using Shape = typename Base::Shape;

  In baseline;
  Index n_nodes;

  State(Exec const& exec, Plan const& plan, In const& x, FlatBaseline<Exec> const& flat, int n_fields)
      : Base(exec, plan, flat.field, n_fields), baseline(x), n_nodes(plan.n_nodes) {}

  void copy(char const* label, Exec const& exec, detail::WorkList<kernels::NodeCopy, MemorySpace> const& list,
            kernels::Field<double> const& from, kernels::Field<double> const& to) const {
    kernels::copy_nodes(exec, label, list, this->rotations, read(from), to);
  }
  [[nodiscard]] kernels::SideTable<MemorySpace> side_table(int f) const {
    kernels::SideTable<MemorySpace> table = this->sides;
    table.c = this->residuals.read()[f];
    return table;
  }
  template <bool Add>
  void sweep(Exec const& exec, detail::WorkList<kernels::SkeletonSweep, MemorySpace> const& list, int f) const {
    kernels::sweep_skeleton<Add>(exec, list, this->lines.chains, this->rotations, side_table(f), this->t.data(),
                                 this->ends.read()[f], this->skeleton.batch()[f], this->turns.of_skeleton(f));
  }

  /// Displacement of the skeleton before slip surfaces ask for theirs: where nothing turns, linear in the boundary displacement.
  /// With `Rate`, its derivative at field `of` where the boundary's is given.
  template <bool Rate>
  void skeleton_stages(Exec const& exec, int f, int of, In const& boundary) const {
    detail::BlockTurns<Exec, Rate> const turning(*this, f, of);
    kernels::Field<double> const u = this->skeleton.batch()[f], end_values = this->ends.batch()[f],
                                 c = this->residuals.batch()[f];
    kernels::scatter_boundary(exec, this->boundary_slots, boundary.array(), u);
    copy("gridmorph::boundary::axis", exec, this->boundary_projections, u, u);
    turning.of_walls(exec);
    for (auto const& stage : this->stages) {
      ProfilingRegion const region(stage.region);
      copy("gridmorph::chain_ends", exec, stage.ends, u, end_values);
      turning.of_ends(exec, stage);
      if (stage.side_lines.extent(0) > 0) {
        copy("gridmorph::side_residual::known", exec, stage.gathers, u, c);
        kernels::fill_sides(exec, this->lines.chains, side_table(f), stage.side_lines, stage.corrected,
                            read(end_values), c, this->turns.of_skeleton(f));
      }
      sweep<false>(exec, stage.sweeps, f);
    }
  }

  /// End values of a finalize pass; with `Rate`, their derivative at displacement field `of`.
  template <bool Rate>
  void slip_ends(Exec const& exec, detail::DeviceSpread<Exec> const& pass, int f, int of) const {
    kernels::slip_ends(exec, pass.first_value, pass.n_values,
                       kernels::SlipEndValues<MemorySpace, Rate>{pass.ends, pass.baselines, this->surfaces.surfaces,
                                                                 this->rotations, this->skeleton.read()[of],
                                                                 this->skeleton.read()[f], this->ends.batch()[f]});
  }

  void displacement_of_skeleton(Exec const& exec, int f, In const& boundary) const {
    skeleton_stages<false>(exec, f, f, boundary);
    for (auto const& pass : this->spreads) {
      ProfilingRegion const region(region_names.slip);
      slip_ends<false>(exec, pass, f, f);
      sweep<true>(exec, pass.sweeps, f);
    }
  }

  /// All nodes from the skeleton: its own, and those inside pieces. Fields first_field, ... go to out[0], ...
  template <bool Move>
  void write(Exec const& exec, int first_field, std::span<Out const> out) const {
    for (std::size_t done = 0; done < out.size(); done += kernels::most_fields_at_once)
      write_at_once<Move>(exec, first_field + int(done),
                          out.subspan(done, std::min<std::size_t>(out.size() - done, kernels::most_fields_at_once)));
  }
  template <bool Move>
  void write_at_once(Exec const& exec, int first_field, std::span<Out const> out) const {
    ProfilingRegion const region(region_names.volume);
    kernels::VectorArray const x = baseline.array();
    auto from = [&](auto const& work) {
      return kernels::FieldBatch<double const>{work.read()[first_field], work.read().stride};
    };
    kernels::VolumePass<MemorySpace, Shape, Move> volume{
        this->boxes.entries,
        this->terms,
        this->boxes.first_item,
        this->lines.chains,
        this->rotations,
        this->sides,
        this->t.data(),
        from(this->ends),
        from(this->residuals),
        {this->turns.read_ends(first_field), this->turns.ends_stride()},
        x,
        {},
        0};
    for (Out const& field : out) {
      kernels::write_skeleton_nodes<Move>(exec, this->skeleton_nodes, this->rotations,
                                          this->skeleton.read()[first_field + volume.n_fields], field.array(), x);
      volume.out[volume.n_fields++] = field.array();
    }
    kernels::pass_volume(exec, this->boxes.n_items, volume);
  }

  /// All that can be asked before anything is enqueued.
  void require(char const* who, std::span<In const> boundary, std::span<Out const> out, int n_fields) const {
    require_as_many(who, boundary.size(), out.size());
    if (n_fields > this->fields)
      throw ConfigError(std::string(who) + " needs room for " + std::to_string(n_fields) + " fields and was made for " +
                        std::to_string(this->fields) + "; ask for it in MorpherOptions");
    for (In const& given : boundary) require_boundary(who, given);
    for (Out const& field : out) require_all_nodes(who, field.size(), n_nodes);
  }
  void require_boundary(char const* who, In const& given) const {
    require_boundary_size(who, std::size_t(given.size()), this->boundary_slots.extent(0), "Plan::boundary_nodes");
  }
  template <bool Move>
  void run(char const* who, Exec const& exec, std::span<In const> boundary, std::span<Out const> out) const {
    require(who, boundary, out, int(out.size()));
    for (std::size_t f = 0; f < boundary.size(); ++f) displacement_of_skeleton(exec, int(f), boundary[f]);
    write<Move>(exec, 0, out);
  }
};

template <class Exec>
Morpher<Exec>::Morpher(Exec const& exec, Plan const& plan, In const& baseline, MorpherOptions const& options) {
  require_all_nodes("gridmorph::Morpher", baseline.size(), plan.n_nodes);
  state_ = std::make_shared<State>(exec, plan, baseline, FlatBaseline<Exec>(exec, baseline),
                                   std::max(options.fields, options.velocity ? 2 : 1));
}

template <class Exec>
Morpher<Exec>::Morpher(Exec const& exec, MorphPlan const& plan, In const& baseline, MorpherOptions const& options) {
  if (plan.blocks())
    *this = Morpher(exec, plan.blocks()->plan(), baseline, options);
  else
    elements_ = std::make_shared<UnstructuredMorpher<Exec> const>(exec, plan.elements()->plan, baseline, options);
}

template <class Exec>
void Morpher<Exec>::positions(Exec const& exec, In const& boundary, Out const& moved) const {
  if (elements_) return elements_->positions(exec, boundary, moved);
  state_->template run<true>("gridmorph::Morpher::positions", exec, {&boundary, 1}, {&moved, 1});
}

template <class Exec>
void Morpher<Exec>::positions(Exec const& exec, std::span<In const> boundary, std::span<Out const> moved) const {
  if (elements_) return elements_->positions(exec, boundary, moved);
  state_->template run<true>("gridmorph::Morpher::positions", exec, boundary, moved);
}

template <class Exec>
void Morpher<Exec>::displacements(Exec const& exec, In const& boundary, Out const& u) const {
  if (elements_) return elements_->displacements(exec, boundary, u);
  state_->template run<false>("gridmorph::Morpher::displacements", exec, {&boundary, 1}, {&u, 1});
}

template <class Exec>
void Morpher<Exec>::displacements(Exec const& exec, std::span<In const> boundary, std::span<Out const> u) const {
  if (elements_) return elements_->displacements(exec, boundary, u);
  state_->template run<false>("gridmorph::Morpher::displacements", exec, boundary, u);
}

template <class Exec>
void Morpher<Exec>::velocities(Exec const& exec, In const& boundary, In const& rate, Out const& v) const {
  if (elements_) return elements_->velocities(exec, boundary, rate, v);
  State const& s = *state_;
  s.require("gridmorph::Morpher::velocities", {&boundary, 1}, {&v, 1}, 2);
  s.require_boundary("gridmorph::Morpher::velocities (rate)", rate);
  s.template skeleton_stages<false>(exec, 0, 0, boundary);
  s.template skeleton_stages<true>(exec, 1, 0, rate);
  for (auto const& pass : s.spreads) {
    ProfilingRegion const region(region_names.slip);
    s.template slip_ends<true>(exec, pass, 1, 0);
    s.template slip_ends<false>(exec, pass, 0, 0);
    s.template sweep<true>(exec, pass.sweeps, 0);
    s.template sweep<true>(exec, pass.sweeps, 1);
  }
  s.template write<false>(exec, 1, {&v, 1});
}

#define GRIDMORPH_INSTANTIATE(Exec) template class Morpher<Exec>;
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
