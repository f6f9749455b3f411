// Meshes dealt to processes: every cell once, about as many to each, rows whole.
#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/deal_zones.hpp>

#include "support/expect_error.hpp"
#include "support/mesh_builders.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace gridmorph::test {
namespace {

Index cells_of(std::vector<NodeBox> const& boxes) {
  Index n = 0;
  for (auto const& [zone, nodes] : boxes)
    n += Index(nodes.extent(0) - 1) * (nodes.extent(1) - 1) * (nodes.extent(2) - 1);
  return n;
}

TEST(DealZones, GivesEveryCellToOneProcessAndToEachAboutAsMany) {
  for (Mesh const& mesh : {box({30, 21, 41}, Shape::curved, 1), around_a_box(1), bricks_with_t_junctions(3), l_shape(2),
                           annulus_sector({}, 1)})
    for (int const n : {1, 2, 3, 7, 16}) {
      auto const parts = deal_zones(mesh, n);
      ASSERT_EQ(int(parts.size()), n);
      std::map<std::pair<int, Index3>, int> given;
      Index largest_plane = 0;
      for (auto const& boxes : parts)
        for (auto const& [z, nodes] : boxes) {
          Index3 const extent = mesh.zones[z].extent;
          if (nodes.extent(1) > 2 || nodes.extent(2) > 2) {
            EXPECT_EQ(nodes.extent(0), extent[0]) << "rows are whole";
          }
          largest_plane = std::max(largest_plane, Index(extent[0] - 1) * (std::max(extent[1], extent[2]) - 1));
          for (int k = nodes.begin[2]; k + 1 < nodes.end[2]; ++k)
            for (int j = nodes.begin[1]; j + 1 < nodes.end[1]; ++j)
              for (int i = nodes.begin[0]; i + 1 < nodes.end[0]; ++i) ++given[{z, Index3{i, j, k}}];
        }
      EXPECT_EQ(Index(given.size()), mesh.n_cells());
      for (auto const& [cell, times] : given) ASSERT_EQ(times, 1);
      for (auto const& boxes : parts) {
        // As near as whole planes of cells come; the last one has what those before leave.
        EXPECT_LE(cells_of(boxes), mesh.n_cells() / n + 2 * largest_plane) << mesh.source << ' ' << n;
      }
    }
}

TEST(DealZones, LeavesProcessesEmptyWhereThereAreFewCellsAndCutsRowsWhereThereIsNothingElse) {
  Mesh const row = box({9, 2, 2}, Shape::straight, 1);
  auto const parts = deal_zones(row, 4);
  for (auto const& boxes : parts) EXPECT_EQ(cells_of(boxes), 2);
  Index dealt = 0;
  for (auto const& boxes : deal_zones(row, 20)) dealt += cells_of(boxes);
  EXPECT_EQ(dealt, 8);
}

TEST(DealZones, RefusesNoProcessAndElements) {
  expect_all_in(message_of<ConfigError>([] { (void)deal_zones(l_shape(1), 0); }), {"1 process", "not to 0"});
  Mesh elements;
  elements.add_zone("gas", Index(4));
  expect_all_in(message_of<ConfigError>([&] { (void)deal_zones(elements, 2); }), {"'gas'", "elements"});
}

}  // namespace
}  // namespace gridmorph::test
