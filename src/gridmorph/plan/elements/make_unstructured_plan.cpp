#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/symmetric_eigen.hpp>
#include <gridmorph/mesh/check_coordinates.hpp>
#include <gridmorph/mesh/node_graph.hpp>
#include <gridmorph/plan/blocks/stage_builder.hpp>
#include <gridmorph/plan/elements/unstructured_planner.hpp>
#include <gridmorph/plan/interpolation_operator.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace gridmorph::detail {

namespace {

/// Corners of the edge, face or element amid which the further node number k of element e is.
std::vector<Index32> corners_around(Mesh const& mesh, Index e, std::size_t k) {
  ElementType const type = mesh.elements.type[e];
  auto const corners = mesh.elements.corners(e);
  int const edge = int(k - corners.size());
  if (edge < n_edges(type)) return {corners[edge_corner(type, edge, 0)], corners[edge_corner(type, edge, 1)]};
  int square = edge - n_edges(type);
  if (!is_surface(type))
    for (int f = 0; f < n_faces(type); ++f) {
      if (n_face_corners(type, f) != 4 || square-- > 0) continue;
      std::array<Index32, max_face_corners> room;
      auto const face = side_nodes(mesh, e, f, room);
      return {face.begin(), face.end()};
    }
  return {corners.begin(), corners.end()};
}

class MiddleRows {
 public:
  MiddleRows(Mesh const& mesh, NodeGraph const& graph) : mesh_(mesh), graph_(graph) {}

  InterpolationOperator run() {
    for (Index e = 0; e < mesh_.n_elements(); ++e) {
      auto const all = mesh_.elements.nodes[e];
      for (std::size_t k = mesh_.elements.corners(e).size(); k < all.size(); ++k)
        if (graph_.carries(all[k]) && graph_.neighbours[all[k]].empty())
          uses_.push_back({all[k], Index32(e), Index32(k)});
    }
    std::sort(uses_.begin(), uses_.end());
    for (std::size_t begin = 0, end; begin < uses_.size(); begin = end) {
      for (end = begin; end < uses_.size() && uses_[end][0] == uses_[begin][0]; ++end) {
      }
      add({uses_.data() + begin, end - begin});
    }
    return std::move(rows_);
  }

 private:
  using Use = std::array<Index32, 3>;  ///< node, element, place in the element

  [[nodiscard]] Index32 owner(Index32 n) const { return graph_.representative[n]; }

  void add(std::span<Use const> uses) {
    Coordinates const& x = mesh_.coordinates;
    Index32 const node = uses[0][0];
    items_.clear();
    weights_.clear();
    Vec3 mean;
    auto const own = corners_around(mesh_, uses[0][1], std::size_t(uses[0][2]));
    double const share = 1.0 / double(own.size());
    double size = 0;
    for (Index32 const c : own) {
      mean += share * x[c];
      add_item(owner(c), share);
      size = std::max(size, distance(x[c], x[own[0]]));
    }
    Vec3 const c = x[node] - mean;
    constexpr double straight = 1e-9;  // of the edge
    if (norm(c) > straight * size) add_gradient(uses, c);
    rows_.add(node, items_, weights_);
  }

  void add_item(Index32 node, double weight) {
    auto const at = std::find(items_.begin(), items_.end(), node);
    if (at != items_.end()) {
      weights_[at - items_.begin()] += weight;
    } else {
      items_.push_back(node);
      weights_.push_back(weight);
    }
  }

  /// G c = sum over the corners p of (g . (p - p0)) u_p, with (sum of (p - p0)(p - p0)^T) g = c; only along what the
  /// corners span.
  void add_gradient(std::span<Use const> uses, Vec3 const& c) {
    Coordinates const& x = mesh_.coordinates;
    around_.clear();
    for (Use const& use : uses)
      for (Index32 const corner : mesh_.elements.corners(use[1])) around_.push_back(owner(corner));
    std::sort(around_.begin(), around_.end());
    around_.erase(std::unique(around_.begin(), around_.end()), around_.end());
    Vec3 centre;
    for (Index32 const p : around_) centre += (1.0 / double(around_.size())) * x[p];
    double moments[3][3] = {}, axis[3][3];
    for (Index32 const p : around_) {
      Vec3 const d = x[p] - centre;
      double const of[3] = {d.x, d.y, d.z};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) moments[i][j] += of[i] * of[j];
    }
    double const total = moments[0][0] + moments[1][1] + moments[2][2];
    kernels::diagonalise(moments, axis);
    Vec3 g;
    for (int k = 0; k < 3; ++k) {
      constexpr double flat = 1e-20;  // of the moments: 1e-10 of the lengths
      if (!(moments[k][k] > flat * total)) continue;
      Vec3 const a{axis[k][0], axis[k][1], axis[k][2]};
      g += (dot(a, c) / moments[k][k]) * a;
    }
    for (Index32 const p : around_) add_item(p, dot(g, x[p] - centre));
  }

