#include <gridmorph/core/for_many.hpp>
#include <gridmorph/plan/blocks/chain_tables.hpp>
#include <gridmorph/plan/blocks/host_lines.hpp>

#include <algorithm>

namespace gridmorph {
namespace {

/// Lattice offset of side q (0, 1: a lower, upper; 2, 3: b) or edge e (a upper = 1, b upper = 2) around a chain piece.
Index3 side_which(int q, int s) {
  Index3 w{s, 1, 1};
  w[1 + q / 2] = 2 * (q % 2);
  return w;
}
Index3 edge_which(int e, int s) { return {s, 2 * (e % 2), 2 * (e / 2)}; }

/// The pieces along a side at position ps: all that touch side q.
template <class Visit>
void for_side_pieces(ChainLayout const& layout, int q, int ps, Visit&& visit) {
  int const n = q < 2 ? layout.n[2] : layout.n[1];
  int const fixed = q % 2 == 0 ? 0 : (q < 2 ? layout.n[1] : layout.n[2]) - 1;
  for (int w = 0; w < n; ++w) q < 2 ? visit(layout.at(ps, fixed, w)) : visit(layout.at(ps, w, fixed));
}

ChainPiece const& edge_piece(ChainLayout const& layout, int e, int ps) {
  return layout.at(ps, e % 2 == 0 ? 0 : layout.n[1] - 1, e / 2 == 0 ? 0 : layout.n[2] - 1);
}

std::vector<kernels::Junction> known_around(Topology const& topology, ChainLayout const& layout, Known const& known) {
  Lattice const& lattice = topology.lattice;
  auto is_known = [&](ChainPiece const& piece, Index3 const& which) {
    return known(lattice.class_of(chain_entity(lattice, piece, which)));
  };
  int const n_blocks = int(layout.first_piece.size()) - 1;
  std::vector<kernels::Junction> junctions;
  for (int m = 0; m <= n_blocks; ++m) {
    // The last junction is the upper end of the last block, behind which nothing is along.
    bool const last = m == n_blocks;
    int const ps = last ? layout.n[0] - 1 : layout.first_piece[m];
    int const end = last ? 2 : 0;
    kernels::Junction j{};
    j.position = last ? layout.n_nodes[0] - 1 : layout.s_begin[ps];
    for (int q = 0; q < 4; ++q) {
      bool across = true, along = !last;
      for_side_pieces(layout, q, ps, [&](ChainPiece const& p) {
        across = across && is_known(p, side_which(q, end));
        along = along && is_known(p, side_which(q, 1));
      });
      j.known_across |= (across ? 1u : 0u) << q;
      j.known_along |= (along ? 1u : 0u) << q;
    }
    for (int e = 0; e < 4; ++e) {
      ChainPiece const& p = edge_piece(layout, e, ps);
      j.known_across |= (is_known(p, edge_which(e, end)) ? 1u : 0u) << (4 + e);
      j.known_along |= (!last && is_known(p, edge_which(e, 1)) ? 1u : 0u) << (4 + e);
    }
    junctions.push_back(j);
  }
  return junctions;
}

/// Lengths of the edges of a cross-section of the chain (s = first or last node) along a (direction 0) or b, each at
/// the node where it ends: (n_b, n_a).
std::vector<double> section_edges(PlanContext const& context, ChainLayout const& layout, int side, int direction) {
  std::vector<double> edges(std::size_t(layout.n_nodes[1]) * layout.n_nodes[2], 0);
  int const ps = side == 0 ? 0 : layout.n[0] - 1;
  for (int pb = 0; pb < layout.n[2]; ++pb)
    for (int pa = 0; pa < layout.n[1]; ++pa) {
      PieceNodes const nodes = piece_nodes(context.mesh, context.topology.lattice, layout.at(ps, pa, pb));
      Index const first = nodes.first + (side == 0 ? 0 : (nodes.count[0] - 1) * nodes.stride[0]);
      for (int b = direction == 1 ? 1 : 0; b < nodes.count[2]; ++b)
        for (int a = direction == 0 ? 1 : 0; a < nodes.count[1]; ++a) {
          Index const node = first + a * nodes.stride[1] + b * nodes.stride[2];
          edges[std::size_t(layout.a_begin[pa] + a) + std::size_t(layout.n_nodes[1]) * (layout.b_begin[pb] + b)] =
              context.lengths(node - nodes.stride[1 + direction], node);
        }
    }
  return edges;
}

/// Arc-length fractions along one direction of a cross-section; node count where a line has no length.
void append_fractions(std::vector<double> const& edges, int n_a, int n_b, int direction, std::vector<double>& out) {
  std::size_t const base = out.size();
  out.resize(base + edges.size());
  int const n = direction == 0 ? n_a : n_b;
  std::size_t const step = direction == 0 ? 1 : n_a;
  for (int line = 0; line < (direction == 0 ? n_b : n_a); ++line) {
    std::size_t const first = direction == 0 ? std::size_t(line) * n_a : line;
    double length = 0;
    for (int p = 0; p < n; ++p) out[base + first + p * step] = length += edges[first + p * step];
    for (int p = 0; p < n; ++p) {
      double& f = out[base + first + p * step];
      f = length > 0 ? f / length : double(p) / (n - 1);
    }
    out[base + first + (n - 1) * step] = 1;
  }
}

/// Slots of the known entities on the four sides -> the side arrays, each entity once per side it lies on.
void add_side_gathers(PlanContext const& context, Chain const& chain, ChainLayout const& layout, Known const& known,
                      kernels::Chain const& device, SideTables& tables) {
  Lattice const& lattice = context.topology.lattice;
  for (int q = 0; q < 4; ++q) {
    int const across = q < 2 ? 2 : 1;  // chain axis along which the lines of the side follow one another
    int const edge = q % 2 == 0 ? 0 : layout.n[1 + q / 2] - 1;
    Index const first = tables.sides[device.first_side + q].first;
    for (int pw = 0; pw < layout.n[across]; ++pw)
      for (int ps = 0; ps < layout.n[0]; ++ps) {
        int const pa = q < 2 ? edge : pw, pb = q < 2 ? pw : edge;
        PlacedBox const box = placed_box(context, chain, layout, ps, pa, pb);
        for (int cw = pw == 0 ? 0 : 1; cw < 3; ++cw)
          for (int cs = ps == 0 ? 0 : 1; cs < 3; ++cs) {
            Index3 which = side_which(q, cs);
            which[across] = cw;
            int const entity = chain_entity(lattice, layout.at(ps, pa, pb), which);
            if (!known(lattice.class_of(entity))) continue;
            add_gather(
                context, box, entity, first, [&](Index3 const& at) { return at[0] + Index(device.n_s) * at[across]; },
                tables.gathers);
          }
      }
  }
}

}  // namespace

void add_side_tables(PlanContext const& context, Chain const& chain, ChainLayout const& layout, Known const& known,
                     int number, Stage& stage, std::vector<SideWalk>& walks) {
  Topology const& topology = context.topology;
  std::vector<kernels::Junction> const junctions = known_around(topology, layout, known);
  kernels::Chain& device = stage.lines.chains[number];
  int const n_blocks = int(chain.steps.size());
  bool any = false;
  for (int m = 0; m <= n_blocks; ++m) {
    any = any || junctions[m].known_along != 0;
    bool const inside = m > 0 && (m < n_blocks || device.open_end);
    any = any || (inside && junctions[m].known_across != 0);
  }
  if (!any) return;
  for (int m = 0; m <= n_blocks; ++m) {
    device.known_sides |= junctions[m].known_along;
    if (m > 0 && (m < n_blocks || device.open_end)) device.known_sides |= junctions[m].known_across;
  }

  SideTables& tables = stage.sides;
  device.first_side = std::int32_t(tables.sides.size());
  device.first_junction = std::int32_t(tables.junctions.size());
  device.n_blocks = n_blocks;
  device.first_section = Index(tables.section.size());
  tables.corrected.push_back(number);
  tables.junctions.insert(tables.junctions.end(), junctions.begin(), junctions.end());

  for (int direction = 0; direction < 2; ++direction)
    for (int side = 0; side < 2; ++side)
      append_fractions(section_edges(context, layout, side, direction), device.n_a, device.n_b, direction,
                       tables.section);

  for (int q = 0; q < 4; ++q) {
    int const n_w = q < 2 ? device.n_b : device.n_a;
    tables.sides.push_back({number, n_w, Index(tables.t.size())});
    tables.t.resize(tables.t.size() + std::size_t(n_w) * device.n_s);
  }
  for (std::size_t n = 0; n < stage.lines.tubes.size(); ++n) {
    kernels::Tube const& tube = stage.lines.tubes[n];
    if (tube.chain != number) continue;
    auto add_line = [&](int q, int a, int b) {
      int const w = q < 2 ? tube.b_begin + b : tube.a_begin + a;
      int const side = device.first_side + q;
      // The line between two tubes of a side is listed once.
      bool const repeated = q < 2 ? (b == 0 && tube.b_begin > 0) : (a == 0 && tube.a_begin > 0);
      if (repeated) return;
      tables.lines.push_back({side, w});
      walks.push_back({n, a, b, tables.sides[side].first + Index(device.n_s) * w});
    };
    for (int b = 0; b < tube.n_b; ++b) {
      if (tube.a_begin == 0) add_line(0, 0, b);
      if (tube.a_begin + tube.n_a == device.n_a) add_line(1, tube.n_a - 1, b);
    }
    for (int a = 0; a < tube.n_a; ++a) {
      if (tube.b_begin == 0) add_line(2, a, 0);
      if (tube.b_begin + tube.n_b == device.n_b) add_line(3, a, tube.n_b - 1);
    }
  }
  add_side_gathers(context, chain, layout, known, device, tables);
}

void find_side_parameters(PlanContext const& context, std::vector<SideWalk> const& walks, Stage& stage) {
  // The same walk as the kernels', on borrowed host tables, so that t is the same number.
  kernels::LineTable<Kokkos::HostSpace> const table = host_lines(stage.lines);
  detail::for_many(context.host, "gridmorph::side_parameters", Index(walks.size()), [&](Index n) {
    SideWalk const& walk = walks[n];
    kernels::walk_line(table, stage.lines.tubes[walk.tube], walk.a, walk.b, context.lengths,
                       [t = stage.sides.t.data() + walk.at](int position, double fraction) { t[position] = fraction; });
  });
}

}  // namespace gridmorph
