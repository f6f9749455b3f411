#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/kokkos_compat.hpp>
#include <gridmorph/mesh/distribution.hpp>
#include <gridmorph/plan/blocks/host_lines.hpp>
#include <gridmorph/plan/share.hpp>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace gridmorph {
namespace {

/// The boxes by zone, with the numbers of their first nodes in the share; of no rank.
class OwnBoxes {
 public:
  OwnBoxes(BoundaryMesh const& mesh, std::span<NodeBox const> boxes) : of_zone_(mesh.zones.size()) {
    for (NodeBox const& box : boxes) {
      if (box.zone < 0 || box.zone >= int(mesh.zones.size()))
        throw ConfigError("a share asks for zone " + std::to_string(box.zone) + ", counted from 0; the mesh has " +
                          std::to_string(mesh.zones.size()) + " zones");
      Zone const& zone = mesh.zones[box.zone];
      if (box.nodes.size() < 1 || intersection(box.nodes, {{0, 0, 0}, zone.extent}) != box.nodes)
        throw ConfigError("a share asks for nodes " + to_string(box.nodes) + " of zone '" + zone.name +
                          "', which has " + to_string(IndexRange{{0, 0, 0}, zone.extent}) +
                          "; name a box of nodes within the zone");
      of_zone_[box.zone].push_back({box.zone, box.nodes, -1, n_nodes_});
      n_nodes_ += box.nodes.size();
    }
  }
  [[nodiscard]] Index n_nodes() const { return n_nodes_; }
  [[nodiscard]] std::vector<Part> const& in_zone(int zone) const { return of_zone_[zone]; }

 private:
  std::vector<std::vector<Part>> of_zone_;
  Index n_nodes_ = 0;
};

/// Appends entries begin ... begin + n of a list, zeros where it is shorter: what few chains need is not there for all.
template <class T>
void append_range(std::vector<T> const& from, Index begin, Index n, std::vector<T>& to) {
  for (Index k = begin; k < begin + n; ++k) to.push_back(k < Index(from.size()) ? from[std::size_t(k)] : T{});
}

/// First and one past the last of what is needed; nothing as long as nothing is included.
struct Range {
  int begin = std::numeric_limits<int>::max(), end = std::numeric_limits<int>::min();

  void include(int n) {
    begin = std::min(begin, n);
    end = std::max(end, n + 1);
  }
  [[nodiscard]] bool any() const { return begin < end; }
  [[nodiscard]] bool has(int n) const { return begin <= n && n < end; }
  [[nodiscard]] int size() const { return any() ? end - begin : 0; }
};

/// The lines (a, b) of a chain that are kept, and where their end values start.
struct KeptChain {
  std::int32_t number = -1;  ///< in the share, -1: none is kept
  Range a, b;
  Index first_end_value = 0;

  [[nodiscard]] bool any() const { return a.any(); }
  void include(int line_a, int line_b) {
    a.include(line_a);
    b.include(line_b);
  }
};

/// The nodes (p, q) of a sweep that are needed.
struct KeptRows {
  Range p, q;
};

/// What is kept of the lines of one stage or pass.
class KeptLines {
 public:
  std::vector<KeptChain> chains;
  std::vector<KeptRows> sweeps;

  explicit KeptLines(LineTables const& lines) : chains(lines.chains.size()), lines_(&lines) {}

