// The stages of a morph of blocks: on the skeleton, the faces, edges and corners of all pieces.
#pragma once

#include <gridmorph/morph/detail/block_turns.hpp>
#include <gridmorph/morph/detail/transposed_plan.hpp>
#include <gridmorph/morph/device_plan.hpp>
#include <gridmorph/morph/stages/block_volume.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>

#include <cstddef>
#include <memory>
#include <string>

namespace gridmorph::stages {

/// The tables that the stages of a plan share.
template <class Exec>
using BlockTables = std::shared_ptr<detail::DevicePlan<Exec> const>;

/// What stages on a skeleton do with the tables they share.
template <class Exec>
class OnSkeleton {
 protected:
  using Memory = typename Exec::memory_space;

  explicit OnSkeleton(BlockTables<Exec> tables) : tables_(std::move(tables)) {}

  [[nodiscard]] detail::DevicePlan<Exec> const& plan() const { return *tables_; }
  void copy(char const* label, Exec const& exec, kernels::TileList<kernels::NodeCopy, Memory> const& list,
            kernels::Field<double> const& from, kernels::Field<double> const& to) const {
    kernels::copy_nodes(exec, label, list, plan().rotations, read(from), to);
  }
  [[nodiscard]] kernels::SideTable<Memory> sides(StageField<Exec> const& f) const {
    kernels::SideTable<Memory> table = plan().sides;
    table.c = read(f.residuals);
    return table;
  }
  /// with_turns, with_sides: what its chains have.
  template <bool Add>
  void sweep(Exec const& exec, detail::WorkList<kernels::SkeletonSweep, Memory> const& list, StageField<Exec> const& f,
             bool with_turns, bool with_sides) const {
    kernels::sweep_skeleton<Add>(exec, list, plan().lines.chains, plan().rotations, sides(f), plan().t.data(),
                                 read(f.ends), f.skeleton, plan().law_knots.data(),
                                 plan().turns.of_skeleton(f.number, f.of), with_turns, with_sides);
  }

  /// Where the transposes of sweeps and of the volume read gradients: of displacements before what is in common is
  /// added, or after it.
  [[nodiscard]] kernels::BundleGradients<Memory> gradients(detail::TransposedLines<Exec> const& lines,
                                                           StageField<Exec> const& f, StageField<Exec> const& g,
                                                           bool before_common) const {
    kernels::BundleGradients<Memory> from{lines.bundles, plan().rotations, plan().t.data(), read(g.skeleton),
                                          g.nodes,       no_field(),       no_field(),      g.baseline};
    if (plan().turns.any()) {
      from.slot_turns = plan().turns.slots.read()[g.number];
      from.position = plan().turns.swept_position.read()[0];
    }
    if (before_common && plan().common) {
      from.moves = plan().common->moves.data() + f.number;
      from.n_moves = plan().common->n_moves();
    }
    return from;
  }
  /// Gradients of the ends of lines, from those of all nodes between.
  void sum_lines(Exec const& exec, detail::TransposedLines<Exec> const& lines, Index first_end, Index n_ends,
                 StageField<Exec> const& f, StageField<Exec> const& g, bool before_common) const {
    auto const& turns = plan().turns;
    kernels::launch("gridmorph::transposed::clear_ends", exec, first_end, first_end + n_ends,
                    kernels::ClearVectors{g.ends});
    kernels::launch("gridmorph::transposed::lines", exec, 0, lines.groups.n_items,
                    kernels::LineGradients<Memory, kernels::TileShape<Exec>::lines>{
                        lines.groups.entries, lines.groups.first_item, plan().lines.chains,
                        gradients(lines, f, g, before_common), plan().law_knots.data(),
                        turns.any() ? turns.read_ends(f.number, f.number).values : no_ends(), end_gradients(g)});
  }
  [[nodiscard]] kernels::EndGradients end_gradients(StageField<Exec> const& g) const {
    kernels::EndGradients to{g.ends, {}, {nullptr, nullptr, nullptr}};
    if (plan().turns.any()) {
      to.turned = {plan().turns.ends_of(g.number)};
      to.turns = plan().turns.end_turns.batch()[g.number];
    }
    return to;
  }

  /// Those that have a motion in common.
  template <class Visit>
  void each_part(Visit const& visit) const {
    if (plan().common)
      for (auto const& part : plan().common->parts) visit(part);
  }

 private:
  static Baseline no_field() { return {nullptr, nullptr, nullptr}; }
  static kernels::TurnedEnds<double const> no_ends() { return {}; }

