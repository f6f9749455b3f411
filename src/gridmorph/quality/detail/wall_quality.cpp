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
};

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
          wall.side == 0 ? strides[wall.axis] : -strides[wall.axis]};
}

template <class MemorySpace>
KOKKOS_INLINE_FUNCTION WallNode wall_node_at(CoordinateViews<MemorySpace> const& c, WallGrid const& wall, Index p,
                                             Index q) {
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
  bool const against_baseline = baseline.x.extent(0) > 0;
  WallSums all;
  std::vector<std::pair<std::string, WallSums>> groups;
  for (WallFace const& face : walls) {
    WallGrid const wall = wall_grid(mesh, face);
    Index const n = wall.extent[0] * wall.extent[1];
    if (wall.extent[0] < 2 || wall.extent[1] < 2) continue;  // a single line of nodes has no normal
    Kokkos::View<WallNodePair*, typename Exec::memory_space> nodes(
        Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::wall_nodes"), n);
    Kokkos::parallel_for(
        "gridmorph::wall_quality", Kokkos::RangePolicy<Exec>(exec, 0, n), KOKKOS_LAMBDA(Index m) {
          Index const p = m % wall.extent[0], q = m / wall.extent[0];
          WallNodePair pair;
          pair.now = wall_node_at(coordinates, wall, p, q);
          if (against_baseline) pair.before = wall_node_at(baseline, wall, p, q);
          nodes(m) = pair;
        });
    auto group = std::find_if(groups.begin(), groups.end(), [&](auto const& g) { return g.first == face.group; });
    if (group == groups.end()) group = groups.insert(group, {face.group, {}});
    auto const nodes_h = download(exec, nodes);
    Index const first = wall.first;
    for (Index m = 0; m < n; ++m) {
      Index const node = first + m % wall.extent[0] * wall.stride[0] + m / wall.extent[0] * wall.stride[1];
      NodeLocation const where{face.zone, mesh.zones[face.zone].index(node)};
      all.add(nodes_h(m), where, against_baseline);
      group->second.add(nodes_h(m), where, against_baseline);
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
