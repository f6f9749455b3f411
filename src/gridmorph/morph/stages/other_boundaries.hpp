// Fourth stage of an unstructured morph: boundaries that do not drive it get what they ask for, and the difference
// spreads.
#pragma once

#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/kernels/common_rest.hpp>
#include <gridmorph/kernels/listed_nodes.hpp>
#include <gridmorph/kernels/slip_nodes.hpp>
#include <gridmorph/morph/stages/asked_back.hpp>
#include <gridmorph/morph/stages/joint_slip.hpp>
#include <gridmorph/morph/stages/periodic_table.hpp>
#include <gridmorph/morph/stages/smooth_field.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <optional>

namespace gridmorph::stages {

template <class Exec>
class OtherBoundaries {
 public:
  static inline std::string const region = "gridmorph::OtherBoundaries";

  /// back: positions of all nodes, where the transpose is asked for. common, x: as for JoinedNodes.
  OtherBoundaries(Exec const& exec, UnstructuredPlan const& plan, std::vector<Vec3> const* back,
                  CommonMotion const* common = nullptr, Baseline const& x = {})
      : start_(exec, plan.start, plan.n_nodes, back),
        surfaces_(exec, plan.surfaces),
        nodes_{upload(exec, plan.residual_nodes, name("node")), upload(exec, plan.residual_slot, name("slot")),
               upload(exec, plan.residual_surfaces.first, name("surfaces::first")),
               upload(exec, plan.residual_surfaces.item, name("surfaces::item")), surfaces_.surfaces},
        sliding_(upload(exec, plan.sliding, name("sliding"))),
        sliding_root_(upload(exec, plan.sliding_root, name("sliding_root"))),
        periodic_(periodic_table(exec, plan, plan.image_owners, plan.images_of_owner)),
        joint_(exec, plan, plan.joint, surfaces_, back != nullptr, name("joint")),
        joint_sliding_(exec, plan, plan.joint_sliding, surfaces_, back != nullptr, name("joint_sliding")),
        residual_(exec, plan.residual, name("residual")),
        lacked_(room_for<Vec3>(exec, plan.residual_nodes.size(), name("lacked"))),
        fade_(upload(exec, plan.fade, name("fade"))),
        detail_(upload(exec, plan.residual_detail, name("detail"))),
        detail_begins_(
            upload_sources(exec, plan.residual_nodes, plan.residual_detail, plan.n_nodes, name("detail_begins"))),
        detail_fade_(upload(exec, plan.detail_fade, name("detail_fade"))) {
    if (common != nullptr && !plan.sliding.empty()) {
      sliding_distance_ = room_for<Vec3>(exec, plan.sliding.size(), name("sliding_distance"));
      kernels::launch(
          "gridmorph::sliding_columns::distances", exec,
          kernels::CommonDistances<Memory>{common->frame, sliding_, sliding_root_, x, sliding_distance_.data()});
      first_part_ = kernels::common_chunks(plan.middle.size());
    }
    if (back == nullptr) return;
    asked_back_ = AskedBack<Exec>(exec, plan.residual_slot, plan.residual_surfaces.item.size() > 0, name("asked_back"));
    sliding_back_ = transposed(exec, plan.sliding_root, &plan.sliding, name("sliding_back"));
    if (residual_.empty()) return;
    std::vector<Index32> readers;
    for (std::size_t n = 0; n < plan.fade.size(); ++n)
      if (plan.fade[n] != 0) readers.push_back(Index32(n));
    readers.insert(readers.end(), plan.residual_nodes.begin(), plan.residual_nodes.end());
    residual_back_.emplace(exec, plan.residual, std::move(readers), *back, name("residual_back"));
    detail_back_ = transposed(exec, plan.residual_detail, plan.n_nodes, name("detail_back"));
  }

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    start_.enqueue(exec, x, f);
    ask(exec, x, f);
    join<false>(exec, x, f);
    take(exec, x, f);
  }
  /// The same, kept for the transpose.
  void enqueue_kept(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    start_.enqueue(exec, x, f);
    asked_back_.keep(exec, nodes_, f.boundary, f.work);
    ask(exec, x, f);
    join<true>(exec, x, f);
    take(exec, x, f);
  }
  [[nodiscard]] bool bends() const { return asked_back_.bends() || !joint_.empty() || !joint_sliding_.empty(); }
  void keep(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    start_.enqueue(exec, x, f);
    asked_back_.keep(exec, nodes_, f.boundary, f.work);
    if (joint_.empty() && joint_sliding_.empty()) return;
    ask(exec, x, f);
    join<true>(exec, x, f);
  }