  /// Where an end value stands: end values of chains follow one another.
  struct Place {
    std::size_t chain;
    int end, a, b;
  };
  [[nodiscard]] Place place(Index value) const {
    auto const after = std::upper_bound(lines_->chains.begin(), lines_->chains.end(), value,
                                        [](Index v, kernels::Chain const& c) { return v < c.first_end_value; });
    auto const c = std::size_t(after - lines_->chains.begin()) - 1;
    kernels::Chain const& chain = lines_->chains[c];
    Index const local = value - chain.first_end_value, line = local % chain.section_size();
    return {c, int(local / chain.section_size()), int(line % chain.n_a), int(line / chain.n_a)};
  }
  [[nodiscard]] bool has(Index value) const {
    Place const at = place(value);
    return chains[at.chain].a.has(at.a) && chains[at.chain].b.has(at.b);
  }
  /// The number of an end value in the share.
  [[nodiscard]] Index number(Index value) const {
    Place const at = place(value);
    KeptChain const& kept = chains[at.chain];
    return kept.first_end_value + at.a - kept.a.begin +
           Index(kept.a.size()) * (at.b - kept.b.begin + Index(kept.b.size()) * at.end);
  }
  /// What a step between end values of a chain becomes; 0 where it is not made.
  [[nodiscard]] Index step(Index value, Index by, int n) const {
    return n < 2 || by == 0 ? 0 : number(value + by) - number(value);
  }
  /// Numbers the chains that are kept, and their end values.
  void number_chains() {
    std::int32_t n = 0;
    Index first = 0;
    for (KeptChain& chain : chains) {
      if (!chain.any()) continue;
      chain.number = n++;
      chain.first_end_value = first;
      first += 2 * Index(chain.a.size()) * chain.b.size();
    }
  }

 private:
  LineTables const* lines_;
};

/// The part of a copy to end values of lines that are kept; none where it has no nodes.
std::optional<kernels::NodeCopy> cut(kernels::NodeCopy copy, KeptLines const& kept) {
  Range p, q;
  for (int m = 0; m < copy.n_q; ++m)
    for (int n = 0; n < copy.n_p; ++n)
      if (kept.has(copy.destination + n * copy.destination_stride_p + m * copy.destination_stride_q)) {
        p.include(n);
        q.include(m);
      }
  if (!p.any()) return {};
  copy.source += p.begin * copy.source_stride_p + q.begin * copy.source_stride_q;
  copy.destination += p.begin * copy.destination_stride_p + q.begin * copy.destination_stride_q;
  copy.n_p = p.size();
  copy.n_q = q.size();
  return copy;
}

/// The same with the numbers of the share.
kernels::NodeCopy renumbered(kernels::NodeCopy copy, KeptLines const& kept) {
  Index const first = copy.destination;
  copy.destination = kept.number(first);
  copy.destination_stride_p = kept.step(first, copy.destination_stride_p, copy.n_p);
  copy.destination_stride_q = kept.step(first, copy.destination_stride_q, copy.n_q);
  return copy;
}

/// The line parameters of those chains that are kept, measured on the whole mesh.
std::vector<double> measured(HostInstance const& host, LineTables const& lines, std::vector<KeptChain> const& kept,
                             Coordinates const& x) {
  using Host = Kokkos::HostSpace;
  std::vector<double> t(std::size_t(lines.n_parameters));
  auto const measure = [&](auto const& exec) {
    using Exec = std::decay_t<decltype(exec)>;
    constexpr int width = kernels::TileShape<Exec>::lines;
    std::vector<kernels::Tube> tubes;
    std::vector<Index> first{0};
    for (kernels::Tube const& tube : lines.tubes) {
      if (!kept[tube.chain].any() || !lines.chains[tube.chain].has_parameters()) continue;
      tubes.push_back(tube);
      first.push_back(first.back() + kernels::LineParameters<Host, width>::items(tube));
    }
    auto const table = host_lines(lines);
    kernels::TileList<kernels::Tube, Host> list;
    list.entries = Kokkos::View<kernels::Tube const*, Host>(tubes.data(), tubes.size());
    list.first_item = Kokkos::View<Index const*, Host>(first.data(), first.size());
    list.n_items = first.back();
    kernels::line_parameters(
        exec, table.chains, list, table.segments,
        Kokkos::View<kernels::ParameterTarget const*, Host>(lines.targets.data(), lines.targets.size()),
        kernels::Field<double const>{x.x.data(), x.y.data(), x.z.data()}, t.data());
    compat::fence(exec, "gridmorph::share_of (line parameters are cut to boxes)");
  };
  host.visit(measure);
  return t;
}

class Sharing {
 public:
  Sharing(HostInstance const& host, Plan const& whole, BoundaryMesh const& mesh, std::span<NodeBox const> boxes)
      : host_(host),
        whole_(whole),
        mesh_(mesh),
        own_(mesh, boxes),
        cuts_of_(whole.boxes.size()),
        needed_(std::size_t(whole.n_slots), 0) {}

