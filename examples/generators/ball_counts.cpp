#include <generators/ball_counts.hpp>
#include <gridmorph/core/error.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace gridmorph::demo {

namespace {

constexpr double thickest_layers = 0.2;     ///< where the generator chooses
constexpr double thickest_requested = 0.3;  ///< where the user does

void check(BallOptions const& o) {
  Problems problems;
  auto const within = [&](char const* what, double value, double low, double high) {
    if (!(value >= low && value <= high))
      problems.add("ball: " + std::string(what) + " is " + std::to_string(value) + "; it must lie within " +
                   std::to_string(low) + " and " + std::to_string(high));
  };
  if (!(o.radius > 0 && std::isfinite(o.radius)))
    problems.add("ball: radius is " + std::to_string(o.radius) + "; it must be positive");
  within("rope_radius", o.rope_radius, 0.05, 0.5);
  within("rope_length", o.rope_length, 2, 100);
  within("jib_height", o.jib_height, 0.1, 100);
  within("mast_distance", o.mast_distance, tube_half_width + 0.2, 100);
  within("mast_width", o.mast_width, 0.1, 100);
  within("behind", o.behind, tube_half_width + 0.2, 100);
  within("beyond", o.beyond, 0.2, 100);
  within("beside", o.beside, tube_half_width + 0.2, 100);
  within("below", o.below, tube_half_width + 0.2, 100);
  within("above", o.above, 0.2, 100);
  within("first_cell", o.first_cell, 1e-8, 0.05);
  within("growth", o.growth, 1, 2);
  within("jitter", o.jitter, 0, 0.3);
  if (o.layers < 0) problems.add("ball: layers is " + std::to_string(o.layers) + "; it must not be negative");
  problems.throw_if_any<ConfigError>();
  LayerHeights const asked{o.first_cell, o.growth, o.layers};
  if (o.layers > 0 && !(asked.total() <= thickest_requested))
    throw ConfigError("ball: " + std::to_string(o.layers) + " layers that begin with " + std::to_string(o.first_cell) +
                      " and grow by " + std::to_string(o.growth) + " are " + std::to_string(asked.total()) +
                      " radii thick; ask for no more than " + std::to_string(thickest_requested));
}

/// `resolution`: faces along a quarter of the ball's equator, but a real number.
BallCounts counts_at(BallOptions const& o, int side, double resolution) {
  auto const rounded = [](double x, int least) { return std::max(least, int(std::lround(x))); };
  BallCounts n;
  n.side = side;
  n.lower = rounded(0.5 * resolution, 2);
  double const face = 0.5 * std::numbers::pi / resolution, far_size = 2 * tube_half_width / resolution;
  n.upper = rounded(upper_arc(o) / face, 3);
  n.rings_on_rope = {face, 0.15, 0.6 * far_size};
  n.rope = n.rings_on_rope.count(0, o.rope_length);
  n.tetrahedral = rounded(0.8 * resolution, 4);
  n.lattice = {far_size, 0.15, 2.5 * far_size};
  double const a = tube_half_width, mast_end = o.mast_distance + o.mast_width;
  n.behind = n.lattice.count(0, o.behind - a);
  n.between = n.lattice.count(0, o.mast_distance - a);
  n.mast = n.lattice.count(o.mast_distance - a, mast_end - a);
  n.beyond = n.lattice.count(mast_end - a, mast_end + o.beyond - a);
  n.beside = n.lattice.count(0, o.beside - a);
  n.below = n.lattice.count(0, o.below - a);
  n.jib = n.lattice.count(0, o.jib_height);
  n.above = n.lattice.count(o.jib_height, o.jib_height + o.above);
  n.layers = o.layers > 0 ? LayerHeights{o.first_cell, o.growth, o.layers}
                          : LayerHeights::reaching(o.first_cell, o.growth, 0.4 * face, thickest_layers);
  return n;
}

}  // namespace

double upper_arc(BallOptions const& options) { return std::acos(options.rope_radius); }

Index count_elements(BallOptions const& options, BallCounts const& n) {
  Index const m = n.side, all = Index(n.lattice_x()) * n.lattice_y() * n.lattice_z();
  Index const tube = m * m * n.rings();
  Index const jib = (m + n.between + n.mast) * m * n.jib, mast = Index(n.mast) * m * (n.below + n.rings());
  Index const on_ball = m * m + 4 * m * (n.lower + n.upper), on_rope = 4 * m * n.rope;
  int const layers = n.layers.n, cells = layers + n.tetrahedral;
  return 6 * (all - tube - jib - mast) +
         on_ball * elements_over(layers, cells, options.layer_elements == LayerElements::hexahedra) +
         on_rope * elements_over(layers, cells, options.layer_elements != LayerElements::prisms);
}

BallCounts ball_counts(BallOptions const& options) {
  check(options);
  constexpr int coarsest = 4, finest = 400, steps = 120;
  constexpr double span = 1.25;        // resolution over cells along a side, either way
  constexpr double even_weight = 0.2;  // what a cell as wide as long is worth against the right number
  double best = std::numeric_limits<double>::infinity();
  BallCounts found;
  double const wanted = double(options.elements);
  for (int side = coarsest; side <= finest; ++side) {
    if (double(count_elements(options, counts_at(options, side, side / span))) > 1.5 * wanted) break;
    for (int step = -steps; step <= steps; ++step) {
      double const off = double(step) / steps * std::log(span);
      BallCounts const counts = counts_at(options, side, side * std::exp(off));
      double const error = std::abs(std::log(double(count_elements(options, counts)) / wanted));
      double const cost = error + even_weight * std::abs(off);
      if (error < 0.09 && cost < best) {
        best = cost;
        found = counts;
      }
    }
  }
  if (found.side == 0)
    throw ConfigError("ball: no mesh of this shape has about " + std::to_string(options.elements) +
                      " elements; ask for 50 thousand to 50 million, or for fewer layers");
  return found;
}

}  // namespace gridmorph::demo
