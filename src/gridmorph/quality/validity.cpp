#include <gridmorph/core/error.hpp>
#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/kernels/cell_validity.hpp>
#include <gridmorph/quality/element_tables.hpp>
#include <gridmorph/quality/validity.hpp>

#include <string>

namespace gridmorph {

namespace {

std::vector<int> handedness_of(HostInstance const& host, Mesh const& mesh) {
  return host.visit([&](auto const& exec) { return zone_handedness(exec, mesh, views(mesh.coordinates)); });
}

/// The determinant of an element.
template <class MemorySpace>
struct ElementDeterminant {
  detail::ElementTables<MemorySpace> elements;
  Kokkos::View<signed char*, MemorySpace> signs;
  kernels::VectorArray x;

  KOKKOS_INLINE_FUNCTION double operator()(Index e) const { return elements.determinant(x, e, signs(e)); }
};

}  // namespace

template <BuiltFor Exec>
struct ValidityCheck<Exec>::State {
  Index n_nodes;
  bool unstructured;
  Kokkos::View<kernels::CellChunk*, MemorySpace> chunks;
  Kokkos::View<kernels::ChunkValidity*, MemorySpace> of_chunk;
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

template <BuiltFor Exec>
ValidityCheck<Exec>::ValidityCheck(Exec const& exec, Mesh const& mesh) {
  auto state = std::make_shared<State>(exec, mesh.n_nodes(), false, detail::chunks_of(mesh));
  state->zones = detail::upload(exec, "gridmorph::ValidityCheck::zones",
                                detail::zone_cells(mesh, handedness_of(host_instance(exec), mesh)));
  state_ = std::move(state);
}

template <BuiltFor Exec>
ValidityCheck<Exec>::ValidityCheck(Exec const& exec, Mesh const& mesh, UnstructuredTopology const& topology) {
  auto state = std::make_shared<State>(exec, mesh.n_nodes(), true, detail::element_chunks(mesh));
  state->first_element = detail::upload(exec, "gridmorph::ValidityCheck::zones", detail::first_elements(mesh));
  state->signs = detail::upload(exec, "gridmorph::ValidityCheck::signs",
                                detail::signs_of(host_instance(exec), mesh, topology.sides, {}));
  state->elements = detail::element_tables(exec, mesh);
  state_ = std::move(state);
}

template <BuiltFor Exec>
typename ValidityCheck<Exec>::Result ValidityCheck<Exec>::operator()(Exec const& exec,
                                                                     ConstVectorView<MemorySpace> const& x) const {
  State const& s = *state_;
  if (x.size() != s.n_nodes)
    throw ConfigError("gridmorph::ValidityCheck: coordinates of " + std::to_string(x.size()) +
                      " nodes, and the mesh has " + std::to_string(s.n_nodes));
  if (s.unstructured)
    kernels::check_elements(exec, s.chunks, s.first_element,
                            ElementDeterminant<MemorySpace>{s.elements, s.signs, x.array()}, s.of_chunk);
  else
    kernels::check_blocks(exec, s.chunks, s.zones, x.array(), s.of_chunk);
  kernels::join_chunks(exec, s.of_chunk, s.of_mesh);
  return s.of_mesh;
}

#define GRIDMORPH_INSTANTIATE(Exec) template class ValidityCheck<Exec>;
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
