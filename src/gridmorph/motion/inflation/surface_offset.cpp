#include <gridmorph/motion/inflation/surface_offset.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/smoothstep.hpp>
#include <gridmorph/geometry/symmetric_eigen.hpp>
#include <gridmorph/motion/detail/slip_correction.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace gridmorph {

namespace {

/// Normals that leave less of themselves than this across the kept directions say nothing.
constexpr double least_part = 1e-6;
/// Heights that a vertex goes at most.
constexpr double longest = 2;

Vec3 uncut_direction(std::span<Vec3 const> normals, std::span<Vec3 const> kept) {
  std::vector<Vec3> basis;  // orthonormal, of the kept directions
  for (Vec3 k : kept) {
    for (Vec3 const& b : basis) k = k - dot(k, b) * b;
    if (norm(k) > least_part) basis.push_back((1 / norm(k)) * k);
  }
  Moments moments;
  Vec3 sum, only;
  double trace = 0;
  for (Vec3 m : normals) {
    for (Vec3 const& b : basis) m = m - dot(m, b) * b;
    if (norm(m) <= least_part) continue;
    moments.add(1, m);
    trace += dot(m, m);
    sum += m;
    only = m;
  }
  if (!(trace > 0)) return {};
  Vec3 d;
  if (normals.size() == 1) {
    d = (1 / dot(only, only)) * only;
  } else {
    PrincipalAxes const axes(moments);
    for (std::size_t k = 0; k < 3; ++k)
      if (axes.moment[k] > 1e-10 * trace) d += (dot(axes.direction[k], sum) / axes.moment[k]) * axes.direction[k];
  }
  return d;
}

Vec3 cut(Vec3 const& d) {
  double const length = norm(d);
  return length > longest ? (longest / length) * d : d;
}

}  // namespace

Vec3 offset_direction(std::span<Vec3 const> normals, std::span<Vec3 const> kept) {
  return cut(uncut_direction(normals, kept));
}

SurfaceOffset::SurfaceOffset(Boundary const& boundary, PatchSurface const& surface, SlipSurfaces const& slip,
                             double crease_angle_deg, std::string const& name)
    : SurfaceOffset(boundary, surface, vertex_images(boundary, surface), slip, crease_angle_deg, name) {}

SurfaceOffset::SurfaceOffset(Boundary const& boundary, PatchSurface const& surface,
                             std::vector<VertexImage> const& images, SlipSurfaces const& slip, double crease_angle_deg,
                             std::string const& name)
    : points_(surface.points), normals_(boundary, surface, images, crease_angle_deg) {
  find_rims(boundary, surface, slip);
  direction_.resize(points_.size());
  for (std::size_t v = 0; v < points_.size(); ++v) {
    std::vector<Vec3> kept;
    for (int const s : rims_[v]) kept.push_back(slip_normal(*touched_[s], points_[v]));
    auto const parts = normals_.parts(int(v));
    Vec3 const uncut = uncut_direction(parts, kept);
    direction_[v] = cut(uncut);
    if (norm(uncut) > longest) ++limited_;
    at_creases_ += parts.size() > 1 ? 1 : 0;
    if (direction_[v] == Vec3{} && kept.empty())
      throw MotionError(
          name + ": there is no normal at " + to_text(points_[v], 9) +
          ", where the sides of a wall without thickness meet or faces have no area; name one side of it");
  }
  fade(surface, images);
}

void SurfaceOffset::find_rims(Boundary const& boundary, PatchSurface const& surface, SlipSurfaces const& slip) {
  rims_.resize(points_.size());
  std::map<int, int> number;  // of slip surfaces, in touched_
  std::vector<char> own(boundary.patches().size(), 0);
  for (PatchGrid const& grid : surface.grids) own[grid.patch] = 1;
  for (std::size_t q = 0; q < own.size(); ++q) {
    int const s = slip.of_patch[q];
    if (s < 0 || own[q] != 0) continue;
    for (Index const n : boundary.surface(int(q)).nodes) {
      int const v = surface.numbers.find(boundary.coordinates()[n]);
      if (v < 0) continue;
      auto const [at, fresh] = number.try_emplace(s, int(touched_.size()));
      if (fresh) touched_.push_back(&slip.surfaces[s]);
      auto& rims = rims_[v];
      if (std::find(rims.begin(), rims.end(), at->second) == rims.end()) rims.push_back(at->second);
    }
  }
  for (auto& rims : rims_) std::sort(rims.begin(), rims.end());
}

void SurfaceOffset::fade(PatchSurface const& surface, std::vector<VertexImage> const& images) {
  slides_.resize(points_.size());
  if (touched_.empty()) return;
  std::vector<std::vector<double>> away;
  std::vector<double> farthest;
  for (std::size_t s = 0; s < touched_.size(); ++s) {
    std::vector<int> sources;
    for (std::size_t v = 0; v < points_.size(); ++v)
      if (std::find(rims_[v].begin(), rims_[v].end(), int(s)) != rims_[v].end()) sources.push_back(int(v));
    away.push_back(edge_distances(surface, images, sources));
    farthest.push_back(0);
    for (double const d : away.back())
      if (std::isfinite(d)) farthest.back() = std::max(farthest.back(), d);
  }
  for (std::size_t v = 0; v < points_.size(); ++v) {
    if (!rims_[v].empty()) continue;
    for (std::size_t s = 0; s < touched_.size(); ++s) {
      double const d = away[s][v];
      if (!(d < farthest[s])) continue;
      double share = 1 - d / farthest[s];
      for (std::size_t t = 0; t < touched_.size(); ++t)
        if (t != s && std::isfinite(away[t][v])) share *= away[t][v] / (d + away[t][v]);
      Vec3 const normal = slip_normal(*touched_[s], points_[v]);
      // Faces along the slip surface, as that of a tip, cannot be offset within it.
      double least = 1;
      for (Vec3 const& n : normals_.parts(int(v))) least = std::min(least, 1 - dot(n, normal) * dot(n, normal));
      share *= smoothstep((least - 0.1) / (0.3 - 0.1));
      if (share > 0) slides_[v].push_back({touched_[s], share, offset_direction(normals_.parts(int(v)), {&normal, 1})});
    }
  }
}

Vec3 SurfaceOffset::displacement(int v, double height) const {
  if (height == 0) return {};
  Vec3 const& p = points_[v];
  Vec3 u = height * direction_[v];
  auto const& rims = rims_[v];
  if (!rims.empty()) {
    // On one surface the first pass is exact; on the edge of two curved ones a few more come to it.
    for (int pass = 0; pass < (rims.size() == 1 ? 1 : 4); ++pass)
      for (int const s : rims) u += slip_correction(*touched_[s], p, u);
    return u;
  }
  Vec3 const straight = u;
  for (Slide const& slide : slides_[v]) {
    Vec3 const along = height * slide.direction;
    // Off a surface of facets a foot need not be below the point, and the way to it is none that vanishes with the
    // height.
    bool const facets = slide.surface->kind == SlipSurface::Kind::facets;
    Vec3 const back = facets ? Vec3{} : slip_correction(*slide.surface, p, along);
    u += slide.share * (along + back - straight);
  }
  return u;
}

}  // namespace gridmorph
