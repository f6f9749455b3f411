// Cost of the stages of an unstructured morph: the ball demo (bench_rbf has the same mesh), its nodes and elements
// numbered at random, which is the worst order there is (names begin with unstructured/); "nodes" are about 0.24 times
// the elements.
//
// Once per mesh, on the host:
//   topology      neighbours, boundary faces, lists around nodes
//   node_graph    which nodes are joined by edges
//   prepare       all of planning: boundary, columns, wrap, layers, background mesh, point location
//   order         nodes and elements brought in order by position, as the command line does after reading
//
// Once per motion, all cores:
//   layers        displacement from layer to layer of near and partially wrapped elements
//   project       far nodes in cells of the background mesh
//   scatter       moving walls to the lattice between them
//   background    the background mesh itself: the structured engine on some ten thousand nodes
//   apply         all of it, from boundary displacements to new coordinates
//   free_body     the same where a sphere amid the mesh grows in one direction; fit: by least squares
//
// topology, prepare and apply also on the mesh in order by position (..._in_order), and there alone:
//   transpose     gradients of all nodes handed back to the boundary
//
// Model, bytes. Rows (layers, project): 12 per row, 8 and a source of 24 per item, 24 written. apply: those; 60 per
// node for displacement and work array, 48 for coordinates in and out, and as much again for the residual's value, fade
// and lattice cells (24 + 4 + 8 * 24, of which neighbours share most). Sources of items lie anywhere: a cache line (64)
// each, so that randomly numbered meshes take up to 64 / 24 times as long as the model says.
#include "bench.hpp"
#include "last_made.hpp"
#include "node_arrays.hpp"
#include "roof.hpp"

#include <generators/ball_demo.hpp>
#include <generators/sphere.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/morph/morpher_access.hpp>
#include <gridmorph/morph/stages/smooth_field.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::bench {

constexpr double nodes_per_element = 0.24;

/// The ball swings by 30 degrees, everything else stands.
Motion swing(BallOptions const& options) {
  FunctionRule rule;
  rule.description = "ball demo";
  rule.function = [options](std::span<Vec3 const> points, std::span<Vec3> displacement) {
    for (std::size_t n = 0; n < points.size(); ++n) displacement[n] = ball_displacement(options, {}, points[n]);
  };
  Motion motion;
  motion.rules.push_back({{"ball", "rope"}, rule, 0, "bench"});
  return motion;
}

/// A ball mesh with what benchmarks need of it; planned when the first asks.
struct BallCase {
  BallOptions options;
  Mesh mesh;
  UnstructuredTopology topology;
  BoundaryFacePatches face_patches;

