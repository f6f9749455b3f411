// Bodies that turn, stretch and shift, in an unstructured morph: after the walls what each does as a whole is taken off
// what they and their columns do, so that all stages up to the far field carry what is left (bending, say); then every
// node gets its share of that.
#pragma once

#include <gridmorph/kernels/body_turn.hpp>
#include <gridmorph/kernels/listed_nodes.hpp>
#include <gridmorph/kernels/transposed_walls.hpp>
#include <gridmorph/morph/stages/columns_of_walls.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/morph/stages/transposed_tables.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <memory>
#include <utility>

namespace gridmorph::stages {

/// Tables and workspace that both stages share.
template <class Exec>
struct BodyTurnTables {
  using Memory = typename Exec::memory_space;

  List<Exec, Index32> known, driving, body_of_driving, rigid;
  kernels::BodyWalls<Memory> walls;
  List<Exec, double> share, shift_share;
  List<Exec, kernels::BodyImage> images;
  List<Exec, Vec3> centre;
  List<Exec, kernels::VectorMoments> sum, sum_rate;
  List<Exec, kernels::Quaternion<Vec3>> half, half_rate;
  List<Exec, Vec3> shift_sum, shift, shift_rate;
  List<Exec, kernels::StretchMap> stretch_sum, stretch_sum_rate, stretch, stretch_rate;  ///< empty: none stretches
  kernels::StretchedColumns<Memory> columns;
  // Of transposes.
  List<Exec, kernels::BodyGradient> parts, gradient;
  List<Exec, kernels::VectorMoments> moments;
  List<Exec, Vec3> listed;
  kernels::TransposedRows<Memory> of_slots;

  BodyTurnTables(Exec const& exec, UnstructuredPlan const& plan, bool with_rate, bool back)
      : known(upload(exec, plan.known, name("known"))),
        driving(upload(exec, plan.driving, name("driving"))),
        body_of_driving(upload(exec, plan.turns_of_bodies.body_of_driving, name("body"))),
        rigid(upload(exec, plan.turns_of_bodies.rigid, name("rigid"))),
        walls{upload(exec, plan.turns_of_bodies.wall, name("wall")),
              upload(exec, plan.turns_of_bodies.slot, name("slot")),
              upload(exec, plan.turns_of_bodies.weight, name("weight")),
              upload(exec, plan.turns_of_bodies.first, name("first")),
              upload(exec, plan.turns_of_bodies.first_chunk, name("first_chunk")),
              upload(exec, plan.turns_of_bodies.axis, name("axis")),
              plan.turns_of_bodies.first_chunk[plan.turns_of_bodies.size()],
              upload(exec, plan.turns_of_bodies.lever, name("lever")),
              upload(exec, plan.turns_of_bodies.limits, name("limits"))},
        share(upload(exec, plan.turns_of_bodies.share, name("share"))),
        shift_share(upload(exec, plan.turns_of_bodies.shift_share, name("shift_share"))),
        images(upload(exec, plan.turns_of_bodies.images, name("images"))),
        centre(upload(exec, plan.turns_of_bodies.centre, name("centre"))),
        sum(room_for<kernels::VectorMoments>(exec, walls.n_wall_chunks, name("sum"))),
        sum_rate(room_for<kernels::VectorMoments>(exec, with_rate ? sum.extent(0) : 0, name("sum_rate"))),
        half(room_for<kernels::Quaternion<Vec3>>(exec, centre.extent(0), name("half"))),
        half_rate(room_for<kernels::Quaternion<Vec3>>(exec, with_rate ? centre.extent(0) : 0, name("half_rate"))),
        shift_sum(room_for<Vec3>(exec, walls.first.extent(0) - 1, name("shift_sum"))),
        shift(room_for<Vec3>(exec, centre.extent(0), name("shift"))),
        shift_rate(room_for<Vec3>(exec, with_rate ? centre.extent(0) : 0, name("shift_rate"))) {
    if (stretches()) {
      stretch_sum = room_for<kernels::StretchMap>(exec, walls.n_wall_chunks, name("stretch_sum"));
      stretch = room_for<kernels::StretchMap>(exec, centre.extent(0), name("stretch"));
      if (!plan.turns_of_bodies.limits.front().even)
        columns = {columns_of_walls(exec, plan), upload(exec, plan.columns.node, name("columns")),
                   upload(exec, plan.turns_of_bodies.column_arm, name("column_arm")), walls.limits};
      if (with_rate) {
        stretch_sum_rate = room_for<kernels::StretchMap>(exec, stretch_sum.extent(0), name("stretch_sum_rate"));
        stretch_rate = room_for<kernels::StretchMap>(exec, centre.extent(0), name("stretch_rate"));
      }
    }
    if (!back) return;
    std::size_t const n_bodies = centre.extent(0);
    parts = room_for<kernels::BodyGradient>(exec, n_bodies * std::size_t(kernels::body_chunks(plan.n_nodes)),
                                            name("parts"));
    gradient = room_for<kernels::BodyGradient>(exec, n_bodies, name("gradient"));
    moments = room_for<kernels::VectorMoments>(exec, n_bodies, name("moments"));
    listed = room_for<Vec3>(exec, plan.turns_of_bodies.slot.size(), name("listed"));
    of_slots = transposed(exec, plan.turns_of_bodies.slot, nullptr, name("of_slots"));
  }

