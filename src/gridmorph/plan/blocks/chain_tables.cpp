#include <gridmorph/plan/blocks/chain_tables.hpp>

namespace gridmorph {
namespace {

/// The chain's frame -> owner's frame of an entity, and onto the axis where the entity lies on it; -1: the same.
std::int32_t from_chain_frame(PlanContext const& context, PlacedBox const& box, int entity) {
  Lattice const& lattice = context.topology.lattice;
  EntityCopy const& copy = lattice.copy_of(entity);
  bool const turned = (box.rotated || copy.moved) &&
                      !(box.rotated && copy.moved && same_rotation(box.rotation, copy.transform.rotation));
  Mat3 matrix = turned ? transpose(copy.transform.rotation) * box.rotation : Mat3{};
  auto const axis = lattice.axis_of(lattice.class_of(entity));
  if (axis) matrix = onto(*axis) * matrix;
  return turned || axis ? context.rotations.number(matrix) : -1;
}

/// Where the line parameters of an entity go: one after another in the order of its own zone's nodes.
struct ParameterRange {
  IndexRange nodes;
  Index first = 0;

  [[nodiscard]] std::array<Index, 3> strides() const {
    return {1, nodes.extent(0), Index(nodes.extent(0)) * nodes.extent(1)};
  }
  [[nodiscard]] Index at(Index3 const& node) const {
    auto const stride = strides();
    Index index = first;
    for (int d = 0; d < 3; ++d) index += (node[d] - nodes.begin[d]) * stride[d];
    return index;
  }
};

kernels::ParameterTarget target(PlacedBox const& box, ParameterRange const& range) {
  kernels::ParameterTarget t{};
  Index3 corner{};
  Index stride[3];
  for (int d = 0; d < 3; ++d) {
    bool const forward = box.to_chain.sign[d] > 0;
    corner[d] = forward ? box.nodes.begin[d] : box.nodes.end[d] - 1;
    stride[box.to_chain.axis[d]] = forward ? range.strides()[d] : -range.strides()[d];
  }
  t.first = range.at(corner);
  t.stride_s = stride[0];
  t.stride_a = stride[1];
  t.stride_b = stride[2];
  return t;
}

}  // namespace

std::int32_t to_chain_frame(PlanContext const& context, PlacedBox const& box, int entity) {
  EntityCopy const& copy = context.topology.lattice.copy_of(entity);
  if (!box.rotated && !copy.moved) return -1;
  if (box.rotated && copy.moved && same_rotation(box.rotation, copy.transform.rotation)) return -1;
  return context.rotations.number(transpose(box.rotation) * copy.transform.rotation);
}

PlacedBox placed_box(PlanContext const& context, Chain const& chain, ChainLayout const& layout, int ps, int pa,
                     int pb) {
  ChainPiece const& piece = layout.at(ps, pa, pb);
  Piece const& p = context.topology.lattice.pieces()[piece.piece];
  ChainStep const& step = chain.steps[piece.step];
  return {p.zone,        p.nodes,          piece.to_chain, {layout.s_begin[ps], layout.a_begin[pa], layout.b_begin[pb]},
          step.rotation, step.translation, step.rotated};
}

kernels::Segment make_segment(Mesh const& mesh, PlacedBox const& box) {
  Zone const& zone = mesh.zones[box.zone];
  auto const strides = zone.strides();
  kernels::Segment segment{};
  Index3 corner{};
  Index stride[3];
  for (int d = 0; d < 3; ++d) {
    bool const forward = box.to_chain.sign[d] > 0;
    int const c = box.to_chain.axis[d];
    corner[d] = forward ? box.nodes.begin[d] : box.nodes.end[d] - 1;
    stride[c] = forward ? strides[d] : -strides[d];
    if (c == 0) segment.count = box.nodes.extent(d);
  }
  segment.first = zone.node(corner);
  segment.stride_s = stride[0];
  segment.stride_a = stride[1];
  segment.stride_b = stride[2];
  segment.begin = box.begin[0];
  for (std::int32_t& t : segment.target) t = -1;
  return segment;
}

namespace {

/// Adds the sweep of one layer of an entity's nodes.
void add_sweep(PlanContext const& context, LineTables& lines, std::vector<kernels::SkeletonSweep>& sweeps, int number,
               PlacedBox const& box, int entity, ParameterRange const& range, SkeletonRows const& rows) {
  kernels::Chain const& chain = lines.chains[number];
  kernels::SkeletonSweep sweep{};
  sweep.chain = number;
  sweep.matrix = from_chain_frame(context, box, entity);
  sweep.n_p = rows.n_p;
  sweep.n_q = rows.n_q;
  sweep.slot = rows.slot;
  sweep.slot_q = rows.slot_q;
  Index3 const steps[3] = {{0, 0, 0}, rows.step_p, rows.step_q};
  Index3 const origin = box.position(rows.at);
  sweep.t = chain.has_parameters() ? range.at(rows.at) : -1;
  sweep.t_p = range.at(plus(rows.at, rows.step_p)) - range.at(rows.at);
  sweep.t_q = range.at(plus(rows.at, rows.step_q)) - range.at(rows.at);
  for (int d = 0; d < 3; ++d) {
    Index3 const at = box.position(plus(rows.at, steps[d]));
    sweep.s[d] = d == 0 ? at[0] : at[0] - origin[0];
    sweep.a[d] = d == 0 ? at[1] : at[1] - origin[1];
    sweep.b[d] = d == 0 ? at[2] : at[2] - origin[2];
  }
  if (chain.turn != kernels::TurnLaw::none) {
    sweep.x = Index(lines.swept_positions.size());
    for (int q = 0; q < sweep.n_q; ++q)
      for (int p = 0; p < sweep.n_p; ++p)
        lines.swept_positions.push_back(box.in_chain_frame(node_position(context.mesh, box.zone, rows, p, q)));
  }
  sweeps.push_back(sweep);
}

}  // namespace

void add_writer(PlanContext const& context, LineTables& lines, std::vector<kernels::SkeletonSweep>& sweeps,
                std::vector<VolumePart>& volume, int number, PlacedBox const& box, int piece, int entity, int category,
                kernels::Segment& segment) {
  Lattice const& lattice = context.topology.lattice;
  kernels::Chain const& chain = lines.chains[number];
  ParameterRange const range{lattice.nodes(entity), lines.n_parameters};
  if (range.nodes.size() == 0) return;
  if (chain.has_parameters()) {
    segment.target[category] = std::int32_t(lines.targets.size());
    lines.targets.push_back(target(box, range));
    lines.n_parameters += range.nodes.size();
  }
  auto const value = [&](Index3 const& at) { return at[1] + Index(chain.n_a) * at[2]; };

  if (lattice.dimension(entity) == 3 && context.topology.blocks.region_of(piece) < 0) {
    VolumePart part{context.box_of_piece[piece], {}};
    kernels::VolumeTerm& term = part.term;
    term.chain = number;
    term.matrix = box.rotated ? context.rotations.number(box.rotation) : -1;
    term.t = chain.has_parameters() ? range.first : -1;
    Index3 const origin = box.position(range.nodes.begin);
    term.end_value = chain.first_end_value + value(origin);
    for (int d = 0; d <= 3; ++d) {
      Index3 step{0, 0, 0};
      if (d > 0) step[d - 1] = 1;
      Index3 const at = box.position(plus(range.nodes.begin, step));
      if (d > 0) term.end_stride[d - 1] = value(at) - value(origin);
      term.s[d] = d == 0 ? at[0] : at[0] - origin[0];
      term.a[d] = d == 0 ? at[1] : at[1] - origin[1];
      term.b[d] = d == 0 ? at[2] : at[2] - origin[2];
    }
    if (box.rotated) term.offset = -(transpose(box.rotation) * box.translation);
    volume.push_back(part);
    return;
  }

  for (int layer = 0; layer < n_layers(range.nodes); ++layer)
    add_sweep(context, lines, sweeps, number, box, entity, range, *context.skeleton.rows(entity, layer));
}

}  // namespace gridmorph
