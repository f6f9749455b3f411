#include <gridmorph/core/error.hpp>
#include <gridmorph/quality/detail/zone_cells.hpp>

#include <algorithm>

namespace gridmorph::detail {

std::vector<kernels::ZoneCells> zone_cells(Mesh const& mesh, std::span<int const> handedness) {
  std::vector<Index> const first = first_cells(mesh);
  std::vector<kernels::ZoneCells> zones(mesh.zones.size());
  for (std::size_t z = 0; z < zones.size(); ++z) {
    zones[z].first_node = mesh.zones[z].first_node;
    zones[z].first_cell = first[z];
    for (int a = 0; a < 3; ++a) zones[z].extent[a] = mesh.zones[z].extent[a] - 1;
    if (!handedness.empty()) zones[z].handedness = handedness[z];
  }
  return zones;
}

namespace {

void append_chunks(std::vector<kernels::CellChunk>& chunks, CellBox const& box) {
  kernels::CellChunk chunk;
  chunk.zone = box.zone;
  for (int a = 0; a < 3; ++a) {
    chunk.box_begin[a] = box.cells.begin[a];
    chunk.box_extent[a] = box.cells.extent(a);
  }
  Index const n = box.cells.size();
  for (Index begin = 0; begin < n; begin += kernels::cells_per_chunk) {
    chunk.begin = begin;
    chunk.end = std::min(begin + kernels::cells_per_chunk, n);
    chunks.push_back(chunk);
  }
}

}  // namespace

std::vector<kernels::CellChunk> chunks_of(Mesh const& mesh) {
  std::vector<kernels::CellChunk> chunks;
  for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
    auto const& n = mesh.zones[z].extent;
    append_chunks(chunks, {int(z), {{0, 0, 0}, {n[0] - 1, n[1] - 1, n[2] - 1}}});
  }
  return chunks;
}

std::vector<kernels::CellChunk> chunks_of(Mesh const& mesh, std::span<CellBox const> boxes) {
  std::vector<kernels::CellChunk> chunks;
  for (CellBox const& box : boxes) {
    if (box.zone < 0 || box.zone >= int(mesh.zones.size()))
      throw MeshError("cell box " + to_string(box.cells) + ": there is no zone number " + std::to_string(box.zone) +
                      ", the mesh has " + std::to_string(mesh.zones.size()) + " zones");
    Zone const& zone = mesh.zones[box.zone];
    for (int a = 0; a < 3; ++a)
      if (box.cells.begin[a] < 0 || box.cells.end[a] > zone.extent[a] - 1 || box.cells.extent(a) < 0)
        throw MeshError("zone '" + zone.name + "': the cell box " + to_string(box.cells) + " does not lie within the " +
                        std::to_string(zone.extent[0] - 1) + " x " + std::to_string(zone.extent[1] - 1) + " x " +
                        std::to_string(zone.extent[2] - 1) + " cells of the zone");
    append_chunks(chunks, box);
  }
  return chunks;
}

void check_size(Mesh const& mesh, std::size_t nx, std::size_t ny, std::size_t nz, std::string const& what) {
  auto const needed = std::size_t(mesh.n_nodes());
  std::size_t const found = std::min({nx, ny, nz});
  if (found < needed)
    throw MeshError(what + ": the Views hold " + std::to_string(found) + " nodes, the mesh '" + mesh.source + "' has " +
                    std::to_string(needed));
}

}  // namespace gridmorph::detail
