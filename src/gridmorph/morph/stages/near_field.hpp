// Second stage of an unstructured morph: the walls' motion between them, smooth, and layer by layer what that misses.
#pragma once

#include <gridmorph/kernels/lattice_field.hpp>
#include <gridmorph/morph/stages/smooth_field.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/morph/stages/transposed_tables.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <algorithm>
#include <optional>
#include <utility>

namespace gridmorph::stages {

/// Linear in the walls' motions.
template <class Exec>
class NearField {
 public:
  static inline std::string const region = "gridmorph::NearField";

  /// back: positions of all nodes, where the transpose is asked for.
  NearField(Exec const& exec, UnstructuredPlan const& plan, std::vector<Vec3> const* back)
      : seeds_{upload_sources(exec, plan.driving, plan.near, plan.n_nodes, name("driving")),
               upload_sources(exec, plan.columns.node, plan.near, plan.n_nodes, name("columns"))},
        beside_(upload(exec, plan.beside_slots, name("beside"))),
        n_driving_(Index(plan.driving.size())),
        walls_(exec, plan.walls, name("walls")),
        layers_(upload(exec, plan.near, name("layers"))) {
    list_nodes(exec, plan);
    if (back == nullptr) return;
    layers_back_ = transposed(exec, plan.near, plan.n_nodes, name("layers_back"));
    std::vector<Index32> readers = plan.near.rows.target;
    for (auto const* nodes : {&plan.driving, &plan.columns.node})
      readers.insert(readers.end(), nodes->begin(), nodes->end());
    walls_back_.emplace(exec, plan.walls, std::move(readers), *back, name("walls_back"));
  }

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    using kernels::launch;
    launch("gridmorph::near::beside", exec,
           kernels::FramesFromSlots<Memory>{beside_, f.boundary, f.frames.data() + n_driving_});
    walls_.enqueue(exec, f.frames.data());
    for (auto const& nodes : seeds_)
      launch("gridmorph::near::missing", exec,
             kernels::FieldMisses<Memory>{nodes, walls_.field(), x, f.u.data(), f.work.data()});
    kernels::interpolate_layers("gridmorph::near::layers", exec, layers_, f.work.data());
    launch("gridmorph::near", exec,
           kernels::FieldAndMissing<Memory>{node_, fade_, walls_.field(), x, f.work.data(), f.u.data()});
  }

  void transpose(Exec const& exec, Baseline const& x, StageField<Exec> const&, StageField<Exec> const& g) const {
    using kernels::launch;
    clear<Vec3>(exec, g.work);
    clear<Vec3>(exec, g.read);
    launch("gridmorph::transposed::near", exec,
           kernels::FieldAndMissingBack<Memory>{node_, fade_, g.u.data(), g.work.data(), g.read.data()});
    kernels::gather_layers("gridmorph::transposed::near::layers", exec, layers_back_, g.work.data());
    for (auto const& nodes : seeds_)
      launch("gridmorph::transposed::near::missing", exec,
             kernels::FieldMissesBack<Memory>{nodes, g.work.data(), g.u.data(), g.read.data()});
    walls_back_->enqueue(exec, x, g.read.data(), g.frames.data());
    launch("gridmorph::transposed::near::beside", exec,
           kernels::FramesToSlots<Memory>{beside_, g.frames.data() + n_driving_, g.given.data()});
  }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }

  /// The nodes of all layers in the order of their numbers: layer by layer a cache line would be read once per layer
  /// that has nodes in it. Fences.
  void list_nodes(Exec const& exec, UnstructuredPlan const& plan) {
    std::vector<std::pair<Index32, float>> nodes;
    for (std::size_t r = 0; r < plan.near_fade.size(); ++r)
      nodes.emplace_back(plan.near.rows.target[r], plan.near_fade[r]);
    std::sort(nodes.begin(), nodes.end());
    std::vector<Index32> node;
    std::vector<float> fade;
    for (auto const& [n, f] : nodes) {
      node.push_back(n);
      fade.push_back(f);
    }
    node_ = upload(exec, node, name("node"));
    fade_ = upload(exec, fade, name("fade"));
    compat::fence(exec, "gridmorph::NearField (host tables may go)");
  }

  List<Exec, Index32> seeds_[2];  ///< on moving walls and at the ends of their columns, where layers begin
  List<Exec, Index32> beside_;
  Index n_driving_;
  SmoothField<Exec, kernels::AffineMotion> walls_;
  kernels::LayerTable<Memory> layers_;
  List<Exec, Index32> node_;  ///< of layers_
  List<Exec, float> fade_;
  kernels::TransposedLayers<Memory> layers_back_;
  std::optional<SmoothFieldBack<Exec, kernels::AffineMotion>> walls_back_;
};

}  // namespace gridmorph::stages
