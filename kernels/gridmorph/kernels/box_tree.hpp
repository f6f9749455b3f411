// A tree of boxes over many things of very different size, and its two questions: which boxes hold a point, and which thing
// is nearest to it.
//
// The things stand in the order of a space-filling curve through the centres of their boxes. Group g of level 0 holds the
// boxes of things 8 g ... 8 g + 7, group g of level l + 1 the boxes of groups 8 g ... 8 g + 7 of level l: numbers say it
// all, there are no links, and all groups of a level are made side by side. Boxes follow the things, whatever their sizes
// and shapes are; the depth is log8(n). Boxes are kept in single precision, rounded outwards: 27 bytes per thing in all.
//
// Order: the Hilbert curve (C. Hamilton, Compact Hilbert indices, 2006), 2^21 steps per axis. Things that follow one another
// on it are neighbours, and groups compact; Z order jumps and makes groups that overlap.
#pragma once

#include <gridmorph/kernels/lanes.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <Kokkos_Core.hpp>

#include <cstdint>

namespace gridmorph {

/// An axis-parallel box; empty as long as nothing is included.
struct Box {
  Vec3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  KOKKOS_INLINE_FUNCTION void include(Vec3 const& p) {
    low = {smaller(low.x, p.x), smaller(low.y, p.y), smaller(low.z, p.z)};
    high = {larger(high.x, p.x), larger(high.y, p.y), larger(high.z, p.z)};
  }
};

/// Place of a point on the Hilbert curve through the box from `low`; `steps`: 2^21 over the size of the box along each axis.
/// Points outside count as those on its limit.
KOKKOS_INLINE_FUNCTION std::uint64_t hilbert_code(Vec3 const& p, Vec3 const& low, Vec3 const& steps) {
  constexpr int bits = 21;
  constexpr double last = double((1 << bits) - 1);
  auto const step = [](double at) { return std::uint32_t(at > 0 ? (at < last ? at : last) : 0.0); };
  std::uint32_t const x = step((p.x - low.x) * steps.x), y = step((p.y - low.y) * steps.y),
                      z = step((p.z - low.z) * steps.z);
  // Of the eight parts of a cube in their order: the axis along which the curve leaves the part, and the corner it enters.
  constexpr std::uint8_t axis_of[8] = {0, 1, 1, 2, 2, 1, 1, 0};
  constexpr std::uint8_t entry_of[8] = {0, 0, 0, 3, 3, 6, 6, 5};
  constexpr std::uint8_t number_of_gray[8] = {0, 1, 3, 2, 7, 6, 4, 5};
  std::uint32_t entry = 0, axis = 0;
  std::uint64_t code = 0;
  for (int level = bits - 1; level >= 0; --level) {
    std::uint32_t const part = (x >> level & 1u) | (y >> level & 1u) << 1 | (z >> level & 1u) << 2;
    std::uint32_t const turn = axis == 2 ? 0 : axis + 1;
    std::uint32_t const seen = part ^ entry;
    std::uint32_t const gray = (seen >> turn | seen << (3 - turn)) & 7u;
    std::uint32_t const number = number_of_gray[gray];
    code = code << 3 | number;
    std::uint32_t const e = entry_of[number];
    entry ^= (e << turn | e >> (3 - turn)) & 7u;
    axis += axis_of[number] + 1u;
    axis -= axis >= 3 ? 3 : 0;
    axis -= axis >= 3 ? 3 : 0;
  }
  return code;
}

/// Boxes of eight things or groups, side by side.
struct BoxGroup {
  static constexpr int width = 8, shift = 3;
  float low[3][width], high[3][width];

  KOKKOS_INLINE_FUNCTION void set(int k, Box const& box) {
    // One step of single precision is at most 1.2e-7 of the number, and 1e-45 next to zero.
    auto const down = [](double a) { return float(a - (1.3e-7 * (a < 0 ? -a : a) + 1e-44)); };
    low[0][k] = down(box.low.x);
    low[1][k] = down(box.low.y);
    low[2][k] = down(box.low.z);
    high[0][k] = -down(-box.high.x);
    high[1][k] = -down(-box.high.y);
    high[2][k] = -down(-box.high.z);
  }
  /// The box around all of a group's.
  KOKKOS_INLINE_FUNCTION void set(int k, BoxGroup const& of) {
    for (int a = 0; a < 3; ++a) {
      float least = of.low[a][0], most = of.high[a][0];
      for (int n = 1; n < width; ++n) {
        least = smaller(least, of.low[a][n]);
        most = larger(most, of.high[a][n]);
      }
      low[a][k] = least;
      high[a][k] = most;
    }
  }
  KOKKOS_INLINE_FUNCTION void set_empty(int k) {
    for (int a = 0; a < 3; ++a) {
      low[a][k] = HUGE_VALF;
      high[a][k] = -HUGE_VALF;
    }
  }

