// Last stage of an unstructured morph: nodes between corners, and nodes that coincide with another.
#pragma once

#include <gridmorph/kernels/interpolation_rows.hpp>
#include <gridmorph/kernels/listed_nodes.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

namespace gridmorph::stages {

/// Linear.
template <class Exec>
class JoinedNodes {
 public:
  static inline std::string const region = "gridmorph::JoinedNodes";

  JoinedNodes(Exec const& exec, UnstructuredPlan const& plan)
      : middle_(upload(exec, plan.middle, name("middle"))),
        copies_(upload(exec, plan.copies, name("copies"))),
        copied_(upload(exec, plan.copied, name("copied"))) {}

  void enqueue(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    kernels::interpolate("gridmorph::middle", exec, middle_, f.u.data(), f.u.data());
    kernels::launch("gridmorph::copies", exec, kernels::CopyListed<Memory>{copies_, copied_, f.u.data()});
  }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }

  kernels::InterpolationTable<Memory> middle_;
  List<Exec, Index32> copies_, copied_;
};

}  // namespace gridmorph::stages
