// A solver of several processes, each with some zones and a layer of ghost nodes around them, lets its mesh follow a
// moving wall.
//
//   mpirun -n 4 example_mpi_loop
//
// Twelve zones fill a duct; its floor is a panel that bends. Every process knows the list of zones and interfaces, and
// has the coordinates of its own zones alone. Process 0 gathers these once, plans, and hands out shares of the plan;
// from then on nothing is exchanged for the mesh: every process moves its nodes and its ghost nodes, on its own
// execution space. What the solver exchanges here shows that ghost nodes go to the bits of their originals.
#include <gridmorph/gridmorph.hpp>
#include <gridmorph/mpi/mpi_ranks.hpp>

#include <mpi.h>
#include <Kokkos_Core.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

namespace {

using gridmorph::Index;
using gridmorph::Index3;
using gridmorph::NodeBox;
using gridmorph::Vec3;
using Exec = Kokkos::DefaultExecutionSpace;
using Memory = Exec::memory_space;
using Vectors = Kokkos::View<double* [3], Kokkos::LayoutRight, Memory>;

constexpr Index3 extent{17, 17, 13};
constexpr int along = 4, upwards = 3, n_zones = along * upwards;

/// The number of a zone of the duct; -1: there is none.
int zone_at(int i, int k) { return i < 0 || i >= along || k < 0 || k >= upwards ? -1 : i + along * k; }

/// Zones, patches and interfaces of the duct, without coordinates: the same on all processes.
gridmorph::Mesh duct() {
  gridmorph::Mesh mesh;
  mesh.source = "duct";
  for (int z = 0; z < n_zones; ++z) mesh.add_zone("zone " + std::to_string(z + 1), extent);
  auto const patch = [&](int zone, char const* name, int axis, int side) {
    gridmorph::Patch p{name, "BCWall", gridmorph::PatchKind::wall, {}, zone, {{0, 0, 0}, extent}};
    p.range.begin[axis] = side == 0 ? 0 : extent[axis] - 1;
    p.range.end[axis] = p.range.begin[axis] + 1;
    mesh.patches.push_back(p);
  };
  auto const [ni, nj, nk] = extent;
  for (int k = 0; k < upwards; ++k)
    for (int i = 0; i < along; ++i) {
      int const zone = zone_at(i, k);
      for (int side = 0; side < 2; ++side) patch(zone, "sides", 1, side);
      if (i == 0) patch(zone, "ends", 0, 0);
      if (k == 0) patch(zone, "panel", 2, 0);
      if (i + 1 == along)
        patch(zone, "ends", 0, 1);
      else
        mesh.interfaces.push_back(gridmorph::interface_from_ranges(
            mesh, "along", zone, {{ni, 1, 1}, {ni, nj, nk}}, zone_at(i + 1, k), {{1, 1, 1}, {1, nj, nk}}, {1, 2, 3}));
      if (k + 1 == upwards)
        patch(zone, "roof", 2, 1);
      else
        mesh.interfaces.push_back(gridmorph::interface_from_ranges(
            mesh, "upwards", zone, {{1, 1, nk}, {ni, nj, nk}}, zone_at(i, k + 1), {{1, 1, 1}, {ni, nj, 1}}, {1, 2, 3}));
    }
  return mesh;
}

/// Where the solver has a node.
Vec3 position(int zone, Index3 const& p) {
  auto const part = [&](int axis) { return p[axis] / (extent[axis] - 1.0); };
  return {(zone % along + part(0)) / along, part(1), (zone / along + part(2)) / upwards};
}

template <class Visit>
void for_nodes(NodeBox const& box, Visit const& visit) {
  for (int k = box.nodes.begin[2]; k < box.nodes.end[2]; ++k)
    for (int j = box.nodes.begin[1]; j < box.nodes.end[1]; ++j)
      for (int i = box.nodes.begin[0]; i < box.nodes.end[0]; ++i) visit(Index3{i, j, k});
}

/// What a process has: its zones, then of each neighbour of another process the layer of nodes beyond the contact.
struct Own {
  std::vector<NodeBox> zones, ghosts;
  Index n_zone_nodes = 0;

  static int rank_of(int zone, int n_ranks) { return zone * n_ranks / n_zones; }

