#include <gridmorph/motion/target/edge_images.hpp>

#include <gridmorph/geometry/affine_fit.hpp>
#include <gridmorph/motion/target/feature_path.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace gridmorph {

namespace {

double mean_distance(std::vector<Vec3> const& a, std::vector<Vec3> const& b) {
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += distance(a[n], b[n]);
  return sum / double(a.size());
}

std::set<std::pair<int, int>> boundary_edges(std::vector<FeatureEdge> const& edges) {
  std::set<std::pair<int, int>> out;
  for (FeatureEdge const& e : edges)
    if (e.boundary) out.insert({e.a, e.b});
  return out;
}

class EdgeMapper {
 public:
  EdgeMapper(std::vector<Vec3> const& points, std::vector<FeatureEdge> const& edges, TargetTree const& target,
             std::vector<FeatureEdge> const& target_edges, double size, std::function<Vec3(Vec3 const&)> const& guess)
      : points_(points),
        target_(target),
        guess_(guess),
        size_(size),
        neighbours_(feature_neighbours(points.size(), edges)),
        corner_(points.size(), 0),
        network_(target.points(), target_edges),
        place_(points.size(), -1),
        loop_(points.size()) {
    out_.known.assign(points.size(), 0);
    out_.image.resize(points.size());
    find_loops(boundary_edges(edges), boundary_edges(target_edges));
  }

  EdgeImages run() {
    for (int v = 0; v < int(points_.size()); ++v) corner_[v] = turns_sharply(points_, neighbours_, v) ? 1 : 0;
    find_reach();
    pair_corners();
    // A sharp turn without a partner is no corner: its two chains are one.
    for (int v = 0; v < int(points_.size()); ++v)
      if (neighbours_[v].size() == 2 && place_[v] < 0) corner_[v] = 0;
    // Lines have no corners inside, and neither has what they go to: beside a thin base the line of the other corner is
    // hardly longer and may be nearer.
    for (int v = 0; v < int(points_.size()); ++v)
      if (place_[v] >= 0) network_.close(place_[v]);
    // First the lines between corners; what they do says where those go that run out in the smooth surface. Lines that
    // run out at both ends are the facets' doing.
    std::vector<FeatureChain> loose;
    for (FeatureChain const& chain : feature_chains(neighbours_, corner_)) {
      int const ends = free_end(chain.vertices.front()) + free_end(chain.vertices.back());
      if (ends == 0) count(map(chain));
      if (ends == 1) loose.push_back(chain);
    }
    refine_guess();
    for (FeatureChain const& chain : loose) count(map(chain));
    refine_guess();
    out_.guess = guess_;
    return std::move(out_);
  }

 private:
  struct Pair {
    double cost;
    int vertex, place;
  };
  /// What is known of a vertex on a loop that has a partner on the target.
  struct LoopVertex {
    int partner = -1;  ///< number of the target's loop
    int place = -1;    ///< one on it
    Vec3 shift;        ///< from the guess to the partner, where they are apart
  };

  /// Holes are farther from where they go than from one another as soon as they move by more than they are wide: the
  /// nearest edge is another hole's. So loops go to loops, and the guess is brought to them where it is off by more
  /// than half their radius.
  void find_loops(std::set<std::pair<int, int>> const& boundary, std::set<std::pair<int, int>> const& of_target) {
    std::vector<Vec3> guessed = points_;
    for (std::size_t v = 0; v < points_.size(); ++v)
      if (!neighbours_[v].empty()) guessed[v] = guess_(points_[v]);
    auto const own =
        feature_loops(guessed, neighbours_, [&](int a, int b) { return boundary.contains(std::minmax(a, b)); });
    auto const there = feature_loops(network_.points(), network_.neighbours(),
                                     [&](int a, int b) { return of_target.contains(network_.edge_between(a, b)); });
    place_loop_.assign(network_.points().size(), -1);
    for (std::size_t k = 0; k < there.size(); ++k)
      for (int const q : there[k].vertices) place_loop_[q] = int(k);
    auto const partner = pair_loops(own, there, 0.5 * size_);
    for (std::size_t k = 0; k < own.size(); ++k) {
      if (partner[k] < 0) continue;
      FeatureLoop const& to = there[partner[k]];
      Vec3 const shift = to.middle - own[k].middle;
      bool const apart = norm(shift) > own[k].length / (4 * std::numbers::pi);
      for (int const v : own[k].vertices) loop_[v] = {partner[k], to.vertices.front(), apart ? shift : Vec3{}};
    }
  }

