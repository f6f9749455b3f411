#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/geometry/plane_fit.hpp>
#include <gridmorph/motion/carry/carried_features.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace gridmorph {

namespace {

std::vector<int> connected_parts(PatchSurface const& surface) {
  DisjointSets<int> sets(surface.points.size());
  auto const neighbours = surface.neighbours();
  for (std::size_t v = 0; v < neighbours.size(); ++v)
    for (int const w : neighbours[v]) sets.join(int(v), w);
  return sets.set_numbers();
}

/// Part of the walls around the rim of a feature.
struct RimFaces {
  std::vector<Vec3> before, after;
  std::vector<double> area;

  void add(Vec3 const& x, Vec3 const& u, double own) {
    before.push_back(x);
    after.push_back(x + u);
    area.push_back(own);
  }
  void append(RimFaces const& other) {
    before.insert(before.end(), other.before.begin(), other.before.end());
    after.insert(after.end(), other.after.begin(), other.after.end());
    area.insert(area.end(), other.area.begin(), other.area.end());
  }
  [[nodiscard]] double largest() const {
    double most = 0;
    for (std::size_t n = 0; n < before.size(); ++n) most = std::max(most, distance(before[n], after[n]));
    return most;
  }
  /// The mean by which the ring moves otherwise than a rigid motion says, weighted by area.
  [[nodiscard]] Vec3 misfit(RigidFit const& fit) const {
    Vec3 sum;
    double total = 0;
    for (std::size_t n = 0; n < before.size(); ++n) {
      sum += area[n] * (after[n] - before[n] - displacement(fit, before[n]));
      total += area[n];
    }
    return (1 / total) * sum;
  }
};

/// The rings of all features on one wall.
class WallRings {
 public:
  /// `feature_at`: the number of the feature that has a node at a point, -1: none.
  template <class FeatureAt>
  WallRings(Boundary const& boundary, int wall, FeatureAt const& feature_at) : surface_(boundary, {wall}) {
    for (Vec3 const& x : surface_.points) feature_of_.push_back(feature_at(x));
    for (GridFacet const& f : surface_.facets()) add(f, 0.5 * norm(facet_normal(surface_.points, f)));
    if (!surface_.lines) return;
    across_ = boundary.across();
    for (GridFacet const& f : surface_.grids.front().faces)
      add(f, distance(surface_.points[f[0]], surface_.points[f[1]]));
  }

  /// The nodes that features have as well.
  [[nodiscard]] std::vector<Vec3> rim() const {
    std::vector<Vec3> out;
    for (std::size_t v = 0; v < feature_of_.size(); ++v)
      if (feature_of_[v] >= 0) out.push_back(surface_.points[v]);
    return out;
  }
  /// The rings by feature; displacement(points, out): that of the wall's nodes.
  template <class Displacement>
  [[nodiscard]] std::map<int, RimFaces> rings(Displacement const& displacement) const {
    std::vector<Vec3> points, u;
    for (auto const& [at, area] : share_) points.push_back(surface_.points[at.second]);
    u.resize(points.size());
    displacement(points, u);
    std::map<int, RimFaces> out;
    std::size_t n = 0;
    for (auto const& [at, area] : share_) {
      RimFaces& ring = out[at.first];
      ring.add(points[n], u[n], area);
      // Points on a line do not say how it turns about itself; lines of a plane mesh are strips.
      if (surface_.lines) ring.add(points[n] + across_, u[n], area);
      ++n;
    }
    return out;
  }

 private:
  void add(GridFacet const& facet, double size) {
    auto const corners = std::size_t(std::count_if(facet.begin(), facet.end(), [](int v) { return v >= 0; }));
    std::array<int, 4> touched{-1, -1, -1, -1};
    for (std::size_t c = 0; c < corners; ++c) {
      int const f = feature_of_[facet[c]];
      if (f < 0 || std::find(touched.begin(), touched.end(), f) != touched.end()) continue;
      touched[c] = f;
      for (std::size_t k = 0; k < corners; ++k) share_[{f, facet[k]}] += size / double(corners);
    }
  }

