// A Morpher on lists and coordinates of the host.
#pragma once

#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/morph/morpher.hpp>

#include <span>

namespace gridmorph {

/// positions() on the default host instance; waits. boundary: of all boundary nodes of the plan; moved: as many nodes
/// as the mesh.
inline void apply_on_host(Morpher<Kokkos::DefaultHostExecutionSpace> const& morpher, std::span<Vec3 const> boundary,
                          Coordinates& moved) {
  Kokkos::DefaultHostExecutionSpace const exec;
  morpher.positions(exec, Kokkos::View<Vec3 const*, Kokkos::HostSpace>(boundary.data(), boundary.size()), moved);
  compat::fence(exec, "gridmorph::apply_on_host (read by the host)");
}

}  // namespace gridmorph
