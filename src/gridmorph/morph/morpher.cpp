#include <gridmorph/core/error.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/morph/device_plan.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/plan/boundary_size.hpp>

#include <string>

namespace gridmorph {
namespace {

struct ScatterBoundary {
  Index const* slots;
  Vec3 const* boundary;
  kernels::Field<double> u;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { u.set(slots[n], boundary[n]); }
};

struct ZeroField {
  kernels::Field<double> u;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { u.set(n, {}); }
};

kernels::Field<double const> read(kernels::Field<double> const& f) { return {f.x, f.y, f.z, f.stride}; }

}  // namespace

template <class Exec>
struct Morpher<Exec>::State : detail::DevicePlan<Exec> {
  using Base = detail::DevicePlan<Exec>;
  using Shape = typename Base::Shape;
  using Range = Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>;
  using Base::Base;

  template <class Kernel>
  static void launch(char const* label, Exec const& exec, Index items, Kernel const& kernel) {
    if (items > 0) Kokkos::parallel_for(label, Range(exec, 0, items), kernel);
  }
  void copy(char const* label, Exec const& exec, detail::WorkList<kernels::NodeCopy, MemorySpace> const& list,
            kernels::Field<double> const& from, kernels::Field<double> const& to) const {
    launch(label, exec, list.n_items,
           typename Base::Copy{list.entries, list.first_item, this->rotations, read(from), to});
  }
  [[nodiscard]] kernels::SideTable<MemorySpace> side_table(int f) const {
    kernels::SideTable<MemorySpace> table = this->sides;
    table.c = this->residuals.read()[f];
    return table;
  }
  template <bool Add>
  void sweep(Exec const& exec, detail::WorkList<kernels::SkeletonSweep, MemorySpace> const& list, int f) const {
    launch(Add ? "gridmorph::skeleton_spread" : "gridmorph::skeleton_sweep", exec, list.n_items,
           kernels::SweepSkeleton<MemorySpace, Shape::row, Add>{list.entries, list.first_item, this->lines.chains,
                                                                this->rotations, side_table(f), this->t.data(),
                                                                this->ends.read()[f], this->skeleton.batch()[f]});
  }

  /// Displacement of the skeleton before slip surfaces ask for theirs: linear in the boundary displacement.
  void skeleton_stages(Exec const& exec, int f, Vec3 const* boundary) const {
    kernels::Field<double> const u = this->skeleton.batch()[f], end_values = this->ends.batch()[f],
                                 c = this->residuals.batch()[f];
    launch("gridmorph::boundary", exec, Index(this->boundary_slots.extent(0)),
           ScatterBoundary{this->boundary_slots.data(), boundary, u});
    copy("gridmorph::boundary::axis", exec, this->boundary_projections, u, u);
    for (auto const& stage : this->stages) {
      copy("gridmorph::chain_ends", exec, stage.ends, u, end_values);
      if (Index const n_lines = Index(stage.side_lines.extent(0)); n_lines > 0) {
        kernels::SideTable<MemorySpace> const table = side_table(f);
        auto const& chains = this->lines.chains;
        copy("gridmorph::side_residual::known", exec, stage.gathers, u, c);
        launch("gridmorph::side_residual", exec, n_lines,
               kernels::SideResidual<MemorySpace>{chains, table, stage.side_lines, read(end_values), c});
        launch("gridmorph::side_residual::edges", exec, 4 * Index(stage.corrected.extent(0)),
               kernels::EdgeFill<MemorySpace>{chains, table, stage.corrected, c});
        launch("gridmorph::side_residual::sides", exec, n_lines,
               kernels::SideFill<MemorySpace>{chains, table, stage.side_lines, c});
      }
      sweep<false>(exec, stage.sweeps, f);
    }
  }

  /// End values of a finalize pass; with `Rate`, their derivative at displacement field `of`.
  template <bool Rate>
  void slip_ends(Exec const& exec, detail::DeviceSpread<Exec> const& pass, int f, int of) const {
    kernels::Field<double> const end_values = this->ends.batch()[f];
    Index const first = pass.first_value;
    launch("gridmorph::slip_ends::clear", exec, pass.n_values,
           ZeroField{{end_values.x + first, end_values.y + first, end_values.z + first}});
    launch(
        "gridmorph::slip_ends", exec, Index(pass.ends.extent(0)),
        kernels::SlipEndValues<MemorySpace, Rate>{pass.ends, pass.baselines, this->surfaces.surfaces, this->rotations,
                                                  this->skeleton.read()[of], this->skeleton.read()[f], end_values});
  }

