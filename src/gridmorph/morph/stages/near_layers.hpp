// Second stage of an unstructured morph, by layers: what walls and the ends of their columns do, turns included, passed
// on node by node.
#pragma once

#include <gridmorph/kernels/layer_motion.hpp>
#include <gridmorph/morph/stages/columns_of_walls.hpp>
#include <gridmorph/morph/stages/stage_field.hpp>
#include <gridmorph/morph/stages/transposed_tables.hpp>
#include <gridmorph/plan/unstructured_plan.hpp>

#include <vector>

namespace gridmorph::stages {

/// Linear in the walls' motions. Workspace: 96 bytes per node of the near field.
template <class Exec>
class NearLayers {
 public:
  static inline std::string const region = "gridmorph::NearLayers";

  /// back: where the transpose is asked for.
  NearLayers(Exec const& exec, UnstructuredPlan const& plan, std::vector<Vec3> const* back)
      : NearLayers(exec, plan, in_places(plan), back != nullptr) {}

  void enqueue(Exec const& exec, Baseline const& x, StageField<Exec> const& f) const {
    using kernels::launch;
    launch("gridmorph::near::seeds", exec,
           kernels::SeedMotions<Memory>{column_, root_, share_, n_walls_, f.u.data(), f.frames.data(), motion_.data()});
    kernels::PassMotions<Memory> const pass{layers_.rows, node_, turn_, x, motion_.data(), f.u.data()};
    for (std::size_t l = 0; l + 1 < layers_.level.size(); ++l)
      launch("gridmorph::near::layers", exec, layers_.level[l], layers_.level[l + 1], pass);
  }

  void transpose(Exec const& exec, Baseline const& x, StageField<Exec> const&, StageField<Exec> const& g) const {
    using kernels::launch;
    clear<kernels::AffineMotion>(exec, motion_);
    launch("gridmorph::transposed::near", exec,
           kernels::MotionsFromNodes<Memory>{layers_.rows.target, node_, g.u.data(), motion_.data()});
    kernels::PassMotionsBack<Memory> const pass{layers_back_.rows, node_, kept_, x, motion_.data()};
    for (std::size_t l = 0; l + 1 < layers_back_.level.size(); ++l)
      launch("gridmorph::transposed::near::layers", exec, layers_back_.level[l], layers_back_.level[l + 1], pass);
    launch("gridmorph::transposed::near::seeds", exec,
           kernels::SeedMotionsBack<Memory>{
               {column_, root_, share_}, columns_of_, n_walls_, motion_.data(), g.frames.data(), g.u.data()});
  }

 private:
  using Memory = typename Exec::memory_space;
  static std::string name(char const* what) { return region + "::" + what; }

  struct Places {
    std::vector<Index32> node;
    LayerRows layers;  ///< of places
  };
  static Places in_places(UnstructuredPlan const& plan) {
    Places out{{}, plan.near};
    for (auto const* nodes : {&plan.driving, &plan.columns.node, &plan.near.rows.target})
      out.node.insert(out.node.end(), nodes->begin(), nodes->end());
    std::vector<Index32> place(plan.n_nodes, -1);
    for (std::size_t p = 0; p < out.node.size(); ++p) place[out.node[p]] = Index32(p);
    for (auto* nodes : {&out.layers.rows.item, &out.layers.rows.target})
      for (Index32& n : *nodes) n = place[n];
    return out;
  }
  NearLayers(Exec const& exec, UnstructuredPlan const& plan, Places const& places, bool back)
      : column_(upload(exec, plan.columns.node, name("column"))),
        root_(upload(exec, plan.columns.root, name("root"))),
        share_(upload(exec, plan.columns.turn, name("share"))),
        node_(upload(exec, places.node, name("node"))),
        layers_(upload(exec, places.layers, name("layers"))),
        turn_(upload(exec, plan.near_turn, name("turn"))),
        motion_(room_for<kernels::AffineMotion>(exec, places.node.size(), name("motion"))),
        n_walls_(Index(plan.driving.size())) {
    if (back) {
      layers_back_ = transposed(exec, places.layers, Index(places.node.size()), name("layers_back"));
      columns_of_ = columns_of_walls(exec, plan);
      std::vector<float> kept(places.node.size(), 1);
      for (std::size_t r = 0; r < plan.near_turn.size(); ++r) kept[places.layers.rows.target[r]] = plan.near_turn[r];
      kept_ = upload(exec, kept, name("kept"));
      compat::fence(exec, "gridmorph::NearLayers (host tables may go)");
    }
    compat::fence(exec, "gridmorph::NearLayers (host tables may go)");
  }

  List<Exec, Index32> column_, root_;
  List<Exec, float> share_;
  List<Exec, Index32> node_;
  kernels::LayerTable<Memory> layers_;
  List<Exec, float> turn_;
  List<Exec, kernels::AffineMotion> motion_;
  Index n_walls_;
  kernels::TransposedLayers<Memory> layers_back_;  ///< of places
  kernels::ColumnsOf<Memory> columns_of_;
  List<Exec, float> kept_;  ///< (places)
};

}  // namespace gridmorph::stages