  Plan result() {
    out_.n_nodes = own_.n_nodes();
    copy_what_all_need();
    cut_volume();
    cut_skeleton_nodes();
    keep_what_is_needed();
    Index first = 0;  // of line parameters, where the whole plan has them
    for (std::size_t n = 0; n < whole_.stages.size(); ++n)
      out_.stages.push_back(share(whole_.stages[n], kept_[n], first));
    for (std::size_t n = 0; n < whole_.spreads.size(); ++n)
      out_.spreads.push_back(share(whole_.spreads[n], kept_[whole_.stages.size() + n], first));
    if (std::none_of(out_.stages.begin(), out_.stages.end(), [](Stage const& stage) { return stage.turns; }))
      out_.turns = {};
    return std::move(out_);
  }

 private:
  /// A box of the volume within one of the share: its number there, and where it starts in the whole one.
  struct Cut {
    int box;
    Index3 begin;
  };

  void copy_what_all_need() {
    out_.boundary_nodes = whole_.boundary_nodes;
    out_.boundary_slots = whole_.boundary_slots;
    out_.boundary_projections = whole_.boundary_projections;
    out_.turns = whole_.turns;
    out_.common = whole_.common;
    out_.law_knots = whole_.law_knots;
    out_.surfaces = whole_.surfaces;
    out_.rotations = whole_.rotations;
    out_.n_slots = whole_.n_slots;
    out_.mesh_size = whole_.mesh_size;
  }

  void cut_volume() {
    for (std::size_t b = 0; b < whole_.boxes.size(); ++b) {
      kernels::VolumeBox const& box = whole_.boxes[b];
      int const z = mesh_.zone_of(box.first);
      Index3 const at = mesh_.zones[z].index(box.first);
      for (Part const& own : own_.in_zone(z)) {
        IndexRange const nodes = intersection(own.nodes, {at, {at[0] + box.n[0], at[1] + box.n[1], at[2] + box.n[2]}});
        if (nodes.size() < 1) continue;
        cuts_of_[b].push_back({int(out_.boxes.size()), minus(nodes.begin, at)});
        kernels::VolumeBox part = box;
        part.first = own.node(nodes.begin);
        part.stride_j = own.strides()[1];
        part.stride_k = own.strides()[2];
        for (int d = 0; d < 3; ++d) part.n[d] = nodes.extent(d);
        out_.boxes.push_back(part);
      }
    }
  }

  void cut_skeleton_nodes() {
    for (kernels::NodeCopy const& copy : whole_.skeleton_nodes) {
      int const z = mesh_.zone_of(copy.destination);
      Zone const& zone = mesh_.zones[z];
      Index3 const first = zone.index(copy.destination);
      auto const along = [&](Index stride, int n) {
        return n < 2 ? Index3{0, 0, 0} : minus(zone.index(copy.destination + stride), first);
      };
      Index3 const p_step = along(copy.destination_stride_p, copy.n_p),
                   q_step = along(copy.destination_stride_q, copy.n_q);
      for (Part const& own : own_.in_zone(z)) {
        int p[2] = {0, copy.n_p}, q[2] = {0, copy.n_q};
        if (!limit(first, p_step, q_step, own.nodes, p, q)) continue;
        kernels::NodeCopy part = copy;
        part.source += p[0] * copy.source_stride_p + q[0] * copy.source_stride_q;
        part.n_p = p[1] - p[0];
        part.n_q = q[1] - q[0];
        Index3 at = first;
        for (int d = 0; d < 3; ++d) at[d] += p[0] * p_step[d] + q[0] * q_step[d];
        auto const stride = own.strides();
        part.destination = own.node(at);
        part.destination_stride_p = part.destination_stride_q = 0;
        for (int d = 0; d < 3; ++d) {
          part.destination_stride_p += p_step[d] * stride[d];
          part.destination_stride_q += q_step[d] * stride[d];
        }
        need(part);
        out_.skeleton_nodes.push_back(part);
      }
    }
  }

