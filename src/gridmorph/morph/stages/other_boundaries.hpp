// Fourth stage of an unstructured morph: boundaries that do not drive it get what they ask for, and the difference spreads.
#pragma once

#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/kernels/listed_nodes.hpp>
#include <gridmorph/kernels/slip_nodes.hpp>
#include <gridmorph/morph/stages/periodic_table.hpp>
#include <gridmorph/morph/stages/smooth_field.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

namespace gridmorph::stages {

template <class Exec>
class OtherBoundaries {
 public:
  static inline std::string const region = "gridmorph::OtherBoundaries";

  OtherBoundaries(Exec const& exec, UnstructuredPlan const& plan)
      : start_(exec, plan.start),
        surfaces_(exec, plan.surfaces),
        nodes_{upload(exec, plan.residual_nodes, name("node")), upload(exec, plan.residual_slot, name("slot")),
               upload(exec, plan.residual_surfaces.first, name("surfaces::first")),
               upload(exec, plan.residual_surfaces.item, name("surfaces::item")), surfaces_.surfaces},
        sliding_(upload(exec, plan.sliding, name("sliding"))),
        sliding_root_(upload(exec, plan.sliding_root, name("sliding_root"))),
        periodic_(periodic_table(exec, plan, plan.image_owners, plan.images_of_owner)),
        residual_(exec, plan.residual, name("residual")),
        lacked_(room_for<Vec3>(exec, plan.residual_nodes.size(), name("lacked"))),
        fade_(upload(exec, plan.fade, name("fade"))),
        detail_(upload(exec, plan.residual_detail, name("detail"))),
        detail_begins_(
            upload_sources(exec, plan.residual_nodes, plan.residual_detail, plan.n_nodes, name("detail_begins"))),
        detail_fade_(upload(exec, plan.detail_fade, name("detail_fade"))) {}

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    start_.enqueue(exec, x, f);
    kernels::launch("gridmorph::residual_nodes", exec,
                    kernels::AskNodes<Memory, false>{nodes_, f.boundary, {}, x, f.work.data(), nullptr});
    take(exec, x, f);
  }

  /// Slip surfaces are not linear: see slip_edge.hpp.
  void rate(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& r) const {
    start_.enqueue(exec, x, f);
    start_.enqueue(exec, x, r);
    kernels::launch("gridmorph::residual_nodes", exec,
                    kernels::AskNodes<Memory, true>{nodes_, f.boundary, r.boundary, x, f.work.data(), r.work.data()});
    take(exec, x, f);
    take(exec, x, r);
  }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }

  /// Where nodes that slide or have images begin, left in StageField::work: the field so far, and the residual of the nodes whose
  /// displacement is given.
  class Start {
   public:
    Start(Exec const& exec, UnstructuredPlan::Start const& plan)
        : given_(upload(exec, plan.given, name("start::given"))),
          given_slot_(upload(exec, plan.given_slot, name("start::given_slot"))),
          residual_(exec, plan.residual, name("start::residual")),
          missing_(room_for<Vec3>(exec, plan.given.size(), name("start::missing"))),
          detail_(upload(exec, plan.detail, name("start::detail"))),
          node_(upload(exec, plan.node, name("start::node"))),
          fade_(upload(exec, plan.fade, name("start::fade"))),
          detail_fade_(upload(exec, plan.detail_fade, name("start::detail_fade"))) {}

    void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
      using kernels::launch;
      if (!residual_.empty()) {
        launch(
            "gridmorph::start::given", exec,
            kernels::GivenMisses<Memory>{given_, given_slot_, f.boundary, f.u.data(), f.work.data(), missing_.data()});
        residual_.enqueue(exec, missing_.data());
        launch("gridmorph::start::missing", exec,
               kernels::FieldMisses<Memory>{given_, residual_.field(), x, f.work.data(), f.work.data()});
        kernels::interpolate_layers("gridmorph::start::layers", exec, detail_, f.work.data());
      }
      launch(
          "gridmorph::start", exec,
          kernels::StartFromField<Memory>{node_, fade_, detail_fade_, residual_.field(), x, f.u.data(), f.work.data()});
    }

   private:
    List<Exec, Index32> given_, given_slot_;
    SmoothField<Exec, Vec3> residual_;
    List<Exec, Vec3> missing_;
    kernels::LayerTable<Memory> detail_;
    List<Exec, Index32> node_;
    List<Exec, float> fade_, detail_fade_;
  };

  /// What is asked for holds; what the field so far lacked of it spreads.
  void take(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    using kernels::launch;
    launch("gridmorph::periodic", exec, kernels::PeriodicMean<Memory>{periodic_, f.work.data()});
    if (sliding_.extent(0) > 0) {
      launch("gridmorph::sliding_columns", exec, kernels::CopyListed<Memory>{sliding_, sliding_root_, f.work.data()});
      launch("gridmorph::periodic", exec, kernels::PeriodicMean<Memory>{periodic_, f.work.data()});
    }
    launch("gridmorph::residual_nodes::take", exec,
           kernels::TakeAsked<Memory>{nodes_.node, f.u.data(), f.work.data(), lacked_.data()});
    if (residual_.empty()) return;
    residual_.enqueue(exec, lacked_.data());
    launch("gridmorph::residual", exec, kernels::AddField<Memory>{fade_, residual_.field(), x, f.u.data()});
    launch("gridmorph::residual::missing", exec,
           kernels::FieldMisses<Memory>{detail_begins_, residual_.field(), x, f.work.data(), f.work.data()});
    kernels::interpolate_layers("gridmorph::residual::layers", exec, detail_, f.work.data());
    launch("gridmorph::residual::detail", exec,
           kernels::AddShare<Memory>{detail_.rows.target, detail_fade_, f.work.data(), f.u.data()});
  }

  Start start_;
  SlipSurfaceTable<Memory> surfaces_;
  kernels::SlipNodeTable<Memory> nodes_;
  List<Exec, Index32> sliding_, sliding_root_;
  kernels::PeriodicTable<Memory> periodic_;
  SmoothField<Exec, Vec3> residual_;
  List<Exec, Vec3> lacked_;
  List<Exec, float> fade_;
  kernels::LayerTable<Memory> detail_;
  List<Exec, Index32> detail_begins_;  ///< boundary nodes that it reads
  List<Exec, float> detail_fade_;
};

}  // namespace gridmorph::stages
