#include <gridmorph/motion/target/target_motion.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/motion/target/target_mappings.hpp>
#include <gridmorph/motion/target/target_projection.hpp>

#include <cmath>
#include <optional>
#include <utility>

namespace gridmorph {

namespace {

/// Points of a target closer than this share of its size are one: files in single precision.
constexpr double same_point = 1e-7;

bool finite(std::vector<Vec3> const& points) {
  for (Vec3 const& p : points)
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return false;
  return true;
}

std::string sizes(PatchSurface const& surface, TargetGeometry const& target) {
  std::string text = "patches have";
  for (PatchGrid const& g : surface.grids)
    text += " " + std::to_string(g.extent[0]) + " x " + std::to_string(g.extent[1]);
  text += ", grids of the target";
  for (TargetGrid const& g : target.grids)
    text += " " + std::to_string(g.extent[0]) + " x " + std::to_string(g.extent[1]);
  return text + (target.grids.empty() ? " there are none" : "");
}

}  // namespace

std::string_view to_string(TargetRule::Mapping mapping) {
  switch (mapping) {
    case TargetRule::Mapping::nodes: return "nodes";
    case TargetRule::Mapping::sections: return "sections";
    case TargetRule::Mapping::projection: return "projection";
    default: return "automatic";
  }
}

TargetTree target_facets(TargetGeometry const& target, std::string const& name) {
  std::vector<Vec3> all = target.points;
  std::vector<std::array<int, 3>> triangles;
  for (auto const& t : target.triangles) {
    for (int const v : t)
      if (v < 0 || v >= int(target.points.size()))
        throw MotionError(name + ": a triangle of the target names point " + std::to_string(v) + " of " +
                          std::to_string(target.points.size()));
    triangles.push_back(t);
  }
  for (TargetGrid const& grid : target.grids) {
    if (grid.extent[0] < 1 || grid.extent[1] < 1 ||
        std::size_t(grid.extent[0]) * std::size_t(grid.extent[1]) != grid.points.size())
      throw MotionError(name + ": grid '" + grid.name + "' of the target has " + std::to_string(grid.points.size()) +
                        " points for " + std::to_string(grid.extent[0]) + " x " + std::to_string(grid.extent[1]));
    int const first = int(all.size()), n = grid.extent[0];
    all.insert(all.end(), grid.points.begin(), grid.points.end());
    for (int b = 0; b + 1 < grid.extent[1]; ++b)
      for (int a = 0; a + 1 < n; ++a) {
        int const v = first + a + n * b;
        triangles.push_back({v, v + 1, v + 1 + n});
        triangles.push_back({v, v + 1 + n, v + n});
      }
  }
  if (!finite(all)) throw MotionError(name + ": a point of the target is not finite");
  double const size = box_diagonal(all);
  PointNumbers numbers(same_point * size);
  std::vector<Vec3> points;
  std::vector<int> number;
  for (Vec3 const& p : all) {
    number.push_back(numbers.find_or_add(p, int(points.size())));
    if (number.back() == int(points.size())) points.push_back(p);
  }
  std::vector<std::array<int, 3>> kept;
  for (auto const& t : triangles) {
    std::array<int, 3> const u{number[t[0]], number[t[1]], number[t[2]]};
    if (u[0] != u[1] && u[1] != u[2] && u[2] != u[0]) kept.push_back(u);
  }
  if (kept.empty())
    throw MotionError(name +
                      ": the target holds no facets to project to; give a surface (STL, CGNS), or for points "
                      "of the nodes mapping = \"nodes\"");
  return {std::move(points), std::move(kept)};
}

TargetMotion::TargetMotion(Boundary const& boundary, std::vector<int> const& patches, TargetRule const& rule,
                           Axis const& axis, BesideTarget const& beside, std::string const& name,
                           std::vector<std::string>& notes)
    : surface_(boundary, patches), name_(name), share_(rule.share) {
  if (!rule.target) throw MotionError(name + ": it has no target");
  TargetGeometry const& target = *rule.target;
  if (!(rule.crease_angle_deg > 0 && rule.crease_angle_deg < 180))
    throw MotionError(name + ": the crease angle is " + std::to_string(rule.crease_angle_deg) +
                      " degrees; give one between 0 and 180");
  if (patches.empty()) throw MotionError(name + ": it moves patches only, and names none");
  if (!(surface_.size > 0)) throw MotionError(name + ": the nodes of its patches are one point");
  if (!surface_.gridded) {
    map_faces(boundary, rule, axis, beside, notes);
    return;
  }
  bool const automatic = rule.mapping == Mapping::automatic;
  if (rule.mapping == Mapping::nodes || (automatic && target.sections.empty())) {
    mapping_ = Mapping::nodes;
    if (!finite(target.nodes)) throw MotionError(name + ": a point of the target is not finite");
    if (!target.nodes.empty()) {
      displacement_ = match_nodes(surface_, target.nodes, boundary, name);
      notes.push_back(name + ": mapped node for node");
      return;
    }
    if (!target.grids.empty()) static_cast<void>(target_facets(target, name));  // its checks
    if (target.triangles.empty() || !automatic)
      if (auto u = match_grids(surface_, target.grids, boundary, name, notes)) {
        displacement_ = std::move(*u);
        return;
      }
    if (!automatic)
      throw MotionError(name + ": not every patch has a grid of its size in the target (" + sizes(surface_, target) +
                        "); give one of the same size each, or mapping = \"projection\"");
  }
  if (rule.mapping == Mapping::sections || (automatic && !target.sections.empty())) {
    map_onto_sections(boundary, rule, axis, notes);
    return;
  }
  mapping_ = Mapping::projection;
  project(boundary, rule, axis, beside, notes);
}

TargetMotion::TargetMotion(TargetMotion const& other, double share) : TargetMotion(other) { share_ = share; }

void TargetMotion::map_onto_sections(Boundary const& boundary, TargetRule const& rule, Axis const& axis,
                                     std::vector<std::string>& notes) {
  mapping_ = Mapping::sections;
  SectionMapping mapped = map_sections(boundary, surface_, rule, axis, name_, notes);
  displacement_ = std::move(mapped.displacement);
  reached_ = std::move(mapped.mapped);
  facets_ = std::move(mapped.facets);
  to_target_ = std::move(mapped.to_target);
}

void TargetMotion::project(Boundary const& boundary, TargetRule const& rule, Axis const& axis,
                           BesideTarget const& beside, std::vector<std::string>& notes) {
  facets_ = cut_at_sides(target_facets(*rule.target, name_), sides_beside(boundary, surface_, beside, axis));
  displacement_ = project_to_target(surface_, facets_, vertices_on(boundary, surface_, beside.fixed),
                                    rule.crease_angle_deg, name_, notes);
}

void TargetMotion::map_faces(Boundary const& boundary, TargetRule const& rule, Axis const& axis,
                             BesideTarget const& beside, std::vector<std::string>& notes) {
  TargetGeometry const& target = *rule.target;
  for (PatchGrid const& grid : surface_.grids)
    if (grid.faces.empty())
      throw MotionError(name_ + ": patch " + boundary.describe_patch(grid.patch) +
                        " has no faces that could go to a target");
  if (rule.mapping == Mapping::nodes || (rule.mapping == Mapping::automatic && !target.nodes.empty())) {
    if (target.nodes.empty())
      throw MotionError(
          name_ +
          ": the patches of an unstructured mesh are no grids; list one point per node in the order of their "
          "numbers, or give mapping = \"projection\"");
    if (!finite(target.nodes)) throw MotionError(name_ + ": a point of the target is not finite");
    displacement_ = match_nodes(surface_, target.nodes, boundary, name_);
    notes.push_back(name_ + ": mapped node for node");
    return;
  }
  mapping_ = Mapping::projection;
  if (surface_.lines) {
    for (TargetSection const& section : target.sections)
      if (!finite(section.points)) throw MotionError(name_ + ": a point of the target is not finite");
    displacement_ = project_to_profile(surface_, target, sides_beside(boundary, surface_, beside, axis),
                                       vertices_on(boundary, surface_, beside.fixed), name_, notes);
    return;
  }
  if (rule.mapping == Mapping::sections || !target.sections.empty()) {
    if (std::optional<PatchSurface> grids = surface_.in_grids(boundary)) surface_ = std::move(*grids);
    map_onto_sections(boundary, rule, axis, notes);
    return;
  }
  project(boundary, rule, axis, beside, notes);
}

void TargetMotion::displacement(std::span<Vec3 const> points, std::span<Vec3> out) const {
  for (std::size_t n = 0; n < points.size(); ++n) {
    int const v = surface_.numbers.find(points[n]);
    if (v < 0)
      throw MotionError(name_ + ": the point " + to_text(points[n], 9) +
                        " is no node of its patches; a target says where they go and nothing else");
    out[n] = share_ == 1 ? displacement_[v] : share_ * displacement_[v];
  }
}

TargetReach TargetMotion::reach(Coordinates const& morphed) const {
  TargetReach out;
  out.description = name_;
  out.mapping = mapping_;
  double sum = 0;
  for (std::size_t g = 0; g < surface_.grids.size(); ++g) {
    PatchGrid const& grid = surface_.grids[g];
    for (std::size_t at = 0; at < grid.nodes.size(); ++at) {
      Index const node = grid.nodes[at];
      int const v = grid.vertex[at];
      if (!reached_.empty() && reached_[v] == 0) continue;
      Vec3 const x = morphed[node];
      double const d = facets_.empty() ? distance(x, surface_.points[v] + displacement_[v])
                                       : facets_.closest(to_target_.empty() ? x : to_target_[g](x)).distance;
      sum += d * d;
      ++out.nodes;
      if (out.worst_node < 0 || d > out.max) {
        out.max = d;
        out.worst_node = node;
      }
    }
  }
  out.rms = out.nodes > 0 ? std::sqrt(sum / double(out.nodes)) : 0;
  return out;
}

}  // namespace gridmorph