  /// Cuts the ranges of p and q to the nodes first + p p_step + q q_step within a box; false: none is. Steps are along
  /// one axis each, of either sense, or zero where there is one node.
  static bool limit(Index3 const& first, Index3 const& p_step, Index3 const& q_step, IndexRange const& box, int (&p)[2],
                    int (&q)[2]) {
    for (int d = 0; d < 3; ++d) {
      if (p_step[d] == 0 && q_step[d] == 0) {
        if (first[d] < box.begin[d] || first[d] >= box.end[d]) return false;
        continue;
      }
      int const step = p_step[d] != 0 ? p_step[d] : q_step[d];
      auto& range = p_step[d] != 0 ? p : q;
      int const low = step > 0 ? box.begin[d] - first[d] : first[d] - box.end[d] + 1;
      int const high = step > 0 ? box.end[d] - first[d] : first[d] - box.begin[d] + 1;
      range[0] = std::max(range[0], low);
      range[1] = std::min(range[1], high);
    }
    return p[0] < p[1] && q[0] < q[1];
  }

  /// From the last pass back to the first stage: rows that make a slot known that is needed, the lines that these and
  /// the boxes read, and what the ends of these lines are.
  void keep_what_is_needed() {
    for (Stage const& stage : whole_.stages) kept_.emplace_back(stage.lines);
    for (SpreadPass const& pass : whole_.spreads) kept_.emplace_back(pass.lines);
    for (std::size_t n = whole_.spreads.size(); n-- > 0;) {
      SpreadPass const& pass = whole_.spreads[n];
      KeptLines& kept = kept_[whole_.stages.size() + n];
      keep_lines(pass, kept);
      for (kernels::SlipEnd const& end : pass.ends)
        if (kept.has(end.value)) needed_[std::size_t(end.slot)] = 1;
    }
    for (std::size_t n = whole_.stages.size(); n-- > 0;) {
      Stage const& stage = whole_.stages[n];
      KeptLines& kept = kept_[n];
      keep_lines(stage, kept);
      for (kernels::NodeCopy const& copy : stage.ends)
        if (auto const part = cut(copy, kept)) need(*part);
      for (kernels::NodeCopy const& copy : stage.sides.gathers)
        if (kept.chains[chain_of_side_node(stage.sides, copy.destination)].any()) need(copy);
    }
  }
  /// The slots that a copy reads.
  void need(kernels::NodeCopy const& copy) {
    for (int q = 0; q < copy.n_q; ++q)
      for (int p = 0; p < copy.n_p; ++p)
        needed_[std::size_t(copy.source + p * copy.source_stride_p + q * copy.source_stride_q)] = 1;
  }

  template <class StageOrPass>
  void keep_lines(StageOrPass const& stage, KeptLines& kept) const {
    for (VolumePart const& part : stage.volume)
      for (Cut const& box : cuts_of_[part.box]) {
        kernels::VolumeTerm const& term = part.term;
        for (int const corner : {0, 7}) {  // of the box: lines are along its axes
          Index a = term.a[0], b = term.b[0];
          for (int d = 0; d < 3; ++d) {
            int const at = box.begin[d] + (corner >> d & 1) * (out_.boxes[box.box].n[d] - 1);
            a += at * term.a[1 + d];
            b += at * term.b[1 + d];
          }
          kept.chains[term.chain].include(int(a), int(b));
        }
      }
    kept.sweeps.resize(stage.sweeps.size());
    for (std::size_t n = 0; n < stage.sweeps.size(); ++n) {
      kernels::SkeletonSweep const& sweep = stage.sweeps[n];
      auto& [p, q] = kept.sweeps[n];
      for (int m = 0; m < sweep.n_q; ++m)
        for (int k = 0; k < sweep.n_p; ++k)
          if (needed_[std::size_t(sweep.slot + k + m * sweep.slot_q)] != 0) {
            p.include(k);
            q.include(m);
          }
      if (!p.any()) continue;
      for (int const k : {p.begin, p.end - 1})
        for (int const m : {q.begin, q.end - 1})
          kept.chains[sweep.chain].include(sweep.a[0] + k * sweep.a[1] + m * sweep.a[2],
                                           sweep.b[0] + k * sweep.b[1] + m * sweep.b[2]);
    }
    for (std::size_t c = 0; c < kept.chains.size(); ++c) {
      kernels::Chain const& chain = stage.lines.chains[c];
      if (!kept.chains[c].any() || chain.first_side < 0) continue;
      // Known sides are blended across all lines.
      kept.chains[c].include(0, 0);
      kept.chains[c].include(chain.n_a - 1, chain.n_b - 1);
    }
    kept.number_chains();
  }

