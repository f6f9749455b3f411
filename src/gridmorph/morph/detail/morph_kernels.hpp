// The kernels of an unstructured morph, one per step of UnstructuredMorpher, in their order. Internal to unstructured.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/slip_edge.hpp>
#include <gridmorph/kernels/slip_surface.hpp>
#include <gridmorph/kernels/uniform_lattice.hpp>
#include <gridmorph/kernels/wall_turn.hpp>
#include <gridmorph/morph/detail/inverse_distance_views.hpp>

#include <cmath>

namespace gridmorph::detail {

template <class MemorySpace>
struct Lists {
  View<MemorySpace, Index> first;
  View<MemorySpace, Index32> item;

  Lists() = default;
  Lists(CsrGraph const& lists, char const* label)
      : first(copy_of<MemorySpace>(lists.first, label)), item(copy_of<MemorySpace>(lists.item, label)) {}
};

/// Position of a node: of the baseline, or moved by what it is displaced by so far.
struct Positions {
  kernels::Field<double const> x;
  Vec3 const* u = nullptr;
  KOKKOS_INLINE_FUNCTION Vec3 operator[](Index n) const { return u == nullptr ? x[n] : x[n] + u[n]; }
};

/// Area-weighted normal of the wall around a node: sum of (a - x) x (b - x) over its faces; in 2-D of (b - a) x plane normal
/// over its edges.
template <class MemorySpace>
struct WallNormal {
  View<MemorySpace, Index32> roots;
  Lists<MemorySpace> fans;
  bool flat;
  Vec3 across;

  KOKKOS_INLINE_FUNCTION Vec3 operator()(Index r, Positions const& at) const {
    Vec3 const x = at[roots(r)];
    Vec3 sum;
    for (Index k = fans.first(r); k < fans.first(r + 1); k += 2) {
      Vec3 const a = at[fans.item(k)], b = at[fans.item(k + 1)];
      sum += flat ? cross(b - a, across) : cross(a - x, b - x);
    }
    return sum;
  }
};

/// How the wall turns at its nodes, as axis times angle: the smallest rotation of its normal, then about the normal the mean turn
/// of the nodes around.
template <class MemorySpace>
struct WallTurn {
  WallNormal<MemorySpace> normal;
  View<MemorySpace, std::uint8_t> turns;
  Positions baseline, moved;
  View<MemorySpace, Vec3> turn;
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    using std::atan2;
    if (turns(r) == 0) {
      turn(r) = {};
      return;
    }
    Vec3 const after = normal(r, moved);
    Vec3 const swing = kernels::turn_between(normal(r, baseline), after);
    double const size = norm(after);
    if (normal.flat || !(size > 0)) {
      turn(r) = swing;
      return;
    }
    Vec3 const axis = (1 / size) * after;
    Vec3 const x = baseline[normal.roots(r)], y = moved[normal.roots(r)];
    double sine = 0, cosine = 0;
    for (Index k = normal.fans.first(r); k < normal.fans.first(r + 1); ++k) {
      Vec3 const before = baseline[normal.fans.item(k)] - x;
      Vec3 const p = before + kernels::turned_by(swing, 1, before), q = moved[normal.fans.item(k)] - y;
      sine += dot(axis, cross(p, q));
      cosine += dot(p, q) - dot(p, axis) * dot(q, axis);
    }
    turn(r) = kernels::turn_then(swing, atan2(sine, cosine) * axis);
  }
};

/// The motion of the wall around its nodes.
template <class MemorySpace>
struct WallFrames {
  View<MemorySpace, Index32> node;
  View<MemorySpace, Vec3> turn, u;
  View<MemorySpace, AffineMotion> frame;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { frame(k) = {u(node(k)), kernels::turn_gradient(turn(k))}; }
};

template <class MemorySpace>
struct MoveColumns {
  View<MemorySpace, Index32> node, root, driving;
  View<MemorySpace, float> share;
  View<MemorySpace, Vec3> turn;
  kernels::Field<double const> x;
  View<MemorySpace, Vec3> u;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index32 const wall = driving(root(k));
    u(node(k)) = u(wall) + kernels::turned_by(turn(root(k)), share(k), x[node(k)] - x[wall]);
  }
};

template <class MemorySpace>
struct ScatterSlots {
  View<MemorySpace, Index32> slots, nodes;
  Kokkos::View<Vec3 const*, MemorySpace> boundary;
  View<MemorySpace, Vec3> u;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { u(nodes(slots(k))) = boundary(slots(k)); }
};

template <class MemorySpace>
struct AddFaded {
  View<MemorySpace, Index32> node;
  View<MemorySpace, float> fade;
  View<MemorySpace, Vec3> add, u;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { u(node(k)) += double(fade(k)) * add(node(k)); }
};

/// What the field so far lacks at nodes whose displacement is given.
template <class MemorySpace>
struct GivenMisses {
  View<MemorySpace, Index32> node, slot;
  Kokkos::View<Vec3 const*, MemorySpace> boundary;
  View<MemorySpace, Vec3> u, left, listed;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Vec3 const r = boundary(slot(k)) - u(node(k));
    left(node(k)) = r;
    listed(k) = r;
  }
};

/// What nodes that slide or have images begin with: the field so far and the faded residual of given nodes.
template <class MemorySpace>
struct StartOthers {
  View<MemorySpace, Index32> node;
  View<MemorySpace, float> fade, detail_fade;
  UniformLattice shape;
  View<MemorySpace, Vec3> lattice;
  kernels::Field<double const> x;
  View<MemorySpace, Vec3> u, start;  ///< in `start` what the lattice misses, where detail_fade is not zero
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index32 const n = node(k);
    Vec3 v = u(n);
    if (fade(k) != 0) v += double(fade(k)) * shape.at(lattice.data(), x[n]);
    if (detail_fade(k) != 0) v += double(detail_fade(k)) * start(n);
    start(n) = v;
  }
};

/// What boundaries beyond the moving walls ask for, by rule or by the surface they slide on.
template <class MemorySpace>
struct AskOthers {
  View<MemorySpace, Index32> node, slot;
  Lists<MemorySpace> surfaces_of;
  View<MemorySpace, SlipSurfaceView> surfaces;
  Kokkos::View<Vec3 const*, MemorySpace> boundary;
  kernels::Field<double const> x;
  View<MemorySpace, Vec3> asked;  ///< with what nodes without a slot begin with
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index32 const n = node(k);
    asked(n) = on_its_surfaces(k, x[n], slot(k) >= 0 ? boundary(slot(k)) : asked(n));
  }

 private:
  /// What slide_along_edge() asks of one node.
  struct Surfaces {
    AskOthers const& others;
    Index from;
    KOKKOS_INLINE_FUNCTION SlipSurfaceView const& operator()(int m) const {
      return others.surfaces(others.surfaces_of.item(from + m));
    }
  };
  struct Offsets {
    Surfaces const& surface;
    Vec3 const& baseline;
    KOKKOS_INLINE_FUNCTION double operator()(int m) const { return surface(m).own_offset(baseline); }
  };

  /// One after another, which is exact for planes at right angles; where that does not settle, along their edge.
  KOKKOS_INLINE_FUNCTION Vec3 on_its_surfaces(Index k, Vec3 const& baseline, Vec3 v) const {
    constexpr int most_rounds = 3;
    Surfaces const surface{*this, surfaces_of.first(k)};
    int const count = int(surfaces_of.first(k + 1) - surface.from);
    for (int round = 0; round < (count > 1 ? most_rounds : 1); ++round) {
      Vec3 const before = v;
      for (int m = 0; m < count; ++m) v = surface(m).constrain(baseline, v);
      if (count < 2 || v == before) return v;
    }
    kernels::slide_along_edge(count, surface, Offsets{surface, baseline}, baseline, v);
    return v;
  }
};

