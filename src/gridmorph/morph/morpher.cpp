#include <gridmorph/core/error.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/mesh/vector_view.hpp>
#include <gridmorph/morph/detail/baseline.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/morph/stages/run_stages.hpp>
#include <gridmorph/morph/stages/stage_list.hpp>
#include <gridmorph/plan/boundary_size.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace gridmorph {

using detail::FlatBaseline;
using detail::ProfilingRegion;
using detail::require_all_nodes;
using detail::require_as_many;

namespace {

/// The caller's vectors with their components axes[0], axes[1] and axes[2] as x, y and z; of one list: ConfigError for
/// zones apart.
template <class Memory, bool ReadOnly>
BasicVectorView<Memory, ReadOnly> with_axes(BasicVectorView<Memory, ReadOnly> const& v,
                                            std::array<int, 3> const& axes) {
  if (axes == std::array<int, 3>{0, 1, 2}) return v;
  kernels::VectorArray const& of = v.array();
  if (of.zones != nullptr)
    detail::refuse_vectors("a plane mesh across x or y has its vectors in one list, not in zones apart; give them so");
  std::array<void*, 3> const all{of.x, of.y, of.z};
  auto const seen = [&]<class Real>(Real*) {
    Kokkos::LayoutStride const layout(std::size_t(v.size()), std::size_t(of.stride));
    auto const view = [&](int k) {
      return Kokkos::View<Real*, Kokkos::LayoutStride, Memory>(static_cast<Real*>(all[axes[k]]), layout);
    };
    return BasicVectorView<Memory, ReadOnly>(view(0), view(1), view(2));
  };
  return of.single ? seen(static_cast<float*>(nullptr)) : seen(static_cast<double*>(nullptr));
}

}  // namespace

template <BuiltFor Exec>
struct Morpher<Exec>::State {
  using Field = stages::StageField<Exec>;

  Index n_nodes;
  std::size_t n_boundary;
  In baseline;
  FlatBaseline<Exec> flat;
  stages::StageList<Exec> list;
  bool transposed = false;
  std::array<int, 3> axes{
      0, 1, 2};  ///< UnstructuredPlan::axes: those of all stages; shifts of a guard have those of the mesh

  State(Exec const& exec, Plan const& plan, In const& x, MorpherOptions const& options)
      : n_nodes(plan.n_nodes),
        n_boundary(plan.boundary_nodes.size()),
        baseline(x),
        flat(exec, x),
        list(stages::stage_list(exec, plan, flat.field, options)),
        transposed(options.transpose) {
    flat = {};  // line parameters have been made of it; the pass through the volume reads the caller's arrays
  }
  State(Exec const& exec, UnstructuredPlan const& plan, In const& x, MorpherOptions const& options)
      : n_nodes(plan.n_nodes),
        n_boundary(plan.known.size()),
        baseline(with_axes(x, plan.axes)),
        flat(exec, baseline),
        list(stages::stage_list(exec, plan, flat.field, options)),
        transposed(options.transpose),
        axes(plan.axes) {}

  /// All that can be asked before anything is enqueued.
  void require(char const* who, std::span<In const> boundary, std::span<Out const> out) const {
    require_as_many(who, boundary.size(), out.size());
    for (In const& given : boundary)
      require_boundary_size(who, std::size_t(given.size()), n_boundary, "MorphPlan::boundary_nodes()");
    for (Out const& field : out) require_all_nodes(who, field.size(), n_nodes);
    for (In const& given : boundary) (void)with_axes(given, axes);
    for (Out const& field : out) (void)with_axes(field, axes);
  }

  /// What stages are to read of what the caller gives.
  void put_back(Exec const& exec, Field& f) const {
    if (!list.given) return;
    ProfilingRegion const region(list.given->region);
    list.given->enqueue(exec, flat.field, f);
  }

  template <bool Move>
  void write(Exec const& exec, std::span<Field const> fields, std::span<Out const> out) const {
    static std::string const name = "gridmorph::all nodes";
    ProfilingRegion const region(name);
    auto const pass = [&](std::span<Field const> from, std::span<Out const> to) {
      std::visit([&](auto const& writer) { writer.template write<Move>(exec, flat.field, baseline.array(), from, to); },
                 list.writer);
    };
    if (axes == std::array<int, 3>{0, 1, 2}) return pass(fields, out);
    for (std::size_t k = 0; k < out.size(); ++k) {
      Out const seen = with_axes(out[k], axes);
      pass(fields.subspan(k, 1), {&seen, 1});
    }
  }

