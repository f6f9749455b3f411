#include <gridmorph/plan/side_tables.hpp>
#include <gridmorph/plan/stage_builder.hpp>

#include <algorithm>
#include <map>

namespace gridmorph {

namespace {

bool same_rotation(Mat3 const& a, Mat3 const& b) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (a.m[i][j] != b.m[i][j]) return false;
  return true;
}

}  // namespace

std::int32_t RotationTable::number(Mat3 const& m) {
  for (std::size_t n = 0; n < table_.size(); ++n)
    if (same_rotation(table_[n], m)) return std::int32_t(n);
  table_.push_back(m);
  return std::int32_t(table_.size()) - 1;
}

int kind_rank(EndKind kind, std::vector<std::string> const& order) {
  auto const it = std::find(order.begin(), order.end(), end_kind_name(kind));
  return int(it - order.begin());
}

namespace {

/// Nodes of an entity copy in the order of its owner's nodes: base and strides along the owner's two widest axes.
struct EntityNodes {
  Index first = 0;
  Index stride[2] = {0, 0};
  int n[2] = {1, 1};
  bool empty = false;
};

EntityNodes entity_nodes(Mesh const& mesh, Lattice const& lattice, EntityCopy const& copy, int owner_entity) {
  IndexRange const own = lattice.nodes(owner_entity);
  EntityNodes nodes;
  nodes.empty = own.size() == 0;
  if (nodes.empty) return nodes;
  Zone const& zone = mesh.zones[lattice.zone_of(copy.entity)];
  auto const stride = zone.strides();
  nodes.first = zone.node(copy.from_owner(own.begin));
  int used = 0;
  for (int a = 0; a < 3; ++a) {
    if (own.extent(a) == 1) continue;
    nodes.n[used] = own.extent(a);
    Orientation const& o = copy.from_owner.orientation;
    nodes.stride[used] = o.sign[a] * stride[o.axis[a]];
    ++used;
  }
  return nodes;
}

}  // namespace

void add_copies(Mesh const& mesh, Lattice const& lattice, int source_entity, RotationTable& rotations,
                CopyTable& table) {
  int const c = lattice.class_of(source_entity);
  auto const copies = lattice.copies(c);
  // Volumes always end here: only corners, edges and faces coincide with others.
  if (copies.size() == 1 && !lattice.axis_of(c)) return;
  int const owner = copies.front().entity;
  EntityCopy const& source = lattice.copy_of(source_entity);
  EntityNodes const from = entity_nodes(mesh, lattice, source, owner);
  if (from.empty) return;
  auto copy_to = [&](EntityNodes const& to, std::int32_t matrix) {
    return kernels::NodeCopy{from.first,   from.stride[0], from.stride[1], to.first, to.stride[0],
                             to.stride[1], from.n[0],      from.n[1],      matrix};
  };
  if (auto const axis = lattice.axis_of(c)) {
    Vec3 const a = source.transform.rotation * *axis;
    Mat3 const onto{
        {{a.x * a.x, a.x * a.y, a.x * a.z}, {a.y * a.x, a.y * a.y, a.y * a.z}, {a.z * a.x, a.z * a.y, a.z * a.z}}};
    table.projections.push_back(copy_to(from, rotations.number(onto)));
  }
  for (EntityCopy const& copy : copies) {
    if (copy.entity == source_entity) continue;
    std::int32_t matrix = -1;
    // Copies in the same frame are bit-identical (R R^T is the identity to round-off only), and so are those on the axis.
    if (!lattice.axis_of(c) && !same_rotation(copy.transform.rotation, source.transform.rotation))
      matrix = rotations.number(copy.transform.rotation * transpose(source.transform.rotation));
    table.copies.push_back(copy_to(entity_nodes(mesh, lattice, copy, owner), matrix));
  }
}

