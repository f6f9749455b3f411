// Steps of an unstructured morph behind those of moving walls: boundaries that do not drive it get what they ask for,
// and the difference spreads.
//
//   StartResidual        where nodes that slide or have images begin, in StageField::work
//   PrescribeAtBoundary  rules and slip surfaces
//   MeanOfImages         what is periodic moves as one
//   JointNodes           on the surfaces of all of it
//   GoAlong              columns on walls that slip, with the mean and the surfaces once more
//   SpreadResidual       what the field so far misses of that, over all nodes
#pragma once

#include <gridmorph/geometry/slip_surface.hpp>
#include <gridmorph/kernels/common_rest.hpp>
#include <gridmorph/kernels/listed_nodes.hpp>
#include <gridmorph/morph/stages/boundary_steps.hpp>
#include <gridmorph/morph/stages/joint_slip.hpp>
#include <gridmorph/morph/stages/smooth_field.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph::stages {

/// Where nodes that slide or have images begin, left in StageField::work: the field so far, and the residual of the
/// nodes whose displacement is given.
template <class Exec>
class StartResidual {
 public:
  static inline std::string const region = "gridmorph::StartResidual";

  /// back: positions of all nodes, where the transpose is asked for.
  StartResidual(Exec const& exec, UnstructuredPlan::Start const& plan, Index n_nodes, std::vector<Vec3> const* back)
      : given_(upload(exec, plan.given, name("given"))),
        given_slot_(upload(exec, plan.given_slot, name("given_slot"))),
        residual_(exec, plan.residual, name("residual")),
        listed_(room_for<Vec3>(exec, plan.given.size(), name("listed"))),
        detail_(upload(exec, plan.detail, name("detail"))),
        node_(upload(exec, plan.node, name("node"))),
        fade_(upload(exec, plan.fade, name("fade"))),
        detail_fade_(upload(exec, plan.detail_fade, name("detail_fade"))) {
    if (back == nullptr || plan.residual.empty()) return;
    std::vector<Index32> readers = plan.node;
    readers.insert(readers.end(), plan.given.begin(), plan.given.end());
    residual_back_.emplace(exec, plan.residual, std::move(readers), *back, name("residual_back"));
    detail_back_ = transposed(exec, plan.detail, n_nodes, name("detail_back"));
    slots_back_ = transposed(exec, plan.given_slot, nullptr, name("slots_back"));
  }

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    using kernels::launch;
    if (!residual_.empty()) {
      launch(
          "gridmorph::start::given", exec,
          kernels::GivenResiduals<Memory>{given_, given_slot_, f.boundary, f.u.data(), f.work.data(), listed_.data()});
      residual_.enqueue(exec, listed_.data());
      launch("gridmorph::start::missing", exec,
             kernels::FieldMisses<Memory>{given_, residual_.field(), x, f.work.data(), f.work.data()});
      kernels::interpolate_layers("gridmorph::start::layers", exec, detail_, f.work.data());
    }
    launch(
        "gridmorph::start", exec,
        kernels::StartFromField<Memory>{node_, fade_, detail_fade_, residual_.field(), x, f.u.data(), f.work.data()});
  }
  void transpose(Exec const& exec, Baseline const& x, StageField<Exec> const&, StageField<Exec> const& g) const {
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
    clear<Vec3>(exec, listed_);
    residual_back_->enqueue(exec, x, g.read.data(), listed_.data());
    launch("gridmorph::transposed::start::given", exec,
           kernels::GivenResidualsBack<Memory>{given_, g.work.data(), listed_.data(), g.u.data()});
    kernels::gather_rows("gridmorph::transposed::start::slots", exec, slots_back_, listed_.data(), g.given.data());
  }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }

  List<Exec, Index32> given_, given_slot_;
  SmoothField<Exec, Vec3> residual_;
  List<Exec, Vec3> listed_;
  kernels::LayerTable<Memory> detail_;
  List<Exec, Index32> node_;
  List<Exec, float> fade_, detail_fade_;
  std::optional<SmoothFieldBack<Exec, Vec3>> residual_back_;
  kernels::TransposedLayers<Memory> detail_back_;
  kernels::TransposedRows<Memory> slots_back_;
};

/// Nodes of columns on walls that slip do what their wall node does.
template <class Exec>
class GoAlong {
 public:
  static inline std::string const region = "gridmorph::GoAlong";

