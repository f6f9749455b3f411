// The motion that parts of a mesh of blocks have in common: their tables, and the stage that adds it to the skeleton.
#pragma once

#include <gridmorph/kernels/part_nodes.hpp>
#include <gridmorph/kernels/transposed_common.hpp>
#include <gridmorph/morph/device_plan.hpp>
#include <gridmorph/morph/stages/common_motion.hpp>
#include <gridmorph/morph/stages/transposed_tables.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::stages {

/// A part. Lists of two: of displacements, and of their rates.
template <class Exec>
struct CommonPartOfBlocks {
  using Memory = typename Exec::memory_space;

  CommonMotionTables<Exec> common;
  bool fits;                               ///< otherwise its motion is there from the start
  List<Exec, Index32> boundary;            ///< numbers of its boundary nodes
  List<Exec, Index32> given_slots;         ///< where they go
  List<Exec, Index32> exact, exact_slots;  ///< of them, those that are on no axis: numbers here, and where they go
  List<Exec, Index32> slots;
  List<Exec, Vec3> position;  ///< of slots
  Baseline x;
  std::array<List<Exec, Vec3>, 2> given, left;  ///< left: less what is in common
  std::array<List<Exec, Vec3>, 2> values;       ///< of slots
  List<Exec, Vec3> exact_values;
  // Where transposes are asked for.
  List<Exec, Vec3> before;             ///< of slots: where they are taken at
  List<Exec, Vec3> of_given, of_left;  ///< gradients
  detail::WorkList<kernels::VolumeBox, Memory> boxes;
  Index n_chunks = 0;  ///< of gradients of slots; those of boxes follow

  CommonPartOfBlocks(Exec const& exec, Plan const& plan, std::size_t number,
                     List<Exec, kernels::CommonMove> const& moves, bool back)
      : CommonPartOfBlocks(exec, plan, plan.common[number], int(number), moves, back) {}

  /// What is given, on the skeleton: less what is in common.
  void take(Exec const& exec, StageField<Exec> const& f) const {
    gather(exec, f, 0);
    common.take(exec, given[0].data(), f.number, left[0]);
    put_left(exec, f, 0);
  }
  void take_rate(Exec const& exec, StageField<Exec> const& f, StageField<Exec> const& r) const {
    gather(exec, r, 1);
    common.take_rate(exec, given[1].data(), f.number, r.number, left[0].data(), left[1]);
    put_left(exec, r, 1);
  }
  /// What take() has left, once more.
  void put_left(Exec const& exec, StageField<Exec> const& f, std::size_t list) const {
    set(exec, given_slots, left[list], f.skeleton);
  }

  /// What is in common, on the skeleton; boundary nodes are then where they are asked to be, to the last bit.
  void add(Exec const& exec, StageField<Exec> const& f) const {
    get(exec, slots, f.skeleton, values[0]);
    common.add(exec, x, f.number, n_slots(), values[0].data());
    put(exec, f, 0);
  }
  void add_rate(Exec const& exec, StageField<Exec> const& f, StageField<Exec> const& r) const {
    get(exec, slots, f.skeleton, values[0]);
    get(exec, slots, r.skeleton, values[1]);
    common.add_rate(exec, x, f.number, r.number, n_slots(), values[0].data(), values[1].data());
    put(exec, r, 1);
  }
  void keep(Exec const& exec, StageField<Exec> const& f) const { get(exec, slots, f.skeleton, before); }

