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
#include <gridmorph/kernels/launch.hpp>
#include <gridmorph/kernels/tile.hpp>

namespace gridmorph::kernels {

/// Device arrays that describe a set of lines.
template <class MemorySpace>
struct LineTable {
  Kokkos::View<Chain const*, MemorySpace> chains;
  Kokkos::View<Tube const*, MemorySpace> tubes;
  Kokkos::View<Segment const*, MemorySpace> segments;
};

/// Calls visit(position on the line, t) for every node of line (a, b) of a tube, in order; nodes where segments meet
/// are visited once per segment. x: Field<double const>, or what else has places with a distance() between neighbours.
/// For the host, which makes tables of plans.
template <class MemorySpace, class Places, class Visit>
void walk_line(LineTable<MemorySpace> const& lines, Tube const& tube, int a, int b, Places const& x,
               Visit const& visit) {
  int const n_s = lines.chains(tube.chain).n_s;
  auto walk = [&](auto const& each) {
    double done = 0;
    for (int m = 0; m < tube.n_segments; ++m) {
      Segment const& s = lines.segments(tube.first_segment + m);
      Index n = s.first + a * s.stride_a + b * s.stride_b;
      auto previous = x[n];
      for (int k = 0; k < s.count; ++k, n += s.stride_s) {
        auto const here = x[n];
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

/// All parameters of a set of lines: one item per tile of at most `Width` neighbouring lines of a tube.
///
/// Edges are measured row by row along memory. Where lines run across it, a row is one position of all lines of the
/// tile; where they run along it, a piece of one line, and their sums follow for four lines at once, since each waits
/// for the one before. Sums go to where the parameters are kept, and are divided by the lengths of their lines while
/// they are still in cache.
template <class MemorySpace, int Width>
struct LineParameters {
  LineTable<MemorySpace> lines;
  Kokkos::View<ParameterTarget const*, MemorySpace> targets;
  Kokkos::View<Index const*, MemorySpace> first_item;  ///< per tube, and one past the last
  Field<double const> x;
  double* t;

  static constexpr bool two_instruction_sets = true;

  static Index items(Tube const& tube) { return tiles(tube.n_a, Width) * tube.n_b; }

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    int const number = entry_of(first_item, item);
    Tube const& tube = lines.tubes(number);
    Index const local = item - first_item(number), per_row = tiles(tube.n_a, Width);
    int const a = int(local % per_row) * Width, b = int(local / per_row);
    int const n = a + Width < tube.n_a ? Width : tube.n_a - a;
    Index const along = lines.segments(tube.first_segment).stride_s;
    if (Width > 1 && x.stride == 1 && (along == 1 || along == -1)) {
      for (int w = 0; w < n; w += 4) measure<Block<true>>({tube, a + w, b, n - w < 4 ? n - w : 4});
    } else {
      measure<Block<false>>({tube, a, b, n});
    }
  }

 private:
  /// Lines (a ... a + n - 1, b) of a tube.
  struct Tile {
    Tube const& tube;
    int a, b, n;
  };

  /// How many lines and nodes are measured at once.
  template <bool Along>
  struct Block {
    static constexpr bool along = Along;
    static constexpr int lines = Along ? 4 : Width, nodes = Along && Width > 1 ? 128 : 1;
  };

  /// Parameters of n_s nodes from position s of a segment on, of n_a lines from line a of a tile on: that of node (s,
  /// a) is kept at t.
  struct Piece {
    double* t;
    Index stride_s, stride_a;
    int s, n_s, a, n_a;
  };

  template <class Block>
  KOKKOS_INLINE_FUNCTION void measure(Tile const& tile) const {
    double length[Block::lines * Block::nodes] = {}, sum[Block::lines] = {};
    for (int m = 0; m < tile.tube.n_segments; ++m) {
      Segment const& segment = lines.segments(tile.tube.first_segment + m);
      for (int begin = 0; begin < segment.count; begin += Block::nodes) {
        int const n = begin + Block::nodes < segment.count ? Block::nodes : segment.count - begin;
        measure_rows<Block>(tile, segment, begin, n, length, sum);
        for_pieces(tile, segment, begin, begin + n, [&](Piece const& piece) {
          for_rows<Block>(piece, [&](double* to, auto stride, int n_row, int s, int w) {
            double const* const from = Block::along ? length + w * Block::nodes + (s - begin) : sum + w;
            for (int i = 0; i < n_row; ++i) to[i * stride] = from[i];
          });
        });
      }
    }
    divide<Block>(tile, sum);
  }

  /// Adds the edges that end at the n nodes of a block to the sums of its lines; none ends at the first node of a
  /// segment. length: of rows along lines, the sums up to each node.
  template <class Block>
  KOKKOS_INLINE_FUNCTION void measure_rows(Tile const& tile, Segment const& segment, int begin, int n, double* length,
                                           double* sum) const {
    Index const back = segment.stride_s * x.stride;
    Index const first =
        (segment.first + begin * segment.stride_s + tile.a * segment.stride_a + tile.b * segment.stride_b) * x.stride;
    if constexpr (Block::along) {
      for (int w = 0; w < tile.n; ++w) {
        double* const row = length + w * Block::nodes;
        row[0] = 0;
        edges_of_row(begin > 0 ? 0 : 1, n, first + w * segment.stride_a, back, back,
                     [&](int i, double edge) { row[i] = edge; });
      }
      for (int c = 0; c < n; ++c)
        for (int w = 0; w < Block::lines; ++w) length[w * Block::nodes + c] = sum[w] += length[w * Block::nodes + c];
    } else if (begin > 0) {
      edges_of_row(0, tile.n, first, back, segment.stride_a * x.stride, [&](int i, double edge) { sum[i] += edge; });
    }
  }

  /// Calls put(i, length of the edge that ends at a node) for nodes i `step` apart.
  template <class Put>
  KOKKOS_INLINE_FUNCTION void edges_of_row(int begin, int end, Index first, Index back, Index step,
                                           Put const& put) const {
    double const *const xx = x.x + first, *const xy = x.y + first, *const xz = x.z + first;
    auto const walk = [&](auto const stride) {
      using std::sqrt;
      for (int i = begin; i < end; ++i) {
        Index const here = i * stride, before = here - back;
        double const dx = xx[before] - xx[here], dy = xy[before] - xy[here], dz = xz[before] - xz[here];
        put(i, sqrt(dx * dx + dy * dy + dz * dz));
      }
    };
    if (step == 1)
      walk(Constant<1>());
    else
      walk(step);
  }

  /// Turns arc lengths into fractions of the whole line.
  template <class Block>
  KOKKOS_INLINE_FUNCTION void divide(Tile const& tile, double const* sum) const {
    double per_length[Block::lines] = {};
    bool poles = false;
    for (int w = 0; w < tile.n; ++w) {
      per_length[w] = sum[w] > 0 ? 1 / sum[w] : 0;
      poles = poles || !(sum[w] > 0);
    }
    int const last = lines.chains(tile.tube.chain).n_s - 1;
    double const per_node = 1 / double(last);
    for (int m = 0; m < tile.tube.n_segments; ++m) {
      Segment const& segment = lines.segments(tile.tube.first_segment + m);
      for_pieces(tile, segment, 0, segment.count, [&](Piece const& piece) {
        for_rows<Block>(piece, [&](double* to, auto stride, int n_row, int s, int w) {
          if (segment.begin + s == last)
            for (int i = 0; i < n_row; ++i) to[i * stride] = 1;
          else if (poles)
            for (int i = 0; i < n_row; ++i) {
              int const line = Block::along ? w : w + i, position = segment.begin + s + (Block::along ? i : 0);
              to[i * stride] = sum[line] > 0 ? to[i * stride] * per_length[line] : position * per_node;
            }
          else
            for (int i = 0; i < n_row; ++i) to[i * stride] *= per_length[Block::along ? w : w + i];
        });
      });
    }
  }

  /// Calls visit(piece) for the parts of nodes [begin, end) of a segment, on the lines of a tile, whose parameters are
  /// wanted: ends and sides of the segment by themselves, its inside in one.
  template <class Visit>
  KOKKOS_INLINE_FUNCTION void for_pieces(Tile const& tile, Segment const& segment, int begin, int end,
                                         Visit const& visit) const {
    int const cb = end_category(tile.b, tile.tube.n_b), inside_a = tile.tube.n_a - 1 - tile.a;
    for (int s = begin, s_end; s < end; s = s_end) {
      int const cs = end_category(s, segment.count);
      s_end = cs != 1 ? s + 1 : end < segment.count ? end : segment.count - 1;
      for (int w = 0, w_end; w < tile.n; w = w_end) {
        int const ca = end_category(tile.a + w, tile.tube.n_a);
        w_end = ca != 1 ? w + 1 : tile.n < inside_a ? tile.n : inside_a;
        int const number = segment.target[cs + 3 * (ca + 3 * cb)];
        if (number < 0) continue;
        ParameterTarget const& to = targets(number);
        visit(Piece{t + to.first + s * to.stride_s + (tile.a + w) * to.stride_a + tile.b * to.stride_b, to.stride_s,
                    to.stride_a, s, s_end - s, w, w_end - w});
      }
    }
  }

  /// Calls visit(first parameter, stride, how many, s, line) for each row of a piece, as a block has them.
  template <class Block, class Visit>
  KOKKOS_INLINE_FUNCTION static void for_rows(Piece const& piece, Visit const& visit) {
    Index const stride = Block::along ? piece.stride_s : piece.stride_a;
    int const rows = Block::along ? piece.n_a : piece.n_s, n = Block::along ? piece.n_s : piece.n_a;
    for (int row = 0; row < rows; ++row) {
      double* const to = piece.t + row * (Block::along ? piece.stride_a : piece.stride_s);
      int const s = piece.s + (Block::along ? 0 : row), w = piece.a + (Block::along ? row : 0);
      if (stride == 1)
        visit(to, Constant<1>(), n, s, w);
      else
        visit(to, stride, n, s, w);
    }
  }
};
/// Finds t of all lines of the tubes listed and puts it where `targets` says.
template <class Exec>
void line_parameters(Exec const& exec, Kokkos::View<Chain const*, typename Exec::memory_space> const& chains,
                     TileList<Tube, typename Exec::memory_space> const& tubes,
                     Kokkos::View<Segment const*, typename Exec::memory_space> const& segments,
                     Kokkos::View<ParameterTarget const*, typename Exec::memory_space> const& targets,
                     Field<double const> const& x, double* t) {
  launch("gridmorph::line_parameters", exec, 0, tubes.n_items,
         LineParameters<typename Exec::memory_space, TileShape<Exec>::lines>{
             {chains, tubes.entries, segments}, targets, tubes.first_item, x, t});
}

}  // namespace gridmorph::kernels