  /// Bit k: box k holds the point.
  KOKKOS_INLINE_FUNCTION unsigned holding(Vec3 const& p) const {
    unsigned bits = 0;
    for (int k = 0; k < width; ++k) {
      unsigned const in = unsigned(p.x >= low[0][k]) & unsigned(p.x <= high[0][k]) & unsigned(p.y >= low[1][k]) &
                          unsigned(p.y <= high[1][k]) & unsigned(p.z >= low[2][k]) & unsigned(p.z <= high[2][k]);
      bits |= in << k;
    }
    return bits;
  }
  /// Square of the distance to box k; infinite to an empty one.
  KOKKOS_INLINE_FUNCTION double distance2(int k, Vec3 const& p) const {
    auto const outside = [](double l, double h, double at) { return at < l ? l - at : at > h ? at - h : 0.0; };
    Vec3 const d{outside(low[0][k], high[0][k], p.x), outside(low[1][k], high[1][k], p.y),
                 outside(low[2][k], high[2][k], p.z)};
    return dot(d, d);
  }
};

/// Borrows its groups.
struct BoxTreeView {
  static constexpr int max_levels = 11;  ///< 8^11 things

  BoxGroup const* groups = nullptr;     ///< level after level
  std::int64_t first[max_levels] = {};  ///< number of each level's first group
  int n_levels = 0;                     ///< the last one has one group; 0: no things

  /// Calls visit(thing) for all things whose boxes hold p, in their order.
  template <class Visit>
  KOKKOS_INLINE_FUNCTION void for_each_holding(Vec3 const& p, Visit const& visit) const {
    if (n_levels == 0) return;
    unsigned pending[max_levels];
    int level = n_levels - 1;
    std::int64_t group = 0;
    pending[level] = groups[first[level]].holding(p);
    for (;;) {
      unsigned const bits = pending[level];
      if (bits == 0) {
        if (++level == n_levels) return;
        group >>= BoxGroup::shift;
        continue;
      }
      unsigned const bit = bits & (0u - bits);
      pending[level] = bits ^ bit;
      int const k = (bit & 0xaau ? 1 : 0) + (bit & 0xccu ? 2 : 0) + (bit & 0xf0u ? 4 : 0);
      std::int64_t const child = (group << BoxGroup::shift) + k;
      if (level == 0) {
        visit(child);
        continue;
      }
      --level;
      group = child;
      pending[level] = groups[first[level] + group].holding(p);
    }
  }

  /// Calls visit(thing) for things in about the order of the distance of their boxes, as long as that is not larger than
  /// limit(), the square of the best distance so far.
  template <class Visit, class Limit>
  KOKKOS_INLINE_FUNCTION void for_each_nearer(Vec3 const& p, Visit const& visit, Limit const& limit) const {
    if (n_levels == 0) return;
    float away[max_levels][BoxGroup::width];  // rounded down; below zero: done
    int level = n_levels - 1;
    std::int64_t group = 0;
    auto const look = [&] {
      BoxGroup const& here = groups[first[level] + group];
      for (int k = 0; k < BoxGroup::width; ++k) {
        double const d2 = here.distance2(k, p) * (1 - 1e-6);
        away[level][k] = here.low[0][k] > here.high[0][k] ? HUGE_VALF : float(smaller(d2, 3e38));
      }
    };
    look();
    for (;;) {
      int nearest = -1;
      float least = HUGE_VALF;
      for (int k = 0; k < BoxGroup::width; ++k) {
        if (away[level][k] < 0 || !(away[level][k] < least)) continue;
        nearest = k;
        least = away[level][k];
      }
      if (nearest < 0 || double(least) > limit()) {
        if (++level == n_levels) return;
        group >>= BoxGroup::shift;
        continue;
      }
      away[level][nearest] = -1;
      std::int64_t const child = (group << BoxGroup::shift) + nearest;
      if (level == 0) {
        visit(child);
        continue;
      }
      --level;
      group = child;
      look();
    }
  }
};

}  // namespace gridmorph