  static std::size_t side_of_node(SideTables const& sides, Index node) {
    auto const after = std::upper_bound(sides.sides.begin(), sides.sides.end(), node,
                                        [](Index n, kernels::Side const& s) { return n < s.first; });
    return std::size_t(after - sides.sides.begin()) - 1;
  }
  static std::size_t chain_of_side_node(SideTables const& sides, Index node) {
    return std::size_t(sides.sides[side_of_node(sides, node)].chain);
  }

  /// Line parameters of a stage of the whole plan, which begin at `first` where it has them all.
  std::vector<double> parameters(LineTables const& lines, KeptLines const& kept, Index& first) const {
    Index const begin = std::exchange(first, first + lines.n_parameters);
    if (whole_.line_parameters.empty()) return measured(host_, lines, kept.chains, mesh_.coordinates);
    return {whole_.line_parameters.begin() + begin, whole_.line_parameters.begin() + first};
  }

  /// Appends those of n[0] x n[1] x n[2] nodes, i fastest; returns the number of the first among those of the stage.
  static Index append_parameters(std::vector<double> const& from, Index first, std::array<Index, 3> const& stride,
                                 Index3 const& n, std::vector<double>& to) {
    Index const begin = Index(to.size());
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i)
          to.push_back(from[std::size_t(first + i * stride[0] + j * stride[1] + k * stride[2])]);
    return begin;
  }

  /// Chains with their end values, sweeps and parts of the volume: what stages and passes have in common.
  template <class StageOrPass>
  void share_lines(StageOrPass const& from, KeptLines const& kept, Index& first_parameter, StageOrPass& to) {
    std::vector<double> const t = parameters(from.lines, kept, first_parameter);
    std::vector<double> own;
    for (std::size_t c = 0; c < kept.chains.size(); ++c) {
      KeptChain const& lines = kept.chains[c];
      if (!lines.any()) continue;
      kernels::Chain const& whole = from.lines.chains[c];
      kernels::Chain chain = whole;
      chain.first_end_value = lines.first_end_value;
      chain.n_a = lines.a.size();
      chain.n_b = lines.b.size();
      to.lines.chains.push_back(chain);
      to.lines.n_end_values += 2 * chain.section_size();
      if (from.lines.end_positions.empty()) continue;
      for (int end = 0; end < 2; ++end)
        for (int b = lines.b.begin; b < lines.b.end; ++b) {
          Index const row = whole.first_end_value + end * whole.section_size() + lines.a.begin + Index(whole.n_a) * b;
          append_range(from.lines.end_positions, row, chain.n_a, to.lines.end_positions);
          append_range(from.lines.end_pivots, row, chain.n_a, to.lines.end_pivots);
        }
    }
    for (std::size_t n = 0; n < from.sweeps.size(); ++n)
      if (auto const& [p, q] = kept.sweeps[n]; p.any())
        to.sweeps.push_back(share(from.sweeps[n], p, q, kept, from.lines, t, own, to.lines.swept_positions));
    for (VolumePart const& part : from.volume)
      for (Cut const& cut : cuts_of_[part.box]) to.volume.push_back(share(part, cut, kept, t, own));
    to.lines.n_parameters = Index(own.size());
    out_.line_parameters.insert(out_.line_parameters.end(), own.begin(), own.end());
  }

