// Predictions of one mesh and motion for any order of chains.
#pragma once

#include <gridmorph/morph/prediction.hpp>
#include <gridmorph/plan/coarse_plan.hpp>

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

}  // namespace gridmorph