  /// Gradients of slots and of nodes inside pieces, before motions are added; nodes: displacements of the latter there.
  /// What boundary nodes get at once waits in of_given.
  void add_back(Exec const& exec, StageField<Exec> const& f, StageField<Exec> const& g, Vec3 const* nodes) const {
    clear<Vec3>(exec, of_given);
    get(exec, exact_slots, g.skeleton, exact_values);
    kernels::launch("gridmorph::transposed::common::given", exec,
                    kernels::ScatterPart<Memory>{exact, exact_values.data(), of_given.data()});
    clear<Vec3>(exec, exact_values);
    set(exec, exact_slots, exact_values, g.skeleton);
    get(exec, slots, g.skeleton, values[1]);
    common.nodes_back(exec, position, before.data(), f.number, 0, values[1]);
    set(exec, slots, values[1], g.skeleton);
    kernels::launch("gridmorph::transposed::common::boxes", exec,
                    kernels::CommonMomentsOfBoxes<Memory>{boxes, common.frame, common.of(f.number), g.baseline, g.nodes,
                                                          nodes, common.partial.data() + n_chunks});
  }
  /// Takes the gradients of the part's boundary nodes off the skeleton.
  void hold_back(Exec const& exec, StageField<Exec> const& g) const {
    get(exec, given_slots, g.skeleton, of_left);
    clear<Vec3>(exec, left[1]);
    set(exec, given_slots, left[1], g.skeleton);
  }
  /// Last: adds them to g.boundary. of_gradients: a motion's place.
  void take_back(Exec const& exec, StageField<Exec> const& f, StageField<Exec> const& g, int of_gradients) const {
    common.fit_back(exec, n_chunks + boxes.n_items, left[0].data(), f.number, of_gradients, of_left, of_given);
    kernels::launch("gridmorph::transposed::common::boundary", exec,
                    kernels::AddPart<Memory>{boundary, of_given.data(), of_left.data(), g.boundary});
  }

 private:
  CommonPartOfBlocks(Exec const& exec, Plan const& plan, CommonPart const& part, int number,
                     List<Exec, kernels::CommonMove> const& moves, bool back)
      : common(exec, part.motion, 0, back ? chunks_of(plan, part, number) : 0, true, moves),
        fits(!part.map),
        boundary(upload(exec, part.boundary, name("boundary"))),
        slots(upload(exec, part.slots, name("slots"))),
        position(upload(exec, part.position, name("position"))),
        x{component(position, 0), component(position, 1), component(position, 2), 3} {
    auto const slot_of = slots_of(plan, part);
    auto const [numbers, places] = off_axis(plan, slot_of);
    given_slots = upload(exec, slot_of, name("given_slots"));
    exact = upload(exec, numbers, name("exact"));
    exact_slots = upload(exec, places, name("exact_slots"));
    exact_values = room_for<Vec3>(exec, numbers.size(), name("exact_values"));
    for (auto* const list : {&given, &left})
      for (auto& vectors : *list) vectors = room_for<Vec3>(exec, part.boundary.size(), name("given"));
    for (auto& vectors : values) vectors = room_for<Vec3>(exec, part.slots.size(), name("values"));
    if (!fits) {
      std::vector<kernels::CommonMove> const fixed(moves.extent(0),
                                                   kernels::common_move(part.motion.frame, *part.map, true));
      auto const copy = upload(exec, fixed, name("fixed"));
      Kokkos::deep_copy(exec, moves, copy);
      compat::fence(exec, "gridmorph::CommonPart (host tables may go)");
    }
    n_chunks = kernels::common_chunks(n_slots());
    std::vector<kernels::VolumeBox> own;
    if (back) {
      before = room_for<Vec3>(exec, part.slots.size(), name("before"));
      of_given = room_for<Vec3>(exec, part.boundary.size(), name("of_given"));
      of_left = room_for<Vec3>(exec, part.boundary.size(), name("of_left"));
      own = boxes_of(plan, number);
    }
    boxes = detail::WorkList<kernels::VolumeBox, Memory>(exec, own, kernels::CommonMomentsOfBoxes<Memory>::items,
                                                         "common::boxes");
    compat::fence(exec, "gridmorph::CommonPart (host tables may go)");
  }

