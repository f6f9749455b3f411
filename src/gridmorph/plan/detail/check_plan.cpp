#include <gridmorph/plan/detail/archive.hpp>
#include <gridmorph/plan/detail/check_plan.hpp>
#include <gridmorph/plan/detail/reach.hpp>

#include <cmath>
#include <string>

namespace gridmorph::detail {
namespace {

/// Steps of one index within an entity category among n nodes: 0 lower end, 1 inside, 2 upper end (end_category()).
struct Steps {
  Index from, to;
  Steps(int category, Index n) : from(category == 0 ? 0 : 1), to(category == 1 ? n - 2 : n - 1) {
    if (category == 0) to = 0;
    if (category == 2) from = to;
    if (category == 2 && n < 2) from = 1;  // an only node is a lower end
  }
  [[nodiscard]] Index count() const { return to < from ? 0 : to - from + 1; }
};

template <class T>
bool is_entry(std::int64_t number, std::vector<T> const& table) {
  return number >= 0 && number < std::int64_t(table.size());
}

class Checker {
 public:
  explicit Checker(Plan const& plan) : plan_(plan) {}

  void whole_plan() {
    where_ = "plan";
    require(plan_.n_nodes > 0 && plan_.n_slots >= 0 && plan_.n_slots <= plan_.n_nodes, "sizes");
    require(std::isfinite(plan_.mesh_size) && plan_.mesh_size > 0, "mesh size");
    surfaces();
    boundary();
    Index written = 0;
    for (kernels::NodeCopy const& c : plan_.skeleton_nodes) {
      copy(c, plan_.n_slots, plan_.n_nodes, "copy to nodes");
      written += Index(c.n_p) * c.n_q;
    }
    for (kernels::VolumeBox const& box : plan_.boxes) written += box_size(box);
    require(written == plan_.n_nodes, "number of nodes that are written");
    cells(plan_.near_field);
    for (Stage const& stage : plan_.stages) {
      where_ = "stage " + std::to_string(&stage - plan_.stages.data() + 1);
      lines(stage.lines, stage.sides);
      sides(stage.sides, stage.lines);
      for (kernels::NodeCopy const& c : stage.ends) copy(c, plan_.n_slots, stage.lines.n_end_values, "end");
      sweeps(stage.sweeps, stage.lines);
      volume(stage.volume, stage.lines);
      cells(stage.cells);
    }
    for (SpreadPass const& pass : plan_.spreads) {
      where_ = "finalize pass " + std::to_string(&pass - plan_.spreads.data() + 1);
      lines(pass.lines, SideTables{});
      slip_ends(pass);
      sweeps(pass.sweeps, pass.lines);
      volume(pass.volume, pass.lines);
    }
    where_ = "plan";
    for (bool const has_terms : has_terms_) require(has_terms, "box that no chain writes");
  }

 private:
  void require(bool good, char const* what) const {
    if (!good) throw Damaged(where_ + ": " + what);
  }

  void surfaces() const {
    for (SlipSurface const& s : plan_.surfaces) {
      require(s.kind == SlipKind::plane || s.kind == SlipKind::revolution || s.kind == SlipKind::axial ||
                  s.kind == SlipKind::meridional || s.kind == SlipKind::facets,
              "kind of slip surface");
      double const turned = s.frame.cosine * s.frame.cosine + s.frame.sine * s.frame.sine;
      require(turned > 0.99 && turned < 1.01, "frame of slip surface");
      RevolutionProfile const& p = s.profile;
      std::size_t const n = p.knots.size();
      bool const has_profile = s.kind == SlipKind::revolution || s.kind == SlipKind::meridional;
      require(n >= 2 || (n == 0 && !has_profile && p.bucket_piece.empty()), "length of profile");
      for (std::size_t m = 1; m < n; ++m) {
        double const lower = p.knots[m - 1].axial, upper = p.knots[m].axial;
        require(std::isfinite(lower) && lower < upper && std::isfinite(upper), "axial positions of profile");
      }
      require(p.bucket_piece.size() != 1, "buckets of profile");
      for (int const piece : p.bucket_piece) require(piece >= 0 && piece < int(n) - 1, "buckets of profile");
      require(s.facets.empty() != (s.kind == SlipKind::facets) && s.facets.empty() == s.facets.boxes.empty(),
              "facets of slip surface");
      facets(s.facets);
    }
  }

