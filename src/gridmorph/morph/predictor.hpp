// Predictions of one mesh and motion for any order of chains.
#pragma once

#include <gridmorph/morph/prediction.hpp>
#include <gridmorph/plan/coarse_plan.hpp>

#include <vector>

namespace gridmorph {

/// Borrows what was prepared.
class Predictor {
 public:
  Predictor(HostInstance const& host, PreparedMorph const& prepared, PredictionOptions const& options);

  /// first: order of chains, as in make_plan(). Of names of chains it has the stage alone.
  [[nodiscard]] Prediction predict(ChainOrder const& first, std::span<Vec3 const> boundary);
  /// Of the plan prepared, with its names.
  [[nodiscard]] Prediction predict(std::span<Vec3 const> boundary);

 private:
  [[nodiscard]] Coordinates morphed(Plan const& plan, std::span<Vec3 const> boundary) const;
  [[nodiscard]] Prediction measure(Plan const& plan, Plan const& names, Coordinates const& morphed) const;
  [[nodiscard]] Prediction predict(ChainOrder const& first, std::span<Vec3 const> boundary, Plan const* names);
  void add(CellBox const& box, Coordinates const& morphed, std::vector<char>& seen, PredictedCells& out) const;

  HostInstance host_;
  PreparedMorph const& prepared_;
  CoarsePlanner planner_;
  std::vector<int> handedness_;  ///< per zone
};

}  // namespace gridmorph
