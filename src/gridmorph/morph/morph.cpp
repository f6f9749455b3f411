#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/core/stopwatch.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/morph/best_order.hpp>
#include <gridmorph/morph/detail/baseline.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/morph/predictor.hpp>
#include <gridmorph/plan/common_parts.hpp>
#include <gridmorph/plan/prepare.hpp>
#include <gridmorph/plan/trim_note.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>
#include <gridmorph/quality/quality.hpp>

#include <algorithm>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace gridmorph {

struct MorphPlan::State {
  std::optional<PreparedMorph> blocks;
  std::optional<PreparedUnstructured> elements;
  double planning = 0;    ///< seconds, of elements
  double predicting = 0;  ///< seconds that it took to see whether cells come out inverted
  double ordering = 0;    ///< seconds that the order of chains took to be found
  mutable std::mutex evaluating;
  mutable std::optional<std::vector<Vec3>> displacement;  ///< of the rules, once it was asked for

  State() = default;
  explicit State(PreparedMorph&& of) : blocks(std::move(of)) {}
  explicit State(PreparedUnstructured&& of) : elements(std::move(of)) {}

  void plan_blocks(HostInstance const& host, Mesh const& mesh, Motion const& motion, PlanOptions const& options,
                   MotionSeries const& series);
  void plan_elements(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology,
                     BoundaryFacePatches const& face_patches, Motion const& motion, PlanOptions options,
                     MotionSeries const& series);

  [[nodiscard]] std::vector<Vec3> const& displacement_by_rules() const;
  [[nodiscard]] std::vector<Vec3> evaluated(Motion const& motion) const;

 private:
  [[nodiscard]] std::optional<std::vector<Vec3>> displacement_if_any() const;
  void order_chains(HostInstance const& host, MotionSeries const& series);
};

std::vector<Vec3> const& MorphPlan::State::displacement_by_rules() const {
  std::lock_guard const lock(evaluating);
  if (!displacement) displacement = blocks ? blocks->boundary_displacement() : elements->boundary_displacement();
  return *displacement;
}

std::vector<Vec3> MorphPlan::State::evaluated(Motion const& motion) const {
  if (elements) return evaluate(elements->boundary, motion);
  return evaluate(blocks->planned.boundary, blocks->surface.with(motion), blocks->plan().rotations);
}

/// Nothing where the motion cannot be made, which is said by who asks for it.
std::optional<std::vector<Vec3>> MorphPlan::State::displacement_if_any() const {
  try {
    return displacement_by_rules();
  } catch (MotionError const&) {
    return {};
  }
}

void MorphPlan::State::plan_blocks(HostInstance const& host, Mesh const& mesh, Motion const& motion,
                                   PlanOptions const& options, MotionSeries const& series) {
  blocks = prepare(host, mesh, motion, options);
  // Of a series the displacements are still to come.
  split_common_motions(*blocks, [&]() -> std::optional<std::vector<Vec3>> {
    if (series.steps > 0) return {};
    return displacement_if_any();
  });
  if (options.volume.by_prediction() || options.volume.are_automatic()) order_chains(host, series);
}

/// Asked for: the order of chains predicted to be best. Left to us: another one where that by priority inverts cells.
void MorphPlan::State::order_chains(HostInstance const& host, MotionSeries const& series) {
  Stopwatch watch;
  bool const asked_for = blocks->options.volume.by_prediction();
  constexpr int enough = 8;  // to see whether any is needed
  Predictor predictor(host, *blocks, {});
  WorstPrediction worst([&](std::span<Vec3 const> boundary) { return predictor.predict(boundary); });
  try {
    if (series.steps == 0) {
      if (!asked_for && is_at_rest(displacement_by_rules())) return;
      worst.look_at(0, displacement_by_rules());
    }
    for (int const step : some_steps(series.steps, asked_for ? most_predicted : enough))
      worst.look_at(step, evaluated(series.motion(step)));
  } catch (MotionError const&) {
    if (asked_for) throw;
    return;  // the plan stands; that the motion cannot be made is said where it is made
  }
  bool const wanted = asked_for || is_inverted_by_priority(host, *blocks, worst.boundary(), worst.prediction());
  if (!asked_for) predicting = watch.lap();
  if (!wanted) return;
  plan_by_prediction(host, *blocks, worst.boundary());
  ordering = watch.lap();
}

void MorphPlan::State::plan_elements(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology,
                                     BoundaryFacePatches const& face_patches, Motion const& motion, PlanOptions options,
                                     MotionSeries const& series) {
  Problems problems;
  for (auto const& problem : face_patches.problems) problems.add(problem);
  problems.throw_if_any<MeshError>();
  Stopwatch watch;
  NodeGraph graph = make_node_graph(host, mesh, topology.elements_of_nodes, row_of_nodes(mesh, motion));
  bool const any = series.steps > 0 || options.elements.motion >= 0;
  BoundaryConditions boundary =
      boundary_conditions(host, mesh, topology, face_patches, graph, motion, options.elements.walls,
                          any ? Displacements::any : Displacements::of_the_rules);
  if (series.steps > 0) {  // the offset of the wrap reckons with all steps, of very many with some
    constexpr int most = 1000;
    options.elements.motion = 0;
    for (int const step : some_steps(series.steps, most)) {
      auto displacement = evaluate(boundary, series.motion(step));
      double const largest = largest_norm(displacement);
      if (!(largest > options.elements.motion)) continue;
      options.elements.motion = largest;
      options.elements.shape = std::move(displacement);
    }
  }
  double const conditions = watch.lap();
  elements = prepare(host, mesh, topology, face_patches, std::move(graph), std::move(boundary), options);
  elements->report.seconds.boundary += conditions;
  planning = conditions + watch.lap();
}

