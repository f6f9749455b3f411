// Interfaces as the pairs of face cells that they join, so that two ways to cut them into rectangles compare equal.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <array>
#include <set>
#include <vector>

namespace gridmorph::test {

/// First and last node of a cell and of the cell it is joined with; the lower pair first.
using CellJoint = std::array<Index, 4>;

inline std::set<CellJoint> joined_cells(Mesh const& mesh, std::vector<Interface1to1> const& interfaces, bool periodic) {
  std::set<CellJoint> out;
  for (auto const& face : interfaces) {
    if (face.periodic.has_value() != periodic) continue;
    int normal = 0;
    while (face.range.extent(normal) != 1) ++normal;
    auto cells = face.range;
    for (int a = 0; a < 3; ++a)
      if (a != normal) --cells.end[a];
    for (int k = cells.begin[2]; k < cells.end[2]; ++k)
      for (int j = cells.begin[1]; j < cells.end[1]; ++j)
        for (int i = cells.begin[0]; i < cells.end[0]; ++i) {
          IndexRange cell{{i, j, k}, {i + 2, j + 2, k + 2}};
          cell.end[normal] = cell.begin[normal] + 1;
          auto const ends = [&](int zone, IndexRange const& r) {
            return std::array<Index, 2>{mesh.zones[zone].node(r.begin),
                                        mesh.zones[zone].node({r.end[0] - 1, r.end[1] - 1, r.end[2] - 1})};
          };
          auto const a = ends(face.zone, cell), b = ends(face.donor_zone, face.to_donor(cell));
          out.insert(a < b ? CellJoint{a[0], a[1], b[0], b[1]} : CellJoint{b[0], b[1], a[0], a[1]});
        }
  }
  return out;
}

}  // namespace gridmorph::test