  [[nodiscard]] bool stretches() const { return walls.lever.extent(0) > 0; }

  /// gradient += what chunks of nodes or frames have left in `parts`.
  void sum_parts(Exec const& exec, Index n_chunks) const {
    Index const n_bodies = Index(centre.extent(0));
    kernels::launch("gridmorph::transposed::bodies::sum", exec, 0, n_bodies,
                    kernels::BodySums{parts.data(), n_chunks, n_bodies, gradient.data()});
  }
  /// Sums gradients of what bodies give to the nodes of a list, or to all n of them.
  void sum_nodes(Exec const& exec, Baseline const& x, List<Exec, Index32> const& nodes, Index n, double sign,
                 StageField<Exec> const& g) const {
    kernels::BodyPartsOfNodes<Memory> const kernel{field<Vec3>(x), nodes, n, sign, g.u.data(), parts.data()};
    kernels::launch("gridmorph::transposed::bodies::nodes", exec, kernel);
    sum_parts(exec, kernel.size());
  }

  template <class V>
  [[nodiscard]] kernels::BodyTurnField<Memory, V> field(Baseline const& x) const {
    return {share,        shift_share,       images, centre,         half.data(),        half_rate.data(),
            shift.data(), shift_rate.data(), x,      stretch.data(), stretch_rate.data()};
  }
  [[nodiscard]] List<Exec, Index32 const> wall_slots() const {
    return Kokkos::subview(walls.slot, std::pair<std::size_t, std::size_t>(0, walls.wall.extent(0)));
  }

 private:
  static std::string name(char const* what) { return std::string("gridmorph::BodyTurns::") + what; }
};

template <class Exec>
using SharedBodyTurns = std::shared_ptr<BodyTurnTables<Exec> const>;

/// What bodies do as wholes, taken off.
template <class Exec>
class TakeTurns {
 public:
  static inline std::string const region = "gridmorph::TakeTurns";

  explicit TakeTurns(SharedBodyTurns<Exec> tables) : tables_(std::move(tables)) {}

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    keep(exec, x, f);
    shift(exec, f, tables_->shift);
    take<Vec3>(exec, x, f);
  }

  /// Rotations are not linear: their exact derivative.
  void rate(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& r) const {
    enqueue(exec, x, f);
    sum(exec, r, tables_->sum_rate);
    turn<kernels::DualVec3>(exec, tables_->half_rate);
    stretch<kernels::DualVec3>(exec, r, tables_->stretch_sum_rate, tables_->stretch_rate);
    shift(exec, r, tables_->shift_rate);
    take<kernels::DualVec3>(exec, x, r);
  }

  [[nodiscard]] static bool bends() { return true; }
  void keep(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    sum(exec, f, tables_->sum);
    turn<Vec3>(exec, tables_->half);
    stretch<Vec3>(exec, f, tables_->stretch_sum, tables_->stretch);
  }
  /// Adds to what the transpose of AddTurns has left.
  void transpose(Exec const& exec, Baseline const& x, StageField<Exec> const&, StageField<Exec> const& g) const {
    using kernels::launch;
    auto const& t = *tables_;
    kernels::BodyPartsOfFrames<Memory> const frames{t.template field<Vec3>(x),
                                                    Index(t.centre.extent(0)),
                                                    t.driving,
                                                    t.body_of_driving,
                                                    t.columns,
                                                    g.u.data(),
                                                    g.frames.data(),
                                                    t.parts.data()};
    launch("gridmorph::transposed::bodies::frames", exec, frames);
    t.sum_parts(exec, frames.size());
    if (t.rigid.extent(0) > 0) t.sum_nodes(exec, x, t.rigid, Index(t.rigid.extent(0)), -1, g);
    if (t.stretches())
      launch("gridmorph::transposed::bodies::stretch", exec,
             kernels::StretchBodiesBack<Memory>{t.walls, t.half.data(), t.stretch_sum.data(), t.gradient.data()});
    launch("gridmorph::transposed::bodies::turn", exec,
           kernels::TurnBodiesBack<Memory>{t.walls, t.sum.data(), t.gradient.data(), t.moments.data()});
    launch(
        "gridmorph::transposed::bodies::walls", exec,
        kernels::BodyWallsBack<Memory>{t.walls, t.moments.data(), t.gradient.data(), g.frames.data(), t.listed.data()});
    kernels::gather_rows("gridmorph::transposed::bodies::slots", exec, t.of_slots, t.listed.data(), g.given.data());
  }

