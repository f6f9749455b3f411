// What the surfaces of nodes that move as one ask of them together: of a node, and of its images behind periodic
// boundaries, each on surfaces of its own, u_k = R_k u. All are put where these want them by constrain_to_all() of
// slip_edge.hpp, each surface seen in the frame of the node: u + R_k^T (constrain(R_k u) - R_k u). So are displacements
// that rules give, unless they are there to within a tolerance.
//
// Cost per entry: 48 bytes, 12 for each surface and 24 for each image, and the surfaces' own.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/transposed_slip.hpp>
#include <gridmorph/kernels/vector_array.hpp>

namespace gridmorph::kernels {

/// A surface as a displacement sees it that moves another node by R u. What slip_edge.hpp asks of a SlipSurfaceView, at
/// the place of that node whatever baseline is given.
struct SurfaceOfImage {
  SlipSurfaceView const& surface;
  Vec3 place;
  Mat3 const* turn;  ///< R; null: none
  double size;

  KOKKOS_INLINE_FUNCTION SurfaceOfImage(SlipSurfaceView const& of, Vec3 const& at, Mat3 const* turned)
      : surface(of), place(at), turn(turned), size(of.size) {}

  [[nodiscard]] KOKKOS_INLINE_FUNCTION Vec3 there(Vec3 const& v) const { return turn == nullptr ? v : *turn * v; }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION Vec3 back(Vec3 const& v) const {
    return turn == nullptr ? v : transpose(*turn) * v;
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double own_offset() const { return surface.own_offset(place); }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION Vec3 constrain(Vec3 const&, double own, Vec3 const& u) const {
    if (turn == nullptr) return surface.constrain(place, own, u);
    Vec3 const v = there(u), kept = surface.constrain(place, own, v);
    return kept == v ? u : u + back(kept - v);
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION Vec3 constrain_rate(Vec3 const&, double own, Vec3 const& u,
                                                           Vec3 const& rate) const {
    return back(surface.constrain_rate(place, own, there(u), there(rate)));
  }
  KOKKOS_INLINE_FUNCTION double excess(Vec3 const&, double own, Vec3 const& u, Vec3& gradient) const {
    Vec3 of_image;
    double const out = surface.excess(place, own, there(u), of_image);
    gradient = back(of_image);
    return out;
  }
};
/// The gradient of u where there is one surface, as constrained_gradient() asks for it.
KOKKOS_INLINE_FUNCTION Vec3 slip_gradient(SurfaceOfImage const& s, Vec3 const&, double own, Vec3 const& u,
                                          Vec3 const& g) {
  return s.back(slip_gradient(s.surface, s.place, own, s.there(u), s.there(g)));
}

template <class MemorySpace>
struct JointSlipTable {
  Kokkos::View<Index const*, MemorySpace> first;                        ///< (entries + 1)
  Kokkos::View<std::int32_t const*, MemorySpace> surface, place, turn;  ///< per surface of an entry; turn -1: none
  Kokkos::View<Mat3 const*, MemorySpace> turns;
  Kokkos::View<SlipSurfaceView const*, MemorySpace> surfaces;

  /// The number of surfaces of entry k.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION int count(Index k) const { return int(first(k + 1) - first(k)); }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION SurfaceOfImage surface_of(Index k, int m, Field<double const> const& x) const {
    Index const at = first(k) + m;
    return {surfaces(surface(at)), x[place(at)], turn(at) < 0 ? nullptr : &turns(turn(at))};
  }
  /// Makes u what the surfaces of entry k let it be, and with `Rate` its rate of change.
  template <bool Rate>
  KOKKOS_INLINE_FUNCTION void constrain(Index k, Field<double const> const& x, Vec3& u, Vec3& rate) const {
    auto const surface_at = [&](int m) { return surface_of(k, m, x); };
    auto const own = [&](int m) { return surface_of(k, m, x).own_offset(); };
    constrain_to_all<Rate>(count(k), surface_at, own, Vec3{}, u, rate);
  }
  /// The transpose of the rate at u.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION Vec3 gradient(Index k, Field<double const> const& x, Vec3 const& u,
                                                     Vec3 const& g) const {
    auto const surface_at = [&](int m) { return surface_of(k, m, x); };
    auto const own = [&](int m) { return surface_of(k, m, x).own_offset(); };
    return constrained_gradient(count(k), surface_at, own, Vec3{}, u, g);
  }
};

/// Displacements that are given, as they are.
struct CopyGiven {
  VectorArray given;
  Vec3* kept;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { kept[n] = given[n]; }
};
/// kept(slot(k)) = what the surfaces of entry k make of given(slot(k)), where that is farther off than a tolerance;
/// with `Rate` also the rate, which knows nothing of it: what leads off a surface does not last longer than the way to
/// there.
template <class MemorySpace, bool Rate>
struct PutBackGiven {
  JointSlipTable<MemorySpace> table;
  Kokkos::View<std::int32_t const*, MemorySpace> slot;
  Kokkos::View<double const*, MemorySpace> tolerance;
  VectorArray given, given_rate;
  Field<double const> x;
  Vec3 *kept, *kept_rate;

