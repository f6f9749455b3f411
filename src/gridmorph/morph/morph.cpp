#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/morph/best_order.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/plan/common_parts.hpp>
#include <gridmorph/plan/prepare.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>

namespace gridmorph {

struct MorphPlan::State {
  std::optional<PreparedMorph> blocks;
  std::optional<PreparedUnstructured> elements;
  std::vector<Vec3> displacement;
};

MorphPlan::MorphPlan(Mesh const& mesh, Motion const& motion, PlanOptions const& options)
    : MorphPlan(HostInstance(), mesh, motion, options) {}

MorphPlan::MorphPlan(HostInstance const& host, Mesh const& mesh, Motion const& motion, PlanOptions const& options) {
  auto state = std::make_shared<State>();
  if (mesh.is_structured()) {
    state->blocks = prepare(host, mesh, motion, options);
    state->displacement = state->blocks->boundary_displacement();
    split_common_motions(*state->blocks, [&] { return std::optional(state->displacement); });
    if (options.volume.by_prediction() ||
        (options.volume.are_automatic() && is_inverted_by_priority(host, *state->blocks, state->displacement)))
      plan_by_prediction(host, *state->blocks, state->displacement);
  } else {
    check_mesh(mesh);
    UnstructuredTopology const topology = make_topology(host, mesh);
    state->elements = prepare(host, mesh, topology, find_face_patches(mesh, topology), motion, options);
    state->displacement = state->elements->boundary_displacement(mesh);
  }
  state_ = std::move(state);
}

Index MorphPlan::n_nodes() const { return blocks() ? blocks()->plan().n_nodes : elements()->plan.n_nodes; }

std::vector<Index> MorphPlan::boundary_nodes() const {
  if (blocks()) return blocks()->plan().boundary_nodes;
  auto const& known = elements()->plan.known;
  return {known.begin(), known.end()};
}

std::vector<BoundaryPlace> MorphPlan::boundary_places() const {
  Mesh const& mesh = blocks() ? blocks()->mesh : elements()->boundary.motion->boundary().mesh();
  auto const& requests = blocks() ? blocks()->planned.boundary.requests : elements()->boundary.requests.requests;
  std::vector<BoundaryPlace> out;
  for (auto const& r : requests) {
    int const z = mesh.zone_of(r.node);
    Zone const& zone = mesh.zones[std::size_t(z)];
    Index3 const index = zone.is_block() ? zone.index(r.node) : Index3{int(r.node - zone.first_node), 0, 0};
    out.push_back({r.boundary_node, r.patch, z, index, {}});
    if (r.rotation >= 0) out.back().rotation = blocks()->plan().rotations[std::size_t(r.rotation)];
  }
  std::stable_sort(out.begin(), out.end(),
                   [](auto const& a, auto const& b) { return a.boundary_node < b.boundary_node; });
  return out;
}

std::vector<Vec3> const& MorphPlan::boundary_displacement() const { return state_->displacement; }

std::vector<Vec3> MorphPlan::boundary_displacement(Motion const& motion) const {
  if (elements()) return evaluate(elements()->boundary, motion);
  PreparedMorph const& prepared = *blocks();
  return evaluate(prepared.mesh, prepared.planned.boundary, prepared.surface.with(motion), prepared.plan().rotations);
}

std::vector<std::string> MorphPlan::notes() const {
  if (elements()) return elements()->notes;
  std::vector<std::string> out = blocks()->mesh.notes;
  for (auto const* list : {&blocks()->surface.motion().notes, &blocks()->surface.notes(), &blocks()->plan().notes})
    out.insert(out.end(), list->begin(), list->end());
  return out;
}

MorphPlan MorphPlan::with(std::shared_ptr<SmoothingMap const> smoothing) const {
  MorphPlan out = *this;
  out.smoothing_ = std::move(smoothing);
  return out;
}

PreparedMorph const* MorphPlan::blocks() const { return state_->blocks ? &*state_->blocks : nullptr; }
PreparedUnstructured const* MorphPlan::elements() const { return state_->elements ? &*state_->elements : nullptr; }

namespace {

/// Where kernels can read it: the View itself, or a copy.
template <class Exec, class T>
Kokkos::View<T*, typename Exec::memory_space> reachable(Exec const& exec, char const* label,
                                                        Kokkos::View<T*, Kokkos::HostSpace> const& host) {
  if constexpr (std::is_same_v<typename Exec::memory_space, Kokkos::HostSpace>) {
    return host;
  } else {
    Kokkos::View<T*, typename Exec::memory_space> copy(Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, label),
                                                       host.extent(0));
    Kokkos::deep_copy(exec, copy, host);
    return copy;
  }
}

/// run(boundary, x): moves x to the new positions, given the displacement of the boundary.
template <class Exec, class Run>
Coordinates moved_by(Exec const& exec, MorphPlan const& plan, Coordinates const& baseline, Run const& run) {
  Coordinates const out(baseline.size());
  Kokkos::deep_copy(exec, out.x, baseline.x);
  Kokkos::deep_copy(exec, out.y, baseline.y);
  Kokkos::deep_copy(exec, out.z, baseline.z);
  std::vector<Vec3> u = plan.boundary_displacement();
  Kokkos::View<Vec3*, Kokkos::HostSpace> const given(u.data(), u.size());
  auto const boundary = reachable(exec, "gridmorph::morph::boundary", given);
  auto const x = reachable(exec, "gridmorph::morph::x", out.x), y = reachable(exec, "gridmorph::morph::y", out.y),
             z = reachable(exec, "gridmorph::morph::z", out.z);
  run(boundary, x, y, z);
  Kokkos::deep_copy(exec, out.x, x);
  Kokkos::deep_copy(exec, out.y, y);
  Kokkos::deep_copy(exec, out.z, z);
  compat::fence(exec, "gridmorph::morph (the host reads the coordinates)");
  return out;
}

}  // namespace

template <class Exec>
Coordinates morph(Exec const& exec, Mesh const& mesh, Motion const& motion, PlanOptions const& options) {
  MorphPlan const plan(host_instance(exec), mesh, motion, options);
  return moved_by(exec, plan, mesh.coordinates, [&](auto const& boundary, auto const& x, auto const& y, auto const& z) {
    VectorView<typename Exec::memory_space> const all(x, y, z);
    Morpher<Exec>(exec, plan, all).positions(exec, boundary, all);
  });
}

#define GRIDMORPH_INSTANTIATE(Exec) \
  template Coordinates morph(Exec const&, Mesh const&, Motion const&, PlanOptions const&);
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