  [[nodiscard]] Vec3 guess_of(int vertex) const { return guess_(points_[vertex]) + loop_[vertex].shift; }

  [[nodiscard]] int free_end(int vertex) const { return neighbours_[vertex].size() == 1 ? 1 : 0; }
  void count(bool mapped) { ++(mapped ? out_.mapped : out_.unmapped); }

  /// Makes the guess from the lines that are mapped: affine, and what that misses by inverse distance to the fourth
  /// power.
  void refine_guess() {
    std::vector<Vec3> from, moved;
    for (std::size_t v = 0; v < points_.size(); ++v)
      if (out_.known[v] != 0) {
        from.push_back(points_[v]);
        moved.push_back(out_.image[v] - points_[v]);
      }
    if (from.empty()) return;
    AffineDisplacement const carried = fit_affine(from, moved, points_);
    for (std::size_t n = 0; n < from.size(); ++n) moved[n] = moved[n] - carried(from[n]);
    guess_ = [from, moved, carried](Vec3 const& x) {
      Vec3 sum;
      double weights = 0;
      for (std::size_t n = 0; n < from.size(); ++n) {
        Vec3 const d = from[n] - x;
        double const squared = dot(d, d);
        if (squared == 0) return x + carried(x) + moved[n];
        sum += (1 / (squared * squared)) * moved[n];
        weights += 1 / (squared * squared);
      }
      return x + carried(x) + (1 / weights) * sum;
    };
  }

  /// Finds how far corners reach: half the length of the shortest chain that ends in a corner: farther away a sharp
  /// turn is not the same one.
  void find_reach() {
    reach_.assign(points_.size(), std::numeric_limits<double>::infinity());
    for (FeatureChain const& chain : feature_chains(neighbours_, corner_)) {
      double length = 0;
      for (std::size_t n = 1; n < chain.vertices.size(); ++n)
        length += distance(points_[chain.vertices[n - 1]], points_[chain.vertices[n]]);
      for (int const end : {chain.vertices.front(), chain.vertices.back()})
        reach_[end] = std::min(reach_[end], 0.5 * length);
    }
  }

  void pair_corners() {
    std::vector<int> places;
    for (int q = 0; q < int(network_.points().size()); ++q)
      if (network_.neighbours()[q].size() > 2 || turns_sharply(network_.points(), network_.neighbours(), q))
        places.push_back(q);
    std::vector<Pair> pairs;
    for (int v = 0; v < int(points_.size()); ++v) {
      std::size_t const degree = neighbours_[v].size();
      if (degree < 2 || (degree == 2 && corner_[v] == 0)) continue;
      Vec3 const g = guess_of(v);
      int const loop = loop_[v].partner;
      for (int const q : places) {
        if (loop >= 0 && place_loop_[q] != loop) continue;
        // Where as many edges meet in both, corners may be far apart; sharp turns of a line are the same only near by.
        bool const alike = network_.neighbours()[q].size() == degree;
        double const limit = alike && degree != 2 ? 0.5 * size_ : reach_[v];
        double const d = distance(g, network_.point(q));
        if (d <= limit) pairs.push_back({d + (alike ? 0 : 0.1 * size_), v, q});
      }
    }
    std::sort(pairs.begin(), pairs.end(), [](Pair const& a, Pair const& b) {
      return a.cost != b.cost ? a.cost < b.cost : a.vertex != b.vertex ? a.vertex < b.vertex : a.place < b.place;
    });
    std::vector<char> taken(network_.points().size(), 0);
    for (Pair const& pair : pairs) {
      if (place_[pair.vertex] >= 0 || taken[pair.place] != 0) continue;
      place_[pair.vertex] = pair.place;
      taken[pair.place] = 1;
    }
    untangle();
  }