  PatchSurface surface_;
  Vec3 across_;
  std::vector<int> feature_of_;                  ///< per vertex
  std::map<std::pair<int, int>, double> share_;  ///< of (feature, vertex): area
};

/// The direction along which features keep their places, if any.
class KeptDirection {
 public:
  KeptDirection(PatchSurface const& surface, std::vector<int> const& feature_of, CarryRule const& rule,
                Axis const& axis)
      : surface_(surface), feature_of_(feature_of), constraint_(rule.constraint), axis_(axis) {}

  [[nodiscard]] std::optional<Vec3> of(int feature) const {
    if (constraint_ == FreeRule::Constraint::none) return std::nullopt;
    if (constraint_ == FreeRule::Constraint::axial) return (1 / norm(axis_.direction)) * axis_.direction;
    return normal(feature);
  }

 private:
  [[nodiscard]] Vec3 normal(int feature) const {
    constexpr double flat = 1e-6;  // deviation of a plane, of what the patch extends to
    std::optional<Vec3> found;
    for (PatchGrid const& grid : surface_.grids) {
      std::vector<Vec3> points;
      for (int const v : grid.vertex)
        if (feature_of_[v] == feature) points.push_back(surface_.points[v]);
      if (points.empty()) continue;
      PlaneFit const plane = fit_plane(points);
      if (!plane.determined || plane.deviation > flat * plane.extent) continue;
      if (found && norm(cross(*found, plane.normal)) > flat)
        throw MotionError("has flat patches across " + to_text(*found, 3) + " and across " + to_text(plane.normal, 3) +
                          ", which cannot both be kept; give these patches rules of their own");
      found = plane.normal;
    }
    if (!found)
      throw MotionError(
          "has no flat patch whose plane could be kept; take the constraint away, or name the flat patch");
    return *found;
  }

  PatchSurface const& surface_;
  std::vector<int> const& feature_of_;
  FreeRule::Constraint constraint_;
  Axis axis_;
};

/// The part of a fit that keeps what lies along d.
RigidFit keep_along(RigidFit fit, RimFaces const& ring, Vec3 const& d) {
  double sine = 0, cosine = 0;
  for (std::size_t n = 0; n < ring.before.size(); ++n) {
    Vec3 const b = ring.before[n] - fit.from, c = ring.after[n] - fit.to;
    sine += ring.area[n] * dot(d, cross(b, c));
    cosine += ring.area[n] * (dot(b, c) - dot(b, d) * dot(c, d));
  }
  fit.rotation = rotation_by(std::atan2(sine, cosine) * d);
  fit.to = fit.to - dot(fit.to - fit.from, d) * d;
  return fit;
}

RigidFit motion_of_ring(RimFaces const& ring) {
  auto const fit = rigid_fit(ring.before, ring.after, ring.area);
  if (!fit)
    throw MotionError(
        "meets faces of the walls that have no area, or that are moved onto a line or mirrored; narrow `of`, or "
        "correct the rule of the walls");
  return *fit;
}

RimFaces together(std::map<int, RimFaces> const& rings) {
  RimFaces all;
  for (auto const& [rule, ring] : rings) all.append(ring);
  return all;
}

/// Features between walls that part, as shrouds between blades, have no rigid motion.
void require_one_motion(std::map<int, RimFaces> const& by_rule, RimFaces const& all, RigidFit const& fit,
                        std::vector<MotionRule> const& rules) {
  constexpr double alike = 0.1;  // of the largest displacement: walls of different rules move as one by less
  if (by_rule.size() < 2) return;
  double const most = alike * all.largest();
  for (auto const& [r, ring] : by_rule) {
    Vec3 const off = ring.misfit(fit);
    if (!(norm(off) > most)) continue;
    MotionRule const& rule = rules[r];
    throw MotionError("meets walls of different motion: that of rule " + std::to_string(r + 1) + " (" +
                      std::string(rule_name(rule.rule)) + (rule.where.empty() ? "" : ", " + rule.where) + ") is " +
                      to_text(off, 3) + " off what would carry it, of " + to_text(all.largest(), 3) +
                      "; name one of the walls in `of`, or give the feature the rule free");
  }
}

}  // namespace

