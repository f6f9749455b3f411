// A mesh of elements in parts, each with stages of its own in its own numbers, and the motion that its boundaries have
// in common taken off before them.
#pragma once

#include <gridmorph/kernels/part_nodes.hpp>
#include <gridmorph/morph/stages/body_turns.hpp>
#include <gridmorph/morph/stages/common_motion.hpp>
#include <gridmorph/morph/stages/far_field.hpp>
#include <gridmorph/morph/stages/middle_nodes.hpp>
#include <gridmorph/morph/stages/near_field.hpp>
#include <gridmorph/morph/stages/near_fit.hpp>
#include <gridmorph/morph/stages/near_layers.hpp>
#include <gridmorph/morph/stages/other_boundaries.hpp>
#include <gridmorph/morph/stages/passage_motion.hpp>
#include <gridmorph/morph/stages/run_stages.hpp>
#include <gridmorph/morph/stages/wall_motion.hpp>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace gridmorph::stages {

template <class Exec>
using ElementStage = std::variant<WallMotion<Exec>, TakePassage<Exec>, TakeTurns<Exec>, NearField<Exec>,
                                  NearLayers<Exec>, NearFit<Exec>, FarField<Exec>, AddTurns<Exec>, AddPassage<Exec>,
                                  StartResidual<Exec>, PrescribeAtBoundary<Exec>, MeanOfImages<Exec>, JointNodes<Exec>,
                                  GoAlong<Exec>, SpreadResidual<Exec>, FollowCorners<Exec>, CopyNodes<Exec>>;

/// The stages of a plan without parts.
template <class Exec>
struct ElementStages {
  std::vector<ElementStage<Exec>> walls;   ///< what moving walls carry
  std::vector<ElementStage<Exec>> others;  ///< what other boundaries ask for, then nodes that follow others

  /// back: positions of all nodes, where transposes are asked for. common, x: as for FollowCorners.
  ElementStages(Exec const& exec, UnstructuredPlan const& plan, bool velocity, std::vector<Vec3> const* back,
                CommonMotion const* common = nullptr, Baseline const& x = {}) {
    walls.emplace_back(WallMotion<Exec>(exec, plan, velocity, back));
    SharedPassage<Exec> passage;
    if (!plan.passage.empty()) {
      passage = std::make_shared<PassageTables<Exec> const>(exec, plan, back != nullptr);
      walls.emplace_back(TakePassage<Exec>(passage));
    }
    SharedBodyTurns<Exec> turns;
    if (plan.turns_of_bodies.size() > 0) {
      turns = std::make_shared<BodyTurnTables<Exec> const>(exec, plan, velocity, back != nullptr);
      walls.emplace_back(TakeTurns<Exec>(turns));
    }
    if (!plan.fit.empty())
      walls.emplace_back(NearFit<Exec>(exec, plan, back));
    else if (plan.walls.empty())
      walls.emplace_back(NearLayers<Exec>(exec, plan, back));
    else
      walls.emplace_back(NearField<Exec>(exec, plan, back));
    if (plan.background) walls.emplace_back(FarField<Exec>(exec, plan, velocity, back != nullptr));
    if (turns) walls.emplace_back(AddTurns<Exec>(turns));
    if (passage) walls.emplace_back(AddPassage<Exec>(passage));
    add_other_boundaries(others, exec, plan, back, common, x);
    add_followers(others, exec, plan, back != nullptr, common, x);
  }

  [[nodiscard]] FarField<Exec> const* far_field() const {
    for (auto const& any : walls)
      if (auto const* far = std::get_if<FarField<Exec>>(&any)) return far;
    return nullptr;
  }
};

/// Workspace of a plan without parts. second: holds rates or gradients.
template <class Exec>
StageField<Exec> element_field(Exec const& exec, UnstructuredPlan const& plan, bool second, bool back) {
  auto const n = std::size_t(plan.n_nodes);
  StageField<Exec> field;
  field.u = room_for<Vec3>(exec, n, "gridmorph::Morpher::u");
  field.work = room_for<Vec3>(exec, n, "gridmorph::Morpher::work");
  field.frames = room_for<kernels::AffineMotion>(exec, plan.driving.size() + plan.beside_slots.size(),
                                                 "gridmorph::Morpher::frames");
  if (back && second) {
    field.given = room_for<Vec3>(exec, plan.known.size(), "gridmorph::Morpher::given");
    field.read = room_for<Vec3>(exec, n, "gridmorph::Morpher::read");
  }
  return field;
}

/// The one stage of a plan of parts.
template <class Exec>
class MorphParts {
 public:
  static inline std::string const region = "gridmorph::MorphParts";

  /// positions: of all nodes, where transposes are asked for.
  MorphParts(Exec const& exec, UnstructuredPlan const& plan, Baseline const& x, bool velocity,
             std::vector<Vec3> const* positions) {
    for (PartPlan const& part : plan.parts)
      parts_.push_back(std::make_shared<Part const>(exec, part, x, velocity, positions));
  }

