#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/mesh/deal_zones.hpp>

#include <algorithm>
#include <cstdint>
#include <string>
#include <tuple>

namespace gridmorph {
namespace {

/// The mean of a zone's corners.
Vec3 middle(BoundaryMesh const& mesh, Zone const& zone) {
  Vec3 sum;
  for (int const i : {0, zone.extent[0] - 1})
    for (int const j : {0, zone.extent[1] - 1})
      for (int const k : {0, zone.extent[2] - 1}) sum += mesh.coordinates[zone.node({i, j, k})];
  return 0.125 * sum;
}

/// The zones along a Hilbert curve through their middles.
std::vector<int> along_curve(BoundaryMesh const& mesh) {
  std::vector<Vec3> middles;
  kernels::Box box;
  for (Zone const& zone : mesh.zones) {
    middles.push_back(middle(mesh, zone));
    box.include(middles.back());
  }
  Vec3 const size = box.high - box.low;
  double const largest = std::max({size.x, size.y, size.z}),
               steps = largest > 0 ? double((1 << kernels::LatticePlace::bits) - 1) / largest : 0;
  std::vector<std::tuple<std::uint64_t, int>> order;
  for (int z = 0; z < int(middles.size()); ++z)
    order.emplace_back(kernels::hilbert_code(kernels::LatticePlace(middles[z], box.low, {steps, steps, steps})), z);
  std::sort(order.begin(), order.end());
  std::vector<int> out;
  for (auto const& [code, z] : order) out.push_back(z);
  return out;
}

/// Cells along each axis.
Index3 cells_of(IndexRange const& nodes) { return {nodes.extent(0) - 1, nodes.extent(1) - 1, nodes.extent(2) - 1}; }

/// Across which axis a box is cut.
int axis_of_cut(Index3 const& cells) {
  if (cells[1] < 2 && cells[2] < 2) return 0;
  return cells[2] >= cells[1] ? 2 : 1;
}

}  // namespace

std::vector<std::vector<NodeBox>> deal_zones(BoundaryMesh const& mesh, int n) {
  if (n < 1) throw ConfigError("a mesh is dealt to 1 process or more, not to " + std::to_string(n));
  Index left = 0;
  for (Zone const& zone : mesh.zones) {
    if (!zone.is_block()) throw ConfigError("zone '" + zone.name + "' has elements; only blocks can be dealt in boxes");
    Index3 const cells = cells_of({{0, 0, 0}, zone.extent});
    left += Index(cells[0]) * cells[1] * cells[2];
  }
  std::vector<std::vector<NodeBox>> out{std::size_t(n)};
  int process = 0;
  double wanted = double(left) / n;  // by the process, still
  for (int const z : along_curve(mesh)) {
    IndexRange rest{{0, 0, 0}, mesh.zones[z].extent};
    while (true) {
      Index3 const cells = cells_of(rest);
      int const axis = axis_of_cut(cells);
      Index const all = Index(cells[0]) * cells[1] * cells[2], of_plane = all / cells[axis];
      // The last one takes what is left. Others take a plane where that brings them nearer to what they should have.
      int const planes =
          process == n - 1 ? cells[axis] : std::min(cells[axis], int(std::max(0., wanted / double(of_plane) + 0.5)));
      if (planes > 0) {
        NodeBox box{z, rest};
        box.nodes.end[axis] = rest.begin[axis] + planes + 1;
        rest.begin[axis] += planes;
        out[std::size_t(process)].push_back(box);
        left -= planes * of_plane;
        wanted -= double(planes * of_plane);
      }
      if (planes == cells[axis]) break;
      ++process;
      wanted = double(left) / (n - process);
    }
  }
  return out;
}

}  // namespace gridmorph
