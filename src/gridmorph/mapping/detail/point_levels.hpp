// A cloud of points and ever more thinned-out copies of it, each with a k-d tree. Internal.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

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

}  // namespace gridmorph::mapping
