// The whole workflow of the paper's turbomachinery example (its Figure 11) on the demo passage.
//
//   workflow    line parameters and one morph in place: what a program that morphs once pays
//   plan_made   the Morpher alone: tables, workspace, line parameters           32 bytes per line parameter
//   apply       a kept plan in place                              48 bytes per node, 8 per line parameter
//   apply_to    the same into other arrays                        48 bytes per node, 8 per line parameter
//   displace    displacements only                                24 bytes per node, 8 per line parameter
//   displace_4  four displacement fields at once                  96 bytes per node, 8 per line parameter
//   rotate      apply with a near field that turns with the blade   48 bytes per node, 8 per line parameter
//   rotate_to_the_end  its turn handed on to all chains from it      the same
//   apply_share_4, apply_share_16  apply of one process of so many, that with the most nodes (docs/mpi.md); "swept":
//               nodes of the skeleton that all of them sweep, over those of one process alone
//   transpose   gradients of nodes handed back to the boundary       24 bytes per node, 8 per line parameter
//   transpose_rotate, transpose_rotate_to_the_end: of rotate and rotate_to_the_end
//
// Bytes are those that must move at least; "share" compares with an in-place update, so stores that first read the line
// they write (apply_to, displace) count as what they are: slower.
#include "bench.hpp"
#include "last_made.hpp"
#include "node_arrays.hpp"
#include "roof.hpp"

#include <generators/passage.hpp>
#include <generators/passage_motion.hpp>
#include <gridmorph/boundary/range_nodes.hpp>
#include <gridmorph/mesh/deal_zones.hpp>
#include <gridmorph/morph/morpher_access.hpp>
#include <gridmorph/plan/prepare.hpp>
#include <gridmorph/plan/share.hpp>

#include <optional>
#include <utility>

namespace gridmorph::bench {
namespace {

/// How much of the blade's turn the mesh around it takes: `turn` of the volume, or none at all.
struct Turned {
  std::int64_t nodes;
  std::optional<double> turn;
  [[nodiscard]] auto operator<=>(Turned const&) const = default;
};

Index line_parameters_of(Plan const& plan) {
  Index n = 0;
  for (Stage const& stage : plan.stages) n += stage.lines.n_parameters;
  for (SpreadPass const& pass : plan.spreads) n += pass.lines.n_parameters;
  return n;
}

struct Passage {
  PassageOptions options;
  Mesh mesh;
  PreparedMorph prepared;
  std::vector<Vec3> boundary;
  Index n_parameters = 0;

  explicit Passage(Turned const& which)
      : options(of_size(which.nodes)),
        mesh(make_passage(options)),
        prepared(plan(options, mesh, which.turn)),
        boundary(prepared.boundary_displacement()),
        n_parameters(line_parameters_of(prepared.plan())) {}
  static PassageOptions of_size(std::int64_t nodes) {
    PassageOptions options;
    options.nodes = std::max<std::int64_t>(nodes, 10'000);
    return options;
  }
  static PreparedMorph plan(PassageOptions const& options, Mesh const& mesh, std::optional<double> turn) {
    PassageMotion const section = rotated_sections();
    Motion motion;
    motion.axis = {{0, 0, 0}, {1, 0, 0}};
    FunctionRule const blade{"rotated sections", [=](std::span<Vec3 const> points, std::span<Vec3> u) {
                               for (std::size_t n = 0; n < points.size(); ++n)
                                 u[n] = passage_displacement(options, section, points[n]);
                             }};
    motion.rules = {{{"blade"}, blade, 0, "blade"},
                    {{"inlet", "outlet"}, CircumferentialSlideRule{{"blade"}}, 0, "slide"},
                    {{"type:periodic"}, FollowRule{{"blade"}}, 0, "follow"},
                    {{"hub", "case"}, SlipRule{SlipRule::Surface::revolution}, 0, "slip"}};
    PlanOptions plan;
    auto const mode = turn ? BoundaryLayer::Mode::rotate : BoundaryLayer::Mode::translate;
    plan.boundary_layers = {{{"blade"}, BoundaryLayer::Extent::block, 0, 0, mode}};
    plan.volume.turn = turn;
    return prepare(mesh, motion, plan);
  }
  [[nodiscard]] double parameters_per_node() const { return double(n_parameters) / double(mesh.n_nodes()); }
};

/// One passage at a time: the large ones take gigabytes.
Passage const& passage(Turned const& which) {
  static LastMade<Turned, Passage> last;
  return last.get(which, [&] { return Passage(which); });
}

template <class ExecutionSpace>
struct OnDevice : NodeArrays<typename ExecutionSpace::memory_space> {
  Kokkos::View<Vec3*, typename ExecutionSpace::memory_space> boundary;