  BallCase(Index nodes, bool in_order) {
    options.shuffle = true;
    options.elements = std::max(Index(50'000), Index(double(nodes) / nodes_per_element));
    mesh = make_ball(options);
    if (in_order) reorder(mesh, order_by_position(mesh));
    topology = make_topology(mesh);
    face_patches = find_face_patches(mesh, topology);
  }
  [[nodiscard]] PreparedUnstructured prepare() const {
    return gridmorph::prepare(mesh, topology, face_patches, swing(options), {});
  }
  [[nodiscard]] PreparedUnstructured const& prepared() const {
    if (!prepared_) prepared_.emplace(prepare());
    return *prepared_;
  }
  [[nodiscard]] UnstructuredPlan const& plan() const { return prepared().plan; }

 private:
  mutable std::optional<PreparedUnstructured> prepared_;
};

BallCase const& ball_case(Index nodes, bool in_order = false) {
  using Key = std::pair<Index, bool>;
  static LastMade<Key, BallCase> last;
  return last.get(Key(nodes, in_order), [&] { return BallCase(nodes, in_order); });
}

/// Rates per node and per element of the mesh; bytes of one iteration.
template <class ExecutionSpace>
void set_ball_rates(benchmark::State& state, ExecutionSpace const& exec, double mean, Mesh const& mesh, double bytes) {
  set_shares(state, exec, mean, mesh.n_nodes(), bytes / double(mesh.n_nodes()));
  state.counters["elements"] = double(mesh.n_elements());
  state.counters["elements/s"] = double(mesh.n_elements()) / mean;
}

double bytes_of(InterpolationOperator const& rows) {
  return 36.0 * double(rows.size()) + 32.0 * double(rows.item.size());
}

/// Work on the host, on the cores of the default host execution space whatever `exec` is.
template <class Work>
void time_host(benchmark::State& state, Mesh const& mesh, Work const& work) {
  Kokkos::DefaultHostExecutionSpace const exec;
  double const mean = time_iterations(state, exec, work);
  state.counters["nodes"] = double(mesh.n_nodes());
  state.counters["nodes/s"] = double(mesh.n_nodes()) / mean;
  state.counters["elements"] = double(mesh.n_elements());
  state.counters["elements/s"] = double(mesh.n_elements()) / mean;
}

void order(benchmark::State& state) {
  BallCase const& ball = ball_case(state.range(0));
  time_host(state, ball.mesh, [&] {
    Mesh mesh = ball.mesh;
    reorder(mesh, order_by_position(mesh));
    benchmark::DoNotOptimize(mesh.elements.nodes.item.data());
  });
}

template <bool in_order>
void topology(benchmark::State& state) {
  BallCase const& ball = ball_case(state.range(0), in_order);
  time_host(state, ball.mesh, [&] { benchmark::DoNotOptimize(make_topology(ball.mesh).boundary.size()); });
}

void node_graph(benchmark::State& state) {
  BallCase const& ball = ball_case(state.range(0));
  auto const around = elements_of_nodes(ball.mesh);
  time_host(state, ball.mesh, [&] { benchmark::DoNotOptimize(make_node_graph(ball.mesh, around).size()); });
}

template <bool in_order>
void prepare_all(benchmark::State& state) {
  BallCase const& ball = ball_case(state.range(0), in_order);
  time_host(state, ball.mesh, [&] { benchmark::DoNotOptimize(ball.prepare().report.far_nodes); });
}

struct Layers {
  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    using Memory = typename ExecutionSpace::memory_space;
    BallCase const& ball = ball_case(state.range(0));
    auto const near = stages::upload(exec, ball.plan().near, "gridmorph::bench::near");
    Kokkos::View<Vec3*, Memory> const u("gridmorph::bench::u", std::size_t(ball.mesh.n_nodes()));
    double const mean = time_iterations(
        state, exec, [&] { kernels::interpolate_layers("gridmorph::bench::layers", exec, near, u.data()); });
    set_ball_rates(state, exec, mean, ball.mesh, bytes_of(ball.plan().near.rows));
    state.counters["layers"] = ball.plan().near.n_layers();
    state.counters["rows/s"] = double(near.rows.size()) / mean;
  }
};

struct Project {
  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    using Memory = typename ExecutionSpace::memory_space;
    BallCase const& ball = ball_case(state.range(0));
    auto const far = stages::upload(exec, ball.plan().far, "gridmorph::bench::far");
    NodeArrays<Memory> const background(ball.plan().background->mesh.coordinates);
    Kokkos::View<Vec3*, Memory> const u("gridmorph::bench::u", std::size_t(ball.mesh.n_nodes()));
    double const mean = time_iterations(
        state, exec, [&] { kernels::interpolate("gridmorph::bench::far", exec, far, background.read(), u.data()); });
    set_ball_rates(state, exec, mean, ball.mesh, bytes_of(ball.plan().far));
    state.counters["rows/s"] = double(far.size()) / mean;
  }
};

struct Scatter {
  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    using Memory = typename ExecutionSpace::memory_space;
    BallCase const& ball = ball_case(state.range(0));
    stages::SmoothField<ExecutionSpace, kernels::AffineMotion> const walls(exec, ball.plan().walls,
                                                                           "gridmorph::bench::walls");
    Kokkos::View<kernels::AffineMotion*, Memory> const given("gridmorph::bench::given", ball.plan().driving.size());
    double const mean = time_iterations(state, exec, [&] { walls.enqueue(exec, given.data()); });
    auto const& plan = ball.plan().walls;
    constexpr double item = 8 + sizeof(kernels::AffineMotion);
    set_ball_rates(state, exec, mean, ball.mesh,
                   item * double(plan.leaves.item.size() + plan.groups.rows.item.size() + plan.lattice.item.size()));
    state.counters["wall nodes"] = double(ball.plan().driving.size());
    state.counters["lattice"] = double(plan.lattice.size());
  }
};

struct BackgroundMesh {
  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    using Memory = typename ExecutionSpace::memory_space;
    BallCase const& ball = ball_case(state.range(0));
    auto const& plan = ball.plan().background_morph->plan();
    NodeArrays<Memory> const x(ball.plan().background->mesh.coordinates), u(ball.plan().background->mesh.coordinates);
    Kokkos::View<Vec3*, Memory> const boundary("gridmorph::bench::boundary", plan.boundary_nodes.size());
    auto const morpher = MorpherAccess::of(exec, plan, x);
    double const mean = time_iterations(state, exec, [&] { morpher.displacements(exec, boundary, u); });
    set_rates(state, ball.plan().background->mesh.n_nodes(), 48);
    state.counters["nodes of the mesh/s"] = double(ball.mesh.n_nodes()) / mean;
  }
};

/// Times what a plan makes of its boundary displacements; `bytes`: of its rows.
template <class ExecutionSpace>
void time_apply(ExecutionSpace const& exec, benchmark::State& state, Mesh const& mesh,
                PreparedUnstructured const& prepared, double bytes) {
  using Memory = typename ExecutionSpace::memory_space;
  NodeArrays<Memory> const baseline(mesh.coordinates), morphed(mesh.coordinates);
  auto const morpher = MorpherAccess::of(exec, prepared.plan, baseline);
  auto const given = prepared.boundary_displacement();
  auto const boundary = stages::upload(exec, given, "gridmorph::bench::boundary");
  double const mean = time_iterations(state, exec, [&] { morpher.positions(exec, boundary, morphed); });
  set_ball_rates(state, exec, mean, mesh, bytes + (60 + 48 + 220) * double(mesh.n_nodes()));
}
double bytes_of_rows(UnstructuredPlan const& plan) {
  return bytes_of(plan.near.rows) + bytes_of(plan.far) + bytes_of(plan.residual_detail.rows);
}

