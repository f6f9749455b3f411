// Tables of a plan of elements turned round, source by source, for the transpose of its morph.
#pragma once

#include <gridmorph/kernels/transposed_nodes.hpp>
#include <gridmorph/kernels/transposed_rows.hpp>
#include <gridmorph/morph/stages/upload.hpp>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::stages {

/// Rows source -> (target, weight), unsorted.
struct TransposedEntries {
  std::vector<Index32> source, target;
  std::vector<double> weight;

  void add(Index32 from, Index32 to, double w) {
    source.push_back(from);
    target.push_back(to);
    weight.push_back(w);
  }
  /// Adds the entries of an operator, the weight that a row leaves its first item included.
  void add(InterpolationOperator const& rows) {
    add(rows, [](Index32) { return true; });
  }
  /// Adds the rows whose targets count.
  template <class Counts>
  void add(InterpolationOperator const& rows, Counts const& counts) {
    for (std::size_t r = 0; r < rows.target.size(); ++r)
      if (counts(rows.target[r])) add_row(rows, r, rows.target[r]);
  }
  /// The targets being the numbers of the rows.
  void add_by_row(InterpolationOperator const& rows) {
    for (std::size_t r = 0; r < rows.target.size(); ++r) add_row(rows, r, Index32(r));
  }

 private:
  void add_row(InterpolationOperator const& rows, std::size_t r, Index32 target) {
    Index const from = rows.first[r], to = rows.first[r + 1];
    double first = 1;
    for (Index k = from + 1; k < to; ++k) first -= double(rows.weight[k]);
    for (Index k = from; k < to; ++k) add(rows.item[k], target, k == from ? first : double(rows.weight[k]));
  }
};

/// In the memory of an execution space, sorted by counting. order: of each source, those with the greatest gather
/// first, a launch each; all at once where it is empty. Fences.
template <class Exec>
kernels::TransposedLayers<typename Exec::memory_space> upload(Exec const& exec, TransposedEntries const& of,
                                                              std::vector<int> const& order, std::string const& label) {
  std::size_t n_sources = order.size();
  for (Index32 const s : of.source) n_sources = std::max(n_sources, std::size_t(s) + 1);
  std::vector<Index> count(n_sources, 0);
  for (Index32 const s : of.source) ++count[s];
  std::vector<Index32> source;
  for (std::size_t s = 0; s < n_sources; ++s)
    if (count[s] > 0) source.push_back(Index32(s));
  if (!order.empty())
    std::stable_sort(source.begin(), source.end(), [&](Index32 a, Index32 b) { return order[a] > order[b]; });
  std::vector<Index> first, level, next(n_sources, 0);
  Index n = 0;
  for (std::size_t k = 0; k < source.size(); ++k) {
    auto const s = std::size_t(source[k]);
    if (k == 0 || (!order.empty() && order[s] != order[source[k - 1]])) level.push_back(Index(k));
    first.push_back(n);
    next[s] = n;
    n += count[s];
  }
  first.push_back(n);
  level.push_back(Index(source.size()));
  std::vector<Index32> target(n, 0);
  std::vector<double> weight(n, 0);
  for (std::size_t k = 0; k < of.source.size(); ++k) {
    auto const to = std::size_t(next[of.source[k]]++);
    target[to] = of.target[k];
    weight[to] = of.weight[k];
  }
  kernels::TransposedLayers<typename Exec::memory_space> out{{upload(exec, source, label), upload(exec, first, label),
                                                              upload(exec, target, label), upload(exec, weight, label)},
                                                             level};
  compat::fence(exec, "gridmorph::Morpher (host tables may go)");
  return out;
}

template <class Exec>
kernels::TransposedRows<typename Exec::memory_space> transposed(Exec const& exec, InterpolationOperator const& rows,
                                                                std::string const& label) {
  TransposedEntries entries;
  entries.add(rows);
  return upload(exec, entries, {}, label).rows;
}

