// What the sides of a passage do, in an unstructured morph: after the walls it is taken off what they and their columns
// do, so that what carries walls has the rest; then every node gets it.
#pragma once

#include <gridmorph/kernels/listed_nodes.hpp>
#include <gridmorph/kernels/passage_motion.hpp>
#include <gridmorph/kernels/transposed_nodes.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/morph/stages/transposed_tables.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::stages {

/// Tables and workspace that both stages share.
template <class Exec>
struct PassageTables {
  using Memory = typename Exec::memory_space;

  kernels::RowFrame frame;
  List<Exec, Index32> slots, sides, known, driving_slots;
  kernels::InterpolationTable<Memory> nodes, rigid;
  kernels::PassageSlopes<Memory> slopes;
  List<Exec, Vec3> c;
  // Of transposes.
  kernels::TransposedRows<Memory> of_nodes, of_rigid, of_places;
  List<Exec, Vec3> of_rows;

  /// back: whether transposes are asked for.
  PassageTables(Exec const& exec, UnstructuredPlan const& plan, bool back)
      : frame(plan.passage.frame),
        slots(upload(exec, plan.passage.slots, name("slots"))),
        known(upload(exec, plan.known, name("known"))),
        driving_slots(upload(exec, plan.driving_slots, name("driving_slots"))),
        nodes(upload(exec, plan.passage.nodes, name("nodes"))),
        rigid(upload(exec, plan.passage.rigid, name("rigid"))),
        slopes{frame, upload(exec, plan.driving, name("driving")), upload(exec, plan.passage.places, name("places")),
               upload(exec, plan.passage.step, name("step"))},
        c(room_for<Vec3>(exec, plan.passage.slots.size(), name("c"))) {
    std::vector<Index32> at;
    for (Index32 const s : plan.passage.slots) at.push_back(plan.known[s]);
    sides = upload(exec, at, name("sides"));
    if (back) {
      auto const by_row = [&](InterpolationOperator const& rows, char const* what) {
        TransposedEntries entries;
        entries.add_by_row(rows);
        return upload(exec, entries, {}, name(what)).rows;
      };
      of_nodes = by_row(plan.passage.nodes, "of_nodes");
      of_rigid = by_row(plan.passage.rigid, "of_rigid");
      of_places = by_row(plan.passage.places, "of_places");
      of_rows = room_for<Vec3>(exec, std::size_t(std::max(nodes.size(), slopes.places.size())), name("of_rows"));
    }
    compat::fence(exec, "gridmorph::PassageMotion (host tables may go)");
  }

  /// u += sign C at the targets of rows.
  void add(Exec const& exec, Baseline const& x, StageField<Exec> const& f,
           kernels::InterpolationTable<Memory> const& rows, double sign) const {
    kernels::launch("gridmorph::passage::sides", exec,
                    kernels::SideComponents<Memory>{frame, slots, sides, x, f.boundary, c.data()});
    kernels::launch("gridmorph::passage::nodes", exec,
                    kernels::AddPassageMotion<Memory>{frame, rows, sign, c.data(), x, f.u.data()});
  }
  /// The transpose: c += what the sides gather of it.
  void add_back(Exec const& exec, Baseline const& x, StageField<Exec> const& g,
                kernels::InterpolationTable<Memory> const& rows, kernels::TransposedRows<Memory> const& of,
                double sign) const {
    kernels::launch("gridmorph::transposed::passage::nodes", exec,
                    kernels::PassageComponentsBack<Memory>{frame, rows, sign, x, g.u.data(), of_rows.data()});
    gather(exec, of);
  }
  void gather(Exec const& exec, kernels::TransposedRows<Memory> const& of) const {
    kernels::gather_rows("gridmorph::transposed::passage::sides", exec, of, static_cast<Vec3 const*>(of_rows.data()),
                         c.data());
  }

 private:
  static std::string name(char const* what) { return std::string("gridmorph::PassageMotion::") + what; }
};

template <class Exec>
using SharedPassage = std::shared_ptr<PassageTables<Exec> const>;

/// What the passage does as one, taken off. Linear.
template <class Exec>
class TakePassage {
 public:
  static inline std::string const region = "gridmorph::TakePassage";

  explicit TakePassage(SharedPassage<Exec> tables) : tables_(std::move(tables)) {}

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    auto const& t = *tables_;
    t.add(exec, x, f, t.rigid, -1);
    kernels::launch("gridmorph::passage::frames", exec,
                    kernels::TakePassageFromFrames<Memory>{t.slopes, t.c.data(), x, f.frames.data()});
  }
  /// The last to hand anything to the sides.
  void transpose(Exec const& exec, Baseline const& x, StageField<Exec> const&, StageField<Exec> const& g) const {
    auto const& t = *tables_;
    kernels::launch("gridmorph::transposed::passage::frames", exec,
                    kernels::TakePassageFromFramesBack<Memory>{t.slopes, x, g.frames.data(), t.of_rows.data()});
    t.gather(exec, t.of_places);
    t.add_back(exec, x, g, t.rigid, t.of_rigid, -1);
    kernels::launch("gridmorph::transposed::passage::slots", exec,
                    kernels::SideComponentsBack<Memory>{t.frame, t.slots, t.sides, x, t.c.data(), g.given.data()});
  }

 private:
  using Memory = typename Exec::memory_space;

  SharedPassage<Exec> tables_;
};

/// What the passage does as one, added to every node; walls are where they were asked to be, to the last bit. Linear.
template <class Exec>
class AddPassage {
 public:
  static inline std::string const region = "gridmorph::AddPassage";

  explicit AddPassage(SharedPassage<Exec> tables) : tables_(std::move(tables)) {}

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    auto const& t = *tables_;
    t.add(exec, x, f, t.nodes, 1);
    kernels::launch("gridmorph::passage::walls", exec,
                    kernels::SetFromSlots<Memory>{t.driving_slots, t.known, f.boundary, f.u.data()});
  }
  void transpose(Exec const& exec, Baseline const& x, StageField<Exec> const&, StageField<Exec> const& g) const {
    auto const& t = *tables_;
    kernels::launch("gridmorph::transposed::passage::walls", exec,
                    kernels::AddToSlots<Memory>{t.driving_slots, t.known, g.u.data(), g.given.data()});
    clear<Vec3>(exec, t.c);
    t.add_back(exec, x, g, t.nodes, t.of_nodes, 1);
  }

 private:
  using Memory = typename Exec::memory_space;

  SharedPassage<Exec> tables_;
};

}  // namespace gridmorph::stages
