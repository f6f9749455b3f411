#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/plan/elements/column_heights.hpp>
#include <gridmorph/plan/elements/one_rings.hpp>
#include <gridmorph/plan/elements/unstructured_planner.hpp>
#include <gridmorph/plan/place_order.hpp>

#include <algorithm>
#include <cmath>

namespace gridmorph::detail {

namespace {

/// Sorts faces by the mean of their corners: a node that several columns reach belongs to the first face, however faces
/// are numbered.
void sort_by_place(Mesh const& mesh, UnstructuredTopology const& topology, std::vector<Index32>& faces) {
  std::vector<Vec3> middle(topology.boundary.size());
  for (Index32 const f : faces) {
    auto const corners = topology.boundary.nodes[f];
    for (Index32 const n : corners) middle[f] += (1.0 / double(corners.size())) * mesh.coordinates[n];
  }
  PlaceOrder const is_before(mesh.coordinates);
  std::sort(faces.begin(), faces.end(), [&](Index32 a, Index32 b) { return is_before(middle[a], a, middle[b], b); });
}

/// The place of each node of the mesh in a list, -1: not in it.
std::vector<Index32> places_of_nodes(std::vector<Index32> const& list, Index n_nodes) {
  std::vector<Index32> place(n_nodes, -1);
  for (std::size_t k = 0; k < list.size(); ++k) place[list[k]] = Index32(k);
  return place;
}

/// Whether a layer says how far columns go.
bool is_given(BoundaryLayer const& layer) {
  return layer.extent == BoundaryLayer::Extent::layers || layer.extent == BoundaryLayer::Extent::thickness;
}

}  // namespace

void UnstructuredPlanner::find_driving_faces() {
  BoundaryConditions const& b = out_.boundary;
  layer_of_patch_.assign(mesh_.patches.size(), -1);
  for (std::size_t l = 0; l < options_.boundary_layers.size(); ++l) {
    auto const& layer = options_.boundary_layers[l];
    std::vector<int> const patches = layer.walls.empty() ? b.driving_patches : select_patches(mesh_, layer.walls);
    for (int const p : patches) {
      int& own = layer_of_patch_[p];
      if (own >= 0)
        throw MotionError("two boundary layers name patch " + describe_patch(mesh_, mesh_.patches[p]) +
                          "; give each wall one");
      own = int(l);
      if (!std::binary_search(b.driving_patches.begin(), b.driving_patches.end(), p) &&
          !std::binary_search(b.standing_patches.begin(), b.standing_patches.end(), p) &&
          !std::binary_search(b.sliding_patches.begin(), b.sliding_patches.end(), p))
        out_.notes.push_back("patch " + describe_patch(mesh_, mesh_.patches[p]) +
                             " has a boundary layer but drives no near field; its columns are not held");
    }
  }
  for (Index f = 0; f < topology_.boundary.size(); ++f) {
    int const p = face_patches_.patch[f];
    if (p >= 0 && std::binary_search(b.driving_patches.begin(), b.driving_patches.end(), p))
      driving_faces_.push_back(Index32(f));
  }
  sort_by_place(mesh_, topology_, driving_faces_);
  if (driving_faces_.empty() && !is_part_)
    throw MotionError(
        "the moving walls have no faces on the boundary of the elements; their patches list nodes of other places");
}

void UnstructuredPlanner::find_columns() {
  find_driving_faces();
  find_turning_bodies();
  std::vector<ColumnExtent> extents;
  for (Index32 const f : driving_faces_) extents.push_back(extent_of_face(f));
  columns_ = make_columns(mesh_, topology_, out_.graph, driving_faces_, extents, is_known_);
  find_wall_lines();
  out_.report.n_columns = std::count_if(columns_.height.begin(), columns_.height.end(), [](double h) { return h > 0; });
  ColumnEnds const ends =
      smooth_ends(out_.graph, columns_, most_heights(), fitted_ ? longest_by_edges() : longest_where_walls_bend());
  // By least squares lines that lean beside sharp edges end by their length, whatever they rise.
  columns_ = cut(columns_, fitted_ ? ColumnEnds{ends.height, std::vector<double>(ends.rise.size(), 0)} : ends);
  columns_.full_rise = ends.rise;
  for (double const h : columns_.full_rise) out_.report.layer_height = std::max(out_.report.layer_height, h);
  plan_columns();
  if (!driving_faces_.empty()) find_held_columns();
  measure_others();
  plan_turns();
}

ColumnExtent UnstructuredPlanner::extent_of_face(Index32 face) const {
  int const l = layer_of_patch_[face_patches_.patch[face]];
  if (l < 0) return {};
  auto const& layer = options_.boundary_layers[l];
  return {is_given(layer) ? layer.extent : BoundaryLayer::Extent::block, layer.layers, layer.thickness};
}

Columns UnstructuredPlanner::columns_on(std::vector<int> const& patches, Mask const& taken, double motion) const {
  std::vector<Index32> faces;
  std::vector<ColumnExtent> extents;
  for (Index f = 0; f < topology_.boundary.size(); ++f)
    if (std::binary_search(patches.begin(), patches.end(), face_patches_.patch[f])) faces.push_back(Index32(f));
  sort_by_place(mesh_, topology_, faces);
  for (Index32 const f : faces) extents.push_back(extent_of_face(f));
  Columns const whole = make_columns(mesh_, topology_, out_.graph, faces, extents, taken);
  // Where a moving wall ends on one that does not move with it, and across gaps, what does not move gives way.
  std::vector<double> most(mesh_.n_nodes(), infinity);
  for (std::size_t n = 0; n < most.size(); ++n)
    if (whole.height[n] > 0 && std::isfinite(from_wall_.distance[n]))
      most[n] = room_in_gap(from_wall_.distance[n], motion);
  return with_copies(cut(whole, smooth_ends(out_.graph, whole, most)));
}

Columns UnstructuredPlanner::with_copies(Columns const& columns) const {
  auto const& images = out_.boundary.images;
  if (images.empty()) return columns;
  Mask listed = mask(), ends = mask();
  for (Index32 const n : columns.node) listed[n] = 1;
  // What copies have is a mean over them, of which each has to know its part.
  for (auto const& image : images)
    if (listed[image.node] != listed[image.owner]) ends[image.node] = ends[image.owner] = 1;
  for (auto const& image : images)
    if (ends[image.owner] != 0) ends[image.node] = 1;
  return kept_nodes(columns, [&](std::size_t k) {
    ends[columns.node[k]] |= ends[columns.below[k]];
    return ends[columns.node[k]] == 0;
  });
}

void UnstructuredPlanner::find_held_columns() {
  Mask taken = is_known_;
  for (Index32 const n : columns_.node) taken[n] = 1;
  standing_ = columns_on(out_.boundary.standing_patches, taken, reach_);
  for (Index32 const n : standing_.node) taken[n] = 1;
  // On another surface too a node has its own way to slip.
  for (Index32 const n : out_.boundary.slip_nodes) taken[n] = 1;
  // They follow the motion, as far as their wall does.
  Columns const sliding = columns_on(out_.boundary.sliding_patches, taken, 0);
  // On the edge of a moving wall, as where a fillet runs out, nodes have that wall's motion, and nothing to go along
  // with.
  sliding_ = kept_nodes(sliding, [&](std::size_t k) { return drives_[sliding.root[k]] == 0; });
  for (Index32 const n : sliding_.node) is_other_[n] = 1;
  for (Index32 const n : standing_.node) is_other_[n] = 1;
}

void UnstructuredPlanner::measure_others() {
  std::vector<Index32> others, given;
  Mask stands = mask();
  for (Index32 const n : standing_.node) stands[n] = 1;
  for (Index32 n = 0; n < Index32(mesh_.n_nodes()); ++n) {
    if (!is_other_[n]) continue;
    others.push_back(n);
    if (is_known_[n] || stands[n]) given.push_back(n);
  }
  // What is free to slide begins where these end.
  bool const sliding = given.size() < others.size() && !given.empty();
  if (n_held() > 0) from_other_ = nearest_source(host_, mesh_.coordinates, out_.graph, others);
  if (sliding) from_given_ = nearest_source(host_, mesh_.coordinates, out_.graph, given);
}

std::vector<double> UnstructuredPlanner::most_heights() const {
  std::vector<double> most = gaps_ahead(mesh_.coordinates, columns_, from_other_);
  for (double& m : most)
    if (std::isfinite(m)) m = room_in_gap(m, reach_);
  for (Index32 const f : driving_faces_)
    if (int const l = layer_of_patch_[face_patches_.patch[f]]; l >= 0 && is_given(options_.boundary_layers[l]))
      for (Index32 const n : topology_.boundary.nodes[f]) most[owner(n)] = infinity;
  return most;
}

std::vector<double> UnstructuredPlanner::longest_by_edges() const {
  // By measurement on an airfoil and an ellipsoid (bench_turns): what is farther from the wall least squares carry
  // better.
  constexpr double of_edge = 0.5;
  std::vector<double> out(mesh_.n_nodes(), infinity);
  for (Index32 const f : driving_faces_) {
    auto const face = topology_.boundary.nodes[f];
    int const l = layer_of_patch_[face_patches_.patch[f]];
    if (l >= 0 && is_given(options_.boundary_layers[l])) continue;
    for (std::size_t k = 0; k < face.size(); ++k) {
      Index32 const a = owner(face[k]), b = owner(face[(k + 1) % face.size()]);
      double const longest = of_edge * distance(mesh_.coordinates[a], mesh_.coordinates[b]);
      for (Index32 const n : {a, b}) out[n] = std::min(out[n], longest);
    }
  }
  return out;
}

std::vector<double> UnstructuredPlanner::longest_where_walls_bend() const {
  auto const* const given = shape();
  TurningBodies const& all = out_.plan.turns_of_bodies;
  if (given == nullptr || all.size() == 0) return {};
  for (Index32 const f : driving_faces_)
    if (int const l = layer_of_patch_[face_patches_.patch[f]]; l >= 0 && is_given(options_.boundary_layers[l]))
      return {};
  // By measurement on an airfoil and an ellipsoid (bench_turns): what lattices show of a bend in the plane they show
  // better than columns do, in space, where they are coarser, no better.
  constexpr double strain = 0.03;
  double const cells = mesh_.dimension == 2 ? 1 : 4;
  auto const turn = turns_of_walls(*given);
  auto const place = places_of_nodes(out_.plan.driving, mesh_.n_nodes());
  std::vector<double> longest(mesh_.n_nodes(), infinity);
  for (std::size_t body = 0; body < wall_bodies_.bodies.size(); ++body) {
    double const bends = (1 - (all.limits.empty() ? 0 : all.limits[body].share)) * body_sizes_[body];
    if (!(body_rests_[body] > 0 && bends > 0)) continue;
    double const least = cells * lattice_spacing(wall_bodies_.bodies[body]);
    for (Index32 const f : wall_bodies_.bodies[body].faces) {
      auto const face = topology_.boundary.nodes[f];
      for (std::size_t k = 0; k < face.size(); ++k) {
        Index32 const ends[2] = {owner(face[k]), owner(face[(k + 1) % face.size()])};
        double const angle = 2 * norm(turn[place[ends[0]]].imaginary - turn[place[ends[1]]].imaginary);
        if (!(angle > 0)) continue;
        double const length = strain * body_rests_[body] / bends *
                              distance(mesh_.coordinates[ends[0]], mesh_.coordinates[ends[1]]) / angle;
        for (Index32 const n : ends) longest[n] = std::min(longest[n], std::max(length, least));
      }
    }
  }
  return longest;
}

double UnstructuredPlanner::lattice_spacing(WallBody const& body) const {
  Box box;
  for (Index32 const n : body.nodes) box.include(mesh_.coordinates[n]);
  Vec3 const extent = box.high - box.low;
  double const beside = 0.5 * norm(extent);
  double const room = (extent.x + beside) * (extent.y + beside) * (mesh_.dimension == 2 ? 1 : extent.z + beside);
  return std::pow(room / double(most_lattice_nodes), 1.0 / mesh_.dimension);
}

std::vector<BoundaryLayer::Mode> UnstructuredPlanner::modes_of_walls() const {
  std::vector<BoundaryLayer::Mode> mode(mesh_.n_nodes(), BoundaryLayer::Mode::rotate);
  for (Index32 const f : driving_faces_)
    if (int const l = layer_of_patch_[face_patches_.patch[f]]; l >= 0)
      for (Index32 const n : topology_.boundary.nodes[f]) mode[owner(n)] = options_.boundary_layers[l].mode;
  return mode;
}

void UnstructuredPlanner::plan_one_rings() {
  UnstructuredPlan& plan = out_.plan;
  auto const mode = modes_of_walls();
  for (Index32 const n : plan.driving) plan.turns.push_back(mode[n] == BoundaryLayer::Mode::translate ? 0 : 1);
  plan.one_rings = wall_one_rings(mesh_, topology_, out_.graph, driving_faces_, plan.driving);
}

void UnstructuredPlanner::find_wall_lines() {
  UnstructuredPlan& plan = out_.plan;
  auto const& x = mesh_.coordinates;
  std::vector<Index32> const place = places_of_nodes(plan.driving, mesh_.n_nodes());
  auto const normal = wall_normals(mesh_, topology_, out_.graph, driving_faces_);
  std::vector<std::vector<Vec3>> lines(plan.driving.size());
  for (std::size_t k = 0; k < columns_.node.size(); ++k) {
    Index32 const root = columns_.root[k];
    if (columns_.below[k] != root) continue;
    Vec3 const line = x[columns_.node[k]] - x[root];
    double const length = norm(line);
    if (!(length > 0)) continue;
    double const side = dot(line, normal[root]) < 0 ? -1 : 1;
    lines[place[root]].push_back((side / length) * line);
  }
  plan.first_line.assign(1, 0);
  for (auto const& of_node : lines) {
    plan.lines.insert(plan.lines.end(), of_node.begin(), of_node.end());
    plan.first_line.push_back(Index(plan.lines.size()));
  }
}

void UnstructuredPlanner::plan_columns() {
  using Mode = BoundaryLayer::Mode;
  auto const mode = modes_of_walls();
  UnstructuredPlan& plan = out_.plan;
  std::vector<Index32> const place = places_of_nodes(plan.driving, mesh_.n_nodes());
  for (std::size_t k = 0; k < columns_.node.size(); ++k) {
    Index32 const root = columns_.root[k];
    double const s = std::min(1.0, columns_.above_wall[k] / columns_.height[root]);
    Mode const m = mode[root];
    // Smooth, and level at the wall: the first cells turn with it.
    double const turn = m == Mode::translate ? 0 : m == Mode::blend ? 1 - s * s * (3 - 2 * s) : 1;
    plan.columns.node.push_back(columns_.node[k]);
    plan.columns.root.push_back(place[root]);
    plan.columns.turn.push_back(float(turn));
  }
}

}  // namespace gridmorph::detail