  /// common: where a motion in common is added to the displacement before, the frame of that; x: then.
  GoAlong(Exec const& exec, UnstructuredPlan const& plan, bool back, CommonMotion const* common, Baseline const& x)
      : sliding_(upload(exec, plan.sliding, name("node"))), root_(upload(exec, plan.sliding_root, name("root"))) {
    if (common != nullptr) {
      distance_ = room_for<Vec3>(exec, plan.sliding.size(), name("distance"));
      kernels::launch("gridmorph::sliding_columns::distances", exec,
                      kernels::CommonDistances<Memory>{common->frame, sliding_, root_, x, distance_.data()});
      first_part_ = kernels::common_chunks(plan.middle.size());
    }
    if (back) back_ = transposed(exec, plan.sliding_root, &plan.sliding, name("back"));
  }

  void enqueue(Exec const& exec, Baseline const&, StageField<Exec> const& f) const {
    kernels::launch("gridmorph::sliding_columns", exec, kernels::CopyListed<Memory>{sliding_, root_, f.work.data()});
    if (f.common != nullptr)
      kernels::launch("gridmorph::sliding_columns::common", exec,
                      kernels::AddCommonDistances<Memory>{sliding_, distance_, f.common, f.work.data()});
  }
  void transpose(Exec const& exec, Baseline const&, StageField<Exec> const&, StageField<Exec> const& g) const {
    if (g.common_parts != nullptr)
      kernels::launch(
          "gridmorph::transposed::sliding_columns::common", exec,
          kernels::CommonDefectsBack<Memory>{sliding_, distance_, g.work.data(), g.common_parts + first_part_});
    kernels::gather_rows("gridmorph::transposed::sliding_columns", exec, back_, g.work.data(), g.work.data());
    kernels::launch("gridmorph::transposed::sliding_columns::done", exec,
                    kernels::ClearListed<Memory>{sliding_, g.work.data()});
  }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }

  List<Exec, Index32> sliding_, root_;
  List<Exec, Vec3> distance_;  ///< from their roots, in the frame of the motion in common
  Index first_part_ = 0;       ///< of what is handed back to that
  kernels::TransposedRows<Memory> back_;
};

/// What is asked for holds; what the field so far misses of it spreads.
template <class Exec>
class SpreadResidual {
 public:
  static inline std::string const region = "gridmorph::SpreadResidual";

