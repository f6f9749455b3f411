#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/mesh/opposite_side.hpp>
#include <gridmorph/quality/detail/wall_quality.hpp>
#include <gridmorph/quality/detail/wall_sums.hpp>
#include <gridmorph/quality/element_tables.hpp>

#include <algorithm>
#include <string>
#include <utility>

namespace gridmorph::detail {

namespace {

/// The nodes of one group of walls: wall node, next node on its column, faces of the group around it.
struct WallTable {
  std::vector<Index32> node, next;
  CsrGraph faces_of_node;  ///< numbers in face_nodes
  CsrGraph face_nodes;
};

/// The next node of a column over corner `node` of boundary face f, or -1.
Index32 next_on_column(Mesh const& mesh, UnstructuredTopology const& topology, Index32 f, Index32 node) {
  Index32 const element = topology.boundary.element[f];
  auto const type = mesh.elements.type[element];
  if (type == ElementType::polyhedron) {
    OppositeSide opposite;
    find_opposite_side(mesh, element, topology.boundary.side[f], opposite);
    auto const at = std::find(opposite.below.begin(), opposite.below.end(), node);
    return opposite.side < 0 || at == opposite.below.end() ? -1 : opposite.above[at - opposite.below.begin()];
  }
  auto const corners = mesh.elements.corners(element);
  for (std::size_t c = 0; c < corners.size(); ++c)
    if (corners[c] == node) {
      int const next = layer_corner(type, topology.boundary.side[f], int(c));
      return next < 0 ? -1 : corners[next];
    }
  return -1;
}

WallTable wall_table(Mesh const& mesh, UnstructuredTopology const& topology, std::vector<Index32> const& faces) {
  WallTable out;
  std::vector<std::pair<Index32, Index32>> pairs;  // node, face of the table
  for (std::size_t f = 0; f < faces.size(); ++f) {
    auto const nodes = topology.boundary.nodes[faces[f]];
    out.face_nodes.add(nodes);
    for (Index32 const n : nodes) pairs.emplace_back(n, Index32(f));
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<Index32> around;
  for (std::size_t p = 0; p < pairs.size();) {
    Index32 const node = pairs[p].first;
    Index32 next = -1;
    around.clear();
    for (; p < pairs.size() && pairs[p].first == node; ++p) {
      around.push_back(pairs[p].second);
      if (next < 0) next = next_on_column(mesh, topology, faces[pairs[p].second], node);
    }
    if (next < 0) continue;
    out.node.push_back(node);
    out.next.push_back(next);
    out.faces_of_node.add(around);
  }
  return out;
}

}  // namespace

template <class Exec>
WallQualities wall_quality(Exec const& exec, Mesh const& mesh, UnstructuredTopology const& topology,
                           BoundaryFacePatches const& face_patches,
                           UnstructuredQualityInput<typename Exec::memory_space> const& input) {
  using MemorySpace = typename Exec::memory_space;
  bool const against_baseline = input.baseline.x.extent(0) > 0;
  std::vector<std::string> names;
  std::vector<int> group_of_patch(mesh.patches.size(), -1);
  for (int const p : input.walls) {
    auto const& patch = mesh.patches.at(p);
    std::string const& name = patch.families.empty() ? patch.name : patch.families.front();
    auto const at = std::find(names.begin(), names.end(), name);
    group_of_patch[p] = int(at - names.begin());
    if (at == names.end()) names.push_back(name);
  }
  std::vector<std::vector<Index32>> faces(names.size());
  for (std::size_t f = 0; f < face_patches.patch.size(); ++f)
    if (face_patches.patch[f] >= 0 && group_of_patch[face_patches.patch[f]] >= 0)
      faces[group_of_patch[face_patches.patch[f]]].push_back(Index32(f));

  WallSums all;
  WallQualities out;
  Vec3 const normal = plane_normal(mesh);
  for (std::size_t g = 0; g < names.size(); ++g) {
    WallTable const table = wall_table(mesh, topology, faces[g]);
    Index const n = Index(table.node.size());
    CsrViews<MemorySpace> const faces_of_node = views(exec, table.faces_of_node),
                                face_nodes = views(exec, table.face_nodes);
    kernels::ColumnWall<MemorySpace> const wall{view_of(exec, table.node, "gridmorph::quality::wall_node"),
                                                view_of(exec, table.next, "gridmorph::quality::wall_next"),
                                                faces_of_node.first,
                                                faces_of_node.item,
                                                face_nodes.first,
                                                face_nodes.item,
                                                normal};
    Kokkos::View<kernels::WallNodePair*, MemorySpace> const nodes(
        Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::quality::wall_nodes"), n);
    kernels::measure_walls(exec, wall, field_of(input.coordinates), field_of(input.baseline), against_baseline, nodes);
    auto const nodes_h = download(exec, nodes);
    WallSums sums;
    for (Index m = 0; m < n; ++m) {
      Index const node = table.node[m];
      NodeLocation const where{mesh.zone_of(node), {int(node_number_in_file(mesh, node)) - 1, 0, 0}};
      all.add(nodes_h(m), where, against_baseline);
      sums.add(nodes_h(m), where, against_baseline);
    }
    out.groups.push_back({names[g], sums.result()});
  }
  out.all = all.result();
  return out;
}

#define GRIDMORPH_INSTANTIATE(Exec)                                                          \
  template WallQualities wall_quality(Exec const&, Mesh const&, UnstructuredTopology const&, \
                                      BoundaryFacePatches const&,                            \
                                      UnstructuredQualityInput<Exec::memory_space> const&);
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph::detail
