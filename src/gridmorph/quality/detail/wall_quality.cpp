#include <gridmorph/core/error.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/kernels/wall_quality.hpp>
#include <gridmorph/quality/detail/wall_quality.hpp>
#include <gridmorph/quality/detail/wall_sums.hpp>
#include <gridmorph/quality/detail/zone_cells.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace gridmorph::detail {

namespace {

/// A wall patch range as the kernel sees it: nodes first + p * stride[0] + q * stride[1], 0 <= p, q < extent.
struct WallGrid {
  Index first;
  Index extent[2];
  Index stride[2];
  Index inward;  ///< from a wall node to the next node on its line
  Index begin;   ///< number of its first node among those of all walls

  KOKKOS_INLINE_FUNCTION Index size() const { return extent[0] * extent[1]; }
  [[nodiscard]] Index node(Index m) const { return first + m % extent[0] * stride[0] + m / extent[0] * stride[1]; }
};

/// Entry of the wall that node `m` of all walls belongs to.
template <class Walls>
KOKKOS_INLINE_FUNCTION Index wall_of(Walls const& walls, Index m) {
  Index low = 0, high = Index(walls.extent(0)) - 1;
  while (low < high) {
    Index const middle = (low + high + 1) / 2;
    if (walls(middle).begin <= m)
      low = middle;
    else
      high = middle - 1;
  }
  return low;
}

WallGrid wall_grid(Mesh const& mesh, WallFace const& wall) {
  if (wall.zone < 0 || wall.zone >= int(mesh.zones.size()))
    throw MeshError("wall quality: there is no zone number " + std::to_string(wall.zone));
  Zone const& zone = mesh.zones[wall.zone];
  bool valid = wall.axis >= 0 && wall.axis < 3 && (wall.side == 0 || wall.side == 1);
  for (int a = 0; a < 3 && valid; ++a)
    valid = wall.range.begin[a] >= 0 && wall.range.end[a] <= zone.extent[a] && wall.range.extent(a) > 0;
  valid = valid && wall.range.extent(wall.axis) == 1 &&
          wall.range.begin[wall.axis] == (wall.side == 0 ? 0 : zone.extent[wall.axis] - 1);
  if (!valid)
    throw MeshError("wall quality: " + describe_range(mesh, wall.zone, wall.range) +
                    " is no range on a face of the zone; use wall_faces() to make wall ranges");
  auto const strides = zone.strides();
  int const t1 = wall.axis == 0 ? 1 : 0, t2 = wall.axis == 2 ? 1 : 2;
  return {zone.node(wall.range.begin),
          {wall.range.extent(t1), wall.range.extent(t2)},
          {strides[t1], strides[t2]},
          wall.side == 0 ? strides[wall.axis] : -strides[wall.axis],
          0};
}

template <class MemorySpace>
KOKKOS_INLINE_FUNCTION kernels::WallNode wall_node_at(CoordinateViews<MemorySpace> const& c, WallGrid const& wall,
                                                      Index p, Index q) {
  auto const at = [&](Index node) { return Vec3{c.x(node), c.y(node), c.z(node)}; };
  Index const node = wall.first + p * wall.stride[0] + q * wall.stride[1];
  auto const difference = [&](Index number, Index extent, Index stride) {
    return at(node + (number + 1 < extent ? stride : 0)) - at(node - (number > 0 ? stride : 0));
  };
  return wall_node(difference(p, wall.extent[0], wall.stride[0]), difference(q, wall.extent[1], wall.stride[1]),
                   at(node + wall.inward) - at(node));
}

}  // namespace

template <class Exec>
WallQualities wall_quality(Exec const& exec, Mesh const& mesh,
                           CoordinateViews<typename Exec::memory_space> const& coordinates,
                           CoordinateViews<typename Exec::memory_space> const& baseline,
                           std::vector<WallFace> const& walls) {
  using MemorySpace = typename Exec::memory_space;
  bool const against_baseline = baseline.x.extent(0) > 0;
  std::vector<WallGrid> grids;
  std::vector<WallFace const*> faces;
  Index n_nodes = 0;
  for (WallFace const& face : walls) {
    WallGrid wall = wall_grid(mesh, face);
    if (wall.extent[0] < 2 || wall.extent[1] < 2) continue;  // a single line of nodes has no normal
    wall.begin = n_nodes;
    n_nodes += wall.size();
    grids.push_back(wall);
    faces.push_back(&face);
  }
  // One launch for all: meshes have hundreds of small wall faces, and a launch each costs more than its work.
  auto const list = upload(exec, "gridmorph::quality::walls", grids);
  Kokkos::View<WallNodePair*, MemorySpace> const nodes(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::wall_nodes"), n_nodes);
  if (n_nodes > 0)
    Kokkos::parallel_for(
        "gridmorph::wall_quality", Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>(exec, 0, n_nodes),
        KOKKOS_LAMBDA(Index m) {
          WallGrid const wall = list(wall_of(list, m));
          Index const p = (m - wall.begin) % wall.extent[0], q = (m - wall.begin) / wall.extent[0];
          WallNodePair pair;
          pair.now = wall_node_at(coordinates, wall, p, q);
          if (against_baseline) pair.before = wall_node_at(baseline, wall, p, q);
          nodes(m) = pair;
        });
  auto const nodes_h = download(exec, nodes);
  WallSums all;
  std::vector<std::pair<std::string, WallSums>> groups;
  for (std::size_t w = 0; w < grids.size(); ++w) {
    WallGrid const& wall = grids[w];
    WallFace const& face = *faces[w];
    auto group = std::find_if(groups.begin(), groups.end(), [&](auto const& g) { return g.first == face.group; });
    if (group == groups.end()) group = groups.insert(group, {face.group, {}});
    for (Index m = 0; m < wall.size(); ++m) {
      NodeLocation const where{face.zone, mesh.zones[face.zone].index(wall.node(m))};
      all.add(nodes_h(wall.begin + m), where, against_baseline);
      group->second.add(nodes_h(wall.begin + m), where, against_baseline);
    }
  }
  WallQualities out{all.result(), {}};
  for (auto const& [name, sums] : groups) out.groups.push_back({name, sums.result()});
  return out;
}

#define GRIDMORPH_INSTANTIATE(Exec)                                                                         \
  template WallQualities wall_quality(Exec const&, Mesh const&, CoordinateViews<Exec::memory_space> const&, \
                                      CoordinateViews<Exec::memory_space> const&, std::vector<WallFace> const&);
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph::detail
