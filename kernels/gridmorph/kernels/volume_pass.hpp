// The one pass over the volume: every node inside a piece gets its displacement from the ends of the lines through it.
//
//   u = (sweep along its chain) + (spread of the slip correction along the chains of every finalize pass)
//   each of the form  u0 + w(t) (u1 - u0) [+ turned ends] [+ c],   out = x + u, or u itself
//
// End values are two-dimensional tables that stay in cache; no neighbour of a node is read.
// Cost per node: 24 bytes of coordinates read and 24 written (none read where the displacement itself is asked for), 8
// read per line parameter: 0 in a near field (8 where it turns), 8 in the far field, 8 more under a slip surface. Where
// line ends turn (turned_line.hpp), the coordinates are read for displacements too, and where parts have a motion in
// common (common_rows.hpp).
#pragma once

#include <gridmorph/kernels/common_rows.hpp>
#include <gridmorph/kernels/fused_row.hpp>
#include <gridmorph/kernels/items_by_kind.hpp>
#include <gridmorph/kernels/node_copy.hpp>
#include <gridmorph/kernels/row_correction.hpp>
#include <gridmorph/kernels/tile.hpp>
#include <gridmorph/kernels/turned_row.hpp>
#include <gridmorph/kernels/vector_array.hpp>

#include <cstdint>
#include <type_traits>

namespace gridmorph::kernels {

/// The nodes inside one piece of a zone.
struct VolumeBox {
  Index first;
  Index stride_j, stride_k;  ///< along i nodes follow one another
  std::int32_t n[3];
  std::int32_t first_term, n_terms;
  std::int32_t common = -1;  ///< which part's motion in common its nodes have, -1: none
  std::int32_t n_swept = 0;  ///< that comes after so many terms, those of stages; 0: none does
};

/// What one chain adds to the nodes of a box.
struct VolumeTerm {
  std::int32_t chain;
  std::int32_t matrix;            ///< chain frame -> frame of the zone, -1: the same
  Index t;                        ///< line parameters of the box, i fastest; < 0: none needed
  Index end_value;                ///< of node (0, 0, 0) at the lower end of the chain
  Index end_stride[3];            ///< along i, j, k
  std::int32_t s[4], a[4], b[4];  ///< position of node (0, 0, 0) on the chain, and what a step along i, j, k adds
  Vec3 offset;                    ///< position in the chain's frame: matrix^T x + offset
};

/// Several displacement fields of the workspace, one behind the other.
template <class T>
struct FieldBatch {
  Field<T> first;
  Index stride = 0;  ///< elements from one field to the next
  KOKKOS_INLINE_FUNCTION Field<T> operator[](int f) const {
    return {first.x + f * stride, first.y + f * stride, first.z + f * stride, first.stride};
  }
};

/// Fields that one pass writes; they share what it reads.
inline constexpr int most_fields_at_once = 8;

/// Ends of lines that turn, of several fields; with rates, of one.
struct TurnedEndsBatch {
  TurnedEndsWithRates first;
  Index stride = 0;
  KOKKOS_INLINE_FUNCTION TurnedEndsWithRates operator[](int f) const {
    return {{first.values.first + f * stride, first.values.n}, first.rates};
  }
};

/// What the terms of a box may have.
enum class VolumeKind {
  plain,   ///< neither known sides, nor ends that turn, nor frames of their own, nor a motion in common
  turned,  ///< no known sides
  any
};

/// One item per tile of a box, of boxes of a kind. `baseline` and `out` may be the same arrays.
template <class MemorySpace, class Shape, VolumeKind Kind = VolumeKind::any>
struct VolumePass {
  Kokkos::View<VolumeBox const*, MemorySpace> boxes;
  Kokkos::View<VolumeTerm const*, MemorySpace> terms;
  Kokkos::View<Index const*, MemorySpace> first_item;  ///< per box, and one past the last
  Kokkos::View<Chain const*, MemorySpace> chains;
  Kokkos::View<Mat3 const*, MemorySpace> matrices;
  SideTable<MemorySpace> sides;
  double const* t;
  double const* law_knots;  ///< of laws that are tables
  FieldBatch<double const> ends, residuals;
  TurnedEndsBatch turned;
  VectorArray baseline;
  VectorArray out[most_fields_at_once];
  int n_fields = 1;
  bool moves = false;  ///< out = baseline + u, otherwise u
  CommonMoves<MemorySpace> common = {};

