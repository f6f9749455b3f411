// Transposed grid lines: the gradient of what lies on a line, added up at its two ends. With J any function of the
// displacements and g = dJ/du of the nodes of a line,
//
//   dJ/du0 = sum of (1 - w(t)) g,   dJ/du1 = sum of w(t) g
//
// and likewise for rotations at its ends (turned_line.hpp), linearised where the ends are: the transpose of
// skeleton_sweep.hpp and volume_pass.hpp without their correction (transposed_sides.hpp).
//
// Nodes of a chain are listed as bundles: boxes (s, a, b) of slots of the skeleton or of nodes inside a piece. A group
// is a rectangle (a, b) of lines that run through the same bundles, so that one work item has its lines to itself: sums
// come in one order whatever the number of threads. On the host nodes are taken in rows that vector instructions work
// on: those of neighbouring lines, or, where memory runs along the lines, those of one line after the other, in sixteen
// sums that are added up at its end.
//
// Cost per node and chain through it: 24 bytes of gradient and 8 of line parameter read; where the chain turns 24 more,
// about 90 flops per end that turns. Nothing is written but at the ends.
#pragma once

#include <gridmorph/kernels/common_rows.hpp>
#include <gridmorph/kernels/row_correction.hpp>
#include <gridmorph/kernels/skeleton_sweep.hpp>
#include <gridmorph/kernels/transposed_turns.hpp>
#include <gridmorph/kernels/vector_array.hpp>

namespace gridmorph::kernels {

/// Steps of an index along s, a and b.
struct LineStep {
  Index s, a, b;
};
/// The direction along which the nodes of a row lie side by side: on neighbouring lines (a), or on one line (s).
enum class RowAlong { a, s };
template <RowAlong along>
KOKKOS_INLINE_FUNCTION Index row_step(LineStep const& step) {
  return along == RowAlong::a ? step.a : step.s;
}

struct LineBundle {
  std::int32_t s, n_s;     ///< positions on the chain
  std::int32_t matrix;     ///< chain frame -> frame of its values, -1: the same
  std::int32_t in_volume;  ///< values of nodes, otherwise of slots
  Index value;             ///< of the first position on the first line of its group
  LineStep value_step;
  Index t;  ///< line parameter likewise, < 0: none needed
  LineStep t_step;
  Index x;  ///< position likewise: in SkeletonTurns::position; nodes: as `value`
  LineStep x_step;
  Vec3 offset;               ///< of nodes: position in the chain's frame is matrix^T x + offset
  std::int32_t common = -1;  ///< of nodes: which part's motion in common they have, -1: none
};

struct LineGroup {
  std::int32_t chain;
  std::int32_t a, b, n_a, n_b;
  std::int32_t first_bundle, n_bundles;
  /// Rows are of nodes of one line, not of neighbouring lines: what follows on one another in memory is read together.
  std::int32_t rows_along_s = 0;
};

/// Gradients of the nodes of bundles, and where these nodes are.
template <class MemorySpace>
struct BundleGradients {
  Kokkos::View<LineBundle const*, MemorySpace> bundles;
  Kokkos::View<Mat3 const*, MemorySpace> matrices;
  double const* t;
  Field<double const> slots;
  VectorArray nodes;
  Field<double const> slot_turns, position;
  VectorArray baseline;
  CommonMove const* moves = nullptr;  ///< of parts; null: gradients are not handed through motions in common
  Index n_moves = 0;                  ///< from part to part

  KOKKOS_INLINE_FUNCTION static Index at(Index first, LineStep const& step, int s, int a, int b) {
    return first + s * step.s + a * step.a + b * step.b;
  }
  /// (s, a, b): from the first of the bundle. All in the frame of the chain.
  KOKKOS_INLINE_FUNCTION Vec3 gradient(LineBundle const& p, int s, int a, int b) const {
    Index const n = at(p.value, p.value_step, s, a, b);
    Vec3 g = p.in_volume != 0 ? nodes[n] : slots[n];
    if (is_pulled(p)) g = transpose(moves[p.common * n_moves].forward) * g;
    return p.matrix < 0 ? g : transpose(matrices(p.matrix)) * g;
  }
  KOKKOS_INLINE_FUNCTION double parameter(LineBundle const& p, int s, int a, int b) const {
    return p.t < 0 ? 0 : t[at(p.t, p.t_step, s, a, b)];
  }