  [[nodiscard]] Index size() const { return Index(slot.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const s = slot(k);
    Vec3 const prescribed = given[s];
    Vec3 u = prescribed, rate;
    if constexpr (Rate) rate = given_rate[s];
    table.template constrain<Rate>(k, x, u, rate);
    if (norm(u - prescribed) > tolerance(k)) kept[s] = u;
    if constexpr (Rate) kept_rate[s] = rate;
  }
};
/// Transpose of PutBackGiven, on gradients where they are: of what is kept, then of what is given.
template <class MemorySpace>
struct PutBackGivenBack {
  JointSlipTable<MemorySpace> table;
  Kokkos::View<std::int32_t const*, MemorySpace> slot;
  VectorArray given;
  Field<double const> x;
  VectorArray gradient;

  [[nodiscard]] Index size() const { return Index(slot.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const s = slot(k);
    gradient.set(s, table.gradient(k, x, given[s], gradient[s]));
  }
};

/// Nodes that move as one: an owner per entry, and its images.
template <class MemorySpace>
struct JointNodes {
  JointSlipTable<MemorySpace> table;
  Kokkos::View<std::int32_t const*, MemorySpace> owner;
  Kokkos::View<Index const*, MemorySpace> first;              ///< (entries + 1)
  Kokkos::View<std::int32_t const*, MemorySpace> node, turn;  ///< per image
};
/// u = what the surfaces of all make of the owner's displacement, of the owner and of its images.
template <class MemorySpace, bool Rate>
struct HoldJointNodes {
  JointNodes<MemorySpace> nodes;
  Field<double const> x;
  Vec3 *u, *rate;

  [[nodiscard]] Index size() const { return Index(nodes.owner.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index const owner = nodes.owner(k);
    Vec3 v = u[owner], v_rate;
    if constexpr (Rate) v_rate = rate[owner];
    Vec3 const before = v;
    nodes.table.template constrain<Rate>(k, x, v, v_rate);
    if (!Rate && v == before) return;
    give(k, v, u);
    if constexpr (Rate) give(k, v_rate, rate);
  }

 private:
  KOKKOS_INLINE_FUNCTION void give(Index k, Vec3 const& v, Vec3* to) const {
    to[nodes.owner(k)] = v;
    for (Index m = nodes.first(k); m < nodes.first(k + 1); ++m) {
      std::int32_t const turn = nodes.turn(m);
      to[nodes.node(m)] = turn < 0 ? v : nodes.table.turns(turn) * v;
    }
  }
};
/// Keeps the owners' displacements that HoldJointNodes is about to start from, for its transpose.
template <class MemorySpace>
struct KeepJointNodes {
  JointNodes<MemorySpace> nodes;
  Vec3 const* u;
  Vec3* kept;
  [[nodiscard]] Index size() const { return Index(nodes.owner.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { kept[k] = u[nodes.owner(k)]; }
};
/// Transpose of HoldJointNodes: all gradients go to the owner.
template <class MemorySpace>
struct HoldJointNodesBack {
  JointNodes<MemorySpace> nodes;
  Field<double const> x;
  Vec3 const* kept;
  Vec3* g;
  [[nodiscard]] Index size() const { return Index(nodes.owner.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Vec3 sum = g[nodes.owner(k)];
    for (Index m = nodes.first(k); m < nodes.first(k + 1); ++m) {
      std::int32_t const turn = nodes.turn(m);
      Vec3& own = g[nodes.node(m)];
      sum += turn < 0 ? own : transpose(nodes.table.turns(turn)) * own;
      own = {};
    }
    g[nodes.owner(k)] = nodes.table.gradient(k, x, kept[k], sum);
  }
};

}  // namespace gridmorph::kernels