  /// Swaps partners while that lessens the squares of the distances, which a common shift of all corners does not
  /// change: the two corners of a thin base are far nearer to one another than to where they go.
  void untangle() {
    std::vector<int> paired;
    for (int v = 0; v < int(points_.size()); ++v)
      if (place_[v] >= 0) paired.push_back(v);
    auto const cost = [&](int v, int place) {
      Vec3 const d = network_.point(place) - guess_of(v);
      return dot(d, d);
    };
    bool swapped = paired.size() < 2000;
    for (int pass = 0; swapped && pass < 20; ++pass) {
      swapped = false;
      for (std::size_t i = 0; i < paired.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
          int const v = paired[i], w = paired[j];
          if (neighbours_[v].size() != neighbours_[w].size() || loop_[v].partner != loop_[w].partner) continue;
          double const now = cost(v, place_[v]) + cost(w, place_[w]), then = cost(v, place_[w]) + cost(w, place_[v]);
          if (then < now - 1e-14 * size_ * size_) {
            std::swap(place_[v], place_[w]);
            swapped = true;
          }
        }
    }
  }

  /// Where the end of a chain goes: to its partner, or to the nearest point of an edge, of those that ways from the
  /// partner of the other end lead to, or of those of its loop's partner.
  int place_of(int vertex, int other_end) {
    int const start = place_[other_end] >= 0 ? place_[other_end] : loop_[vertex].place;
    if (place_[vertex] < 0) place_[vertex] = network_.nearest_place(guess_of(vertex), start);
    return place_[vertex];
  }

  [[nodiscard]] std::optional<std::vector<int>> between(FeatureChain const& chain, Polyline const& guide) {
    int const first = chain.vertices.front(), last = chain.vertices.back();
    int const from = place_of(first, last), to = place_of(last, first);
    if (from < 0 || to < 0) return std::nullopt;
    return way_beside(from, to, guide.points());
  }

  [[nodiscard]] bool is_corner(int vertex) const { return neighbours_[vertex].size() != 2 || corner_[vertex] != 0; }

  bool map(FeatureChain const& chain) {
    if (network_.empty()) return false;
    std::vector<Vec3> own, guessed;
    for (int const v : chain.vertices) {
      own.push_back(points_[v]);
      guessed.push_back(guess_of(v));
    }
    Polyline const line(own), guide(guessed);
    if (!(line.length() > 0) || !(guide.length() > 0)) return false;
    auto const way = chain.closed() ? around(chain, guide) : between(chain, guide);
    if (!way) return false;
    std::vector<Vec3> way_points;
    for (int const place : *way) way_points.push_back(network_.point(place));
    Polyline const found(way_points);
    if (!(found.length() > 0.5 * guide.length() && found.length() < 2 * guide.length())) return false;
    bool const free_start = chain.closed() && !is_corner(chain.vertices.front());
    double const phase = free_start ? best_phase(line, guessed, found) : 0;
    std::vector<Vec3> image;
    for (std::size_t n = 0; n < own.size(); ++n) image.push_back(at(found, line.fraction(n), phase));
    double to_target = 0;
    for (Vec3 const& g : guessed) to_target += target_.closest(g).distance / double(guessed.size());
    if (mean_distance(image, guessed) > 0.25 * guide.length() + 2 * to_target) return false;
    for (std::size_t n = 0; n < own.size(); ++n) {
      int const v = chain.vertices[n];
      out_.known[v] = 1;
      out_.image[v] = image[n];
      if (n > 0) out_.edges.insert(std::minmax(chain.vertices[n - 1], v));
    }
    for (std::size_t n = 1; n < way->size(); ++n)
      out_.on_target.insert(network_.edge_between((*way)[n - 1], (*way)[n]));
    return true;
  }

  /// The way between two places that stays beside a line, once the ends of the line are brought there: what the guess
  /// is off by at the ends it is off by between them, while the other side of a thin section may be nearer.
  [[nodiscard]] std::optional<std::vector<int>> way_beside(int from, int to, std::vector<Vec3> points) const {
    Polyline const line(points);
    Vec3 const first = network_.point(from) - points.front(), last = network_.point(to) - points.back();
    for (std::size_t n = 0; n < points.size(); ++n) {
      double const f = line.fraction(n);
      points[n] = points[n] + (1 - f) * first + f * last;
    }
    return network_.path(from, to, Polyline(std::move(points)));
  }

