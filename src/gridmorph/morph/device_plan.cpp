#include <gridmorph/core/instantiate.hpp>
#include <gridmorph/core/large_pages.hpp>
#include <gridmorph/morph/device_plan.hpp>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace gridmorph::detail {
namespace {

template <class T>
void append(std::vector<T>& to, std::vector<T> const& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// What to add to the numbers of a stage's tables so that they count in the joined ones.
struct Shift {
  std::int32_t chain, segment, target, side, junction;
  Index parameter, end_value, side_node, section, swept;

  explicit Shift(JoinedTables const& to)
      : chain(std::int32_t(to.lines.chains.size())),
        segment(std::int32_t(to.lines.segments.size())),
        target(std::int32_t(to.lines.targets.size())),
        side(std::int32_t(to.sides.sides.size())),
        junction(std::int32_t(to.sides.junctions.size())),
        parameter(to.lines.n_parameters),
        end_value(to.lines.n_end_values),
        side_node(Index(to.sides.t.size())),
        section(Index(to.sides.section.size())),
        swept(Index(to.lines.swept_positions.size())) {}
};

void join_lines(LineTables const& from, Shift const& shift, LineTables& to) {
  for (kernels::Chain c : from.chains) {
    c.first_end_value += shift.end_value;
    if (c.first_side >= 0) {
      c.first_side += shift.side;
      c.first_junction += shift.junction;
      c.first_section += shift.section;
    }
    to.chains.push_back(c);
  }
  for (kernels::Tube tube : from.tubes) {
    tube.chain += shift.chain;
    tube.first_segment += shift.segment;
    to.tubes.push_back(tube);
  }
  for (kernels::Segment segment : from.segments) {
    for (std::int32_t& target : segment.target)
      if (target >= 0) target += shift.target;
    to.segments.push_back(segment);
  }
  for (kernels::ParameterTarget target : from.targets) {
    target.first += shift.parameter;
    to.targets.push_back(target);
  }
  if (!from.end_positions.empty()) {
    to.end_positions.resize(to.n_end_values);
    append(to.end_positions, from.end_positions);
    to.end_pivots.resize(to.n_end_values);
    append(to.end_pivots, from.end_pivots);
  }
  append(to.swept_positions, from.swept_positions);
  to.n_parameters += from.n_parameters;
  to.n_end_values += from.n_end_values;
}

void join_sides(gridmorph::SideTables const& from, Shift const& shift, gridmorph::SideTables& to) {
  for (kernels::Side side : from.sides) {
    side.chain += shift.chain;
    side.first += shift.side_node;
    to.sides.push_back(side);
  }
  if (!from.positions.empty()) {
    to.positions.resize(to.t.size());
    append(to.positions, from.positions);
  }
  append(to.junctions, from.junctions);
  append(to.t, from.t);
  append(to.section, from.section);
}

/// The sides of a stage's chains, numbered in the joined tables, that rows of the volume run across, from one line to
/// the next.
std::vector<std::int32_t> sides_run_across(Stage const& stage, Shift const& shift) {
  std::vector<std::int32_t> out;
  for (VolumePart const& part : stage.volume) {
    kernels::Chain const& chain = stage.lines.chains[part.term.chain];
    if (chain.first_side < 0) continue;
    for (int side = 0; side < 4; ++side)
      if ((side < 2 ? part.term.b : part.term.a)[1] != 0 && chain.side_matters(side))
        out.push_back(shift.side + chain.first_side + side);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Makes room for second copies of sides (kernels::Side::across) behind all that there is, and their parameters; the
/// work that fills them.
std::vector<kernels::SideLine> add_copies_across(std::vector<std::int32_t> const& copied, JoinedTables& to) {
  std::vector<kernels::SideLine> pieces;
  for (std::int32_t const number : copied) {
    kernels::Side& side = to.sides.sides[number];
    int const n_s = to.lines.chains[side.chain].n_s;
    side.across = Index(to.sides.t.size());
    for (int p = 0; p < n_s; ++p)
      for (int w = 0; w < side.n_w; ++w) {
        double const t = to.sides.t[side.first + Index(n_s) * w + p];  // not from the array that grows
        to.sides.t.push_back(t);
      }
    for (int w = 0; w < side.n_w; w += kernels::SidesAcross<Kokkos::HostSpace>::lines) pieces.push_back({number, w});
  }
  return pieces;
}

/// Per node of a side 1 / (t(next) - t) along its line, 0 where they are equal.
std::vector<double> inverse_steps(JoinedTables const& joined) {
  std::vector<double> const& t = joined.sides.t;
  std::vector<double> out(t.size(), 0);
  for (kernels::Side const& side : joined.sides.sides) {
    int const n_s = joined.lines.chains[side.chain].n_s;
    for (int w = 0; w < side.n_w; ++w)
      for (int p = 0; p + 1 < n_s; ++p) {
        Index const at = side.first + Index(n_s) * w + p;
        if (double const rise = t[at + 1] - t[at]; rise > 0) out[at] = 1 / rise;
        if (side.across >= 0) out[side.across + Index(side.n_w) * p + w] = out[at];
      }
  }
  return out;
}

std::vector<kernels::SkeletonSweep> shifted(std::vector<kernels::SkeletonSweep> sweeps, Shift const& shift) {
  for (kernels::SkeletonSweep& sweep : sweeps) {
    sweep.chain += shift.chain;
    if (sweep.t >= 0) sweep.t += shift.parameter;
    if (sweep.x >= 0) sweep.x += shift.swept;
  }
  return sweeps;
}

std::vector<kernels::NodeCopy> shifted(std::vector<kernels::NodeCopy> copies, Index destination) {
  for (kernels::NodeCopy& copy : copies) copy.destination += destination;
  return copies;
}

std::vector<kernels::NearFieldLine> shifted(std::vector<kernels::NearFieldLine> lines, Shift const& shift) {
  for (kernels::NearFieldLine& line : lines) {
    line.lower += shift.end_value;
    line.upper += shift.end_value;
  }
  return lines;
}

/// What an end slides on.
kernels::SlipKinds kind_of(kernels::SlipEnd const& end, std::vector<SlipSurface> const& surfaces) {
  using kernels::SlipKinds;
  auto kind = end.surface[1] < 0 ? SlipKinds::simple : SlipKinds::smooth;
  for (std::int32_t const number : end.surface) {
    if (number < 0) continue;
    if (surfaces[number].kind == kernels::SlipKind::facets) return SlipKinds::any;
    if (surfaces[number].kind == kernels::SlipKind::meridional) kind = SlipKinds::smooth;
  }
  return kind;
}

/// The values of a pass that none of its ends has; its values start with the first.
std::vector<Index> at_rest(std::vector<kernels::SlipEnd> const& ends, Index first, Index n_values) {
  std::vector<char> slides(std::size_t(n_values), 0);
  for (kernels::SlipEnd const& end : ends) slides[std::size_t(end.value - first)] = 1;
  std::vector<Index> out;
  for (Index n = 0; n < n_values; ++n)
    if (!slides[std::size_t(n)]) out.push_back(first + n);
  return out;
}

/// What the terms of a box have.
kernels::VolumeKind kind_of(kernels::VolumeBox const& box, JoinedTables const& joined) {
  auto kind = box.common < 0 ? kernels::VolumeKind::plain : kernels::VolumeKind::turned;
  for (std::int32_t n = 0; n < box.n_terms; ++n) {
    kernels::VolumeTerm const& term = joined.terms[box.first_term + n];
    kernels::Chain const& chain = joined.lines.chains[term.chain];
    if (chain.first_side >= 0) return kernels::VolumeKind::any;
    if (chain.turn != kernels::TurnLaw::none || term.matrix >= 0) kind = kernels::VolumeKind::turned;
  }
  return kind;
}

/// Puts entries in the order of their kinds, where each kind has a kernel of its own.
template <bool Host, class Entry, class KindOf>
void sort_by_kind(std::vector<Entry>& entries, KindOf const& kind) {
  if constexpr (!Host)
    std::stable_sort(entries.begin(), entries.end(), [&](auto const& a, auto const& b) { return kind(a) < kind(b); });
}

void collect_parts(std::vector<VolumePart> const& parts, Shift const& shift,
                   std::vector<std::vector<kernels::VolumeTerm>>& of_box) {
  for (VolumePart const& part : parts) {
    kernels::VolumeTerm term = part.term;
    term.chain += shift.chain;
    term.end_value += shift.end_value;
    if (term.t >= 0) term.t += shift.parameter;
    of_box[part.box].push_back(term);
  }
}

/// The stages of a plan in their order, those together that follow one another and need not wait: none of them writes a
/// slot of the skeleton that another one reads or writes. Cost: linear in the nodes of the skeleton.
std::vector<std::vector<Stage const*>> launched_together(Plan const& plan) {
  // The last launch that writes a slot, and that reads it.
  std::vector<std::size_t> written(std::size_t(plan.n_slots), 0), read(std::size_t(plan.n_slots), 0);
  auto const each_read = [](Stage const& stage, auto const& visit) {
    for (auto const* const list : {&stage.ends, &stage.sides.gathers})
      for (kernels::NodeCopy const& copy : *list)
        for (Index q = 0; q < copy.n_q; ++q)
          for (Index p = 0; p < copy.n_p; ++p)
            visit(std::size_t(copy.source + p * copy.source_stride_p + q * copy.source_stride_q));
  };
  auto const each_written = [](Stage const& stage, auto const& visit) {
    for (kernels::SkeletonSweep const& sweep : stage.sweeps)
      for (std::int32_t q = 0; q < sweep.n_q; ++q)
        for (std::int32_t p = 0; p < sweep.n_p; ++p) visit(std::size_t(sweep.slot + p + q * sweep.slot_q));
  };
  std::vector<std::vector<Stage const*>> launches;
  for (Stage const& stage : plan.stages) {
    std::size_t const last = launches.size();
    // Where rotations come to ends they come to all ends of a launch.
    bool waits = launches.empty() || stage.turns || launches.back().front()->turns;
    if (!waits) {
      each_read(stage, [&](std::size_t slot) { waits = waits || written[slot] == last; });
      each_written(stage, [&](std::size_t slot) { waits = waits || written[slot] == last || read[slot] == last; });
    }
    if (waits) launches.emplace_back();
    launches.back().push_back(&stage);
    each_read(stage, [&](std::size_t slot) { read[slot] = launches.size(); });
    each_written(stage, [&](std::size_t slot) { written[slot] = launches.size(); });
  }
  return launches;
}

/// Vectors of the host, component by component.
template <class Exec>
Workspace<typename Exec::memory_space> positions(Exec const& exec, std::vector<Vec3> const& host, char const* what) {
  std::vector<double> values;
  for (double Vec3::*const component : {&Vec3::x, &Vec3::y, &Vec3::z})
    for (Vec3 const& v : host) values.push_back(v.*component);
  Workspace<typename Exec::memory_space> out;
  out.values = table(exec, values, what);
  out.n = Index(host.size());
  compat::fence(exec, "gridmorph::Morpher (host positions may go)");
  return out;
}

template <class Exec>
void add_bodies(Exec const& exec, TurningRoots const& bodies, int fields, DeviceTurns<Exec>& turns) {
  Index const n_bodies = Index(bodies.first_chunk.size()) - 1, n_chunks = bodies.first_chunk.back();
  turns.bodies = {table(exec, bodies.root, "bodies::roots"),
                  {},
                  table(exec, bodies.weight, "bodies::weights"),
                  table(exec, bodies.first, "bodies::first"),
                  table(exec, bodies.first_chunk, "bodies::first_chunk"),
                  table(exec, std::vector<Vec3>(std::size_t(n_bodies)), "bodies::axes"),
                  n_chunks};
  turns.body_sums = Kokkos::View<kernels::VectorMoments*, typename Exec::memory_space>(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::Morpher::bodies::sums"), n_chunks);
  turns.mean = Workspace<typename Exec::memory_space>(exec, n_bodies, fields, "bodies::turns");
}

template <class Exec>
DeviceTurns<Exec> device_turns(Exec const& exec, Plan const& plan, JoinedTables& joined,
                               SlipSurfaceTable<typename Exec::memory_space> const& surfaces,
                               Kokkos::View<Mat3*, typename Exec::memory_space> const& rotations, int fields) {
  using Work = Workspace<typename Exec::memory_space>;
  DeviceTurns<Exec> out;
  out.table.roots = table(exec, plan.turns.roots, "roots");
  out.table.neighbours = table(exec, plan.turns.neighbours, "root_neighbours");
  out.table.ends = table(exec, plan.turns.ends, "root_ends");
  out.table.end_walls = table(exec, plan.turns.end_walls, "end_walls");
  out.table.surfaces = surfaces.surfaces;
  out.table.matrices = rotations;
  out.n_ends = joined.lines.n_end_values;
  add_bodies(exec, plan.turns.bodies, fields, out);
  Index const n_roots = Index(plan.turns.roots.size());
  out.slots = Work(exec, plan.n_slots, fields, "turns");
  out.free = Work(exec, n_roots, fields, "free_root_turns");
  out.raw = Work(exec, n_roots, fields, "root_turns");
  out.outer = Work(exec, n_roots, fields, "outer_turns");
  out.at_end = Work(exec, 3 * Index(plan.turns.end_walls.size()), fields, "end_wall_turns");
  out.end_turns = Work(exec, out.n_ends, fields, "end_turns");
  out.ends = Kokkos::View<double*, typename Exec::memory_space>(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::Morpher::turned_ends"),
      out.ends_stride() * fields);
  joined.lines.end_positions.resize(out.n_ends);
  joined.lines.end_pivots.resize(out.n_ends);
  joined.sides.positions.resize(joined.sides.t.size());
  out.end_position = positions(exec, joined.lines.end_positions, "end_positions");
  out.end_pivot = positions(exec, joined.lines.end_pivots, "end_pivots");
  out.swept_position = positions(exec, joined.lines.swept_positions, "swept_positions");
  out.side_position = positions(exec, joined.sides.positions, "side_positions");
  return out;
}

}  // namespace

template <class Exec>
DevicePlan<Exec>::DevicePlan(Exec const& exec, Plan const& plan, kernels::Field<double const> x, int n_fields)
    : fields(n_fields) {
  surfaces = SlipSurfaceTable<Memory>(exec, plan.surfaces);
  JoinedTables joined;
  std::vector<std::vector<kernels::VolumeTerm>> of_box(plan.boxes.size());
  auto copies = [&](std::vector<kernels::NodeCopy> const& list, char const* what) {
    return WorkList<kernels::NodeCopy, Memory>(exec, list, Copy::items, what);
  };
  auto sweeps = [&](std::vector<kernels::SkeletonSweep> const& list) {
    return WorkList<kernels::SkeletonSweep, Memory>(exec, list, Sweep::items, "sweeps");
  };
  for (Stage const& stage : plan.stages) n_end_values += stage.lines.n_end_values;
  for (SpreadPass const& pass : plan.spreads) n_end_values += pass.lines.n_end_values;
  for (std::vector<Stage const*> const& together : launched_together(plan)) {
    DeviceStage<Exec> device;
    device.region = "gridmorph::stage";
    device.first_end_value = joined.lines.n_end_values;
    std::vector<kernels::NodeCopy> ends, gathers;
    std::vector<kernels::SkeletonSweep> written;
    std::vector<kernels::SideNodes> side_nodes;
    std::vector<kernels::SideLine> side_lines;
    std::vector<std::int32_t> corrected, run_across;
    std::vector<kernels::NearFieldLine> near_field;
    for (Stage const* const stage : together) {
      Shift const shift(joined);
      device.region += (stage == together.front() ? " " : ", ") + stage->name;
      append(ends, shifted(stage->ends, shift.end_value));
      append(gathers, shifted(stage->sides.gathers, n_end_values + shift.side_node));
      append(written, shifted(stage->sweeps, shift));
      for (kernels::Side const& side : stage->sides.sides)
        side_nodes.push_back({shift.side + std::int32_t(&side - stage->sides.sides.data()),
                              stage->lines.chains[side.chain].n_s, side.n_w});
      for (kernels::SideLine const& line : stage->sides.lines) side_lines.push_back({line.side + shift.side, line.w});
      for (std::int32_t const chain : stage->sides.corrected) corrected.push_back(chain + shift.chain);
      append(near_field, shifted(stage->near_field, shift));
      device.turns = stage->turns;
      collect_parts(stage->volume, shift, of_box);
      join_lines(stage->lines, shift, joined.lines);
      join_sides(stage->sides, shift, joined.sides);
      append(run_across, sides_run_across(*stage, shift));
    }
    device.n_end_values = joined.lines.n_end_values - device.first_end_value;
    std::size_t const n_ends = ends.size();
    for (kernels::NodeCopy const& copy : ends) device.ends.n_items += Copy::items(copy);
    append(ends, gathers);
    device.copies = copies(ends, "chain_ends");
    device.ends.entries = Kokkos::subview(device.copies.entries, std::pair<std::size_t, std::size_t>{0, n_ends});
    device.ends.first_item = device.copies.first_item;
    device.gathers = Kokkos::subview(device.copies.entries, std::pair<std::size_t, std::size_t>{n_ends, ends.size()});
    device.sweeps = sweeps(written);
    device.side_nodes = WorkList<kernels::SideNodes, Memory>(exec, side_nodes, SideResidual::items, "side_nodes");
    device.side_lines = table(exec, side_lines, "side_lines");
    device.corrected = table(exec, corrected, "corrected");
    device.near_field = table(exec, near_field, "near_field_lines");
    std::vector<kernels::SideLine> across;
    if constexpr (Shape::host) across = add_copies_across(run_across, joined);
    device.across = table(exec, across, "sides_across");
    stages.push_back(std::move(device));
    // The host lists of these stages end here, and uploads may still read them.
    compat::fence(exec, "gridmorph::Morpher (host tables of a stage may go)");
  }
  std::vector<std::int32_t> n_swept;
  for (std::size_t b = 0; b < plan.boxes.size(); ++b)
    n_swept.push_back(plan.boxes[b].common >= 0 ? std::int32_t(of_box[b].size()) : 0);
  for (SpreadPass const& pass : plan.spreads) {
    Shift const shift(joined);
    DeviceSpread<Exec> device;
    std::vector<kernels::SlipEnd> slip_ends = pass.ends;
    auto const apart = positions(exec, pass.positions, "slip_ends::positions");
    for (std::size_t n = 0; n < slip_ends.size(); ++n) {
      slip_ends[n].value += shift.end_value;
      if (!pass.positions.empty()) slip_ends[n].node = Index(n);
    }
    auto const kind = [&](kernels::SlipEnd const& end) { return kind_of(end, plan.surfaces); };
    sort_by_kind<Shape::host>(slip_ends, kind);
    std::vector<Index> const rest = at_rest(slip_ends, shift.end_value, pass.lines.n_end_values);
    device.at_rest = table(exec, rest, "slip_ends::at_rest");
    for (Index& first : device.items.first) first = Index(rest.size());
    for (kernels::SlipEnd const& end : slip_ends) device.items.add(kind(end), 1);
    device.ends = table(exec, slip_ends, "slip_ends");
    device.baselines = Kokkos::View<kernels::SlipEndBaseline*, Memory>(
        Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::Morpher::slip_ends::baselines"),
        slip_ends.size());
    kernels::slip_end_baselines(exec, device.ends, surfaces.surfaces, pass.positions.empty() ? x : apart.read()[0],
                                device.baselines);
    device.sweeps = sweeps(shifted(pass.sweeps, shift));
    device.first_value = shift.end_value;
    device.n_values = pass.lines.n_end_values;
    collect_parts(pass.volume, shift, of_box);
    join_lines(pass.lines, shift, joined.lines);
    spreads.push_back(std::move(device));
    compat::fence(exec, "gridmorph::Morpher (host tables of a pass may go)");
  }
  for (std::size_t b = 0; b < plan.boxes.size(); ++b) {
    kernels::VolumeBox box = plan.boxes[b];
    box.first_term = std::int32_t(joined.terms.size());
    box.n_terms = std::int32_t(of_box[b].size());
    box.n_swept = n_swept[b];
    append(joined.terms, of_box[b]);
    joined.boxes.push_back(box);
  }
  auto const kind = [&](kernels::VolumeBox const& box) { return kind_of(box, joined); };
  sort_by_kind<Shape::host>(joined.boxes, kind);
  for (kernels::VolumeBox const& box : joined.boxes) volume_items.add(kind(box), Volume::items(box));

  lines.chains = table(exec, joined.lines.chains, "chains");
  lines.segments = table(exec, joined.lines.segments, "segments");
  sides.sides = table(exec, joined.sides.sides, "sides");
  sides.junctions = table(exec, joined.sides.junctions, "junctions");
  sides.t = table(exec, joined.sides.t, "side_parameters");
  std::vector<double> const per_t = inverse_steps(joined);
  sides.per_t = table(exec, per_t, "side_parameters::inverse_steps");
  sides.section = table(exec, joined.sides.section, "section_parameters");
  rotations = table(exec, plan.rotations, "rotations");
  boundary_slots = table(exec, plan.boundary_slots, "boundary_slots");
  boundary_projections = copies(plan.boundary_projections, "boundary_projections");
  skeleton_nodes = copies(plan.skeleton_nodes, "skeleton_nodes");
  boxes = WorkList<kernels::VolumeBox, Memory>(exec, joined.boxes, Volume::items, "boxes");
  terms = table(exec, joined.terms, "terms");
  law_knots = table(exec, plan.law_knots, "law_knots");
  skeleton = Workspace<Memory>(exec, plan.n_slots, fields, "skeleton");
  ends = Workspace<Memory>(exec, n_end_values + Index(joined.sides.t.size()), fields, "end_values");
  residuals = Workspace<Memory>(exec, Index(joined.sides.t.size()), fields, "side_residuals");
  sides.c = residuals.read()[0];
  if (!plan.turns.roots.empty()) turns = device_turns(exec, plan, joined, surfaces, rotations, fields);

  t = Kokkos::View<double*, Memory>(
      Kokkos::view_alloc(exec, Kokkos::WithoutInitializing, "gridmorph::Morpher::line_parameters"),
      joined.lines.n_parameters);
  if constexpr (std::is_same_v<Memory, Kokkos::HostSpace>) prefer_large_pages(t.data(), t.extent(0) * sizeof(double));
  std::vector<kernels::Tube> with_parameters;
  for (kernels::Tube const& tube : joined.lines.tubes)
    if (joined.lines.chains[tube.chain].has_parameters()) with_parameters.push_back(tube);
  WorkList<kernels::Tube, Memory> const tubes(exec, with_parameters, Parameters::items, "tubes");
  lines.tubes = tubes.entries;
  auto const targets = table(exec, joined.lines.targets, "targets");
  if (plan.line_parameters.empty())
    kernels::line_parameters(exec, lines.chains, tubes, lines.segments, targets, x, t.data());
  else
    Kokkos::deep_copy(exec, t, enqueue_copy(exec, plan.line_parameters, "gridmorph::Morpher::given_parameters"));
  compat::fence(exec, "gridmorph::Morpher (host tables of the plan may go)");
}

#define GRIDMORPH_INSTANTIATE(Exec) template struct DevicePlan<Exec>;
GRIDMORPH_FOR_EACH_EXEC(GRIDMORPH_INSTANTIATE)
#undef GRIDMORPH_INSTANTIATE

}  // namespace gridmorph::detail