  void facets(FacetSurface const& s) const {
    for (Facet const& f : s.facets) {
      require(f.corner[3] >= -1, "corner of facet");
      for (int q = 0; q < f.n_corners(); ++q) {
        require(is_entry(f.corner[q], s.points) && is_entry(f.normal[q], s.normals), "corner of facet");
        require(is_entry(f.bend[q], s.bends) && is_entry(f.bend[q] ^ 1, s.bends), "edge of facet");
        std::int32_t const beyond = f.neighbour[q];
        require(beyond == -1 ||
                    (beyond >= 0 && is_entry(beyond / 4, s.facets) && beyond % 4 < s.facets[beyond / 4].n_corners()),
                "neighbour of facet");
      }
    }
    // Boxes come after the one box that holds them, so their depth is known when they are reached.
    std::vector<int> depth(s.boxes.size(), 0);
    Index n_facets = 0;
    for (std::size_t b = 0; b < s.boxes.size(); ++b) {
      FacetBox const& box = s.boxes[b];
      require(box.first >= 0 && box.count >= 0 && depth[b] < FacetTreeView::max_depth, "box of facets");
      if (box.count > 0) {
        require(Index(box.first) + box.count <= Index(s.facets.size()), "facets of box");
        n_facets += box.count;
        continue;
      }
      require(Index(box.first) > Index(b) && Index(box.first) + 1 < Index(s.boxes.size()), "boxes of box");
      for (int const half : {box.first, box.first + 1}) {
        require(depth[half] == 0, "boxes of box");
        depth[half] = depth[b] + 1;
      }
    }
    require(n_facets == Index(s.facets.size()), "facets of boxes");
  }

  void boundary() const {
    require(plan_.boundary_nodes.size() == plan_.boundary_slots.size(), "length of boundary tables");
    for (Index const node : plan_.boundary_nodes) require(node >= 0 && node < plan_.n_nodes, "boundary node");
    for (Index const slot : plan_.boundary_slots) require(is_slot(slot), "boundary slot");
    for (kernels::NodeCopy const& c : plan_.boundary_projections)
      copy(c, plan_.n_slots, plan_.n_slots, "boundary projection");
  }

  [[nodiscard]] bool is_slot(Index slot) const { return slot >= 0 && slot < plan_.n_slots; }
  [[nodiscard]] bool is_matrix(std::int32_t m) const { return m == -1 || is_entry(m, plan_.rotations); }

  void copy(kernels::NodeCopy const& c, Index n_source, Index n_destination, char const* what) const {
    require(c.n_p >= 1 && c.n_q >= 1 && Index(c.n_p) * c.n_q <= n_destination && is_matrix(c.matrix) &&
                Reach(c.source).along(c.source_stride_p, c.n_p).along(c.source_stride_q, c.n_q).within(0, n_source) &&
                Reach(c.destination)
                    .along(c.destination_stride_p, c.n_p)
                    .along(c.destination_stride_q, c.n_q)
                    .within(0, n_destination),
            what);
  }

  [[nodiscard]] Index box_size(kernels::VolumeBox const& box) const {
    require(box.n[0] >= 1 && box.n[1] >= 1 && box.n[2] >= 1, "size of box");
    Index const plane = Index(box.n[0]) * box.n[1];
    require(plane <= plan_.n_nodes && plane * box.n[2] <= plan_.n_nodes, "size of box");
    require(Reach(box.first)
                .along(1, box.n[0])
                .along(box.stride_j, box.n[1])
                .along(box.stride_k, box.n[2])
                .within(0, plan_.n_nodes),
            "nodes of box");
    return plane * box.n[2];
  }

  /// The nodes of zones are known to the mesh alone; a box larger than all of them is wrong for sure.
  void cells(std::vector<CellBox> const& boxes) const {
    for (CellBox const& box : boxes) {
      Index size = 1;
      require(box.zone >= 0, "zone of cells");
      for (int d = 0; d < 3; ++d) {
        require(box.cells.begin[d] >= 0 && box.cells.end[d] > box.cells.begin[d], "range of cells");
        size *= box.cells.extent(d);
        require(size <= plan_.n_nodes, "range of cells");
      }
    }
  }

