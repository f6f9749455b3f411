// The rotations of a plan of blocks through one morph: of the walls' nodes first, then stage by stage of the ends of
// chains; and in reverse.
#pragma once

#include <gridmorph/kernels/transposed_copies.hpp>
#include <gridmorph/kernels/transposed_turns.hpp>
#include <gridmorph/morph/detail/transposed_plan.hpp>
#include <gridmorph/morph/device_plan.hpp>

#include <type_traits>

namespace gridmorph::detail {

/// The turns of displacement field `f`; with `Rate` f holds the rates of field `of`, of which everything has been done
/// before.
template <class Exec, bool Rate>
class BlockTurns {
 public:
  using Memory = typename Exec::memory_space;
  using V = std::conditional_t<Rate, kernels::DualVec3, Vec3>;

  BlockTurns(DevicePlan<Exec> const& plan, int f, int of) : plan_(plan), turns_(plan.turns), f_(f), of_(of) {}

  /// From the displacement of the walls, which is on the skeleton.
  void of_walls(Exec const& exec) const {
    if (!turns_.any()) return;
    kernels::launch("gridmorph::turns::clear", exec, 0, turns_.slots.n,
                    kernels::ClearVectors{turns_.slots.batch()[f_]});
    kernels::launch("gridmorph::turns::walls", exec,
                    kernels::FreeRootTurn<Memory, V>{turns_.table, both(plan_.skeleton), turns_.free.batch()[f_]});
    if constexpr (!Rate) mean_of_bodies(exec);
    kernels::launch("gridmorph::turns::ways", exec,
                    kernels::RawRootTurn<Memory, V>{turns_.table, both(plan_.skeleton), both(turns_.free),
                                                    turns_.mean.read()[of_], turns_.raw.batch()[f_]});
    kernels::launch("gridmorph::turns::end_walls", exec,
                    kernels::EndWallTurn<Memory, V>{turns_.table, both(plan_.skeleton), both(turns_.raw),
                                                    turns_.at_end.batch()[f_]});
    kernels::launch(
        "gridmorph::turns::near_field", exec,
        kernels::NearFieldTurn<Memory, V>{
            turns_.table, both(turns_.raw), {both(turns_.at_end)}, turns_.slots.batch()[f_], turns_.outer.batch()[f_]});
  }

  /// From the slots to the ends of a stage's chains.
  void of_ends(Exec const& exec, DeviceStage<Exec> const& stage) const {
    if (!stage.turns) return;
    kernels::Field<double const> const position = turns_.end_position.read()[0];
    bool const all_near_field = 2 * Index(stage.near_field.extent(0)) == stage.n_end_values;
    if (!all_near_field) {
      kernels::copy_nodes(exec, "gridmorph::turns::ends", stage.ends, plan_.rotations, turns_.slots.read()[f_],
                          turns_.end_turns.batch()[f_]);
      kernels::launch("gridmorph::turns::ends_of_lines", exec, stage.first_end_value,
                      stage.first_end_value + stage.n_end_values,
                      kernels::TurnEnds<V>{both(turns_.end_turns), position, turns_.end_pivot.read()[0],
                                           turns_.ends_of(f_), plan_.ends.batch()[f_]});
    }
    kernels::launch("gridmorph::turns::near_field_lines", exec,
                    kernels::TurnNearField<Memory, V>{stage.near_field, turns_.table, both(turns_.slots),
                                                      both(turns_.raw), both(turns_.outer), position,
                                                      turns_.end_turns.batch()[f_], turns_.ends_of(f_)});
  }

 private:
  /// What it decides does not change with its rate.
  void mean_of_bodies(Exec const& exec) const {
    kernels::launch("gridmorph::turns::bodies", exec,
                    kernels::SumBodyWalls<Memory, kernels::TurnGradients>{
                        turns_.bodies, {turns_.free.read()[f_]}, turns_.body_sums.data()});
    kernels::launch("gridmorph::turns::means", exec,
                    kernels::MeanTurns<Memory>{turns_.bodies, turns_.body_sums.data(), turns_.mean.batch()[f_]});
  }
  [[nodiscard]] kernels::VectorsWithRates<V> both(Workspace<Memory> const& work) const {
    return {work.read()[of_], work.read()[f_]};
  }

  DevicePlan<Exec> const& plan_;
  DeviceTurns<Exec> const& turns_;
  int f_, of_;
};

/// Field g holds the gradients of field f, which has gone through BlockTurns.
template <class Exec>
class BlockTurnGradients {
 public:
  using Memory = typename Exec::memory_space;

  BlockTurnGradients(DevicePlan<Exec> const& plan, int f, int g) : plan_(plan), turns_(plan.turns), f_(f), g_(g) {}