  OnDevice(ExecutionSpace const& exec, Passage const& p) : OnDevice(exec, p.mesh.coordinates, p.boundary) {}
  OnDevice(ExecutionSpace const& exec, Coordinates const& x, std::vector<Vec3> const& given)
      : NodeArrays<typename ExecutionSpace::memory_space>(x), boundary("gridmorph::bench::boundary", given.size()) {
    Kokkos::View<Vec3 const*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>> const host(given.data(),
                                                                                                     given.size());
    Kokkos::deep_copy(boundary, host);
    compat::fence(exec, "gridmorph::bench (passage is ready)");
  }
};

/// Calls work(passage, its arrays) for every iteration. In place means that a mesh drifts from iteration to iteration;
/// the line parameters, and so the work, stay those of the baseline.
template <class Work>
struct OnPassage {
  Work work;
  double fixed_bytes;  ///< per node
  double bytes_per_parameter;
  std::optional<double> turn;

  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    Passage const& p = passage({state.range(0), turn});
    OnDevice<ExecutionSpace> const mesh(exec, p);
    auto const step = work(exec, p, mesh);
    double const mean = time_iterations(state, exec, step);
    set_shares(state, exec, mean, p.mesh.n_nodes(), fixed_bytes + bytes_per_parameter * p.parameters_per_node());
  }
};

Index nodes_swept(Plan const& plan) {
  Index n = 0;
  for (Stage const& stage : plan.stages)
    for (kernels::SkeletonSweep const& sweep : stage.sweeps) n += Index(sweep.n_p) * sweep.n_q;
  for (SpreadPass const& pass : plan.spreads)
    for (kernels::SkeletonSweep const& sweep : pass.sweeps) n += Index(sweep.n_p) * sweep.n_q;
  return n;
}

/// What the process of several that has most nodes does for its apply.
struct ApplyOfShare {
  int processes;

  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    Passage const& p = passage({state.range(0), 0.0});
    Plan largest;
    std::vector<NodeBox> own;
    Index swept = 0;
    for (auto const& boxes : deal_zones(p.mesh, processes)) {
      Plan share = share_of(host_instance(exec), p.prepared.plan(), p.mesh, boxes);
      swept += nodes_swept(share);
      if (share.n_nodes <= largest.n_nodes) continue;
      largest = std::move(share);
      own = boxes;
    }
    Coordinates x(largest.n_nodes);
    Index n = 0;
    for (auto const& [zone, nodes] : own)
      for_each_node(p.mesh.zones[zone], nodes, [&](Index node) { x.set(n++, p.mesh.coordinates[node]); });
    OnDevice<ExecutionSpace> const mesh(exec, x, p.boundary);
    auto const morpher = MorpherAccess::of(exec, largest, mesh);
    double const mean = time_iterations(state, exec, [&] { morpher.positions(exec, mesh.boundary, mesh); });
    set_shares(state, exec, mean, n, 48 + 8 * double(line_parameters_of(largest)) / double(n));
    state.counters["swept"] = double(swept) / double(nodes_swept(p.prepared.plan()));
  }
};

template <class Work>
void add(std::string const& name, double fixed_bytes, double bytes_per_parameter, Work const& work,
         std::optional<double> turn = {}) {
  register_benchmark("passage/" + name, OnPassage<Work>{work, fixed_bytes, bytes_per_parameter, turn}, passage_sizes);
}

}  // namespace

void register_all() {
  add("workflow", 48, 40, [](auto const& exec, Passage const& p, auto const& mesh) {
    return [&, mesh] {
      auto const morpher = MorpherAccess::of(exec, p.prepared.plan(), mesh);
      morpher.positions(exec, mesh.boundary, mesh);
    };
  });
  add("plan_made", 0, 32, [](auto const& exec, Passage const& p, auto const& mesh) {
    return [&, mesh] { auto const morpher = MorpherAccess::of(exec, p.prepared.plan(), mesh); };
  });
  auto const apply = [](auto const& exec, Passage const& p, auto const& mesh) {
    auto const morpher = MorpherAccess::of(exec, p.prepared.plan(), mesh);
    return [&, mesh, morpher] { morpher.positions(exec, mesh.boundary, mesh); };
  };
  add("apply", 48, 8, apply);
  add("rotate", 48, 8, apply, 0.0);
  add("rotate_to_the_end", 48, 8, apply, 0.25);
  for (int const processes : {4, 16})
    register_benchmark("passage/apply_share_" + std::to_string(processes), ApplyOfShare{processes}, passage_sizes);
  auto const transpose = [](auto const& exec, Passage const& p, auto const& mesh) {
    using Exec = std::decay_t<decltype(exec)>;
    auto const morpher = MorpherAccess::of(exec, p.prepared.plan(), mesh, {.transpose = true});
    auto const out = Kokkos::create_mirror(typename Exec::memory_space(), mesh.boundary);
    return [&, mesh, morpher, out] { morpher.transpose(exec, mesh.boundary, mesh, out); };
  };
  add("transpose", 24, 8, transpose);
  add("transpose_rotate", 24, 8, transpose, 0.0);
  add("transpose_rotate_to_the_end", 24, 8, transpose, 0.25);
  add("apply_to", 48, 8, [](auto const& exec, Passage const& p, auto const& mesh) {
    auto const morpher = MorpherAccess::of(exec, p.prepared.plan(), mesh);
    std::decay_t<decltype(mesh)> const to(exec, p);
    return [&, mesh, morpher, to] { morpher.positions(exec, mesh.boundary, to); };
  });
  add("displace", 24, 8, [](auto const& exec, Passage const& p, auto const& mesh) {
    auto const morpher = MorpherAccess::of(exec, p.prepared.plan(), mesh);
    return [&, mesh, morpher] { morpher.displacements(exec, mesh.boundary, mesh); };
  });
  add("displace_4", 96, 8, [](auto const& exec, Passage const& p, auto const& mesh) {
    using Exec = std::decay_t<decltype(exec)>;
    using Memory = typename Exec::memory_space;
    auto const morpher = MorpherAccess::of(exec, p.prepared.plan(), mesh, {4});
    Index const n = p.mesh.n_nodes();
    Kokkos::View<double* [4][3], Kokkos::LayoutLeft, Memory> const fields("gridmorph::bench::fields", n);
    std::vector<typename Morpher<Exec>::In> const boundary(4, mesh.boundary);
    std::vector<typename Morpher<Exec>::Out> u;
    for (int f = 0; f < 4; ++f) u.emplace_back(Kokkos::subview(fields, Kokkos::ALL, f, Kokkos::ALL));
    return [&, mesh, morpher, fields, boundary, u] { morpher.displacements(exec, boundary, u); };
  });
}

}  // namespace gridmorph::bench
