// The transfinite correction (side_correction.hpp) for a row of nodes inside a chain at once.
//
// A node reads the residual of a side line between two of its nodes, at the same fraction t of the length. Along a row
// these two stay the same for long, counted
//
//   - on one line, where the row runs across it,
//   - from neighbour to neighbour on one line, where it runs along the chain,
//   - at one position of line after line, where it runs from one to the next (Side::across has these side by side),
//
// so that nodes are taken in groups, without a search and with neighbours in memory. Each chooses between the intervals
// below and above one node of the side line: a row keeps changing between these wherever the mesh is as even as its
// sides and only rounding decides.
//
// Cost per node and line read: some 12 flops and two comparisons, and two searches where a group leaves both intervals.
#pragma once

#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/kernels/lanes.hpp>
#include <gridmorph/kernels/side_correction.hpp>
#include <gridmorph/kernels/tile.hpp>

namespace gridmorph::kernels {

template <int width>
struct VectorRow {
  double x[width], y[width], z[width];
};

/// Nodes w = 0 ... n - 1 at (s + w ds, a + w da, b + w db) of a chain and fractions t[w] of their lines; none of them
/// on a side of the chain.
template <class MemorySpace, int width>
struct RowCorrection {
  SideTable<MemorySpace> const& table;
  Chain const& chain;
  int s, ds, a, da, b, db;
  double const* t;
  int n;

  /// v += correction, in the frame of the chain.
  KOKKOS_INLINE_FUNCTION void add_to(VectorRow<width>& v) const {
    double A[width], B[width];
    if (!chain.blends_along(1)) fractions(0, A);
    if (!chain.blends_along(0)) fractions(1, B);
    if constexpr (width == 1) {
      each_lookup([&](Lookup const& of) { add(of, A, B, v); });
    } else {
      // What is added stands once in the code then.
      Lookup lookups[8];
      int count = 0;
      each_lookup([&](Lookup const& of) { lookups[count++] = of; });
      for (int m = 0; m < count; ++m) add(lookups[m], A, B, v);
    }
  }

 private:
  /// How much of a side or edge comes to a node by one direction across.
  enum class Share { whole, of_lower, of_upper };

  /// The lines that the nodes of a row read. Node p of the line of node w of the row is at first + p along + w between.
  struct Lookup {
    Index first, along, between;
    Share share_a, share_b;
  };

  template <class Visit>
  KOKKOS_INLINE_FUNCTION void each_lookup(Visit const& visit) const {
    bool const only_a = chain.blends_along(0), only_b = chain.blends_along(1);
    unsigned const known = chain.known_sides;
    for (int side = 0; side < 4; ++side) {
      bool const reads =
          only_a || only_b ? (side < 2) == only_a && chain.side_matters(side) : ((known >> side) & 1u) != 0;
      if (!reads) continue;
      Share const of_side = side % 2 == 0 ? Share::of_lower : Share::of_upper;
      visit(lookup(side, side < 2 ? of_side : Share::whole, side < 2 ? Share::whole : of_side));
    }
    if (only_a || only_b) return;
    // Sides have what is beyond their edges, so that edges come in once, by the products of both shares.
    for (int e = 0; e < 4; ++e) {
      if (!((known >> (4 + e)) & 1u)) continue;
      int const side = e & 1, w = (e & 2) != 0 ? chain.n_b - 1 : 0;
      visit(Lookup{table.sides(chain.first_side + side).first + Index(chain.n_s) * w, 1, 0,
                   side == 0 ? Share::of_lower : Share::of_upper, (e & 2) == 0 ? Share::of_lower : Share::of_upper});
    }
  }
  KOKKOS_INLINE_FUNCTION Lookup lookup(int side, Share share_a, Share share_b) const {
    Side const& of = table.sides(chain.first_side + side);
    int const w = side < 2 ? b : a, step = side < 2 ? db : da;
    if (step != 0 && of.across >= 0) return {of.across + w, of.n_w, step, share_a, share_b};
    return {of.first + Index(chain.n_s) * w, 1, Index(chain.n_s) * step, share_a, share_b};
  }

