#include <gridmorph/app/cli/near_field_mask.hpp>
#include <gridmorph/quality/quality.hpp>

namespace gridmorph::cli {

std::vector<unsigned char> near_field_mask(Mesh const& mesh, Plan const& plan) {
  std::vector<unsigned char> mask(std::size_t(mesh.n_cells()), 0);
  std::vector<Index> const first = first_cells(mesh);
  for (auto const& box : plan.near_field) {
    Index const ni = mesh.zones[box.zone].extent[0] - 1, nj = mesh.zones[box.zone].extent[1] - 1;
    for (int k = box.cells.begin[2]; k < box.cells.end[2]; ++k)
      for (int j = box.cells.begin[1]; j < box.cells.end[1]; ++j)
        for (int i = box.cells.begin[0]; i < box.cells.end[0]; ++i)
          mask[std::size_t(first[box.zone] + i + ni * (j + nj * k))] = 1;
  }
  return mask;
}

}  // namespace gridmorph::cli