  /// The gradients of a row of n nodes from (s, a, b) on; below: where they are, their parameters, the gradients of the
  /// rotations of slots.
  template <RowAlong along, int width>
  KOKKOS_INLINE_FUNCTION void row(LineBundle const& p, int s, int a, int b, int n, VectorRow<width>& g) const {
    Index const first = at(p.value, p.value_step, s, a, b), step = row_step<along>(p.value_step);
    p.in_volume != 0 ? read(nodes, first, step, n, g) : read(slots, first, step, n, g);
    if (is_pulled(p)) pull_row(moves[p.common * n_moves], n, g);
    turn_back(p, n, g);
  }
  template <RowAlong along, int width>
  KOKKOS_INLINE_FUNCTION void places(LineBundle const& p, int s, int a, int b, int n, VectorRow<width>& x) const {
    Index const first = at(p.x, p.x_step, s, a, b), step = row_step<along>(p.x_step);
    if (p.in_volume == 0) return read(position, first, step, n, x);
    read(baseline, first, step, n, x);
    turn_back(p, n, x);
    for (int w = 0; w < n; ++w) {
      x.x[w] += p.offset.x;
      x.y[w] += p.offset.y;
      x.z[w] += p.offset.z;
    }
  }
  template <RowAlong along>
  KOKKOS_INLINE_FUNCTION void parameters(LineBundle const& p, int s, int a, int b, int n, double* to) const {
    double const* const from = t + (p.t < 0 ? 0 : at(p.t, p.t_step, s, a, b));
    for (int w = 0; w < n; ++w) to[w] = p.t < 0 ? 0 : from[w * row_step<along>(p.t_step)];
  }
  template <RowAlong along, int width>
  KOKKOS_INLINE_FUNCTION void turn_gradients(LineBundle const& p, int s, int a, int b, int n,
                                             VectorRow<width>& g) const {
    read(slot_turns, at(p.value, p.value_step, s, a, b), row_step<along>(p.value_step), n, g);
    turn_back(p, n, g);
  }

 private:
  KOKKOS_INLINE_FUNCTION bool is_pulled(LineBundle const& p) const { return moves != nullptr && p.common >= 0; }

  template <class Real, int width>
  KOKKOS_INLINE_FUNCTION static void read(Real const* x, Real const* y, Real const* z, Index step, int n,
                                          VectorRow<width>& to) {
    for (int w = 0; w < n; ++w) {
      to.x[w] = double(x[w * step]);
      to.y[w] = double(y[w * step]);
      to.z[w] = double(z[w * step]);
    }
  }
  template <int width>
  KOKKOS_INLINE_FUNCTION static void read(Field<double const> const& from, Index first, Index step, int n,
                                          VectorRow<width>& to) {
    Index const skip = first * from.stride;
    read(from.x + skip, from.y + skip, from.z + skip, step * from.stride, n, to);
  }
  template <int width>
  KOKKOS_INLINE_FUNCTION static void read(VectorArray const& from, Index first, Index step, int n,
                                          VectorRow<width>& to) {
    if (from.zones == nullptr) {
      from.with_row(first, [&](auto const& row) { read(row.x, row.y, row.z, step * row.stride, n, to); });
      return;
    }
    for (int w = 0; w < n; ++w) {
      Vec3 const v = from[first + w * step];
      to.x[w] = v.x;
      to.y[w] = v.y;
      to.z[w] = v.z;
    }
  }
  template <int width>
  KOKKOS_INLINE_FUNCTION void turn_back(LineBundle const& p, int n, VectorRow<width>& v) const {
    if (p.matrix < 0) return;
    Mat3 const back = transpose(matrices(p.matrix));
    for (int w = 0; w < n; ++w) {
      Vec3 const turned = back * Vec3{v.x[w], v.y[w], v.z[w]};
      v.x[w] = turned.x;
      v.y[w] = turned.y;
      v.z[w] = turned.z;
    }
  }
};

/// Where gradients of line ends go: of displacements, and where chains turn of rotations made ready and as vectors.
struct EndGradients {
  Field<double> u;
  TurnedEndGradients turned;
  Field<double> turns{nullptr, nullptr, nullptr};
};

/// One item per at most `Width` neighbouring lines of a group. Sets the gradients at their ends.
template <class MemorySpace, int Width>
struct LineGradients {
  Kokkos::View<LineGroup const*, MemorySpace> groups;
  Kokkos::View<Index const*, MemorySpace> first_item;  ///< per group, and one past the last
  Kokkos::View<Chain const*, MemorySpace> chains;
  BundleGradients<MemorySpace> from;
  double const* law_knots;
  TurnedEnds<double const> ends;
  EndGradients to;

  static Index items(LineGroup const& g) { return tiles(g.n_a, Width) * g.n_b; }

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    int const entry = entry_of(first_item, item);
    LineGroup const& group = groups(entry);
    Index const local = item - first_item(entry), per_row = tiles(group.n_a, Width);
    int const first = int(local % per_row) * Width, b = int(local / per_row);
    int const n = group.n_a - first < Width ? group.n_a - first : Width;
    if constexpr (Width > 1)
      if (group.rows_along_s != 0) {
        for (int a = first; a < first + n; ++a) add<RowAlong::s>(group, Lines<nodes_of_a_line>{a, b, nodes_of_a_line});
        return;
      }
    add<RowAlong::a>(group, Lines<Width>{first, b, n});
  }

 private:
  static constexpr int nodes_of_a_line = 16;  ///< in a row along s