  /// As many fields at once as there is room for.
  template <bool Move>
  void run(char const* who, Exec const& exec, std::span<In const> boundary, std::span<Out const> out) const {
    require(who, boundary, out);
    for (std::size_t done = 0; done < out.size(); done += list.fields.size()) {
      std::size_t const n = std::min(out.size() - done, list.fields.size());
      for (std::size_t k = 0; k < n; ++k) {
        Field f = list.fields[k];
        f.boundary = with_axes(boundary[done + k], axes).array();
        f.baseline = baseline.array();
        put_back(exec, f);
        stages::enqueue_all(list.stages, exec, flat.field, f);
      }
      write<Move>(exec, {list.fields.data(), n}, out.subspan(done, n));
      if (!list.shifts) continue;
      ProfilingRegion const region(list.shifts->region);
      for (std::size_t k = 0; k < n; ++k) {
        Field f = list.fields[k];
        f.boundary = boundary[done + k].array();
        list.shifts->add(exec, f, out[done + k]);
      }
    }
  }

  void run_rate(Exec const& exec, In const& boundary, In const& boundary_rate, Out const& v) const {
    Field f = list.fields[0], r = list.fields[1];
    f.boundary = with_axes(boundary, axes).array();
    f.baseline = baseline.array();
    r.boundary = with_axes(boundary_rate, axes).array();
    r.of = f.number;
    if (list.given) {
      ProfilingRegion const region(list.given->region);
      list.given->rate(exec, flat.field, f, r);
    }
    stages::enqueue_rates(list.stages, exec, flat.field, f, r);
    write<false>(exec, {&r, 1}, {&v, 1});
    if (!list.shifts) return;
    ProfilingRegion const region(list.shifts->region);
    f.boundary = boundary.array();
    r.boundary = boundary_rate.array();
    list.shifts->add_rate(exec, f, r, v);
  }

  /// What transposes are taken at, forwards; nothing that no transpose asks for.
  void linearise(Exec const& exec, Field const& f) const {
    bool const all = list.shifts && list.shifts->bends();
    stages::linearise(list.stages, all ? list.stages.size() : stages::n_that_bend(list.stages), all, exec, flat.field,
                      f);
  }

  void run_transpose(Exec const& exec, In const& boundary, In const& dJ_du, Out const& dJ_db) const {
    Field f = list.fields[0], g = list.fields[1];
    f.boundary = with_axes(boundary, axes).array();
    f.baseline = baseline.array();
    g.nodes = with_axes(dJ_du, axes).array();
    g.baseline = baseline.array();
    g.boundary = with_axes(dJ_db, axes).array();
    auto const given = f.boundary;
    Field of_shifts = f, to_shifts = g;
    of_shifts.boundary = boundary.array();
    to_shifts.nodes = dJ_du.array();
    to_shifts.boundary = dJ_db.array();
    put_back(exec, f);
    linearise(exec, f);
    std::visit([&](auto const& writer) { writer.transpose(exec, g); }, list.writer);
    if (list.shifts) {
      ProfilingRegion const region(list.shifts->region);
      list.shifts->transpose_nodes(exec, of_shifts, to_shifts);
    }
    stages::transpose_all(list.stages, exec, flat.field, f, g);
    if (list.given) {
      ProfilingRegion const region("transposed " + list.given->region);
      list.given->transpose(exec, flat.field, given, g);
    }
    if (list.shifts) list.shifts->transpose_boundary(exec, to_shifts);
  }
};

namespace {

template <class Exec, class State, class AnyPlan>
std::shared_ptr<State const> state_of(Exec const& exec, AnyPlan const& plan,
                                      ConstVectorView<typename Exec::memory_space> const& baseline,
                                      MorpherOptions const& options) {
  require_all_nodes("gridmorph::Morpher", baseline.size(), plan.n_nodes);
  return std::make_shared<State const>(exec, plan, baseline, options);
}

MorpherOptions with_smoothing(MorpherOptions options, std::shared_ptr<SmoothingMap const> const& of_plan) {
  if (!options.smoothing) options.smoothing = of_plan;
  return options;
}

}  // namespace

