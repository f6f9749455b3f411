#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/check_coordinates.hpp>
#include <gridmorph/plan/elements/middle_rows.hpp>
#include <gridmorph/plan/elements/unstructured_planner.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gridmorph::detail {

namespace {

void refuse_open_faces(BoundaryFacePatches const& face_patches) {
  Problems problems;
  for (auto const& problem : face_patches.problems) problems.add(problem);
  problems.throw_if_any<MeshError>();
}

}  // namespace

PreparedUnstructured UnstructuredPlanner::run() {
  out_.plan.n_nodes = mesh_.n_nodes();
  out_.plan.dimension = mesh_.dimension;
  out_.plan.plane_normal = plane_normal(mesh_);
  if (mesh_.dimension == 2 && !(std::abs(out_.plan.plane_normal.z) == 1))
    throw MeshError("mesh " + mesh_.source +
                    " is 2-D but does not lie in a plane x, y or z = constant; turn it into one");
  timed(out_.report.seconds.boundary, [&] { take_boundary(); });
  timed(out_.report.seconds.distances, [&] { measure_distances(); });
  timed(out_.report.seconds.columns, [&] { find_columns(); });
  timed(out_.report.seconds.wrap, [&] { find_regions(); });
  timed(out_.report.seconds.layers, [&] { plan_layers(); });
  timed(out_.report.seconds.background, [&] { plan_background(); });
  timed(out_.report.seconds.location, [&] { plan_projections(); });
  timed(out_.report.seconds.residual, [&] { plan_residual(); });
  return std::move(out_);
}

void UnstructuredPlanner::take_boundary() {
  BoundaryConditions const& b = out_.boundary;
  UnstructuredPlan& plan = out_.plan;
  out_.notes = b.notes;
  plan.known = b.known;
  plan.surfaces = slip_surfaces_;
  plan.images = b.images;
  plan.rotations = b.rotations;
  plan.middle = middle_rows(mesh_, out_.graph);
  is_known_ = drives_ = is_other_ = is_middle_ = mask();
  for (Index32 const n : plan.middle.target) is_middle_[std::size_t(n)] = 1;
  for (std::size_t k = 0; k < b.known.size(); ++k) {
    is_known_[std::size_t(b.known[k])] = 1;
    if (b.drives[k] && !is_middle_[std::size_t(b.known[k])]) {
      drives_[std::size_t(b.known[k])] = 1;
      plan.driving.push_back(b.known[k]);
      plan.driving_slots.push_back(Index32(k));
    }
  }
  for (Index32 n = 0; n < Index32(mesh_.n_nodes()); ++n)
    if (Index32 const o = owner(n); o != n) {
      plan.copies.push_back(n);
      plan.copied.push_back(o);
    }
  if (!out_.displacement && options_.elements.motion < 0) out_.displacement = evaluate(b);
  reach_ = rest_reach_ = out_.displacement ? largest_norm(*out_.displacement) : options_.elements.motion;
}

void UnstructuredPlanner::measure_distances() {
  BoundaryConditions const& b = out_.boundary;
  for (std::size_t k = 0; k < b.known.size(); ++k)
    if (!b.drives[k]) is_other_[std::size_t(b.known[k])] = 1;
  for (Index32 const n : b.slip_nodes) is_other_[std::size_t(n)] = 1;
  for (auto const& image : b.images) is_other_[std::size_t(image.node)] = is_other_[std::size_t(image.owner)] = 1;
  for (Index32 const n : out_.plan.middle.target) is_other_[std::size_t(n)] = 0;
  std::vector<Index32> walls, others;
  for (Index32 n = 0; n < Index32(mesh_.n_nodes()); ++n) {
    if (drives_[std::size_t(n)]) {
      walls.push_back(n);
      // Where a moving wall ends on another boundary, both are at no distance.
      is_other_[std::size_t(n)] = 0;
    } else if (is_other_[std::size_t(n)]) {
      others.push_back(n);
    }
  }
  from_wall_ = nearest_source(host_, mesh_.coordinates, out_.graph, walls);
  from_other_ = nearest_source(host_, mesh_.coordinates, out_.graph, others);
  // A wall that ends on another boundary has no gap to it.
  for (Index32 const n : walls) gap_ = std::min(gap_, from_other_.distance[std::size_t(n)]);
}

}  // namespace gridmorph::detail

namespace gridmorph {

PreparedUnstructured prepare(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology,
                             BoundaryFacePatches const& face_patches, Motion const& motion,
                             PlanOptions const& options) {
  check_coordinates(mesh, "gridmorph::prepare");
  check_usable(mesh, "gridmorph::prepare");
  detail::refuse_open_faces(face_patches);
  Stopwatch watch;
  NodeGraph graph = make_node_graph(host, mesh, topology.elements_of_nodes, row_of_nodes(mesh, motion));
  BoundaryConditions boundary =
      boundary_conditions(host, mesh, topology, face_patches, graph, motion, options.elements.walls,
                          options.elements.motion >= 0 ? Displacements::any : Displacements::of_the_rules);
  double const seconds = watch.lap();
  auto out = prepare(host, mesh, topology, face_patches, std::move(graph), std::move(boundary), options);
  out.report.seconds.boundary += seconds;
  return out;
}

PreparedUnstructured prepare(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology,
                             BoundaryFacePatches const& face_patches, NodeGraph graph, BoundaryConditions boundary,
                             PlanOptions const& options, std::optional<std::vector<Vec3>> displacement) {
  check_coordinates(mesh, "gridmorph::prepare");
  detail::refuse_open_faces(face_patches);
  auto const axes = plane_axes(mesh);
  if (axes == std::array<int, 3>{0, 1, 2})
    return detail::UnstructuredPlanner(host, mesh, topology, face_patches, std::move(graph), std::move(boundary),
                                       options, std::move(displacement))
        .run();
  if (options.elements.background)
    throw PlanError("mesh " + mesh.source +
                    " is 2-D across another axis than z, and a background mesh of your own is for ones across z; turn "
                    "both, or leave it out");
  Mesh seen = mesh;
  seen.coordinates = along_axes(axes, mesh.coordinates);
  auto const rotations = boundary.rotations;
  for (Mat3& rotation : boundary.rotations) rotation = along_axes(axes, rotation);
  if (!displacement && options.elements.motion < 0) displacement = evaluate(boundary);
  auto const given = displacement;
  if (displacement)
    for (Vec3& u : *displacement) u = along_axes(axes, u);
  auto out = detail::UnstructuredPlanner(host, seen, topology, face_patches, std::move(graph), std::move(boundary),
                                         options, std::move(displacement), axes)
                 .run();
  out.boundary.rotations = rotations;
  out.displacement = given;
  return out;
}

}  // namespace gridmorph