  /// What is added up side by side: lines from a on, or every n-th node of one line.
  template <int width>
  struct Lines {
    int a, b, n;
  };
  template <int width>
  using Row = VectorRow<width>;

  template <RowAlong along, int width>
  KOKKOS_INLINE_FUNCTION void add(LineGroup const& group, Lines<width> const& lines) const {
    Chain const& chain = chains(group.chain);
    Index const lower = chain.first_end_value + group.a + lines.a + Index(chain.n_a) * (group.b + lines.b);
    if (chain.turn == TurnLaw::none)
      add_displacements<along>(group, chain, lines, lower, [](LineBundle const&, int, int, Row<width> const&) {});
    else
      add_turned<along>(group, chain, lines, lower);
  }

  /// visit(bundle, s, number of nodes, gradients) of every row.
  template <RowAlong along, int width, class Visit>
  KOKKOS_INLINE_FUNCTION void add_displacements(LineGroup const& group, Chain const& chain, Lines<width> const& lines,
                                                Index lower, Visit const& visit) const {
    Row<width> first, last, g;
    double weight[width];
    for (int w = 0; w < lines.n; ++w) first.x[w] = first.y[w] = first.z[w] = last.x[w] = last.y[w] = last.z[w] = 0;
    bool const constant = chain.law == LineLaw::constant;
    constexpr int step = along == RowAlong::a ? 1 : width;
    for (int m = 0; m < group.n_bundles; ++m) {
      LineBundle const& p = from.bundles(group.first_bundle + m);
      for (int s = 0; s < p.n_s; s += step) {
        int const n = along == RowAlong::a ? lines.n : p.n_s - s < width ? p.n_s - s : width;
        from.template row<along>(p, s, lines.a, lines.b, n, g);
        if (!constant) weights<along>(chain, p, s, lines, n, weight);
        for (int w = 0; w < n; ++w) {
          double const f = constant ? 0 : weight[w];
          first.x[w] += (1 - f) * g.x[w];
          first.y[w] += (1 - f) * g.y[w];
          first.z[w] += (1 - f) * g.z[w];
          last.x[w] += f * g.x[w];
          last.y[w] += f * g.y[w];
          last.z[w] += f * g.z[w];
        }
        visit(p, s, n, g);
      }
    }
    Index const upper = lower + chain.section_size();
    // All nodes of the rows are on one line, whose ends get the sum.
    if constexpr (along == RowAlong::s) {
      Vec3 of_first, of_last;
      for (int w = 0; w < width; ++w) {
        of_first += {first.x[w], first.y[w], first.z[w]};
        of_last += {last.x[w], last.y[w], last.z[w]};
      }
      to.u.set(lower, of_first);
      to.u.set(upper, of_last);
      return;
    }
    for (int w = 0; w < lines.n; ++w) {
      to.u.set(lower + w, {first.x[w], first.y[w], first.z[w]});
      to.u.set(upper + w, {last.x[w], last.y[w], last.z[w]});
    }
  }

  template <RowAlong along, int width>
  KOKKOS_INLINE_FUNCTION void weights(Chain const& chain, LineBundle const& p, int s, Lines<width> const& lines, int n,
                                      double* weight) const {
    if (p.t < 0) {
      for (int w = 0; w < n; ++w) weight[w] = law_weight(chain, law_knots, 0);
      return;
    }
    double const* const at = from.t + from.at(p.t, p.t_step, s, lines.a, lines.b);
    Index const step = row_step<along>(p.t_step);
    auto const fill = [&](auto const& law) {
      for (int w = 0; w < n; ++w) weight[w] = law(at[w * step]);
    };
    switch (chain.law) {
      case LineLaw::linear: return fill([](double f) { return f; });
      case LineLaw::c1: return fill([](double f) { return f * f * (3 - 2 * f); });
      default: return fill([&](double f) { return law_weight(chain, law_knots, f); });
    }
  }

  template <RowAlong along, int width>
  KOKKOS_INLINE_FUNCTION void add_turned(LineGroup const& group, Chain const& chain, Lines<width> const& lines,
                                         Index lower) const {
    constexpr bool one_line = along == RowAlong::s;
    TurnedLines<width> turned(ends, chain, lower, lines.n, one_line);
    add_displacements<along>(group, chain, lines, lower, [&](LineBundle const& p, int s, int n, Row<width> const& g) {
      double t[width];
      Row<width> x;
      from.template parameters<along>(p, s, lines.a, lines.b, n, t);
      from.template places<along>(p, s, lines.a, lines.b, n, x);
      turned.add(t, x, g, n);
      if (p.in_volume != 0) return;
      Row<width> of_turns;
      from.template turn_gradients<along>(p, s, lines.a, lines.b, n, of_turns);
      turned.add_turns(t, of_turns, n);
    });
    one_line ? turned.write_sum(lower, to.turned, to.turns) : turned.write(lower, to.turned, to.turns);
  }
};

}  // namespace gridmorph::kernels
