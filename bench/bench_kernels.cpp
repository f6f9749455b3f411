// Every kernel of the engine by itself, on cubes whose plans are known beforehand. Bytes are those that must move at
// least; end values, side tables and plan tables stay in cache and do not count.
//
//   line_parameters/<axis>                  arc-length fractions of all nodes along one axis    32 bytes per node
//   volume/<axis>/<law>/<known sides>       the pass over the volume, in place        48 bytes, 8 per line parameter
//   volume/<axis>/near_field                the same under the constant law           48 bytes
//   volume/<axis>/near_field_turns          and turned about the wall                 48 bytes, 8 per line parameter
//   volume/<axis>/<law>/slip_sides          with a finalize pass: two terms           48 bytes, 8 per line parameter
//   skeleton_sweep                          faces that chains make known              32 bytes
//   node_copy                               skeleton -> nodes, in place               72 bytes
//   side_residual                           gather, residuals and borders of sides   152 bytes
//   slip_ends/<surface>                     end values of a finalize pass            sizes of its tables, 48 bytes
//   apply                                   all of it through the Morpher             as the volume pass
//
// Axes are those of memory: i lines run along it. ".../many_apart" and ".../many_joined" are 512 cubes (8 in the
// smallest size), each a block of its own or all one block. Nodes are those that the kernel writes.
#include "bench.hpp"
#include "cubes.hpp"
#include "last_made.hpp"
#include "node_arrays.hpp"
#include "planned_kernels.hpp"
#include "roof.hpp"

#include <string>

#include <unistd.h>

namespace gridmorph::bench {
namespace {

template <class ExecutionSpace>
void run(ExecutionSpace const& exec, benchmark::State& state, Timed const& timed) {
  double const mean = time_iterations(state, exec, timed.launch);
  set_shares(state, exec, mean, timed.nodes, timed.bytes_per_node);
}

Mesh const& cubes(Cubes const& which) {
  static LastMade<Cubes, Mesh> last;
  return last.get(which, [&] { return make_cubes(which); });
}

/// A kernel on cubes, planned for a case.
template <class Work>
struct OnCubes {
  CubeCase what;
  bool many = false, joined = false;

  template <class Exec>
  void operator()(Exec const& exec, benchmark::State& state) const {
    int const edge = int(std::lround(std::cbrt(double(state.range(0)))));
    int const per_axis = !many ? 1 : state.range(0) == smoke_nodes ? 2 : 8;
    Mesh const& mesh = cubes({edge / per_axis, per_axis, joined});
    PreparedMorph const prepared = prepare_case(mesh, what);
    NodeArrays<typename Exec::memory_space> const x(mesh.coordinates);
    run(exec, state, Work()(exec, prepared, x));
    state.counters["blocks"] = double(mesh.zones.size());
  }
};

// -------------------------------------------------------------------------------------- kernels with tables of their
// own

/// One cube as one chain along an axis; every node wants its parameter.
struct LineParameters {
  int axis;

  template <class Exec>
  void operator()(Exec const& exec, benchmark::State& state) const {
    using Memory = typename Exec::memory_space;
    using Kernel = kernels::LineParameters<Memory, kernels::TileShape<Exec>::lines>;
    int const n = int(std::lround(std::cbrt(double(state.range(0)))));
    Mesh const& mesh = cubes({n, 1, false});
    Index const stride[3] = {1, n, Index(n) * n};
    int const a = axis == 0 ? 1 : 0, b = 3 - axis - a;
    kernels::Chain const chain{n, n, n, kernels::LineLaw::linear, 0, -1, 0, 1, 0, 0, 0};
    kernels::Segment const segment{0, stride[axis], stride[a], stride[b], n, 0, {}};  // all to target 0
    kernels::ParameterTarget const target{0, stride[axis], stride[a], stride[b]};
    detail::WorkList<kernels::Tube, Memory> const tubes(exec, {{0, 0, 0, n, n, 0, 1}}, Kernel::items, "tubes");
    NodeArrays<Memory> const x(mesh.coordinates);
    Kokkos::View<double*, Memory> const t("gridmorph::bench::t", mesh.n_nodes());
    Kernel const kernel{{detail::table(exec, std::vector{chain}, "chains"), tubes.entries,
                         detail::table(exec, std::vector{segment}, "segments")},
                        detail::table(exec, std::vector{target}, "targets"),
                        tubes.first_item,
                        x.read(),
                        t.data()};
    compat::fence(exec, "gridmorph::bench (host tables may go)");
    run(exec, state,
        {[&] { kernels::launch("gridmorph::bench::line_parameters", exec, 0, tubes.n_items, kernel); }, mesh.n_nodes(),
         32});
  }
};

/// Nodes all over a sector of a surface of revolution (as a profile or as facets), or of a plane, that would leave it
/// by a little.
struct SlipEnds {
  SlipKind kind;