namespace {

/// Appends the tubes and segments of a laid-out chain. `writes(entity)` decides once per entity class who writes it.
template <class Writes>
void append_lines(Mesh const& mesh, Topology const& topology, Chain const& chain, ChainLayout const& layout,
                  int chain_number, RotationTable& rotations, LineTables& lines, Writes&& writes) {
  Lattice const& lattice = topology.lattice;
  for (int pb = 0; pb < layout.n[2]; ++pb)
    for (int pa = 0; pa < layout.n[1]; ++pa) {
      kernels::Tube tube{};
      tube.chain = chain_number;
      tube.a_begin = layout.a_begin[pa];
      tube.b_begin = layout.b_begin[pb];
      tube.first_segment = std::int32_t(lines.segments.size());
      tube.n_segments = layout.n[0];
      for (int ps = 0; ps < layout.n[0]; ++ps) {
        ChainPiece const& piece = layout.at(ps, pa, pb);
        PieceNodes const nodes = piece_nodes(mesh, lattice, piece);
        kernels::Segment segment{};
        segment.first = nodes.first;
        segment.stride_s = nodes.stride[0];
        segment.stride_a = nodes.stride[1];
        segment.stride_b = nodes.stride[2];
        segment.count = nodes.count[0];
        segment.begin = layout.s_begin[ps];
        ChainStep const& step = chain.steps[piece.step];
        segment.rotation = step.rotated ? rotations.number(step.rotation) : -1;
        for (int cb = 0; cb < 3; ++cb)
          for (int ca = 0; ca < 3; ++ca)
            for (int cs = 0; cs < 3; ++cs)
              if (writes(chain_entity(lattice, piece, {cs, ca, cb})))
                segment.write_mask |= 1u << (cs + 3 * (ca + 3 * cb));
        lines.segments.push_back(segment);
        tube.n_a = nodes.count[1];
        tube.n_b = nodes.count[2];
      }
      lines.tubes.push_back(tube);
      lines.first_line.push_back(lines.first_line.back() + Index(tube.n_a) * tube.n_b);
    }
}

kernels::Chain device_chain(ChainLayout const& layout, kernels::LineLaw law, bool open_end) {
  kernels::Chain c{};
  c.n_s = layout.n_nodes[0];
  c.n_a = layout.n_nodes[1];
  c.n_b = layout.n_nodes[2];
  c.law = law;
  c.open_end = open_end ? 1 : 0;
  c.first_side = -1;
  return c;
}

/// Turns the cross-section of a chain so that a runs along memory.
Chain with_contiguous_a(Mesh const& mesh, Topology const& topology, Chain chain) {
  ChainLayout const layout = lay_out(topology, chain);
  PieceNodes const nodes = piece_nodes(mesh, topology.lattice, layout.pieces.front());
  if (std::abs(nodes.stride[1]) > std::abs(nodes.stride[2]))
    for (ChainStep& step : chain.steps) step.to_chain = step.to_chain.then({{0, 2, 1}, {1, 1, 1}});
  return chain;
}

}  // namespace

Stage build_stage(Mesh const& mesh, Topology const& topology, std::vector<StageChain> const& chains, Known& known,
                  RotationTable& rotations, std::vector<std::string> const& kind_order) {
  Stage stage;
  Lattice const& lattice = topology.lattice;
  std::map<int, int> writer;       // entity class -> entity that is written
  std::map<int, EndKind> becomes;  // entity class -> kind
  for (StageChain const& entry : chains) {
    Chain const chain = with_contiguous_a(mesh, topology, entry.chain);
    ChainLayout const layout = lay_out(topology, chain);
    EndKind const kind =
        entry.open_end || kind_rank(chain.first.kind, kind_order) <= kind_rank(chain.last.kind, kind_order)
            ? chain.first.kind
            : chain.last.kind;
    int const number = int(stage.lines.chains.size());
    stage.lines.chains.push_back(device_chain(layout, entry.law, entry.open_end));
    append_lines(mesh, topology, chain, layout, number, rotations, stage.lines, [&](int entity) {
      int const c = lattice.class_of(entity);
      if (known(c)) return false;
      auto const [it, fresh] = becomes.try_emplace(c, kind);
      if (!fresh && kind_rank(kind, kind_order) < kind_rank(it->second, kind_order)) it->second = kind;
      return writer.try_emplace(c, entity).first->second == entity && fresh;
    });
    add_side_tables(mesh, topology, chain, layout, known, number, stage);
    for (ChainPiece const& p : layout.pieces) {
      Piece const& piece = lattice.pieces()[p.piece];
      IndexRange cells = piece.nodes;
      for (int a = 0; a < 3; ++a) --cells.end[a];
      stage.cells.push_back({piece.zone, cells});
    }
  }
  for (auto const& [c, entity] : writer) {
    add_copies(mesh, lattice, entity, rotations, stage.copies);
    known.known[c] = 1;
    known.kind[c] = becomes.at(c);
  }
  return stage;
}

