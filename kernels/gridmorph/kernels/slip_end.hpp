// What slip surfaces ask of the nodes on them: the end values of the redistribution along the lines between end walls.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/slip_surface.hpp>

namespace gridmorph::kernels {

/// One end of a line of a redistribution chain that slides on surfaces.
struct SlipEnd {
  Index node;             ///< whose position counts
  Index slot;             ///< whose displacement counts
  Index value;            ///< where its end value goes
  std::int32_t to_node;   ///< frame of the slot -> frame of the node, -1: the same
  std::int32_t to_chain;  ///< frame of the node -> chain frame
  std::int32_t surface[3];
  double tolerance;  ///< nodes with a given displacement are left alone this near to their surfaces
};

/// What does not change from morph to morph: position in the baseline mesh and distances from surfaces of revolution.
struct SlipEndBaseline {
  Vec3 position;
  double own_offset[3] = {0, 0, 0};
};

template <class MemorySpace>
struct SlipEndBaselines {
  Kokkos::View<SlipEnd const*, MemorySpace> ends;
  Kokkos::View<SlipSurfaceView const*, MemorySpace> surfaces;
  Field<double const> x;
  Kokkos::View<SlipEndBaseline*, MemorySpace> baselines;

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    SlipEnd const& end = ends(item);
    SlipEndBaseline b;
    b.position = x[end.node];
    for (int m = 0; m < 3; ++m)
      if (end.surface[m] >= 0) b.own_offset[m] = surfaces(end.surface[m]).own_offset(b.position);
    baselines(item) = b;
  }
};

/// d = (what the surfaces make of u) - u, in the chain's frame; with `Rate` its derivative where u changes by `rate` per
/// unit of time. Where several surfaces meet, they are applied in turn until the node lies on all of them (exact after one
/// round for planes at right angles and for surfaces of revolution with planes across their axis).
template <class MemorySpace, bool Rate>
struct SlipEndValues {
  static constexpr int max_rounds = 50;
  Kokkos::View<SlipEnd const*, MemorySpace> ends;
  Kokkos::View<SlipEndBaseline const*, MemorySpace> baselines;
  Kokkos::View<SlipSurfaceView const*, MemorySpace> surfaces;
  Kokkos::View<Mat3 const*, MemorySpace> matrices;
  Field<double const> u, rate;
  Field<double> values;

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    SlipEnd const& end = ends(item);
    SlipEndBaseline const& baseline = baselines(item);
    Vec3 const here = baseline.position, given = in_frame(end.to_node, u[end.slot]);
    Vec3 const given_rate = Rate ? in_frame(end.to_node, rate[end.slot]) : Vec3{};
    Vec3 wanted = given, wanted_rate = given_rate;
    bool const several = end.surface[1] >= 0;
    for (int round = 0; round < (several ? max_rounds : 1); ++round) {
      Vec3 const before = wanted;
      for (int m = 0; m < 3; ++m) {
        if (end.surface[m] < 0) continue;
        SlipSurfaceView const& surface = surfaces(end.surface[m]);
        if constexpr (Rate) wanted_rate = surface.constrain_rate(here, baseline.own_offset[m], wanted, wanted_rate);
        wanted = surface.constrain(here, baseline.own_offset[m], wanted);
      }
      if (wanted == before) break;
    }
    bool const left_alone = norm(wanted - given) <= end.tolerance && end.tolerance > 0;
    Vec3 const d = left_alone ? Vec3{} : (Rate ? wanted_rate - given_rate : wanted - given);
    values.set(end.value, in_frame(end.to_chain, d));
  }

 private:
  KOKKOS_INLINE_FUNCTION Vec3 in_frame(std::int32_t matrix, Vec3 const& v) const {
    return matrix < 0 ? v : matrices(matrix) * v;
  }
};

}  // namespace gridmorph::kernels
