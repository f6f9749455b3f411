#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/kernels/flat_cells.hpp>
#include <gridmorph/kernels/jacobian_bounds.hpp>
#include <gridmorph/quality/detail/partial_sums.hpp>
#include <gridmorph/quality/element_tables.hpp>
#include <gridmorph/quality/validity.hpp>

#include <algorithm>

namespace gridmorph {

namespace {

using kernels::JacobianSign;

/// What one chunk of cells gives.
struct ChunkCertificate {
  Index cells = 0, zero = 0, flat_before = 0, negative = 0, undecided = 0, broken = 0;
  Index first = -1;  ///< number of the first broken cell

  KOKKOS_INLINE_FUNCTION void take_positive(int count) { cells += count; }
  /// baseline(): the sign that the cell had; flat_cell(): its FlatCell.
  template <class Baseline, class Flat>
  KOKKOS_INLINE_FUNCTION void take(JacobianSign sign, Index cell, Baseline const& baseline, Flat const& flat_cell) {
    ++cells;
    bool const lost = sign >= JacobianSign::negative && baseline() < JacobianSign::negative;
    if (lost && flat_cell().stays_flat()) {
      ++zero;
      ++flat_before;
      return;
    }
    zero += sign == JacobianSign::zero ? 1 : 0;
    negative += sign == JacobianSign::negative ? 1 : 0;
    undecided += sign == JacobianSign::undecided ? 1 : 0;
    if (!lost) return;
    if (broken++ == 0 || cell < first) first = cell;
  }
  KOKKOS_INLINE_FUNCTION void join(ChunkCertificate const& other) {
    cells += other.cells;
    zero += other.zero;
    flat_before += other.flat_before;
    negative += other.negative;
    undecided += other.undecided;
    if (other.broken > 0 && (broken == 0 || other.first < first)) first = other.first;
    broken += other.broken;
  }
};

template <class MemorySpace>
bool check_sizes(Mesh const& mesh, CertificateInput<MemorySpace> const& input) {
  detail::check_size(mesh, input.coordinates, "coordinates to certify");
  bool const against_baseline = input.baseline.x.extent(0) > 0;
  if (against_baseline) detail::check_size(mesh, input.baseline, "baseline coordinates");
  return against_baseline;
}

/// In the order of the chunks. place(cell): zone and index of a cell.
template <class Exec, class Chunks, class Place>
Certificate sum_of(Exec const& exec, Chunks const& of_chunk, Place const& place) {
  auto const host = detail::download(exec, of_chunk);
  ChunkCertificate all;
  for (std::size_t c = 0; c < host.extent(0); ++c) all.join(host(c));
  Certificate out{all.cells, all.zero, all.flat_before, all.negative, all.undecided, {}};
  out.broken.cells = all.broken;
  if (all.broken > 0) {
    auto const [zone, cell] = place(all.first);
    out.broken.worst_zone = zone;
    out.broken.worst_cell = cell;
    out.broken.number = all.first;
  }
  return out;
}

template <class Exec>
Kokkos::View<ChunkCertificate*, typename Exec::memory_space> results(Exec const& exec, std::size_t n_chunks) {
  return Kokkos::View<ChunkCertificate*, typename Exec::memory_space>(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::certify::of_chunk"), n_chunks);
}

/// Those of the zones that are looked at.
std::vector<kernels::CellChunk> of_zones(std::vector<kernels::CellChunk> table, std::vector<int> const& zones) {
  if (!zones.empty()) std::erase_if(table, [&](auto const& chunk) { return !std::ranges::count(zones, chunk.zone); });
  return table;
}

}  // namespace

template <BuiltFor Exec>
Certificate certify(Exec const& exec, Mesh const& mesh, CertificateInput<typename Exec::memory_space> const& input) {
  using Policy = kernels::CellPolicy<Exec>;
  bool const against_baseline = check_sizes(mesh, input);
  auto const coordinates = input.coordinates, baseline = against_baseline ? input.baseline : input.coordinates;
  std::vector<int> const handedness =
      input.handedness.size() == mesh.zones.size() ? input.handedness : zone_handedness(exec, mesh, baseline);
  std::vector<kernels::CellChunk> const table = of_zones(detail::chunks_of(mesh), input.zones);
  auto const zones = detail::upload(exec, "gridmorph::certify::zones", detail::zone_cells(mesh, handedness));
  auto const chunks = detail::upload(exec, "gridmorph::certify::chunks", table);
  auto const of_chunk = results(exec, table.size());
  kernels::visit_chunks<kernels::by_lanes>(
      exec, "gridmorph::certify::blocks", chunks, of_chunk,
      KOKKOS_LAMBDA(kernels::RowOfCells const& row, ChunkCertificate& certificate) {
        kernels::ZoneCells const zone = zones(row.zone);
        kernels::CellRow const now = detail::cell_row(coordinates, zone, row);
        double mark[Policy::row_length];
        kernels::row_jacobian_signs<Policy::lanes>(now, mark);
        for (int n = 0; n < row.count; ++n) {
          if (mark[n] == 0) {
            certificate.take_positive(1);
            continue;
          }
          certificate.take(
              kernels::jacobian_sign(now.cell(n), zone.handedness), kernels::first_cell(zone, row) + n,
              [&] {
                return against_baseline
                           ? kernels::jacobian_sign(detail::cell_row(baseline, zone, row).cell(n), zone.handedness)
                           : JacobianSign::positive;
              },
              [&] {
                return against_baseline ? kernels::flat_cell(detail::cell_row(baseline, zone, row).cell(n), now.cell(n),
                                                             zone.handedness)
                                        : kernels::FlatCell{};
              });
        }
      });
  return sum_of(exec, of_chunk, [&](Index cell) { return detail::place_of_cell(mesh, cell); });
}

template <BuiltFor Exec>
Certificate certify(Exec const& exec, Mesh const& mesh, UnstructuredTopology const& topology,
                    CertificateInput<typename Exec::memory_space> const& input) {
  bool const against_baseline = check_sizes(mesh, input);
  auto const coordinates = input.coordinates, baseline = against_baseline ? input.baseline : input.coordinates;
  std::vector<kernels::CellChunk> const table = of_zones(detail::element_chunks(mesh), input.zones);
  auto const elements = detail::element_tables(exec, mesh);
  auto const first_element = detail::upload(exec, "gridmorph::certify::zones", detail::first_elements(mesh));
  auto const signs = detail::upload(exec, "gridmorph::certify::signs",
                                    detail::signs_of(host_instance(exec), mesh, topology.sides, input.signs));
  auto const chunks = detail::upload(exec, "gridmorph::certify::chunks", table);
  auto const of_chunk = results(exec, table.size());
  kernels::visit_chunks(
      exec, "gridmorph::certify::elements", chunks, of_chunk,
      KOKKOS_LAMBDA(kernels::RowOfCells const& row, ChunkCertificate& certificate) {
        for (int n = 0; n < row.count; ++n) {
          Index const e = first_element(row.zone) + row.i + n;
          auto const sign_in = [&](auto const& x) { return elements.jacobian_sign(x, e, signs(e)); };
          certificate.take(
              sign_in(coordinates), e, [&] { return against_baseline ? sign_in(baseline) : JacobianSign::positive; },
              [&] {
                return against_baseline ? elements.flat_element(baseline, coordinates, e, signs(e))
                                        : kernels::FlatCell{};
              });
        }
      });
  return sum_of(exec, of_chunk, [&](Index element) { return detail::place_of_element(mesh, element); });
}

#define GRIDMORPH_INSTANTIATE(Exec)                                                                    \
  template Certificate certify(Exec const&, Mesh const&, CertificateInput<Exec::memory_space> const&); \
  template Certificate certify(Exec const&, Mesh const&, UnstructuredTopology const&,                  \
                               CertificateInput<Exec::memory_space> const&);
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph
