// How the near field of a wall of blocks turns, line by line. A root is the slot that a line of the near field stands
// on.
//
//   free    the wall's rotation there (wall_turn.hpp), over all near-field walls that touch, across the edges of blocks
//             Where the wall is sharp, its faces' normals after count as long as they were before (sharpness()); where
//             faces lie on one another, as at the ends of a tip that is a line, as those of one side
//   raw     free, the way round that is nearer to the mean of its body (way_near(), body_turn.hpp): near half a turn
//             some nodes of a body that is deformed besides turn by 179 degrees and some by 181
//             At an edge of the wall, where its faces may turn differently, no further than the line keeps a share of
//             its height above each of the faces, as far as it would keep it without a turn; as far as free where the
//             wall turns beyond 150 degrees
//   inner   raw, corrected towards end walls so that lines that stand beside one stay on it:
//             (sum over its ends of (1 - c1(h / H)) alpha) raw
//           alpha at the end: onto a slip surface the smallest rotation that takes raw N to N', N its normal there
//           before and after; onto a wall that a rule moves its own rotation after raw's inverse
//   outer   turn * raw, where lines along the wall run between two slip surfaces turn * (Align(raw N -> N') raw), N
//           mixed by span fraction: the outer edge turns about the spanwise direction alone
//
// From raw on all keeps the way round that raw goes (turn_on()).
//
// written for V = Vec3, or V = DualVec3 for exact rates of all but the curvature of slip surfaces, which is a
// difference. Cost: surfaces; per root about 500 flops and its neighbours read from cache.
#pragma once

#include <gridmorph/kernels/body_turn.hpp>
#include <gridmorph/kernels/kept_height.hpp>
#include <gridmorph/kernels/slip_surface.hpp>
#include <gridmorph/kernels/wall_turn.hpp>

namespace gridmorph::kernels {

struct RootNeighbour {
  Index slot;
  std::int32_t matrix;  ///< frame of its slot -> frame of the root's, -1: the same
  Vec3 arm;             ///< from the root to it, frame of the root's slot
};

/// Neighbours are pairs as in wall_turn.hpp.
struct Root {
  Index slot;
  Index centre;  ///< slot, of the same frame, whose neighbours these are: its own, or another one's whose turn it makes
  Index first_neighbour;
  std::int32_t n_neighbours;
  std::int32_t stands;  ///< a line of the near field stands on it; otherwise it is there for RootEnd::wall alone
  double turn;          ///< share of its turn that the outer edge of the near field makes
  Vec3 line;  ///< unit, along its first edge or against it, as the wall's normals; zero but at an edge of the wall
  std::int32_t body = -1;  ///< whose mean rotation says which way round it turns; -1: none, the shorter one
};

/// An end wall where a wall's grid lines end. Rotations and normals of it are in the frame of its root's slot.
struct EndWall {
  std::int32_t root = -1;     ///< on the end wall and the wall
  std::int32_t wall = -1;     ///< root whose neighbours are the end wall's own, -1: a slip surface
  std::int32_t surface = -1;  ///< slip surface
  std::int32_t to_zone = -1;  ///< frame of the slot -> frame of the surface
  Vec3 position;              ///< of the root, frame of the surface
};

/// An end wall beside a root, at the end of the wall's grid line through it.
struct RootEnd {
  std::int32_t end = -1;      ///< -1: none
  std::int32_t to_root = -1;  ///< frame of the end's slot -> frame of this root's slot
  double share = 0;           ///< 1 - c1(h / H)
};
struct RootEnds {
  RootEnd end[2];
  double fraction = -1;  ///< of the way from end 0 to end 1 where one line runs between them, otherwise negative
};

template <class MemorySpace>
struct RootTable {
  Kokkos::View<Root const*, MemorySpace> roots;
  Kokkos::View<RootNeighbour const*, MemorySpace> neighbours;
  Kokkos::View<RootEnds const*, MemorySpace> ends;  ///< per root
  Kokkos::View<EndWall const*, MemorySpace> end_walls;
  Kokkos::View<SlipSurfaceView const*, MemorySpace> surfaces;
  Kokkos::View<Mat3 const*, MemorySpace> matrices;

  KOKKOS_INLINE_FUNCTION Vec3 in_frame(std::int32_t matrix, Vec3 const& v) const {
    return matrix < 0 ? v : matrices(matrix) * v;
  }
  KOKKOS_INLINE_FUNCTION DualVec3 in_frame(std::int32_t matrix, DualVec3 const& v) const {
    return {in_frame(matrix, v.value), in_frame(matrix, v.rate)};
  }
  KOKKOS_INLINE_FUNCTION Vec3 back(std::int32_t matrix, Vec3 const& v) const {
    return matrix < 0 ? v : transpose(matrices(matrix)) * v;
  }
  KOKKOS_INLINE_FUNCTION DualVec3 back(std::int32_t matrix, DualVec3 const& v) const {
    return {back(matrix, v.value), back(matrix, v.rate)};
  }
};

/// A vector per slot or root, with its rate where V has one.
template <class V>
struct VectorsWithRates {
  Field<double const> values, rates;
  KOKKOS_INLINE_FUNCTION V operator[](Index n) const {
    if constexpr (has_rate<V>)
      return {values[n], rates[n]};
    else
      return values[n];
  }
};
struct ClearVectors {
  Field<double> v;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { v.set(n, {}); }
};

/// Normals of faces that lie on one another add up to less than this share of their area.
inline constexpr double folded_walls = 1e-6;

/// How sharp a wall is at a root around which its faces have that area, from the sum of their normals: 0 where they
/// turn by less than some 18 degrees from its direction, 1 from 37 on.
KOKKOS_INLINE_FUNCTION double sharpness(Vec3 const& normal, double area) {
  double const share = area > 0 ? norm(normal) / area : 1, s = (0.95 - share) / 0.15;
  return s > 0 ? (s < 1 ? s * s * (3 - 2 * s) : 1) : 0;
}

/// What a face's normal after counts where the wall is so sharp; the normal itself, to the last bit, where nothing
/// stretches.
template <class V>
KOKKOS_INLINE_FUNCTION V counted(double sharp, V const& before, V const& after) {
  return sharp > 0 ? after + sharp * (as_long_as(before, after) - after) : after;
}

/// The arms of a root before and after. By differences of displacements: nothing turns where all are the same.
template <class MemorySpace, class V>
struct RootArms {
  RootTable<MemorySpace> const& table;
  VectorsWithRates<V> const& u;  ///< per slot
  Root const& root;

  KOKKOS_INLINE_FUNCTION V before(Index k) const { return V{table.neighbours(root.first_neighbour + k).arm}; }
  KOKKOS_INLINE_FUNCTION V after(Index k) const {
    RootNeighbour const& other = table.neighbours(root.first_neighbour + k);
    return V{other.arm} + (table.in_frame(other.matrix, u[other.slot]) - u[root.centre]);
  }
};

/// The rotation `free` of every root.
template <class MemorySpace, class V>
struct FreeRootTurn {
  RootTable<MemorySpace> table;
  VectorsWithRates<V> u;  ///< per slot
  Field<double> free;     ///< per root

