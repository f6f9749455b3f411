// Nodes of elements that move as one, held on the surfaces of all of them; and displacements that rules give, put back
// on slip surfaces before any stage reads them.
#pragma once

#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/kernels/joint_slip.hpp>
#include <gridmorph/morph/stages/boundary_steps.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace gridmorph::stages {

/// Enqueues copies: the host tables must stay until the instance has been fenced.
template <class Exec>
kernels::JointSlipTable<typename Exec::memory_space> joint_slip_table(
    Exec const& exec, UnstructuredPlan const& plan, JointSlip const& of,
    SlipSurfaceTable<typename Exec::memory_space> const& surfaces, std::string const& label) {
  return {upload(exec, of.first, label + "::first"),     upload(exec, of.surface, label + "::surface"),
          upload(exec, of.place, label + "::place"),     upload(exec, of.turned, label + "::turned"),
          upload(exec, plan.rotations, label + "::rot"), surfaces.surfaces};
}

/// Nodes that move as one are put on the surfaces of all of them.
template <class Exec>
class JointNodes {
 public:
  static inline std::string const region = "gridmorph::JointNodes";

  /// back: where the transpose is asked for. Fences.
  JointNodes(Exec const& exec, OnList<Exec> on, UnstructuredPlan const& plan, UnstructuredPlan::JointNodes const& of,
             SlipSurfaceTable<typename Exec::memory_space> const& surfaces, bool back)
      : on_(on), surfaces_(surfaces) {
    std::vector<Index32> node;
    std::vector<std::int32_t> turn;
    for (Index32 const image : of.images.item) {
      node.push_back(plan.images[image].node);
      turn.push_back(plan.images[image].rotation);
    }
    nodes_ = {joint_slip_table(exec, plan, of.slip, surfaces_, region), upload(exec, of.slip.of, region + "::owner"),
              upload(exec, of.images.first, region + "::images"), upload(exec, node, region + "::node"),
              upload(exec, turn, region + "::turn")};
    if (back) kept_ = room_for<Vec3>(exec, of.slip.of.size(), region + "::kept");
    compat::fence(exec, "gridmorph::stages::JointNodes (host tables may go)");
  }

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    kernels::launch("gridmorph::joint_slip", exec,
                    kernels::HoldJointNodes<Memory, false>{nodes_, x, (f.*on_).data(), nullptr});
  }
  void rate(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& r) const {
    kernels::launch("gridmorph::joint_slip", exec,
                    kernels::HoldJointNodes<Memory, true>{nodes_, x, (f.*on_).data(), (r.*on_).data()});
  }

  [[nodiscard]] static bool bends() { return true; }
  void keep(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    kernels::launch("gridmorph::transposed::keep_joint_slip", exec,
                    kernels::KeepJointNodes<Memory>{nodes_, (f.*on_).data(), kept_.data()});
  }
  void enqueue_kept(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    keep(exec, x, f);
    enqueue(exec, x, f);
  }
  void transpose(Exec const& exec, Baseline const& x, StageField<Exec> const&, StageField<Exec> const& g) const {
    kernels::launch("gridmorph::transposed::joint_slip", exec,
                    kernels::HoldJointNodesBack<Memory>{nodes_, x, kept_.data(), (g.*on_).data()});
  }

 private:
  using Memory = typename Exec::memory_space;
  OnList<Exec> on_;
  SlipSurfaceTable<Memory> surfaces_;  ///< that the tables point into
  kernels::JointNodes<Memory> nodes_;
  List<Exec, Vec3> kept_;
};

/// Before the first stage: StageField::boundary as it was given becomes what slip surfaces let it be.
template <class Exec>
class GivenSlip {
 public:
  static inline std::string const region = "gridmorph::GivenSlip";

  GivenSlip(Exec const& exec, UnstructuredPlan const& plan)
      : surfaces_(exec, plan.surfaces),
        table_(joint_slip_table(exec, plan, plan.given_slip, surfaces_, name("table"))),
        slot_(upload(exec, plan.given_slip.of, name("slot"))),
        tolerance_(upload(exec, plan.given_tolerance, name("tolerance"))) {}

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec>& f) const {
    copy(exec, f);
    kernels::launch("gridmorph::given_slip", exec,
                    kernels::PutBackGiven<Memory, false>{
                        table_, slot_, tolerance_, f.boundary, {}, x, f.kept_given.data(), nullptr});
    read_kept(f);
  }
  void rate(Exec const& exec, Baseline const& x, StageField<Exec>& f, StageField<Exec>& r) const {
    copy(exec, f);
    copy(exec, r);
    kernels::launch("gridmorph::given_slip", exec,
                    kernels::PutBackGiven<Memory, true>{table_, slot_, tolerance_, f.boundary, r.boundary, x,
                                                        f.kept_given.data(), r.kept_given.data()});
    read_kept(f);
    read_kept(r);
  }
  /// The last one. given: as the caller gives them; g.boundary: gradients of what was kept, then of what was given.
  void transpose(Exec const& exec, Baseline const& x, kernels::VectorArray const& given,
                 StageField<Exec> const& g) const {
    kernels::launch("gridmorph::transposed::given_slip", exec,
                    kernels::PutBackGivenBack<Memory>{table_, slot_, given, x, g.boundary});
  }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }

  void copy(Exec const& exec, StageField<Exec> const& f) const {
    kernels::launch("gridmorph::given", exec, 0, Index(f.kept_given.extent(0)),
                    kernels::CopyGiven{f.boundary, f.kept_given.data()});
  }
  static void read_kept(StageField<Exec>& f) {
    Vec3* const v = f.kept_given.data();
    f.boundary = {&v->x, &v->y, &v->z, sizeof(Vec3) / sizeof(double)};
  }

  SlipSurfaceTable<Memory> surfaces_;
  kernels::JointSlipTable<Memory> table_;
  List<Exec, Index32> slot_;
  List<Exec, double> tolerance_;
};

}  // namespace gridmorph::stages