  static kernels::SkeletonSweep share(kernels::SkeletonSweep sweep, Range const& p, Range const& q,
                                      KeptLines const& kept, LineTables const& from, std::vector<double> const& t,
                                      std::vector<double>& own, std::vector<Vec3>& positions) {
    KeptChain const& lines = kept.chains[sweep.chain];
    if (sweep.x >= 0) {
      Index const first = std::exchange(sweep.x, Index(positions.size()));
      for (int m = q.begin; m < q.end; ++m)
        append_range(from.swept_positions, first + p.begin + Index(sweep.n_p) * m, p.size(), positions);
    }
    if (sweep.t >= 0) {
      Index const first = sweep.t + p.begin * sweep.t_p + q.begin * sweep.t_q;
      sweep.t = append_parameters(t, first, {sweep.t_p, sweep.t_q, 0}, {p.size(), q.size(), 1}, own);
      sweep.t_p = 1;
      sweep.t_q = p.size();
    }
    for (auto* const place : {&sweep.s, &sweep.a, &sweep.b})
      (*place)[0] += p.begin * (*place)[1] + q.begin * (*place)[2];
    sweep.a[0] -= lines.a.begin;
    sweep.b[0] -= lines.b.begin;
    sweep.slot += p.begin + q.begin * sweep.slot_q;
    sweep.n_p = p.size();
    sweep.n_q = q.size();
    sweep.chain = lines.number;
    return sweep;
  }

  VolumePart share(VolumePart const& part, Cut const& cut, KeptLines const& kept, std::vector<double> const& t,
                   std::vector<double>& own) const {
    kernels::VolumeBox const &whole = whole_.boxes[part.box], &box = out_.boxes[cut.box];
    VolumePart out{cut.box, part.term};
    kernels::VolumeTerm& term = out.term;
    KeptChain const& lines = kept.chains[term.chain];
    for (int d = 0; d < 3; ++d) {
      term.end_value += cut.begin[d] * term.end_stride[d];
      for (auto* const place : {&term.s, &term.a, &term.b}) (*place)[0] += cut.begin[d] * (*place)[1 + d];
    }
    for (int d = 0; d < 3; ++d) term.end_stride[d] = kept.step(term.end_value, term.end_stride[d], box.n[d]);
    term.end_value = kept.number(term.end_value);
    term.chain = lines.number;
    term.a[0] -= lines.a.begin;
    term.b[0] -= lines.b.begin;
    if (term.t >= 0) {
      std::array<Index, 3> const stride{1, whole.n[0], Index(whole.n[0]) * whole.n[1]};
      Index const first = term.t + cut.begin[0] + cut.begin[1] * stride[1] + cut.begin[2] * stride[2];
      term.t = append_parameters(t, first, stride, {box.n[0], box.n[1], box.n[2]}, own);
    }
    return out;
  }

  Stage share(Stage const& from, KeptLines const& kept, Index& first_parameter) {
    Stage to;
    to.name = from.name;
    share_lines(from, kept, first_parameter, to);
    to.turns = from.turns && !to.lines.chains.empty();
    share_sides(from, kept, to);
    for (kernels::NodeCopy const& copy : from.ends)
      if (auto const part = cut(copy, kept)) to.ends.push_back(renumbered(*part, kept));
    for (kernels::NearFieldLine line : from.near_field) {
      if (!kept.has(line.lower)) continue;
      line.lower = kept.number(line.lower);
      line.upper = kept.number(line.upper);
      to.near_field.push_back(line);
    }
    return to;
  }

