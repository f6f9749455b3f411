#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/plan/elements/background_hole.hpp>
#include <gridmorph/plan/elements/unstructured_planner.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace gridmorph::detail {

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
  if (options_.elements.background)
    classify_by_background();
  else
    classify_by_wrap();
  near_ = mask();
  for (Index32 n = 0; n < Index32(mesh_.n_nodes()); ++n)
    if (out_.report.regions.near[std::size_t(n)]) near_[std::size_t(owner(n))] = 1;
  // Columns are kept whole, wherever the wrap ends.
  for (Index32 const n : columns_.node) near_[std::size_t(n)] = 1;
}

void UnstructuredPlanner::classify_by_wrap() {
  if (driving_faces_.empty()) {
    auto const n_nodes = std::size_t(mesh_.n_nodes());
    auto& regions = out_.report.regions;
    regions.element.assign(std::size_t(mesh_.n_elements()), Region::far);
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
    if (!out_.report.regions.inside[std::size_t(n)] && astray++ == 0) first = n;
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