 private:
  using Memory = typename Exec::memory_space;

  void sum(Exec const& exec, StageField<Exec> const& f, List<Exec, kernels::VectorMoments> const& to) const {
    kernels::launch(
        "gridmorph::bodies::sum", exec,
        kernels::SumBodyWalls<Memory, kernels::FrameGradients>{tables_->walls, {f.frames.data()}, to.data()});
  }
  template <class V>
  void turn(Exec const& exec, List<Exec, kernels::Quaternion<Vec3>> const& to) const {
    kernels::launch(
        "gridmorph::bodies::turn", exec,
        kernels::TurnBodies<Memory, V>{tables_->walls, tables_->sum.data(), tables_->sum_rate.data(), to.data()});
  }
  template <class V>
  void stretch(Exec const& exec, StageField<Exec> const& f, List<Exec, kernels::StretchMap> const& moments,
               List<Exec, kernels::StretchMap> const& to) const {
    auto const& t = *tables_;
    if (!t.stretches()) return;
    kernels::launch("gridmorph::bodies::sum_stretches", exec,
                    kernels::SumBodyStretches<Memory>{t.walls.slot, t.walls.lever, t.walls.first, t.walls.n_wall_chunks,
                                                      f.boundary, moments.data()});
    kernels::launch("gridmorph::bodies::stretch", exec,
                    kernels::StretchBodies<Memory, V>{t.walls, t.half.data(), t.half_rate.data(), t.stretch_sum.data(),
                                                      t.stretch_sum_rate.data(), to.data()});
  }
  /// Linear: rates as well.
  void shift(Exec const& exec, StageField<Exec> const& f, List<Exec, Vec3> const& to) const {
    kernels::launch("gridmorph::bodies::sum_shifts", exec,
                    kernels::SumBodyShifts<Memory>{tables_->walls, f.boundary, tables_->shift_sum.data()});
    kernels::launch("gridmorph::bodies::shift", exec,
                    kernels::ShiftBodies<Memory>{tables_->walls, tables_->shift_sum.data(), to.data()});
  }
  template <class V>
  void take(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    auto const field = tables_->template field<V>(x);
    kernels::launch("gridmorph::bodies::take", exec,
                    kernels::TakeBodyTurns<Memory, V>{field, tables_->rigid, f.u.data()});
    kernels::launch("gridmorph::bodies::frames", exec,
                    kernels::TakeTurnsFromFrames<Memory, V>{field, tables_->driving, tables_->body_of_driving,
                                                            tables_->columns, f.u.data(), f.frames.data()});
  }

  SharedBodyTurns<Exec> tables_;
};

/// What bodies do as wholes, added to every node by its shares; walls are where they were asked to be, to the last bit.
template <class Exec>
class AddTurns {
 public:
  static inline std::string const region = "gridmorph::AddTurns";

  explicit AddTurns(SharedBodyTurns<Exec> tables) : tables_(std::move(tables)) {}

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const { add<Vec3>(exec, x, f); }
  /// The rate of what TakeTurns found.
  void rate(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& r) const {
    add<Vec3>(exec, x, f);
    add<kernels::DualVec3>(exec, x, r);
  }

  void transpose(Exec const& exec, Baseline const& x, StageField<Exec> const&, StageField<Exec> const& g) const {
    auto const& t = *tables_;
    kernels::launch("gridmorph::transposed::bodies::slots_of_walls", exec,
                    kernels::AddToSlots<Memory>{t.wall_slots(), t.known, g.u.data(), g.given.data()});
    clear<kernels::BodyGradient>(exec, t.gradient);
    t.sum_nodes(exec, x, {}, Index(g.u.extent(0)), 1, g);
  }

 private:
  using Memory = typename Exec::memory_space;

  template <class V>
  void add(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    using kernels::launch;
    launch("gridmorph::bodies::add", exec, 0, Index(f.u.extent(0)),
           kernels::AddBodyTurns<Memory, V>{tables_->template field<V>(x), f.u.data()});
    launch("gridmorph::bodies::walls", exec,
           kernels::SetFromSlots<Memory>{tables_->wall_slots(), tables_->known, f.boundary, f.u.data()});
  }

  SharedBodyTurns<Exec> tables_;
};

}  // namespace gridmorph::stages