  void transpose(Exec const& exec, Baseline const& x, StageField<Exec> const&, StageField<Exec> const& g) const {
    using kernels::launch;
    clear<Vec3>(exec, g.work);
    clear<Vec3>(exec, lacked_);
    if (!residual_.empty()) spread_back(exec, x, g);
    launch("gridmorph::transposed::residual_nodes::take", exec,
           kernels::TakeAskedBack<Memory>{nodes_.node, g.u.data(), g.work.data(), lacked_.data()});
    if (sliding_.extent(0) > 0) {
      joint_sliding_.transpose(exec, x, g.work);
      launch("gridmorph::transposed::periodic", exec, kernels::PeriodicMeanBack<Memory>{periodic_, g.work.data()});
      if (g.common_parts != nullptr)
        launch("gridmorph::transposed::sliding_columns::common", exec,
               kernels::CommonDefectsBack<Memory>{sliding_, sliding_distance_, g.work.data(),
                                                  g.common_parts + first_part_});
      kernels::gather_rows("gridmorph::transposed::sliding_columns", exec, sliding_back_, g.work.data(), g.work.data());
      launch("gridmorph::transposed::sliding_columns::done", exec,
             kernels::ClearListed<Memory>{sliding_, g.work.data()});
    }
    joint_.transpose(exec, x, g.work);
    launch("gridmorph::transposed::periodic", exec, kernels::PeriodicMeanBack<Memory>{periodic_, g.work.data()});
    asked_back_.enqueue(exec, nodes_, x, g.work, g.given);
    start_.transpose(exec, x, g);
  }

