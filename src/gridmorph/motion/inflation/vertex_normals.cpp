#include <gridmorph/motion/inflation/surface_offset.hpp>

#include <gridmorph/geometry/barycentric.hpp>
#include <gridmorph/geometry/target_tree.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

namespace gridmorph {

namespace {

/// Unit normal of a face at one of its corners, and the angle of the corner.
struct Corner {
  Vec3 normal;
  double angle = 0;
};
using Corners = std::vector<std::vector<Corner>>;  ///< per vertex

/// Unit normal of a facet; zero without area.
Vec3 facet_normal(std::vector<Vec3> const& points, GridFacet const& facet, int corners) {
  Vec3 const origin = points[facet[0]];
  Vec3 sum;
  for (int c = 1; c + 1 < corners; ++c) sum += cross(points[facet[c]] - origin, points[facet[c + 1]] - origin);
  double const length = norm(sum);
  return length > 0 ? (1 / length) * sum : Vec3{};
}

Corners corners_of_lines(PatchSurface const& surface, Vec3 const& across) {
  Corners out(surface.points.size());
  for (PatchGrid const& grid : surface.grids)
    for (GridFacet const& face : grid.faces) {
      Vec3 const normal = cross(across, surface.points[face[1]] - surface.points[face[0]]);
      if (!(norm(normal) > 0)) continue;
      for (int c = 0; c < 2; ++c) out[face[c]].push_back({(1 / norm(normal)) * normal, std::numbers::pi});
    }
  return out;
}

Corners corners_of_facets(PatchSurface const& surface) {
  auto const& points = surface.points;
  Corners out(points.size());
  for (GridFacet const& facet : surface.facets()) {
    int const n = facet[3] < 0 ? 3 : 4;
    Vec3 const whole = facet_normal(points, facet, n);
    if (whole == Vec3{}) continue;
    for (int c = 0; c < n; ++c) {
      auto const v = std::size_t(facet[c]);
      Vec3 const next = points[facet[(c + 1) % n]] - points[v];
      Vec3 const before = points[facet[(c + n - 1) % n]] - points[v];
      Vec3 const own = cross(next, before);
      double const angle = std::atan2(norm(own), dot(next, before));
      // A corner of 180 degrees has no normal, and that of a re-entrant one points the other way.
      bool const has_own = norm(own) > 1e-12 * norm(next) * norm(before) && dot(own, whole) > 0;
      if (angle > 0) out[v].push_back({has_own ? (1 / norm(own)) * own : whole, angle});
    }
  }
  return out;
}

/// Adds to every vertex the corners of its images.
void join_images(std::vector<VertexImage> const& images, Corners& corners) {
  std::map<int, std::vector<VertexImage const*>> of;
  for (VertexImage const& image : images) of[image.vertex].push_back(&image);
  std::vector<std::pair<int, std::vector<Corner>>> joined;
  for (auto const& [v, own] : of) {
    std::map<int, Mat3> reached{{v, Mat3{}}};  // rotation from v
    std::vector<int> front{v};
    std::vector<Corner> all = corners[v];
    while (!front.empty()) {
      int const at = front.back();
      front.pop_back();
      for (VertexImage const* image : of.at(at)) {
        auto const [to, fresh] = reached.try_emplace(image->image, image->rotation * reached.at(at));
        if (!fresh) continue;
        Mat3 const back = transpose(to->second);
        for (auto const& [normal, angle] : corners[image->image]) all.push_back({back * normal, angle});
        front.push_back(image->image);
      }
    }
    joined.emplace_back(v, std::move(all));
  }
  for (auto& [v, all] : joined) corners[v] = std::move(all);
}

/// Means of what hangs together by steps of less than the crease angle.
std::vector<Vec3> smooth_parts(std::vector<Corner> const& corners, double least_cosine) {
  std::vector<std::size_t> part(corners.size());
  for (std::size_t k = 0; k < corners.size(); ++k) {
    part[k] = k;
    for (std::size_t j = 0; j < k; ++j) {
      if (part[j] == part[k] || dot(corners[j].normal, corners[k].normal) < least_cosine) continue;
      std::size_t const stays = std::min(part[j], part[k]), gone = std::max(part[j], part[k]);
      std::replace(part.begin(), part.begin() + std::ptrdiff_t(k) + 1, gone, stays);
    }
  }
  std::vector<Vec3> out;
  for (std::size_t p = 0; p < corners.size(); ++p) {
    Vec3 sum;
    double angles = 0;
    for (std::size_t k = 0; k < corners.size(); ++k)
      if (part[k] == p) {
        sum += corners[k].angle * corners[k].normal;
        angles += corners[k].angle;
      }
    if (norm(sum) > 1e-6 * angles) out.push_back((1 / norm(sum)) * sum);
  }
  return out;
}

/// The parts that the corners around a point have in common, meaned.
class BetweenCorners {
 public:
  BetweenCorners(PatchSurface const& surface, double least_cosine) : least_cosine_(least_cosine) {
    std::vector<std::array<int, 3>> triangles;
    for (GridFacet const& f : surface.facets()) {
      triangles.push_back({f[0], f[1], f[2]});
      if (f[3] >= 0) triangles.push_back({f[0], f[2], f[3]});
    }
    for (PatchGrid const& grid : surface.grids)
      for (GridFacet const& f : grid.faces)
        if (f[2] < 0) triangles.push_back({f[0], f[1], f[1]});
    tree_ = TargetTree(surface.points, std::move(triangles));
  }