  template <class Exec>
  void operator()(Exec const& exec, benchmark::State& state) const {
    using Memory = typename Exec::memory_space;
    Index const n = state.range(0);
    SlipSurface surface{kind, {0, 0, 0}, kind == SlipKind::plane ? Vec3{0, 0, 1} : Vec3{1, 0, 0}, {}, 0, 1};
    auto const radius = [](double axial) { return 1 + 0.1 * std::sin(3 * axial); };
    if (kind == SlipKind::revolution) {
      std::vector<std::pair<double, double>> points;
      for (int m = 0; m <= 2000; ++m) points.emplace_back(m / 2000.0, radius(m / 2000.0));
      surface.profile = RevolutionProfile::from_points(points);
    }
    Index const row = std::max<Index>(1, Index(std::sqrt(double(n))));
    if (kind == SlipKind::facets) {
      // As many facets as nodes, as on a patch of the mesh, and a few more all round.
      FacetList list;
      int const side = int(row) + 3;
      for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
          double const axial = (i - 1) / double(row), theta = 0.5 * (j - 1) / double(row);
          list.points.push_back({axial, radius(axial) * std::cos(theta), radius(axial) * std::sin(theta)});
        }
      for (int j = 0; j + 1 < side; ++j)
        for (int i = 0; i + 1 < side; ++i) {
          int const at = i + side * j;
          list.facets.push_back({at, at + 1, at + 1 + side, at + side});
        }
      surface.facets = FacetSurface::from_facets(list);
    }
    SlipSurfaceTable<Memory> const surfaces(exec, {surface});
    std::vector<kernels::SlipEnd> ends;
    std::vector<kernels::SlipEndBaseline> baselines;
    for (Index m = 0; m < n; ++m) {
      double const axial = double(m % row) / double(row), theta = 0.5 * double(m / row) / double(row);
      Vec3 const p{axial, radius(axial) * std::cos(theta), radius(axial) * std::sin(theta)};
      ends.push_back({m, m, m, -1, -1, {0, -1, -1}, 0});
      baselines.push_back({kind == SlipKind::plane ? Vec3{p.x, p.y, 0} : p, {}});
    }
    detail::Workspace<Memory> const u(exec, n, 1, "u"), values(exec, n, 1, "values");
    Kokkos::deep_copy(exec, u.values, 1e-3);
    kernels::SlipEndValues<Memory, false> const kernel{detail::table(exec, ends, "slip_ends"),
                                                       detail::table(exec, baselines, "baselines"),
                                                       surfaces.surfaces,
                                                       {},
                                                       u.read().first,
                                                       {},
                                                       values.batch().first};
    compat::fence(exec, "gridmorph::bench (host tables may go)");
    run(exec, state,
        {[&] { kernels::launch("gridmorph::bench::slip_ends", exec, 0, n, kernel); }, n,
         48 + double(sizeof(kernels::SlipEnd) + sizeof(kernels::SlipEndBaseline))});
  }
};

// ----------------------------------------------------------------------------------------------------------- names

std::string axis_name(int axis) { return std::string(1, "ijk"[axis]); }

template <class Work>
void add(std::string const& kernel, CubeCase const& c, std::int64_t nodes) {
  std::string name = "kernels/" + kernel + "/" + axis_name(c.axis);
  if (c.known < KnownSides::near_field) name += c.law == Law::c1 ? "/c1" : "/linear";
  register_benchmark(name + "/" + known_names[int(c.known)], OnCubes<Work>{c}, {nodes});
}

template <class Work>
void add_many(std::string const& kernel, CubeCase const& c, std::int64_t nodes) {
  for (bool const joined : {false, true})
    register_benchmark("kernels/" + kernel + "/" + axis_name(c.axis) + "/linear/" + known_names[int(c.known)] +
                           (joined ? "/many_joined" : "/many_apart"),
                       OnCubes<Work>{c, true, joined}, {nodes});
}

void register_one_cube(std::int64_t nodes) {
  for (int axis = 0; axis < 3; ++axis)
    register_benchmark("kernels/line_parameters/" + axis_name(axis), LineParameters{axis}, {nodes});
  for (int axis = 0; axis < 3; ++axis) {
    for (Law const law : {Law::linear, Law::c1})
      for (KnownSides const known : {KnownSides::no_side, KnownSides::two_sides, KnownSides::four_sides})
        add<Volume>("volume", {axis, law, known}, nodes);
    add<Volume>("volume", {axis, Law::linear, KnownSides::slip_sides}, nodes);
    for (KnownSides const known : {KnownSides::near_field, KnownSides::near_field_turns})
      add<Volume>("volume", {axis, Law::linear, known}, nodes);
  }
  add<Apply>("apply", {2, Law::linear, KnownSides::no_side}, nodes);
  add<Apply>("apply", {2, Law::linear, KnownSides::four_sides}, nodes);
  add<SkeletonSweep>("skeleton_sweep", {2, Law::linear, KnownSides::no_side}, nodes);
  add<NodeCopies>("node_copy", {2, Law::linear, KnownSides::no_side}, nodes);
  add<SideResiduals>("side_residual", {2, Law::linear, KnownSides::four_sides}, nodes);
}

void register_many_cubes(std::int64_t nodes) {
  for (int axis = 0; axis < 3; ++axis) {
    add_many<Volume>("volume", {axis, Law::linear, KnownSides::four_sides}, nodes);
    add_many<Apply>("apply", {axis, Law::linear, KnownSides::four_sides}, nodes);
  }
  add_many<NodeCopies>("node_copy", {2, Law::linear, KnownSides::four_sides}, nodes);
}

std::int64_t cube(std::int64_t edge) { return edge * edge * edge; }

bool has_memory(double gibibytes) {
  return double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGE_SIZE)) > gibibytes * (1 << 30);
}

}  // namespace

void register_all() {
  for (std::int64_t const nodes : {smoke_nodes, cube(9), cube(33), cube(65), cube(129), cube(257)})
    register_one_cube(nodes);
  if (has_memory(16)) register_one_cube(cube(513));  // takes about 11
  for (std::int64_t const nodes : {smoke_nodes, cube(8 * 9), cube(8 * 17), cube(8 * 33)}) register_many_cubes(nodes);
  for (auto const& [kind, name] : {std::pair{SlipKind::plane, "plane"}, std::pair{SlipKind::revolution, "revolution"},
                                   std::pair{SlipKind::facets, "baseline"}})
    register_benchmark(std::string("kernels/slip_ends/") + name, SlipEnds{kind}, {smoke_nodes, cache_nodes, 1'000'000});
}

}  // namespace gridmorph::bench
