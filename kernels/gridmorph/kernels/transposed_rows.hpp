// Transposes of weighted means: rows of interpolation operators (interpolation_rows.hpp), layers of them
// (layer_motion.hpp too), smooth fields between boundary values (inverse_distance.hpp) and what nodes read of a lattice
// (lattice_field.hpp).
//
// Each source gathers from the rows that name it; where rows come in layers, sources do so from the last layer to the
// first, and gradients of rows are complete when they are read. So every gradient is written by one work item and sums
// come in one order.
//
// Cost: as forwards, with 12 bytes of tables per item. Lattices: 28 bytes read per node that reads one, 192 written per
// chunk of them.
#pragma once

#include <gridmorph/kernels/inverse_distance.hpp>
#include <gridmorph/kernels/lanes.hpp>
#include <gridmorph/kernels/lattice_field.hpp>

namespace gridmorph::kernels {

/// The targets of each source and its weight there; the weight that a row leaves its first item included.
template <class MemorySpace>
struct TransposedRows {
  Kokkos::View<std::int32_t const*, MemorySpace> source;
  Kokkos::View<Index const*, MemorySpace> first;
  Kokkos::View<std::int32_t const*, MemorySpace> target;
  Kokkos::View<double const*, MemorySpace> weight;

  [[nodiscard]] Index size() const { return Index(source.extent(0)); }
};

/// Sources in the order in which they gather. The host keeps where each launch begins.
template <class MemorySpace>
struct TransposedLayers {
  TransposedRows<MemorySpace> rows;
  std::vector<Index> level{0};
};

/// sources(item) += the sum of weight targets(row).
template <class MemorySpace, class Targets, class Sources>
struct GatherRows {
  TransposedRows<MemorySpace> rows;
  Targets targets;
  Sources sources;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    auto sum = sources[rows.source(n)];
    for (Index k = rows.first(n); k < rows.first(n + 1); ++k) sum += rows.weight(k) * targets[rows.target(k)];
    sources[rows.source(n)] = sum;
  }
};
template <class Exec, class Targets, class Sources>
void gather_rows(char const* label, Exec const& exec, TransposedRows<typename Exec::memory_space> const& rows,
                 Targets const& targets, Sources const& sources) {
  launch(label, exec, 0, rows.size(),
         GatherRows<typename Exec::memory_space, Targets, Sources>{rows, targets, sources});
}
/// Gathers in place, layer after layer, one launch per layer.
template <class Exec, class Value>
void gather_layers(char const* label, Exec const& exec, TransposedLayers<typename Exec::memory_space> const& layers,
                   Value* value) {
  for (std::size_t l = 0; l + 1 < layers.level.size(); ++l)
    launch(label, exec, layers.level[l], layers.level[l + 1],
           GatherRows<typename Exec::memory_space, Value*, Value*>{layers.rows, value, value});
}

/// sources(item) += the sum of weight targets(row), where sources are three arrays.
template <class MemorySpace>
struct AddToField {
  TransposedRows<MemorySpace> rows;
  Vec3 const* targets;
  Field<double> sources;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    Index const source = rows.source(n);
    Vec3 sum = sources[source];
    for (Index k = rows.first(n); k < rows.first(n + 1); ++k) sum += rows.weight(k) * targets[rows.target(k)];
    sources.set(source, sum);
  }
};

template <class Value>
struct ClearValues {
  Value* value;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { value[n] = Value{}; }
};
/// Clears the values of listed nodes, which had been written over.
template <class MemorySpace>
struct ClearListed {
  Kokkos::View<std::int32_t const*, MemorySpace> node;
  Vec3* value;
  [[nodiscard]] Index size() const { return Index(node.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const { value[node(k)] = {}; }
};

/// Adds to the gradient of a group's motion that of its value_at() x, g, with a weight.
KOKKOS_INLINE_FUNCTION void add_value_gradient(Vec3& to, Vec3 const& g, double weight, Vec3 const&, Vec3 const&) {
  to += weight * g;
}
KOKKOS_INLINE_FUNCTION void add_value_gradient(AffineMotion& to, Vec3 const& g, double weight, Vec3 const& centre,
                                               Vec3 const& x) {
  Vec3 const arm = x - centre;
  double const a[3] = {arm.x, arm.y, arm.z}, b[3] = {weight * g.x, weight * g.y, weight * g.z};
  to.u += weight * g;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) to.gradient.m[i][j] += b[i] * a[j];
}

/// Groups from lattice nodes; sources are groups.
template <class MemorySpace, class Value>
struct GroupsFromLattice {
  TransposedRows<MemorySpace> rows;
  Kokkos::View<Vec3 const*, MemorySpace> centre, place;  ///< of groups; of lattice nodes
  Vec3 const* value;
  Value* group;

  [[nodiscard]] Index size() const { return rows.size(); }
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    Index const at = rows.source(n);
    Vec3 const here = centre(at);
    Value sum = group[at];
    for (Index k = rows.first(n); k < rows.first(n + 1); ++k) {
      Index const from = rows.target(k);
      add_value_gradient(sum, value[from], rows.weight(k), here, place(from));
    }
    group[at] = sum;
  }
};

