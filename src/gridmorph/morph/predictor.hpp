// Predictions of one mesh for many displacements of its boundary, and of blocks for any order of chains.
#pragma once

#include <gridmorph/morph/prediction.hpp>
#include <gridmorph/plan/coarse_plan.hpp>

#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace gridmorph {

/// Takes the worst of both; of equal ones the first.
void join(PredictedCells& all, PredictedCells const& some);
/// By the smallest scaled Jacobian, of elements by the smallest share kept.
bool is_worse(PredictedCells const& a, PredictedCells const& b);
void sort_worst_first(std::vector<PredictedGroup>& groups);

/// predict() of one mesh and plan for any displacement of the boundary: what predictions share is made once. Serves one
/// call at a time; keeps mesh and plan.
using PredictionOf = std::function<Prediction(std::span<Vec3 const> boundary)>;
PredictionOf predictions(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan,
                         PredictionOptions const& options = {});
PredictionOf predictions_of_elements(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan,
                                     PredictionOptions const& options);

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
  /// The prediction of the plan prepared, with its names.
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

/// The worst of several motions of one plan.
class WorstPrediction {
 public:
  explicit WorstPrediction(PredictionOf of) : of_(std::move(of)) {}

  /// boundary: displacements of MorphPlan::boundary_nodes() at that step.
  void look_at(int step, std::vector<Vec3> boundary) {
    Prediction now = of_(boundary);
    if (step_ >= 0 && !is_worse(now.all, prediction_.all)) return;
    prediction_ = std::move(now);
    step_ = step;
    boundary_ = std::move(boundary);
  }

  [[nodiscard]] Prediction const& prediction() const { return prediction_; }
  [[nodiscard]] int step() const { return step_; }
  [[nodiscard]] std::vector<Vec3> const& boundary() const { return boundary_; }

 private:
  PredictionOf of_;
  Prediction prediction_;
  int step_ = -1;  ///< -1: none was looked at
  std::vector<Vec3> boundary_;
};

}  // namespace gridmorph