SpreadPass build_spread(Mesh const& mesh, Topology const& topology, std::vector<Chain> const& chains,
                        std::vector<int> const& surface_of_patch, Known const& given, double mesh_size,
                        RotationTable& rotations) {
  SpreadPass pass;
  Lattice const& lattice = topology.lattice;
  Blocks const& blocks = topology.blocks;
  // Slip surfaces of every entity class: faces have one, edges and corners up to three.
  std::map<int, std::vector<int>> surfaces_of;
  for (int c = 0; c < lattice.n_classes(); ++c) {
    int const patch = blocks.patch_of_face()[c];
    if (patch < 0 || surface_of_patch[patch] < 0) continue;
    for (EntityCopy const& copy : lattice.copies(c)) {
      Index3 const p = lattice.position(copy.entity);
      Index3 d{};
      for (d[2] = -1; d[2] <= 1; ++d[2])
        for (d[1] = -1; d[1] <= 1; ++d[1])
          for (d[0] = -1; d[0] <= 1; ++d[0]) {
            if ((p[0] % 2 == 0 && d[0] != 0) || (p[1] % 2 == 0 && d[1] != 0) || (p[2] % 2 == 0 && d[2] != 0)) continue;
            auto& list = surfaces_of[lattice.class_of(
                lattice.entity(lattice.zone_of(copy.entity), {p[0] + d[0], p[1] + d[1], p[2] + d[2]}))];
            if (std::find(list.begin(), list.end(), surface_of_patch[patch]) == list.end())
              list.push_back(surface_of_patch[patch]);
          }
    }
  }

  std::map<int, int> writer;
  for (Chain const& entry : chains) {
    Chain const chain = with_contiguous_a(mesh, topology, entry);
    ChainLayout const layout = lay_out(topology, chain);
    int const number = int(pass.lines.chains.size());
    // Zero slope at both ends: the first spacings at the end walls keep their size.
    kernels::Chain device = device_chain(layout, kernels::LineLaw::c1, false);
    Index const section = Index(device.n_a) * device.n_b;
    device.first_end_value = pass.n_values;
    pass.n_values += 2 * section;
    pass.lines.chains.push_back(device);
    append_lines(mesh, topology, chain, layout, number, rotations, pass.lines, [&](int entity) {
      auto const [it, fresh] = writer.try_emplace(lattice.class_of(entity), entity);
      return fresh && it->second == entity;
    });
    for (int side = 0; side < 2; ++side) {
      int const patch = side == 0 ? chain.first.patch : chain.last.patch;
      if (patch < 0 || surface_of_patch[patch] < 0) continue;
      for (int pb = 0; pb < layout.n[2]; ++pb)
        for (int pa = 0; pa < layout.n[1]; ++pa) {
          int const ps = side == 0 ? 0 : layout.n[0] - 1;
          ChainPiece const& piece = layout.at(ps, pa, pb);
          PieceNodes const nodes = piece_nodes(mesh, lattice, piece);
          ChainStep const& step = chain.steps[piece.step];
          std::int32_t const rotation = step.rotated ? rotations.number(step.rotation) : -1;
          for (int b = 0; b < nodes.count[2]; ++b)
            for (int a = 0; a < nodes.count[1]; ++a) {
              SlipEnd end;
              end.node = nodes.first + a * nodes.stride[1] + b * nodes.stride[2] +
                         (side == 0 ? 0 : (nodes.count[0] - 1) * nodes.stride[0]);
              end.value = device.first_end_value + side * section + (layout.a_begin[pa] + a) +
                          Index(device.n_a) * (layout.b_begin[pb] + b);
              end.rotation = rotation;
              int const c = lattice.class_of(chain_entity(
                  lattice, piece,
                  {2 * side, kernels::end_category(a, nodes.count[1]), kernels::end_category(b, nodes.count[2])}));
              if (given(c)) end.tolerance = 1e-10 * mesh_size;
              auto const& on = surfaces_of.at(c);
              for (std::size_t m = 0; m < on.size() && m < 3; ++m) end.surface[m] = on[m];
              pass.ends.push_back(end);
            }
        }
    }
  }
  for (auto const& [c, entity] : writer) add_copies(mesh, lattice, entity, rotations, pass.copies);
  return pass;
}

}  // namespace gridmorph