MorphPlan::MorphPlan(HostInstance const& host, IndexedMesh const& mesh, Motion const& motion,
                     PlanOptions const& options, MotionSeries const& series) {
  auto state = std::make_shared<State>();
  if (mesh.is_structured())
    state->plan_blocks(host, mesh.mesh(), motion, options, series);
  else
    state->plan_elements(host, mesh.mesh(), mesh.topology(), mesh.face_patches(), motion, options, series);
  state_ = std::move(state);
}

MorphPlan::MorphPlan(HostInstance const& host, Mesh const& mesh, Motion const& motion, PlanOptions const& options,
                     MotionSeries const& series) {
  auto state = std::make_shared<State>();
  if (mesh.is_structured()) {
    state->plan_blocks(host, mesh, motion, options, series);
  } else {
    check_mesh(mesh);
    UnstructuredTopology const topology = make_topology(host, mesh);
    state->plan_elements(host, mesh, topology, find_face_patches(mesh, topology), motion, options, series);
  }
  state_ = std::move(state);
}

MorphPlan::MorphPlan(Mesh const& mesh, Motion const& motion, PlanOptions const& options)
    : MorphPlan(HostInstance(), mesh, motion, options) {}

PreparedMorph const* PlanAccess::blocks(MorphPlan const& plan) {
  return plan.state_->blocks ? &*plan.state_->blocks : nullptr;
}
PreparedUnstructured const* PlanAccess::elements(MorphPlan const& plan) {
  return plan.state_->elements ? &*plan.state_->elements : nullptr;
}
MorphPlan PlanAccess::of(PreparedMorph&& prepared) {
  return MorphPlan(std::make_shared<MorphPlan::State const>(std::move(prepared)));
}
MorphPlan PlanAccess::of(PreparedUnstructured&& prepared) {
  return MorphPlan(std::make_shared<MorphPlan::State const>(std::move(prepared)));
}

std::vector<int> some_steps(int n, int most) {
  std::vector<int> out;
  int const count = std::min(n, most);
  for (int k = 0; k < count; ++k) out.push_back(count < 2 ? k : int(std::int64_t(k) * (n - 1) / (count - 1)));
  return out;
}

Index MorphPlan::n_nodes() const {
  return state_->blocks ? state_->blocks->plan().n_nodes : state_->elements->plan.n_nodes;
}

std::vector<Index> MorphPlan::boundary_nodes() const {
  if (state_->blocks) return state_->blocks->plan().boundary_nodes;
  auto const& known = state_->elements->plan.known;
  return {known.begin(), known.end()};
}

Index MorphPlan::n_boundary_nodes() const {
  return Index(state_->blocks ? state_->blocks->plan().boundary_nodes.size() : state_->elements->plan.known.size());
}

std::vector<BoundaryPlace> MorphPlan::boundary_places() const {
  auto const& blocks = state_->blocks;
  auto const& elements = state_->elements;
  Boundary const& boundary = rules().boundary();
  auto const& requests = blocks ? blocks->planned.boundary.requests : elements->boundary.requests.requests;
  std::vector<BoundaryPlace> out;
  for (auto const& r : requests) {
    int const z = boundary.zone_of(r.node);
    Zone const& zone = boundary.zones()[z];
    Index3 const index = zone.is_block() ? zone.index(r.node) : Index3{int(r.node - zone.first_node), 0, 0};
    out.push_back({r.boundary_node, r.patch, z, index, {}});
    if (r.rotation >= 0) out.back().rotation = blocks->plan().rotations[r.rotation];
  }
  std::stable_sort(out.begin(), out.end(),
                   [](auto const& a, auto const& b) { return a.boundary_node < b.boundary_node; });
  return out;
}

std::vector<Vec3> const& MorphPlan::boundary_displacement() const { return state_->displacement_by_rules(); }

std::vector<Vec3> MorphPlan::boundary_displacement(Motion const& motion) const { return state_->evaluated(motion); }

std::vector<std::string> MorphPlan::notes() const {
  if (state_->elements) return state_->elements->notes;
  PreparedMorph const& blocks = *state_->blocks;
  std::vector<std::string> out = blocks.mesh.notes;
  for (auto const* list : {&blocks.surface.motion().notes, &blocks.surface.notes(), &blocks.plan().notes})
    out.insert(out.end(), list->begin(), list->end());
  return out;
}

BoundaryMotion const& MorphPlan::rules() const {
  return state_->blocks ? state_->blocks->surface : *state_->elements->boundary.motion;
}

