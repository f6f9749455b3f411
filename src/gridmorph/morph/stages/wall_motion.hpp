// First stage of an unstructured morph: the moving walls, how they turn, and the columns of cells on them.
#pragma once

#include <gridmorph/kernels/column_motion.hpp>
#include <gridmorph/kernels/listed_nodes.hpp>
#include <gridmorph/kernels/transposed_walls.hpp>
#include <gridmorph/morph/stages/columns_of_walls.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/morph/stages/transposed_tables.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

namespace gridmorph::stages {

template <class Exec>
class WallMotion {
 public:
  static inline std::string const region = "gridmorph::WallMotion";

  /// back: where the transpose is asked for.
  WallMotion(Exec const& exec, UnstructuredPlan const& plan, bool with_rate, std::vector<Vec3> const* back)
      : known_(upload(exec, plan.known, name("known"))),
        slots_(upload(exec, plan.driving_slots, name("driving_slots"))),
        wall_{upload(exec, plan.driving, name("driving")),
              upload(exec, plan.one_rings.first, name("one_rings::first")),
              upload(exec, plan.one_rings.item, name("one_rings::item")),
              upload(exec, plan.turns, name("turns")),
              plan.dimension == 2,
              plan.plane_normal,
              upload(exec, plan.first_line, name("first_line")),
              upload(exec, plan.lines, name("lines"))},
        columns_{upload(exec, plan.columns.node, name("columns::node")),
                 upload(exec, plan.columns.root, name("columns::root")),
                 upload(exec, plan.columns.turn, name("columns::share"))},
        turn_(room_for<Vec3>(exec, plan.driving.size(), name("turn"))),
        turn_rate_(room_for<Vec3>(exec, with_rate ? plan.driving.size() : 0, name("turn_rate"))) {
    if (back == nullptr) return;
    columns_of_ = columns_of_walls(exec, plan);
    turn_gradient_ = room_for<Vec3>(exec, plan.driving.size(), name("turn_gradient"));
    TransposedEntries parts;
    auto const n_around = Index32(plan.one_rings.item.size());
    for (Index32 k = 0; k < n_around; ++k) parts.add(plan.one_rings.item[k], k, 1);
    for (std::size_t r = 0; r < plan.driving.size(); ++r) parts.add(plan.driving[r], n_around + Index32(r), 1);
    turn_parts_ = room_for<Vec3>(exec, std::size_t(n_around) + plan.driving.size(), name("turn_parts"));
    parts_of_node_ = upload(exec, parts, {}, name("parts_of_node")).rows;
  }

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    set(exec, f);
    follow<Vec3>(exec, {x}, {x, f.u.data()}, turn_, x, f);
  }

  /// Rotations are not linear: their exact derivative.
  void rate(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& r) const {
    enqueue(exec, x, f);
    set(exec, r);
    follow<kernels::DualVec3>(exec, {x}, {x, f.u.data(), r.u.data()}, turn_rate_, x, r);
  }

  [[nodiscard]] static bool bends() { return true; }
  void keep(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    set(exec, f);
    turn<Vec3>(exec, {x}, {x, f.u.data()}, turn_);
  }
  /// The last one: g.boundary is written.
  void transpose(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& g) const {
    using kernels::launch;
    launch("gridmorph::transposed::wall_motion", exec,
           kernels::WallBack<Memory>{columns_, columns_of_, wall_.node, turn_.data(), x, g.frames.data(), g.u.data(),
                                     turn_gradient_.data()});
    set(exec, f);  // where the walls were when they turned
    launch("gridmorph::transposed::wall_turn", exec,
           kernels::WallTurnBack<Memory>{wall_, x, f.u.data(), turn_gradient_.data(), turn_parts_.data()});
    kernels::gather_rows("gridmorph::transposed::wall_turn::nodes", exec, parts_of_node_, turn_parts_.data(),
                         g.u.data());
    launch("gridmorph::transposed::moving_walls", exec,
           kernels::AddToSlots<Memory>{slots_, known_, g.u.data(), g.given.data()});
    launch("gridmorph::transposed::slots", exec, 0, Index(g.given.extent(0)),
           kernels::WriteSlots{g.given.data(), g.boundary});
  }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }

  void set(Exec const& exec, StageField<Exec> const& f) const {
    using kernels::launch;
    launch("gridmorph::rest", exec, 0, Index(f.u.extent(0)), kernels::RestNodes{f.u.data()});
    launch("gridmorph::moving_walls", exec, kernels::SetFromSlots<Memory>{slots_, known_, f.boundary, f.u.data()});
  }

  template <class V>
  void turn(Exec const& exec, kernels::Positions<V> const& baseline, kernels::Positions<V> const& moved,
            List<Exec, Vec3> const& to) const {
    kernels::launch("gridmorph::wall_turn", exec, kernels::WallTurn<Memory, V>{wall_, baseline, moved, to.data()});
  }
  template <class V>
  void follow(Exec const& exec, kernels::Positions<V> const& baseline, kernels::Positions<V> const& moved,
              List<Exec, Vec3> const& turn, Baseline const& x, StageField<Exec> const& f) const {
    using kernels::launch;
    Vec3 const *const turns = turn_.data(), *const rates = turn_rate_.data();
    this->turn(exec, baseline, moved, turn);
    launch("gridmorph::wall_frames", exec,
           kernels::WallFrames<Memory, V>{wall_, turns, rates, f.u.data(), f.frames.data()});
    launch("gridmorph::columns", exec,
           kernels::MoveColumns<Memory, V>{columns_, wall_.node, turns, rates, x, f.u.data()});
  }

  List<Exec, Index32> known_, slots_;
  kernels::WallTable<Memory> wall_;
  kernels::ColumnTable<Memory> columns_;
  List<Exec, Vec3> turn_, turn_rate_, turn_gradient_;
  kernels::ColumnsOf<Memory> columns_of_;
  List<Exec, Vec3> turn_parts_;  ///< kernels::WallTurnBack
  kernels::TransposedRows<Memory> parts_of_node_;
};

}  // namespace gridmorph::stages
