// Runs a plan on an execution space: displacement and morphed coordinates of every node, back on the host.
#pragma once

#include <gridmorph/morph/morpher_access.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace gridmorph::test {

template <class Memory>
struct DeviceField {
  Kokkos::View<double*, Memory> x, y, z;
  explicit DeviceField(Coordinates const& c)
      : x(Kokkos::create_mirror_view_and_copy(Memory(), c.x)),
        y(Kokkos::create_mirror_view_and_copy(Memory(), c.y)),
        z(Kokkos::create_mirror_view_and_copy(Memory(), c.z)) {}
  [[nodiscard]] kernels::Field<double const> read() const { return {x.data(), y.data(), z.data()}; }
  [[nodiscard]] kernels::Field<double> write() const { return {x.data(), y.data(), z.data()}; }
  [[nodiscard]] Coordinates host_copy() const {
    Coordinates c(Index(x.extent(0)));
    Kokkos::deep_copy(c.x, x);
    Kokkos::deep_copy(c.y, y);
    Kokkos::deep_copy(c.z, z);
    return c;
  }
};

template <class Memory>
Kokkos::View<Vec3*, Memory> upload(std::vector<Vec3> const& values) {
  Kokkos::View<Vec3*, Memory> device("test::boundary", values.size());
  auto const host = Kokkos::create_mirror_view(device);
  for (std::size_t n = 0; n < values.size(); ++n) host(n) = values[n];
  Kokkos::deep_copy(device, host);
  return device;
}

struct Morphed {
  Coordinates displacement, position;
};

/// Every node starts as not-a-number, so that a node the plan forgets shows.
template <class Exec>
Morphed run_plan(Exec const& exec, Coordinates const& baseline, Plan const& plan, std::vector<Vec3> const& boundary) {
  using Memory = typename Exec::memory_space;
  Coordinates nothing(baseline.size());
  for (Index n = 0; n < nothing.size(); ++n) {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    nothing.set(n, {nan, nan, nan});
  }
  // On the host these are the arrays themselves, not copies.
  DeviceField<Memory> const x(baseline), u(nothing);
  auto const morpher = MorpherAccess::of(exec, plan, x);
  Morphed out;
  morpher.displacements(exec, upload<Memory>(boundary), u);
  exec.fence();
  out.displacement = u.host_copy();
  Coordinates nothing_yet(baseline.size());
  DeviceField<Memory> const moved(nothing_yet);
  morpher.positions(exec, upload<Memory>(boundary), moved);
  exec.fence();
  out.position = moved.host_copy();
  return out;
}

template <class Exec>
Morphed run_plan(Exec const& exec, Mesh const& mesh, Plan const& plan, std::vector<Vec3> const& boundary) {
  return run_plan(exec, mesh.coordinates, plan, boundary);
}

/// A mesh, its plan and what came of it.
struct Outcome {
  Mesh mesh;
  PreparedMorph prepared;
  std::vector<Vec3> boundary;
  Morphed morphed;

  [[nodiscard]] Vec3 u(Index n) const { return morphed.displacement[n]; }
  [[nodiscard]] Plan const& plan() const { return prepared.plan(); }
};

/// Without a near field: what tests of lines from boundary to boundary assume.
inline PlanOptions without_near_field() {
  PlanOptions options;
  options.default_boundary_layer = false;
  return options;
}

template <class Exec = Kokkos::DefaultHostExecutionSpace>
Outcome morph(Mesh const& mesh, Motion const& motion, PlanOptions const& options = without_near_field(),
              Exec const& exec = {}) {
  PreparedMorph prepared = prepare(mesh, motion, options);
  std::vector<Vec3> boundary = prepared.boundary_displacement();
  Morphed morphed = run_plan(exec, mesh, prepared.plan(), boundary);
  return {prepared.mesh, std::move(prepared), std::move(boundary), std::move(morphed)};
}

inline bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }
inline bool same_bits(Vec3 const& a, Vec3 const& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

/// Number of nodes where two fields differ in any bit.
inline Index different_bits(Coordinates const& a, Coordinates const& b) {
  Index count = 0;
  for (Index n = 0; n < a.size(); ++n) count += same_bits(a[n], b[n]) ? 0 : 1;
  return count;
}

}  // namespace gridmorph::test
