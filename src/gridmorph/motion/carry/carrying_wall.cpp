#include <gridmorph/geometry/smoothstep.hpp>
#include <gridmorph/motion/carry/carried_features.hpp>
#include <gridmorph/motion/detail/edge_distances.hpp>

#include <algorithm>
#include <cstddef>

namespace gridmorph {

namespace {

using Feature = CarriedFeatures::Feature;

/// Which feature is nearest to each vertex of a wall, and how far that reaches.
class Reach {
 public:
  Reach(Boundary const& boundary, PatchSurface const& surface, std::vector<Feature const*> const& features,
        std::vector<char> const& limits)
      : surface_(surface) {
    for (Feature const* feature : features) reach_.push_back(feature->fade);
    find_nearest(features);
    for (std::size_t q = 0; q < limits.size(); ++q)
      if (limits[q] != 0)
        for (Index const n : boundary.surface(int(q)).nodes) end_at(surface.numbers.find(boundary.coordinates()[n]));
    for (VertexImage const& image : vertex_images(boundary, surface)) end_at(image.vertex);
    part_features();
  }

  /// The number of the nearest feature, or -1 where none reaches.
  [[nodiscard]] int feature(std::size_t v) const {
    int const f = nearest_[v];
    return f >= 0 && (away_[v] == 0 || away_[v] < reach_[f]) ? f : -1;
  }
  [[nodiscard]] double share(std::size_t v) const {
    return away_[v] == 0 ? 1 : 1 - smoothstep(away_[v] / reach_[nearest_[v]]);
  }

 private:
  void find_nearest(std::vector<Feature const*> const& features) {
    std::vector<int> rim, of_rim;
    for (std::size_t f = 0; f < features.size(); ++f)
      for (Vec3 const& x : features[f]->rim)
        if (int const v = surface_.numbers.find(x); v >= 0) {
          rim.push_back(v);
          of_rim.push_back(int(f));
        }
    EdgeDistances distances = edge_distances_and_sources(surface_, {}, rim);
    away_ = std::move(distances.distance);
    for (int const s : distances.source) nearest_.push_back(s < 0 ? -1 : of_rim[s]);
  }

  /// Nodes on a rim are the feature's, whatever else they are.
  void end_at(int v) {
    if (v < 0 || nearest_[v] < 0 || away_[v] == 0) return;
    double& own = reach_[nearest_[v]];
    own = std::min(own, away_[v]);
  }

  /// Parts features from one another: half way between two of them the wall has its own motion.
  void part_features() {
    auto const neighbours = surface_.neighbours();
    for (std::size_t v = 0; v < neighbours.size(); ++v)
      for (int const other : neighbours[v]) {
        auto const w = std::size_t(other);
        if (nearest_[v] < 0 || nearest_[w] < 0 || nearest_[v] == nearest_[w]) continue;
        double const half = 0.5 * (away_[v] + away_[w] + distance(surface_.points[v], surface_.points[w]));
        double& own = reach_[nearest_[v]];
        own = std::min(own, half);
      }
  }

  PatchSurface const& surface_;
  std::vector<double> reach_;  ///< per feature
  std::vector<double> away_;   ///< per vertex, from the rim of the nearest
  std::vector<int> nearest_;
};

}  // namespace

CarryingWall::CarryingWall(Boundary const& boundary, std::vector<int> const& patches,
                           std::vector<Feature const*> const& features, std::vector<char> const& limits,
                           CarriedFeatures::Displacement const& own)
    : surface_(boundary, patches), changes_(surface_.points.size(), 0), displacement_(surface_.points.size()) {
  Reach const reach(boundary, surface_, features, limits);
  for (PatchGrid const& grid : surface_.grids) {
    std::vector<std::size_t> vertices;
    std::vector<Vec3> points;
    for (int const vertex : grid.vertex) {
      auto const v = std::size_t(vertex);
      if (changes_[v] != 0 || reach.feature(v) < 0) continue;
      changes_[v] = 1;
      vertices.push_back(v);
      points.push_back(surface_.points[v]);
    }
    std::vector<Vec3> u(points.size());
    own(grid.patch, points, u);
    for (std::size_t n = 0; n < vertices.size(); ++n) {
      std::size_t const v = vertices[n];
      Vec3 const carried = displacement(features[reach.feature(v)]->motion, points[n]);
      double const share = reach.share(v);
      displacement_[v] = share == 1 ? carried : u[n] + share * (carried - u[n]);
    }
  }
}

void CarryingWall::change(std::span<Vec3 const> points, std::span<Vec3> displacement) const {
  for (std::size_t n = 0; n < points.size(); ++n)
    if (int const v = surface_.numbers.find(points[n]); v >= 0 && changes_[v] != 0) displacement[n] = displacement_[v];
}

}  // namespace gridmorph