/// Nodes that read a lattice, cell by cell, in chunks of at most so many.
constexpr Index lattice_chunk = 256;
template <class MemorySpace>
struct LatticeReaders {
  UniformLattice shape;
  Kokkos::View<std::int32_t const*, MemorySpace> node;          ///< those of chunk c from first(c) on
  Kokkos::View<Index const*, MemorySpace> first;                ///< (chunks + 1)
  Kokkos::View<std::int32_t const*, MemorySpace> lattice_node;  ///< of cells that hold any of them
  Kokkos::View<Index const*, MemorySpace> first_part;  ///< first of `part` for each lattice node, and one past the last
  Kokkos::View<std::int32_t const*, MemorySpace> part;  ///< LatticeParts::parts, cell by cell
  Index n_chunks = 0;
};

/// The gradients at the corners of the cell of each chunk, which is an item. parts: eight per chunk, of the corners of
/// its cell, which are computed with in lanes.
template <class MemorySpace>
struct LatticeParts {
  LatticeReaders<MemorySpace> readers;
  Field<double const> x;
  Vec3 const* gradient;  ///< of what the nodes read
  Vec3* parts;
  KOKKOS_INLINE_FUNCTION void operator()(Index c) const {
    Corners sum[3];
    LatticeReader<Vec3> const lattice(readers.shape);
    Index const begin = readers.first(c), end = readers.first(c + 1);
    for (Index k = begin; k < end; ++k) {
      Index const n = readers.node(k);
      Vec3 const g = gradient[n];
      Vec3 const t = lattice.place(x[n]).t;
      for (int m = 0; m < n_lanes; ++m) {
        T const weight = share<0>(t.x, m) * share<1>(t.y, m) * share<2>(t.z, m);
        sum[0].of[m] += weight * g.x;
        sum[1].of[m] += weight * g.y;
        sum[2].of[m] += weight * g.z;
      }
    }
    double at_corner[3][8];
    for (int a = 0; a < 3; ++a)
      for (int m = 0; m < n_lanes; ++m) store_lanes(at_corner[a] + width * m, sum[a].of[m]);
    for (int corner = 0; corner < 8; ++corner)
      parts[8 * c + corner] = {at_corner[0][corner], at_corner[1][corner], at_corner[2][corner]};
  }

 private:
  static constexpr int width = native_lanes, n_lanes = 8 / width;
  using T = Lanes<width>;
  struct Corners {
    T of[n_lanes] = {};
  };
  /// The share along an axis of the corners from m width on: t of those whose bit `axis` is set, 1 - t of the others.
  template <int axis>
  KOKKOS_FORCEINLINE_FUNCTION static T share(double t, int m) {
    double upper[width];
    for (int w = 0; w < width; ++w) upper[w] = ((m * width + w) >> axis) & 1;
    return load_lanes<T>(upper) > 0 ? broadcast<T>(t) : broadcast<T>(1 - t);
  }
};
/// The gradient of each lattice node that is read, which is an item and gathers from the cells around it; the others
/// stay zero.
template <class MemorySpace>
struct LatticeSums {
  LatticeReaders<MemorySpace> readers;
  Vec3 const* parts;
  Vec3* value;
  KOKKOS_INLINE_FUNCTION void operator()(Index k) const {
    Vec3 sum;
    for (Index m = readers.first_part(k); m < readers.first_part(k + 1); ++m) sum += parts[readers.part(m)];
    value[readers.lattice_node(k)] = sum;
  }
};
/// Gathers `value`, the gradients of lattice nodes, from those of what nodes read; parts: workspace.
template <class Exec>
void gather_readers(Exec const& exec, LatticeReaders<typename Exec::memory_space> const& readers,
                    Field<double const> const& x, Vec3 const* gradient, Vec3* parts, Vec3* value) {
  using Memory = typename Exec::memory_space;
  launch("gridmorph::transposed::lattice_parts", exec, 0, readers.n_chunks,
         LatticeParts<Memory>{readers, x, gradient, parts});
  launch("gridmorph::transposed::lattice", exec, 0, Index(readers.lattice_node.extent(0)),
         LatticeSums<Memory>{readers, parts, value});
}

/// Transpose of PassMotions, by places: each gathers from the rows that name it. Sources in layers as in
/// TransposedLayers.
template <class MemorySpace>
struct PassMotionsBack {
  TransposedRows<MemorySpace> rows;                     ///< of places
  Kokkos::View<std::int32_t const*, MemorySpace> node;  ///< (places)
  Kokkos::View<float const*, MemorySpace> kept;  ///< (places) share of turns that is handed on; 1 where no row is
  Field<double const> x;
  AffineMotion* motion;

  KOKKOS_INLINE_FUNCTION void operator()(Index n) const {
    Index const place = rows.source(n);
    AffineMotion sum = motion[place];
    Vec3 const here = x[node(place)];
    for (Index k = rows.first(n); k < rows.first(n + 1); ++k) {
      Index const target = rows.target(k);
      AffineMotion const& g = motion[target];
      sum.gradient = (sum + (rows.weight(k) * double(kept(target))) * AffineMotion{{}, g.gradient}).gradient;
      add_value_gradient(sum, g.u, rows.weight(k), here, x[node(target)]);
    }
    motion[place] = sum;
  }
};
/// At listed places, what rows have written to u becomes the first gradient of their motion.
template <class MemorySpace>
struct MotionsFromNodes {
  Kokkos::View<std::int32_t const*, MemorySpace> place, node;
  Vec3* u;
  AffineMotion* motion;
  [[nodiscard]] Index size() const { return Index(place.extent(0)); }
  KOKKOS_INLINE_FUNCTION void operator()(Index r) const {
    Index const n = node(place(r));
    motion[place(r)] = {u[n]};
    u[n] = {};
  }
};

}  // namespace gridmorph::kernels
