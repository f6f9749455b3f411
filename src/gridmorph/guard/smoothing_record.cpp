#include <gridmorph/core/error.hpp>
#include <gridmorph/guard/guard.hpp>
#include <gridmorph/guard/shape_smoothing.hpp>
#include <gridmorph/kernels/symmetric_eigen.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/morph/apply_on_host.hpp>
#include <gridmorph/morph/morph.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/plan/block_points.hpp>
#include <gridmorph/plan/boundary_size.hpp>
#include <gridmorph/plan/smoothing_map.hpp>
#include <gridmorph/quality/quality.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

namespace gridmorph {

namespace {

constexpr char const* who = "gridmorph::SmoothingRecord::add";

struct Mode {
  int part;
  double value;                    ///< eigenvalue
  std::vector<double> of_records;  ///< eigenvector
};

/// Eigenvectors of the products of vectors with one another, largest values first, down to `least` of the largest.
/// places: of the vectors, those of `part`.
std::vector<Mode> modes_of(std::vector<std::vector<Vec3> const*> const& u, std::vector<std::size_t> const& places,
                           int part, double least) {
  constexpr std::size_t most = SmoothingRecord::most;
  double a[most][most] = {}, v[most][most];
  for (std::size_t k = 0; k < u.size(); ++k)
    for (std::size_t m = 0; m <= k; ++m) {
      for (std::size_t const b : places) a[k][m] += dot((*u[k])[b], (*u[m])[b]);
      a[m][k] = a[k][m];
    }
  kernels::diagonalise(a, v);
  std::vector<Mode> out;
  for (std::size_t d = 0; d < most; ++d) out.push_back({part, a[d][d], {v[d], v[d] + u.size()}});
  std::stable_sort(out.begin(), out.end(), [](Mode const& l, Mode const& r) { return l.value > r.value; });
  double const largest = out.front().value;
  std::erase_if(out, [&](Mode const& m) { return !(m.value > least * largest) || !(m.value > 0); });
  return out;
}

/// Takes nodes on slip surfaces, point by point, out of those that move in space.
void add_slides(BlockPoints const& points, SmoothingMap& map) {
  std::map<int, std::int32_t> number;  // of a surface, in the map
  std::vector<std::uint8_t> done(map.n_nodes, 0);
  std::vector<Index> free;
  std::vector<Vec3> shifts;
  auto const modes = std::size_t(map.n_modes);
  auto const append = [&](std::vector<Vec3>& to, std::size_t at) {
    to.insert(to.end(), map.shift.begin() + std::ptrdiff_t(at * modes),
              map.shift.begin() + std::ptrdiff_t((at + 1) * modes));
  };
  for (std::size_t at = 0; at < map.node.size(); ++at) {
    if (done[map.node[at]] != 0) continue;
    std::vector<PointNode> nodes;
    points.for_each_node(map.node[at], [&](PointNode const& n) { nodes.push_back(n); });
    auto const slide = points.sliding(nodes);
    auto const of_frame = slide && slide->count > 0
                              ? std::lower_bound(map.node.begin(), map.node.end(), slide->node.node)
                              : map.node.end();
    if (of_frame == map.node.end() || *of_frame != slide->node.node) {
      free.push_back(map.node[at]);
      append(shifts, at);
      continue;
    }
    kernels::SlidingShift entry{
        points.slot(slide->node.node),      slide->node.node, slide->node.matrix, {-1, -1, -1}, {0, 0, 0},
        points.baseline()[slide->node.node]};
    for (int m = 0; m < slide->count; ++m) {
      int const surface = slide->surface[m];
      auto const [known, fresh] = number.try_emplace(surface, std::int32_t(map.surfaces.size()));
      if (fresh) map.surfaces.push_back(points.slip_surfaces()[surface]);
      entry.surface[m] = known->second;
      entry.own_offset[m] = slide->own_offset[m];
    }
    for (PointNode const& n : nodes) {
      done[n.node] = 1;
      map.slide_nodes.push_back({n.node, std::int32_t(map.slides.size()), n.matrix});
    }
    append(map.slide_shift, std::size_t(of_frame - map.node.begin()));
    map.slides.push_back(entry);
  }
  map.node = std::move(free);
  map.shift = std::move(shifts);
}

}  // namespace

void SmoothingRecord::add(std::span<Vec3 const> boundary, Coordinates const& plain, Coordinates const& guarded) {
  Index const n_nodes = plan_.n_nodes();
  require_boundary_size(who, boundary.size(), std::size_t(plan_.n_boundary_nodes()), "MorphPlan::boundary_nodes()");
  if (plain.size() != n_nodes || guarded.size() != n_nodes)
    throw ConfigError(std::string(who) + ": " + std::to_string(plain.size()) + " and " +
                      std::to_string(guarded.size()) + " nodes, and the plan's mesh has " + std::to_string(n_nodes));
  if (size() == most)
    throw ConfigError(std::string(who) + ": " + std::to_string(most) +
                      " displacements are recorded already; leave out some between them");
  Recorded now{{boundary.begin(), boundary.end()}, {}};
  for (Index n = 0; n < n_nodes; ++n)
    if (Vec3 const s = guarded[n] - plain[n]; !(s == Vec3{})) now.shift.emplace_back(n, s);
  recorded_.push_back(std::move(now));
}

std::shared_ptr<SmoothingMap const> SmoothingRecord::map(FreezeOptions const& options) const {
  auto made = std::make_shared<SmoothingMap>();
  SmoothingMap& out = *made;
  out.n_nodes = plan_.n_nodes();
  std::vector<Index> const boundary_nodes = plan_.boundary_nodes();
  out.n_boundary = Index(boundary_nodes.size());
  std::vector<std::vector<Vec3> const*> u;
  for (Recorded const& r : recorded_) {
    u.push_back(&r.boundary);
    for (auto const& [node, shift] : r.shift) out.node.push_back(node);
  }
  std::sort(out.node.begin(), out.node.end());
  out.node.erase(std::unique(out.node.begin(), out.node.end()), out.node.end());
  auto const part_of = [&](Index node) { return options.part_of_node.empty() ? 0 : options.part_of_node[node]; };
  std::map<int, std::vector<std::size_t>> places;  // of boundary nodes, by part
  for (std::size_t b = 0; b < boundary_nodes.size(); ++b) places[part_of(boundary_nodes[b])].push_back(b);
  std::set<int> moved;
  for (Index const node : out.node) moved.insert(part_of(node));
  std::vector<Mode> modes;
  for (int const part : moved) {
    auto const own = modes_of(u, places[part], part, options.least_share * options.least_share);
    modes.insert(modes.end(), own.begin(), own.end());
  }
  out.n_modes = int(modes.size());
  out.n_records = size();
  if (modes.empty()) {
    out.node.clear();
    return made;
  }
  out.gauge.resize(modes.size() * std::size_t(out.n_boundary));
  out.shift.resize(out.node.size() * modes.size());
  for (std::size_t d = 0; d < modes.size(); ++d)
    for (std::size_t k = 0; k < recorded_.size(); ++k) {
      double const share = modes[d].of_records[k];
      for (std::size_t const b : places[modes[d].part])
        out.gauge[d * std::size_t(out.n_boundary) + b] += share / modes[d].value * (*u[k])[b];
      std::size_t at = 0;
      for (auto const& [node, shift] : recorded_[k].shift) {
        if (part_of(node) != modes[d].part) continue;
        while (out.node[at] != node) ++at;
        out.shift[at * modes.size() + d] += share * shift;
      }
    }
  // a_d(u_k) = v_d(k); modes of other parts have no shift at a node.
  for (std::size_t k = 0; k < recorded_.size(); ++k) {
    auto next = recorded_[k].shift.begin();
    for (std::size_t at = 0; at < out.node.size(); ++at) {
      bool const has_shift = next != recorded_[k].shift.end() && next->first == out.node[at];
      Vec3 left = has_shift ? (next++)->second : Vec3{};
      out.largest_shift = std::max(out.largest_shift, norm(left));
      for (std::size_t d = 0; d < modes.size(); ++d)
        left = left - modes[d].of_records[k] * out.shift[at * modes.size() + d];
      out.misfit = std::max(out.misfit, norm(left));
    }
  }
  if (PlanAccess::chains(plan_) != nullptr) add_slides(PlanAccess::block_points(plan_), out);
  return made;
}

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

Coordinates copy_of(Coordinates const& x) {
  Coordinates out(x.size());
  Kokkos::deep_copy(out.x, x.x);
  Kokkos::deep_copy(out.y, x.y);
  Kokkos::deep_copy(out.z, x.z);
  return out;
}

}  // namespace

MorphPlan freeze_guard(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan,
                       std::span<std::vector<Vec3> const> boundaries, FreezeOptions const& options) {
  SmoothingRecord record(plan);
  Morpher<Exec> const morpher(Exec(), plan.with(nullptr), mesh.mesh().coordinates);
  Coordinates plain(mesh.n_nodes());
  // Smoothed alike in all of them, meshes between those recorded follow.
  bool const alike = PlanAccess::chains(plan) != nullptr && boundaries.size() > 1;
  FrozenSmoothing lost;
  if (alike)
    for (std::vector<Vec3> const& boundary : boundaries) {
      apply_on_host(morpher, boundary, plain);
      lost.join(lost_shapes(host, mesh, plain));
    }
  for (std::vector<Vec3> const& boundary : boundaries) {
    apply_on_host(morpher, boundary, plain);
    Coordinates guarded = copy_of(plain);
    if (alike)
      (void)smooth_frozen(host, mesh, plan, guarded, lost);
    else
      (void)guard(host, mesh, plan, guarded);
    record.add(boundary, plain, guarded);
  }
  return plan.with(record.map(options));
}

}  // namespace gridmorph
