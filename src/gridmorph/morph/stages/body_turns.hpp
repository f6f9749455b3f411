// Bodies that turn, in an unstructured morph: after the walls the turn of each as a whole is taken off what they and their columns do, so that
// all stages up to the far field carry what is left (shifts, bending); then every node gets its share of the turns.
#pragma once

#include <gridmorph/kernels/body_turn.hpp>
#include <gridmorph/kernels/listed_nodes.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <memory>

namespace gridmorph::stages {

/// Tables and workspace that both stages share.
template <class Exec>
struct BodyTurnTables {
  using Memory = typename Exec::memory_space;

  List<Exec, Index32> known, slots, driving, body_of_driving, rigid;
  kernels::BodyWalls<Memory> walls;
  List<Exec, double> share;
  List<Exec, Vec3> centre;
  List<Exec, kernels::VectorMoments> sum, sum_rate;
  List<Exec, kernels::Quaternion<Vec3>> half, half_rate;

  BodyTurnTables(Exec const& exec, UnstructuredPlan const& plan, bool with_rate)
      : known(upload(exec, plan.known, name("known"))),
        slots(upload(exec, plan.turns_of_bodies.slot, name("slots"))),
        driving(upload(exec, plan.driving, name("driving"))),
        body_of_driving(upload(exec, plan.turns_of_bodies.body_of_driving, name("body"))),
        rigid(upload(exec, plan.turns_of_bodies.rigid, name("rigid"))),
        walls{upload(exec, plan.turns_of_bodies.wall, name("wall")),
              upload(exec, plan.turns_of_bodies.weight, name("weight")),
              upload(exec, plan.turns_of_bodies.first, name("first")),
              upload(exec, plan.turns_of_bodies.first_chunk, name("first_chunk")),
              upload(exec, plan.turns_of_bodies.axis, name("axis"))},
        share(upload(exec, plan.turns_of_bodies.share, name("share"))),
        centre(upload(exec, plan.turns_of_bodies.centre, name("centre"))),
        sum(room_for<kernels::VectorMoments>(exec, walls.first.extent(0) - 1, name("sum"))),
        sum_rate(room_for<kernels::VectorMoments>(exec, with_rate ? sum.extent(0) : 0, name("sum_rate"))),
        half(room_for<kernels::Quaternion<Vec3>>(exec, centre.extent(0), name("half"))),
        half_rate(room_for<kernels::Quaternion<Vec3>>(exec, with_rate ? centre.extent(0) : 0, name("half_rate"))) {}

  template <class V>
  [[nodiscard]] kernels::BodyTurnField<Memory, V> field(Baseline const& x) const {
    return {share, centre, half.data(), half_rate.data(), x};
  }

 private:
  static std::string name(char const* what) { return std::string("gridmorph::BodyTurns::") + what; }
};

template <class Exec>
using SharedBodyTurns = std::shared_ptr<BodyTurnTables<Exec> const>;

/// The turns of the bodies, taken off.
template <class Exec>
class TakeTurns {
 public:
  static inline std::string const region = "gridmorph::TakeTurns";

  explicit TakeTurns(SharedBodyTurns<Exec> tables) : tables_(std::move(tables)) {}

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    sum(exec, f, tables_->sum);
    turn<Vec3>(exec, tables_->half);
    take<Vec3>(exec, x, f);
  }

  /// Rotations are not linear: their exact derivative.
  void rate(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& r) const {
    enqueue(exec, x, f);
    sum(exec, r, tables_->sum_rate);
    turn<kernels::DualVec3>(exec, tables_->half_rate);
    take<kernels::DualVec3>(exec, x, r);
  }

 private:
  using Memory = typename Exec::memory_space;

  void sum(Exec const& exec, StageField<Exec> const& f, List<Exec, kernels::VectorMoments> const& to) const {
    kernels::launch("gridmorph::bodies::sum", exec,
                    kernels::SumBodyWalls<Memory>{tables_->walls, f.frames.data(), to.data()});
  }
  template <class V>
  void turn(Exec const& exec, List<Exec, kernels::Quaternion<Vec3>> const& to) const {
    kernels::launch(
        "gridmorph::bodies::turn", exec,
        kernels::TurnBodies<Memory, V>{tables_->walls, tables_->sum.data(), tables_->sum_rate.data(), to.data()});
  }
  template <class V>
  void take(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    auto const field = tables_->template field<V>(x);
    kernels::launch("gridmorph::bodies::take", exec,
                    kernels::TakeBodyTurns<Memory, V>{field, tables_->rigid, f.u.data()});
    kernels::launch("gridmorph::bodies::frames", exec,
                    kernels::TakeTurnsFromFrames<Memory, V>{field, tables_->driving, tables_->body_of_driving,
                                                            f.u.data(), f.frames.data()});
  }

  SharedBodyTurns<Exec> tables_;
};

/// The turns of the bodies, added to every node; walls are where they were asked to be, to the last bit.
template <class Exec>
class AddTurns {
 public:
  static inline std::string const region = "gridmorph::AddTurns";

  explicit AddTurns(SharedBodyTurns<Exec> tables) : tables_(std::move(tables)) {}

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const { add<Vec3>(exec, x, f); }
  /// Of the turns that TakeTurns found.
  void rate(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& r) const {
    add<Vec3>(exec, x, f);
    add<kernels::DualVec3>(exec, x, r);
  }

 private:
  using Memory = typename Exec::memory_space;

  template <class V>
  void add(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    using kernels::launch;
    launch("gridmorph::bodies::add", exec, 0, Index(f.u.extent(0)),
           kernels::AddBodyTurns<Memory, V>{tables_->template field<V>(x), f.u.data()});
    launch("gridmorph::bodies::walls", exec,
           kernels::SetFromSlots<Memory>{tables_->slots, tables_->known, f.boundary, f.u.data()});
  }

  SharedBodyTurns<Exec> tables_;
};

}  // namespace gridmorph::stages