  void lines(LineTables const& lines, SideTables const& sides) const {
    Index n_end_values = 0;
    for (kernels::Chain const& chain : lines.chains) {
      require(chain.n_s >= 2 && chain.n_s <= plan_.n_nodes && chain.n_a >= 1 && chain.n_b >= 1 &&
                  chain.section_size() <= plan_.n_nodes,
              "size of chain");
      require(chain.law >= kernels::LineLaw::linear && chain.law <= kernels::LineLaw::constant, "law of chain");
      n_end_values += 2 * chain.section_size();
    }
    require(lines.n_end_values == n_end_values, "number of end values");
    for (kernels::Chain const& chain : lines.chains) {
      require(Reach(chain.first_end_value).along(1, 2 * chain.section_size()).within(0, n_end_values),
              "end values of chain");
      require(chain.first_side >= -1, "sides of chain");
      if (chain.first_side >= 0) side_numbers(chain, sides);
    }
    Index n_parameters = 0;
    for (kernels::Tube const& tube : lines.tubes) {
      require(is_entry(tube.chain, lines.chains), "chain of tube");
      kernels::Chain const& chain = lines.chains[tube.chain];
      require(is_part(tube.a_begin, tube.n_a, chain.n_a) && is_part(tube.b_begin, tube.n_b, chain.n_b),
              "place of tube");
      require(tube.first_segment >= 0 && tube.n_segments >= 1 &&
                  Index(tube.first_segment) + tube.n_segments <= Index(lines.segments.size()),
              "segments of tube");
      for (int m = 0; m < tube.n_segments; ++m)
        n_parameters += parameters(lines, tube, chain, lines.segments[tube.first_segment + m]);
    }
    require(lines.n_parameters == n_parameters && n_parameters <= plan_.n_nodes, "number of line parameters");
  }

  static bool is_part(Index begin, Index n, Index whole) { return begin >= 0 && n >= 1 && begin + n <= whole; }

  /// Number of line parameters that the targets of a segment hold.
  [[nodiscard]] Index parameters(LineTables const& lines, kernels::Tube const& tube, kernels::Chain const& chain,
                                 kernels::Segment const& s) const {
    require(s.count >= 2 && is_part(s.begin, s.count, chain.n_s), "place of segment");
    require(Reach(s.first)
                .along(s.stride_s, s.count)
                .along(s.stride_a, tube.n_a)
                .along(s.stride_b, tube.n_b)
                .within(0, plan_.n_nodes),
            "nodes of segment");
    Index n = 0;
    for (int category = 0; category < 27; ++category) {
      if (s.target[category] < 0) continue;
      require(is_entry(s.target[category], lines.targets), "target of segment");
      kernels::ParameterTarget const& to = lines.targets[s.target[category]];
      Steps const along(category % 3, s.count), a(category / 3 % 3, tube.n_a), b(category / 9, tube.n_b);
      require(along.count() > 0 && a.count() > 0 && b.count() > 0, "target without nodes");
      require(Reach(to.first)
                  .along(to.stride_s, along.from, along.to)
                  .along(to.stride_a, a.from, a.to)
                  .along(to.stride_b, b.from, b.to)
                  .within(0, lines.n_parameters),
              "place of line parameters");
      require(along.count() <= plan_.n_nodes / (a.count() * b.count()), "number of line parameters");
      n += along.count() * a.count() * b.count();
    }
    return n;
  }

  /// Where a corrected chain finds its sides, junctions and section; that they are right is up to sides().
  void side_numbers(kernels::Chain const& chain, SideTables const& sides) const {
    require(Index(chain.first_side) + 4 <= Index(sides.sides.size()), "sides of chain");
    require(chain.n_blocks >= 1 && chain.first_junction >= 0 &&
                Index(chain.first_junction) + chain.n_blocks + 1 <= Index(sides.junctions.size()),
            "junctions of chain");
    Index const n_section = Index(sides.section.size());
    require(chain.first_section >= 0 && chain.first_section <= n_section &&
                chain.section_size() <= (n_section - chain.first_section) / 4,
            "section of chain");
    for (int m = 0; m <= chain.n_blocks; ++m) {
      int const at = sides.junctions[chain.first_junction + m].position;
      bool const good = m == 0 ? at == 0 : m == chain.n_blocks ? at == chain.n_s - 1 : at < chain.n_s;
      require(good && (m == 0 || at > sides.junctions[chain.first_junction + m - 1].position), "position of junction");
    }
    for (int q = 0; q < 4; ++q) {
      kernels::Side const& side = sides.sides[chain.first_side + q];
      require(side.n_w == (q < 2 ? chain.n_b : chain.n_a), "lines of side");
      require(side.first >= 0 && side.first <= Index(sides.t.size()) &&
                  chain.n_s <= (Index(sides.t.size()) - side.first) / side.n_w,
              "nodes of side");
    }
  }