CarriedFeatures::CarriedFeatures(Boundary const& boundary, ResolvedMotion const& motion,
                                 std::vector<int> const& patches, CarryRule const& rule, std::vector<int> const& walls,
                                 Displacement const& displacement, std::string const& name)
    : name_(name), surface_(boundary, patches), feature_of_(connected_parts(surface_)) {
  std::size_t const count =
      feature_of_.empty() ? 0 : 1 + std::size_t(*std::max_element(feature_of_.begin(), feature_of_.end()));
  std::vector<std::map<int, RimFaces>> rings(count);  // by the rule of the walls
  std::vector<std::set<int>> rims(count);             // vertices
  for (int const wall : walls) {
    WallRings const on(boundary, wall, [&](Vec3 const& x) { return feature_at(x); });
    for (Vec3 const& x : on.rim()) rims[feature_at(x)].insert(surface_.numbers.find(x));
    auto const of_wall = [&](std::span<Vec3 const> x, std::span<Vec3> u) { displacement(wall, x, u); };
    for (auto const& [f, ring] : on.rings(of_wall)) rings[f][motion.patch[wall].rule].append(ring);
  }
  KeptDirection const kept(surface_, feature_of_, rule, motion.axis);
  Problems problems;
  for (std::size_t f = 0; f < count; ++f) try {
      if (rings[f].empty()) throw MotionError("has no node in common with faces of the walls in `of`");
      RimFaces const all = together(rings[f]);
      RigidFit const fit = motion_of_ring(all);
      require_one_motion(rings[f], all, fit, motion.rules);
      auto const direction = kept.of(int(f));
      features_.push_back(made(rims[f], direction ? keep_along(fit, all, *direction) : fit, rule.fade));
    } catch (MotionError const& e) {
      problems.add(name + ": the feature " + described(boundary, int(f)) + " " + e.what());
    }
  problems.throw_if_any<MotionError>();
}

int CarriedFeatures::feature_at(Vec3 const& point) const {
  int const v = surface_.numbers.find(point);
  return v < 0 ? -1 : feature_of_[v];
}

CarriedFeatures::Feature CarriedFeatures::made(std::set<int> const& rim, RigidFit const& motion,
                                               std::optional<double> const& fade) const {
  Feature out;
  out.motion = motion;
  Vec3 middle;
  for (int const v : rim) {
    out.rim.push_back(surface_.points[v]);
    middle += (1 / double(rim.size())) * out.rim.back();
  }
  for (Vec3 const& x : out.rim) out.fade = std::max(out.fade, distance(x, middle));
  out.fade = fade.value_or(out.fade);
  return out;
}

std::string CarriedFeatures::described(Boundary const& boundary, int feature) const {
  Vec3 sum;
  int count = 0;
  for (std::size_t v = 0; v < feature_of_.size(); ++v)
    if (feature_of_[v] == feature) {
      sum += surface_.points[v];
      ++count;
    }
  for (PatchGrid const& grid : surface_.grids)
    if (std::any_of(grid.vertex.begin(), grid.vertex.end(), [&](int v) { return feature_of_[v] == feature; }))
      return boundary.describe_patch(grid.patch) + " around " + to_text((1.0 / count) * sum, 4);
  return "without patches";
}

void CarriedFeatures::displacement(std::span<Vec3 const> points, std::span<Vec3> out) const {
  for (std::size_t n = 0; n < points.size(); ++n) {
    int const f = feature_at(points[n]);
    if (f < 0)
      throw MotionError(name_ + ": the point " + to_text(points[n], 9) +
                        " is no node of its patches, and what is not connected has no motion");
    out[n] = gridmorph::displacement(features_[f].motion, points[n]);
  }
}

}  // namespace gridmorph