template <BuiltFor Exec>
Morpher<Exec>::Morpher(Exec const& exec, Plan const& plan, In const& baseline, MorpherOptions const& options)
    : state_(state_of<Exec, State>(exec, plan, baseline, options)) {}

template <BuiltFor Exec>
Morpher<Exec>::Morpher(Exec const& exec, UnstructuredPlan const& plan, In const& baseline,
                       MorpherOptions const& options)
    : state_(state_of<Exec, State>(exec, plan, baseline, options)) {}

template <BuiltFor Exec>
Morpher<Exec>::Morpher(Exec const& exec, MorphPlan const& plan, In const& baseline, MorpherOptions const& options)
    : Morpher(
          PlanAccess::blocks(plan)
              ? Morpher(exec, PlanAccess::blocks(plan)->plan(), baseline, with_smoothing(options, plan.smoothing()))
              : Morpher(exec, PlanAccess::elements(plan)->plan, baseline, with_smoothing(options, plan.smoothing()))) {}

template <BuiltFor Exec>
Morpher<Exec>::Morpher(Exec const& exec, PlanShare const& share, In const& baseline, MorpherOptions const& options)
    : Morpher(exec, PlanAccess::chains(share), baseline, with_smoothing(options, PlanAccess::smoothing(share))) {}

template <BuiltFor Exec>
void Morpher<Exec>::positions(Exec const& exec, In const& boundary, Out const& moved) const {
  positions(exec, {&boundary, 1}, {&moved, 1});
}

template <BuiltFor Exec>
void Morpher<Exec>::positions(Exec const& exec, std::span<In const> boundary, std::span<Out const> moved) const {
  state_->template run<true>("gridmorph::Morpher::positions", exec, boundary, moved);
}

template <BuiltFor Exec>
void Morpher<Exec>::displacements(Exec const& exec, In const& boundary, Out const& u) const {
  displacements(exec, {&boundary, 1}, {&u, 1});
}

template <BuiltFor Exec>
void Morpher<Exec>::displacements(Exec const& exec, std::span<In const> boundary, std::span<Out const> u) const {
  state_->template run<false>("gridmorph::Morpher::displacements", exec, boundary, u);
}

template <BuiltFor Exec>
void Morpher<Exec>::velocities(Exec const& exec, In const& boundary, In const& rate, Out const& v) const {
  char const* const who = "gridmorph::Morpher::velocities";
  if (state_->list.fields.size() < 2)
    throw ConfigError(std::string(who) +
                      " needs room for 2 fields and was made for 1; ask for it by MorpherOptions::velocity");
  state_->require(who, {&boundary, 1}, {&v, 1});
  state_->require("gridmorph::Morpher::velocities (rate)", {&rate, 1}, {&v, 1});
  state_->run_rate(exec, boundary, rate, v);
}

template <BuiltFor Exec>
void Morpher<Exec>::transpose(Exec const& exec, In const& boundary, In const& dJ_du, Out const& dJ_db) const {
  char const* const who = "gridmorph::Morpher::transpose";
  if (!state_->transposed)
    throw ConfigError(std::string(who) + " needs tables that were not made; ask for them by MorpherOptions::transpose");
  char const* const nodes = "MorphPlan::boundary_nodes()";
  require_boundary_size(who, std::size_t(boundary.size()), state_->n_boundary, nodes);
  require_all_nodes("gridmorph::Morpher::transpose (dJ_du)", dJ_du.size(), state_->n_nodes);
  require_boundary_size("gridmorph::Morpher::transpose (dJ_db)", std::size_t(dJ_db.size()), state_->n_boundary, nodes);
  state_->run_transpose(exec, boundary, dJ_du, dJ_db);
}

template <BuiltFor Exec>
typename Morpher<Exec>::In Morpher<Exec>::background_displacements(std::size_t part) const {
  for (auto const& any : state_->list.stages) {
    auto const* far = std::get_if<stages::FarField<Exec>>(&any);
    if (auto const* parts = std::get_if<stages::MorphParts<Exec>>(&any)) far = parts->far_field(part);
    if (far != nullptr) return far->displacements();
  }
  return Kokkos::View<Vec3 const*, MemorySpace>();
}

#define GRIDMORPH_INSTANTIATE(Exec) template class Morpher<Exec>;
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