  Own(int rank, int n_ranks) {
    for (int z = 0; z < n_zones; ++z) {
      if (rank_of(z, n_ranks) != rank) continue;
      zones.push_back({z, {{0, 0, 0}, extent}});
      n_zone_nodes += zones.back().nodes.size();
      int const i = z % along, k = z / along;
      for (int axis : {0, 2})
        for (int side : {0, 1}) {
          int const step = side == 0 ? -1 : 1;
          int const beyond = axis == 0 ? zone_at(i + step, k) : zone_at(i, k + step);
          if (beyond < 0 || rank_of(beyond, n_ranks) == rank) continue;
          NodeBox layer{beyond, {{0, 0, 0}, extent}};
          layer.nodes.begin[axis] = side == 0 ? extent[axis] - 2 : 1;
          layer.nodes.end[axis] = layer.nodes.begin[axis] + 1;
          ghosts.push_back(layer);
        }
    }
  }
  [[nodiscard]] std::vector<NodeBox> boxes() const {
    std::vector<NodeBox> all = zones;
    all.insert(all.end(), ghosts.begin(), ghosts.end());
    return all;
  }
};

/// First bending shape of a panel that is held at its edges.
double panel_shape(Vec3 const& p) {
  double const a = std::sin(std::numbers::pi * p.x) * std::sin(std::numbers::pi * p.y);
  return a * a;
}

/// Ghost nodes that are not, to the bit, where their owners have them: the solver's halo exchange of coordinates, which
/// need not be made.
long long strange_ghosts(MPI_Comm comm, Own const& own, Vectors const& x) {
  int rank = 0, n_ranks = 1;
  MPI_Comm_rank(comm, &rank);
  MPI_Comm_size(comm, &n_ranks);
  auto const host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), x);
  std::vector<std::vector<double>> out;
  std::vector<MPI_Request> requests;
  // Everybody's ghosts in turn: those that ask for nodes of zones here are answered. Tags tell the layers apart.
  auto const tag = [](NodeBox const& ghost) {
    int const axis = ghost.nodes.extent(0) == 1 ? 0 : 2;
    return 4 * ghost.zone + 2 * (axis / 2) + (ghost.nodes.begin[axis] == 1 ? 0 : 1);
  };
  for (int other = 0; other < n_ranks; ++other)
    for (NodeBox const& ghost : Own(other, n_ranks).ghosts) {
      if (Own::rank_of(ghost.zone, n_ranks) != rank) continue;
      auto const zone =
          std::find_if(own.zones.begin(), own.zones.end(), [&](auto const& z) { return z.zone == ghost.zone; });
      Index const first = (zone - own.zones.begin()) * zone->nodes.size();
      out.emplace_back();
      for_nodes(ghost, [&](Index3 const& p) {
        Index const n = first + p[0] + extent[0] * (p[1] + Index(extent[1]) * p[2]);
        for (int c = 0; c < 3; ++c) out.back().push_back(host(n, c));
      });
      requests.emplace_back();
      MPI_Isend(out.back().data(), int(out.back().size()), MPI_DOUBLE, other, tag(ghost), comm, &requests.back());
    }
  long long strange = 0;
  Index n = own.n_zone_nodes;
  for (NodeBox const& ghost : own.ghosts) {
    std::vector<double> theirs(std::size_t(3 * ghost.nodes.size()));
    MPI_Recv(theirs.data(), int(theirs.size()), MPI_DOUBLE, Own::rank_of(ghost.zone, n_ranks), tag(ghost), comm,
             MPI_STATUS_IGNORE);
    for (std::size_t k = 0; k < theirs.size(); k += 3, ++n)
      strange += host(n, 0) == theirs[k] && host(n, 1) == theirs[k + 1] && host(n, 2) == theirs[k + 2] ? 0 : 1;
  }
  MPI_Waitall(int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  MPI_Allreduce(MPI_IN_PLACE, &strange, 1, MPI_LONG_LONG, MPI_SUM, comm);
  return strange;
}