  static constexpr int width = Shape::volume_i;
  static constexpr bool two_instruction_sets = true;
  using Row = VectorRow<width>;

  /// The same for boxes of another kind.
  template <VolumeKind Other>
  [[nodiscard]] VolumePass<MemorySpace, Shape, Other> of_kind() const {
    VolumePass<MemorySpace, Shape, Other> other{boxes, terms,     first_item, chains,    matrices, sides,
                                                t,     law_knots, ends,       residuals, turned,   baseline,
                                                {},    n_fields,  moves,      common};
    for (int f = 0; f < n_fields; ++f) other.out[f] = out[f];
    return other;
  }

  static Index items(VolumeBox const& box) {
    return tiles(box.n[0], Shape::volume_i) * tiles(box.n[1], Shape::volume_j) * tiles(box.n[2], Shape::volume_k);
  }

  KOKKOS_INLINE_FUNCTION void operator()(Index item) const {
    int const entry = entry_of(first_item, item);
    VolumeBox const& box = boxes(entry);
    int const n_terms = common.leaves_out ? box.n_swept : box.n_terms;
    if (common.leaves_out && n_terms == 0) return;
    Index const local = item - first_item(entry);
    // Numbers of 64 bits are divided by some hundred instructions on GPUs, and there every node is a tile.
    auto const [i, j0, k0] =
        local <= 0xffffffffLL ? first_node<std::uint32_t>(box, local) : first_node<Index>(box, local);
    int const n = smaller(width, box.n[0] - i);
    int const j1 = smaller(j0 + Shape::volume_j, box.n[1]), k1 = smaller(k0 + Shape::volume_k, box.n[2]);
    bool const is_fused = Shape::host && (has_plain_terms(box, n_terms) || turns_near_wall(box, n_terms));
    for (int k = k0; k < k1; ++k)
      for (int j = j0; j < j1; ++j)
        for (int f = 0; f < n_fields; ++f) {
          Row u;
          Index const node = box.first + i + j * box.stride_j + k * box.stride_k;
          if constexpr (Shape::host)
            if (is_fused && write_at_once(box, n_terms, f, i, j, k, n, node)) continue;
          for (int m = 0; m < n_terms; ++m) {
            add_term(box, terms(box.first_term + m), m == 0, f, i, j, k, n, u);
            if constexpr (Kind != VolumeKind::plain)
              if (m + 1 == box.n_swept && !common.leaves_out) add_common(box, f, node, n, u);
          }
          write(node, n, u, out[f]);
        }
  }

 private:
  struct IJK {
    int i, j, k;
  };
  /// The first node of a tile.
  template <class Int>
  KOKKOS_INLINE_FUNCTION static IJK first_node(VolumeBox const& box, Index tile) {
    Int const tiles_i = Int(tiles(box.n[0], Shape::volume_i)), tiles_j = Int(tiles(box.n[1], Shape::volume_j));
    Int const row = Int(tile) / tiles_i, plane = row / tiles_j;
    return {int(Int(tile) - row * tiles_i) * Shape::volume_i, int(row - plane * tiles_j) * Shape::volume_j,
            int(plane) * Shape::volume_k};
  }
  KOKKOS_INLINE_FUNCTION static int smaller(int a, int b) { return a < b ? a : b; }