namespace {

NearCells near_cells_of(PreparedMorph const& prepared) {
  Mesh const& mesh = prepared.mesh;
  Kokkos::View<std::uint8_t*, Kokkos::HostSpace> const mask("gridmorph::near_cells", std::size_t(mesh.n_cells()));
  std::vector<Index> const first = first_cells(mesh);
  for (auto const& box : prepared.plan().near_field) {
    Zone const& zone = mesh.zones[box.zone];
    Index const ni = zone.extent[0] - 1, nj = zone.extent[1] - 1;
    for (int k = box.cells.begin[2]; k < box.cells.end[2]; ++k)
      for (int j = box.cells.begin[1]; j < box.cells.end[1]; ++j)
        for (int i = box.cells.begin[0]; i < box.cells.end[0]; ++i) mask(first[box.zone] + i + ni * (j + nj * k)) = 1;
  }
  NearCells out{mask, {}};
  for (auto const& layer : prepared.options.boundary_layers)
    if (!layer.walls.empty())
      for (int const p : select_patches(mesh, layer.walls)) out.walls.push_back(p);
  return out;
}

NearCells near_cells_of(PreparedUnstructured const& prepared) {
  auto const& regions = prepared.report.regions.element;
  Kokkos::View<std::uint8_t*, Kokkos::HostSpace> const near("gridmorph::near_cells", regions.size());
  for (std::size_t e = 0; e < regions.size(); ++e) near(e) = regions[e] == Region::far ? 0 : 1;
  return {near, prepared.boundary.driving_patches};
}

}  // namespace

NearCells MorphPlan::near_cells() const {
  return state_->blocks ? near_cells_of(*state_->blocks) : near_cells_of(*state_->elements);
}

std::vector<Trim> MorphPlan::trims(std::vector<Vec3> const& boundary) const {
  return PlanAccess::trims(*this, boundary, rules());
}

std::vector<Trim> MorphPlan::trims(std::vector<Vec3> const& boundary, Motion const& motion) const {
  if (state_->elements) return trims(boundary);
  return PlanAccess::trims(*this, boundary, state_->blocks->surface.with(motion));
}

std::vector<PlanSeconds> MorphPlan::seconds() const {
  if (state_->elements) return {{"plan", state_->planning}};
  auto const& took = state_->blocks->seconds;
  std::vector<PlanSeconds> out{{"topology", took.topology}, {"rules", took.rules}, {"plan", took.plan}};
  if (state_->predicting > 0) out.push_back({"prediction", state_->predicting});
  if (state_->ordering > 0) out.push_back({"order", state_->ordering});
  return out;
}

MorphPlan MorphPlan::with(std::shared_ptr<SmoothingMap const> smoothing) const {
  MorphPlan out = *this;
  out.smoothing_ = std::move(smoothing);
  return out;
}

namespace {

/// Where kernels can read it: the View itself, or a copy.
template <class Exec, class T>
Kokkos::View<T*, typename Exec::memory_space> reachable(Exec const& exec, char const* label,
                                                        Kokkos::View<T*, Kokkos::HostSpace> const& host) {
  if constexpr (std::is_same_v<typename Exec::memory_space, Kokkos::HostSpace>) {
    return host;
  } else {
    // As a string: Kokkos takes another kind of pointer for memory to wrap.
    Kokkos::View<T*, typename Exec::memory_space> copy(
        Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, std::string(label)), host.extent(0));
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

template <BuiltFor Exec>
Coordinates host_coordinates(Exec const& exec, ConstVectorView<typename Exec::memory_space> const& x) {
  Index const n = x.size();
  // Host and device exchange arrays that are contiguous alone.
  Kokkos::View<double*, typename Exec::memory_space> const flat(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::host_coordinates"), std::size_t(3 * n));
  kernels::Field<double> const field{flat.data(), flat.data() + n, flat.data() + 2 * n};
  kernels::launch("gridmorph::host_coordinates", exec, 0, n, detail::CopyVectors{x.array(), field});
  Coordinates const out(n);
  Index first = 0;
  for (auto const& to : {out.x, out.y, out.z}) {
    Kokkos::deep_copy(exec, to, Kokkos::subview(flat, std::pair(first, first + n)));
    first += n;
  }
  compat::fence(exec, "gridmorph::host_coordinates (read by the host)");
  return out;
}

template <BuiltFor Exec>
Coordinates morph(Exec const& exec, Mesh const& mesh, Motion const& motion, PlanOptions const& options) {
  MorphPlan const plan(host_instance(exec), mesh, motion, options);
  return moved_by(exec, plan, mesh.coordinates, [&](auto const& boundary, auto const& x, auto const& y, auto const& z) {
    VectorView<typename Exec::memory_space> const all(x, y, z);
    Morpher<Exec>(exec, plan, all).positions(exec, boundary, all);
  });
}

#define GRIDMORPH_INSTANTIATE(Exec)                                                               \
  template Coordinates host_coordinates(Exec const&, ConstVectorView<Exec::memory_space> const&); \
  template Coordinates morph(Exec const&, Mesh const&, Motion const&, PlanOptions const&);
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
