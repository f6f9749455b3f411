// A tree of boxes over many things of very different size, and its two questions: which boxes hold a point, and which
// thing is nearest to it.
//
// The things stand in the order of a space-filling curve through the centres of their boxes. Group g of level 0 holds
// the boxes of things 8 g ... 8 g + 7, group g of level l + 1 the boxes of groups 8 g ... 8 g + 7 of level l: numbers
// say it all, there are no links, and all groups of a level are made side by side. Boxes follow the things, whatever
// their sizes and shapes are; the depth is log8(n). Boxes are kept in single precision, rounded outwards: 27 bytes per
// thing in all.
//
// Order: the Hilbert curve (C. Hamilton, Compact Hilbert indices, 2006), 2^21 steps per axis. Things that follow one
// another on it are neighbours, and groups compact; Z order jumps and makes groups that overlap.
#pragma once

#include <gridmorph/kernels/lanes.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <Kokkos_Core.hpp>

#include <cstdint>

namespace gridmorph::kernels {

/// An axis-parallel box; empty as long as nothing is included.
struct Box {
  Vec3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  KOKKOS_INLINE_FUNCTION void include(Vec3 const& p) {
    low = {smaller(low.x, p.x), smaller(low.y, p.y), smaller(low.z, p.z)};
    high = {larger(high.x, p.x), larger(high.y, p.y), larger(high.z, p.z)};
  }
};

/// Steps of a lattice of 2^21 to an axis: those of a point from `low`, `steps` of them to a unit of length. Points
/// outside count as those on its limit.
struct LatticePlace {
  static constexpr int bits = 21;
  std::uint32_t x, y, z;

  KOKKOS_INLINE_FUNCTION LatticePlace(Vec3 const& p, Vec3 const& low, Vec3 const& steps)
      : x(step((p.x - low.x) * steps.x)), y(step((p.y - low.y) * steps.y)), z(step((p.z - low.z) * steps.z)) {}

 private:
  KOKKOS_INLINE_FUNCTION static std::uint32_t step(double at) {
    constexpr double last = double((1 << bits) - 1);
    return std::uint32_t(at > 0 ? (at < last ? at : last) : 0.0);
  }
};

/// Rules of the Hilbert curve. A state is the corner by which the curve enters a cube and the axis along which it
/// leaves, entry + 8 * axis; next[state][part] is 8 * (state in that eighth) + its number along the curve.
struct HilbertRules {
  std::uint8_t next[24][8];
};

KOKKOS_INLINE_FUNCTION constexpr HilbertRules hilbert_rules() {
  constexpr unsigned axis_of[8] = {0, 1, 1, 2, 2, 1, 1, 0};
  constexpr unsigned entry_of[8] = {0, 0, 0, 3, 3, 6, 6, 5};
  constexpr unsigned number_of_gray[8] = {0, 1, 3, 2, 7, 6, 4, 5};
  HilbertRules rules{};
  for (unsigned axis = 0; axis < 3; ++axis)
    for (unsigned entry = 0; entry < 8; ++entry)
      for (unsigned part = 0; part < 8; ++part) {
        unsigned const turn = (axis + 1) % 3, seen = part ^ entry;
        unsigned const number = number_of_gray[(seen >> turn | seen << (3 - turn)) & 7u];
        unsigned const e = entry_of[number];
        unsigned const next_entry = entry ^ ((e << turn | e >> (3 - turn)) & 7u);
        unsigned const next_axis = (axis + axis_of[number] + 1) % 3;
        rules.next[entry + 8 * axis][part] = std::uint8_t(8 * (next_entry + 8 * next_axis) + number);
      }
  return rules;
}

/// Place on the Hilbert curve through the lattice.
KOKKOS_INLINE_FUNCTION std::uint64_t hilbert_code(LatticePlace const& p) {
  constexpr HilbertRules rules = hilbert_rules();
  unsigned state = 0;
  std::uint64_t code = 0;
  for (int level = LatticePlace::bits - 1; level >= 0; --level) {
    unsigned const part = (p.x >> level & 1u) | (p.y >> level & 1u) << 1 | (p.z >> level & 1u) << 2;
    unsigned const next = rules.next[state][part];
    code = code << 3 | (next & 7u);
    state = next >> 3;
  }
  return code;
}

/// Place in Z order (G. Morton, 1966): the bits of x, y, z in turn. Cheaper, but neighbours along it can be far apart.
KOKKOS_INLINE_FUNCTION std::uint64_t z_code(LatticePlace const& p) {
  auto const spread = [](std::uint64_t a) {
    a = (a | a << 32) & 0x1f00000000ffffull;
    a = (a | a << 16) & 0x1f0000ff0000ffull;
    a = (a | a << 8) & 0x100f00f00f00f00full;
    a = (a | a << 4) & 0x10c30c30c30c30c3ull;
    return (a | a << 2) & 0x1249249249249249ull;
  };
  return spread(p.x) | spread(p.y) << 1 | spread(p.z) << 2;
}

/// A point in single precision, rounded down and up: what holds it holds both or lies between.
struct RoundedPoint {
  float low[3], high[3];

