// What a morph by radial basis functions costs on the nodes of the ball demo: 1,000 centres picked from the boundary.
//
//   unstructured/rbf_apply   displacement of all nodes from the weights    1,000 centres per node; 48 bytes per node
//   unstructured/rbf_solve   weights from the displacements of the centres  independent of the nodes
//
// "elements/s" compares with the unstructured morph, which has no centres. "error": largest difference from the given
// displacement over all nodes of ball and rope, in radii of the ball: what 1,000 centres leave of the boundary's shape.
#include "bench.hpp"
#include "last_made.hpp"
#include "node_arrays.hpp"
#include "rbf_reference.hpp"
#include "roof.hpp"

#include <generators/ball_demo.hpp>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace gridmorph::bench {

constexpr int n_centres = 1000;
constexpr double nodes_per_element = 0.24;

struct BallCase {
  Mesh mesh;
  std::vector<Vec3> centres, displacement;
  double error = 0;
};

/// Half of the centres from ball and rope, the others from what stands still.
BallCase make_case(Index nodes) {
  BallCase out;
  BallOptions options;
  options.elements = std::max(Index(50'000), Index(double(nodes) / nodes_per_element));
  out.mesh = make_ball(options);
  std::vector<Index32> moving, still;
  for (auto const& patch : out.mesh.patches) {
    auto& list = patch.name == "ball" || patch.name == "rope" ? moving : still;
    auto const nodes_of = patch_nodes(patch);
    list.insert(list.end(), nodes_of.begin(), nodes_of.end());
  }
  std::mt19937 random(1);
  auto const pick = [&](std::vector<Index32>& list, std::vector<Index32> const& taken) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    for (Index32 const n : taken) list.erase(std::remove(list.begin(), list.end(), n), list.end());
    for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[random() % i]);
    std::size_t const n = std::min(list.size(), std::size_t(n_centres / 2));
    return std::vector<Index32>(list.begin(), list.begin() + std::ptrdiff_t(n));
  };
  auto const fixed = pick(still, {});
  auto const swinging = pick(moving, fixed);
  for (auto const* list : {&fixed, &swinging})
    for (Index32 const n : *list) {
      Vec3 const p = out.mesh.coordinates[n];
      out.centres.push_back(p);
      out.displacement.push_back(list == &swinging ? ball_displacement(options, {}, p) : Vec3{});
    }
  RbfField<Kokkos::HostSpace> const field(out.centres, out.displacement, out.mesh.size());
  for (Index32 const n : moving) {
    Vec3 const p = out.mesh.coordinates[n];
    out.error = std::max(out.error, distance(field(p), ball_displacement(options, {}, p)));
  }
  return out;
}

BallCase const& ball_case(Index nodes) {
  static LastMade<Index, BallCase> cases;
  return cases.get(nodes, [&] { return make_case(nodes); });
}

struct Apply {
  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    using Memory = typename ExecutionSpace::memory_space;
    BallCase const& ball = ball_case(state.range(0));
    RbfField<Memory> const field(ball.centres, ball.displacement, ball.mesh.size());
    NodeArrays<Memory> const baseline(ball.mesh.coordinates), morphed(ball.mesh.coordinates);
    auto const n = std::size_t(ball.mesh.n_nodes());
    double const mean = time_iterations(state, exec, [&] { field.apply(exec, n, baseline.read(), morphed.write()); });
    set_rates(state, ball.mesh.n_nodes(), 48);
    state.counters["elements"] = double(ball.mesh.n_elements());
    state.counters["elements/s"] = double(ball.mesh.n_elements()) / mean;
    state.counters["centres"] = double(ball.centres.size());
    state.counters["error"] = ball.error;
  }
};

struct Solve {
  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    BallCase const& ball = ball_case(state.range(0));
    time_iterations(state, exec, [&] {
      RbfField<typename ExecutionSpace::memory_space> const field(ball.centres, ball.displacement, ball.mesh.size());
      benchmark::DoNotOptimize(field.weights.data());
    });
    state.counters["centres"] = double(ball.centres.size());
  }
};

void register_all() {
  register_benchmark("unstructured/rbf_apply", Apply(), {smoke_nodes, cache_nodes, 400'000, 1'000'000});
  register_benchmark("unstructured/rbf_solve", Solve(), {smoke_nodes, cache_nodes});
}

}  // namespace gridmorph::bench
