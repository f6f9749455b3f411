#include <gridmorph/core/for_all.hpp>
#include <gridmorph/geometry/smoothstep.hpp>
#include <gridmorph/plan/boundary_groups.hpp>
#include <gridmorph/plan/least_squares_field.hpp>
#include <gridmorph/plan/make_rows.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace gridmorph {

namespace {

constexpr double order = 5;  // p
/// Radius over distance up to which a group counts as one, and as its two parts from twice as much on; no ratio of
/// lengths in a lattice, as round-off would break such ties. By measurement (bench_turns, bench_unstructured): half as
/// large, sections twice as thick keep 0.02 more and an apply takes twice as long.
constexpr double opening = 0.2517;
/// What weighs less than this share of the nearest does not count.
constexpr double least_weight = 1e-2;

/// The sources, then those of each image.
struct Places {
  Coordinates place;
  std::vector<Index32> number;
  std::vector<double> area;

  Places(Coordinates const& x, FieldSources const& of)
      : place(Index(of.nodes.size() * (1 + of.images.size()))), number(place.size()) {
    std::iota(number.begin(), number.end(), Index32(0));
    for (std::size_t k = 0; k < number.size(); ++k) {
      std::size_t const n = k % of.nodes.size(), image = k / of.nodes.size();
      Vec3 const p = x[of.nodes[n]];
      place.set(Index(k), image == 0 ? p : of.images[image - 1](p));
      area.push_back(of.area[n]);
    }
  }
  /// The largest distance of the walls' own nodes, the first ones, from their centre.
  [[nodiscard]] double size(std::size_t n_walls) const {
    Vec3 centre;
    double sum = 0, out = 0;
    for (std::size_t k = 0; k < n_walls; ++k) {
      centre += area[k] * place[Index(k)];
      sum += area[k];
    }
    for (std::size_t k = 0; k < n_walls; ++k)
      out = std::max(out, gridmorph::distance(place[Index(k)], (1 / sum) * centre));
    return out;
  }
};

/// Means of places and of their products, as the rows of the field make them.
struct PlaceMoments {
  Vec3 x;
  double xx[6] = {};  ///< xx, yy, zz, xy, yz, zx
  double turns = 0;   ///< the share of walls, whose turns are known

  static PlaceMoments of(Vec3 const& p, bool turns) {
    return {p, {p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.y, p.y * p.z, p.z * p.x}, turns ? 1.0 : 0.0};
  }
  void add(double w, PlaceMoments const& b) {
    x += w * b.x;
    turns += w * b.turns;
    for (int k = 0; k < 6; ++k) xx[k] += w * b.xx[k];
  }
};

/// With the weights that kernels have.
template <class Source>
PlaceMoments mean_of_row(InterpolationOperator const& rows, Index r, Source const& source) {
  Index const from = rows.first[r], to = rows.first[r + 1];
  PlaceMoments sum;
  double rest = 1;
  for (Index k = from + 1; k < to; ++k) {
    double const w = rows.weight[k];
    rest -= w;
    sum.add(w, source(rows.item[k]));
  }
  sum.add(rest, source(rows.item[from]));
  return sum;
}

/// (C + m I)^-1 v, C being the symmetric matrix of second moments about the mean.
Vec3 solved(PlaceMoments const& of, double m, Vec3 const& v) {
  double const xx = of.xx[0] - of.x.x * of.x.x + m, yy = of.xx[1] - of.x.y * of.x.y + m,
               zz = of.xx[2] - of.x.z * of.x.z + m, xy = of.xx[3] - of.x.x * of.x.y, yz = of.xx[4] - of.x.y * of.x.z,
               zx = of.xx[5] - of.x.z * of.x.x;
  double const a = yy * zz - yz * yz, b = yz * zx - xy * zz, c = xy * yz - yy * zx;
  double const d = xx * zz - zx * zx, e = xy * zx - xx * yz, f = xx * yy - xy * xy;
  double const det = xx * a + xy * b + zx * c;
  return (1 / det) * Vec3{a * v.x + b * v.y + c * v.z, b * v.x + d * v.y + e * v.z, c * v.x + e * v.y + f * v.z};
}

/// The share of what walls turn by that reaches so many of their sizes, where the mean of it is left to the field: all
/// beside them, and so little far away that nodes move by about as much as walls there.
double kept_turn(double sizes) {
  double const of_reach = sizes / 0.75;
  return 1 / (1 + of_reach * of_reach);
}

/// What the mean of 1 / r^5 over a group is of that at its centre, at the distance d, to second order.
double spread(BoundaryGroups::Group const& group, Vec3 const& x, double d) {
  Vec3 const n = (1 / d) * (x - group.centre);
  double const c[3] = {n.x, n.y, n.z};
  double along = 0, all = 0;
  for (int i = 0; i < 3; ++i) {
    all += group.moments[i][i];
    for (int j = 0; j < 3; ++j) along += c[i] * group.moments[i][j] * c[j];
  }
  return 1 + 0.5 * order * ((order + 2) * along - all) / (d * d);
}

/// The groups that a node reads and their weights, of which the largest is 1.
class GroupWeights {
 public:
  explicit GroupWeights(BoundaryGroups const& tree) : tree_(tree) {}