struct Apply {
  bool in_order = false;

  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    BallCase const& ball = ball_case(state.range(0), in_order);
    time_apply(exec, state, ball.mesh, ball.prepared(), bytes_of_rows(ball.plan()));
  }
};

/// Gradients of nodes handed back to the boundary; bytes as if it were Apply.
struct Transpose {
  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    using Memory = typename ExecutionSpace::memory_space;
    BallCase const& ball = ball_case(state.range(0), true);
    UnstructuredPlan const& plan = ball.plan();
    NodeArrays<Memory> const baseline(ball.mesh.coordinates);
    auto const morpher = MorpherAccess::of(exec, plan, baseline, {.transpose = true});
    auto const given = ball.prepared().boundary_displacement();
    auto const boundary = stages::upload(exec, given, "gridmorph::bench::boundary");
    auto const out = Kokkos::create_mirror(Memory(), boundary);
    double const mean = time_iterations(state, exec, [&] { morpher.transpose(exec, boundary, baseline, out); });
    set_ball_rates(state, exec, mean, ball.mesh, bytes_of_rows(plan) + (60 + 48 + 220) * double(ball.mesh.n_nodes()));
  }
};

/// A sphere amid a mesh in order, which grows by half in one direction; bytes of the rows and of all nodes.
struct FreeBody {
  NearFieldMethod method;

  struct Made {
    Mesh mesh;
    PreparedUnstructured prepared;
  };
  [[nodiscard]] Made make(Index nodes) const {
    SphereOptions sphere;
    sphere.elements = std::max(Index(20'000), Index(double(nodes) / nodes_per_element));
    Made out{make_sphere(sphere), {}};
    reorder(out.mesh, order_by_position(out.mesh));
    FunctionRule const grows{"grows", [](std::span<Vec3 const> x, std::span<Vec3> u) {
                               for (std::size_t n = 0; n < x.size(); ++n) u[n] = {0.5 * x[n].x, 0, 0};
                             }};
    Motion motion;
    motion.rules.push_back({{"sphere"}, grows, 0, "bench"});
    PlanOptions options;
    options.elements.method = method;
    UnstructuredTopology const topology = make_topology(out.mesh);
    out.prepared = prepare(out.mesh, topology, find_face_patches(out.mesh, topology), motion, options);
    return out;
  }
  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    static LastMade<std::pair<NearFieldMethod, Index>, Made> last;
    Made const& made = last.get({method, state.range(0)}, [&] { return make(state.range(0)); });
    UnstructuredPlan const& plan = made.prepared.plan;
    double const fit = 60.0 * double(plan.fit.nodes.size()) + 8.0 * double(plan.fit.nodes.item.size());
    time_apply(exec, state, made.mesh, made.prepared, bytes_of_rows(plan) + fit);
    if (plan.fit.nodes.size() > 0)
      state.counters["groups per node"] = double(plan.fit.nodes.item.size()) / double(plan.fit.nodes.size());
  }
};

/// 0.05 to 10 million elements.
std::vector<std::int64_t> const ball_sizes{smoke_nodes, 24'000, 120'000, 480'000, 1'200'000, 2'400'000};

void register_host(char const* name, void (*run)(benchmark::State&)) {
  auto* const registered = benchmark::RegisterBenchmark((std::string(name) + "/host").c_str(), run)
                               ->ArgName("nodes")
                               ->UseManualTime()
                               ->Unit(benchmark::kMillisecond);
  for (std::int64_t const n : ball_sizes) registered->Arg(n);
}

void register_all() {
  register_host("unstructured/order", order);
  register_host("unstructured/topology", topology<false>);
  register_host("unstructured/node_graph", node_graph);
  register_host("unstructured/prepare", prepare_all<false>);
  register_benchmark("unstructured/layers", Layers(), ball_sizes);
  register_benchmark("unstructured/project", Project(), ball_sizes);
  register_benchmark("unstructured/scatter", Scatter(), ball_sizes);
  register_benchmark("unstructured/background", BackgroundMesh(), ball_sizes);
  register_benchmark("unstructured/apply", Apply(), ball_sizes);
  register_benchmark("unstructured/free_body", FreeBody{NearFieldMethod::lattice}, ball_sizes);
  register_benchmark("unstructured/fit", FreeBody{NearFieldMethod::least_squares}, ball_sizes);
  register_host("unstructured/topology_in_order", topology<true>);
  register_host("unstructured/prepare_in_order", prepare_all<true>);
  register_benchmark("unstructured/apply_in_order", Apply{true}, ball_sizes);
  register_benchmark("unstructured/transpose_in_order", Transpose(), ball_sizes);
}

}  // namespace gridmorph::bench
