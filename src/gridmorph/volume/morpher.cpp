#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/line_sweep.hpp>
#include <gridmorph/kernels/node_copy.hpp>
#include <gridmorph/kernels/side_residual.hpp>
#include <gridmorph/motion/slip_surface.hpp>
#include <gridmorph/volume/morpher.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace gridmorph {
namespace detail {

template <class T, class Exec>
Kokkos::View<T*, typename Exec::memory_space> upload(Exec const& exec, std::vector<T> const& host, char const* what) {
  Kokkos::View<T*, typename Exec::memory_space> device(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, std::string("gridmorph::Morpher::") + what), host.size());
  Kokkos::View<T const*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>> const source(host.data(),
                                                                                                  host.size());
  if (!host.empty()) Kokkos::deep_copy(exec, device, source);
  return device;
}

template <class Exec>
struct DeviceCopies {
  using Memory = typename Exec::memory_space;
  struct Table {
    Kokkos::View<kernels::NodeCopy*, Memory> copies;
    Kokkos::View<Index*, Memory> first_item;
    Index n_items = 0;
  };
  Table projections, copies;

  DeviceCopies() = default;
  DeviceCopies(Exec const& exec, CopyTable const& table) {
    auto put = [&](std::vector<kernels::NodeCopy> const& list) {
      std::vector<Index> first{0};
      for (auto const& c : list) first.push_back(first.back() + Index(c.n_p) * c.n_q);
      return Table{upload(exec, list, "copies"), upload(exec, first, "copies::first_item"), first.back()};
    };
    projections = put(table.projections);
    copies = put(table.copies);
  }
  void run(Exec const& exec, Kokkos::View<Mat3*, Memory> const& matrices, kernels::Field<double> u) const {
    for (Table const* t : {&projections, &copies})
      if (t->n_items > 0)
        Kokkos::parallel_for("gridmorph::node_copy",
                             Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>(exec, 0, t->n_items),
                             kernels::CopyNodes<Memory>{t->copies, t->first_item, matrices, u});
  }
};

template <class Exec>
kernels::LineTable<typename Exec::memory_space> upload_lines(
    Exec const& exec, LineTables const& lines, Kokkos::View<Mat3*, typename Exec::memory_space> rotations) {
  kernels::LineTable<typename Exec::memory_space> table;
  table.chains = upload(exec, lines.chains, "chains");
  table.tubes = upload(exec, lines.tubes, "tubes");
  table.segments = upload(exec, lines.segments, "segments");
  table.first_line = upload(exec, lines.first_line, "first_line");
  table.rotations = rotations;
  table.n_lines = lines.first_line.back();
  return table;
}

template <class Exec>
struct DeviceStage {
  using Memory = typename Exec::memory_space;
  kernels::LineTable<Memory> lines;
  kernels::SideTable<Memory> sides;
  Kokkos::View<kernels::SideLine*, Memory> side_lines;
  Kokkos::View<std::int32_t*, Memory> corrected;
  DeviceCopies<Exec> copies;
};

template <class Exec>
struct DeviceSpread {
  using Memory = typename Exec::memory_space;
  kernels::LineTable<Memory> lines;
  Kokkos::View<SlipEnd*, Memory> ends;
  Index n_values = 0;
  DeviceCopies<Exec> copies;
};

