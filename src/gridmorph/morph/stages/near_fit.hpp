// Second stage of an unstructured morph, by least squares: the walls' motion everywhere, and from layer to layer what
// that misses at the ends of columns.
#pragma once

#include <gridmorph/kernels/least_squares.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/morph/stages/transposed_tables.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <algorithm>
#include <vector>

namespace gridmorph::stages {

/// Linear in the walls' motions. Workspace: 168 bytes per wall node and group.
template <class Exec>
class NearFit {
 public:
  static inline std::string const region = "gridmorph::NearFit";

  /// back: where the transpose is asked for.
  NearFit(Exec const& exec, UnstructuredPlan const& plan, std::vector<Vec3> const* back)
      : sources_(upload_now(exec, plan.smooth_sources(), "sources")),
        beside_(upload(exec, plan.beside_slots, name("beside"))),
        n_driving_(Index(plan.driving.size())),
        leaves_(upload(exec, plan.fit.leaves, name("leaves"))),
        groups_(upload(exec, plan.fit.groups, name("groups"))),
        images_(upload_images(exec, plan)),
        origin_(plan.fit.origin),
        table_{upload(exec, plan.fit.nodes, name("nodes")), upload(exec, plan.fit.lean, name("lean")),
               upload(exec, plan.fit.level, name("level")), upload(exec, plan.fit.room, name("room"))},
        layers_(upload(exec, plan.near, name("layers"))),
        fade_(upload(exec, plan.near_fade, name("fade"))),
        moment_(
            room_for<kernels::MotionMoments>(exec, sources_.extent(0) * (1 + plan.fit.images.size()), name("moment"))),
        group_(room_for<kernels::MotionMoments>(exec, plan.fit.n_groups, name("group"))),
        n_ends_(plan.n_fitted_ends) {
    if (back == nullptr) return;
    auto const& rows = plan.fit.nodes;
    auto const ends = rows.target.begin() + std::ptrdiff_t(n_ends_);
    ends_ = upload(exec, std::vector<Index32>(rows.target.begin(), ends), name("ends"));
    nodes_ = upload(exec, std::vector<Index32>(ends, rows.target.end()), name("others"));
    shares_ = upload(exec, std::vector<float>(plan.near_fade.begin() + std::ptrdiff_t(n_ends_), plan.near_fade.end()),
                     name("shares"));
    layers_back_ = transposed(exec, plan.near, plan.n_nodes, name("layers_back"));
    TransposedEntries readers;
    readers.add_by_row(rows);
    readers_of_groups_ = upload(exec, readers, {}, name("readers")).rows;
    groups_back_ = transposed(exec, plan.fit.groups, Index(plan.fit.n_groups), name("groups_back"));
    leaves_back_ = transposed(exec, plan.fit.leaves, name("leaves_back"));
    compat::fence(exec, "gridmorph::NearFit (host tables may go)");
  }

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    using kernels::launch;
    launch("gridmorph::fit::beside", exec,
           kernels::FramesFromSlots<Memory>{beside_, f.boundary, f.frames.data() + n_driving_});
    launch("gridmorph::fit::walls", exec,
           kernels::MomentsOfFrames<Memory>{sources_, images_, x, origin_, f.frames.data(), moment_.data()});
    kernels::interpolate("gridmorph::fit::leaves", exec, leaves_,
                         static_cast<kernels::MotionMoments const*>(moment_.data()), group_.data());
    kernels::interpolate_layers("gridmorph::fit::groups", exec, groups_, group_.data());
    launch("gridmorph::fit::missing", exec, 0, n_ends_,
           kernels::LeastSquaresMisses<Memory>{table_, group_.data(), f.u.data(), f.work.data()});
    kernels::interpolate_layers("gridmorph::fit::layers", exec, layers_, f.work.data());
    launch("gridmorph::fit", exec, n_ends_, table_.rows.size(),
           kernels::LeastSquaresAndMissing<Memory>{table_, fade_, group_.data(), f.work.data(), f.u.data()});
  }

  void transpose(Exec const& exec, Baseline const& x, StageField<Exec> const&, StageField<Exec> const& g) const {
    using kernels::launch;
    clear<Vec3>(exec, g.work);
    clear<Vec3>(exec, g.read);
    launch("gridmorph::transposed::fit", exec,
           kernels::FieldAndMissingBack<Memory>{nodes_, shares_, g.u.data(), g.work.data(), g.read.data()});
    kernels::gather_layers("gridmorph::transposed::fit::layers", exec, layers_back_, g.work.data());
    launch("gridmorph::transposed::fit::missing", exec,
           kernels::FieldMissesBack<Memory>{ends_, g.work.data(), g.u.data(), g.read.data()});
    clear<kernels::MotionMoments>(exec, group_);
    clear<kernels::MotionMoments>(exec, moment_);
    launch("gridmorph::transposed::fit::nodes", exec,
           kernels::GroupsFromLeastSquares<Memory>{readers_of_groups_, table_, g.read.data(), group_.data()});
    kernels::gather_layers("gridmorph::transposed::fit::groups", exec, groups_back_, group_.data());
    kernels::gather_rows("gridmorph::transposed::fit::leaves", exec, leaves_back_,
                         static_cast<kernels::MotionMoments const*>(group_.data()), moment_.data());
    launch("gridmorph::transposed::fit::walls", exec,
           kernels::FramesFromMoments<Memory>{sources_, images_, x, origin_, moment_.data(), g.frames.data()});
    launch("gridmorph::transposed::fit::beside", exec,
           kernels::FramesToSlots<Memory>{beside_, g.frames.data() + n_driving_, g.given.data()});
  }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }
  static List<Exec, kernels::WallImage> upload_images(Exec const& exec, UnstructuredPlan const& plan) {
    std::vector<kernels::WallImage> images;
    for (RigidTransform const& image : plan.fit.images) images.push_back({image.rotation, image.translation});
    return upload_now(exec, images, "images");
  }
  /// A list that ends with the call. Fences.
  template <class T>
  static List<Exec, T> upload_now(Exec const& exec, std::vector<T> const& list, char const* what) {
    auto const out = upload(exec, list, name(what));
    compat::fence(exec, "gridmorph::NearFit (host tables may go)");
    return out;
  }

  List<Exec, Index32> sources_, beside_;
  Index n_driving_;
  kernels::InterpolationTable<Memory> leaves_;
  kernels::LayerTable<Memory> groups_;
  List<Exec, kernels::WallImage> images_;
  Vec3 origin_;
  kernels::LeastSquaresTable<Memory> table_;
  kernels::LayerTable<Memory> layers_;
  List<Exec, float> fade_;
  List<Exec, kernels::MotionMoments> moment_, group_;
  Index n_ends_;  ///< rows of the ends of columns, where layers begin; they come first
  List<Exec, Index32> ends_, nodes_;
  List<Exec, float> shares_;
  kernels::TransposedLayers<Memory> layers_back_, groups_back_;
  kernels::TransposedRows<Memory> readers_of_groups_, leaves_back_;
};

}  // namespace gridmorph::stages
