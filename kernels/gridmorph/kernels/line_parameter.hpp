// Line parameters: the fraction t of its line's baseline arc length at which every node of a chain lies.
//
//   t(m) = sum of |x(l) - x(l - 1)|, l = 1 .. m, over the sum for l = 1 .. n_s - 1
//
// (paper, section 3: "by grid line length"). Lines of zero length (poles) use the node count instead. Computed once per
// plan and baseline mesh; applying the plan reads them and no neighbour of a node.
//
// Every line is summed in node order, so results do not depend on the execution space, the tile or the thread count.
// Cost per node: 24 bytes of coordinates read, 8 written; the division by the length comes after, from cache.
#pragma once

#include <gridmorph/kernels/field.hpp>
#include <gridmorph/kernels/tile.hpp>

namespace gridmorph::kernels {

/// Device arrays that describe a set of lines.
template <class MemorySpace>
struct LineTable {
  Kokkos::View<Chain const*, MemorySpace> chains;
  Kokkos::View<Tube const*, MemorySpace> tubes;
  Kokkos::View<Segment const*, MemorySpace> segments;
};

/// Calls visit(position on the line, t) for every node of line (a, b) of a tube, in order; nodes where segments meet are
/// visited once per segment.
template <class MemorySpace, class Visit>
KOKKOS_INLINE_FUNCTION void walk_line(LineTable<MemorySpace> const& lines, Tube const& tube, int a, int b,
                                      Field<double const> const& x, Visit const& visit) {
  int const n_s = lines.chains(tube.chain).n_s;
  auto walk = [&](auto const& each) {
    double done = 0;
    for (int m = 0; m < tube.n_segments; ++m) {
      Segment const& s = lines.segments(tube.first_segment + m);
      Index n = s.first + a * s.stride_a + b * s.stride_b;
      Vec3 previous = x[n];
      for (int k = 0; k < s.count; ++k, n += s.stride_s) {
        Vec3 const here = x[n];
        if (k > 0) done += distance(previous, here);
        previous = here;
        each(s.begin + k, done);
      }
    }
    return done;
  };
  double const total = walk([](int, double) {});
  double const per_length = total > 0 ? 1 / total : 0;
  walk([&](int position, double done) {
    double t = total > 0 ? done * per_length : position * (1 / double(n_s - 1));
    if (position == n_s - 1) t = 1;
    visit(position, t);
  });
}

/// One item per tile of at most `Width` neighbouring lines of a tube.
template <class MemorySpace, int Width>
struct LineParameters {
  LineTable<MemorySpace> lines;
  Kokkos::View<ParameterTarget const*, MemorySpace> targets;
  Kokkos::View<Index const*, MemorySpace> first_item;  ///< per tube, and one past the last
  Field<double const> x;
  double* t;

  static Index items(Tube const& tube) { return tiles(tube.n_a, Width) * tube.n_b; }

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    int const number = entry_of(first_item, item);
    Tube const& tube = lines.tubes(number);
    Index const local = item - first_item(number), per_row = tiles(tube.n_a, Width);
    Tile const tile{tube, int(local % per_row) * Width, int(local / per_row)};
    int const n = tile.a + Width < tube.n_a ? Width : tube.n_a - tile.a;
    double sum[Width];
    Index const along = lines.segments(tube.first_segment).stride_s;
    if (Width > 1 && x.stride == 1 && (along == 1 || along == -1)) {
      for (int w = 0; w < n; w += 4) sum_along(tile, w, n - w < 4 ? n - w : 4, sum);
      divide_along(tile, n, sum);
    } else {
      sum_across(tile, n, sum);
      divide_across(tile, n, sum);
    }
  }

 private:
  struct Tile {
    Tube const& tube;
    int a, b;  ///< first line
  };

  /// Calls put(destination of line w = 0, stride over lines, first w, one past the last w) for the lines of a tile that
  /// want the parameter of node k of a segment.
  template <class Put>
  KOKKOS_INLINE_FUNCTION void for_targets(Tile const& tile, Segment const& s, int k, int n, Put const& put) const {
    int const cs = end_category(k, s.count), cb = end_category(tile.b, tile.tube.n_b);
    int w = 0;
    while (w < n) {
      int const ca = end_category(tile.a + w, tile.tube.n_a);
      int end = w + 1;
      if (ca == 1) end = tile.a + n < tile.tube.n_a ? n : n - 1;
      int const number = s.target[cs + 3 * (ca + 3 * cb)];
      if (number >= 0) {
        ParameterTarget const& to = targets(number);
        put(to.first + k * to.stride_s + tile.a * to.stride_a + tile.b * to.stride_b, to.stride_a, w, end);
      }
      w = end;
    }
  }