  Mesh const& mesh_;
  NodeGraph const& graph_;
  InterpolationOperator rows_;
  std::vector<Use> uses_;
  std::vector<Index32> items_, around_;
  std::vector<double> weights_;
};

/// One row for each node that is no corner of any element but a further node of one: amid an edge, a quadrilateral face
/// or the element itself, in the order of the SIDS. With m the mean of the corners of that edge, face or element, and c
/// = x - m,
///
///   u(x) = mean of their u + G c
///
/// G being the gradient that fits the displacement of all corners of the elements around x best (least squares): c, by
/// which an edge is curved, turns and stretches with the elements, so that affine motions are followed exactly. Where
/// edges are straight, c = 0, and u is the mean. Cost O(nodes of all elements).
InterpolationOperator middle_rows(Mesh const& mesh, NodeGraph const& graph) { return MiddleRows(mesh, graph).run(); }

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
      tolerance =
          std::max(tolerance, given_tolerance(plan.surfaces[b.given_slip.surface[s]], b.motion->boundary().size()));
    plan.given_tolerance.push_back(tolerance);
  }
  plan.images = b.images;
  plan.rotations = b.rotations;
  plan.middle = middle_rows(mesh_, out_.graph);
  is_known_ = drives_ = is_other_ = is_middle_ = mask();
  for (Index32 const n : plan.middle.target) is_middle_[n] = 1;
  for (std::size_t k = 0; k < b.known.size(); ++k) {
    is_known_[b.known[k]] = 1;
    if (b.drives[k] && !is_middle_[b.known[k]]) {
      drives_[b.known[k]] = 1;
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
    if (!b.drives[k]) is_other_[b.known[k]] = 1;
  for (Index32 const n : b.slip_nodes) is_other_[n] = 1;
  for (auto const& image : b.images) is_other_[image.node] = is_other_[image.owner] = 1;
  for (Index32 const n : b.joint_slip.of) is_other_[n] = 1;  // where periodic sides meet nodes have no images
  for (Index32 const n : out_.plan.middle.target) is_other_[n] = 0;
  std::vector<Index32> walls, others;
  for (Index32 n = 0; n < Index32(mesh_.n_nodes()); ++n) {
    if (drives_[n]) {
      walls.push_back(n);
      // Where a moving wall ends on another boundary, both are at no distance.
      is_other_[n] = 0;
    } else if (is_other_[n]) {
      others.push_back(n);
    }
  }
  from_wall_ = nearest_source(host_, mesh_.coordinates, out_.graph, walls);
  from_other_ = nearest_source(host_, mesh_.coordinates, out_.graph, others);
  // A wall that ends on another boundary has no gap to it.
  for (Index32 const n : walls) gap_ = std::min(gap_, from_other_.distance[n]);
}

}  // namespace gridmorph::detail

namespace gridmorph {

PreparedUnstructured prepare(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology,
                             BoundaryFacePatches const& face_patches, Motion const& motion,
                             PlanOptions const& options) {
  check_coordinates(mesh, "gridmorph::prepare");
  check_usable(host, mesh, "gridmorph::prepare");
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
  if (auto const n = options.elements.shape.size(); n != 0 && n != boundary.known.size())
    throw PlanError("ElementOptions::shape has " + std::to_string(n) + " displacements, and mesh " + mesh.source + " " +
                    std::to_string(boundary.known.size()) +
                    " boundary nodes that rules displace; give one for each, or none");
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
  PlanOptions own = options;
  for (Vec3& u : own.elements.shape) u = along_axes(axes, u);
  auto out = detail::UnstructuredPlanner(host, seen, topology, face_patches, std::move(graph), std::move(boundary), own,
                                         std::move(displacement), axes)
                 .run();
  out.boundary.rotations = std::move(rotations);
  out.displacement = std::move(given);
  return out;
}

}  // namespace gridmorph