/// Nodes behind periodic boundaries move by the mean over their class, or as the one whose displacement a rule gives.
template <class MemorySpace>
struct PeriodicMean {
  View<MemorySpace, Index32> owner, image_node;
  View<MemorySpace, std::int32_t> image_rotation;
  View<MemorySpace, std::uint8_t> owner_known;
  Lists<MemorySpace> images_of;
  View<MemorySpace, Mat3> rotations;
  View<MemorySpace, Vec3> asked;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Vec3 mean = asked(owner(k));
    Index const from = images_of.first(k), to = images_of.first(k + 1);
    if (owner_known(k) == 0) {
      Vec3 const base = mean;
      Vec3 sum;
      for (Index i = from; i < to; ++i) {
        Index32 const image = images_of.item(i);
        Vec3 const v = asked(image_node(image));
        sum += (image_rotation(image) < 0 ? v : transpose(rotations(image_rotation(image))) * v) - base;
      }
      mean = base + (1.0 / double(to - from + 1)) * sum;
      asked(owner(k)) = mean;
    }
    for (Index i = from; i < to; ++i) {
      Index32 const image = images_of.item(i);
      asked(image_node(image)) = image_rotation(image) < 0 ? mean : rotations(image_rotation(image)) * mean;
    }
  }
};

/// u becomes what is asked for; what it lacked is left in `asked` to spread.
template <class MemorySpace>
struct TakeOthers {
  View<MemorySpace, Index32> node;
  View<MemorySpace, Vec3> u, asked;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Vec3 const before = u(node(k));
    u(node(k)) = asked(node(k));
    asked(node(k)) = asked(node(k)) - before;
  }
};

/// What a smooth field misses of given values: left(n) = value(n) - smooth(x_n).
template <class MemorySpace>
struct SmoothMisses {
  View<MemorySpace, Index32> node;
  UniformLattice shape;
  View<MemorySpace, Vec3> lattice;
  kernels::Field<double const> x;
  View<MemorySpace, Vec3> value, left;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index32 const n = node(k);
    left(n) = value(n) - shape.at(lattice.data(), x[n]);
  }
};

/// The smooth field and a share of what it misses.
template <class MemorySpace>
struct SmoothAndMissing {
  View<MemorySpace, Index32> node;
  View<MemorySpace, float> fade;
  UniformLattice shape;
  View<MemorySpace, Vec3> lattice;
  kernels::Field<double const> x;
  View<MemorySpace, Vec3> missing, u;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Index32 const n = node(k);
    u(n) = shape.at(lattice.data(), x[n]) + double(fade(k)) * missing(n);
  }
};

template <class MemorySpace>
struct AddResidual {
  View<MemorySpace, float> fade;
  UniformLattice shape;
  View<MemorySpace, Vec3> lattice;
  kernels::Field<double const> x;
  View<MemorySpace, Vec3> u;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    double const f = fade(n);
    if (f != 0) u(n) += f * shape.at(lattice.data(), x[n]);
  }
};

/// Values of nodes, one after another.
template <class MemorySpace>
struct PickNodes {
  View<MemorySpace, Index32> node;
  View<MemorySpace, Vec3> from, to;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { to(k) = from(node(k)); }
};

/// Nodes that nothing reaches stay.
template <class MemorySpace>
struct RestNodes {
  View<MemorySpace, Vec3> u;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { u(n) = Vec3{}; }
};

template <class MemorySpace>
struct CopyNodes {
  View<MemorySpace, Index32> to, from;
  View<MemorySpace, Vec3> u;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { u(to(k)) = u(from(k)); }
};

template <class MemorySpace, bool Move>
struct WriteNodes {
  View<MemorySpace, Vec3> u;
  kernels::Field<double const> x;
  kernels::Field<double> out;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { out.set(n, Move ? x[n] + u(n) : u(n)); }
};

}  // namespace gridmorph::detail
