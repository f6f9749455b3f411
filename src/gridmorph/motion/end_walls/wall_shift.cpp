#include <gridmorph/motion/end_walls/extended_blades.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/smoothstep.hpp>
#include <gridmorph/motion/detail/edge_distances.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace gridmorph {

namespace {

/// A node of a rim, or a periodic copy, and how much farther it goes.
struct Pull {
  Vec3 at, shift;
};

Vec3 pulled(std::vector<Pull> const& pulls, Vec3 const& p) {
  Vec3 sum;
  double weights = 0;
  for (auto const& [at, shift] : pulls) {
    double const d2 = dot(p - at, p - at), w = 1 / (d2 * d2);
    if (!std::isfinite(w)) return shift;
    sum += w * shift;
    weights += w;
  }
  return (1 / weights) * sum;
}

/// Copies of a node get the mean of what they got, by way of the one with the smallest number.
void make_periodic(std::vector<VertexImage> const& images, std::vector<Vec3>& shift) {
  std::vector<Vec3> mean = shift;
  std::vector<int> n(shift.size(), 1);
  for (VertexImage const& image : images) {
    mean[image.vertex] += transpose(image.rotation) * shift[image.image];
    ++n[image.vertex];
  }
  for (std::size_t v = 0; v < shift.size(); ++v)
    if (n[v] > 1) shift[v] = (1.0 / n[v]) * mean[v];
  for (VertexImage const& image : images)  // ascending
    if (image.image < image.vertex) shift[image.vertex] = transpose(image.rotation) * shift[image.image];
}

}  // namespace

WallShift::WallShift(Boundary const& boundary, MovedWall const& wall, std::span<ExtensionMotion const* const> blades,
                     std::string const& name)
    : name_(name), surface_(&wall.surface()), displacement_(wall.displacement()) {
  auto const& points = surface_->points;
  std::vector<int> rim;
  std::vector<Vec3> rim_displacement;
  std::vector<char> of_blade(boundary.patches().size(), 0), is_rim(points.size(), 0);
  for (ExtensionMotion const* blade : blades) {
    for (PatchGrid const& grid : blade->surface().grids) of_blade[grid.patch] = 1;
    for (std::size_t b = 0; b < blade->surface().points.size(); ++b) {
      int const v = surface_->numbers.find(blade->surface().points[b]);
      if (v < 0 || std::exchange(is_rim[v], 1) != 0) continue;
      rim.push_back(v);
      rim_displacement.push_back(blade->displacement()[b]);
    }
  }
  std::vector<Pull> pulls;
  bool any = false;
  auto const transforms = boundary.periodic_transforms(wall.patches());
  for (std::size_t k = 0; k < rim.size(); ++k) {
    Vec3 const& p = points[rim[k]];
    Vec3 const e = wall.shift_to(rim[k], rim_displacement[k], name);
    any = any || e != Vec3{};
    pulls.push_back({p, e});
    for (RigidTransform const& t : transforms)
      for (RigidTransform const& copy : {t, t.inverse()}) pulls.push_back({copy(p), copy.rotation * e});
  }
  if (!any) return;

  auto const images = vertex_images(boundary, *surface_);
  auto const away = edge_distances(*surface_, images, rim);
  for (int const p : wall.patches()) of_blade[p] = 1;
  double reach = std::numeric_limits<double>::infinity(), farthest = 0;
  for (std::size_t q = 0; q < of_blade.size(); ++q) {
    if (of_blade[q] != 0) continue;
    for (Index const n : boundary.surface(int(q)).nodes)
      if (int const v = surface_->numbers.find(boundary.coordinates()[n]); v >= 0 && away[v] > 0)
        reach = std::min(reach, away[v]);
  }
  for (double const d : away)
    if (std::isfinite(d)) farthest = std::max(farthest, d);
  reach = std::min(reach, farthest);

  std::vector<Vec3> shift(points.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (!(away[v] < reach)) continue;
    shift[v] = (1 - smoothstep(away[v] / reach)) * pulled(pulls, points[v]);
  }
  make_periodic(images, shift);
  for (std::size_t v = 0; v < points.size(); ++v) displacement_[v] = wall.displaced(int(v), shift[v]);
  for (std::size_t k = 0; k < rim.size(); ++k) displacement_[rim[k]] = rim_displacement[k];
}

void WallShift::displacement(std::span<Vec3 const> at, std::span<Vec3> out) const {
  for (std::size_t n = 0; n < at.size(); ++n) {
    int const v = surface_->numbers.find(at[n]);
    if (v < 0)
      throw MotionError(name_ + ": the point " + to_text(at[n], 9) +
                        " is no node of its patches; around blades that are extended there is no other place");
    out[n] = displacement_[v];
  }
}

}  // namespace gridmorph