/// Moves the panel up and down; 0 where all went as it should.
int run(MPI_Comm comm) {
  Exec const exec;  // the solver's own instance
  auto const ranks = gridmorph::mpi_ranks(comm);
  Own const own(ranks->rank(), ranks->size());
  std::vector<NodeBox> const boxes = own.boxes();

  // The solver's coordinates: of its zones, then of its ghost layers.
  Index n_nodes = 0;
  for (NodeBox const& box : boxes) n_nodes += box.nodes.size();
  Vectors const x("coordinates", n_nodes), now("moved coordinates", n_nodes);
  auto const host = Kokkos::create_mirror_view(x);
  gridmorph::Coordinates mine(own.n_zone_nodes);
  Index n = 0;
  for (NodeBox const& box : boxes)
    for_nodes(box, [&](Index3 const& p) {
      Vec3 const at = position(box.zone, p);
      if (n < mine.size()) mine.set(n, at);
      host(n, 0) = at.x, host(n, 1) = at.y, host(n, 2) = at.z;
      ++n;
    });
  Kokkos::deep_copy(x, host);

  // Once: process 0 plans for all.
  gridmorph::Mesh mesh = duct();
  mesh.coordinates = gridmorph::gather_coordinates(ranks, mesh, own.zones, mine);
  std::optional<gridmorph::MorphPlan> plan;
  gridmorph::together(*ranks, [&] {
    if (ranks->rank() != 0) return;
    gridmorph::FunctionRule const bends{"bending panel", [](std::span<Vec3 const> points, std::span<Vec3> u) {
                                          for (std::size_t k = 0; k < points.size(); ++k)
                                            u[k] = {0, 0, panel_shape(points[k])};
                                        }};
    gridmorph::Motion motion;
    motion.rules.push_back({{"panel"}, bends, 0, "mpi_loop"});
    plan.emplace(mesh, motion);
  });
  gridmorph::PlanShare const share =
      gridmorph::share_out(*ranks, {}, plan ? &*plan : nullptr, plan ? &mesh : nullptr, boxes);
  plan.reset();
  mesh.coordinates = {};
  gridmorph::Morpher<Exec> const morpher(exec, share, x);

  gridmorph::Mesh zones_here;  // for the check of cells
  for (NodeBox const& box : own.zones) zones_here.add_zone(mesh.zones[box.zone].name, extent);
  zones_here.coordinates = mine;
  std::optional<gridmorph::ValidityCheck<Exec>> validity;
  if (!own.zones.empty()) validity.emplace(exec, zones_here);
  auto const cells_of = Kokkos::subview(now, std::pair<Index, Index>(0, own.n_zone_nodes), Kokkos::ALL);

  // Every step: displacement of all boundary nodes in, positions of own nodes and ghosts out.
  std::vector<Vec3> const& shape = share.boundary_displacement();
  auto const mode = Kokkos::create_mirror_view_and_copy(
      Memory(), Kokkos::View<Vec3 const*, Kokkos::HostSpace>(shape.data(), shape.size()));
  Vectors const boundary("boundary displacement", shape.size());
  int wrong = 0;
  for (int step = 0; step <= 8; ++step) {
    double const amplitude = 0.15 * std::sin(2 * std::numbers::pi * step / 8);
    Kokkos::parallel_for(
        "deflect", Kokkos::RangePolicy<Exec>(exec, 0, Index(mode.extent(0))), KOKKOS_LAMBDA(Index k) {
          boundary(k, 0) = amplitude * mode(k).x;
          boundary(k, 1) = amplitude * mode(k).y;
          boundary(k, 2) = amplitude * mode(k).z;
        });
    morpher.positions(exec, boundary, now);
    double smallest = 1e300;
    if (validity) {
      auto const found = (*validity)(exec, cells_of);
      exec.fence();
      smallest = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), found)().smallest_determinant;
    }
    exec.fence();
    MPI_Allreduce(MPI_IN_PLACE, &smallest, 1, MPI_DOUBLE, MPI_MIN, comm);
    long long const strange = strange_ghosts(comm, own, now);
    wrong += strange != 0 || !(smallest > 0) ? 1 : 0;
    if (ranks->rank() == 0)
      std::printf("step %d: panel by %+.3f, smallest determinant %.3f, ghost nodes that differ: %lld\n", step,
                  amplitude, smallest, strange);
  }
  return wrong == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int status = 1;
  {
    Kokkos::ScopeGuard const kokkos(argc, argv);
    status = run(MPI_COMM_WORLD);
  }
  MPI_Finalize();
  return status;
}