  KOKKOS_FORCEINLINE_FUNCTION static double share(Share of, double fraction) {
    return of == Share::of_upper ? fraction : 1 - fraction;
  }
  KOKKOS_INLINE_FUNCTION void weights(Lookup const& of, double const* A, double const* B, double* weight) const {
    if (of.share_a == Share::whole)
      for (int w = 0; w < n; ++w) weight[w] = share(of.share_b, B[w]);
    else if (of.share_b == Share::whole)
      for (int w = 0; w < n; ++w) weight[w] = share(of.share_a, A[w]);
    else
      for (int w = 0; w < n; ++w) weight[w] = share(of.share_a, A[w]) * share(of.share_b, B[w]);
  }

  /// Arc-length fractions across the chain (SideTable::across) of all nodes.
  KOKKOS_INLINE_FUNCTION void fractions(int direction, double* fraction) const {
    Index const plane = chain.section_size();
    double const* const at_lower =
        table.section.data() + chain.first_section + 2 * direction * plane + a + Index(chain.n_a) * b;
    double const* const at_upper = at_lower + plane;
    Index const step = da + Index(chain.n_a) * db;
    if (step == 0)
      for (int w = 0; w < n; ++w) fraction[w] = (1 - t[w]) * at_lower[0] + t[w] * at_upper[0];
    else if (step == 1)
      for (int w = 0; w < n; ++w) fraction[w] = (1 - t[w]) * at_lower[w] + t[w] * at_upper[w];
    else
      for (int w = 0; w < n; ++w) fraction[w] = (1 - t[w]) * at_lower[w * step] + t[w] * at_upper[w * step];
  }

  /// v += weight (residual of the lines).
  KOKKOS_INLINE_FUNCTION void add(Lookup const& of, double const* A, double const* B, VectorRow<width>& v) const {
    double weight[width];
    weights(of, A, B, weight);
    if constexpr (width == 1) {
      add_one(of, 0, interval(of, 0, s), weight, v);
    } else {
      // From one node of the row to the next, on the line and from line to line; one of both stands still.
      Index const step = ds * of.along + of.between;
      if (step == 0)
        add_by_lanes(Constant<0>(), of, weight, v);
      else if (step == 1)
        add_by_lanes(Constant<1>(), of, weight, v);
      else if (step == -1)
        add_by_lanes(Constant<-1>(), of, weight, v);
      else
        for (int w = 0, guess = s; w < n; ++w) add_one(of, w, guess = interval(of, w, guess), weight, v);
    }
  }
  /// What node w of the row is after, on its own line.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION int interval(Lookup const& of, int w, int guess) const {
    return table.interval(of.first + w * of.between, chain.n_s - 1, t[w], guess, of.along);
  }
  KOKKOS_INLINE_FUNCTION void add_one(Lookup const& of, int w, int lower, double const* weight,
                                      VectorRow<width>& v) const {
    Index const at = of.first + w * of.between + lower * of.along;
    double const f = (t[w] - table.t(at)) * table.per_t(at);
    Vec3 const c = table.c[at], rise = table.c[at + of.along] - c;
    v.x[w] += weight[w] * (c.x + f * rise.x);
    v.y[w] += weight[w] * (c.y + f * rise.y);
    v.z[w] += weight[w] * (c.z + f * rise.z);
  }

  /// Two neighbouring intervals of the lines, as groups of nodes read them. Positions are those that node 0 of the row
  /// would have: they go along with it.
  struct Window {
    int middle = -1, guess = 0;
    int begin = 0, end = 0;  ///< nodes whose lines have both intervals
    double const *t = nullptr, *per_t = nullptr, *x = nullptr, *y = nullptr, *z = nullptr;
  };
  static constexpr int lanes = native_lanes > 1 ? 4 : 1;

  template <class Step>
  KOKKOS_INLINE_FUNCTION void add_by_lanes(Step step, Lookup const& of, double const* weight,
                                           VectorRow<width>& v) const {
    Window at;
    at.guess = s;
    int w = 0;
    for (; w + 2 * lanes <= n; w += 2 * lanes) add_group<2>(step, of, w, weight, at, v);
    if (w + lanes <= n) {
      add_group<1>(step, of, w, weight, at, v);
      w += lanes;
    }
    for (; w < n; ++w) add_one(of, w, at.guess = interval(of, w, at.guess), weight, v);
  }

