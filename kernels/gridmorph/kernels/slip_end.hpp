// What slip surfaces ask of the nodes on them: the end values of the redistribution along the lines between end walls.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/items_by_kind.hpp>
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
  /// Nodes with a given displacement are left alone this near to their surfaces. Rates know nothing of it: what leads
  /// off a surface does not last longer than the way to here.
  double tolerance;
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

  [[nodiscard]] Index size() const { return Index(ends.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    SlipEnd const& end = ends(item);
    SlipEndBaseline b;
    b.position = x[end.node];
    for (int m = 0; m < 3; ++m)
      if (end.surface[m] >= 0) b.own_offset[m] = surfaces(end.surface[m]).own_offset(b.position);
    baselines(item) = b;
  }
};

/// The values of slip ends, d = (what the surfaces make of u) - u, in the chain's frame; with `Rate` its derivative
/// where u changes by `rate` per unit of time: constrain_to_all() of slip_edge.hpp. One item per end that slides on
/// nothing, whose value is zero, then one per slip end; where those are simple, each slides on one surface.
template <class MemorySpace, bool Rate, SlipKinds Of = SlipKinds::any>
struct SlipEndValues {
  Kokkos::View<SlipEnd const*, MemorySpace> ends;
  Kokkos::View<SlipEndBaseline const*, MemorySpace> baselines;
  Kokkos::View<SlipSurfaceView const*, MemorySpace> surfaces;
  Kokkos::View<Mat3 const*, MemorySpace> matrices;
  Field<double const> u, rate;
  Field<double> values;
  Kokkos::View<Index const*, MemorySpace> at_rest = {};  ///< values of ends that slide on nothing

  /// The same for ends of another kind.
  template <SlipKinds Other>
  [[nodiscard]] SlipEndValues<MemorySpace, Rate, Other> of_kind() const {
    return {ends, baselines, surfaces, matrices, u, rate, values, at_rest};
  }

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    Index const n = item - Index(at_rest.extent(0));
    if (n < 0) return values.set(at_rest(item), {});
    Index const slot = ends(n).slot;
    values.set(ends(n).value, change(n, u[slot], Rate ? rate[slot] : Vec3{}));
  }

  /// The value d of one end whose slot is displaced by u; with `Rate` its derivative.
  KOKKOS_INLINE_FUNCTION Vec3 change(Index n, Vec3 const& u_slot, Vec3 const& rate_slot) const {
    SlipEnd const& end = ends(n);
    SlipEndBaseline const& baseline = baselines(n);
    Vec3 const given = in_frame(end.to_node, u_slot), given_rate = in_frame(end.to_node, rate_slot);
    Vec3 wanted = given, wanted_rate = given_rate;
    int const count = Of == SlipKinds::simple || end.surface[1] < 0 ? 1 : end.surface[2] < 0 ? 2 : 3;
    Surfaces const of_end{surfaces, end};
    Offsets const own{baseline};
    if (Rate && count == 1)  // needs no displacement for it
      wanted_rate = of_end(0).constrain_rate(baseline.position, own(0), given, given_rate);
    else if constexpr (Of == SlipKinds::simple)
      wanted = of_end(0).constrain(baseline.position, own(0), given);
    else
      constrain_to_all<Rate>(count, of_end, own, baseline.position, wanted, wanted_rate);
    if constexpr (Rate) return in_frame(end.to_chain, wanted_rate - given_rate);
    bool const left_alone = norm(wanted - given) <= end.tolerance && end.tolerance > 0;
    return left_alone ? Vec3{} : in_frame(end.to_chain, wanted - given);
  }

 private:
  /// The surfaces of one end, as constrain_to_all() asks for them.
  struct Surfaces {
    Kokkos::View<SlipSurfaceView const*, MemorySpace> const& all;
    SlipEnd const& end;
    KOKKOS_INLINE_FUNCTION SlipSurfaceOf<Of> operator()(int m) const { return SlipSurfaceOf<Of>(all(end.surface[m])); }
  };
  struct Offsets {
    SlipEndBaseline const& baseline;
    KOKKOS_INLINE_FUNCTION double operator()(int m) const { return baseline.own_offset[m]; }
  };

  KOKKOS_INLINE_FUNCTION Vec3 in_frame(std::int32_t matrix, Vec3 const& v) const {
    return matrix < 0 ? v : matrices(matrix) * v;
  }
};
/// Fills the baselines of all ends, once per plan and baseline mesh.
template <class Exec>
void slip_end_baselines(Exec const& exec, Kokkos::View<SlipEnd const*, typename Exec::memory_space> const& ends,
                        Kokkos::View<SlipSurfaceView const*, typename Exec::memory_space> const& surfaces,
                        Field<double const> const& x,
                        Kokkos::View<SlipEndBaseline*, typename Exec::memory_space> const& baselines) {
  launch("gridmorph::slip_ends::baselines", exec,
         SlipEndBaselines<typename Exec::memory_space>{ends, surfaces, x, baselines});
}

/// End values of a pass: zero where its lines do not slide, `kernel` for the others.
template <class Exec, bool Rate>
void slip_ends(Exec const& exec, ItemsByKind<SlipKinds> const& items,
               SlipEndValues<typename Exec::memory_space, Rate> const& kernel) {
  launch_by_kind("gridmorph::slip_ends", exec, items, kernel);
}

}  // namespace gridmorph::kernels