  /// Whether the rows of a box have one or two terms of the kinds that fused_row.hpp has.
  KOKKOS_INLINE_FUNCTION bool has_plain_terms(VolumeBox const& box, int n_terms) const {
    if (n_terms < 1 || n_terms > 2 || (box.n_swept > 0 && !common.leaves_out)) return false;
    for (int m = 0; m < n_terms; ++m) {
      VolumeTerm const& term = terms(box.first_term + m);
      Chain const& chain = chains(term.chain);
      if (!is_plain(chain, term) || !can_fuse(chain.law, term.end_stride[0])) return false;
    }
    VolumeTerm const &first = terms(box.first_term), &last = terms(box.first_term + n_terms - 1);
    return n_terms == 1 || can_fuse_both(first.end_stride[0], chains(last.chain).law, last.end_stride[0]);
  }
  KOKKOS_INLINE_FUNCTION static bool is_plain(Chain const& chain, VolumeTerm const& term) {
    return Kind == VolumeKind::plain || (chain.first_side < 0 && term.matrix < 0 && chain.turn == TurnLaw::none);
  }

  /// Whether the rows of a box are those of a near field that turns.
  KOKKOS_INLINE_FUNCTION bool turns_near_wall(VolumeBox const& box, int n_terms) const {
    if (n_terms != 1 || (box.n_swept > 0 && !common.leaves_out)) return false;
    VolumeTerm const& term = terms(box.first_term);
    Chain const& chain = chains(term.chain);
    return chain.turn == TurnLaw::near_field && chain.law == LineLaw::constant && chain.first_side < 0 &&
           term.matrix < 0 && can_fuse(chain.law, term.end_stride[0]);
  }

  /// All of a row in one loop, where its arrays are plain ones of doubles; otherwise nothing is done.
  KOKKOS_INLINE_FUNCTION bool write_at_once(VolumeBox const& box, int n_terms, int f, int i, int j, int k, int n,
                                            Index node) const {
    FusedRow row;
    if (!arrays_of_row(node, out[f], row)) return false;
    if (chains(terms(box.first_term).chain).turn != TurnLaw::none)
      return write_turned(row, node, terms(box.first_term), f, ends_of_row(box, terms(box.first_term), f, i, j, k, n));
    VolumeTerm const &a = terms(box.first_term), &b = terms(box.first_term + n_terms - 1);
    LineLaw const law = chains(a.chain).law;
    if (n_terms == 1)
      write_fused(row, moves, law, ends_of_row(box, a, f, i, j, k, n));
    else
      write_fused(row, moves, law, ends_of_row(box, a, f, i, j, k, n), chains(b.chain).law,
                  ends_of_row(box, b, f, i, j, k, n));
    return true;
  }

  /// The same of a row near a wall that turns.
  KOKKOS_INLINE_FUNCTION bool write_turned(FusedRow& row, Index node, VolumeTerm const& term, int f,
                                           RowEnds const& ends) const {
    if (turned[f].has_rates() || !baseline.plain_row(node, row.from_x, row.from_y, row.from_z)) return false;
    Chain const& chain = chains(term.chain);
    auto const write = [&](auto step) {
      LineTerm const line(ends, LawWeight<LineLaw::constant>(), step);
      with_turn_near_wall(turned[f].values, chain, ends, step, [&](auto const& turn) {
        double const *const x = row.from_x, *const y = row.from_y, *const z = row.from_z;
        Vec3 const offset = term.offset;
        write_row(row, moves, ends.n, [=](int w) { return line.at(w) + turn.at(w, Vec3{x[w], y[w], z[w]} + offset); });
      });
    };
    ends.step == 0 ? write(Constant<0>()) : write(Constant<1>());
    return true;
  }

  /// False where one of its arrays is no plain one of doubles.
  KOKKOS_INLINE_FUNCTION bool arrays_of_row(Index node, VectorArray const& to, FusedRow& row) const {
    return to.plain_row(node, row.x, row.y, row.z) &&
           (!moves || baseline.plain_row(node, row.from_x, row.from_y, row.from_z));
  }

  KOKKOS_INLINE_FUNCTION RowEnds ends_of_row(VolumeBox const& box, VolumeTerm const& term, int f, int i, int j, int k,
                                             int n) const {
    return {ends[f],
            term.end_value + i * term.end_stride[0] + j * term.end_stride[1] + k * term.end_stride[2],
            chains(term.chain).section_size(),
            term.end_stride[0],
            term.t < 0 ? nullptr : t + term.t + i + box.n[0] * (j + Index(box.n[1]) * k),
            n};
  }