  KOKKOS_INLINE_FUNCTION explicit RoundedPoint(Vec3 const& p)
      : low{down(p.x), down(p.y), down(p.z)}, high{-down(-p.x), -down(-p.y), -down(-p.z)} {}
  /// A step of single precision is at most 1.2e-7 of the number, and 1e-45 next to zero.
  KOKKOS_INLINE_FUNCTION static float down(double a) {
    constexpr double most = 3e38;
    if (!(a > -most)) return -HUGE_VALF;
    return float(a < most ? a - (1.3e-7 * (a < 0 ? -a : a) + 1e-44) : most);
  }
};

/// Boxes of eight things or groups, side by side.
struct BoxGroup {
  static constexpr int width = 8, shift = 3;
  float low[3][width], high[3][width];

  KOKKOS_INLINE_FUNCTION void set(int k, Box const& box) {
    RoundedPoint const l(box.low), h(box.high);
    for (int a = 0; a < 3; ++a) {
      low[a][k] = l.low[a];
      high[a][k] = h.high[a];
    }
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

  /// The boxes that hold a point or are next to it: bit k for box k.
  KOKKOS_INLINE_FUNCTION unsigned holding(RoundedPoint const& p) const {
#if defined(__GNUC__) && !defined(__CUDACC__) && !defined(__HIPCC__)
    // Four boxes at once, which compilers do not do on their own.
    constexpr int n = 4;
    using Floats [[gnu::vector_size(n * sizeof(float))]] = float;
    using Bits [[gnu::vector_size(n * sizeof(float))]] = int;
    auto const four = [&](int k, Bits const& bit) {
      auto const between = [&](int a) {
        Floats l, h;
        __builtin_memcpy(&l, low[a] + k, sizeof l);
        __builtin_memcpy(&h, high[a] + k, sizeof h);
        return ((Floats{} + p.high[a]) >= l) & ((Floats{} + p.low[a]) <= h);
      };
      return between(0) & between(1) & between(2) & bit;
    };
    static_assert(width == 2 * n);
    Bits const in = four(0, Bits{1, 2, 4, 8}) | four(n, Bits{16, 32, 64, 128});
    return unsigned((in[0] | in[1]) | (in[2] | in[3]));
#else
    unsigned bits = 0;
    for (int k = 0; k < width; ++k) {
      unsigned const in = unsigned(p.high[0] >= low[0][k]) & unsigned(p.low[0] <= high[0][k]) &
                          unsigned(p.high[1] >= low[1][k]) & unsigned(p.low[1] <= high[1][k]) &
                          unsigned(p.high[2] >= low[2][k]) & unsigned(p.low[2] <= high[2][k]);
      bits |= in << k;
    }
    return bits;
#endif
  }
  /// Squares of the distances to the boxes, never too large; infinite to empty ones.
  KOKKOS_INLINE_FUNCTION void distances2(RoundedPoint const& p, float* out) const {
    constexpr float safe = 1 - 1e-6f, most = 3e38f;
    for (int k = 0; k < width; ++k) {
      float sum = 0;
      for (int a = 0; a < 3; ++a) {
        float const before = low[a][k] - p.high[a], behind = p.low[a] - high[a][k];
        float const away = before > behind ? before : behind;
        sum += away > 0 ? away * away : 0.0f;
      }
      sum *= safe;
      sum = sum < most ? sum : most;
      out[k] = low[0][k] <= high[0][k] ? sum : HUGE_VALF;
    }
  }
};

/// A tree of boxes. Borrows its groups.
struct BoxTreeView {
  static constexpr int max_levels = 11;  ///< 8^11 things

  BoxGroup const* groups = nullptr;     ///< level after level
  std::int64_t first[max_levels] = {};  ///< number of each level's first group
  int n_levels = 0;                     ///< the last one has one group; 0: no things

  /// Calls visit(thing) for all things whose boxes hold p, in their order.
  template <class Visit>
  KOKKOS_INLINE_FUNCTION void for_each_holding(Vec3 const& p, Visit const& visit) const {
    if (n_levels == 0) return;
    RoundedPoint const rounded(p);
    unsigned pending[max_levels];
    int level = n_levels - 1;
    std::int64_t group = 0;
    pending[level] = groups[first[level]].holding(rounded);
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
      pending[level] = groups[first[level] + group].holding(rounded);
    }
  }

  /// Calls visit(thing) for things in about the order of the distance of their boxes, as long as that is not larger
  /// than limit(), the square of the best distance so far. Distances above 1e19 count as that.
  template <class Visit, class Limit>
  KOKKOS_INLINE_FUNCTION void for_each_nearer(Vec3 const& p, Visit const& visit, Limit const& limit) const {
    if (n_levels == 0) return;
    RoundedPoint const rounded(p);
    float away[max_levels][BoxGroup::width];  // infinite: empty or done
    int level = n_levels - 1;
    std::int64_t group = 0;
    groups[first[level]].distances2(rounded, away[level]);
    for (;;) {
      int nearest = -1;
      float least = HUGE_VALF;
      for (int k = 0; k < BoxGroup::width; ++k) {
        if (!(away[level][k] < least)) continue;
        nearest = k;
        least = away[level][k];
      }
      if (nearest < 0 || double(least) > limit()) {
        if (++level == n_levels) return;
        group >>= BoxGroup::shift;
        continue;
      }
      away[level][nearest] = HUGE_VALF;
      std::int64_t const child = (group << BoxGroup::shift) + nearest;
      if (level == 0) {
        visit(child);
        continue;
      }
      --level;
      group = child;
      groups[first[level] + group].distances2(rounded, away[level]);
    }
  }
};

}  // namespace gridmorph::kernels

// Boxes are a word of the library, like the vectors of vec3.hpp.
namespace gridmorph {
using kernels::Box;
}  // namespace gridmorph
