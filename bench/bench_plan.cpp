// What it takes to know what to do: topology, rules and plan of a mesh of 500 blocks.
//
//   prepare   connect, check, resolve, plan; counters "topology", "rules" and "plan" are its parts in seconds
//
// The mesh is a cube of 8 x 8 x 8 bricks with twelve of them left out, here and there: each hole is a moving wall whose
// edges and corners keep blocks apart, so that chains are many and have ties to break. Nothing of it depends on the
// displacement. To be compared with read_mesh of bench_io at as many nodes.
#include "bench.hpp"

#include <gridmorph/plan/prepare.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace gridmorph::bench {
namespace {

constexpr int bricks = 8;
using Numbers = std::array<std::array<std::array<int, bricks>, bricks>, bricks>;

/// Zone of each brick, -1 for those left out: no two of them touch.
Numbers number_bricks() {
  Numbers number{};
  int next = 0, left_out = 0;
  for (int k = 0; k < bricks; ++k)
    for (int j = 0; j < bricks; ++j)
      for (int i = 0; i < bricks; ++i) {
        bool const inner = std::min({i, j, k}) > 0 && std::max({i, j, k}) < bricks - 1;
        bool const out = inner && left_out < 12 && i % 2 == 1 && j % 2 == 1 && k % 2 == 1 && (i + j + k) % 4 != 1;
        left_out += out;
        number[i][j][k] = out ? -1 : next++;
      }
  return number;
}

IndexRange face(Index3 const& extent, int axis, int side) {
  IndexRange r{{0, 0, 0}, extent};
  r.begin[axis] = side == 0 ? 0 : extent[axis] - 1;
  r.end[axis] = r.begin[axis] + 1;
  return r;
}

Mesh make_bricks(std::int64_t nodes) {
  Numbers const number = number_bricks();
  int const m = std::max(2, int(std::cbrt(double(nodes) / 500)));
  Index3 const extent{m, m, m};
  Mesh mesh;
  mesh.source = "bench_plan";
  std::vector<Index3> place;
  for (int k = 0; k < bricks; ++k)
    for (int j = 0; j < bricks; ++j)
      for (int i = 0; i < bricks; ++i)
        if (number[i][j][k] >= 0) {
          mesh.add_zone("brick " + std::to_string(number[i][j][k] + 1), extent);
          place.push_back({i, j, k});
        }
  mesh.coordinates = Coordinates(mesh.n_nodes());
  Orientation const same{};
  for (int z = 0; z < int(mesh.zones.size()); ++z) {
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        Index3 beyond = place[z];
        beyond[axis] += side == 0 ? -1 : 1;
        bool const outside = beyond[axis] < 0 || beyond[axis] >= bricks;
        int const donor = outside ? -1 : number[beyond[0]][beyond[1]][beyond[2]];
        if (donor < 0) {
          std::string const name = outside ? std::string(face_name(axis, side)) : "hole";
          mesh.patches.push_back(
              {name, "", outside ? PatchKind::farfield : PatchKind::wall, {name}, z, face(extent, axis, side)});
          continue;
        }
        // Each connection is stored from both sides, as most files do.
        Interface1to1 join;
        join.name = "join " + std::to_string(mesh.interfaces.size() + 1);
        join.zone = z;
        join.donor_zone = donor;
        join.range = face(extent, axis, side);
        join.to_donor = {same, join.range.begin, face(extent, axis, 1 - side).begin};
        mesh.interfaces.push_back(std::move(join));
      }
    Zone const& zone = mesh.zones[z];
    for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n) {
      auto const p = zone.index(n);
      // In steps of whole cells, so that nodes of neighbours agree to the bit.
      double const h = 1.0 / (bricks * (m - 1));
      double const x = h * (place[z][0] * (m - 1) + p[0]), y = h * (place[z][1] * (m - 1) + p[1]),
                   w = h * (place[z][2] * (m - 1) + p[2]);
      mesh.coordinates.set(n, {x + 0.01 * std::sin(5 * y), y + 0.01 * std::sin(4 * w), w + 0.01 * std::cos(3 * x)});
    }
  }
  return mesh;
}

void run(benchmark::State& state) {
  Mesh const original = make_bricks(state.range(0));
  Motion motion;
  motion.rules.push_back({{"hole"}, RigidRule{{}, {1e-3, 0, 0}}, 0, "bench"});
  PreparedMorph::Seconds sum;
  for (auto _ : state) {
    state.SetIterationTime(seconds(Kokkos::DefaultHostExecutionSpace(), [&] {
      PreparedMorph const prepared = prepare(original, motion, {});
      benchmark::DoNotOptimize(prepared.plan().n_nodes);
      sum.topology += prepared.seconds.topology;
      sum.rules += prepared.seconds.rules;
      sum.plan += prepared.seconds.plan;
    }));
  }
  auto const mean = benchmark::Counter::kAvgIterations;
  state.counters["blocks"] = double(original.zones.size());
  state.counters["topology"] = benchmark::Counter(sum.topology, mean);
  state.counters["rules"] = benchmark::Counter(sum.rules, mean);
  state.counters["plan"] = benchmark::Counter(sum.plan, mean);
  state.counters["nodes"] = double(original.n_nodes());
  state.counters["nodes/s"] =
      benchmark::Counter(double(original.n_nodes()), benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

void register_all() {
  benchmark::RegisterBenchmark("prepare", run)
      ->ArgName("nodes")
      ->Arg(smoke_nodes)
      ->Arg(cache_nodes)
      ->Arg(10'000'000)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace gridmorph::bench
