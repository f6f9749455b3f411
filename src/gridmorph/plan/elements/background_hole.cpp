#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/plan/elements/background_hole.hpp>
#include <gridmorph/plan/elements/locate.hpp>

#include <algorithm>

namespace gridmorph {

Classification classify_by_hole(HostInstance const& host, Mesh const& mesh, Background const& background,
                                std::vector<Vec3> const& wrap_nodes) {
  Box box;
  for (Vec3 const& p : wrap_nodes) box.include(p);
  auto const& [low, high] = box;
  std::vector<Index32> candidates;
  std::vector<Vec3> points;
  for (Index32 n = 0; n < Index32(mesh.n_nodes()); ++n) {
    Vec3 const x = mesh.coordinates[n];
    bool const flat = mesh.dimension == 2;
    if (x.x < low.x || x.x > high.x || x.y < low.y || x.y > high.y || (!flat && (x.z < low.z || x.z > high.z)))
      continue;
    candidates.push_back(n);
    points.push_back(x);
  }
  Classification out;
  out.inside.assign(std::size_t(mesh.n_nodes()), 0);
  auto const in_background = locate(host, as_hexahedra(background.mesh), points);
  for (std::size_t k = 0; k < candidates.size(); ++k)
    out.inside[std::size_t(candidates[k])] = in_background[k].distance > 0 ? 1 : 0;
  out.element.assign(std::size_t(mesh.n_elements()), Region::far);
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    auto const corners = mesh.elements.corners(e);
    auto const n = std::count_if(corners.begin(), corners.end(), [&](Index32 c) { return out.inside[std::size_t(c)]; });
    if (n > 0) out.element[std::size_t(e)] = std::size_t(n) == corners.size() ? Region::near : Region::partial;
  }
  for (Location const& place : locate(host, mesh, wrap_nodes))
    if (place.element >= 0 && out.element[std::size_t(place.element)] == Region::far)
      out.element[std::size_t(place.element)] = Region::partial;
  out.near.assign(std::size_t(mesh.n_nodes()), 0);
  for (Index e = 0; e < mesh.n_elements(); ++e)
    if (out.element[std::size_t(e)] != Region::far)
      for (Index32 const n : mesh.elements.nodes[e]) out.near[std::size_t(n)] = 1;
  out.count();
  return out;
}

}  // namespace gridmorph