/// End values of the spread: what the slip surfaces ask of the nodes on them. Where several surfaces meet, the
/// constraints are applied in turn until the node lies on all of them (exact after one round for planes at right
/// angles and for surfaces of revolution with planes across their axis).
template <class Memory>
struct SlipEndValues {
  static constexpr int max_rounds = 50;
  Kokkos::View<SlipEnd*, Memory> ends;
  Kokkos::View<SlipSurfaceView*, Memory> surfaces;
  Kokkos::View<Mat3*, Memory> rotations;
  kernels::Field<double const> x, u;
  kernels::Field<double> values;

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    SlipEnd const& end = ends(item);
    Vec3 const here = x[end.node], given = u[end.node];
    Vec3 wanted = given;
    bool const several = end.surface[1] >= 0;
    for (int round = 0; round < (several ? max_rounds : 1); ++round) {
      Vec3 const before = wanted;
      for (int m = 0; m < 3; ++m)
        if (end.surface[m] >= 0) wanted = surfaces(end.surface[m]).constrain(here, wanted);
      if (wanted == before) break;
    }
    Vec3 d = wanted - given;
    if (norm(d) <= end.tolerance) d = {};
    values.set(end.value, end.rotation < 0 ? d : transpose(rotations(end.rotation)) * d);
  }
};

struct ScatterBoundary {
  Index const* nodes;
  Vec3 const* boundary;
  kernels::Field<double> u;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { u.set(nodes[n], boundary[n]); }
};

struct MoveNodes {
  kernels::Field<double const> x;
  kernels::Field<double> u;
  // -0.0 + 0.0 is +0.0: a node that stays must keep its sign bits too.
  KOKKOS_INLINE_FUNCTION static double moved(double x, double u) { return u == 0 ? x : x + u; }
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    Vec3 const p = x[n], d = u[n];
    u.set(n, {moved(p.x, d.x), moved(p.y, d.y), moved(p.z, d.z)});
  }
};

struct ZeroField {
  kernels::Field<double> u;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { u.set(n, {}); }
};

}  // namespace detail

template <class Exec>
struct Morpher<Exec>::State {
  Kokkos::View<Index*, MemorySpace> boundary_nodes;
  detail::DeviceCopies<Exec> boundary_copies;
  Kokkos::View<Mat3*, MemorySpace> rotations;
  std::vector<detail::DeviceStage<Exec>> stages;
  std::vector<detail::DeviceSpread<Exec>> spreads;
  SlipSurfaceTable<MemorySpace> surfaces;
  Kokkos::View<double*, MemorySpace> side_workspace, spread_workspace;
  Index n_nodes = 0;

  static kernels::Field<double> three(Kokkos::View<double*, MemorySpace> const& w) {
    return {w.data(), w.data() + w.extent(0) / 3, w.data() + 2 * (w.extent(0) / 3)};
  }
  static Kokkos::View<double*, MemorySpace> workspace(Exec const& exec, std::size_t n, std::string const& label) {
    return Kokkos::View<double*, MemorySpace>(Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, label), 3 * n);
  }
};

template <class Exec>
Morpher<Exec>::Morpher(Exec const& exec, Plan const& plan) {
  auto state = std::make_shared<State>();
  state->n_nodes = plan.n_nodes;
  state->boundary_nodes = detail::upload(exec, plan.boundary_nodes, "boundary_nodes");
  state->boundary_copies = detail::DeviceCopies<Exec>(exec, plan.boundary_copies);
  state->rotations = detail::upload(exec, plan.rotations, "rotations");
  state->surfaces = SlipSurfaceTable<MemorySpace>(exec, plan.surfaces);
  std::size_t side_nodes = 0, end_values = 0;
  for (Stage const& stage : plan.stages) side_nodes = std::max(side_nodes, stage.sides.t.size());
  for (SpreadPass const& pass : plan.spreads) end_values = std::max(end_values, std::size_t(pass.n_values));
  state->side_workspace = State::workspace(exec, side_nodes, "gridmorph::Morpher::side_residuals");
  state->spread_workspace = State::workspace(exec, end_values, "gridmorph::Morpher::end_values");
  for (Stage const& stage : plan.stages) {
    detail::DeviceStage<Exec> device;
    device.lines = detail::upload_lines(exec, stage.lines, state->rotations);
    device.sides.sides = detail::upload(exec, stage.sides.sides, "sides");
    device.sides.junctions = detail::upload(exec, stage.sides.junctions, "junctions");
    device.sides.t = detail::upload(exec, stage.sides.t, "side_fractions");
    device.sides.section = detail::upload(exec, stage.sides.section, "section_fractions");
    device.sides.c = State::three(state->side_workspace);
    device.side_lines = detail::upload(exec, stage.sides.lines, "side_lines");
    device.corrected = detail::upload(exec, stage.sides.corrected, "corrected");
    device.copies = detail::DeviceCopies<Exec>(exec, stage.copies);
    state->stages.push_back(std::move(device));
  }
  for (SpreadPass const& pass : plan.spreads)
    state->spreads.push_back({detail::upload_lines(exec, pass.lines, state->rotations),
                              detail::upload(exec, pass.ends, "slip_ends"), pass.n_values,
                              detail::DeviceCopies<Exec>(exec, pass.copies)});
  state_ = std::move(state);
  compat::fence(exec, "gridmorph::Morpher (host tables of the plan may go)");
}

