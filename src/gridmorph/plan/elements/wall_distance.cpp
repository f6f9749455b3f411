#include <gridmorph/core/for_all.hpp>
#include <gridmorph/plan/elements/wall_distance.hpp>
#include <gridmorph/plan/place_order.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>

namespace gridmorph {

namespace {

/// The source that a node takes for its nearest one, and its distance.
struct Found {
  double squared = std::numeric_limits<double>::infinity();  ///< distance
  Index32 source = -1;                                       ///< place in the list of sources; their number: none
};

/// Sweeps over fronts of nodes. All nodes of a sweep look at what was known before it, so neither the order of a front
/// nor the number of threads matters.
class Spreading {
 public:
  Spreading(HostInstance const& host, Coordinates const& coordinates, NodeGraph const& graph,
            std::vector<Index32> const& sources)
      : host_(host),
        coordinates_(coordinates),
        graph_(graph),
        sources_(sources),
        is_before_(coordinates),
        none_{std::numeric_limits<double>::infinity(), Index32(sources.size())},
        source_(std::size_t(graph.size()), none_.source),
        squared_(source_.size(), none_.squared),
        listed_(source_.size(), 0),
        waits_(source_.size(), Waits::no) {
    place_.reserve(sources.size());
    for (Index32 const s : sources) place_.push_back(coordinates[s]);
  }

  NearestSource run() {
    std::vector<Change> changes;
    for (std::size_t s = 0; s < sources_.size(); ++s)
      if (source_[sources_[s]] == none_.source) {
        source_[sources_[s]] = Index32(s);
        changes.push_back({sources_[s], {0, Index32(s)}});
      }
    while (!changes.empty()) {
      take(changes);
      changes = spread(changes);
      if (changes.empty()) changes = go_further();
    }
    descend();
    NearestSource out;
    out.source.resize(source_.size());
    out.distance.resize(source_.size());
    detail::for_all(host_, "gridmorph::nearest_source::write", std::ssize(source_), [&](Index n) {
      Index32 const s = source_[n];
      out.source[n] = s == none_.source ? -1 : sources_[s];
      out.distance[n] = std::sqrt(squared_[n]);
    });
    return out;
  }

 private:
  struct Change {
    Index32 node;
    Found found;
  };
  enum class Waits : std::uint8_t { no, as_known, offered_more };

  // Steps of PlaceOrder::rounded are below 1e-4: squares further apart than that say the same.
  static constexpr double clearly_more = (1 + 1e-4) * (1 + 1e-4), clearly_less = (1 - 1e-4) * (1 - 1e-4);

  [[nodiscard]] double squared(Vec3 const& x, Index32 source) const {
    Vec3 const d = x - place_[source];
    return dot(d, d);
  }

  /// Whether a source is nearer than another one; sources as far but for round-off go by their places. An order of all
  /// sources.
  [[nodiscard]] bool is_better(Found const& a, Found const& than) const {
    if (a.squared > than.squared * clearly_more) return false;
    if (a.squared < than.squared * clearly_less) return true;
    double const d = is_before_.rounded_steps(std::sqrt(a.squared)),
                 other = is_before_.rounded_steps(std::sqrt(than.squared));
    return d < other || (d == other && is_before_(sources_[a.source], sources_[than.source]));
  }

  /// The best of what a node has and of what its neighbours have.
  [[nodiscard]] Found best(Index32 node) const {
    Vec3 const x = coordinates_[node];
    Found nearest{squared_[node], source_[node]};
    Index32 last = none_.source;  // many neighbours have the same one
    for (Index32 const m : graph_.neighbours[node]) {
      Index32 const s = source_[m];
      if (s == none_.source || s == nearest.source || s == last) continue;
      last = s;
      if (Found const there{squared(x, s), s}; is_better(there, nearest)) nearest = there;
    }
    return nearest;
  }

  /// Gathers what list(k, out) adds for 0 <= k < count, part by part side by side.
  template <class Item, class List>
  std::vector<Item> gather(char const* label, Index count, List const& list) {
    constexpr Index part = 256;
    std::vector<std::vector<Item>> lists((count + part - 1) / part);
    auto const one = [&](Index p) {
      for (Index k = p * part; k < std::min(count, (p + 1) * part); ++k) list(k, lists[p]);
    };
    if (lists.empty()) return {};
    if (lists.size() == 1) {
      one(0);
      return std::move(lists[0]);
    }
    detail::for_all_parts(host_, label, std::ssize(lists), one);
    std::vector<Item> out;
    std::size_t size = 0;
    for (auto const& own : lists) size += own.size();
    out.reserve(size);
    for (auto const& own : lists) out.insert(out.end(), own.begin(), own.end());
    return out;
  }