  void find(Vec3 const& x, double from_walls) {
    items_.clear();
    weights_.clear();
    open_.assign(1, {0, 1.0});
    largest_ = 0;
    while (!open_.empty()) {
      auto const [g, part] = open_.back();
      open_.pop_back();
      look_at(g, part, x, from_walls);
    }
    std::size_t kept = 0;
    for (std::size_t k = 0; k < items_.size(); ++k) {
      if (weights_[k] < least_weight * largest_) continue;
      items_[kept] = items_[k];
      weights_[kept++] = weights_[k] / largest_;
    }
    items_.resize(kept);
    weights_.resize(kept);
  }
  [[nodiscard]] std::vector<Index32> const& items() const { return items_; }
  [[nodiscard]] std::vector<double> const& weights() const { return weights_; }

 private:
  void look_at(Index32 g, double part, Vec3 const& x, double from_walls) {
    auto const& group = tree_.groups[g];
    double const d = std::max(distance(x, group.centre), from_walls);
    // Lengths may be tiny: only ratios of weights count.
    double const near = from_walls / d;
    double weight = part * group.area * near * near * near * near * near * spread(group, x, d);
    double const wide = group.radius / d;
    if (wide < 2 * opening && weight < least_weight * largest_) return;
    double const opened = group.part[0] < 0 ? 0 : smoothstep((wide - opening) / opening);
    if (opened > 0) {
      open_.emplace_back(group.part[1], part * opened);
      open_.emplace_back(group.part[0], part * opened);
    }
    weight *= 1 - opened;
    if (!(weight > least_weight * largest_)) return;
    largest_ = std::max(largest_, weight);
    items_.push_back(g);
    weights_.push_back(weight);
  }

  BoundaryGroups const& tree_;
  std::vector<std::pair<Index32, double>> open_;  ///< groups, and how much of them counts
  std::vector<Index32> items_;
  std::vector<double> weights_;
  double largest_ = 0;
};

}  // namespace

LeastSquaresField make_least_squares_field(HostInstance const& host, Coordinates const& coordinates,
                                           FieldSources const& of, MeanTurn turns,
                                           std::vector<FieldReader> const& readers) {
  LeastSquaresField out;
  if (of.n_walls == 0) return out;
  Places const sources(coordinates, of);
  BoundaryGroups const tree(sources.place, sources.number, sources.area, 0, BoundaryGroups::Along::principal_axes);
  out.images = of.images;
  double const size = sources.size(of.n_walls);
  out.n_groups = Index32(tree.groups.size());
  tree.add_rows(out.leaves, out.groups);
  out.origin = tree.groups.front().centre;

  bool const walls_alone = of.images.empty() && of.n_walls == of.nodes.size();
  std::vector<double> distance_of(readers.size());
  detail::for_all(host, "gridmorph::least_squares_distance", std::ssize(readers), [&](Index at) {
    FieldReader const& reader = readers[at];
    double const own = reader.distance;
    distance_of[at] =
        walls_alone ? own : std::min(own, std::max(tree.distance(coordinates[reader.node]), 1e-14 * tree.size()));
  });

  out.nodes = make_rows(host, "gridmorph::make_least_squares_field", std::ssize(readers),
                        [&, groups = GroupWeights(tree)](Index r, InterpolationOperator& rows) mutable {
                          groups.find(coordinates[readers[r].node], distance_of[r]);
                          rows.add(readers[r].node, groups.items(), groups.weights());
                        });

  // With the weights as they are rounded, so that common motions are exact.
  std::vector<PlaceMoments> moment(tree.groups.size());
  for (Index r = 0; r < out.leaves.size(); ++r)
    moment[out.leaves.target[r]] = mean_of_row(out.leaves, r, [&](Index32 k) {
      return PlaceMoments::of(sources.place[k] - out.origin, std::size_t(k) % of.nodes.size() < of.n_walls);
    });
  auto const of_group = [&](Index32 g) { return moment[g]; };
  for (Index r = 0; r < out.groups.rows.size(); ++r)
    moment[out.groups.rows.target[r]] = mean_of_row(out.groups.rows, r, of_group);
  out.lean.resize(readers.size());
  out.level.resize(readers.size());
  out.room.resize(readers.size());
  detail::for_all(host, "gridmorph::least_squares", std::ssize(readers), [&](Index at) {
    auto const r = std::size_t(at);
    PlaceMoments const around = mean_of_row(out.nodes, at, of_group);
    double const m = distance_of[r] * distance_of[r];
    Vec3 const x = coordinates[readers[r].node] - out.origin;
    double const kept = turns == MeanTurn::taken_off ? 1 : kept_turn(distance_of[r] / size);
    // As much as there are turns, so that motions in common are exact; a little where there are none.
    constexpr double least_turns = 0.05;
    out.lean[r] = kept * solved(around, std::max(around.turns, least_turns) * m, x - around.x);
    out.level[r] = 1 - dot(around.x, out.lean[r]);
    out.room[r] = m;
  });
  return out;
}

}  // namespace gridmorph