  BlockTables<Exec> tables_;
};

/// First: the boundary's displacement, less what parts have in common, goes to its slots, and how walls turn is taken
/// from it. Linear where none does.
template <class Exec>
class BoundaryValues : OnSkeleton<Exec> {
 public:
  static inline std::string const region = "gridmorph::stage boundary";

  explicit BoundaryValues(BlockTables<Exec> tables) : OnSkeleton<Exec>(std::move(tables)) {}

  void enqueue(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    scatter(exec, f, [&](auto const& part) { part.take(exec, f); });
    turn<false>(exec, f);
  }
  void rate(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& r) const {
    enqueue(exec, x, f);
    scatter(exec, r, [&](auto const& part) { part.take_rate(exec, f, r); });
    turn<true>(exec, r);
  }
  [[nodiscard]] bool bends() const { return this->plan().turns.any(); }
  /// g.boundary is written: gradients of the boundary's displacement.
  void transpose(Exec const& exec, Baseline const&, StageField<Exec> const& f, StageField<Exec> const& g) const {
    auto const& plan = this->plan();
    // Where the walls were when they turned: passes over slip surfaces have trimmed some of their nodes since.
    scatter(exec, f, [&](auto const& part) { part.put_left(exec, f, 0); });
    detail::BlockTurnGradients<Exec>(plan, f.number, g.number).of_walls(exec);
    kernels::copy_back<false>("gridmorph::transposed::axis", exec, plan.transposed->boundary_projections,
                              plan.rotations, read(g.skeleton), g.skeleton);
    this->each_part([&](auto const& part) { part.hold_back(exec, g); });
    kernels::launch(
        "gridmorph::transposed::boundary", exec,
        kernels::GatherBoundary<typename Exec::memory_space>{plan.boundary_slots, read(g.skeleton), g.boundary});
    this->each_part([&](auto const& part) { part.take_back(exec, f, g, plan.common->n_fields); });
  }

 private:
  template <class Take>
  void scatter(Exec const& exec, StageField<Exec> const& f, Take const& take) const {
    kernels::scatter_boundary(exec, this->plan().boundary_slots, f.boundary, f.skeleton);
    this->each_part(take);
    this->copy("gridmorph::boundary::axis", exec, this->plan().boundary_projections, f.skeleton, f.skeleton);
  }
  template <bool Rate>
  void turn(Exec const& exec, StageField<Exec> const& f) const {
    detail::BlockTurns<Exec, Rate>(this->plan(), f.number, f.of).of_walls(exec);
  }
};

/// The chains of one Stage of the plan: faces, edges and corners between known ends. Linear where nothing turns.
template <class Exec>
class LineSweep : OnSkeleton<Exec> {
 public:
  std::string region;

  /// The stage with this number.
  LineSweep(BlockTables<Exec> tables, std::size_t number)
      : OnSkeleton<Exec>(std::move(tables)), region(this->plan().stages[number].region), number_(number) {}

  void enqueue(Exec const& exec, Baseline const&, StageField<Exec> const& f) const { run<false>(exec, f); }
  void rate(Exec const& exec, Baseline const&, StageField<Exec> const& f, StageField<Exec> const& r) const {
    run<false>(exec, f);
    run<true>(exec, r);
  }
  [[nodiscard]] bool bends() const { return this->plan().stages[number_].turns; }
  void keep(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    detail::BlockTurns<Exec, false>(this->plan(), f.number, f.of).of_ends(exec, this->plan().stages[number_]);
  }
  void transpose(Exec const& exec, Baseline const&, StageField<Exec> const& f, StageField<Exec> const& g) const {
    auto const& stage = this->plan().stages[number_];
    auto const& back = this->plan().transposed->stages[number_];
    detail::BlockTurnGradients<Exec> const turns(this->plan(), f.number, g.number);
    turns.clear_ends(exec, stage);
    this->sum_lines(exec, back.lines, stage.first_end_value, stage.n_end_values, f, g, true);
    if (stage.side_lines.extent(0) > 0) sum_sides(exec, stage, back, f, g);
    turns.of_ends(exec, stage, back, g.ends);
    kernels::copy_back<true>("gridmorph::transposed::chain_ends", exec, back.ends, this->plan().rotations, read(g.ends),
                             g.skeleton);
  }

 private:
  using Memory = typename Exec::memory_space;

