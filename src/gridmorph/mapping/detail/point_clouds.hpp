// Clouds of points: ever more thinned-out copies with a k-d tree each, how far the origin lies outside of a few points,
// and nodes of a model that are given more than once. Internal.
#pragma once

#include <gridmorph/kernels/vec3.hpp>
#include <gridmorph/mapping/structural_model.hpp>

#include <nanoflann.hpp>

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace gridmorph::mapping {

struct Points {
  std::vector<Vec3> const* position;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return position->size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    Vec3 const& p = (*position)[i];
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3, std::size_t>;

/// The points, or one point per cell of a grid: neighbours on surface meshes that are stretched a hundredfold all lie
/// on one grid line, and a thinned level finds the next lines without walking along this one.
struct Level {
  std::vector<std::size_t> number;  ///< in the cloud
  std::vector<Vec3> position;
  Points points{nullptr};
  std::unique_ptr<Tree> tree;

  Level(std::vector<std::size_t> n, std::vector<Vec3> const& all) : number(std::move(n)) {
    for (std::size_t const i : number) position.push_back(all[i]);
    points.position = &position;
    tree = std::make_unique<Tree>(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(16));
    tree->buildIndex();
  }
  Level(Level const&) = delete;
  Level& operator=(Level const&) = delete;
};

/// All points first; each further level is thinned to a quarter of the density along a line, down to `fewest` points.
std::vector<std::unique_ptr<Level>> make_levels(std::vector<Vec3> const& position, std::size_t fewest);

/// The point of the convex hull that is closest to the origin; the zero vector when the origin is inside, or outside by
/// less than `tolerance`. The points may lie in a plane or on a line. Cost O(n) inside, O(n^3) outside: for
/// neighbourhoods.
Vec3 closest_in_hull(std::vector<Vec3> const& points, double tolerance);

/// Keeps the first of nodes at equal positions, in the model, its elements and all fields (fields)(nodes). A
/// quadrilateral that loses a corner so becomes a triangle. Throws ConfigError when their displacements differ by more
/// than 1e-6 of the largest of the field. Cost O(n log n).
void merge_nodes(StructuralModel& model, std::vector<std::vector<Vec3>>& fields);

}  // namespace gridmorph::mapping