  void take(std::vector<Change> const& changes) {
    detail::for_all(host_, "gridmorph::nearest_source::take", std::ssize(changes), [&](Index k) {
      auto const& [node, found] = changes[k];
      source_[node] = found.source;
      squared_[node] = found.squared;
    });
    ++sweep_;
  }

  /// Neighbours for which changes are better than what they have; those that they are too far for, as yet, wait.
  [[nodiscard]] std::vector<Change> spread(std::vector<Change> const& changes) {
    std::vector<Change> out;
    auto const offered = gather<Change>(
        "gridmorph::nearest_source::spread", std::ssize(changes), [&](Index k, std::vector<Change>& out) {
          Index32 const source = changes[k].found.source;
          for (Index32 const m : graph_.neighbours[changes[k].node]) {
            Found const own{squared_[m], source_[m]};
            if (own.source == source || own.squared == 0) continue;
            Found const offer{squared(coordinates_[m], source), source};
            if (own.source == none_.source && offer.squared > reach_) {
              std::atomic_ref<Waits> const waits(waits_[m]);
              if (waits.load(std::memory_order_relaxed) != Waits::offered_more &&
                  waits.exchange(Waits::offered_more, std::memory_order_relaxed) == Waits::no)
                out.push_back({m, none_});
              continue;
            }
            if (own.source != none_.source && !is_better(offer, own)) continue;
            std::atomic_ref<Index32> const listed(listed_[m]);
            // A node beside several changes is listed once. Whichever comes first does it: best() looks at all
            // neighbours.
            if (listed.load(std::memory_order_relaxed) == sweep_ ||
                listed.exchange(sweep_, std::memory_order_relaxed) == sweep_)
              continue;
            out.push_back({m, best(m)});
          }
        });
    for (Change const& c : offered) (c.found.source == none_.source ? waiting_ : out).push_back(c);
    return out;
  }

  /// What comes next when all within reach is known: the nearest of the nodes that wait, and those hardly further away.
  [[nodiscard]] std::vector<Change> go_further() {
    detail::for_all(host_, "gridmorph::nearest_source::go_further", std::ssize(waiting_), [&](Index k) {
      auto& [node, found] = waiting_[k];
      Waits& waits = waits_[node];
      if (source_[node] != none_.source)
        found = none_;
      else if (waits == Waits::offered_more)
        found = best(node);
      waits = Waits::as_known;
    });
    std::erase_if(waiting_, [&](Change const& c) { return c.found.source == none_.source; });
    // Too little makes for many sweeps, too much for sources that come late; no ratio of lengths in a lattice.
    constexpr double further = 1.4937;
    reach_ = none_.squared;
    for (Change const& c : waiting_) reach_ = std::min(reach_, further * c.found.squared);
    std::vector<Change> out;
    std::erase_if(waiting_, [&](Change const& c) {
      bool const within = c.found.squared <= reach_;
      if (within) out.push_back(c);
      return within;
    });
    return out;
  }

  /// Goes on from source to source downhill, from the one that a node has: among sources that edges join the nearest
  /// may not have got through.
  void descend() {
    std::vector<Index32> place(source_.size(), none_.source), row;
    for (std::size_t s = 0; s < sources_.size(); ++s) place[sources_[s]] = Index32(s);
    CsrGraph beside;
    for (Index32 const s : sources_) {
      row.clear();
      for (Index32 const m : graph_.neighbours[s])
        if (place[m] != none_.source) row.push_back(place[m]);
      beside.add(row);
    }
    detail::for_all(host_, "gridmorph::nearest_source::descend", std::ssize(source_), [&](Index n) {
      Found own{squared_[n], source_[n]};
      if (own.source == none_.source || own.squared == 0) return;
      Vec3 const x = coordinates_[n];
      for (Index32 before = none_.source; before != own.source;) {
        before = own.source;
        for (Index32 const m : beside[before])
          if (Found const there{squared(x, m), m}; is_better(there, own)) own = there;
      }
      squared_[n] = own.squared;
      source_[n] = own.source;
    });
  }

  HostInstance host_;
  Coordinates const& coordinates_;
  NodeGraph const& graph_;
  std::vector<Index32> const& sources_;
  PlaceOrder is_before_;
  Found none_;
  std::vector<Vec3> place_;  ///< of the sources
  std::vector<Index32> source_;
  std::vector<double> squared_;
  std::vector<Index32> listed_;  ///< in which sweep a node was last a change
  std::vector<Waits> waits_;
  std::vector<Change> waiting_;  ///< nodes beside what is known, too far away as yet
  double reach_ = 0;             ///< squared
  Index32 sweep_ = 0;
};

}  // namespace

NearestSource nearest_source(HostInstance const& host, Coordinates const& coordinates, NodeGraph const& graph,
                             std::vector<Index32> const& sources) {
  return Spreading(host, coordinates, graph, sources).run();
}

}  // namespace gridmorph
