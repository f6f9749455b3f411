// The last steps of an unstructured morph: nodes between corners, and nodes that coincide with another.
#pragma once

#include <gridmorph/kernels/common_rest.hpp>
#include <gridmorph/kernels/interpolation_rows.hpp>
#include <gridmorph/morph/stages/boundary_steps.hpp>
#include <gridmorph/morph/stages/joint_slip.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <string>
#include <vector>

namespace gridmorph::stages {

/// Nodes between corners follow them: the mean of the corners' displacements by the element's own weights.
template <class Exec>
class FollowCorners {
 public:
  static inline std::string const region = "gridmorph::FollowCorners";

  /// common: where a motion in common is added to the displacement before, the frame of that; x: then.
  FollowCorners(Exec const& exec, UnstructuredPlan const& plan, bool back, CommonMotion const* common,
                Baseline const& x)
      : middle_(upload(exec, plan.middle, name("middle"))) {
    if (common != nullptr) find_defects(exec, common->frame, x, plan.n_nodes);
    if (back) middle_back_ = transposed(exec, plan.middle, name("middle_back"));
  }

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    if (f.common == nullptr) {
      kernels::interpolate("gridmorph::middle", exec, middle_, f.u.data(), f.u.data());
      return;
    }
    kernels::launch("gridmorph::middle::beyond", exec, 0, Index(f.u.extent(0)),
                    kernels::NodesBeyondCommon{frame_, x, f.common, f.u.data(), f.work.data()});
    kernels::interpolate("gridmorph::middle", exec, middle_, f.work.data(), f.u.data());
    kernels::launch("gridmorph::middle::common", exec,
                    kernels::AddCommonAt<Memory>{frame_, middle_.target, x, f.common, f.u.data()});
  }
  void transpose(Exec const& exec, Baseline const&, StageField<Exec> const&, StageField<Exec> const& g) const {
    if (g.common_parts != nullptr)
      kernels::launch("gridmorph::transposed::middle::common", exec,
                      kernels::CommonDefectsBack<Memory>{middle_.target, defect_, g.u.data(), g.common_parts});
    kernels::gather_rows("gridmorph::transposed::middle", exec, middle_back_, g.u.data(), g.u.data());
    kernels::launch("gridmorph::transposed::middle::done", exec,
                    kernels::ClearListed<Memory>{middle_.target, g.u.data()});
  }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }

  /// Rows in single precision miss what is affine by their rounding.
  void find_defects(Exec const& exec, kernels::CommonFrame const& frame, Baseline const& x, Index n_nodes) {
    frame_ = frame;
    auto const y = room_for<Vec3>(exec, n_nodes, name("coordinates"));
    defect_ = room_for<Vec3>(exec, middle_.target.extent(0), name("defect"));
    kernels::launch("gridmorph::middle::coordinates", exec, 0, n_nodes, kernels::CommonCoordinates{frame, x, y.data()});
    kernels::interpolate("gridmorph::middle::means", exec, middle_, y.data(), y.data());
    kernels::launch("gridmorph::middle::defects", exec,
                    kernels::CommonDefects<Memory>{frame, middle_.target, x, y.data(), defect_.data()});
  }

  kernels::InterpolationTable<Memory> middle_;
  kernels::CommonFrame frame_;
  List<Exec, Vec3> defect_;  ///< what rows miss of the coordinates of that frame
  kernels::TransposedRows<Memory> middle_back_;
};

/// Appends the steps of nodes that follow others, as far as the plan has any. back: where the transpose is asked for;
/// common, x: as for FollowCorners.
template <class Exec, class Step>
void add_followers(std::vector<Step>& to, Exec const& exec, UnstructuredPlan const& plan, bool back,
                   CommonMotion const* common, Baseline const& x) {
  OnList<Exec> const on = &StageField<Exec>::u;
  auto const& at = plan.middle_boundary;
  if (plan.middle.size() > 0) to.emplace_back(FollowCorners<Exec>(exec, plan, back, common, x));
  SlipSurfaceTable<typename Exec::memory_space> surfaces;
  if (at.surfaces.item.size() > 0 || !at.joint.slip.empty())
    surfaces = SlipSurfaceTable<typename Exec::memory_space>(exec, plan.surfaces);
  if (!at.node.empty())
    to.emplace_back(PrescribeAtBoundary<Exec>(exec, on, at.node, at.slot, at.surfaces, surfaces, back,
                                              "gridmorph::middle::boundary"));
  if (!at.image_owners.empty())
    to.emplace_back(MeanOfImages<Exec>(on, periodic_table(exec, plan, at.image_owners, at.images_of_owner)));
  if (!at.joint.slip.empty()) to.emplace_back(JointNodes<Exec>(exec, on, plan, at.joint, surfaces, back));
  if (!plan.copies.empty()) to.emplace_back(CopyNodes<Exec>(exec, plan, back));
}

}  // namespace gridmorph::stages