  void enqueue(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    rest(exec, f);
    for (auto const& part : parts_) part->enqueue(exec, f);
  }
  void rate(Exec const& exec, Baseline const&, StageField<Exec> const& f, StageField<Exec> const& r) const {
    rest(exec, f);
    rest(exec, r);
    for (auto const& part : parts_) part->rate(exec, f, r);
  }

  [[nodiscard]] static bool bends() { return true; }
  void keep(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    for (auto const& part : parts_) part->keep(exec, f);
  }
  /// g.boundary is written.
  void transpose(Exec const& exec, Baseline const&, StageField<Exec> const&, StageField<Exec> const& g) const {
    kernels::launch("gridmorph::transposed::parts::clear", exec, 0, Index(g.given.extent(0)),
                    kernels::ClearVectorArray{g.boundary});
    for (auto const& part : parts_) part->transpose(exec, g);
  }

  /// The far field of a part, where it has one.
  [[nodiscard]] FarField<Exec> const* far_field(std::size_t part) const {
    return part < parts_.size() ? parts_[part]->stages.far_field() : nullptr;
  }

 private:
  using Memory = typename Exec::memory_space;

  struct Part {
    List<Exec, Index32> nodes, slots, known, driving_slots;
    List<Exec, Vec3> position;
    Baseline x;
    std::optional<CommonMotionTables<Exec>> common;
    ElementStages<Exec> stages;
    std::vector<StageField<Exec>> fields;
    std::array<List<Exec, Vec3>, 2> given, left;  ///< of each field; left: less what is in common
    List<Exec, Vec3> of_left;                     ///< gradients of that
    List<Exec, Vec3> before;  ///< where transposes are taken at: displacements before what is in common is added
    Index n_node_chunks = 0, n_other_chunks = 0;  ///< of gradients that are summed

    Part(Exec const& exec, PartPlan const& part, Baseline const& all, bool velocity, std::vector<Vec3> const* positions)
        : nodes(upload(exec, part.nodes, name("nodes"))),
          slots(upload(exec, part.slots, name("slots"))),
          known(upload(exec, part.plan->known, name("known"))),
          driving_slots(upload(exec, part.plan->driving_slots, name("driving_slots"))),
          position(gathered(exec, nodes, all)),
          x{component(position, 0), component(position, 1), component(position, 2), 3},
          stages(made(exec, part, velocity, x, positions)) {
      bool const back = positions != nullptr;
      std::size_t const n_fields = velocity || back ? 2 : 1;
      if (back) {
        n_node_chunks = kernels::common_chunks(Index(part.nodes.size()));
        n_other_chunks =
            kernels::common_chunks(part.plan->middle.size()) + kernels::common_chunks(Index(part.plan->sliding.size()));
      }
      if (part.common) {
        common.emplace(exec, *part.common, int(n_fields), n_node_chunks + n_other_chunks, true);
        if (back) before = room_for<Vec3>(exec, part.nodes.size(), name("before"));
      }
      for (std::size_t f = 0; f < n_fields; ++f) {
        fields.push_back(element_field(exec, *part.plan, f == 1, back));
        given[f] = room_for<Vec3>(exec, part.slots.size(), name("given"));
        left[f] = common ? room_for<Vec3>(exec, part.slots.size(), name("left")) : given[f];
      }
      if (back) of_left = room_for<Vec3>(exec, part.slots.size(), name("of_left"));
      compat::fence(exec, "gridmorph::MorphParts (host tables may go)");
    }