  /// The correction and its residuals, in reverse.
  void sum_sides(Exec const& exec, detail::DeviceStage<Exec> const& stage, detail::TransposedStage<Exec> const& back,
                 StageField<Exec> const& f, StageField<Exec> const& g) const {
    using kernels::launch;
    auto const& plan = this->plan();
    auto const& chains = plan.lines.chains;
    auto const sides = this->sides(f);
    auto const edges = plan.transposed->edges.batch();
    auto const between = plan.transposed->between.batch()[0];
    launch("gridmorph::transposed::clear_sides", exec, back.first_side_node, back.first_side_node + back.n_side_nodes,
           kernels::ClearVectors{g.residuals});
    clear(exec, plan.transposed->edges);
    sum_in_shares(exec, back, g, [&](kernels::SumShares const& to) {
      launch("gridmorph::transposed::sides", exec,
             kernels::SideGradients<Memory, shares>{back.slabs, back.lines.groups.entries, chains, sides,
                                                    this->gradients(back.lines, f, g, true), to, edges});
    });
    if constexpr (shares > 1)
      launch("gridmorph::transposed::add_edges", exec, 0, plan.transposed->edges.n,
             kernels::AddShares<shares>{{edges}, 1, edges[0]});
    launch("gridmorph::transposed::sum_edges", exec,
           kernels::EdgeSums<Memory>{chains, sides, stage.corrected, back.first_part, read(edges[0]), g.residuals});
    launch("gridmorph::transposed::fill_sides", exec,
           kernels::SideFillBack<Memory>{chains, sides, stage.side_lines, g.residuals, between});
    sum_in_shares(exec, back, g, [&](kernels::SumShares const& to) {
      launch("gridmorph::transposed::side_edges", exec,
             kernels::SideEdgesBack<Memory, shares>{chains, sides, stage.corrected, read(between), to});
    });
    launch("gridmorph::transposed::fill_edges", exec,
           kernels::EdgeFillBack<Memory>{chains, sides, stage.corrected, g.residuals});
    bool const any = plan.turns.any();
    launch("gridmorph::transposed::residuals", exec,
           kernels::SideResidualBack<Memory>{
               chains, sides, stage.side_lines, g.residuals, plan.law_knots.data(),
               any ? plan.turns.read_ends(f.number, f.number).values : kernels::TurnedEnds<double const>{},
               any ? plan.turns.side_position.read()[0] : Baseline{nullptr, nullptr, nullptr}, this->end_gradients(g)});
    kernels::copy_back<true>("gridmorph::transposed::known_sides", exec, back.gathers, plan.rotations,
                             read(g.residuals), g.skeleton);
  }

  static constexpr int shares = kernels::shares_of_sums<Exec>;

  /// All fields of a workspace.
  static void clear(Exec const& exec, detail::Workspace<Memory> const& of) {
    Index const n = Index(of.values.extent(0)) / 3;
    kernels::launch("gridmorph::transposed::clear_shares", exec, 0, n,
                    kernels::ClearVectors{{of.values.data(), of.values.data() + n, of.values.data() + 2 * n}});
  }
  /// sum(shares) adds to the residuals of g, or to shares of them that are added up after.
  template <class Sum>
  void sum_in_shares(Exec const& exec, detail::TransposedStage<Exec> const& back, StageField<Exec> const& g,
                     Sum const& sum) const {
    if constexpr (shares == 1) {
      sum(kernels::SumShares{{g.residuals}});
    } else {
      auto const& room = this->plan().transposed->sides;
      clear(exec, room);
      kernels::SumShares const parts{room.batch(), back.first_side_node};
      sum(parts);
      kernels::launch("gridmorph::transposed::add_sides", exec, 0, back.n_side_nodes,
                      kernels::AddShares<shares>{parts, 0, g.residuals});
    }
  }

  template <bool Rate>
  void run(Exec const& exec, StageField<Exec> const& f) const {
    auto const& stage = this->plan().stages[number_];
    this->copy("gridmorph::chain_ends", exec, stage.copies, f.skeleton, f.ends);
    detail::BlockTurns<Exec, Rate>(this->plan(), f.number, f.of).of_ends(exec, stage);
    kernels::fill_sides(exec, stage.side_nodes, this->plan().lines.chains, this->sides(f), stage.across, read(f.ends),
                        this->plan().known_sides(f.ends), f.residuals, this->plan().law_knots.data(),
                        this->plan().turns.of_skeleton(f.number, f.of), stage.turns);
    this->template sweep<false>(exec, stage.sweeps, f, stage.turns, stage.side_nodes.n_items > 0);
  }