/// Sources from the last layer to the first, then those in none.
template <class Exec>
kernels::TransposedLayers<typename Exec::memory_space> transposed(Exec const& exec, LayerRows const& layers,
                                                                  Index n_values, std::string const& label) {
  std::vector<int> layer(n_values, 0);
  for (std::size_t l = 0; l + 1 < layers.level.size(); ++l)
    for (Index r = layers.level[l]; r < layers.level[l + 1]; ++r) layer[layers.rows.target[r]] = int(l) + 1;
  TransposedEntries entries;
  entries.add(layers.rows);
  return upload(exec, entries, layer, label);
}

/// from[k] -> to[k], or k itself where there is no `to`: of copies, and of listed values of slots. Negative ones are
/// left out.
template <class Exec>
kernels::TransposedRows<typename Exec::memory_space> transposed(Exec const& exec, std::vector<Index32> const& from,
                                                                std::vector<Index32> const* to,
                                                                std::string const& label) {
  TransposedEntries entries;
  for (std::size_t k = 0; k < from.size(); ++k)
    if (from[k] >= 0) entries.add(from[k], to ? (*to)[k] : Index32(k), 1);
  return upload(exec, entries, {}, label).rows;
}

struct CopyPositions {
  Baseline x;
  Vec3* to;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { to[n] = x[n]; }
};
/// Positions of the baseline on the host. Fences.
template <class Exec>
std::vector<Vec3> host_positions(Exec const& exec, Baseline const& x, Index n) {
  auto const all = room_for<Vec3>(exec, n, "gridmorph::Morpher::positions");
  kernels::launch("gridmorph::Morpher::positions", exec, 0, n, CopyPositions{x, all.data()});
  compat::fence(exec, "gridmorph::Morpher (positions are read on the host)");
  auto const host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), all);
  return {host.data(), host.data() + host.extent(0)};
}

/// Nodes that read a lattice, each once, by cells.
struct ReadersOfCells {
  Index cells[3];
  std::vector<Index32> node;
  std::vector<Index> begin;  ///< (cells + 1)

