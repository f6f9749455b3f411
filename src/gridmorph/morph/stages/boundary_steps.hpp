// Steps of boundaries that do not drive a morph of elements: what they ask of a list of nodes, of what moves as one the
// mean, and copies. Each works on one list of a field, and is written forwards and backwards once; rates and what
// transposes are linearised at follow from where it stands in its list (run_stages.hpp).
#pragma once

#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/kernels/listed_nodes.hpp>
#include <gridmorph/kernels/periodic_mean.hpp>
#include <gridmorph/kernels/slip_nodes.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/morph/stages/transposed_tables.hpp>
#include <gridmorph/morph/stages/upload.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <string>
#include <vector>

namespace gridmorph::stages {

/// The classes of periodic images of `owners` on an execution space; images are entries of UnstructuredPlan::images.
/// Fences.
template <class Exec>
kernels::PeriodicTable<typename Exec::memory_space> periodic_table(Exec const& exec, UnstructuredPlan const& plan,
                                                                   std::vector<Index32> const& owners,
                                                                   CsrGraph const& images_of_owner) {
  auto const name = [](char const* what) { return std::string("gridmorph::periodic::") + what; };
  std::vector<Index32> nodes;
  std::vector<std::int32_t> rotations;
  for (PeriodicImage const& image : plan.images) {
    nodes.push_back(image.node);
    rotations.push_back(image.rotation);
  }
  std::vector<std::uint8_t> is_known(plan.n_nodes, 0), owner_known;
  for (Index32 const n : plan.known) is_known[n] = 1;
  for (Index32 const n : owners) owner_known.push_back(is_known[n]);
  kernels::PeriodicTable<typename Exec::memory_space> const table{upload(exec, owners, name("owner")),
                                                                  upload(exec, owner_known, name("owner_known")),
                                                                  upload(exec, images_of_owner.first, name("first")),
                                                                  upload(exec, images_of_owner.item, name("image")),
                                                                  upload(exec, nodes, name("node")),
                                                                  upload(exec, rotations, name("rotation")),
                                                                  upload(exec, plan.rotations, name("rotations"))};
  compat::fence(exec, "gridmorph::stages::periodic_table (host tables may go)");
  return table;
}

/// The list of a field that a step reads and writes: StageField::u or StageField::work.
template <class Exec>
using OnList = List<Exec, Vec3> StageField<Exec>::*;

/// Nodes with a slot get what their rule gives, all of them are put back on the surfaces that they lie on:
/// PrescribeNodes. Slip surfaces are not linear: see slip_edge.hpp.
template <class Exec>
class PrescribeAtBoundary {
 public:
  static inline std::string const region = "gridmorph::PrescribeAtBoundary";

  /// slot: per node, -1: none; surfaces: per node. back: where the transpose is asked for. label: of its kernel.
  PrescribeAtBoundary(Exec const& exec, OnList<Exec> on, std::vector<Index32> const& node,
                      std::vector<Index32> const& slot, CsrGraph const& surfaces,
                      SlipSurfaceTable<typename Exec::memory_space> const& of, bool back, char const* label)
      : on_(on),
        label_(label),
        surfaces_(of),
        table_{upload(exec, node, name("node")), upload(exec, slot, name("slot")),
               upload(exec, surfaces.first, name("surfaces::first")),
               upload(exec, surfaces.item, name("surfaces::item")), surfaces_.surfaces},
        bends_(back && surfaces.item.size() > 0) {
    if (!back) return;
    of_slots_ = transposed(exec, slot, nullptr, name("of_slots"));
    kept_ = room_for<Vec3>(exec, slot.size(), name("kept"));
    listed_ = room_for<Vec3>(exec, slot.size(), name("listed"));
  }

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    kernels::launch(label_, exec,
                    kernels::PrescribeNodes<Memory, false>{table_, f.boundary, {}, x, (f.*on_).data(), nullptr});
  }
  void rate(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& r) const {
    kernels::launch(
        label_, exec,
        kernels::PrescribeNodes<Memory, true>{table_, f.boundary, r.boundary, x, (f.*on_).data(), (r.*on_).data()});
  }

  [[nodiscard]] bool bends() const { return bends_; }
  void keep(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    kernels::launch("gridmorph::transposed::keep_prescribed", exec,
                    kernels::KeepPrescribed<Memory>{table_, f.boundary, (f.*on_).data(), kept_.data()});
  }
  void enqueue_kept(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    keep(exec, x, f);
    enqueue(exec, x, f);
  }
  /// Gradients of what nodes were asked for become those of their own displacement before; g.given: += those of slots.
  void transpose(Exec const& exec, Baseline const& x, StageField<Exec> const&, StageField<Exec> const& g) const {
    kernels::PrescribeNodes<Memory, false> const ask{table_, {}, {}, x, nullptr, nullptr};
    kernels::launch("gridmorph::transposed::prescribed", exec,
                    kernels::PrescribeNodesBack<Memory>{ask, kept_.data(), (g.*on_).data(), listed_.data()});
    kernels::gather_rows("gridmorph::transposed::prescribed::slots", exec, of_slots_, listed_.data(), g.given.data());
  }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }

  OnList<Exec> on_;
  char const* label_;
  SlipSurfaceTable<Memory> surfaces_;  ///< that the table points into
  kernels::SlipNodeTable<Memory> table_;
  bool bends_;
  kernels::TransposedRows<Memory> of_slots_;
  List<Exec, Vec3> kept_, listed_;
};

/// Nodes that periodic connections make one get the mean of what they have, each in its frame.
template <class Exec>
class MeanOfImages {
 public:
  static inline std::string const region = "gridmorph::MeanOfImages";

  MeanOfImages(OnList<Exec> on, kernels::PeriodicTable<typename Exec::memory_space> const& table)
      : on_(on), table_(table) {}

  void enqueue(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    kernels::launch("gridmorph::periodic", exec, kernels::PeriodicMean<Memory>{table_, (f.*on_).data()});
  }
  void transpose(Exec const& exec, Baseline const&, StageField<Exec> const&, StageField<Exec> const& g) const {
    kernels::launch("gridmorph::transposed::periodic", exec,
                    kernels::PeriodicMeanBack<Memory>{table_, (g.*on_).data()});
  }

 private:
  using Memory = typename Exec::memory_space;
  OnList<Exec> on_;
  kernels::PeriodicTable<Memory> table_;
};

/// Nodes that coincide with another take its displacement.
template <class Exec>
class CopyNodes {
 public:
  static inline std::string const region = "gridmorph::CopyNodes";

  CopyNodes(Exec const& exec, UnstructuredPlan const& plan, bool back)
      : copies_(upload(exec, plan.copies, region + "::copies")),
        copied_(upload(exec, plan.copied, region + "::copied")) {
    if (back) back_ = transposed(exec, plan.copied, &plan.copies, region + "::back");
  }

  void enqueue(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    kernels::launch("gridmorph::copies", exec, kernels::CopyListed<Memory>{copies_, copied_, f.u.data()});
  }
  void transpose(Exec const& exec, Baseline const&, StageField<Exec> const&, StageField<Exec> const& g) const {
    kernels::gather_rows("gridmorph::transposed::copies", exec, back_, g.u.data(), g.u.data());
    kernels::launch("gridmorph::transposed::copies::done", exec, kernels::ClearListed<Memory>{copies_, g.u.data()});
  }

 private:
  using Memory = typename Exec::memory_space;
  List<Exec, Index32> copies_, copied_;
  kernels::TransposedRows<Memory> back_;
};

}  // namespace gridmorph::stages