  static std::string name(char const* what) { return std::string("gridmorph::CommonPart::") + what; }
  static double const* component(List<Exec, Vec3> const& v, std::size_t c) {
    return v.extent(0) == 0 ? nullptr : &v.data()->x + c;
  }
  static std::vector<kernels::VolumeBox> boxes_of(Plan const& plan, int number) {
    std::vector<kernels::VolumeBox> out;
    for (auto const& box : plan.boxes)
      if (box.common == number) out.push_back(box);
    return out;
  }
  static Index chunks_of(Plan const& plan, CommonPart const& part, int number) {
    Index n = kernels::common_chunks(Index(part.slots.size()));
    for (auto const& box : boxes_of(plan, number)) n += kernels::CommonMomentsOfBoxes<Memory>::items(box);
    return n;
  }
  static std::vector<Index32> slots_of(Plan const& plan, CommonPart const& part) {
    std::vector<Index32> out;
    for (Index32 const k : part.boundary) out.push_back(Index32(plan.boundary_slots[k]));
    return out;
  }
  /// Of a part's boundary nodes those whose displacement is not put onto an axis, and their slots.
  static std::pair<std::vector<Index32>, std::vector<Index32>> off_axis(Plan const& plan,
                                                                        std::vector<Index32> const& slot_of) {
    std::vector<char> on_axis(plan.n_slots, 0);
    for (kernels::NodeCopy const& c : plan.boundary_projections)
      for (Index q = 0; q < c.n_q; ++q)
        for (Index p = 0; p < c.n_p; ++p)
          on_axis[c.destination + p * c.destination_stride_p + q * c.destination_stride_q] = 1;
    std::pair<std::vector<Index32>, std::vector<Index32>> out;
    for (std::size_t k = 0; k < slot_of.size(); ++k) {
      if (on_axis[slot_of[k]] != 0) continue;
      out.first.push_back(Index32(k));
      out.second.push_back(slot_of[k]);
    }
    return out;
  }

  [[nodiscard]] Index n_slots() const { return Index(slots.extent(0)); }
  static void get(Exec const& exec, List<Exec, Index32> const& list, kernels::Field<double> const& from,
                  List<Exec, Vec3> const& to) {
    kernels::launch("gridmorph::common::get", exec,
                    kernels::GatherPart<Memory, kernels::Field<double>>{list, from, to.data()});
  }
  static void set(Exec const& exec, List<Exec, Index32> const& list, List<Exec, Vec3> const& from,
                  kernels::Field<double> const& to) {
    kernels::launch("gridmorph::common::set", exec, kernels::SetPart<Memory>{list, from.data(), to});
  }
  void gather(Exec const& exec, StageField<Exec> const& f, std::size_t list) const {
    kernels::launch("gridmorph::common::boundary", exec,
                    kernels::GatherPart<Memory, kernels::VectorArray>{boundary, f.boundary, given[list].data()});
    if (fits) common.fit(exec, given[list].data(), f.number);
  }
  void put(Exec const& exec, StageField<Exec> const& f, std::size_t list) const {
    set(exec, slots, values[list], f.skeleton);
    kernels::launch("gridmorph::common::exact", exec,
                    kernels::GatherPart<Memory, Vec3 const*>{exact, given[list].data(), exact_values.data()});
    set(exec, exact_slots, exact_values, f.skeleton);
  }
};

/// All parts that have one.
template <class Exec>
struct BlockCommon {
  using Memory = typename Exec::memory_space;

  std::vector<CommonPartOfBlocks<Exec>> parts;
  Kokkos::View<kernels::CommonFrame*, Memory> frames;
  List<Exec, kernels::CommonMove> moves;  ///< part after part, of all fields and of gradients
  List<Exec, Vec3> before;  ///< where rates and transposes are taken at: displacements of nodes inside pieces before
                            ///< what is in common is added
  int n_fields;

  BlockCommon(Exec const& exec, Plan const& plan, int fields, bool transposes, bool keeps)
      : moves(room_for<kernels::CommonMove>(exec, plan.common.size() * (std::size_t(fields) + 1),
                                            "gridmorph::CommonPart::moves")),
        n_fields(fields) {
    std::vector<kernels::CommonFrame> host;
    for (std::size_t p = 0; p < plan.common.size(); ++p) {
      auto const first = p * std::size_t(n_moves());
      parts.emplace_back(exec, plan, p, Kokkos::subview(moves, std::pair(first, first + std::size_t(n_moves()))),
                         transposes);
      host.push_back(plan.common[p].motion.frame);
    }
    frames = upload(exec, host, "gridmorph::CommonPart::frames");
    if (keeps) before = room_for<Vec3>(exec, plan.n_nodes, "gridmorph::CommonPart::before");
    compat::fence(exec, "gridmorph::CommonPart (host tables may go)");
  }

  [[nodiscard]] Index n_moves() const { return n_fields + 1; }
  /// For the pass through the volume that writes a field, and those behind it.
  [[nodiscard]] kernels::CommonMoves<Memory> of(StageField<Exec> const& f) const {
    kernels::CommonMoves<Memory> out{frames, moves.data(), n_moves(), f.number, f.of};
    if (f.of != f.number) out.before = before.data();
    return out;
  }
};

}  // namespace gridmorph::stages
