#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/check_coordinates.hpp>
#include <gridmorph/plan/blocks/stage_builder.hpp>
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

Periodic turned_along(std::array<int, 3> const& axes, Periodic const& p) {
  return {along_axes(axes, p.rotation_center),
          along_axes(axes, p.rotation_angle_rad),
          along_axes(axes, p.translation),
          {along_axes(axes, p.declared.rotation), along_axes(axes, p.declared.translation)}};
}

/// The mesh with its components in that order; coordinates are shared.
Mesh seen_along(std::array<int, 3> const& axes, Mesh const& mesh) {
  Mesh out = mesh;
  out.coordinates = along_axes(axes, mesh.coordinates);
  for (Connection& connection : out.connections)
    if (connection.periodic) connection.periodic = turned_along(axes, *connection.periodic);
  return out;
}

}  // namespace

PreparedUnstructured UnstructuredPlanner::run() {
  out_.plan.n_nodes = mesh_.n_nodes();
  out_.plan.dimension = mesh_.dimension;
  out_.plan.plane_normal = plane_normal(mesh_);
  if (mesh_.dimension == 2 && !(std::abs(out_.plan.plane_normal.z) == 1))
    throw MeshError("mesh " + mesh_.source +
                    " is 2-D but does not lie in a plane x, y or z = constant; turn it into one");
  std::vector<Part> parts;
  timed(out_.report.seconds.boundary, [&] {
    take_boundary();
    if (!is_part_) parts = find_parts();
  });
  if (parts.empty())
    plan_whole();
  else
    plan_parts(std::move(parts));
  return std::move(out_);
}

void UnstructuredPlanner::plan_whole() {
  timed(out_.report.seconds.distances, [&] { measure_distances(); });
  timed(out_.report.seconds.columns, [&] { find_columns(); });
  timed(out_.report.seconds.wrap, [&] { find_regions(); });
  timed(out_.report.seconds.layers, [&] { plan_layers(); });
  timed(out_.report.seconds.background, [&] { plan_background(); });
  timed(out_.report.seconds.location, [&] { plan_projections(); });
  timed(out_.report.seconds.residual, [&] { plan_residual(); });
}

void UnstructuredPlanner::take_boundary() {
  BoundaryConditions const& b = out_.boundary;
  UnstructuredPlan& plan = out_.plan;
  out_.notes = b.notes;
  plan.known = b.known;
  plan.surfaces = along_axes(plan.axes, b.surfaces());
  plan.given_slip = b.given_slip;
  for (std::size_t k = 0; k < b.given_slip.of.size(); ++k) {
    // A node that several surfaces hold is left alone as far as the least exact of them allows.
    double tolerance = 0;
    for (Index s = b.given_slip.first[k]; s < b.given_slip.first[k + 1]; ++s)
      tolerance = std::max(tolerance, given_tolerance(plan.surfaces[std::size_t(b.given_slip.surface[std::size_t(s)])],
                                                      b.motion->boundary().size()));
    plan.given_tolerance.push_back(tolerance);
  }
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
  for (Index32 const n : b.joint_slip.of)
    is_other_[std::size_t(n)] = 1;  // where periodic sides meet nodes have no images
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
                                       options, std::move(displacement), axes)
        .run();
  if (options.elements.background)
    throw PlanError("mesh " + mesh.source +
                    " is 2-D across another axis than z, and a background mesh of your own is for ones across z; turn "
                    "both, or leave it out");
  Mesh const seen = detail::seen_along(axes, mesh);
  if (!displacement && options.elements.motion < 0) displacement = evaluate(boundary);
  auto given = displacement;
  auto rotations = boundary.rotations;
  if (displacement)
    for (Vec3& u : *displacement) u = along_axes(axes, u);
  for (Mat3& rotation : boundary.rotations) rotation = along_axes(axes, rotation);
  auto out = detail::UnstructuredPlanner(host, seen, topology, face_patches, std::move(graph), std::move(boundary),
                                         options, std::move(displacement), axes)
                 .run();
  out.boundary.rotations = std::move(rotations);
  out.displacement = std::move(given);
  return out;
}

}  // namespace gridmorph
