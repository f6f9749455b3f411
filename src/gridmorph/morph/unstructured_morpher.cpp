#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/listed_nodes.hpp>
#include <gridmorph/morph/detail/baseline.hpp>
#include <gridmorph/morph/stages/far_field.hpp>
#include <gridmorph/morph/stages/joined_nodes.hpp>
#include <gridmorph/morph/stages/near_field.hpp>
#include <gridmorph/morph/stages/other_boundaries.hpp>
#include <gridmorph/morph/stages/wall_motion.hpp>
#include <gridmorph/morph/unstructured_morpher.hpp>
#include <gridmorph/plan/boundary_size.hpp>

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace gridmorph {

template <class Exec>
struct UnstructuredMorpher<Exec>::State {
  using Field = stages::StageField<Exec>;
  using Stage = std::variant<stages::WallMotion<Exec>, stages::NearField<Exec>, stages::FarField<Exec>,
                             stages::OtherBoundaries<Exec>, stages::JoinedNodes<Exec>>;

  Index n_nodes;
  std::size_t n_known;
  detail::FlatBaseline<Exec> baseline;
  std::vector<Stage> list;
  Field field;
  std::optional<Field> rate;

  State(Exec const& exec, UnstructuredPlan const& plan, In const& x, MorpherOptions const& options)
      : n_nodes(plan.n_nodes),
        n_known(plan.known.size()),
        baseline(exec, x),
        field(exec, n_nodes, plan.driving.size(), "gridmorph::UnstructuredMorpher") {
    if (options.velocity) rate.emplace(exec, n_nodes, plan.driving.size(), "gridmorph::UnstructuredMorpher::rate");
    list.emplace_back(stages::WallMotion<Exec>(exec, plan, options.velocity));
    list.emplace_back(stages::NearField<Exec>(exec, plan));
    if (plan.background) list.emplace_back(stages::FarField<Exec>(exec, plan, options.velocity));
    list.emplace_back(stages::OtherBoundaries<Exec>(exec, plan));
    list.emplace_back(stages::JoinedNodes<Exec>(exec, plan));
    compat::fence(exec, "gridmorph::UnstructuredMorpher (host tables of the plan may go)");
  }

  void require(char const* who, std::span<In const> boundary, std::span<Out const> out) const {
    detail::require_as_many(who, boundary.size(), out.size());
    for (In const& given : boundary)
      require_boundary_size(who, std::size_t(given.size()), n_known, "UnstructuredPlan::known");
    for (Out const& to : out) detail::require_all_nodes(who, to.size(), n_nodes);
  }

  /// Calls run(stage) for each stage in a profiling region of its own.
  template <class Run>
  void for_each_stage(Run const& run) const {
    for (Stage const& any : list)
      std::visit(
          [&](auto const& stage) {
            detail::ProfilingRegion const region(stage.region);
            run(stage);
          },
          any);
  }

  template <bool Move>
  void write(Exec const& exec, Field const& f, Out const& out) const {
    kernels::launch(Move ? "gridmorph::move" : "gridmorph::write", exec, 0, n_nodes,
                    kernels::WriteNodes<Move>{f.u.data(), baseline.field, out.array()});
  }

  template <bool Move>
  void run(char const* who, Exec const& exec, std::span<In const> boundary, std::span<Out const> out) const {
    require(who, boundary, out);
    for (std::size_t k = 0; k < out.size(); ++k) {
      Field f = field;
      f.boundary = boundary[k].array();
      for_each_stage([&](auto const& stage) { stage.enqueue(exec, baseline.field, f); });
      write<Move>(exec, f, out[k]);
    }
  }

  void run_rate(Exec const& exec, In const& boundary, In const& boundary_rate, Out const& v) const {
    Field f = field, r = *rate;
    f.boundary = boundary.array();
    r.boundary = boundary_rate.array();
    for_each_stage([&](auto const& stage) {
      if constexpr (requires { stage.rate(exec, baseline.field, f, r); }) {
        stage.rate(exec, baseline.field, f, r);
      } else {
        stage.enqueue(exec, baseline.field, f);
        stage.enqueue(exec, baseline.field, r);
      }
    });
    write<false>(exec, r, v);
  }
};

template <class Exec>
UnstructuredMorpher<Exec>::UnstructuredMorpher(Exec const& exec, UnstructuredPlan const& plan, In const& baseline,
                                               MorpherOptions const& options) {
  detail::require_all_nodes("gridmorph::UnstructuredMorpher", baseline.size(), plan.n_nodes);
  state_ = std::make_shared<State>(exec, plan, baseline, options);
}

template <class Exec>
void UnstructuredMorpher<Exec>::positions(Exec const& exec, In const& boundary, Out const& moved) const {
  positions(exec, {&boundary, 1}, {&moved, 1});
}

template <class Exec>
void UnstructuredMorpher<Exec>::positions(Exec const& exec, std::span<In const> boundary,
                                          std::span<Out const> moved) const {
  state_->template run<true>("gridmorph::UnstructuredMorpher::positions", exec, boundary, moved);
}

template <class Exec>
void UnstructuredMorpher<Exec>::displacements(Exec const& exec, In const& boundary, Out const& u) const {
  displacements(exec, {&boundary, 1}, {&u, 1});
}

template <class Exec>
void UnstructuredMorpher<Exec>::displacements(Exec const& exec, std::span<In const> boundary,
                                              std::span<Out const> u) const {
  state_->template run<false>("gridmorph::UnstructuredMorpher::displacements", exec, boundary, u);
}

template <class Exec>
void UnstructuredMorpher<Exec>::velocities(Exec const& exec, In const& boundary, In const& rate, Out const& v) const {
  char const* const who = "gridmorph::UnstructuredMorpher::velocities";
  if (!state_->rate)
    throw ConfigError(std::string(who) + " needs room for rates; ask for it by MorpherOptions::velocity");
  for (In const* given : {&boundary, &rate}) state_->require(who, {given, 1}, {&v, 1});
  state_->run_rate(exec, boundary, rate, v);
}

template <class Exec>
kernels::Field<double const> UnstructuredMorpher<Exec>::background_displacement() const {
  for (auto const& stage : state_->list)
    if (auto const* far = std::get_if<stages::FarField<Exec>>(&stage)) return far->displacement();
  return {nullptr, nullptr, nullptr};
}

void apply_on_host(UnstructuredMorpher<Kokkos::DefaultHostExecutionSpace> const& morpher,
                   std::span<Vec3 const> boundary, Coordinates& moved) {
  Kokkos::DefaultHostExecutionSpace const exec;
  morpher.positions(exec, Kokkos::View<Vec3 const*, Kokkos::HostSpace>(boundary.data(), boundary.size()), moved);
  compat::fence(exec, "gridmorph::apply_on_host (read by the host)");
}

#define GRIDMORPH_INSTANTIATE(Exec) template class UnstructuredMorpher<Exec>;
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