    void enqueue(Exec const& exec, StageField<Exec> const& f) const {
      gather(exec, f, 0);
      if (common) common->take(exec, given[0].data(), 0, left[0]);
      enqueue_all(stages.walls, exec, x, field(0, left));
      add(exec);
      enqueue_all(stages.others, exec, x, whole(0));
      scatter(exec, 0, f);
    }
    void rate(Exec const& exec, StageField<Exec> const& f, StageField<Exec> const& r) const {
      gather(exec, f, 0);
      gather(exec, r, 1);
      if (common) {
        common->take(exec, given[0].data(), 0, left[0]);
        common->take_rate(exec, given[1].data(), 0, 1, left[0].data(), left[1]);
      }
      enqueue_rates(stages.walls, exec, x, field(0, left), field(1, left));
      if (common) {
        common->add_rate(exec, x, 0, 1, Index(nodes.extent(0)), fields[0].u.data(), fields[1].u.data());
        set_walls(exec, 1);
      }
      add(exec);
      enqueue_rates(stages.others, exec, x, whole(0), whole(1));
      scatter(exec, 0, f);
      scatter(exec, 1, r);
    }
    void keep(Exec const& exec, StageField<Exec> const& f) const {
      gather(exec, f, 0);
      std::size_t const n_others = n_that_bend(stages.others);
      bool const on = n_others > 0 || common;
      if (common) common->take(exec, given[0].data(), 0, left[0]);
      linearise(stages.walls, on ? stages.walls.size() : n_that_bend(stages.walls), on, exec, x, field(0, left));
      if (!on) return;
      if (common)
        kernels::launch(
            "gridmorph::parts::before", exec, 0, Index(before.extent(0)),
            gridmorph::detail::CopyVectors{VectorView<Memory>(fields[0].u).array(), as_field(before.data())});
      add(exec);
      linearise(stages.others, n_others, false, exec, x, whole(0));
    }
    void transpose(Exec const& exec, StageField<Exec> const& all) const {
      using kernels::launch;
      StageField<Exec> g = fields[1];
      g.boundary = VectorView<Memory>(of_left).array();
      if (common) g.common_parts = common->partial.data() + n_node_chunks;
      launch("gridmorph::transposed::parts::nodes", exec,
             kernels::GatherPart<Memory, Vec3 const*>{nodes, all.u.data(), g.u.data()});
      clear<Vec3>(exec, g.given);
      clear<kernels::AffineMotion>(exec, g.frames);
      transpose_all(stages.others, exec, x, whole(0), g);
      List<Exec, Vec3> const of_given = g.given;
      if (common) {
        launch("gridmorph::transposed::parts::walls", exec,
               kernels::AddToSlots<Memory>{driving_slots, known, g.u.data(), of_given.data()});
        common->nodes_back(exec, position, before.data(), 0, 0, g.u);
      }
      // What other boundaries hand to the displacement itself waits beside what walls hand to the rest of it.
      g.given = given[1];
      clear<Vec3>(exec, g.given);
      transpose_all(stages.walls, exec, x, field(0, left), g);
      if (common) common->fit_back(exec, n_node_chunks + n_other_chunks, left[0].data(), 0, 2, of_left, of_given);
      launch("gridmorph::transposed::parts::slots", exec,
             kernels::AddPart<Memory>{slots, of_given.data(), of_left.data(), all.boundary});
    }

   private:
    static std::string name(char const* what) { return region + "::" + what; }
    static double const* component(List<Exec, Vec3> const& v, std::size_t c) {
      return v.extent(0) == 0 ? nullptr : &v.data()->x + c;
    }
    static List<Exec, Vec3> gathered(Exec const& exec, List<Exec, Index32> const& nodes, Baseline const& all) {
      auto const out = room_for<Vec3>(exec, nodes.extent(0), name("position"));
      kernels::launch("gridmorph::parts::position", exec,
                      kernels::GatherPart<Memory, Baseline>{nodes, all, out.data()});
      return out;
    }
    static ElementStages<Exec> made(Exec const& exec, PartPlan const& part, bool velocity, Baseline const& x,
                                    std::vector<Vec3> const* positions) {
      std::vector<Vec3> own;
      if (positions != nullptr)
        for (Index32 const n : part.nodes) own.push_back((*positions)[n]);
      ElementStages<Exec> out(exec, *part.plan, velocity, positions == nullptr ? nullptr : &own,
                              part.common ? &*part.common : nullptr, x);
      compat::fence(exec, "gridmorph::MorphParts (positions may go)");
      return out;
    }

    [[nodiscard]] StageField<Exec> field(std::size_t f, std::array<List<Exec, Vec3>, 2> const& boundary) const {
      StageField<Exec> out = fields[f];
      out.boundary = VectorView<Memory>(boundary[f]).array();
      return out;
    }
    /// With what is in common.
    [[nodiscard]] StageField<Exec> whole(std::size_t f) const {
      StageField<Exec> out = field(f, given);
      if (common) out.common = common->of(int(f));
      return out;
    }
    /// What its boundary nodes are given, and what they have in common.
    void gather(Exec const& exec, StageField<Exec> const& from, std::size_t f) const {
      kernels::launch("gridmorph::parts::boundary", exec,
                      kernels::GatherPart<Memory, kernels::VectorArray>{slots, from.boundary, given[f].data()});
      if (common) common->fit(exec, given[f].data(), int(f));
    }
    void add(Exec const& exec) const {
      if (!common) return;
      common->add(exec, x, 0, Index(nodes.extent(0)), fields[0].u.data());
      set_walls(exec, 0);
    }
    /// Walls are where they were asked to be, to the last bit.
    void set_walls(Exec const& exec, std::size_t f) const {
      StageField<Exec> const own = field(f, given);
      kernels::launch("gridmorph::parts::walls", exec,
                      kernels::SetFromSlots<Memory>{driving_slots, known, own.boundary, own.u.data()});
    }
    void scatter(Exec const& exec, std::size_t f, StageField<Exec> const& to) const {
      kernels::launch("gridmorph::parts::nodes", exec,
                      kernels::ScatterPart<Memory>{nodes, fields[f].u.data(), to.u.data()});
    }
  };

  /// Nodes of no part.
  static void rest(Exec const& exec, StageField<Exec> const& f) {
    kernels::launch("gridmorph::parts::rest", exec, 0, Index(f.u.extent(0)), kernels::RestNodes{f.u.data()});
  }

  std::vector<std::shared_ptr<Part const>> parts_;
};

}  // namespace gridmorph::stages
