#include <gridmorph/boundary/patch_facets.hpp>
#include <gridmorph/boundary/patch_points.hpp>

namespace gridmorph {

FacetList facets_of_patches(Mesh const& mesh, std::span<int const> patches) {
  FacetList list;
  for (int const p : patches) {
    Patch const& patch = mesh.patches[p];
    auto const first = std::int32_t(list.points.size());
    for_each_node(mesh.zones[patch.zone], patch.range, [&](Index n) { list.points.push_back(mesh.coordinates[n]); });
    // Nodes of the range lie i fastest: the two axes along the patch, in this order.
    int axes[2] = {-1, -1};
    for (int axis = 0; axis < 3; ++axis)
      if (patch.range.extent(axis) > 1) axes[axes[0] < 0 ? 0 : 1] = axis;
    if (axes[1] < 0) continue;
    auto const n_a = std::int32_t(patch.range.extent(axes[0])), n_b = std::int32_t(patch.range.extent(axes[1]));
    for (std::int32_t b = 0; b + 1 < n_b; ++b)
      for (std::int32_t a = 0; a + 1 < n_a; ++a) {
        std::int32_t const at = first + a + n_a * b;
        list.facets.push_back({at, at + 1, at + 1 + n_a, at + n_a});
      }
  }
  return list;
}

}  // namespace gridmorph
