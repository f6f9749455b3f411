#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/morph/detail/line_groups.hpp>
#include <gridmorph/morph/detail/transposed_plan.hpp>

#include <algorithm>
#include <set>
#include <utility>

namespace gridmorph::detail {
namespace {

template <class View>
auto on_host(View const& view) {
  auto const copy = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
  using T = typename View::non_const_value_type;
  return std::vector<T>(copy.data(), copy.data() + copy.extent(0));
}

struct Pair {
  Index of, item;
  std::int32_t matrix = -1;
};
void sort(std::vector<Pair>& pairs) {
  std::stable_sort(pairs.begin(), pairs.end(), [](Pair const& a, Pair const& b) { return a.of < b.of; });
}
struct Rows {
  std::vector<Index> of, first, item;
  std::vector<std::int32_t> matrix;
};
Rows rows_of(std::vector<Pair> pairs) {
  sort(pairs);
  Rows rows;
  for (Pair const& p : pairs) {
    if (rows.of.empty() || rows.of.back() != p.of) {
      rows.of.push_back(p.of);
      rows.first.push_back(Index(rows.item.size()));
    }
    rows.item.push_back(p.item);
    rows.matrix.push_back(p.matrix);
  }
  rows.first.push_back(Index(rows.item.size()));
  return rows;
}

template <class Exec>
kernels::CopiesOf<typename Exec::memory_space> copies_of(Exec const& exec, std::vector<Pair> pairs) {
  Rows const rows = rows_of(std::move(pairs));
  kernels::CopiesOf<typename Exec::memory_space> const out{
      table(exec, rows.of, "transposed::sources"), table(exec, rows.first, "transposed::first"),
      table(exec, rows.item, "transposed::copies"), table(exec, rows.matrix, "transposed::matrices")};
  compat::fence(exec, "gridmorph::Morpher (host tables may go)");
  return out;
}
template <class Exec>
kernels::CopiesOf<typename Exec::memory_space> copies_of(Exec const& exec,
                                                         std::vector<kernels::NodeCopy> const& copies) {
  std::vector<Pair> pairs;
  for (kernels::NodeCopy const& c : copies)
    for (Index q = 0; q < c.n_q; ++q)
      for (Index p = 0; p < c.n_p; ++p)
        pairs.push_back({c.source + p * c.source_stride_p + q * c.source_stride_q,
                         c.destination + p * c.destination_stride_p + q * c.destination_stride_q, c.matrix});
  // Lists may name a destination more than once, always with the same value: it counts once.
  std::stable_sort(pairs.begin(), pairs.end(), [](Pair const& a, Pair const& b) { return a.item < b.item; });
  pairs.erase(std::unique(pairs.begin(), pairs.end(), [](Pair const& a, Pair const& b) { return a.item == b.item; }),
              pairs.end());
  return copies_of(exec, std::move(pairs));
}

/// Targets and what depends on them; each pair counts once.
using Dependencies = std::vector<std::pair<Index, Index>>;

template <class Exec>
kernels::Dependents<typename Exec::memory_space> dependents(Exec const& exec, Dependencies pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<Pair> list;
  for (auto const& [target, dependent] : pairs) list.push_back({target, dependent});
  Rows const rows = rows_of(std::move(list));
  kernels::Dependents<typename Exec::memory_space> const out{table(exec, rows.of, "transposed::targets"),
                                                             table(exec, rows.first, "transposed::first"),
                                                             table(exec, rows.item, "transposed::dependents")};
  compat::fence(exec, "gridmorph::Morpher (host tables may go)");
  return out;
}

template <class Exec>
TransposedLines<Exec> lines_of(Exec const& exec, LineGroups const& host) {
  using Memory = typename Exec::memory_space;
  TransposedLines<Exec> out;
  out.groups = WorkList<kernels::LineGroup, Memory>(
      exec, host.groups, kernels::LineGradients<Memory, kernels::TileShape<Exec>::lines>::items, "transposed::groups");
  out.bundles = table(exec, host.bundles, "transposed::bundles");
  compat::fence(exec, "gridmorph::Morpher (host tables may go)");
  return out;
}

/// Host copies of what all stages look up.
struct HostPlan {
  std::vector<kernels::Chain> chains;
  std::vector<kernels::Side> sides;
  BundlesOfChains volume;

