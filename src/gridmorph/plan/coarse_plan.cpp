#include <gridmorph/plan/coarse_plan.hpp>
#include <gridmorph/plan/common_parts.hpp>

#include <gridmorph/plan/blocks/host_lines.hpp>

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace gridmorph {
namespace {

std::vector<CutPlane> const& limits_of(PlanBasis const& basis) { return basis.limits.kept_planes; }

int chosen_every(PlanBasis const& basis, Links const& links, int every) {
  constexpr Index enough = 40'000;
  constexpr int widest = 64;
  if (every > 0) return every;
  int n = 4;
  while (n < widest && count_nodes(sampled_planes(basis.mesh, links, limits_of(basis), n)) > enough) n *= 2;
  return n;
}

Topology coarse_topology(CoarseMesh const& coarse, PlanBasis const& basis) {
  MergeLimits limits = basis.limits;
  for (CutPlane& plane : limits.kept_planes) plane.index = coarse.place(plane.zone, plane.axis, plane.index);
  return build_topology(coarse.mesh, coarse.links, limits);
}

/// Puts the parameters of one line where the segments of its tube say, node by node.
class StoreParameters {
 public:
  StoreParameters(LineTables const& lines, kernels::Tube const& tube, int a, int b, double* t)
      : lines_(lines), tube_(tube), a_(a), b_(b), t_(t) {}

  void operator()(int /*position*/, double t) const {
    kernels::Segment const& segment = lines_.segments[tube_.first_segment + m_];
    int const category = kernels::end_category(s_, segment.count) +
                         3 * (kernels::end_category(a_, tube_.n_a) + 3 * kernels::end_category(b_, tube_.n_b));
    if (int const number = segment.target[category]; number >= 0) {
      kernels::ParameterTarget const& to = lines_.targets[number];
      t_[to.first + s_ * to.stride_s + a_ * to.stride_a + b_ * to.stride_b] = t;
    }
    if (++s_ == segment.count) {
      s_ = 0;
      ++m_;
    }
  }

 private:
  LineTables const& lines_;
  kernels::Tube const& tube_;
  int a_, b_;
  double* t_;
  mutable int m_ = 0, s_ = 0;  ///< segment, node in it
};

void append_parameters(LineTables const& lines, GridLengths const& lengths, std::vector<double>& out) {
  std::size_t const first = out.size();
  out.resize(first + std::size_t(lines.n_parameters), 0);
  auto const table = host_lines(lines);
  for (kernels::Tube const& tube : lines.tubes) {
    if (!lines.chains[tube.chain].has_parameters()) continue;
    for (int b = 0; b < tube.n_b; ++b)
      for (int a = 0; a < tube.n_a; ++a)
        kernels::walk_line(table, tube, a, b, lengths, StoreParameters(lines, tube, a, b, out.data() + first));
  }
}

}  // namespace

CoarsePlanner::CoarsePlanner(HostInstance const& host, PreparedMorph const& prepared, int every)
    : prepared_(prepared),
      basis_(plan_basis(prepared.mesh, prepared.links, prepared.surface, prepared.options)),
      every_(chosen_every(basis_, prepared.links, every)),
      coarse_(coarsen(prepared.mesh, prepared.links,
                      sampled_planes(prepared.mesh, prepared.links, limits_of(basis_), every_))),
      topology_(coarse_topology(coarse_, basis_)),
      lines_{coarse_.mesh, topology_, GridLengths(coarse_.mesh, coarse_.lengths)},
      priority_(host, prepared.mesh, basis_.topology, prepared.options.volume, prepared.links.mesh_size) {}

PlannedMorph CoarsePlanner::plan(ChainOrder const& first, ChainOrder* next, ChainChoice choice) {
  PlannedMorph planned =
      build_plan(basis_, priority_, lines_, prepared_.surface, prepared_.options, first, next, choice);
  for (Stage const& stage : planned.plan.stages)
    append_parameters(stage.lines, lines_.lengths, planned.plan.line_parameters);
  for (SpreadPass const& pass : planned.plan.spreads)
    append_parameters(pass.lines, lines_.lengths, planned.plan.line_parameters);
  return planned;
}

Plan CoarsePlanner::with_common_motions(Plan plan, std::span<Vec3 const> boundary) const {
  carry_common_motions(prepared_, boundary, coarse_.mesh, plan);
  return plan;
}

std::vector<Vec3> CoarsePlanner::displacement(Plan const& plan, std::span<Vec3 const> boundary) const {
  std::vector<Index> const& fine = prepared_.plan().boundary_nodes;
  std::unordered_map<Index, std::size_t> place;
  place.reserve(fine.size());
  for (std::size_t n = 0; n < fine.size(); ++n) place.emplace(fine[n], n);
  std::vector<Vec3> out;
  for (Index const node : plan.boundary_nodes) {
    int const z = coarse_.mesh.zone_of(node);
    Index3 const at = coarse_.fine_index(z, coarse_.mesh.zones[z].index(node));
    out.push_back(boundary[place.at(prepared_.mesh.zones[z].node(at))]);
  }
  return out;
}

}  // namespace gridmorph