  /// Nodes w ... w + count * lanes - 1.
  template <int count, class Step>
  KOKKOS_FORCEINLINE_FUNCTION void add_group(Step step, Lookup const& of, int w, double const* weight, Window& at,
                                             VectorRow<width>& v) const {
    if (!holds<count>(step, of, w, at)) {
      int const last_w = w + count * lanes - 1;
      bool found = false;
      if (w >= at.begin && last_w < at.end) {
        // Mostly a row has come to the next interval.
        set(of, at.middle + (t[last_w] >= at.t[2 * of.along + last_w * step] ? 1 : -1), at);
        found = holds<count>(step, of, w, at);
      }
      if (!found) {
        choose(of, w, last_w, at);
        found = holds<count>(step, of, w, at);
      }
      if (!found) {
        for (int k = w; k < w + count * lanes; ++k) add_one(of, k, at.guess = interval(of, k, at.guess), weight, v);
        return;
      }
    }
    using T = Lanes<lanes>;
    Index const one = of.along, two = 2 * of.along;
    for (int k = w; k < w + count * lanes; k += lanes) {
      auto const read = [&](double const* p) { return load_lanes_by<T>(step, p + k * step); };
      T const here = load_lanes<T>(t + k), share = load_lanes<T>(weight + k);
      T const t0 = read(at.t), t1 = read(at.t + one), per_t0 = read(at.per_t), per_t1 = read(at.per_t + one);
      auto const upper = here >= t1;
      T const f = (here - (upper ? t1 : t0)) * (upper ? per_t1 : per_t0);
      auto const add_component = [&](double const* c, double* to) {
        T const c0 = read(c), c1 = read(c + one), c2 = read(c + two);
        T const from = upper ? c1 : c0, till = upper ? c2 : c1;
        store_lanes(to + k, T(load_lanes<T>(to + k) + share * (from + f * (till - from))));
      };
      add_component(at.x, v.x);
      add_component(at.y, v.y);
      add_component(at.z, v.z);
    }
  }

  /// Whether all nodes of a group lie in a window.
  template <int count, class Step>
  KOKKOS_FORCEINLINE_FUNCTION bool holds(Step step, Lookup const& of, int w, Window const& at) const {
    if (w < at.begin || w + count * lanes > at.end) return false;
    using T = Lanes<lanes>;
    AnyOutside<T> outside;
    double const *const from = at.t, *const to = at.t + 2 * of.along;
    for (int k = w; k < w + count * lanes; k += lanes)
      outside.add(load_lanes<T>(t + k), load_lanes_by<T>(step, from + k * step), load_lanes_by<T>(step, to + k * step));
    return !outside.any();
  }

  /// The window for nodes w ... last_w: around what lies between the intervals of both, or around the end of their
  /// common one that the row comes to next.
  KOKKOS_INLINE_FUNCTION void choose(Lookup const& of, int w, int last_w, Window& at) const {
    int const first_lower = interval(of, w, at.guess);
    int const lower = interval(of, last_w, clamped(first_lower + (last_w - w) * ds));
    at.guess = lower;
    int const begin = first_lower - w * ds, end = lower - last_w * ds;
    Index const node = of.first + last_w * of.between + lower * of.along;
    if (begin == end)
      set(of, end + ((t[last_w] - table.t(node)) * table.per_t(node) > 0.5 ? 1 : 0), at);
    else
      set(of, begin < end ? end : begin, at);
  }
  KOKKOS_INLINE_FUNCTION void set(Lookup const& of, int middle, Window& at) const {
    int const last = chain.n_s - 1;
    // Both intervals on the line of every node: 1 <= middle + w ds <= last - 1.
    if (ds == 0) {
      at.middle = middle < 1 ? 1 : middle > last - 1 ? last - 1 : middle;
      at.begin = 0;
      at.end = last > 1 ? n : 0;
    } else {
      at.middle = middle;
      int const a = ds > 0 ? 1 - middle : middle - (last - 1), b = ds > 0 ? last - 1 - middle : middle - 1;
      at.begin = a > 0 ? a : 0;
      at.end = b + 1 < n ? b + 1 : n;
    }
    Index const from = of.first + (at.middle - 1) * of.along;
    at.t = table.t.data() + from;
    at.per_t = table.per_t.data() + from;
    at.x = table.c.x + from;
    at.y = table.c.y + from;
    at.z = table.c.z + from;
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION int clamped(int position) const { return position < 0 ? 0 : position; }
};

}  // namespace gridmorph::kernels