  void sides(SideTables const& sides, LineTables const& lines) const {
    auto const corrected_chain = [&](std::int32_t number) -> kernels::Chain const& {
      require(is_entry(number, lines.chains) && lines.chains[number].first_side >= 0, "corrected chain");
      return lines.chains[number];
    };
    for (std::int32_t const number : sides.corrected) static_cast<void>(corrected_chain(number));
    for (kernels::Side const& side : sides.sides) {
      Index const q = &side - sides.sides.data() - corrected_chain(side.chain).first_side;
      require(q >= 0 && q < 4, "chain of side");
    }
    for (kernels::SideLine const& line : sides.lines)
      require(is_entry(line.side, sides.sides) && line.w >= 0 && line.w < sides.sides[line.side].n_w, "side line");
    for (kernels::NodeCopy const& c : sides.gathers) copy(c, plan_.n_slots, Index(sides.t.size()), "known side");
  }

  void sweeps(std::vector<kernels::SkeletonSweep> const& list, LineTables const& lines) const {
    for (kernels::SkeletonSweep const& s : list) {
      require(is_entry(s.chain, lines.chains) && is_matrix(s.matrix), "chain of sweep");
      kernels::Chain const& chain = lines.chains[s.chain];
      require(s.n_p >= 1 && s.n_q >= 1 && Index(s.n_p) * s.n_q <= plan_.n_slots &&
                  Reach(s.slot).along(1, s.n_p).along(s.slot_q, s.n_q).within(0, plan_.n_slots),
              "slots of sweep");
      require(chain.has_parameters() ? Reach(s.t).along(s.t_p, s.n_p).along(s.t_q, s.n_q).within(0, lines.n_parameters)
                                     : s.t == -1,
              "line parameters of sweep");
      auto const inside = [&](std::int32_t const(&at)[3], Index n) {
        return Reach(at[0]).along(at[1], s.n_p).along(at[2], s.n_q).within(0, n);
      };
      require(inside(s.s, chain.n_s) && inside(s.a, chain.n_a) && inside(s.b, chain.n_b),
              "place of sweep on its chain");
    }
  }

  void volume(std::vector<VolumePart> const& parts, LineTables const& lines) {
    for (VolumePart const& part : parts) {
      require(is_entry(part.box, plan_.boxes), "box of volume term");
      has_terms_[part.box] = true;
      std::int32_t const(&n)[3] = plan_.boxes[part.box].n;
      kernels::VolumeTerm const& term = part.term;
      require(is_entry(term.chain, lines.chains) && is_matrix(term.matrix), "chain of volume term");
      kernels::Chain const& chain = lines.chains[term.chain];
      Index const size = Index(n[0]) * n[1] * n[2];
      require(chain.has_parameters() ? term.t >= 0 && term.t <= lines.n_parameters - size : term.t == -1,
              "line parameters of volume term");
      Index const first = chain.first_end_value;
      require(Reach(term.end_value)
                  .along(term.end_stride[0], n[0])
                  .along(term.end_stride[1], n[1])
                  .along(term.end_stride[2], n[2])
                  .within(first, first + chain.section_size()),
              "end values of volume term");
      auto const inside = [&](std::int32_t const(&at)[4], Index limit) {
        return Reach(at[0]).along(at[1], n[0]).along(at[2], n[1]).along(at[3], n[2]).within(0, limit);
      };
      require(inside(term.s, chain.n_s) && inside(term.a, chain.n_a) && inside(term.b, chain.n_b),
              "place of volume term on its chain");
    }
  }

  void slip_ends(SpreadPass const& pass) const {
    for (kernels::SlipEnd const& end : pass.ends) {
      require(end.node >= 0 && end.node < plan_.n_nodes && is_slot(end.slot) && end.value >= 0 &&
                  end.value < pass.lines.n_end_values && is_matrix(end.to_node) && is_matrix(end.to_chain),
              "slip end");
      for (std::int32_t const s : end.surface) require(s == -1 || is_entry(s, plan_.surfaces), "surface of slip end");
    }
  }

  Plan const& plan_;
  std::string where_;
  std::vector<bool> has_terms_ = std::vector<bool>(plan_.boxes.size());
};

}  // namespace

void check_plan(Plan const& plan, Index n_nodes) {
  if (plan.n_nodes != n_nodes) throw Damaged("plan: number of nodes");
  Checker(plan).whole_plan();
}

}  // namespace gridmorph::detail