  /// Arc lengths of n lines side by side, node by node: for lines across memory.
  KOKKOS_INLINE_FUNCTION void sum_across(Tile const& tile, int n, double* sum) const {
    double px[Width], py[Width], pz[Width];
    for (int w = 0; w < n; ++w) sum[w] = 0;
    for (int m = 0; m < tile.tube.n_segments; ++m) {
      Segment const& s = lines.segments(tile.tube.first_segment + m);
      Index const step = s.stride_a * x.stride;
      for (int k = 0; k < s.count; ++k) {
        Index const first = (s.first + k * s.stride_s + tile.a * s.stride_a + tile.b * s.stride_b) * x.stride;
        double const *const xx = x.x + first, *const xy = x.y + first, *const xz = x.z + first;
        if (k == 0) {
          for (int w = 0; w < n; ++w) {
            px[w] = xx[w * step];
            py[w] = xy[w * step];
            pz[w] = xz[w * step];
          }
        } else if (step == 1) {
          add_edges(n, xx, xy, xz, Constant<1>(), px, py, pz, sum);
        } else {
          add_edges(n, xx, xy, xz, step, px, py, pz, sum);
        }
        for_targets(tile, s, k, n, [&](Index to, Index stride, int begin, int end) {
          if (stride == 1)
            for (int w = begin; w < end; ++w) t[to + w] = sum[w];
          else
            for (int w = begin; w < end; ++w) t[to + w * stride] = sum[w];
        });
      }
    }
  }

  template <class Step>
  KOKKOS_INLINE_FUNCTION static void add_edges(int n, double const* xx, double const* xy, double const* xz, Step step,
                                               double* px, double* py, double* pz, double* sum) {
    for (int w = 0; w < n; ++w) {
      double const hx = xx[w * step], hy = xy[w * step], hz = xz[w * step];
      double const dx = px[w] - hx, dy = py[w] - hy, dz = pz[w] - hz;
      sum[w] += sqrt_of(dx * dx + dy * dy + dz * dz);
      px[w] = hx;
      py[w] = hy;
      pz[w] = hz;
    }
  }

  /// Arc lengths of up to four lines that run along memory: lengths of edges first, side by side, then the running sums,
  /// four at a time because each waits for the addition before it.
  KOKKOS_INLINE_FUNCTION void sum_along(Tile const& tile, int w0, int n, double* sum) const {
    constexpr int chunk = Width > 1 ? 128 : 1;
    double edge[4][chunk];
    for (int w = 0; w < 4; ++w)
      for (int c = 0; c < chunk; ++c) edge[w][c] = 0;
    double running[4] = {0, 0, 0, 0};
    for (int m = 0; m < tile.tube.n_segments; ++m) {
      Segment const& s = lines.segments(tile.tube.first_segment + m);
      for (int k0 = 0; k0 < s.count; k0 += chunk) {
        int const length = s.count - k0 < chunk ? s.count - k0 : chunk;
        for (int w = 0; w < n; ++w) {
          Index const first = s.first + k0 * s.stride_s + (tile.a + w0 + w) * s.stride_a + tile.b * s.stride_b;
          double const *const xx = x.x + first, *const xy = x.y + first, *const xz = x.z + first;
          if (s.stride_s == 1) {
            edges_of(k0 == 0 ? 1 : 0, length, xx, xy, xz, Constant<1>(), edge[w]);
          } else {
            edges_of(k0 == 0 ? 1 : 0, length, xx, xy, xz, s.stride_s, edge[w]);
          }
          if (k0 == 0) edge[w][0] = 0;
        }
        for (int c = 0; c < length; ++c)
          for (int w = 0; w < 4; ++w) edge[w][c] = running[w] += edge[w][c];
        for (int w = 0; w < n; ++w)
          for_runs({tile.tube, tile.a + w0 + w, tile.b}, s, k0, k0 + length,
                   [&](Index to, Index stride, int begin, int end) {
                     double const* const from = edge[w] + (begin - k0);
                     if (stride == 1)
                       for (int l = 0; l < end - begin; ++l) t[to + l] = from[l];
                     else
                       for (int l = 0; l < end - begin; ++l) t[to + l * stride] = from[l];
                   });
      }
    }
    for (int w = 0; w < n; ++w) sum[w0 + w] = running[w];
  }
  /// Calls put(destination of node `begin`, stride, begin, end) for the runs of nodes [k0, k1) of a segment on one line
  /// whose parameters are wanted: its ends by themselves, its inside in a row.
  template <class Put>
  KOKKOS_INLINE_FUNCTION void for_runs(Tile const& line, Segment const& s, int k0, int k1, Put const& put) const {
    int const across = 3 * (end_category(line.a, line.tube.n_a) + 3 * end_category(line.b, line.tube.n_b));
    for (int k = k0; k < k1;) {
      int const cs = end_category(k, s.count);
      int end = k + 1;
      if (cs == 1) end = k1 < s.count ? k1 : k1 - 1;
      int const number = s.target[cs + across];
      if (number >= 0) {
        ParameterTarget const& to = targets(number);
        put(to.first + k * to.stride_s + line.a * to.stride_a + line.b * to.stride_b, to.stride_s, k, end);
      }
      k = end;
    }
  }

