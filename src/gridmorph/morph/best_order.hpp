// The order of chains of which the best is predicted.
#pragma once

#include <gridmorph/morph/prediction.hpp>
#include <gridmorph/plan/prepare.hpp>

#include <span>
#include <string>

namespace gridmorph {

struct FoundOrder {
  ChainOrder order;  ///< of all stages; that of the rules where no better one was found
  PredictedCells by_priority, by_prediction;
  int tried = 0;  ///< plans

  bool better = false;  ///< than the order of the rules
};

/// Where VolumeOptions::order asks for it, or nothing does, looks for the order and the directions of chains with the
/// fewest cells inverted, then the largest smallest scaled Jacobian, then the largest smallest share of it that a cell
/// keeps, as predict() sees them for one displacement of the boundary; none of the three is worse than by the rules.
/// Stage by stage every alternative is tried, what comes after it by the rules, and the best four go on (beam search;
/// its first one is the greedy choice), until nothing is left to choose or 400 plans were tried. Then, where
/// VolumeOptions::laws_by_prediction is set, other laws for single chains and for all of a stage are taken while they
/// make it better, 400 more at most. Deterministic. Cost: a prediction per plan.
FoundOrder find_order(HostInstance const& host, PreparedMorph const& prepared, std::span<Vec3 const> boundary);

/// The same question within the time of some 20 plans of the whole mesh: the chains of all stages in the order of other
/// measures than the rules' (ChainChoice), and the best of these orders with another law for all its chains. Fewer
/// cells inverted count first here, whatever else they cost. Of the best six the first is taken in which
/// predict_closely() would find none.
FoundOrder find_order_quickly(HostInstance const& host, PreparedMorph const& prepared, std::span<Vec3 const> boundary);

/// `some`, which is predict() of a plan, or that of more of its cells where those looked at are sound and one of them
/// keeps less than 0.3 of its scaled Jacobian: its neighbours may keep nothing. All cells are looked at in meshes of up
/// to two million nodes, one in four along each direction up to 20 million, one in eight beyond.
Prediction predict_closely(HostInstance const& host, PreparedMorph const& prepared, std::span<Vec3 const> boundary,
                           Prediction const& some);

/// A prediction of all cells where `some` looked at some of them; of elements `some` itself.
Prediction predict_closely(HostInstance const& host, MorphPlan const& plan, std::span<Vec3 const> boundary,
                           Prediction const& some);

/// Whether no boundary node is displaced.
bool is_at_rest(std::span<Vec3 const> boundary);

/// Where VolumeOptions leave order and law to the library: whether predict_closely() finds inverted cells. Not where
/// nothing moves.
bool is_inverted_by_priority(HostInstance const& host, PreparedMorph const& prepared, std::span<Vec3 const> boundary);
/// Where `some` is predict() already.
bool is_inverted_by_priority(HostInstance const& host, PreparedMorph const& prepared, std::span<Vec3 const> boundary,
                             Prediction const& some);

/// Plans again in the order found, by the search that VolumeOptions ask for, where it is better, and adds a note on
/// what it gains.
FoundOrder plan_by_prediction(HostInstance const& host, PreparedMorph& prepared, std::span<Vec3 const> boundary);

/// "smallest scaled Jacobian 0.31 (0.12 by priority), ..."
std::string describe(FoundOrder const& found);

}  // namespace gridmorph