  std::size_t number_;
};

/// What parts have in common, added to the skeleton: slip surfaces see the whole, the pass through the volume adds it
/// elsewhere.
template <class Exec>
class AddCommon : OnSkeleton<Exec> {
 public:
  static inline std::string const region = "gridmorph::motion in common";

  explicit AddCommon(BlockTables<Exec> tables) : OnSkeleton<Exec>(std::move(tables)) {}

  void enqueue(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    this->each_part([&](auto const& part) { part.add(exec, f); });
  }
  void rate(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& r) const {
    keep_nodes(exec, f);
    this->each_part([&](auto const& part) { part.add_rate(exec, f, r); });
    enqueue(exec, x, f);
  }

  [[nodiscard]] static bool bends() { return true; }
  void keep(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    keep_nodes(exec, f);
    this->each_part([&](auto const& part) { part.keep(exec, f); });
  }
  void enqueue_kept(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    keep(exec, x, f);
    enqueue(exec, x, f);
  }
  void transpose(Exec const& exec, Baseline const&, StageField<Exec> const& f, StageField<Exec> const& g) const {
    this->each_part([&](auto const& part) { part.add_back(exec, f, g, this->plan().common->before.data()); });
  }

 private:
  /// Nodes inside pieces, before.
  void keep_nodes(Exec const& exec, StageField<Exec> const& f) const {
    auto volume = volume_pass(this->plan(), f.baseline, f, false);
    volume.common.leaves_out = true;
    volume.out[volume.n_fields++] = VectorView<typename Exec::memory_space>(this->plan().common->before).array();
    kernels::pass_volume(exec, this->plan().volume_items, volume);
  }
};

/// One SpreadPass of the plan: ends of lines go back onto slip surfaces, and the correction along the lines between.
template <class Exec>
class SlipSpread : OnSkeleton<Exec> {
 public:
  static inline std::string const region = "gridmorph::slip surfaces";

  /// The pass with this number.
  SlipSpread(BlockTables<Exec> tables, std::size_t number) : OnSkeleton<Exec>(std::move(tables)), number_(number) {}

  void enqueue(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    project<false>(exec, f, f);
    this->template sweep<true>(exec, pass().sweeps, f, false, false);
  }

  void rate(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& r) const {
    project<true>(exec, f, r);
    enqueue(exec, x, f);
    this->template sweep<true>(exec, pass().sweeps, r, false, false);
  }

  [[nodiscard]] static bool bends() { return true; }
  void keep(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    kernels::launch("gridmorph::transposed::keep_slip_ends", exec,
                    kernels::KeepSlipEnds<Memory>{pass().ends, read(f.skeleton), back().kept.batch()[0]});
  }
  void enqueue_kept(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    keep(exec, x, f);
    enqueue(exec, x, f);
  }
  void transpose(Exec const& exec, Baseline const&, StageField<Exec> const& f, StageField<Exec> const& g) const {
    this->sum_lines(exec, back().lines, pass().first_value, pass().n_values, f, g, false);
    kernels::SlipEndValues<Memory, false> const values{pass().ends,
                                                       pass().baselines,
                                                       this->plan().surfaces.surfaces,
                                                       this->plan().rotations,
                                                       read(f.skeleton),
                                                       read(f.skeleton),
                                                       g.ends,
                                                       {}};
    kernels::pull_back("gridmorph::transposed::slip_ends", exec, back().ends_of_slot,
                       kernels::SlipEndBySlot<Memory>{values, back().kept.read()[0], read(g.ends)}, g.skeleton);
  }

 private:
  using Memory = typename Exec::memory_space;
  [[nodiscard]] detail::TransposedSpread<Exec> const& back() const { return this->plan().transposed->spreads[number_]; }
  [[nodiscard]] detail::DeviceSpread<Exec> const& pass() const { return this->plan().spreads[number_]; }

  /// End values of `to`, where the displacement is that of `at`; with `Rate`, their derivative.
  template <bool Rate>
  void project(Exec const& exec, StageField<Exec> const& at, StageField<Exec> const& to) const {
    kernels::slip_ends(exec, pass().items,
                       kernels::SlipEndValues<typename Exec::memory_space, Rate>{
                           pass().ends, pass().baselines, this->plan().surfaces.surfaces, this->plan().rotations,
                           read(at.skeleton), read(to.skeleton), to.ends, pass().at_rest});
  }

  std::size_t number_;
};

}  // namespace gridmorph::stages
