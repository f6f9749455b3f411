#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/morph/best_order.hpp>
#include <gridmorph/morph/plan_access.hpp>
#include <gridmorph/morph/predictor.hpp>
#include <gridmorph/plan/common_parts.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
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

/// One cell in so many along each direction that a closer look takes: all of them where there are few.
int close_sample(Mesh const& mesh) {
  constexpr Index few = 2'000'000, many = 20'000'000;
  Index const n = mesh.n_nodes();
  return n <= few ? 1 : n <= many ? 4 : 8;
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
  /// All stages by one measure at a time, then laws for all chains of the best of these.
  void choose_quickly() {
    for (ChainChoice const choice :
         {ChainChoice::long_first, ChainChoice::many_blocks, ChainChoice::short_first, ChainChoice::few_blocks,
          ChainChoice::blunt_first, ChainChoice::sharp_first, ChainChoice::weakest_ends})
      attempt([&] { return predictor_.try_order({}, boundary_, choice); });
    ChainOrder const order = best_.order;
    for (Law const law : {Law::matched, Law::mixed, Law::c1}) {
      ChainOrder other = order;
      for (auto& stage : other)
        for (ChainPlace& place : stage) place.law = law;
      attempt([&] { return predictor_.try_order(other, boundary_); });
    }
  }
  /// Of the best of these the first that a closer look finds sound, or the best of the few that it looks at.
  void look_closely(HostInstance const& host, PreparedMorph const& prepared) {
    constexpr std::size_t few = 6;
    std::ranges::stable_sort(quick_, {}, [](OrderTrial const& t) { return score(t.prediction.all); });
    Predictor close(host, prepared, {.every = close_sample(prepared.mesh)});
    auto const look = [&](ChainOrder const& order) {
      ++best_.tried;
      return close.try_order(order, boundary_).prediction.all;
    };
    ChainOrder const& rules = beam_.front().trial.order;
    best_ = {rules, look(rules), {}, best_.tried, false};
    best_.by_prediction = best_.by_priority;
    for (std::size_t n = 0; n < std::min(few, quick_.size()) && best_.by_prediction.inverted > 0; ++n) {
      PredictedCells const cells = look(quick_[n].order);
      if (score(cells) < score(best_.by_prediction))
        best_ = {quick_[n].order, best_.by_priority, cells, best_.tried, true};
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

  /// Takes what a trial comes to if it is better by the score alone.
  void attempt(std::function<OrderTrial()> const& make) {
    try {
      OrderTrial const trial = make();
      ++best_.tried;
      quick_.push_back(trial);
      if (score(trial.prediction.all) >= score(best_.by_prediction)) return;
      best_.by_prediction = trial.prediction.all;
      best_.order = trial.order;
      best_.better = true;
    } catch (PlanError const&) {  // leaves blocks that nothing reaches
    }
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
  std::vector<OrderTrial> quick_;  ///< what choose_quickly() tried
  std::set<ChainOrder> begun_;
  std::set<State> reached_;
};

}  // namespace

bool is_at_rest(std::span<Vec3 const> boundary) {
  return std::ranges::all_of(boundary, [](Vec3 const& u) { return u == Vec3{}; });
}

FoundOrder find_order(HostInstance const& host, PreparedMorph const& prepared, std::span<Vec3 const> boundary) {
  VolumeOptions const& options = prepared.options.volume;
  Search search(host, prepared, boundary);
  if (options.order == OrderBy::prediction || !options.laws_by_prediction) search.choose_order();
  if (options.laws_by_prediction) search.choose_laws();
  return std::move(search).result();
}

FoundOrder find_order_quickly(HostInstance const& host, PreparedMorph const& prepared, std::span<Vec3 const> boundary) {
  Search search(host, prepared, boundary);
  search.choose_quickly();
  search.look_closely(host, prepared);
  return std::move(search).result();
}

Prediction predict_closely(HostInstance const& host, PreparedMorph const& prepared, std::span<Vec3 const> boundary,
                           Prediction const& some) {
  constexpr double little = 0.3;
  int const every = close_sample(prepared.mesh);
  if (some.all.inverted > 0 || some.every <= every || !(some.all.kept.value < little)) return some;
  return Predictor(host, prepared, {.every = every}).predict(boundary);
}

Prediction predict_closely(HostInstance const& host, MorphPlan const& plan, std::span<Vec3 const> boundary,
                           Prediction const& some) {
  PreparedMorph const* const blocks = PlanAccess::blocks(plan);
  return blocks != nullptr ? predict_closely(host, *blocks, boundary, some) : some;
}

bool is_inverted_by_priority(HostInstance const& host, PreparedMorph const& prepared, std::span<Vec3 const> boundary,
                             Prediction const& some) {
  return !is_at_rest(boundary) && predict_closely(host, prepared, boundary, some).all.inverted > 0;
}

bool is_inverted_by_priority(HostInstance const& host, PreparedMorph const& prepared, std::span<Vec3 const> boundary) {
  if (is_at_rest(boundary)) return false;
  return is_inverted_by_priority(host, prepared, boundary, Predictor(host, prepared, {}).predict(boundary));
}

FoundOrder plan_by_prediction(HostInstance const& host, PreparedMorph& prepared, std::span<Vec3 const> boundary) {
  bool const by_itself = !prepared.options.volume.by_prediction();
  FoundOrder found = by_itself ? find_order_quickly(host, prepared, boundary) : find_order(host, prepared, boundary);
  if (found.better) {
    PlannedMorph planned =
        make_plan(host, prepared.mesh, prepared.links, prepared.surface, prepared.options, found.order);
    carry_common_motions(prepared, planned);
    prepared.planned = std::move(planned);
  }
  std::string const why = by_itself ? "by priority cells would be inverted: " : "";
  prepared.planned.plan.notes.push_back(why + describe(found));
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
