// The rotations of a plan of blocks through one morph: of the walls' nodes first, then stage by stage of the ends of
// chains.
#pragma once

#include <gridmorph/morph/device_plan.hpp>

#include <type_traits>

namespace gridmorph::detail {

/// Of displacement field `f`; with `Rate` f holds the rates of field `of`, of which everything has been done before.
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

}  // namespace gridmorph::detail
