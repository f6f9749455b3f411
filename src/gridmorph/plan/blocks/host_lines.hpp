// The lines of a stage as kernels see them, on the tables of the host: for walks along them while planning.
#pragma once

#include <gridmorph/plan/plan.hpp>

namespace gridmorph {

/// The chains and segments of a stage's lines, for walks on the host. Borrows the tables.
inline kernels::LineTable<Kokkos::HostSpace> host_lines(LineTables const& lines) {
  using Host = Kokkos::HostSpace;
  kernels::LineTable<Host> table;
  table.chains = Kokkos::View<kernels::Chain const*, Host>(lines.chains.data(), lines.chains.size());
  table.segments = Kokkos::View<kernels::Segment const*, Host>(lines.segments.data(), lines.segments.size());
  return table;
}

}  // namespace gridmorph
