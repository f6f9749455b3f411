#include <gridmorph/core/error.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/quality/element_tables.hpp>
#include <gridmorph/quality/validity.hpp>

#include <string>

namespace gridmorph {

namespace {

/// What one chunk of cells gives.
struct ChunkValidity : Validity {
  KOKKOS_INLINE_FUNCTION void take(double determinant) {
    if (determinant < smallest_determinant) smallest_determinant = determinant;
    if (determinant < 0) ++inverted;
  }
  KOKKOS_INLINE_FUNCTION void join(ChunkValidity const& other) {
    if (other.smallest_determinant < smallest_determinant) smallest_determinant = other.smallest_determinant;
    inverted += other.inverted;
  }
};

/// The nodes of a row of cells gathered from wherever they lie.
template <int Length>
struct RowNodes {
  double x[4][Length + 1], y[4][Length + 1], z[4][Length + 1];

  KOKKOS_INLINE_FUNCTION RowNodes(kernels::VectorArray const& from, kernels::ZoneCells const& zone,
                                  kernels::RowOfCells const& row) {
    Index const sj = zone.node_stride(1), sk = zone.node_stride(2);
    for (int line = 0; line < 4; ++line) {
      Index const first = zone.first_node + row.i + (row.j + line % 2) * sj + (row.k + line / 2) * sk;
      from.with_row(first, [&](auto const& nodes) {
        for (int n = 0; n <= row.count; ++n) {
          x[line][n] = nodes.x[n * nodes.stride];
          y[line][n] = nodes.y[n * nodes.stride];
          z[line][n] = nodes.z[n * nodes.stride];
        }
      });
    }
  }
  KOKKOS_INLINE_FUNCTION kernels::CellRow cells(int count, double handedness) const {
    return {x[0], y[0], z[0], Length + 1, 2 * (Length + 1), count, handedness};
  }
};

std::vector<int> handedness_of(HostInstance const& host, Mesh const& mesh) {
  return host.visit([&](auto const& exec) { return zone_handedness(exec, mesh, views(mesh.coordinates)); });
}

template <class Exec>
void check_blocks(Exec const& exec, Kokkos::View<kernels::CellChunk*, typename Exec::memory_space> const& chunks,
                  Kokkos::View<kernels::ZoneCells*, typename Exec::memory_space> const& zones,
                  kernels::VectorArray const& x,
                  Kokkos::View<ChunkValidity*, typename Exec::memory_space> const& of_chunk) {
  using Policy = kernels::CellPolicy<Exec>;
  kernels::visit_chunks(
      exec, "gridmorph::validity::blocks", chunks, of_chunk,
      KOKKOS_LAMBDA(kernels::RowOfCells const& row, ChunkValidity& validity) {
        RowNodes<Policy::row_length> const nodes(x, zones(row.zone), row);
        double determinant[Policy::row_length], mark[Policy::row_length];
        row_determinants<Policy::lanes>(nodes.cells(row.count, zones(row.zone).handedness), determinant, mark);
        for (int n = 0; n < row.count; ++n) validity.take(determinant[n]);
      });
}

template <class Exec>
void check_elements(Exec const& exec, Kokkos::View<kernels::CellChunk*, typename Exec::memory_space> const& chunks,
                    detail::ElementTables<typename Exec::memory_space> const& elements,
                    Kokkos::View<Index*, typename Exec::memory_space> const& first_element,
                    Kokkos::View<signed char*, typename Exec::memory_space> const& signs, kernels::VectorArray const& x,
                    Kokkos::View<ChunkValidity*, typename Exec::memory_space> const& of_chunk) {
  kernels::visit_chunks(
      exec, "gridmorph::validity::elements", chunks, of_chunk,
      KOKKOS_LAMBDA(kernels::RowOfCells const& row, ChunkValidity& validity) {
        for (int n = 0; n < row.count; ++n) {
          Index const e = first_element(row.zone) + row.i + n;
          ElementType const type = elements.type(e);
          if (type == ElementType::polyhedron) continue;
          validity.take(element_determinant(type, elements.corners(x, e), signs(e), elements.plane_normal));
        }
      });
}

}  // namespace

template <class Exec>
struct ValidityCheck<Exec>::State {
  Index n_nodes;
  bool unstructured;
  Kokkos::View<kernels::CellChunk*, MemorySpace> chunks;
  Kokkos::View<ChunkValidity*, MemorySpace> of_chunk;
  Kokkos::View<Validity, MemorySpace> of_mesh;
  Kokkos::View<kernels::ZoneCells*, MemorySpace> zones;  ///< of blocks
  Kokkos::View<Index*, MemorySpace> first_element;
  Kokkos::View<signed char*, MemorySpace> signs;
  detail::ElementTables<MemorySpace> elements;

