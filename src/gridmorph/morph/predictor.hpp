// Predictions of one mesh and motion for any order of chains.
#pragma once

#include <gridmorph/morph/prediction.hpp>
#include <gridmorph/plan/coarse_plan.hpp>

#include <utility>
#include <vector>

namespace gridmorph {

/// What an order of chains leads to.
struct OrderTrial {
  ChainOrder order;  ///< of all stages
  ChainOrder next;   ///< what the stage after the ones given could have been
  Prediction prediction;
};

/// Borrows what was prepared.
class Predictor {
 public:
  Predictor(HostInstance const& host, PreparedMorph const& prepared, PredictionOptions const& options);

  /// first: order of chains, as in make_plan(). Nodes in names of chains are numbered among those sampled.
  [[nodiscard]] OrderTrial try_order(ChainOrder const& first, std::span<Vec3 const> boundary,
                                     ChainChoice choice = ChainChoice::rules);
  /// Of the plan prepared, with its names.
  [[nodiscard]] Prediction predict(std::span<Vec3 const> boundary);

 private:
  [[nodiscard]] Coordinates morphed(Plan const& plan, std::span<Vec3 const> boundary) const;
  [[nodiscard]] Prediction measure(Plan const& plan, Plan const& names, Coordinates const& morphed) const;
  void add(CellBox const& box, Coordinates const& morphed, std::vector<char>& seen, PredictedCells& out) const;

  HostInstance host_;
  PreparedMorph const& prepared_;
  CoarsePlanner planner_;
  std::vector<int> handedness_;  ///< per zone
};

/// Of a series of motions at most so many are predicted, spread evenly: they take the time of a plan.
inline constexpr int most_predicted = 100;

/// The worst of several motions of one plan, by the smallest scaled Jacobian. Borrows what was prepared.
class WorstPrediction {
 public:
  WorstPrediction(HostInstance const& host, PreparedMorph const& prepared) : predictor_(host, prepared, {}) {}
  /// plan: of blocks.
  WorstPrediction(HostInstance const& host, MorphPlan const& plan);

  /// boundary: displacements of Plan::boundary_nodes at that step.
  void look_at(int step, std::vector<Vec3> boundary) {
    Prediction now = predictor_.predict(boundary);
    if (!boundary_.empty() && !(now.all.scaled_jacobian.value < prediction_.all.scaled_jacobian.value)) return;
    prediction_ = std::move(now);
    step_ = step;
    boundary_ = std::move(boundary);
  }

  [[nodiscard]] Prediction const& prediction() const { return prediction_; }
  [[nodiscard]] int step() const { return step_; }
  [[nodiscard]] std::vector<Vec3> const& boundary() const { return boundary_; }

 private:
  Predictor predictor_;
  Prediction prediction_;
  int step_ = 0;
  std::vector<Vec3> boundary_;
};

}  // namespace gridmorph
