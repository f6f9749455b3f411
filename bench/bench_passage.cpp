// The whole workflow of the paper's turbomachinery example (its Figure 11) on the demo passage.
//
//   workflow    line parameters and one morph in place: what a program that morphs once pays
//   plan_made   the Morpher alone: tables, workspace, line parameters           32 bytes per line parameter
//   apply       a kept plan in place                              48 bytes per node, 8 per line parameter
//   apply_to    the same into other arrays                        48 bytes per node, 8 per line parameter
//   displace    displacements only                                24 bytes per node, 8 per line parameter
//   displace_4  four displacement fields at once                  96 bytes per node, 8 per line parameter
//
// Bytes are those that must move at least; "share" compares with an in-place update, so stores that first read the line
// they write (apply_to, displace) count as what they are: slower.
#include "bench.hpp"
#include "last_made.hpp"
#include "node_arrays.hpp"
#include "roof.hpp"

#include <generators/passage.hpp>
#include <generators/passage_motion.hpp>
#include <gridmorph/morph/morpher.hpp>
#include <gridmorph/plan/prepare.hpp>

namespace gridmorph::bench {
namespace {

struct Passage {
  PassageOptions options;
  Mesh mesh;
  PreparedMorph prepared;
  std::vector<Vec3> boundary;
  Index n_parameters = 0;

  explicit Passage(std::int64_t nodes)
      : options(of_size(nodes)),
        mesh(make_passage(options)),
        prepared(plan(options, mesh)),
        boundary(prepared.boundary_displacement()) {
    for (Stage const& stage : prepared.plan().stages) n_parameters += stage.lines.n_parameters;
    for (SpreadPass const& pass : prepared.plan().spreads) n_parameters += pass.lines.n_parameters;
  }
  static PassageOptions of_size(std::int64_t nodes) {
    PassageOptions options;
    options.nodes = std::max<std::int64_t>(nodes, 10'000);
    return options;
  }
  static PreparedMorph plan(PassageOptions const& options, Mesh const& mesh) {
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
    plan.boundary_layers = {{{"blade"}, BoundaryLayer::Extent::block, 0, 0, BoundaryLayer::Mode::translate}};
    return prepare(mesh, motion, plan);
  }
  [[nodiscard]] double parameters_per_node() const { return double(n_parameters) / double(mesh.n_nodes()); }
};

/// One passage at a time: the large ones take gigabytes.
Passage const& passage(std::int64_t nodes) {
  static LastMade<std::int64_t, Passage> last;
  return last.get(nodes, [&] { return Passage(nodes); });
}

template <class ExecutionSpace>
struct OnDevice : NodeArrays<typename ExecutionSpace::memory_space> {
  Kokkos::View<Vec3*, typename ExecutionSpace::memory_space> boundary;

  OnDevice(ExecutionSpace const& exec, Passage const& p)
      : NodeArrays<typename ExecutionSpace::memory_space>(p.mesh.coordinates),
        boundary("gridmorph::bench::boundary", p.boundary.size()) {
    Kokkos::View<Vec3 const*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>> const host(p.boundary.data(),
                                                                                                     p.boundary.size());
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

  template <class ExecutionSpace>
  void operator()(ExecutionSpace const& exec, benchmark::State& state) const {
    Passage const& p = passage(state.range(0));
    OnDevice<ExecutionSpace> const mesh(exec, p);
    auto const step = work(exec, p, mesh);
    double const mean = time_iterations(state, exec, step);
    set_shares(state, exec, mean, p.mesh.n_nodes(), fixed_bytes + bytes_per_parameter * p.parameters_per_node());
  }
};

template <class Work>
void add(std::string const& name, double fixed_bytes, double bytes_per_parameter, Work const& work) {
  register_benchmark("passage/" + name, OnPassage<Work>{work, fixed_bytes, bytes_per_parameter}, passage_sizes);
}

}  // namespace

void register_all() {
  add("workflow", 48, 40, [](auto const& exec, Passage const& p, auto const& mesh) {
    using Exec = std::decay_t<decltype(exec)>;
    return [&, mesh] {
      Morpher<Exec> const morpher(exec, p.prepared.plan(), mesh);
      morpher.positions(exec, mesh.boundary, mesh);
    };
  });
  add("plan_made", 0, 32, [](auto const& exec, Passage const& p, auto const& mesh) {
    using Exec = std::decay_t<decltype(exec)>;
    return [&, mesh] { Morpher<Exec> const morpher(exec, p.prepared.plan(), mesh); };
  });
  add("apply", 48, 8, [](auto const& exec, Passage const& p, auto const& mesh) {
    using Exec = std::decay_t<decltype(exec)>;
    Morpher<Exec> const morpher(exec, p.prepared.plan(), mesh);
    return [&, mesh, morpher] { morpher.positions(exec, mesh.boundary, mesh); };
  });
  add("apply_to", 48, 8, [](auto const& exec, Passage const& p, auto const& mesh) {
    using Exec = std::decay_t<decltype(exec)>;
    Morpher<Exec> const morpher(exec, p.prepared.plan(), mesh);
    std::decay_t<decltype(mesh)> const to(exec, p);
    return [&, mesh, morpher, to] { morpher.positions(exec, mesh.boundary, to); };
  });
  add("displace", 24, 8, [](auto const& exec, Passage const& p, auto const& mesh) {
    using Exec = std::decay_t<decltype(exec)>;
    Morpher<Exec> const morpher(exec, p.prepared.plan(), mesh);
    return [&, mesh, morpher] { morpher.displacements(exec, mesh.boundary, mesh); };
  });
  add("displace_4", 96, 8, [](auto const& exec, Passage const& p, auto const& mesh) {
    using Exec = std::decay_t<decltype(exec)>;
    using Memory = typename Exec::memory_space;
    Morpher<Exec> const morpher(exec, p.prepared.plan(), mesh, {4});
    Index const n = p.mesh.n_nodes();
    Kokkos::View<double* [4][3], Kokkos::LayoutLeft, Memory> const fields("gridmorph::bench::fields", n);
    std::vector<typename Morpher<Exec>::In> const boundary(4, mesh.boundary);
    std::vector<typename Morpher<Exec>::Out> u;
    for (int f = 0; f < 4; ++f) u.emplace_back(Kokkos::subview(fields, Kokkos::ALL, f, Kokkos::ALL));
    return [&, mesh, morpher, fields, boundary, u] { morpher.displacements(exec, boundary, u); };
  });
}

}  // namespace gridmorph::bench
