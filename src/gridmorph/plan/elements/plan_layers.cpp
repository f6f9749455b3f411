#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/mesh/node_graph.hpp>
#include <gridmorph/plan/elements/one_rings.hpp>
#include <gridmorph/plan/elements/unstructured_planner.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::detail {

namespace {

/// Mean over the elements around each node of their shortest over their longest edge, 0 < grade <= 1. Cost O(corners).
std::vector<double> node_grades(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph) {
  std::vector<double> grade_of_element(mesh.n_elements(), 1);
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    ElementType const type = mesh.elements.type[e];
    if (type == ElementType::polyhedron) continue;
    auto const nodes = mesh.elements.corners(e);
    double shortest = std::numeric_limits<double>::infinity(), longest = 0;
    for (int k = 0; k < n_edges(type); ++k) {
      double const length =
          distance(mesh.coordinates[nodes[edge_corner(type, k, 0)]], mesh.coordinates[nodes[edge_corner(type, k, 1)]]);
      if (length > 0) shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
    if (longest > 0) grade_of_element[e] = shortest / longest;
  }
  std::vector<double> grade(mesh.n_nodes(), 0);
  std::vector<Index32> count(mesh.n_nodes(), 0);
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    std::size_t const o = std::size_t(graph.representative[n]);
    for (Index32 const e : topology.elements_of_nodes[n]) {
      grade[o] += grade_of_element[e];
      ++count[o];
    }
  }
  for (std::size_t n = 0; n < grade.size(); ++n) grade[n] = count[n] > 0 ? grade[n] / count[n] : 1;
  return grade;
}

/// Curvature of the wall at each of its nodes: the largest angle between its normal and a neighbour's over their
/// distance [1 / length]; zero elsewhere. Cost O(faces).
std::vector<double> wall_curvature(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                                   std::vector<Index32> const& faces) {
  std::vector<Vec3> const normal = wall_normals(mesh, topology, graph, faces);
  std::vector<double> curvature(normal.size(), 0);
  for (Index32 const f : faces) {
    auto const face = topology.boundary.nodes[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      Index32 const a = graph.representative[face[k]], b = graph.representative[face[(k + 1) % face.size()]];
      Vec3 const m = normal[a], n = normal[b];
      double const edge = distance(mesh.coordinates[a], mesh.coordinates[b]);
      if (!(edge > 0) || !(norm(m) > 0) || !(norm(n) > 0)) continue;
      double const angle = std::atan2(norm(cross(m, n)), dot(m, n));
      for (Index32 const at : {a, b}) curvature[at] = std::max(curvature[at], angle / edge);
    }
  }
  return curvature;
}

}  // namespace

std::function<double(Index32, Index32)> UnstructuredPlanner::layer_weight() {
  auto const length = [this](Index32 a, Index32 b) {
    double const d = distance(mesh_.coordinates[a], mesh_.coordinates[b]);
    return d > 0 ? d : std::numeric_limits<double>::min();
  };
  switch (options_.elements.weight) {
    case LayerWeight::uniform: return [](Index32, Index32) { return 1.0; };
    case LayerWeight::inverse_distance: return [=](Index32 a, Index32 b) { return 1 / length(a, b); };
    case LayerWeight::quality:
      return [=, grade = node_grades(mesh_, topology_, out_.graph)](Index32 a, Index32 b) {
        return (grade[a] + grade[b]) / length(a, b);
      };
    case LayerWeight::curvature:
      return [=, this, bend = wall_curvature(mesh_, topology_, out_.graph, driving_faces_)](Index32 a, Index32 b) {
        Index32 const wall = from_wall_.source[b];
        double const reach = wall < 0 ? 0 : from_wall_.distance[b] * bend[wall];
        return 1 / (length(a, b) * (1 + reach) * (1 + reach));
      };
  }
  return [](Index32, Index32) { return 1.0; };
}

void UnstructuredPlanner::measure_columns() {
  column_reach_ = columns_.full_rise;
  for (Index32 const n : columns_.node)
    if (Index32 const wall = from_wall_.source[n]; wall >= 0)
      column_reach_[wall] = std::max(column_reach_[wall], from_wall_.distance[n]);
}