  /// u = (first) or u += the displacement that one chain gives to a row.
  KOKKOS_INLINE_FUNCTION void add_term(VolumeBox const& box, VolumeTerm const& term, bool first, int f, int i, int j,
                                       int k, int n, Row& u) const {
    Chain const& chain = chains(term.chain);
    RowEnds const row = ends_of_row(box, term, f, i, j, k, n);
    if (is_plain(chain, term)) {
      first ? interpolate<false>(chain, row, u) : interpolate<true>(chain, row, u);
      return;
    }
    if constexpr (Kind != VolumeKind::plain) {
      Row v;
      interpolate<false>(chain, row, v);
      if (chain.turn != TurnLaw::none)
        add_turned(chain, term, f, row, box.first + i + j * box.stride_j + k * box.stride_k, v);
      if constexpr (Kind == VolumeKind::any)
        if (chain.first_side >= 0) add_correction(chain, term, f, i, j, k, n, row.t, v);
      if (term.matrix >= 0) turn(matrices(term.matrix), n, v);
      for (int w = 0; w < n; ++w) {
        u.x[w] = first ? v.x[w] : u.x[w] + v.x[w];
        u.y[w] = first ? v.y[w] : u.y[w] + v.y[w];
        u.z[w] = first ? v.z[w] : u.z[w] + v.z[w];
      }
    }
  }

  /// What the ends of its lines turn a row of nodes by, the first of which is `node`.
  KOKKOS_INLINE_FUNCTION void add_turned(Chain const& chain, VolumeTerm const& term, int f, RowEnds const& row,
                                         Index node, Row& v) const {
    Row x;
    read_baseline(node, row.n, x);
    if (term.matrix >= 0) turn(transpose(matrices(term.matrix)), row.n, x);
    add_vector(term.offset, row.n, x);
    with_step(row.step, [&](auto step) {
      with_turns(turned[f], chain, row, step, [&](auto const& turn) {
        GRIDMORPH_INDEPENDENT_LOOP
        for (int w = 0; w < row.n; ++w) {
          Vec3 const c = turn.at(w, {x.x[w], x.y[w], x.z[w]});
          v.x[w] += c.x;
          v.y[w] += c.y;
          v.z[w] += c.z;
        }
      });
    });
  }
  KOKKOS_INLINE_FUNCTION void add_common(VolumeBox const& box, int f, Index node, int n, Row& u) const {
    Row x;
    read_baseline(node, n, x);
    common.add_to(box.common, f, node, n, x, u);
  }
  KOKKOS_INLINE_FUNCTION void read_baseline(Index node, int n, Row& x) const {
    baseline.with_row(node, [&](auto const& at) {
      for (int w = 0; w < n; ++w) {
        x.x[w] = double(at.x[w * at.stride]);
        x.y[w] = double(at.y[w * at.stride]);
        x.z[w] = double(at.z[w * at.stride]);
      }
    });
  }
  KOKKOS_INLINE_FUNCTION static void add_vector(Vec3 const& a, int n, Row& x) {
    for (int w = 0; w < n; ++w) {
      x.x[w] += a.x;
      x.y[w] += a.y;
      x.z[w] += a.z;
    }
  }