  /// Before all stages.
  void clear(Exec const& exec) const {
    if (!turns_.any()) return;
    for (Workspace<Memory> const* work : {&turns_.slots, &turns_.raw, &turns_.outer, &turns_.at_end})
      kernels::launch("gridmorph::transposed::clear_turns", exec, 0, work->n, kernels::ClearVectors{work->batch()[g_]});
  }
  /// Before the lines of a stage.
  void clear_ends(Exec const& exec, DeviceStage<Exec> const& stage) const {
    if (turns_.any())
      kernels::launch("gridmorph::transposed::clear_turned_ends", exec, stage.first_end_value,
                      stage.first_end_value + stage.n_end_values, cleared());
  }

  /// From the ends of a stage's chains to the slots; u: gradients of the ends' displacements.
  void of_ends(Exec const& exec, DeviceStage<Exec> const& stage, TransposedStage<Exec> const& back,
               kernels::Field<double> const& u) const {
    if (!stage.turns) return;
    kernels::TurnNearField<Memory, Vec3> const lines{stage.near_field,
                                                     turns_.table,
                                                     values(turns_.slots),
                                                     values(turns_.raw),
                                                     values(turns_.outer),
                                                     turns_.end_position.read()[0],
                                                     none(),
                                                     {}};
    kernels::launch("gridmorph::transposed::near_field_lines", exec,
                    kernels::NearFieldLinesBack<Memory>{back.lines_of_root, lines, turns_.end_turns.read()[g_],
                                                        turned(), turns_.slots.batch()[g_], turns_.raw.batch()[g_],
                                                        turns_.outer.batch()[g_]});
    if (2 * Index(stage.near_field.extent(0)) == stage.n_end_values) return;
    kernels::launch("gridmorph::transposed::near_field_done", exec,
                    kernels::ClearLineGradients<Memory>{stage.near_field, cleared()});
    kernels::launch("gridmorph::transposed::ends_of_lines", exec, stage.first_end_value,
                    stage.first_end_value + stage.n_end_values,
                    kernels::TurnEndsBack{turns_.end_turns.read()[f_],
                                          turns_.end_position.read()[0],
                                          turns_.end_pivot.read()[0],
                                          {u.x, u.y, u.z, u.stride},
                                          turned(),
                                          turns_.end_turns.batch()[g_]});
    kernels::copy_back<true>("gridmorph::transposed::turns_of_ends", exec, back.ends, plan_.rotations,
                             turns_.end_turns.read()[g_], turns_.slots.batch()[g_]);
  }

  /// From the slots of walls to the displacements that turn them.
  void of_walls(Exec const& exec) const {
    if (!turns_.any()) return;
    using kernels::DualVec3;
    using kernels::pull_back;
    auto const& back = plan_.transposed->turns;
    auto const& table = turns_.table;
    auto const raw = turns_.raw.read()[f_], at_end = turns_.at_end.read()[f_], u = plan_.skeleton.read()[f_];
    auto const raw_gradient = turns_.raw.batch()[g_], slots = plan_.skeleton.batch()[g_];
    auto const& parts = plan_.transposed->turn_parts;
    kernels::launch(
        "gridmorph::transposed::near_field", exec,
        kernels::NearFieldTurnBack<Memory>{
            table, raw, {at_end}, turns_.slots.read()[g_], turns_.outer.read()[g_], raw_gradient, parts.batch()[0]});
    kernels::copy_back<true>("gridmorph::transposed::near_field_ends", exec, back.parts_of_end, plan_.rotations,
                             parts.read()[0], turns_.at_end.batch()[g_]);
    kernels::EndWallTurn<Memory, DualVec3> const end_walls{table, {}, {}, none()};
    auto const of_ends = turns_.at_end.read()[g_];
    pull_back("gridmorph::transposed::end_walls", exec, back.end_walls_of_slot,
              kernels::EndWallTurnBy<Memory, false>{end_walls, u, raw, of_ends}, slots);
    pull_back("gridmorph::transposed::end_wall_turns", exec, back.end_walls_of_root,
              kernels::EndWallTurnBy<Memory, true>{end_walls, u, raw, of_ends}, raw_gradient);
    kernels::launch(
        "gridmorph::transposed::walls", exec,
        kernels::RawRootTurnBack<Memory>{table, u, turns_.raw.read()[g_], turns_.mean.read()[f_], parts.batch()[0]});
    kernels::copy_back<true>("gridmorph::transposed::wall_slots", exec, back.parts_of_slot, plan_.rotations,
                             parts.read()[0], slots);
  }

 private:
  static kernels::Field<double> none() { return {nullptr, nullptr, nullptr}; }
  [[nodiscard]] kernels::TurnedEndGradients turned() const { return {turns_.ends_of(g_)}; }
  [[nodiscard]] kernels::ClearEndGradients cleared() const { return {turns_.end_turns.batch()[g_], turned()}; }

  [[nodiscard]] kernels::VectorsWithRates<Vec3> values(Workspace<Memory> const& work) const {
    return {work.read()[f_], {nullptr, nullptr, nullptr}};
  }

  DevicePlan<Exec> const& plan_;
  DeviceTurns<Exec> const& turns_;
  int f_, g_;
};

}  // namespace gridmorph::detail