  State(Exec const& exec, Index nodes, bool elements_of_all_types, std::vector<kernels::CellChunk> const& table)
      : n_nodes(nodes),
        unstructured(elements_of_all_types),
        chunks(detail::upload(exec, "gridmorph::ValidityCheck::chunks", table)),
        of_chunk(Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::ValidityCheck::of_chunk"),
                 table.size()),
        of_mesh(Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::ValidityCheck::of_mesh")) {}
};

template <class Exec>
ValidityCheck<Exec>::ValidityCheck(Exec const& exec, Mesh const& mesh) {
  auto state = std::make_shared<State>(exec, mesh.n_nodes(), false, detail::chunks_of(mesh));
  state->zones = detail::upload(exec, "gridmorph::ValidityCheck::zones",
                                detail::zone_cells(mesh, handedness_of(host_instance(exec), mesh)));
  state_ = std::move(state);
}

template <class Exec>
ValidityCheck<Exec>::ValidityCheck(Exec const& exec, Mesh const& mesh, UnstructuredTopology const& topology) {
  auto state = std::make_shared<State>(exec, mesh.n_nodes(), true, detail::element_chunks(mesh));
  state->first_element = detail::upload(exec, "gridmorph::ValidityCheck::zones", detail::first_elements(mesh));
  state->signs = detail::upload(exec, "gridmorph::ValidityCheck::signs",
                                detail::signs_of(host_instance(exec), mesh, topology.sides, {}));
  state->elements = detail::element_tables(exec, mesh);
  state_ = std::move(state);
}

template <class Exec>
typename ValidityCheck<Exec>::Result ValidityCheck<Exec>::operator()(Exec const& exec,
                                                                     ConstVectorView<MemorySpace> const& x) const {
  State const& s = *state_;
  if (x.size() != s.n_nodes)
    throw ConfigError("gridmorph::ValidityCheck: coordinates of " + std::to_string(x.size()) +
                      " nodes, and the mesh has " + std::to_string(s.n_nodes));
  auto const of_mesh = s.of_mesh;
  auto const of_chunk = s.of_chunk;
  Kokkos::parallel_for(
      "gridmorph::validity::begin", Kokkos::RangePolicy<Exec>(exec, 0, 1),
      KOKKOS_LAMBDA(int) { of_mesh() = Validity{}; });
  if (s.unstructured)
    check_elements(exec, s.chunks, s.elements, s.first_element, s.signs, x.array(), of_chunk);
  else
    check_blocks(exec, s.chunks, s.zones, x.array(), of_chunk);
  // Neither the smallest of some values nor the sum of whole numbers depends on the order in which they come.
  Kokkos::parallel_for(
      "gridmorph::validity::all", Kokkos::RangePolicy<Exec>(exec, 0, int(of_chunk.extent(0))), KOKKOS_LAMBDA(int c) {
        Kokkos::atomic_fetch_min(&of_mesh().smallest_determinant, of_chunk(c).smallest_determinant);
        Kokkos::atomic_add(&of_mesh().inverted, of_chunk(c).inverted);
      });
  return of_mesh;
}

#define GRIDMORPH_INSTANTIATE(Exec) template class ValidityCheck<Exec>;
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
