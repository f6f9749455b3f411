// Spreads the displacement of some nodes of a surface over its patches, and puts its nodes onto a target without losing
// their order.
#pragma once

#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/geometry/affine_fit.hpp>

#include <functional>
#include <set>
#include <utility>
#include <vector>

namespace gridmorph {

/// Spreads known images of some vertices to images of all: the affine displacement that fits the known ones best
/// carries everything along; what it misses is spread over each patch, which is cut along grid lines that known edges
/// run along. Corners of the pieces take it by inverse distance to the fourth power, sides linearly by arc length
/// between vertices that have an image, the inside by transfinite interpolation (W. J. Gordon and C. A. Hall 1973) with
/// shares of the length of each grid line. Patches that are no grids take it from neighbour to neighbour instead: a
/// vertex the mean of those nearer to the known ones by the number of sides, weighted by one over their distance.
/// Explicit; cost O(vertices), plus corners times known vertices.
class SurfaceSpread {
 public:
  /// Puts a vertex where it shall be in the end, given where the spread wants it.
  using Place = std::function<Vec3(int vertex, Vec3 const& wanted)>;
  using Edges = std::set<std::pair<int, int>>;

  /// Keeps references to its arguments; `image` is of the known vertices.
  SurfaceSpread(PatchSurface const& surface, std::vector<char> const& known, std::vector<Vec3> image,
                Edges const& edges);

  [[nodiscard]] AffineDisplacement const& carried() const { return carried_; }
  /// Makes the images of all vertices.
  std::vector<Vec3> run(Place const& place);

 private:
  void set(int v, Vec3 const& residual);
  [[nodiscard]] Vec3 residual(int v) const { return image_[v] - points_[v] - carried_(points_[v]); }
  [[nodiscard]] std::vector<int> cuts(PatchGrid const& grid, int direction) const;
  void set_corners(std::vector<int> corners);
  void set_side(std::vector<int> const& side);
  void set_by_layers();
  void set_inside(PatchGrid const& grid, int a0, int a1, int b0, int b1);

  PatchSurface const& surface_;
  std::vector<Vec3> const& points_;
  std::vector<char> const& known_;
  Edges const& edges_;
  AffineDisplacement carried_;
  Place const* place_ = nullptr;
  std::vector<char> set_;
  std::vector<Vec3> image_;
};

/// Where the nodes of a surface end that shall go to `wanted` smoothly, and to where `place` puts a point exactly (on a
/// target; as it is, for no target). What that adds to wanted, c = x - wanted, is made smooth along the surface: every
/// sweep replaces c by the mean of its neighbours' along grid lines (sides of faces), weighted by one over their
/// distance, and places wanted + c again. So a node goes straight to the target where the target is smooth and near,
/// and where closest points heap up (beside sharp edges that bulge) the nodes spread again as `wanted` has them. Begins
/// with `start`, where known nodes stay. Damped Jacobi sweeps, so the numbering does not matter; at most 200, ended
/// when no node moves by more than a thousandth of the distance to its neighbours. Cost O(nodes) calls of `place` per
/// sweep, fewer where nothing changes any more.
std::vector<Vec3> relax(PatchSurface const& surface, std::vector<char> const& known, std::vector<Vec3> const& wanted,
                        std::vector<Vec3> start, std::function<Vec3(int vertex, Vec3 const& point)> const& place);

}  // namespace gridmorph
