#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/morph/best_order.hpp>
#include <gridmorph/morph/predictor.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace gridmorph {
namespace {

/// Smaller is better. Rounded, so that round-off decides nothing.
std::tuple<Index, long long, long long> score(PredictedCells const& cells) {
  auto const rounded = [](double value) { return std::llround(-1e6 * value); };
  return {cells.inverted, rounded(cells.scaled_jacobian.value), rounded(cells.kept.value)};
}

bool is_no_worse(PredictedCells const& a, PredictedCells const& b) {
  return a.inverted <= b.inverted && a.scaled_jacobian.value >= b.scaled_jacobian.value && a.kept.value >= b.kept.value;
}

class Search {
 public:
  Search(HostInstance const& host, PreparedMorph const& prepared, std::span<Vec3 const> boundary)
      : predictor_(host, prepared, {}), boundary_(boundary) {
    OrderTrial rules = predictor_.try_order({}, boundary);
    best_ = {rules.order, rules.prediction.all, rules.prediction.all, 1, false};
    beam_.push_back({{}, std::move(rules)});
  }

  void choose_order() {
    while (!beam_.empty() && best_.tried < most_plans) advance();
  }
  /// Chain by chain, those that come out worst first, until no other law is better.
  void choose_laws() {
    int const most = best_.tried + most_plans;
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t stage = 0; stage < best_.order.size(); ++stage) {
        for (std::size_t chain = 0; chain < best_.order[stage].size(); ++chain)
          for (Law const law : {Law::linear, Law::c1, Law::c2, Law::mixed, Law::matched})
            if (best_.tried < most) changed = accept(with_law(stage, chain, law)) || changed;
        for (Law const law : {Law::linear, Law::c1, Law::c2, Law::mixed, Law::matched})
          if (best_.tried < most) changed = accept(with_law(stage, law)) || changed;
      }
    }
  }
  [[nodiscard]] FoundOrder result() && { return std::move(best_); }

 private:
  static constexpr std::size_t width = 4;
  static constexpr int most_plans = 400;

  struct Path {
    ChainOrder first;  ///< chosen
    OrderTrial trial;  ///< with the rest by priority
  };

  /// One chain of a stage in a stage of its own, since those of one may share lines.
  [[nodiscard]] ChainOrder with_law(std::size_t stage, std::size_t chain, Law law) const {
    ChainOrder order = best_.order;
    if (chain >= order[stage].size()) return {};
    ChainPlace place = order[stage][chain];
    place.law = law;
    if (order[stage].size() == 1) {
      order[stage][0] = place;
      return order;
    }
    order[stage].erase(order[stage].begin() + std::ptrdiff_t(chain));
    order.insert(order.begin() + std::ptrdiff_t(stage) + 1, {place});
    return order;
  }
  [[nodiscard]] ChainOrder with_law(std::size_t stage, Law law) const {
    ChainOrder order = best_.order;
    for (ChainPlace& place : order[stage]) place.law = law;
    return order;
  }

  /// Takes an order if it is better.
  bool accept(ChainOrder const& order) {
    if (order.empty() || !begun_.insert(order).second) return false;
    OrderTrial trial;
    try {
      trial = predictor_.try_order(order, boundary_);
    } catch (PlanError const&) {
      return false;
    }
    ++best_.tried;
    return take(trial);
  }
  bool take(OrderTrial const& trial) {
    PredictedCells const& cells = trial.prediction.all;
    if (!is_no_worse(cells, best_.by_priority) || score(cells) >= score(best_.by_prediction)) return false;
    best_.by_prediction = cells;
    best_.order = trial.order;
    best_.better = true;
    return true;
  }

  /// One stage more.
  void advance() {
    std::vector<Path> longer;
    for (Path& path : beam_) {
      std::size_t const depth = path.first.size();
      if (depth >= path.trial.order.size()) continue;
      // What comes next by priority is a choice too.
      path.trial.next.insert(path.trial.next.begin(), path.trial.order[depth]);
      for (auto const& stage : path.trial.next) extend(path.first, stage, longer);
    }
    std::stable_sort(longer.begin(), longer.end(), [](Path const& a, Path const& b) {
      return score(a.trial.prediction.all) < score(b.trial.prediction.all);
    });
    if (longer.size() > width) longer.resize(width);
    beam_ = std::move(longer);
  }

  void extend(ChainOrder first, std::vector<ChainPlace> const& stage, std::vector<Path>& longer) {
    first.push_back(stage);
    if (best_.tried >= most_plans || !begun_.insert(first).second) return;
    OrderTrial trial;
    try {
      trial = predictor_.try_order(first, boundary_);
    } catch (PlanError const&) {
      return;  // what is left has no chain to known faces
    }
    ++best_.tried;
    // Chains that get in each other's way are not taken together.
    std::copy_n(trial.order.begin(), first.size(), first.begin());
    begun_.insert(first);
    if (!reached_.insert(state(first, trial.prediction.all)).second) return;
    take(trial);
    longer.push_back({std::move(first), std::move(trial)});
  }

  /// The same chains in another order that comes out the same are no other way.
  using State = std::pair<std::vector<ChainPlace>, std::tuple<Index, long long, long long>>;
  static State state(ChainOrder const& first, PredictedCells const& cells) {
    std::vector<ChainPlace> places;
    for (auto const& stage : first) places.insert(places.end(), stage.begin(), stage.end());
    std::sort(places.begin(), places.end());
    return {std::move(places), score(cells)};
  }

  Predictor predictor_;
  std::span<Vec3 const> boundary_;
  FoundOrder best_;
  std::vector<Path> beam_;
  std::set<ChainOrder> begun_;
  std::set<State> reached_;
};

}  // namespace

FoundOrder find_order(HostInstance const& host, PreparedMorph const& prepared, std::span<Vec3 const> boundary) {
  VolumeOptions const& options = prepared.options.volume;
  Search search(host, prepared, boundary);
  if (options.order == OrderBy::prediction || !options.laws_by_prediction) search.choose_order();
  if (options.laws_by_prediction) search.choose_laws();
  return std::move(search).result();
}

FoundOrder plan_by_prediction(HostInstance const& host, PreparedMorph& prepared, std::span<Vec3 const> boundary) {
  FoundOrder found = find_order(host, prepared, boundary);
  if (found.better)
    prepared.planned = make_plan(host, prepared.mesh, prepared.links, prepared.surface, prepared.options, found.order);
  prepared.planned.plan.notes.push_back(describe(found));
  return found;
}

std::string describe(FoundOrder const& found) {
  if (!found.better)
    return "of " + std::to_string(found.tried) +
           " orders and laws of chains none is predicted to be better than that by priority";
  PredictedCells const &now = found.by_prediction, &before = found.by_priority;
  auto const pair = [](double a, double b) { return to_text(a, 3) + " (" + to_text(b, 3) + " by priority)"; };
  return "order and laws of chains by prediction, the best of " + std::to_string(found.tried) +
         " plans tried: smallest scaled Jacobian " + pair(now.scaled_jacobian.value, before.scaled_jacobian.value) +
         ", smallest share of it kept " + pair(now.kept.value, before.kept.value) + ", cells inverted " +
         std::to_string(now.inverted) + " (" + std::to_string(before.inverted) + ")";
}

}  // namespace gridmorph