  [[nodiscard]] std::vector<Vec3> at(Vec3 const& p, std::vector<std::vector<Vec3>> const& of) const {
    TargetTree::Hit const hit = tree_.closest(p);
    if (hit.triangle < 0) return {};
    auto const& corner = tree_.triangles()[hit.triangle];
    auto const& x = tree_.points();
    std::array<double, 3> const weight = barycentric(hit.point, x[corner[0]], x[corner[1]], x[corner[2]]);
    std::vector<Vec3> out;
    bool first = true;
    for (std::size_t c = 0; c < 3; ++c) {
      if (weight[c] < 0.2) continue;  // the middle of a side has none of the third corner
      auto const& theirs = of[corner[c]];
      if (std::exchange(first, false)) {
        out = theirs;
        continue;
      }
      std::erase_if(out, [&](Vec3 const& n) {
        return std::none_of(theirs.begin(), theirs.end(), [&](Vec3 const& m) { return near(n, m); });
      });
      for (Vec3& n : out) {
        Vec3 const m = *std::max_element(theirs.begin(), theirs.end(),
                                         [&](Vec3 const& a, Vec3 const& b) { return dot(a, n) < dot(b, n); });
        n = (1 / norm(n + m)) * (n + m);
      }
    }
    return out;
  }

 private:
  [[nodiscard]] bool near(Vec3 const& n, Vec3 const& m) const { return dot(n, m) >= least_cosine_ * norm(n) * norm(m); }
  double least_cosine_;
  TargetTree tree_;
};

}  // namespace

VertexNormals::VertexNormals(Boundary const& boundary, PatchSurface const& surface,
                             std::vector<VertexImage> const& images, double crease_angle_deg) {
  double const least_cosine = std::cos(crease_angle_deg * std::numbers::pi / 180);
  Corners corners = surface.lines ? corners_of_lines(surface, boundary.across()) : corners_of_facets(surface);
  join_images(images, corners);
  std::vector<std::vector<Vec3>> parts;
  for (auto const& own : corners) parts.push_back(smooth_parts(own, least_cosine));
  std::optional<BetweenCorners> between;
  for (std::size_t v = 0; v < parts.size(); ++v) {
    if (corners[v].empty() && !between) between.emplace(surface, least_cosine);
    std::vector<Vec3> const own = corners[v].empty() ? between->at(surface.points[v], parts) : parts[v];
    parts_.insert(parts_.end(), own.begin(), own.end());
    first_.push_back(parts_.size());
  }
}

}  // namespace gridmorph