  template <class Step>
  KOKKOS_INLINE_FUNCTION static void edges_of(int begin, int length, double const* xx, double const* xy,
                                              double const* xz, Step step, double* edge) {
    for (int c = begin; c < length; ++c) {
      double const dx = xx[(c - 1) * step] - xx[c * step], dy = xy[(c - 1) * step] - xy[c * step],
                   dz = xz[(c - 1) * step] - xz[c * step];
      edge[c] = sqrt_of(dx * dx + dy * dy + dz * dz);
    }
  }

  /// Arc lengths to fractions, tile still in cache.
  KOKKOS_INLINE_FUNCTION void divide_across(Tile const& tile, int n, double const* sum) const {
    double per_length[Width] = {};  // compilers do not see that n lines are all that is used
    bool all = true;
    for (int w = 0; w < n; ++w) {
      per_length[w] = sum[w] > 0 ? 1 / sum[w] : 0;
      all = all && sum[w] > 0;
    }
    int const last = lines.chains(tile.tube.chain).n_s - 1;
    double const per_node = 1 / double(last);
    for (int m = 0; m < tile.tube.n_segments; ++m) {
      Segment const& s = lines.segments(tile.tube.first_segment + m);
      for (int k = 0; k < s.count; ++k)
        for_targets(tile, s, k, n, [&](Index to, Index stride, int begin, int end) {
          int const position = s.begin + k;
          if (position == last)
            for (int w = begin; w < end; ++w) t[to + w * stride] = 1;
          else if (!all)
            for (int w = begin; w < end; ++w)
              t[to + w * stride] = sum[w] > 0 ? t[to + w * stride] * per_length[w] : position * per_node;
          else if (stride == 1)
            for (int w = begin; w < end; ++w) t[to + w] *= per_length[w];
          else
            for (int w = begin; w < end; ++w) t[to + w * stride] *= per_length[w];
        });
    }
  }

  KOKKOS_INLINE_FUNCTION void divide_along(Tile const& tile, int n, double const* sum) const {
    int const last = lines.chains(tile.tube.chain).n_s - 1;
    double const per_node = 1 / double(last);
    for (int w = 0; w < n; ++w) {
      double const per_length = sum[w] > 0 ? 1 / sum[w] : 0;
      for (int m = 0; m < tile.tube.n_segments; ++m) {
        Segment const& s = lines.segments(tile.tube.first_segment + m);
        for_runs({tile.tube, tile.a + w, tile.b}, s, 0, s.count, [&](Index to, Index stride, int begin, int end) {
          if (s.begin + begin == last)
            t[to] = 1;
          else if (!(sum[w] > 0))
            for (int k = begin; k < end; ++k) t[to + (k - begin) * stride] = (s.begin + k) * per_node;
          else if (stride == 1)
            for (int l = 0; l < end - begin; ++l) t[to + l] *= per_length;
          else
            for (int l = 0; l < end - begin; ++l) t[to + l * stride] *= per_length;
        });
      }
    }
  }

  KOKKOS_INLINE_FUNCTION static double sqrt_of(double v) {
    using std::sqrt;
    return sqrt(v);
  }
};

}  // namespace gridmorph::kernels
