#include <gridmorph/core/for_many.hpp>
#include <gridmorph/kernels/turned_line.hpp>
#include <gridmorph/plan/blocks/host_lines.hpp>
#include <gridmorph/plan/blocks/turned_lines.hpp>
#include <gridmorph/plan/blocks/wall_roots.hpp>

#include <algorithm>
#include <iterator>

namespace gridmorph {
namespace {

/// Calls visit(position (s, a, b) on the chain, its place in the chain's frame) for the nodes of a piece from `first`
/// to `last` along each axis of the chain.
template <class Visit>
void for_nodes(PlanContext const& context, PlacedBox const& box, PieceNodes const& piece, Index3 const& first,
               Index3 const& last, Visit const& visit) {
  Index3 at{};
  for (at[2] = first[2]; at[2] <= last[2]; ++at[2])
    for (at[1] = first[1]; at[1] <= last[1]; ++at[1])
      for (at[0] = first[0]; at[0] <= last[0]; ++at[0]) {
        Index node = piece.first;
        for (int d = 0; d < 3; ++d) node += at[d] * piece.stride[d];
        visit(Index3{box.begin[0] + at[0], box.begin[1] + at[1], box.begin[2] + at[2]},
              box.in_chain_frame(context.mesh.coordinates[node]));
      }
}

/// Calls visit(ps, pa, pb) for the pieces at the lower (end 0) or upper end of a chain along an axis.
template <class Visit>
void for_end_pieces(ChainLayout const& layout, int axis, int end, Visit const& visit) {
  Index3 first{0, 0, 0}, last{layout.n[0] - 1, layout.n[1] - 1, layout.n[2] - 1};
  (end == 0 ? last : first)[axis] = end == 0 ? 0 : layout.n[axis] - 1;
  for (int pb = first[2]; pb <= last[2]; ++pb)
    for (int pa = first[1]; pa <= last[1]; ++pa)
      for (int ps = first[0]; ps <= last[0]; ++ps) visit(ps, pa, pb);
}

/// Visits all nodes of the chain at one of its ends along an axis.
template <class Visit>
void for_end_nodes(PlanContext const& context, Chain const& chain, ChainLayout const& layout, int axis, int end,
                   Visit const& visit) {
  for_end_pieces(layout, axis, end, [&](int ps, int pa, int pb) {
    PieceNodes const piece = piece_nodes(context.mesh, context.topology.lattice, layout.at(ps, pa, pb));
    Index3 first{0, 0, 0}, last{piece.count[0] - 1, piece.count[1] - 1, piece.count[2] - 1};
    (end == 0 ? last : first)[axis] = end == 0 ? 0 : piece.count[axis] - 1;
    for_nodes(context, placed_box(context, chain, layout, ps, pa, pb), piece, first, last, visit);
  });
}

/// Steps along a line from its wall node to the first node that is no nearer than `least`, or to the last one but one
/// of its segment.
int steps_to_resolved(kernels::Segment const& segment, Index node, kernels::Field<double const> const& x,
                      double least) {
  int steps = 1;
  while (steps + 2 < segment.count && norm(x[node + steps * segment.stride_s] - x[node]) < least) ++steps;
  return steps;
}

}  // namespace

void add_turn_positions(PlanContext const& context, Chain const& chain, ChainLayout const& layout, int number,
                        Stage& stage) {
  kernels::Chain const& device = stage.lines.chains[number];
  auto& ends = stage.lines.end_positions;
  ends.resize(stage.lines.n_end_values);
  for (int end = 0; end < 2; ++end)
    for_end_nodes(context, chain, layout, 0, end, [&](Index3 const& at, Vec3 const& x) {
      ends[device.first_end_value + end * device.section_size() + at[1] + Index(device.n_a) * at[2]] = x;
    });
  stage.lines.end_pivots.insert(stage.lines.end_pivots.end(), ends.begin() + Index(stage.lines.end_pivots.size()),
                                ends.end());
  if (device.first_side < 0) return;
  auto& sides = stage.sides.positions;
  sides.resize(stage.sides.t.size());
  for (int q = 0; q < 4; ++q) {
    Index const first = stage.sides.sides[device.first_side + q].first;
    for_end_nodes(context, chain, layout, 1 + q / 2, q % 2, [&](Index3 const& at, Vec3 const& x) {
      sides[first + at[0] + Index(device.n_s) * at[q < 2 ? 2 : 1]] = x;
    });
  }
}

void add_near_field_lines(PlanContext const& context, Chain const& chain, ChainLayout const& layout, int number,
                          Stage& stage) {
  kernels::Chain const& device = stage.lines.chains[number];
  Lattice const& lattice = context.topology.lattice;
  std::vector<std::pair<std::int32_t, std::int32_t>> roots(device.section_size(), {-1, -1});
  for_end_pieces(layout, 0, 0, [&](int ps, int pa, int pb) {
    PlacedBox const box = placed_box(context, chain, layout, ps, pa, pb);
    for (int category = 0; category < 9; ++category) {
      int const entity = chain_entity(lattice, layout.at(ps, pa, pb), {0, category % 3, category / 3});
      auto const rows = context.skeleton.rows(entity);
      if (!rows) continue;
      std::int32_t const matrix = to_chain_frame(context, box, entity);
      for (int q = 0; q < rows->n_q; ++q)
        for (int p = 0; p < rows->n_p; ++p) {
          Index3 const at = box.position(node_at(*rows, p, q));
          roots[at[1] + Index(device.n_a) * at[2]] = {context.roots->of_slot(rows->slot + p + rows->slot_q * q),
                                                      matrix};
        }
    }
  });

  kernels::Field<double const> const x{context.mesh.coordinates.x.data(), context.mesh.coordinates.y.data(),
                                       context.mesh.coordinates.z.data()};
  kernels::LineTable<Kokkos::HostSpace> const table = host_lines(stage.lines);
  struct Line {
    kernels::Tube const* tube;
    int a, b;
  };
  std::vector<Line> lines;
  for (kernels::Tube const& tube : stage.lines.tubes) {
    if (tube.chain != number) continue;
    for (int b = 0; b < tube.n_b; ++b)
      for (int a = 0; a < tube.n_a; ++a) lines.push_back({&tube, a, b});
  }
  auto const first = Index(stage.near_field.size());
  stage.near_field.resize(first + lines.size());
  std::vector<double> resolved_at(lines.size());
  detail::for_many(context.host, "gridmorph::near_field_lines", Index(lines.size()), [&](Index n) {
    auto const [tube, a, b] = lines[n];
    kernels::Segment const& segment = stage.lines.segments[tube->first_segment];
    Index const at = tube->a_begin + a + Index(device.n_a) * (tube->b_begin + b);
    auto const [root, matrix] = roots[at];
    Index const node = segment.first + a * segment.stride_a + b * segment.stride_b;
    int const steps = steps_to_resolved(segment, node, x, context.roots->resolved_arm());
    Vec3 const edge = x[node + steps * segment.stride_s] - x[node];
    double t = 0;
    kernels::walk_line(table, *tube, a, b, x, [&t, steps](int position, double fraction) {
      if (position == steps) t = fraction;
    });
    resolved_at[n] = t;
    Vec3 normal = fan_normal(context.roots->nodes()[root].around);
    if (matrix >= 0) normal = context.rotations[matrix] * normal;
    double const size = norm(normal);
    stage.near_field[first + n] = {device.first_end_value + at,
                                   device.first_end_value + device.section_size() + at,
                                   root,
                                   matrix,
                                   size > 0 ? (1 / size) * normal : Vec3{},
                                   edge,
                                   kernels::near_field_weight(t)};
  });
  // Several lines stand on the roots of edges: what they say of them is taken in their order.
  for (std::size_t n = 0; n < lines.size(); ++n) {
    kernels::NearFieldLine const& line = stage.near_field[std::size_t(first) + n];
    double const length = norm(line.edge);
    if (resolved_at[n] > 0) context.roots->set_thickness(line.root, length / resolved_at[n]);
    if (length > 0)
      context.roots->add_line(
          line.root,
          (1 / length) * (line.matrix >= 0 ? transpose(context.rotations[line.matrix]) * line.edge : line.edge));
  }
}

void leave_out_outer_edges_at_rest(WallRoots const& roots, Stage& stage) {
  std::vector<kernels::Chain>& chains = stage.lines.chains;
  for (kernels::Chain& chain : chains)
    if (chain.turn == kernels::TurnLaw::near_field) chain.turned_ends = 1;
  for (kernels::NearFieldLine const& line : stage.near_field) {
    if (roots.nodes()[line.root].turn == 0) continue;
    auto const after =
        std::upper_bound(chains.begin(), chains.end(), line.lower,
                         [](Index end, kernels::Chain const& chain) { return end < chain.first_end_value; });
    std::prev(after)->turned_ends = 3;
  }
}

}  // namespace gridmorph