  /// One loop per law, and per step between the lines of neighbouring nodes: the steps that occur most are constants,
  /// so that the compiler sees one line for the whole row, or unit stride.
  template <bool Add>
  KOKKOS_INLINE_FUNCTION void interpolate(Chain const& chain, RowEnds const& row, Row& u) const {
    bool const done = with_law(chain.law, [&](auto const& weight) { put<Add>(row, weight, u); });
    if (!done) interpolate_by_asked_law<Add>(chain, row, u);
  }
  /// The laws that chains have where somebody asks for them.
  template <bool Add>
  GRIDMORPH_CALLED_ON_HOST KOKKOS_FUNCTION void interpolate_by_asked_law(Chain const& chain, RowEnds const& row,
                                                                         Row& u) const {
    if (chain.law == LineLaw::c2) {
      put<Add>(row, LawWeight<LineLaw::c2>(), u);
    } else if (chain.law == LineLaw::cubic) {
      double const a = chain.slope[0], b = chain.slope[1];
      put<Add>(
          row, [a, b](double t) { return cubic_weight(a, b, t); }, u);
    } else {
      double const* const knots = law_knots + chain.first_knot;
      int const n = chain.n_intervals;
      put<Add>(
          row, [knots, n](double t) { return table_weight(knots, n, t); }, u);
    }
  }
  template <bool Add, class Weight>
  KOKKOS_INLINE_FUNCTION static void put(RowEnds const& row, Weight const& weight, Row& u) {
    with_step(row.step, [&](auto step) {
      LineTerm const term(row, weight, step);
      for (int w = 0; w < row.n; ++w) {
        Vec3 const v = term.at(w);
        u.x[w] = Add ? u.x[w] + v.x : v.x;
        u.y[w] = Add ? u.y[w] + v.y : v.y;
        u.z[w] = Add ? u.z[w] + v.z : v.z;
      }
    });
  }
  template <class Body>
  KOKKOS_INLINE_FUNCTION static void with_step(Index step, Body const& body) {
    if (width == 1 || step == 0)
      body(Constant<0>());
    else if (step == 1)
      body(Constant<1>());
    else
      body(step);
  }

  KOKKOS_INLINE_FUNCTION void add_correction(Chain const& chain, VolumeTerm const& term, int f, int i, int j, int k,
                                             int n, double const* here, Row& v) const {
    SideTable<MemorySpace> table = sides;
    table.c = residuals[f];
    auto at = [&](std::int32_t const* p) { return p[0] + i * p[1] + j * p[2] + k * p[3]; };
    RowCorrection<MemorySpace, width>{table,     chain,      at(term.s), term.s[1], at(term.a),
                                      term.a[1], at(term.b), term.b[1],  here,      n}
        .add_to(v);
  }

  KOKKOS_INLINE_FUNCTION static void turn(Mat3 const& r, int n, Row& v) {
    for (int w = 0; w < n; ++w) {
      Vec3 const turned = r * Vec3{v.x[w], v.y[w], v.z[w]};
      v.x[w] = turned.x;
      v.y[w] = turned.y;
      v.z[w] = turned.z;
    }
  }

  /// The sum goes through the row: baseline and destination may be the same arrays, which would keep the compiler from
  /// vectorising a loop that reads one and writes the other.
  KOKKOS_INLINE_FUNCTION void write(Index node, int n, Row& u, VectorArray const& to) const {
    FusedRow row;
    if (Shape::host && arrays_of_row(node, to, row))
      return write_row(row, moves, n, [&](int w) { return Vec3{u.x[w], u.y[w], u.z[w]}; });
    if (moves)
      baseline.with_row(node, [&](auto const& x) {
        add_component(n, x.x, x.stride, u.x);
        add_component(n, x.y, x.stride, u.y);
        add_component(n, x.z, x.stride, u.z);
      });
    to.with_row(node, [&](auto const& out) {
      write_component(n, u.x, out.x, out.stride);
      write_component(n, u.y, out.y, out.stride);
      write_component(n, u.z, out.z, out.stride);
    });
  }
  template <class Real>
  KOKKOS_INLINE_FUNCTION static void add_component(int n, Real const* x, Index stride, double* u) {
    with_step(stride, [&](auto step) {
      for (int w = 0; w < n; ++w) u[w] = moved(double(x[w * step]), u[w]);
    });
  }
  template <class Real>
  KOKKOS_INLINE_FUNCTION static void write_component(int n, double const* u, Real* to, Index stride) {
    with_step(stride, [&](auto step) {
      for (int w = 0; w < n; ++w) to[w * step] = Real(u[w]);
    });
  }
};
/// All nodes inside the boxes that the pass was made for.
template <class Exec, class Shape>
void pass_volume(Exec const& exec, ItemsByKind<VolumeKind> const& items,
                 VolumePass<typename Exec::memory_space, Shape> const& pass) {
  static_assert(std::is_same_v<Shape, TileShape<Exec>>, "the tiles of another execution space");
  launch_by_kind("gridmorph::volume", exec, items, pass);
}

}  // namespace gridmorph::kernels