  /// back: positions of all nodes, where the transpose is asked for.
  SpreadResidual(Exec const& exec, UnstructuredPlan const& plan, std::vector<Vec3> const* back)
      : node_(upload(exec, plan.residual_nodes, name("node"))),
        residual_(exec, plan.residual, name("residual")),
        listed_(room_for<Vec3>(exec, plan.residual_nodes.size(), name("listed"))),
        fade_(upload(exec, plan.fade, name("fade"))),
        detail_(upload(exec, plan.residual_detail, name("detail"))),
        detail_begins_(
            upload_sources(exec, plan.residual_nodes, plan.residual_detail, plan.n_nodes, name("detail_begins"))),
        detail_fade_(by_node(exec, plan)) {
    if (back == nullptr || residual_.empty()) return;
    std::vector<Index32> readers;
    for (std::size_t n = 0; n < plan.fade.size(); ++n)
      if (plan.fade[n] != 0) readers.push_back(Index32(n));
    readers.insert(readers.end(), plan.residual_nodes.begin(), plan.residual_nodes.end());
    residual_back_.emplace(exec, plan.residual, std::move(readers), *back, name("residual_back"));
    detail_back_ = transposed(exec, plan.residual_detail, plan.n_nodes, name("detail_back"));
  }

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    using kernels::launch;
    launch("gridmorph::residual_nodes::take", exec,
           kernels::TakePrescribed<Memory>{node_, f.u.data(), f.work.data(), listed_.data()});
    if (residual_.empty()) return;
    residual_.enqueue(exec, listed_.data());
    launch("gridmorph::residual::missing", exec,
           kernels::FieldMisses<Memory>{detail_begins_, residual_.field(), x, f.work.data(), f.work.data()});
    kernels::interpolate_layers("gridmorph::residual::layers", exec, detail_, f.work.data());
    launch("gridmorph::residual", exec,
           kernels::AddFieldAndMissing<Memory>{fade_, detail_fade_, residual_.field(), x, f.work.data(), f.u.data()});
  }
  void transpose(Exec const& exec, Baseline const& x, StageField<Exec> const&, StageField<Exec> const& g) const {
    clear<Vec3>(exec, g.work);
    clear<Vec3>(exec, listed_);
    if (!residual_.empty()) spread_back(exec, x, g);
    kernels::launch("gridmorph::transposed::residual_nodes::take", exec,
                    kernels::TakePrescribedBack<Memory>{node_, g.u.data(), g.work.data(), listed_.data()});
  }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }

  /// The shares of what the lattice misses, of all nodes. Fences.
  static List<Exec, float> by_node(Exec const& exec, UnstructuredPlan const& plan) {
    std::vector<float> share(plan.residual.empty() ? 0 : std::size_t(plan.n_nodes), 0);
    for (std::size_t r = 0; r < plan.detail_fade.size(); ++r)
      share[plan.residual_detail.rows.target[r]] = plan.detail_fade[r];
    auto const out = upload(exec, share, name("detail_fade"));
    compat::fence(exec, "gridmorph::SpreadResidual (host tables may go)");
    return out;
  }
  /// From gradients of the residual over all nodes to those of what is missing.
  void spread_back(Exec const& exec, Baseline const& x, StageField<Exec> const& g) const {
    using kernels::launch;
    launch("gridmorph::transposed::residual::detail", exec, 0, Index(detail_fade_.extent(0)),
           kernels::ReadWithShare<Memory>{detail_fade_, g.u.data(), g.work.data()});
    kernels::gather_layers("gridmorph::transposed::residual::layers", exec, detail_back_, g.work.data());
    launch("gridmorph::transposed::residual::layers_done", exec,
           kernels::ClearListed<Memory>{detail_.rows.target, g.work.data()});
    launch("gridmorph::transposed::residual", exec, 0, Index(fade_.extent(0)),
           kernels::ReadWithShare<Memory>{fade_, g.u.data(), g.read.data()});
    launch("gridmorph::transposed::residual::missing", exec,
           kernels::ReadWith<Memory, true>{detail_begins_, -1, g.work.data(), g.read.data()});
    residual_back_->enqueue(exec, x, g.read.data(), listed_.data());
  }

  List<Exec, Index32> node_;
  SmoothField<Exec, Vec3> residual_;
  List<Exec, Vec3> listed_;
  List<Exec, float> fade_;
  kernels::LayerTable<Memory> detail_;
  List<Exec, Index32> detail_begins_;  ///< boundary nodes that it reads
  List<Exec, float> detail_fade_;      ///< (n_nodes)
  std::optional<SmoothFieldBack<Exec, Vec3>> residual_back_;
  kernels::TransposedLayers<Memory> detail_back_;
};

/// Appends these steps, as far as the plan has use for them. back: positions of all nodes, where the transpose is asked
/// for; common, x: as for GoAlong.
template <class Exec, class Step>
void add_other_boundaries(std::vector<Step>& to, Exec const& exec, UnstructuredPlan const& plan,
                          std::vector<Vec3> const* back, CommonMotion const* common, Baseline const& x) {
  OnList<Exec> const on = &StageField<Exec>::work;
  SlipSurfaceTable<typename Exec::memory_space> const surfaces(exec, plan.surfaces);
  to.emplace_back(StartResidual<Exec>(exec, plan.start, plan.n_nodes, back));
  to.emplace_back(PrescribeAtBoundary<Exec>(exec, on, plan.residual_nodes, plan.residual_slot, plan.residual_surfaces,
                                            surfaces, back != nullptr, "gridmorph::residual_nodes"));
  auto const images = periodic_table(exec, plan, plan.image_owners, plan.images_of_owner);
  auto const join = [&](UnstructuredPlan::JointNodes const& joint) {
    if (!plan.image_owners.empty()) to.emplace_back(MeanOfImages<Exec>(on, images));
    if (!joint.slip.empty()) to.emplace_back(JointNodes<Exec>(exec, on, plan, joint, surfaces, back != nullptr));
  };
  join(plan.joint);
  if (!plan.sliding.empty()) {
    to.emplace_back(GoAlong<Exec>(exec, plan, back != nullptr, common, x));
    join(plan.joint_sliding);
  }
  to.emplace_back(SpreadResidual<Exec>(exec, plan, back));
}

}  // namespace gridmorph::stages
