// What slip surfaces ask of the nodes on them: the end values of the redistribution along the lines between end walls.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/slip_edge.hpp>
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

/// What does not change from morph to morph: position in the baseline mesh and own distances from its surfaces.
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
/// unit of time.
///
/// Where several surfaces meet, the node slides along their common edge. They are applied in turn; planes at right angles,
/// and surfaces of revolution with planes across or along their axis, are exact after one round. Other nodes then take
/// Gauss-Newton steps: the shortest step that brings the node onto the tangent planes of all surfaces at once (quadratic
/// convergence, whatever the angle). Surfaces that meet at less than 0.01 rad count as one in these steps. The rate after
/// them is the one before without its components across the edge: exact but for the curvature of the surfaces over the
/// length of the steps.
template <class MemorySpace, bool Rate>
struct SlipEndValues {
  static constexpr int max_rounds = 3;
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
    bool on_all = end.surface[1] < 0;
    for (int round = 0; round < (on_all ? 1 : max_rounds); ++round) {
      Vec3 const before = wanted;
      for (int m = 0; m < 3; ++m) {
        if (end.surface[m] < 0) continue;
        SlipSurfaceView const& surface = surfaces(end.surface[m]);
        if constexpr (Rate) wanted_rate = surface.constrain_rate(here, baseline.own_offset[m], wanted, wanted_rate);
        wanted = surface.constrain(here, baseline.own_offset[m], wanted);
      }
      if (wanted == before) {
        on_all = true;
        break;
      }
    }
    if (!on_all) {
      int const count = end.surface[2] < 0 ? 2 : 3;
      AcrossEdge const across =
          slide_along_edge(count, Surfaces{surfaces, end}, Offsets{baseline}, baseline.position, wanted);
      if constexpr (Rate)
        for (int k = 0; k < across.count; ++k)
          wanted_rate = wanted_rate - dot(wanted_rate, across.direction[k]) * across.direction[k];
    }
    bool const left_alone = norm(wanted - given) <= end.tolerance && end.tolerance > 0;
    Vec3 const d = left_alone ? Vec3{} : (Rate ? wanted_rate - given_rate : wanted - given);
    values.set(end.value, in_frame(end.to_chain, d));
  }

 private:
  /// What slide_along_edge() asks of one end.
  struct Surfaces {
    Kokkos::View<SlipSurfaceView const*, MemorySpace> const& all;
    SlipEnd const& end;
    KOKKOS_INLINE_FUNCTION SlipSurfaceView const& operator()(int m) const { return all(end.surface[m]); }
  };
  struct Offsets {
    SlipEndBaseline const& baseline;
    KOKKOS_INLINE_FUNCTION double operator()(int m) const { return baseline.own_offset[m]; }
  };

  KOKKOS_INLINE_FUNCTION Vec3 in_frame(std::int32_t matrix, Vec3 const& v) const {
    return matrix < 0 ? v : matrices(matrix) * v;
  }
};

}  // namespace gridmorph::kernels
