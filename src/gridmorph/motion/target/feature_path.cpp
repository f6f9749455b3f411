#include <gridmorph/motion/target/feature_path.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <unordered_map>
#include <utility>

namespace gridmorph {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Nearest point of a segment; exactly an end where that is nearest.
Vec3 closest_on_segment(Vec3 const& p, Vec3 const& a, Vec3 const& b) {
  Vec3 const ab = b - a;
  double const t = dot(p - a, ab), whole = dot(ab, ab);
  if (!(t > 0)) return a;
  return t >= whole ? b : a + (t / whole) * ab;
}

}  // namespace

Polyline::Polyline(std::vector<Vec3> points) : points_(std::move(points)), length_{0} {
  for (std::size_t n = 1; n < points_.size(); ++n)
    length_.push_back(length_.back() + distance(points_[n - 1], points_[n]));
}

Vec3 Polyline::at(double fraction) const {
  constexpr double same = 1e-10;
  double const s = std::clamp(fraction, 0.0, 1.0) * length();
  auto const after = std::lower_bound(length_.begin(), length_.end(), s);
  std::size_t const n = std::min<std::size_t>(std::size_t(after - length_.begin()), length_.size() - 1);
  if (length_[n] - s <= same * length()) return points_[n];
  if (n == 0) return points_[0];
  if (s - length_[n - 1] <= same * length()) return points_[n - 1];
  double const t = (s - length_[n - 1]) / (length_[n] - length_[n - 1]);
  return points_[n - 1] + t * (points_[n] - points_[n - 1]);
}

double Polyline::distance_to(Vec3 const& p) const {
  double nearest = distance(p, points_.front());
  for (std::size_t n = 1; n < points_.size(); ++n)
    nearest = std::min(nearest, distance(p, closest_on_segment(p, points_[n - 1], points_[n])));
  return nearest;
}

FeatureNetwork::FeatureNetwork(std::vector<Vec3> const& points, std::vector<FeatureEdge> const& edges) {
  std::unordered_map<int, int> number;
  auto const place = [&](int vertex) {
    auto const [at, fresh] = number.try_emplace(vertex, int(points_.size()));
    if (fresh) {
      points_.push_back(points[vertex]);
      neighbours_.emplace_back();
      on_.push_back({vertex, vertex});
      closed_.push_back(0);
    }
    return at->second;
  };
  for (FeatureEdge const& e : edges) {
    int const a = place(e.a), b = place(e.b);
    neighbours_[a].push_back(b);
    neighbours_[b].push_back(a);
  }
}

/// Per place, whether ways from `place` lead on from there.
std::vector<char> FeatureNetwork::reached_from(int place) const {
  std::vector<char> reached(points_.size(), 0);
  std::vector<int> waiting{place};
  reached[place] = 1;
  while (!waiting.empty()) {
    int const v = waiting.back();
    waiting.pop_back();
    for (int const w : neighbours_[v])
      if (reached[w] == 0 && closed_[w] == 0) {
        reached[w] = 1;
        waiting.push_back(w);
      }
  }
  return reached;
}

int FeatureNetwork::nearest_place(Vec3 const& p, int start) {
  auto const reached = start < 0 ? std::vector<char>(points_.size(), 1) : reached_from(start);
  int from = -1, to = -1;
  double nearest = infinite;
  Vec3 best;
  for (int a = 0; a < int(points_.size()); ++a)
    for (int const b : neighbours_[a]) {
      if (b < a || (reached[a] == 0 && reached[b] == 0)) continue;
      Vec3 const q = closest_on_segment(p, points_[a], points_[b]);
      if (double const d = distance(p, q); d < nearest) {
        nearest = d;
        from = a;
        to = b;
        best = q;
      }
    }
  if (from < 0) return -1;
  double const close = 1e-9 * distance(points_[from], points_[to]);
  if (distance(best, points_[from]) <= close) return from;
  if (distance(best, points_[to]) <= close) return to;
  int const fresh = int(points_.size());
  points_.push_back(best);
  neighbours_.push_back({from, to});
  closed_.push_back(0);
  // Further vertices may divide the same edge: the new one keeps the ends of the whole of it.
  auto const [a, b] = edge_between(from, to);
  on_.push_back({a, b});
  std::replace(neighbours_[from].begin(), neighbours_[from].end(), to, fresh);
  std::replace(neighbours_[to].begin(), neighbours_[to].end(), from, fresh);
  return fresh;
}

std::pair<int, int> FeatureNetwork::edge_between(int place, int neighbour) const {
  auto const &p = on_[place], &q = on_[neighbour];
  if (p[0] != p[1]) return std::minmax(p[0], p[1]);
  if (q[0] != q[1]) return std::minmax(q[0], q[1]);
  return std::minmax(p[0], q[0]);
}

std::optional<std::vector<int>> FeatureNetwork::path(int from, int to, Polyline const& guide) const {
  double const reach = 0.1 * guide.length();
  std::vector<double> cost(points_.size(), infinite);
  std::vector<int> before(points_.size(), -1);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> waiting;
  cost[from] = 0;
  waiting.emplace(0.0, from);
  while (!waiting.empty()) {
    auto const [c, v] = waiting.top();
    waiting.pop();
    if (c > cost[v]) continue;
    if (v == to) break;
    if (closed_[v] != 0 && v != from) continue;
    for (int const w : neighbours_[v]) {
      // What lies off the guide costs more, so that a way follows it where a short cut would lead past.
      double const aside = guide.distance_to(0.5 * (points_[v] + points_[w])) / reach;
      double const next = c + distance(points_[v], points_[w]) * (1 + aside * aside);
      if (next < cost[w]) {
        cost[w] = next;
        before[w] = v;
        waiting.emplace(next, w);
      }
    }
  }
  if (before[to] < 0 && from != to) return std::nullopt;
  std::vector<int> way{to};
  for (int v = to; v != from; v = before[v]) way.push_back(before[v]);
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace gridmorph
