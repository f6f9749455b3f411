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

kernels::WallGrid wall_grid(Mesh const& mesh, WallFace const& wall) {
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

}  // namespace

template <class Exec>
WallQualities wall_quality(Exec const& exec, Mesh const& mesh,
                           CoordinateViews<typename Exec::memory_space> const& coordinates,
                           CoordinateViews<typename Exec::memory_space> const& baseline,
                           std::vector<WallFace> const& walls) {
  using MemorySpace = typename Exec::memory_space;
  bool const against_baseline = baseline.x.extent(0) > 0;
  std::vector<kernels::WallGrid> grids;
  std::vector<WallFace const*> faces;
  Index n_nodes = 0;
  for (WallFace const& face : walls) {
    kernels::WallGrid wall = wall_grid(mesh, face);
    if (wall.extent[0] < 2 || wall.extent[1] < 2) continue;  // a single line of nodes has no normal
    wall.begin = n_nodes;
    n_nodes += wall.size();
    grids.push_back(wall);
    faces.push_back(&face);
  }
  auto const list = upload(exec, "gridmorph::quality::walls", grids);
  Kokkos::View<kernels::WallNodePair*, MemorySpace> const nodes(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::wall_nodes"), n_nodes);
  kernels::measure_walls(exec, Kokkos::View<kernels::WallGrid const*, MemorySpace>(list), field_of(coordinates),
                         field_of(baseline), against_baseline, nodes);
  auto const nodes_h = download(exec, nodes);
  WallSums all;
  std::vector<std::pair<std::string, WallSums>> groups;
  for (std::size_t w = 0; w < grids.size(); ++w) {
    kernels::WallGrid const& wall = grids[w];
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