void UnstructuredPlanner::plan_layers() {
  measure_columns();
  Mask seeds = drives_;
  for (Index32 const n : columns_.node) seeds[n] = 1;
  if (fitted_)
    plan_fit();
  else
    plan_near(seeds);
  auto const& near = out_.plan.near;
  auto& layer = out_.report.layer;
  layer.assign(seeds.size(), -1);
  for (std::size_t n = 0; n < seeds.size(); ++n)
    if (seeds[n]) layer[n] = 0;
  for (int l = 0; l < near.n_layers(); ++l)
    for (Index r = near.level[l]; r < near.level[l + 1]; ++r) layer[near.rows.target[r]] = l + 1;
  out_.report.n_layers = near.n_layers();
}

void UnstructuredPlanner::plan_near(Mask const& seeds) {
  UnstructuredPlan& plan = out_.plan;
  Mask wanted = near_;
  // Seeds have their motion already, and copies of a node get that of the node that carries it.
  for (std::size_t n = 0; n < seeds.size(); ++n)
    if (seeds[n] || !out_.graph.carries(Index32(n))) wanted[n] = 0;
  plan.near = make_layers(host_, out_.graph, mesh_.coordinates, seeds, wanted, from_wall_.distance, layer_weight());
  if (options_.elements.method != NearFieldMethod::layers && !driving_faces_.empty())
    plan_smooth_walls();
  else
    plan_layer_turns();
  for (Index32 const n : plan.near.rows.target) wanted[n] = 0;
  out_.report.unreached = std::count(wanted.begin(), wanted.end(), 1);
  if (out_.report.unreached > 0)
    out_.notes.push_back(
        std::to_string(out_.report.unreached) +
        " nodes lie in the wrap but are joined to no moving wall by edges of elements; they follow the other "
        "boundaries alone");
}

void UnstructuredPlanner::plan_fit() {
  UnstructuredPlan& plan = out_.plan;
  auto const n_nodes = std::size_t(mesh_.n_nodes());
  constexpr double reach = 3;  // of the height of the column below
  auto const fade = [&](std::size_t n) {
    Index32 const wall = from_wall_.source[n];
    double const height = wall < 0 ? 0 : column_reach_[wall];
    if (!(height > 0)) return 0.0;
    double const s = std::min(1.0, beyond_column(n) / (reach * height));
    return 1 - s * s * (3 - 2 * s);
  };
  Mask ends = mask(), wanted = mask();
  for (Index32 const n : columns_.node) ends[n] = 1;
  auto const is_moved = [&](std::size_t n) {
    return drives_[n] == 0 && out_.graph.carries(Index32(n)) && !out_.graph.neighbours[Index32(n)].empty();
  };
  for (std::size_t n = 0; n < n_nodes; ++n) wanted[n] = ends[n] == 0 && is_moved(n) && fade(n) > 0 ? 1 : 0;
  plan.near = make_layers(host_, out_.graph, mesh_.coordinates, ends, wanted, from_wall_.distance, layer_weight());
  // Only the ends of columns are where layers begin.
  Mask begins = mask(), passes = mask();
  for (Index32 const n : plan.near.rows.item) begins[n] = ends[n];
  for (Index32 const n : plan.near.rows.target) passes[n] = 1;
  double const nearest = 1e-14 * extent_of(host_, mesh_.coordinates).size();
  std::vector<FieldReader> readers;
  auto const add = [&](Index32 n) { readers.push_back({n, std::max(nearest, from_wall_.distance[n])}); };
  for (Index32 const n : columns_.node)
    if (begins[n] != 0) add(n);
  plan.n_fitted_ends = Index(readers.size());
  plan.near_fade.assign(readers.size(), 0);
  for (std::size_t n = 0; n < n_nodes; ++n) {
    if (ends[n] != 0 || !is_moved(n) || !std::isfinite(from_wall_.distance[n])) continue;
    add(Index32(n));
    plan.near_fade.push_back(passes[n] != 0 ? float(fade(n)) : 0);
  }
  std::vector<RigidTransform> images = periodic_moves(host_, mesh_, out_.graph, out_.boundary, 2);
  images.erase(images.begin());
  auto const turns_freely = [&](WallBody const& body) { return mesh_.dimension == 2 || norm(body.axis) == 0; };
  bool const taken_off =
      all_walls_turn() && std::all_of(wall_bodies_.bodies.begin(), wall_bodies_.bodies.end(), turns_freely);
  if (plan.passage.empty()) plan.beside_slots = slots_beside_walls(Beside::anywhere);
  std::vector<Index32> const sources = plan.smooth_sources();
  plan.fit = make_least_squares_field(host_, mesh_.coordinates, {sources, plan.driving.size(), areas(sources), images},
                                      taken_off ? MeanTurn::taken_off : MeanTurn::left, readers);
  plan_passage();
}

