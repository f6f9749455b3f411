#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/plan/blocks/boundary_facts.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace gridmorph {
namespace {

/// A collapsed face: `along` is the zone axis of the pole line, `around` the axis that has no length.
struct PoleFace {
  int entity = -1;
  int along = 0, around = 0;
  int end_edge[2] = {-1, -1};  ///< edge classes at the lower and upper end of the pole line
};

double longest_edge(Mesh const& mesh, Zone const& zone, IndexRange const& r, int axis) {
  Index const stride = zone.strides()[axis];
  double longest = 0;
  for (int k = r.begin[2]; k < r.end[2]; ++k)
    for (int j = r.begin[1]; j < r.end[1]; ++j)
      for (int i = r.begin[0]; i < r.end[0]; ++i) {
        Index3 const p{i, j, k};
        if (p[axis] + 1 >= r.end[axis]) continue;
        Index const n = zone.node(p);
        longest = std::max(longest, distance(mesh.coordinates[n], mesh.coordinates[n + stride]));
      }
  return longest;
}

std::vector<PoleFace> pole_faces(Mesh const& mesh, Topology const& topology, ResolvedMotion const& motion,
                                 Known const& known, double mesh_size) {
  Lattice const& lattice = topology.lattice;
  std::vector<PoleFace> faces;
  for (int c = 0; c < lattice.n_classes(); ++c) {
    int const patch = topology.blocks.patch_of_face()[c];
    if (patch < 0 || known(c) || mesh.patches[patch].kind != PatchKind::degenerate ||
        !std::holds_alternative<FreeRule>(motion.patch_rule(patch)))
      continue;
    PoleFace face;
    face.entity = lattice.copies(c).front().entity;
    Index3 const p = lattice.position(face.entity);
    Zone const& zone = mesh.zones[lattice.zone_of(face.entity)];
    IndexRange const r = closed_nodes(lattice, face.entity);
    int axes[2], n = 0;
    for (int a = 0; a < 3; ++a)
      if (p[a] % 2 == 1) axes[n++] = a;
    double const l0 = longest_edge(mesh, zone, r, axes[0]), l1 = longest_edge(mesh, zone, r, axes[1]);
    if (std::min(l0, l1) > std::max(1e-12 * mesh_size, coordinate_resolution(mesh, lattice.zone_of(face.entity))))
      continue;  // declared degenerate, but an ordinary face
    face.along = l0 > l1 ? axes[0] : axes[1];
    face.around = l0 > l1 ? axes[1] : axes[0];
    for (int end = 0; end < 2; ++end) {
      Index3 q = p;
      q[face.along] += end == 0 ? -1 : 1;
      face.end_edge[end] = lattice.class_of(lattice.entity(lattice.zone_of(face.entity), q));
    }
    faces.push_back(face);
  }
  return faces;
}

/// Pole faces in a row, each with the end it is entered by.
using PoleRow = std::vector<std::pair<int, int>>;

std::vector<PoleRow> pole_rows(std::vector<PoleFace> const& faces, Known const& known) {
  std::map<int, std::vector<std::pair<int, int>>> at_edge;
  for (int f = 0; f < int(faces.size()); ++f)
    for (int end = 0; end < 2; ++end) at_edge[faces[f].end_edge[end]].emplace_back(f, end);
  auto next = [&](int f, int end) -> std::pair<int, int> {
    int const edge = faces[f].end_edge[end];
    auto const& there = at_edge.at(edge);
    if (known(edge) || there.size() != 2) return {-1, -1};
    return there[0] == std::pair{f, end} ? there[1] : there[0];
  };
  std::vector<PoleRow> rows;
  std::set<int> done;
  for (int f = 0; f < int(faces.size()); ++f) {
    if (done.contains(f)) continue;
    std::pair<int, int> at{f, 0};
    std::set<int> seen{f};
    while (true) {  // back to where the row starts
      auto const before = next(at.first, at.second);
      if (before.first < 0 || !seen.insert(before.first).second) break;
      at = {before.first, 1 - before.second};
    }
    PoleRow row;
    while (at.first >= 0 && done.insert(at.first).second) {
      row.push_back(at);
      at = next(at.first, 1 - at.second);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Index3 last_node(IndexRange const& r) { return {r.end[0] - 1, r.end[1] - 1, r.end[2] - 1}; }

/// The faces of a row as boxes of a chain: s along the pole, a around it.
std::vector<PlacedBox> placed_row(Lattice const& lattice, std::vector<PoleFace> const& faces, PoleRow const& row) {
  std::vector<PlacedBox> boxes;
  int position = 0;
  for (auto const& [f, enter] : row) {
    PoleFace const& face = faces[f];
    PlacedBox box;
    box.zone = lattice.zone_of(face.entity);
    box.nodes = closed_nodes(lattice, face.entity);
    box.to_chain.axis[face.along] = 0;
    box.to_chain.sign[face.along] = enter == 0 ? 1 : -1;
    box.to_chain.axis[face.around] = 1;
    box.to_chain.axis[3 - face.along - face.around] = 2;
    box.begin = {position, 0, 0};
    position += box.nodes.extent(face.along) - 1;
    boxes.push_back(box);
  }
  return boxes;
}

/// Makes the unknown entities of a pole face boundary nodes that no rule asks for: their displacement is zero.
void keep_in_place(PlanContext const& context, PoleFace const& face, Known& known, Plan& plan) {
  Lattice const& lattice = context.topology.lattice;
  Index3 const p = lattice.position(face.entity);
  for (int da = -1; da <= 1; ++da)
    for (int ds = -1; ds <= 1; ++ds) {
      Index3 q = p;
      q[face.around] += da;
      q[face.along] += ds;
      int const c = lattice.class_of(lattice.entity(lattice.zone_of(face.entity), q));
      if (known(c)) continue;
      known.known[c] = 1;
      known.kind[c] = end_kind(PatchKind::degenerate);
      add_boundary_nodes(context, c, plan);
    }
}

}  // namespace

std::optional<Stage> pole_stage(PlanContext const& context, ResolvedMotion const& motion,
                                std::vector<std::string> const& kind_order, Known& known, Plan& plan) {
  Mesh const& mesh = context.mesh;
  Topology const& topology = context.topology;
  Lattice const& lattice = topology.lattice;
  std::vector<PoleFace> const faces = pole_faces(mesh, topology, motion, known, plan.mesh_size);
  if (faces.empty()) return std::nullopt;

  Stage stage;
  stage.name = "poles";
  std::map<int, int> writer;
  std::map<int, EndKind> becomes;
  for (PoleRow row : pole_rows(faces, known)) {
    int first = faces[row.front().first].end_edge[row.front().second];
    int last = faces[row.back().first].end_edge[1 - row.back().second];
    std::string const where = describe_range(mesh, lattice.zone_of(faces[row.front().first].entity),
                                             closed_nodes(lattice, faces[row.front().first].entity));
    if (!known(first) && !known(last)) {
      plan.notes.push_back("pole at " + where + " has no end with a known displacement; it stays where it is");
      for (auto const& step : row) keep_in_place(context, faces[step.first], known, plan);
      continue;
    }
    // Rows begin at a known end: what it does goes on to the other one where that is open.
    if (!known(first)) {
      std::reverse(row.begin(), row.end());
      for (auto& step : row) step.second = 1 - step.second;
      std::swap(first, last);
    }
    bool const open = !known(last);
    EndKind const kind = open || kind_rank(known.kind[first], kind_order) <= kind_rank(known.kind[last], kind_order)
                             ? known.kind[first]
                             : known.kind[last];
    std::vector<PlacedBox> const boxes = placed_row(lattice, faces, row);
    kernels::Chain chain{};
    chain.law = open ? kernels::LineLaw::constant : kernels::LineLaw::linear;
    chain.open_end = open ? 1 : 0;
    chain.first_side = -1;
    for (PlacedBox const& box : boxes)
      for (Index3 const& corner : {box.nodes.begin, last_node(box.nodes)}) {
        Index3 const at = box.position(corner);
        chain.n_s = std::max(chain.n_s, at[0] + 1);
        chain.n_a = std::max(chain.n_a, at[1] + 1);
      }
    chain.n_b = 1;
    chain.first_end_value = stage.lines.n_end_values;
    stage.lines.n_end_values += 2 * chain.section_size();
    int const number = int(stage.lines.chains.size());
    stage.lines.chains.push_back(chain);
    kernels::Tube tube{};
    tube.chain = number;
    tube.n_a = chain.n_a;
    tube.n_b = 1;
    tube.first_segment = std::int32_t(stage.lines.segments.size());
    tube.n_segments = int(boxes.size());
    stage.lines.tubes.push_back(tube);
    for (std::size_t m = 0; m < boxes.size(); ++m) {
      kernels::Segment segment = make_segment(mesh, boxes[m]);
      for (int category = 0; category < 9; ++category) {
        int const cs = category % 3, ca = category / 3;
        PoleFace const& face = faces[row[m].first];
        Index3 q = lattice.position(face.entity);
        q[face.around] += ca - 1;
        q[face.along] += row[m].second == 0 ? cs - 1 : 1 - cs;
        int const entity = lattice.entity(boxes[m].zone, q);
        int const c = lattice.class_of(entity);
        bool const lower_end = m == 0 && cs == 0, upper_end = m + 1 == boxes.size() && cs == 2 && !open;
        if (lower_end || upper_end)
          add_gather(
              context, boxes[m], entity, chain.first_end_value + (lower_end ? 0 : chain.section_size()),
              [](Index3 const& at) { return Index(at[1]); }, stage.ends);
        if (known(c)) continue;
        becomes.try_emplace(c, kind);
        // What is known of an entity holds for all of its copies: one line writes it.
        if (writer.try_emplace(c, entity).second)
          add_writer(context, stage.lines, stage.sweeps, stage.volume, number, boxes[m], -1, entity, category, segment);
      }
      stage.lines.segments.push_back(segment);
    }
    stage.description.push_back(where + ": " + std::string(end_kind_name(known.kind[first])) + " to " +
                                (open ? "open" : std::string(end_kind_name(known.kind[last]))));
  }
  for (auto const& [c, entity] : writer) {
    known.known[c] = 1;
    known.kind[c] = becomes.at(c);
  }
  if (stage.lines.chains.empty()) return std::nullopt;
  return stage;
}

}  // namespace gridmorph