template <class Exec>
void Morpher<Exec>::displace(Exec const& exec, Kokkos::View<Vec3 const*, MemorySpace> boundary,
                             kernels::Field<double const> x, kernels::Field<double> u) const {
  using Range = Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>;
  State const& s = *state_;
  kernels::Field<double const> const read_u{u.x, u.y, u.z, u.stride};
  Kokkos::parallel_for("gridmorph::boundary", Range(exec, 0, Index(s.boundary_nodes.extent(0))),
                       detail::ScatterBoundary{s.boundary_nodes.data(), boundary.data(), u});
  s.boundary_copies.run(exec, s.rotations, u);

  for (auto const& stage : s.stages) {
    if (stage.corrected.extent(0) > 0) {
      Index const n_lines = Index(stage.side_lines.extent(0));
      Kokkos::parallel_for("gridmorph::side_residual", Range(exec, 0, n_lines),
                           kernels::SideResidual<MemorySpace>{stage.lines, stage.sides, stage.side_lines, read_u});
      Kokkos::parallel_for("gridmorph::side_residual::edges", Range(exec, 0, 4 * Index(stage.corrected.extent(0))),
                           kernels::EdgeFill<MemorySpace>{stage.lines, stage.sides, stage.corrected});
      Kokkos::parallel_for("gridmorph::side_residual::sides", Range(exec, 0, n_lines),
                           kernels::SideFill<MemorySpace>{stage.lines, stage.sides, stage.side_lines});
    }
    Kokkos::parallel_for("gridmorph::line_sweep", Range(exec, 0, stage.lines.n_lines),
                         kernels::LineSweep<MemorySpace>{stage.lines, stage.sides, x, u});
    stage.copies.run(exec, s.rotations, u);
  }

  for (auto const& pass : s.spreads) {
    kernels::Field<double> const values = State::three(s.spread_workspace);
    Kokkos::parallel_for("gridmorph::line_spread::clear", Range(exec, 0, pass.n_values), detail::ZeroField{values});
    Kokkos::parallel_for(
        "gridmorph::line_spread::ends", Range(exec, 0, Index(pass.ends.extent(0))),
        detail::SlipEndValues<MemorySpace>{pass.ends, s.surfaces.surfaces, s.rotations, x, read_u, values});
    Kokkos::parallel_for(
        "gridmorph::line_spread", Range(exec, 0, pass.lines.n_lines),
        kernels::LineSpread<MemorySpace>{pass.lines, {values.x, values.y, values.z, values.stride}, x, u});
    pass.copies.run(exec, s.rotations, u);
  }
}

template <class Exec>
void Morpher<Exec>::move(Exec const& exec, kernels::Field<double const> x, kernels::Field<double> u) const {
  Kokkos::parallel_for("gridmorph::move_nodes",
                       Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>(exec, 0, state_->n_nodes),
                       detail::MoveNodes{x, u});
}

#define GRIDMORPH_INSTANTIATE(Exec) template class Morpher<Exec>;
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