  /// Slip surfaces are not linear: see slip_edge.hpp.
  void rate(Exec const& exec, Baseline const& x, StageField<Exec> const& f, StageField<Exec> const& r) const {
    start_.enqueue(exec, x, f);
    start_.enqueue(exec, x, r);
    kernels::launch("gridmorph::residual_nodes", exec,
                    kernels::AskNodes<Memory, true>{nodes_, f.boundary, r.boundary, x, f.work.data(), r.work.data()});
    average(exec, f);
    average(exec, r);
    joint_.rate(exec, x, f.work, r.work);
    if (sliding_.extent(0) > 0) {
      go_along(exec, f);
      go_along(exec, r);
      joint_sliding_.rate(exec, x, f.work, r.work);
    }
    take(exec, x, f);
    take(exec, x, r);
  }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }

  /// Where nodes that slide or have images begin, left in StageField::work: the field so far, and the residual of the
  /// nodes whose displacement is given.
  class Start {
   public:
    Start(Exec const& exec, UnstructuredPlan::Start const& plan, Index n_nodes, std::vector<Vec3> const* back)
        : given_(upload(exec, plan.given, name("start::given"))),
          given_slot_(upload(exec, plan.given_slot, name("start::given_slot"))),
          residual_(exec, plan.residual, name("start::residual")),
          missing_(room_for<Vec3>(exec, plan.given.size(), name("start::missing"))),
          detail_(upload(exec, plan.detail, name("start::detail"))),
          node_(upload(exec, plan.node, name("start::node"))),
          fade_(upload(exec, plan.fade, name("start::fade"))),
          detail_fade_(upload(exec, plan.detail_fade, name("start::detail_fade"))) {
      if (back == nullptr || plan.residual.empty()) return;
      std::vector<Index32> readers = plan.node;
      readers.insert(readers.end(), plan.given.begin(), plan.given.end());
      residual_back_.emplace(exec, plan.residual, std::move(readers), *back, name("start::residual_back"));
      detail_back_ = transposed(exec, plan.detail, n_nodes, name("start::detail_back"));
      slots_back_ = transposed(exec, plan.given_slot, nullptr, name("start::slots_back"));
    }

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
    void transpose(Exec const& exec, Baseline const& x, StageField<Exec> const& g) const {
      using kernels::launch;
      clear<Vec3>(exec, g.read);
      launch("gridmorph::transposed::start", exec,
             kernels::StartFromFieldBack<Memory>{node_, fade_, detail_fade_, g.work.data(), g.u.data(), g.read.data()});
      if (residual_.empty()) return;
      kernels::gather_layers("gridmorph::transposed::start::layers", exec, detail_back_, g.work.data());
      launch("gridmorph::transposed::start::layers_done", exec,
             kernels::ClearListed<Memory>{detail_.rows.target, g.work.data()});
      launch("gridmorph::transposed::start::missing", exec,
             kernels::ReadWith<Memory, true>{given_, -1, g.work.data(), g.read.data()});
      clear<Vec3>(exec, missing_);
      residual_back_->enqueue(exec, x, g.read.data(), missing_.data());
      launch("gridmorph::transposed::start::given", exec,
             kernels::GivenMissesBack<Memory>{given_, g.work.data(), missing_.data(), g.u.data()});
      kernels::gather_rows("gridmorph::transposed::start::slots", exec, slots_back_, missing_.data(), g.given.data());
    }

   private:
    List<Exec, Index32> given_, given_slot_;
    SmoothField<Exec, Vec3> residual_;
    List<Exec, Vec3> missing_;
    kernels::LayerTable<Memory> detail_;
    List<Exec, Index32> node_;
    List<Exec, float> fade_, detail_fade_;
    std::optional<SmoothFieldBack<Exec, Vec3>> residual_back_;
    kernels::TransposedLayers<Memory> detail_back_;
    kernels::TransposedRows<Memory> slots_back_;
  };

  /// By rules, and by the surfaces that each node lies on.
  void ask(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    kernels::launch("gridmorph::residual_nodes", exec,
                    kernels::AskNodes<Memory, false>{nodes_, f.boundary, {}, x, f.work.data(), nullptr});
  }
  void average(Exec const& exec, StageField<Exec> const& f) const {
    kernels::launch("gridmorph::periodic", exec, kernels::PeriodicMean<Memory>{periodic_, f.work.data()});
  }
  void go_along(Exec const& exec, StageField<Exec> const& f) const {
    kernels::launch("gridmorph::sliding_columns", exec,
                    kernels::CopyListed<Memory>{sliding_, sliding_root_, f.work.data()});
    if (f.common != nullptr)
      kernels::launch("gridmorph::sliding_columns::common", exec,
                      kernels::AddCommonDistances<Memory>{sliding_, sliding_distance_, f.common, f.work.data()});
    average(exec, f);
  }
  /// What moves as one, on the surfaces of all of it; columns on walls that slip go along.
  template <bool Keep>
  void join(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    average(exec, f);
    if constexpr (Keep) joint_.keep(exec, f.work);
    joint_.enqueue(exec, x, f.work);
    if (sliding_.extent(0) == 0) return;
    go_along(exec, f);
    if constexpr (Keep) joint_sliding_.keep(exec, f.work);
    joint_sliding_.enqueue(exec, x, f.work);
  }

  /// What is asked for holds; what the field so far lacked of it spreads.
  void take(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    using kernels::launch;
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

  /// Of the residual over all nodes, to what was lacked.
  void spread_back(Exec const& exec, Baseline const& x, StageField<Exec> const& g) const {
    using kernels::launch;
    launch("gridmorph::transposed::residual::detail", exec,
           kernels::ShareOf<Memory>{detail_.rows.target, detail_fade_, g.u.data(), g.work.data()});
    kernels::gather_layers("gridmorph::transposed::residual::layers", exec, detail_back_, g.work.data());
    launch("gridmorph::transposed::residual::layers_done", exec,
           kernels::ClearListed<Memory>{detail_.rows.target, g.work.data()});
    launch("gridmorph::transposed::residual", exec, 0, Index(fade_.extent(0)),
           kernels::ReadWithShare<Memory>{fade_, g.u.data(), g.read.data()});
    launch("gridmorph::transposed::residual::missing", exec,
           kernels::ReadWith<Memory, true>{detail_begins_, -1, g.work.data(), g.read.data()});
    residual_back_->enqueue(exec, x, g.read.data(), lacked_.data());
  }

  Start start_;
  SlipSurfaceTable<Memory> surfaces_;
  kernels::SlipNodeTable<Memory> nodes_;
  List<Exec, Index32> sliding_, sliding_root_;
  List<Exec, Vec3> sliding_distance_;  ///< from their roots, in the frame of the motion in common
  Index first_part_ = 0;               ///< of what is handed back to that
  kernels::PeriodicTable<Memory> periodic_;
  JointNodes<Exec> joint_, joint_sliding_;
  SmoothField<Exec, Vec3> residual_;
  List<Exec, Vec3> lacked_;
  List<Exec, float> fade_;
  kernels::LayerTable<Memory> detail_;
  List<Exec, Index32> detail_begins_;  ///< boundary nodes that it reads
  List<Exec, float> detail_fade_;
  AskedBack<Exec> asked_back_;
  kernels::TransposedRows<Memory> sliding_back_;
  std::optional<SmoothFieldBack<Exec, Vec3>> residual_back_;
  kernels::TransposedLayers<Memory> detail_back_;
};

}  // namespace gridmorph::stages
