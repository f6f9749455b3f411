// Both ways to share chunks of cells out, by work items and by teams of threads as on GPUs, against plain loops.
#include <gridmorph/kernels/cell_chunks.hpp>
#include <gridmorph/quality/detail/zone_cells.hpp>

#include "quality/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace gridmorph::detail {
namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

/// Number of cells, first cell, and a sum that shows each cell once.
struct Visited {
  int cells = 0;
  Index smallest = 1 << 30, sum = 0;

  KOKKOS_INLINE_FUNCTION void take(Index cell) {
    ++cells;
    smallest = cell < smallest ? cell : smallest;
    sum += cell * cell;
  }
  KOKKOS_INLINE_FUNCTION void join(Visited const& other) {
    cells += other.cells;
    smallest = other.smallest < smallest ? other.smallest : smallest;
    sum += other.sum;
  }
  bool operator==(Visited const&) const = default;
};

struct Visit {
  Kokkos::View<kernels::ZoneCells const*, Kokkos::HostSpace> zones;

  KOKKOS_INLINE_FUNCTION void operator()(kernels::RowOfCells const& row, Visited& v) const {
    for (int n = 0; n < row.count; ++n) v.take(kernels::first_cell(zones(row.zone), row) + n);
  }
};

class VisitChunks : public ::testing::Test {
 protected:
  Mesh mesh_ = test::two_zones(test::all_orientations()[7], true);
  Mesh large_ = test::one_zone({71, 20, 4}, [](Index3 const& p) {
    return Vec3{double(p[0]), double(p[1]), double(p[2])};
  });

  /// What the chunks of boxes hold, counted cell by cell.
  static std::vector<Visited> plain(Mesh const& mesh, std::vector<CellBox> const& boxes) {
    std::vector<Visited> list;
    std::vector<Index> const first = first_cells(mesh);
    for (CellBox const& b : boxes) {
      Index const ni = mesh.zones[b.zone].extent[0] - 1, nj = mesh.zones[b.zone].extent[1] - 1;
      int in_chunk = 0;
      for (int k = b.cells.begin[2]; k < b.cells.end[2]; ++k)
        for (int j = b.cells.begin[1]; j < b.cells.end[1]; ++j)
          for (int i = b.cells.begin[0]; i < b.cells.end[0]; ++i, ++in_chunk) {
            if (in_chunk % kernels::cells_per_chunk == 0) list.emplace_back();
            list.back().take(first[b.zone] + i + ni * (j + nj * k));
          }
    }
    return list;
  }
  static std::vector<Visited> host(Kokkos::View<Visited*, Kokkos::HostSpace> const& v) {
    return {v.data(), v.data() + v.extent(0)};
  }
};

TEST_F(VisitChunks, ItemsAndTeamsOfAnySizeSeeEveryCellOfTheBoxesOnce) {
  std::vector<std::pair<Mesh const*, std::vector<CellBox>>> const cases{
      {&mesh_, {{1, {{0, 1, 0}, {2, 3, 4}}}, {0, {{1, 0, 2}, {3, 5, 4}}}}},
      {&large_, {{0, {{0, 0, 0}, {70, 19, 3}}}, {0, {{3, 2, 1}, {68, 17, 3}}}, {0, {{5, 5, 0}, {6, 6, 1}}}}}};
  Exec const exec;
  for (auto const& [mesh, boxes] : cases) {
    std::vector<Visited> const expected = plain(*mesh, boxes);
    auto const chunks = upload(exec, "chunks", chunks_of(*mesh, boxes));
    ASSERT_EQ(chunks.extent(0), expected.size());
    Visit const visit{upload(exec, "zones", zone_cells(*mesh, {}))};
    Kokkos::View<Visited*, Kokkos::HostSpace> const results("results", chunks.extent(0));
    kernels::visit_chunks(exec, "items", chunks, results, visit);
    exec.fence();
    EXPECT_EQ(host(results), expected);
    for (int team_size = 1; team_size <= std::min(3, exec.concurrency()); ++team_size) {
      Kokkos::deep_copy(results, Visited());
      kernels::visit_chunks_by_teams<Exec, Visited, Visit>(exec, "teams", team_size, {chunks, results, visit});
      exec.fence();
      EXPECT_EQ(host(results), expected) << "teams of " << team_size;
    }
  }
}

}  // namespace
}  // namespace gridmorph::detail