  void displacement_of_skeleton(Exec const& exec, int f, Vec3 const* boundary) const {
    skeleton_stages(exec, f, boundary);
    for (auto const& pass : this->spreads) {
      slip_ends<false>(exec, pass, f, f);
      sweep<true>(exec, pass.sweeps, f);
    }
  }

  /// All nodes from the skeleton: its own, and those inside pieces. Fields first_field ... first_field + n - 1 go to out.
  template <bool Move>
  void write(Exec const& exec, int first_field, int n, kernels::Field<double const> const& x,
             kernels::FieldBatch<double> const& out) const {
    for (int f = 0; f < n; ++f)
      launch("gridmorph::skeleton_nodes", exec, this->skeleton_nodes.n_items,
             kernels::CopyNodes<MemorySpace, Shape::row, Move>{this->skeleton_nodes.entries,
                                                               this->skeleton_nodes.first_item, this->rotations,
                                                               this->skeleton.read()[first_field + f], out[f], x});
    auto from = [&](auto const& work) {
      return kernels::FieldBatch<double const>{work.read()[first_field], work.read().stride};
    };
    launch("gridmorph::volume", exec, this->boxes.n_items,
           kernels::VolumePass<MemorySpace, Shape, Move>{
               this->boxes.entries, this->terms, this->boxes.first_item, this->lines.chains, this->rotations,
               this->sides, this->t.data(), from(this->ends), from(this->residuals), x, out, n});
  }

  void require_boundary(std::size_t given, char const* what) const {
    require_boundary_size(what, given, this->boundary_slots.extent(0), "Plan::boundary_nodes");
  }

  void require_fields(int n, char const* what) const {
    if (n > this->fields)
      throw ConfigError(std::string("gridmorph::Morpher::") + what + " needs room for " + std::to_string(n) +
                        " fields and was made for " + std::to_string(this->fields) + "; ask for it in MorpherOptions");
  }
};

template <class Exec>
Morpher<Exec>::Morpher(Exec const& exec, Plan const& plan, kernels::Field<double const> x,
                       MorpherOptions const& options)
    : state_(std::make_shared<State>(exec, plan, x, std::max(options.fields, options.velocity ? 2 : 1))) {}

template <class Exec>
void Morpher<Exec>::apply(Exec const& exec, Boundary boundary, kernels::Field<double const> x,
                          kernels::Field<double> moved) const {
  state_->require_boundary(boundary.extent(0), "gridmorph::Morpher::apply");
  state_->displacement_of_skeleton(exec, 0, boundary.data());
  state_->template write<true>(exec, 0, 1, x, {moved});
}

template <class Exec>
void Morpher<Exec>::displace(Exec const& exec, Boundary boundary, kernels::Field<double> u) const {
  state_->require_boundary(boundary.extent(0), "gridmorph::Morpher::displace");
  state_->displacement_of_skeleton(exec, 0, boundary.data());
  state_->template write<false>(exec, 0, 1, {}, {u});
}

template <class Exec>
void Morpher<Exec>::displace(Exec const& exec, BoundaryBatch boundary, kernels::FieldBatch<double> u) const {
  int const n = int(boundary.extent(0));
  state_->require_fields(n, "displace");
  state_->require_boundary(boundary.extent(1), "gridmorph::Morpher::displace");
  for (int f = 0; f < n; ++f) state_->displacement_of_skeleton(exec, f, boundary.data() + f * boundary.stride(0));
  state_->template write<false>(exec, 0, n, {}, u);
}

template <class Exec>
void Morpher<Exec>::velocity(Exec const& exec, Boundary boundary, Boundary rate, kernels::Field<double> v) const {
  State const& s = *state_;
  s.require_fields(2, "velocity");
  s.require_boundary(boundary.extent(0), "gridmorph::Morpher::velocity");
  s.require_boundary(rate.extent(0), "gridmorph::Morpher::velocity (rate)");
  s.skeleton_stages(exec, 0, boundary.data());
  s.skeleton_stages(exec, 1, rate.data());
  for (auto const& pass : s.spreads) {
    s.template slip_ends<true>(exec, pass, 1, 0);
    s.template slip_ends<false>(exec, pass, 0, 0);
    s.template sweep<true>(exec, pass.sweeps, 0);
    s.template sweep<true>(exec, pass.sweeps, 1);
  }
  s.template write<false>(exec, 1, 1, {}, {v});
}

#define GRIDMORPH_INSTANTIATE(Exec) template class Morpher<Exec>;
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
