// Last stage of an unstructured morph: nodes between corners, and nodes that coincide with another.
#pragma once

#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/kernels/common_rest.hpp>
#include <gridmorph/kernels/interpolation_rows.hpp>
#include <gridmorph/kernels/listed_nodes.hpp>
#include <gridmorph/kernels/slip_nodes.hpp>
#include <gridmorph/morph/stages/asked_back.hpp>
#include <gridmorph/morph/stages/joint_slip.hpp>
#include <gridmorph/morph/stages/periodic_table.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

namespace gridmorph::stages {

template <class Exec>
class JoinedNodes {
 public:
  static inline std::string const region = "gridmorph::JoinedNodes";

  /// common: where a motion in common is added to the displacement before, the frame of that; x: then.
  JoinedNodes(Exec const& exec, UnstructuredPlan const& plan, bool back, CommonMotion const* common = nullptr,
              Baseline const& x = {})
      : middle_(upload(exec, plan.middle, name("middle"))),
        copies_(upload(exec, plan.copies, name("copies"))),
        copied_(upload(exec, plan.copied, name("copied"))) {
    auto const& at = plan.middle_boundary;
    if (at.surfaces.item.size() > 0 || !at.joint.slip.empty())
      surfaces_ = SlipSurfaceTable<Memory>(exec, plan.surfaces);
    boundary_ = {upload(exec, at.node, name("boundary")), upload(exec, at.slot, name("slot")),
                 upload(exec, at.surfaces.first, name("surfaces::first")),
                 upload(exec, at.surfaces.item, name("surfaces::item")), surfaces_.surfaces};
    if (!at.image_owners.empty()) periodic_ = periodic_table(exec, plan, at.image_owners, at.images_of_owner);
    joint_ = JointNodes<Exec>(exec, plan, at.joint, surfaces_, back, name("joint"));
    if (common != nullptr && plan.middle.size() > 0) find_defects(exec, common->frame, x, plan.n_nodes);
    if (!back) return;
    middle_back_ = transposed(exec, plan.middle, name("middle_back"));
    copies_back_ = transposed(exec, plan.copied, &plan.copies, name("copies_back"));
    asked_back_ = AskedBack<Exec>(exec, at.slot, at.surfaces.item.size() > 0, name("asked_back"));
  }

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    follow_corners(exec, x, f);
    ask(exec, x, f);
    joint_.enqueue(exec, x, f.u);
    copy(exec, f);
  }
  [[nodiscard]] bool bends() const { return asked_back_.bends() || !joint_.empty(); }
  void keep(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    follow_corners(exec, x, f);
    asked_back_.keep(exec, boundary_, f.boundary, f.u);
    if (joint_.empty()) return;
    ask(exec, x, f);
    joint_.keep(exec, f.u);
  }
  /// Where fields go on behind the last stage.
  void enqueue_kept(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    keep(exec, x, f);
    enqueue(exec, x, f);
  }
  void transpose(Exec const& exec, Baseline const& x, StageField<Exec> const&, StageField<Exec> const& g) const {
    using kernels::launch;
    kernels::gather_rows("gridmorph::transposed::copies", exec, copies_back_, g.u.data(), g.u.data());
    launch("gridmorph::transposed::copies::done", exec, kernels::ClearListed<Memory>{copies_, g.u.data()});
    joint_.transpose(exec, x, g.u);
    launch("gridmorph::transposed::middle::periodic", exec, kernels::PeriodicMeanBack<Memory>{periodic_, g.u.data()});
    asked_back_.enqueue(exec, boundary_, x, g.u, g.given);
    if (g.common_parts != nullptr)
      launch("gridmorph::transposed::middle::common", exec,
             kernels::CommonDefectsBack<Memory>{middle_.target, defect_, g.u.data(), g.common_parts});
    kernels::gather_rows("gridmorph::transposed::middle", exec, middle_back_, g.u.data(), g.u.data());
    launch("gridmorph::transposed::middle::done", exec, kernels::ClearListed<Memory>{middle_.target, g.u.data()});
  }

  /// Slip surfaces are not linear: see slip_edge.hpp.
  void rate(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& r) const {
    follow_corners(exec, x, f);
    follow_corners(exec, x, r);
    kernels::launch("gridmorph::middle::boundary", exec,
                    kernels::AskNodes<Memory, true>{boundary_, f.boundary, r.boundary, x, f.u.data(), r.u.data()});
    average(exec, f);
    average(exec, r);
    joint_.rate(exec, x, f.u, r.u);
    copy(exec, f);
    copy(exec, r);
  }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }

  void follow_corners(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    if (f.common == nullptr || middle_.target.extent(0) == 0) {
      kernels::interpolate("gridmorph::middle", exec, middle_, f.u.data(), f.u.data());
      return;
    }
    kernels::launch("gridmorph::middle::beyond", exec, 0, Index(f.u.extent(0)),
                    kernels::NodesBeyondCommon{frame_, x, f.common, f.u.data(), f.work.data()});
    kernels::interpolate("gridmorph::middle", exec, middle_, f.work.data(), f.u.data());
    kernels::launch("gridmorph::middle::common", exec,
                    kernels::AddCommonAt<Memory>{frame_, middle_.target, x, f.common, f.u.data()});
  }
  /// Rows in single precision miss what is affine by their rounding.
  void find_defects(Exec const& exec, kernels::CommonFrame const& frame, Baseline const& x, Index n_nodes) {
    frame_ = frame;
    auto const y = room_for<Vec3>(exec, std::size_t(n_nodes), name("coordinates"));
    defect_ = room_for<Vec3>(exec, middle_.target.extent(0), name("defect"));
    kernels::launch("gridmorph::middle::coordinates", exec, 0, n_nodes, kernels::CommonCoordinates{frame, x, y.data()});
    kernels::interpolate("gridmorph::middle::means", exec, middle_, y.data(), y.data());
    kernels::launch("gridmorph::middle::defects", exec,
                    kernels::CommonDefects<Memory>{frame, middle_.target, x, y.data(), defect_.data()});
  }
  /// By rules and surfaces, and of what moves as one the mean.
  void ask(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    kernels::launch("gridmorph::middle::boundary", exec,
                    kernels::AskNodes<Memory, false>{boundary_, f.boundary, {}, x, f.u.data(), nullptr});
    average(exec, f);
  }
  void average(Exec const& exec, StageField<Exec> const& f) const {
    kernels::launch("gridmorph::middle::periodic", exec, kernels::PeriodicMean<Memory>{periodic_, f.u.data()});
  }
  void copy(Exec const& exec, StageField<Exec> const& f) const {
    kernels::launch("gridmorph::copies", exec, kernels::CopyListed<Memory>{copies_, copied_, f.u.data()});
  }

  kernels::InterpolationTable<Memory> middle_;
  kernels::CommonFrame frame_;
  List<Exec, Vec3> defect_;  ///< what rows miss of the coordinates of that frame
  SlipSurfaceTable<Memory> surfaces_;
  kernels::SlipNodeTable<Memory> boundary_;
  kernels::PeriodicTable<Memory> periodic_;
  JointNodes<Exec> joint_;
  List<Exec, Index32> copies_, copied_;
  kernels::TransposedRows<Memory> middle_back_, copies_back_;
  AskedBack<Exec> asked_back_;
};

}  // namespace gridmorph::stages