  /// A loop in two halves, so that the guide says which way around.
  std::optional<std::vector<int>> around(FeatureChain const& chain, Polyline const& guide) {
    auto const& points = guide.points();
    std::size_t half = 1;
    while (half + 2 < chain.vertices.size() && guide.fraction(half) < 0.5) ++half;
    int const first_vertex = chain.vertices.front();
    int const start = is_corner(first_vertex) ? place_of(first_vertex, first_vertex)
                                              : network_.nearest_place(points.front(), loop_[first_vertex].place);
    int const middle = network_.nearest_place(points[half] + network_.point(start) - points.front(),
                                              loop_[first_vertex].partner < 0 ? -1 : start);
    if (start == middle) return std::nullopt;
    auto const at_half = points.begin() + std::ptrdiff_t(half);
    auto first = way_beside(start, middle, {points.begin(), at_half + 1});
    auto const second = way_beside(middle, start, {at_half, points.end()});
    if (!first || !second) return std::nullopt;
    first->insert(first->end(), second->begin() + 1, second->end());
    return first;
  }

  static Vec3 at(Polyline const& loop, double fraction, double phase) {
    if (phase == 0) return loop.at(fraction);
    double const f = fraction + phase;
    return loop.at(f - std::floor(f));
  }

  /// The turn of a loop that moves its nodes least (squares, each node with its share of the length).
  static double best_phase(Polyline const& line, std::vector<Vec3> const& guessed, Polyline const& loop) {
    auto const cost = [&](double phase) {
      double sum = 0;
      for (std::size_t n = 0; n + 1 < guessed.size(); ++n) {
        Vec3 const d = at(loop, line.fraction(n), phase) - guessed[n];
        double const before = n == 0 ? 1 - line.fraction(guessed.size() - 2) : line.fraction(n) - line.fraction(n - 1);
        sum += dot(d, d) * 0.5 * (before + line.fraction(n + 1) - line.fraction(n));
      }
      return sum;
    };
    constexpr int steps = 64;
    double const unturned = cost(0);
    double best = 0, least = unturned;
    for (int k = 1; k < steps; ++k)
      if (double const c = cost(double(k) / steps); c < least) {
        least = c;
        best = double(k) / steps;
      }
    // Golden section around the best of them.
    constexpr double golden = 0.6180339887498949;
    double lo = best - 1.0 / steps, hi = best + 1.0 / steps;
    double a = hi - golden * (hi - lo), b = lo + golden * (hi - lo), ca = cost(a), cb = cost(b);
    for (int n = 0; n < 60; ++n) {
      if (ca < cb) {
        hi = b;
        b = a;
        cb = ca;
        ca = cost(a = hi - golden * (hi - lo));
      } else {
        lo = a;
        a = b;
        ca = cb;
        cb = cost(b = lo + golden * (hi - lo));
      }
    }
    double const turned = 0.5 * (lo + hi);
    // A loop that lies on itself already stays as it is, whatever the rounding.
    double const nothing = 1e-24 * loop.length() * loop.length();
    return unturned <= nothing || cost(turned) >= unturned ? 0 : turned;
  }

  std::vector<Vec3> const& points_;
  TargetTree const& target_;
  std::function<Vec3(Vec3 const&)> guess_;
  double size_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<char> corner_;
  FeatureNetwork network_;
  std::vector<int> place_;        ///< of each corner in the network, -1: none yet
  std::vector<LoopVertex> loop_;  ///< per vertex
  std::vector<int> place_loop_;   ///< per place of the network as it is at first: the number of its loop, -1: none
  std::vector<double> reach_;
  EdgeImages out_;
};

}  // namespace

EdgeImages map_edges(std::vector<Vec3> const& points, std::vector<FeatureEdge> const& edges, TargetTree const& target,
                     std::vector<FeatureEdge> const& target_edges, double size,
                     std::function<Vec3(Vec3 const&)> const& guess) {
  return EdgeMapper(points, edges, target, target_edges, size, guess).run();
}

}  // namespace gridmorph