  ReadersOfCells(kernels::UniformLattice const& shape, std::vector<Index32> nodes, std::vector<Vec3> const& x) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (int a = 0; a < 3; ++a) cells[a] = std::max<Index>(1, shape.nodes[a] - 1);
    begin.assign(std::size_t(cells[0] * cells[1] * cells[2]) + 1, 0);
    std::vector<Index> cell;
    kernels::LatticeReader<Vec3> const lattice(shape);
    for (Index32 const n : nodes) {
      Vec3 const at = lattice.place(x[n]).cell;
      cell.push_back(Index(at.x) + cells[0] * (Index(at.y) + cells[1] * Index(at.z)));
      ++begin[std::size_t(cell.back()) + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    node.resize(nodes.size());
    std::vector<Index> next(begin.begin(), begin.end() - 1);
    for (std::size_t k = 0; k < nodes.size(); ++k) node[next[cell[k]]++] = nodes[k];
  }
};

/// In the memory of an execution space; is_read: of each lattice node, is set. Fences.
template <class Exec>
kernels::LatticeReaders<typename Exec::memory_space> lattice_readers(Exec const& exec,
                                                                     kernels::UniformLattice const& shape,
                                                                     ReadersOfCells const& readers,
                                                                     std::vector<bool>& is_read,
                                                                     std::string const& label) {
  std::vector<Index> first;
  std::vector<std::vector<Index32>> parts(shape.size());
  Index const n_cells = Index(readers.begin.size()) - 1;
  for (Index c = 0; c < n_cells; ++c)
    for (Index k = readers.begin[c]; k < readers.begin[c + 1]; k += kernels::lattice_chunk) {
      Index const at[3] = {c % readers.cells[0], c / readers.cells[0] % readers.cells[1],
                           c / (readers.cells[0] * readers.cells[1])};
      for (int corner = 0; corner < 8; ++corner) {
        Index node[3];
        bool inside = true;  // a flat lattice has no upper corners
        for (int a = 0; a < 3; ++a) {
          node[a] = at[a] + ((corner >> a) & 1);
          inside = inside && node[a] < shape.nodes[a];
        }
        if (inside)
          parts[node[0] + shape.nodes[0] * (node[1] + shape.nodes[1] * node[2])].push_back(
              Index32(8 * Index(first.size()) + corner));
      }
      first.push_back(k);
    }
  Index const n_chunks = Index(first.size());
  first.push_back(Index(readers.node.size()));
  std::vector<Index32> lattice_node, part;
  std::vector<Index> first_part;
  is_read.assign(parts.size(), false);
  for (std::size_t n = 0; n < parts.size(); ++n) {
    if (parts[n].empty()) continue;
    is_read[n] = true;
    lattice_node.push_back(Index32(n));
    first_part.push_back(Index(part.size()));
    part.insert(part.end(), parts[n].begin(), parts[n].end());
  }
  first_part.push_back(Index(part.size()));
  kernels::LatticeReaders<typename Exec::memory_space> out{shape,
                                                           upload(exec, readers.node, label),
                                                           upload(exec, first, label),
                                                           upload(exec, lattice_node, label),
                                                           upload(exec, first_part, label),
                                                           upload(exec, part, label),
                                                           n_chunks};
  compat::fence(exec, "gridmorph::Morpher (host tables may go)");
  return out;
}

/// The transpose of a SmoothField and of what nodes read of it.
template <class Exec, class Value>
class SmoothFieldBack {
 public:
  /// readers: all nodes that read it.
  SmoothFieldBack(Exec const& exec, InverseDistanceField const& plan, std::vector<Index32> readers,
                  std::vector<Vec3> const& x, std::string const& label) {
    if (plan.empty()) return;
    leaves_ = transposed(exec, plan.leaves, label);
    groups_ = transposed(exec, plan.groups, plan.n_groups, label);
    std::vector<bool> is_read;
    readers_ = lattice_readers(exec, plan.shape, ReadersOfCells(plan.shape, std::move(readers), x), is_read, label);
    TransposedEntries rows;
    rows.add(plan.lattice, [&](Index32 n) { return bool(is_read[n]); });
    lattice_ = upload(exec, rows, {}, label).rows;
    centre_ = upload(exec, plan.centre, label);
    std::vector<Vec3> place;
    for (Index n = 0; n < plan.shape.size(); ++n) place.push_back(plan.shape.position(n));
    place_ = upload(exec, place, label);
    group_ = room_for<Value>(exec, plan.n_groups, label);
    value_ = room_for<Vec3>(exec, plan.shape.size(), label);
    parts_ = room_for<Vec3>(exec, std::size_t(8 * readers_.n_chunks), label);
  }

  /// given += gradients of what the boundary nodes say, from those of what nodes read, by node.
  void enqueue(Exec const& exec, Baseline const& x, Vec3 const* read, Value* given) const {
    using Memory = typename Exec::memory_space;
    using kernels::launch;
    kernels::gather_readers(exec, readers_, x, read, parts_.data(), value_.data());
    launch("gridmorph::transposed::clear_groups", exec, 0, Index(group_.extent(0)),
           kernels::ClearValues<Value>{group_.data()});
    launch("gridmorph::transposed::groups_of_lattice", exec,
           kernels::GroupsFromLattice<Memory, Value>{lattice_, centre_, place_, value_.data(), group_.data()});
    kernels::gather_layers("gridmorph::transposed::groups", exec, groups_, group_.data());
    kernels::gather_rows("gridmorph::transposed::leaves", exec, leaves_, static_cast<Value const*>(group_.data()),
                         given);
  }

 private:
  using Memory = typename Exec::memory_space;
  kernels::TransposedRows<Memory> leaves_, lattice_;
  kernels::TransposedLayers<Memory> groups_;
  List<Exec, Vec3> centre_, place_;
  kernels::LatticeReaders<Memory> readers_;
  List<Exec, Value> group_;
  List<Exec, Vec3> value_, parts_;
};

template <class Value, class Exec>
void clear(Exec const& exec, List<Exec, Value> const& values) {
  kernels::launch("gridmorph::transposed::clear", exec, 0, Index(values.extent(0)),
                  kernels::ClearValues<Value>{values.data()});
}

/// Vectors as three arrays.
inline kernels::Field<double> as_field(Vec3* v) { return {&v->x, &v->y, &v->z, 3}; }

}  // namespace gridmorph::stages
