#include <gridmorph/core/error.hpp>
#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/plan/elements/background.hpp>
#include <gridmorph/plan/elements/classify.hpp>
#include <gridmorph/plan/elements/locate.hpp>
#include <gridmorph/plan/elements/unstructured_planner.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace gridmorph::detail {

namespace {

/// Near is what lies in the hole of a background mesh: within the box around its wrap (`wrap_nodes`, their positions),
/// but in none of its cells. Partially wrapped is what has a node there, or holds a node of the wrap. Cost: one search
/// in the background per node in that box, and one in the mesh per node of the wrap.
Classification classify_by_hole(HostInstance const& host, Mesh const& mesh, Background const& background,
                                std::vector<Vec3> const& wrap_nodes) {
  Box box;
  for (Vec3 const& p : wrap_nodes) box.include(p);
  auto const& [low, high] = box;
  std::vector<Index32> candidates;
  std::vector<Vec3> points;
  for (Index32 n = 0; n < Index32(mesh.n_nodes()); ++n) {
    Vec3 const x = mesh.coordinates[n];
    bool const flat = mesh.dimension == 2;
    if (x.x < low.x || x.x > high.x || x.y < low.y || x.y > high.y || (!flat && (x.z < low.z || x.z > high.z)))
      continue;
    candidates.push_back(n);
    points.push_back(x);
  }
  Classification out;
  out.inside.assign(mesh.n_nodes(), 0);
  auto const in_background = locate(host, as_hexahedra(background.mesh), points);
  for (std::size_t k = 0; k < candidates.size(); ++k) out.inside[candidates[k]] = in_background[k].distance > 0 ? 1 : 0;
  out.element.assign(mesh.n_elements(), Region::far);
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    auto const corners = mesh.elements.corners(e);
    auto const n = std::count_if(corners.begin(), corners.end(), [&](Index32 c) { return out.inside[c]; });
    if (n > 0) out.element[e] = std::size_t(n) == corners.size() ? Region::near : Region::partial;
  }
  for (Location const& place : locate(host, mesh, wrap_nodes))
    if (place.element >= 0 && out.element[place.element] == Region::far) out.element[place.element] = Region::partial;
  out.near.assign(mesh.n_nodes(), 0);
  for (Index e = 0; e < mesh.n_elements(); ++e)
    if (out.element[e] != Region::far)
      for (Index32 const n : mesh.elements.nodes[e]) out.near[n] = 1;
  out.count();
  return out;
}

}  // namespace

double UnstructuredPlanner::offset() {
  OffsetHints hints;
  hints.layer_height = out_.report.layer_height;
  hints.motion = rest_reach_;
  double sum = 0;
  Index count = 0;
  Box box;
  for (Index32 const f : driving_faces_) {
    auto const face = topology_.boundary.nodes[f];
    for (std::size_t k = 0; k < face.size(); ++k, ++count) {
      Vec3 const x = mesh_.coordinates[face[k]];
      sum += distance(x, mesh_.coordinates[face[(k + 1) % face.size()]]);
      box.include(x);
    }
  }
  hints.wall_edge = sum / double(count);
  hints.body = distance(box.low, box.high);
  // No gap at all cannot limit the wrap.
  hints.gap = std::isfinite(gap_) && gap_ > hints.wall_edge ? gap_ : 0;
  return options_.elements.offset > 0 ? options_.elements.offset : suggest_offset(hints);
}

void UnstructuredPlanner::find_regions() {
  if (fitted_) {
    classify_by_distance();
  } else if (options_.elements.background)
    classify_by_background();
  else
    classify_by_wrap();
  near_ = mask();
  for (Index32 n = 0; n < Index32(mesh_.n_nodes()); ++n)
    if (out_.report.regions.near[n]) near_[owner(n)] = 1;
  // Columns are kept whole, wherever the wrap ends.
  for (Index32 const n : columns_.node) near_[n] = 1;
}

void UnstructuredPlanner::classify_by_distance() {
  out_.report.offset = offset();
  auto& regions = out_.report.regions;
  regions.inside = regions.near = mask();
  for (std::size_t n = 0; n < regions.inside.size(); ++n)
    regions.inside[n] = from_wall_.distance[n] < out_.report.offset ? 1 : 0;
  regions.element.assign(mesh_.n_elements(), Region::far);
  for (Index e = 0; e < mesh_.n_elements(); ++e) {
    auto const corners = mesh_.elements.corners(e);
    auto const n =
        std::count_if(corners.begin(), corners.end(), [&](Index32 c) { return regions.inside[owner(c)] != 0; });
    if (n == 0) continue;
    regions.element[e] = std::size_t(n) == corners.size() ? Region::near : Region::partial;
    for (Index32 const c : mesh_.elements.nodes[e]) regions.near[c] = 1;
  }
  regions.count();
}

void UnstructuredPlanner::classify_by_wrap() {
  if (driving_faces_.empty()) {
    auto const n_nodes = std::size_t(mesh_.n_nodes());
    auto& regions = out_.report.regions;
    regions.element.assign(mesh_.n_elements(), Region::far);
    regions.near.assign(n_nodes, 0);
    regions.inside.assign(n_nodes, 0);
    regions.count();
    return;
  }
  out_.report.offset = offset();
  CsrGraph faces;
  for (Index32 const f : driving_faces_) faces.add(topology_.boundary.nodes[f]);
  WrapOptions wrap;
  wrap.offset = out_.report.offset;
  wrap.resolution = options_.elements.resolution;
  wrap.tube = options_.elements.tube;
  wrap.domain = find_domain();
  out_.report.wrap = make_wrap(host_, mesh_, {&faces, 1}, wrap);
  if (std::string const& note = out_.report.wrap->note; !note.empty())
    out_.notes.push_back("the wrap is made of lattice cells: " + note);
  out_.report.regions = classify(host_, mesh_, *out_.report.wrap);
}

void UnstructuredPlanner::classify_by_background() {
  take_background(*options_.elements.background);
  Background const& background = *out_.plan.background;
  out_.report.regions =
      classify_by_hole(host_, mesh_, background, wrap_nodes(background, *out_.plan.background_morph).position);
  Index astray = 0;
  Index32 first = -1;
  for (Index32 const n : out_.plan.driving)
    if (!out_.report.regions.inside[n] && astray++ == 0) first = n;
  if (astray > 0)
    throw MeshError("background mesh " + background.mesh.source +
                    " does not go around the moving walls: " + std::to_string(astray) + " of their " +
                    std::to_string(out_.plan.driving.size()) + " nodes lie in its cells or beyond its wrap, such as " +
                    describe_node(mesh_, first) + "; leave a hole in it that holds them, its faces being the wrap");
}

void UnstructuredPlanner::take_background(Background background) {
  out_.plan.background = std::move(background);
  out_.plan.background_morph = prepare_background(host_, *out_.plan.background, options_.volume);
}

}  // namespace gridmorph::detail