  /// The tables of known sides of the chains that are kept.
  static void share_sides(Stage const& from, KeptLines const& kept, Stage& to) {
    SideTables const& all = from.sides;
    std::vector<std::int32_t> side_number(all.sides.size(), -1);
    std::vector<Index> node_shift(all.sides.size(), 0);
    for (std::size_t c = 0; c < kept.chains.size(); ++c) {
      kernels::Chain const& whole = from.lines.chains[c];
      if (!kept.chains[c].any() || whole.first_side < 0) continue;
      kernels::Chain& chain = to.lines.chains[kept.chains[c].number];
      chain.first_side = std::int32_t(to.sides.sides.size());
      chain.first_junction = std::int32_t(to.sides.junctions.size());
      chain.first_section = Index(to.sides.section.size());
      append_range(all.junctions, whole.first_junction, whole.n_blocks + 1, to.sides.junctions);
      append_range(all.section, whole.first_section, 4 * whole.section_size(), to.sides.section);
      for (int q = 0; q < 4; ++q) {
        std::size_t const number = std::size_t(whole.first_side + q);
        kernels::Side side = all.sides[number];
        Index const n = Index(whole.n_s) * side.n_w;
        side_number[number] = std::int32_t(to.sides.sides.size());
        node_shift[number] = Index(to.sides.t.size()) - side.first;
        append_range(all.t, side.first, n, to.sides.t);
        if (!all.positions.empty()) append_range(all.positions, side.first, n, to.sides.positions);
        side.first += node_shift[number];
        side.chain = kept.chains[c].number;
        to.sides.sides.push_back(side);
      }
    }
    for (kernels::SideLine line : all.lines)
      if (side_number[line.side] >= 0) {
        line.side = side_number[line.side];
        to.sides.lines.push_back(line);
      }
    for (std::int32_t const chain : all.corrected)
      if (kept.chains[chain].any()) to.sides.corrected.push_back(kept.chains[chain].number);
    for (kernels::NodeCopy copy : all.gathers)
      if (std::size_t const side = side_of_node(all, copy.destination); side_number[side] >= 0) {
        copy.destination += node_shift[side];
        to.sides.gathers.push_back(copy);
      }
  }

  SpreadPass share(SpreadPass const& from, KeptLines const& kept, Index& first_parameter) {
    SpreadPass to;
    share_lines(from, kept, first_parameter, to);
    for (kernels::SlipEnd end : from.ends)
      if (kept.has(end.value)) {
        end.value = kept.number(end.value);
        to.positions.push_back(mesh_.coordinates[end.node]);
        to.ends.push_back(end);
      }
    return to;
  }

  HostInstance const& host_;
  Plan const& whole_;
  BoundaryMesh const& mesh_;
  OwnBoxes own_;
  std::vector<std::vector<Cut>> cuts_of_;  ///< per box of the whole plan
  std::vector<char> needed_;               ///< per slot
  std::vector<KeptLines> kept_;            ///< per stage, then per pass
  Plan out_;
};

}  // namespace

Plan share_of(HostInstance const& host, Plan const& whole, BoundaryMesh const& mesh, std::span<NodeBox const> boxes) {
  return Sharing(host, whole, mesh, boxes).result();
}

SmoothingMap share_of(SmoothingMap const& whole, BoundaryMesh const& mesh, std::span<NodeBox const> boxes) {
  OwnBoxes const own(mesh, boxes);
  SmoothingMap out = whole;
  out.n_nodes = own.n_nodes();
  out.node.clear();
  out.shift.clear();
  out.slide_nodes.clear();
  auto const for_copies = [&](Index node, auto const& visit) {
    int const z = mesh.zone_of(node);
    Index3 const at = mesh.zones[z].index(node);
    for (Part const& box : own.in_zone(z))
      if (box.nodes.contains(at)) visit(box.node(at));
  };
  std::vector<std::pair<Index, std::size_t>> moved;  // node here, entry there
  for (std::size_t k = 0; k < whole.node.size(); ++k)
    for_copies(whole.node[k], [&](Index node) { moved.emplace_back(node, k); });
  std::sort(moved.begin(), moved.end());
  for (auto const& [node, k] : moved) {
    out.node.push_back(node);
    append_range(whole.shift, Index(k) * whole.n_modes, whole.n_modes, out.shift);
  }
  for (kernels::SlidingNode const& slides : whole.slide_nodes)
    for_copies(slides.node, [&](Index node) {
      out.slide_nodes.push_back(slides);
      out.slide_nodes.back().node = node;
    });
  return out;
}

}  // namespace gridmorph