  [[nodiscard]] Index size() const { return Index(table.roots.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const { free.set(r, written(turn_at(table.roots(r)))); }

 private:
  KOKKOS_INLINE_FUNCTION V turn_at(Root const& root) const {
    RootArms<MemorySpace, V> const arms{table, u, root};
    auto const before = [&](Index k) { return arms.before(k); };
    auto const after = [&](Index k) { return arms.after(k); };
    V normal{}, moved{};
    double area = 0;
    for (Index k = 0; k < root.n_neighbours; k += 2) {
      V const face = cross(before(k), before(k + 1));
      normal = normal + face;
      area += norm(value_of(face));
    }
    double const sharp = sharpness(value_of(normal), area);
    for (Index k = 0; k < root.n_neighbours; k += 2)
      moved = moved + counted(sharp, cross(before(k), before(k + 1)), cross(after(k), after(k + 1)));
    if (!(norm(value_of(normal)) > folded_walls * area)) add_one_side(root, before, after, normal, moved);
    V const swing = turn_between(normal, moved);
    auto const size = norm(moved);
    if (!(size > 0)) return swing;
    V const axis = (1 / size) * moved;
    ArmWeights const weight(root.n_neighbours, before);
    return turn_then(swing, twist_about(axis, swing, root.n_neighbours, before, after, weight));
  }
  /// Normals of faces that lie on one another, all towards the side of the first.
  template <class Before, class After>
  KOKKOS_INLINE_FUNCTION static void add_one_side(Root const& root, Before const& before, After const& after, V& normal,
                                                  V& moved) {
    normal = moved = V{};
    for (Index k = 0; k < root.n_neighbours; k += 2) {
      V const face = cross(before(k), before(k + 1));
      double const side = dot(value_of(face), value_of(normal)) < 0 ? -1 : 1;
      normal = normal + side * face;
      moved = moved + side * as_long_as(face, cross(after(k), after(k + 1)));
    }
  }
};

/// The rotation `raw` of every root.
template <class MemorySpace, class V>
struct RawRootTurn {
  RootTable<MemorySpace> table;
  VectorsWithRates<V> u;     ///< per slot
  VectorsWithRates<V> free;  ///< per root
  Field<double const> mean;  ///< rotations of bodies
  Field<double> raw;         ///< per root

  [[nodiscard]] Index size() const { return Index(table.roots.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Root const& root = table.roots(r);
    raw.set(r, written(kept(root, root.body < 0 ? free[r] : way_near(free[r], mean[root.body]))));
  }

 private:
  KOKKOS_INLINE_FUNCTION V kept(Root const& root, V const& turn) const {
    if (!(dot(root.line, root.line) > 0)) return turn;
    using Scalar = std::decay_t<decltype(dot(turn, turn))>;
    auto const held = held_back(dot(turn, turn));
    if (!(held > 0)) return turn;
    RootArms<MemorySpace, V> const arms{table, u, root};
    auto const share = share_that_keeps_height(
        root.line, turn, root.n_neighbours / 2,
        [&](Index k) { return cross(arms.before(2 * k), arms.before(2 * k + 1)); },
        [&](Index k) { return cross(arms.after(2 * k), arms.after(2 * k + 1)); });
    return held < 1 ? (Scalar{1} - held * (Scalar{1} - share)) * turn : share * turn;
  }
};

/// What is kept of each end wall: alpha, and its normal before and after where it is a slip surface.
template <class Vectors>
struct EndWallVectors {
  Vectors all;  ///< 3 per end wall
  KOKKOS_INLINE_FUNCTION auto alpha(Index e) const { return all[3 * e]; }
  KOKKOS_INLINE_FUNCTION auto normal(Index e) const { return all[3 * e + 1]; }
  KOKKOS_INLINE_FUNCTION auto moved(Index e) const { return all[3 * e + 2]; }
};

/// The rotation alpha of every end wall.
template <class MemorySpace, class V>
struct EndWallTurn {
  RootTable<MemorySpace> table;
  VectorsWithRates<V> u;    ///< per slot
  VectorsWithRates<V> raw;  ///< per root
  Field<double> out;        ///< 3 per end wall

  [[nodiscard]] Index size() const { return Index(table.end_walls.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index e) const {
    Found const found = at(e, u, raw);
    out.set(3 * e, written(found.alpha));
    out.set(3 * e + 1, written(found.before));
    out.set(3 * e + 2, written(found.after));
  }

  struct Found {
    V alpha{}, before{}, after{};
  };
  /// What end wall e is found to do by displacements u and rotations raw.
  template <class Displacements, class Rotations>
  KOKKOS_INLINE_FUNCTION Found at(Index e, Displacements const& u, Rotations const& raw) const {
    EndWall const& end = table.end_walls(e);
    Found found;
    if (end.wall >= 0) {
      found.alpha = turn_then(-raw[end.root], raw[end.wall]);
    } else {
      found.before = normal(end, V{});
      found.after = normal(end, u[table.roots(end.root).slot]);
      found.alpha = turn_between(found.before + turned_by(raw[end.root], found.before), found.after);
    }
    return found;
  }

 private:
  /// The normal of the surface where the displacement takes the end, in the frame of the end's slot.
  KOKKOS_INLINE_FUNCTION V normal(EndWall const& end, V const& displacement) const {
    V const there = table.in_frame(end.to_zone, displacement);
    if constexpr (has_rate<V>) {
      Vec3 const value = normal_at(end, there.value);
      if (!(norm(there.rate) > 0)) return table.back(end.to_zone, V{value});
      // Axis by axis, so that rates are linear to round-off, as their transpose takes them to be.
      double const step = 1e-5 * table.surfaces(end.surface).size;
      auto const along = [&](double rate, Vec3 const& axis) {
        if (rate == 0) return Vec3{};
        Vec3 const change = normal_at(end, there.value + step * axis) - normal_at(end, there.value - step * axis);
        return (rate / (2 * step)) * change;
      };
      return table.back(end.to_zone, V{value, along(there.rate.x, {1, 0, 0}) + along(there.rate.y, {0, 1, 0}) +
                                                  along(there.rate.z, {0, 0, 1})});
    } else {
      return table.back(end.to_zone, normal_at(end, there));
    }
  }
  KOKKOS_INLINE_FUNCTION Vec3 normal_at(EndWall const& end, Vec3 const& u) const {
    Vec3 n;
    table.surfaces(end.surface).excess(end.position, 0, u, n);
    double const size = norm(n);
    return size > 0 ? (1 / size) * n : n;
  }
};

/// The rotations `inner` of every root, to its slot, and `outer`.
template <class MemorySpace, class V>
struct NearFieldTurn {
  RootTable<MemorySpace> table;
  VectorsWithRates<V> raw;  ///< per root
  EndWallVectors<VectorsWithRates<V>> at_end;
  Field<double> inner;  ///< per slot
  Field<double> outer;  ///< per root

  [[nodiscard]] Index size() const { return Index(table.roots.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Root const& root = table.roots(r);
    if (root.stands == 0) return;
    RootEnds const& ends = table.ends(r);
    V correction{};
    for (RootEnd const& end : ends.end)
      if (end.end >= 0 && end.share > 0)
        correction = correction + end.share * table.in_frame(end.to_root, at_end.alpha(end.end));
    V const own = raw[r], turned = turn_on(own, correction);
    inner.set(root.slot, written(turned));
    outer.set(r, written(root.turn == 0 ? V{} : root.turn * section(ends, own, turned)));
  }

 private:
  /// The turn of the section: between two slip surfaces that about the spanwise direction alone, otherwise the turn
  /// itself.
  KOKKOS_INLINE_FUNCTION V section(RootEnds const& ends, V const& own, V const& turned) const {
    if (!(ends.fraction >= 0)) return turned;
    V before{}, after{};
    for (int m = 0; m < 2; ++m) {
      RootEnd const& end = ends.end[m];
      if (table.end_walls(end.end).surface < 0) return turned;
      V const n = table.in_frame(end.to_root, at_end.normal(end.end));
      double const share = m == 0 ? 1 - ends.fraction : ends.fraction;
      double const signed_share = m == 1 && dot(value_of(n), value_of(before)) < 0 ? -share : share;
      before = before + signed_share * n;
      after = after + signed_share * table.in_frame(end.to_root, at_end.moved(end.end));
    }
    return turn_on(own, turn_between(before + turned_by(own, before), after));
  }
};

}  // namespace gridmorph::kernels