void UnstructuredPlanner::plan_smooth_walls() {
  UnstructuredPlan& plan = out_.plan;
  Box box;
  for (Index32 n = 0; n < Index32(mesh_.n_nodes()); ++n)
    if (near_[n]) box.include(mesh_.coordinates[n]);
  plan.beside_slots = slots_beside_walls(Beside::near);
  std::vector<Index32> const sources = plan.smooth_sources();
  ScatterLattice lattice{box.low, box.high, most_lattice_nodes, fine_opening, plan.near.rows.target};
  for (auto const* nodes : {&plan.driving, &plan.columns.node})
    lattice.readers.insert(lattice.readers.end(), nodes->begin(), nodes->end());
  plan.walls = make_scatter_lattice(host_, mesh_.coordinates, sources, areas(sources), mesh_.dimension, lattice);
  double const reach = 4 * plan.walls.shape.spacing;
  for (Index32 const n : plan.near.rows.target) {
    double const s = std::min(1.0, beyond_column(std::size_t(n)) / reach);
    plan.near_fade.push_back(float(1 - s * s * (3 - 2 * s)));
  }
}

std::vector<Index32> UnstructuredPlanner::slots_beside_walls(Beside which) const {
  using Request = BoundaryRequests::Request;
  BoundaryConditions const& b = out_.boundary;
  auto const& rules = b.motion->motion().rules;
  auto const is_moved = [&](Request const& r) {
    if (std::holds_alternative<FixedRule>(rules[r.rule].rule)) return false;
    return !out_.displacement || !((*out_.displacement)[r.boundary_node] == Vec3{});
  };
  auto const surface = [](Request const& r) { return std::pair(r.patch, r.interface); };
  std::set<std::pair<int, int>> moving;
  for (Request const& r : b.requests.requests)
    if (is_moved(r)) moving.insert(surface(r));
  Mask is_beside(b.known.size(), 0);
  for (Request const& r : b.requests.requests) {
    auto const n = std::size_t(b.known[r.boundary_node]);
    bool const is_region = r.patch >= int(mesh_.patches.size());
    if ((which == Beside::anywhere || near_[n] != 0) && !drives_[n] && !is_middle_[n] && !is_region &&
        moving.contains(surface(r)))
      is_beside[r.boundary_node] = 1;
  }
  std::vector<Index32> out;
  for (std::size_t s = 0; s < is_beside.size(); ++s)
    if (is_beside[s]) out.push_back(Index32(s));
  return out;
}

void UnstructuredPlanner::plan_layer_turns() {
  // Where turns are carried far, nodes between walls that turn differently are pulled apart; where they end at once,
  // the first elements beyond the columns shear.
  constexpr double reach_by_offset = 0.1;
  InterpolationOperator const& rows = out_.plan.near.rows;
  double const reach = reach_by_offset * (out_.report.offset > 0 ? out_.report.offset : out_.report.layer_height);
  auto const share = [&](Index32 n) {
    double const d = beyond_column(std::size_t(n));
    return reach > 0 && std::isfinite(d) ? reach / (reach + d) : 0;
  };
  for (Index r = 0; r < rows.size(); ++r) {
    Index const from = rows.first[r], to = rows.first[r + 1];
    double of_sources = 0;
    for (Index k = from; k < to; ++k) of_sources += double(rows.weight[k]) * share(rows.item[k]);
    double const own = share(rows.target[r]);
    out_.plan.near_turn.push_back(of_sources > 0 ? float(std::min(1.0, own / of_sources)) : 0);
  }
}

double UnstructuredPlanner::beyond_column(std::size_t n) const {
  Index32 const wall = from_wall_.source[n];
  return wall < 0 ? infinity : std::max(0.0, from_wall_.distance[n] - column_reach_[wall]);
}

}  // namespace gridmorph::detail