  template <class Exec>
  explicit HostPlan(DevicePlan<Exec> const& plan)
      : chains(on_host(plan.lines.chains)), sides(on_host(plan.sides.sides)) {
    auto const terms = on_host(plan.terms);
    for (kernels::VolumeBox const& box : on_host(plan.boxes.entries))
      for (int m = 0; m < box.n_terms; ++m) {
        kernels::VolumeTerm const& term = terms[box.first_term + m];
        if (box.n[0] > 0 && box.n[1] > 0 && box.n[2] > 0) volume[term.chain].push_back(bundle_of(box, term));
      }
  }

  /// All nodes that the chains with these end values give something to.
  [[nodiscard]] BundlesOfChains bundles(std::vector<kernels::SkeletonSweep> const& sweeps, Index first_end,
                                        Index n_ends) const {
    BundlesOfChains out;
    for (kernels::SkeletonSweep const& sweep : sweeps) out[sweep.chain].push_back(bundle_of(sweep));
    for (auto const& [chain, list] : volume) {
      Index const first = chains[chain].first_end_value;
      if (first >= first_end && first < first_end + n_ends)
        out[chain].insert(out[chain].end(), list.begin(), list.end());
    }
    return out;
  }
};

/// Slabs of the corrected chains of a stage; returns the room that their parts of edges take.
template <class Exec>
Index add_slabs(Exec const& exec, HostPlan const& host, std::vector<kernels::LineGroup> const& groups,
                std::vector<std::int32_t> const& corrected, TransposedStage<Exec>& stage) {
  std::vector<kernels::SideSlab> slabs;
  std::vector<Index> first_part;
  Index room = 0;
  for (std::int32_t const number : corrected) {
    kernels::Chain const& chain = host.chains[number];
    auto const [begin, end] =
        std::equal_range(groups.begin(), groups.end(), kernels::LineGroup{number, 0, 0, 0, 0, 0, 0},
                         [](kernels::LineGroup const& a, kernels::LineGroup const& b) { return a.chain < b.chain; });
    bool const has_edges = !chain.blends_along(0) && !chain.blends_along(1) && (chain.known_sides >> 4) != 0;
    first_part.push_back(has_edges ? room : -1);
    for (int direction = 0; direction < 2; ++direction)
      for (int w = 0; w < (direction == 0 ? chain.n_b : chain.n_a); ++w)
        slabs.push_back({number, direction, w, std::int32_t(begin - groups.begin()), std::int32_t(end - begin),
                         has_edges && direction == 0 ? room + 4 * Index(w) * chain.n_s : -1});
    if (has_edges) room += 4 * Index(chain.n_b) * chain.n_s;
    for (int q = 0; q < 4; ++q) {
      kernels::Side const& side = host.sides[chain.first_side + q];
      Index const side_end = side.first + Index(chain.n_s) * side.n_w;
      if (stage.n_side_nodes == 0) stage.first_side_node = side.first;
      stage.n_side_nodes = std::max(stage.n_side_nodes, side_end - stage.first_side_node);
    }
  }
  stage.slabs = table(exec, slabs, "transposed::slabs");
  stage.first_part = table(exec, first_part, "transposed::first_part");
  compat::fence(exec, "gridmorph::Morpher (host tables may go)");
  return room;
}

template <class Exec>
TransposedTurns<Exec> turns_of(Exec const& exec, DeviceTurns<Exec> const& turns) {
  auto const roots = on_host(turns.table.roots);
  auto const neighbours = on_host(turns.table.neighbours);
  auto const ends = on_host(turns.table.ends);
  auto const end_walls = on_host(turns.table.end_walls);
  std::vector<Pair> parts, of_ends;
  Dependencies walls_by_slot, walls_by_root;
  for (std::size_t r = 0; r < roots.size(); ++r) {
    for (Index k = roots[r].first_neighbour; k < roots[r].first_neighbour + roots[r].n_neighbours; ++k)
      parts.push_back({neighbours[k].slot, k, neighbours[k].matrix});
    parts.push_back({roots[r].centre, Index(neighbours.size() + r)});
    for (Index m = 0; m < 2; ++m) {
      kernels::RootEnd const& end = ends[r].end[m];
      if (end.end < 0) continue;
      of_ends.push_back({3 * Index(end.end), 4 * Index(r) + 2 * m, end.to_root});
      of_ends.push_back({3 * Index(end.end) + 2, 4 * Index(r) + 2 * m + 1, end.to_root});
    }
  }
  for (std::size_t e = 0; e < end_walls.size(); ++e) {
    walls_by_root.push_back({end_walls[e].root, e});
    if (end_walls[e].wall >= 0)
      walls_by_root.push_back({end_walls[e].wall, e});
    else
      walls_by_slot.push_back({roots[end_walls[e].root].slot, e});
  }
  return {copies_of(exec, std::move(parts)), copies_of(exec, std::move(of_ends)), dependents(exec, walls_by_slot),
          dependents(exec, walls_by_root)};
}

}  // namespace

template <class Exec>
TransposedPlan<Exec>::TransposedPlan(Exec const& exec, DevicePlan<Exec> const& plan) {
  compat::fence(exec, "gridmorph::Morpher (tables are read back)");
  HostPlan const host(plan);
  Index room_for_edges = 0;
  for (DeviceStage<Exec> const& stage : plan.stages) {
    TransposedStage<Exec> t;
    LineGroups const groups =
        groups_of(host.bundles(on_host(stage.sweeps.entries), stage.first_end_value, stage.n_end_values));
    t.lines = lines_of(exec, groups);
    t.ends = copies_of(exec, on_host(stage.ends.entries));
    auto gathers = on_host(stage.gathers);
    for (kernels::NodeCopy& copy : gathers) copy.destination -= plan.n_end_values;  // gradients are where residuals are
    t.gathers = copies_of(exec, gathers);
    room_for_edges = std::max(room_for_edges, add_slabs(exec, host, groups.groups, on_host(stage.corrected), t));
    Dependencies of_root;
    auto const lines = on_host(stage.near_field);
    std::set<Index> seen;  // lines between two tubes are listed with both
    for (std::size_t n = 0; n < lines.size(); ++n) {
      if (!seen.insert(lines[n].lower).second) continue;
      of_root.push_back({lines[n].root, n});
    }
    t.lines_of_root = dependents(exec, of_root);
    stages.push_back(std::move(t));
  }
  for (DeviceSpread<Exec> const& pass : plan.spreads) {
    TransposedSpread<Exec> t;
    t.lines = lines_of(exec, groups_of(host.bundles(on_host(pass.sweeps.entries), pass.first_value, pass.n_values)));
    auto const ends = on_host(pass.ends);
    Dependencies of_slot;
    for (std::size_t n = 0; n < ends.size(); ++n) of_slot.push_back({ends[n].slot, n});
    t.ends_of_slot = dependents(exec, of_slot);
    t.kept = Workspace<Memory>(exec, Index(ends.size()), 1, "transposed::slip_ends");
    spreads.push_back(std::move(t));
  }
  if (plan.turns.any()) turns = turns_of(exec, plan.turns);
  boundary_projections = copies_of(exec, on_host(plan.boundary_projections.entries));
  skeleton_nodes = copies_of(exec, on_host(plan.skeleton_nodes.entries));
  between = Workspace<Memory>(exec, plan.residuals.n, 1, "transposed::between_edges");
  Index const n_roots = Index(plan.turns.table.roots.extent(0)),
              n_neighbours = Index(plan.turns.table.neighbours.extent(0));
  turn_parts = Workspace<Memory>(exec, std::max(n_neighbours + n_roots, 4 * n_roots), 1, "transposed::turn_parts");
  constexpr int shares = kernels::shares_of_sums<Exec>;
  edges = Workspace<Memory>(exec, room_for_edges, shares, "transposed::edges");
  if constexpr (shares > 1) {
    Index most = 0;
    for (TransposedStage<Exec> const& stage : stages) most = std::max(most, stage.n_side_nodes);
    sides = Workspace<Memory>(exec, most, shares, "transposed::sides");
  }
}

#define GRIDMORPH_INSTANTIATE(Exec) template struct TransposedPlan<Exec>;
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph::detail
