#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/motion/boundary_motion.hpp>
#include <gridmorph/plan/elements/locate.hpp>
#include <gridmorph/plan/elements/turning_bodies.hpp>
#include <gridmorph/plan/elements/unstructured_planner.hpp>
#include <gridmorph/plan/plane_axes.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace gridmorph::detail {

namespace {

/// The sides of a passage in the meridional plane: their faces as elements of a plane mesh, along the axis and away
/// from it. Those of a plane mesh are lines, drawn out across the one direction that there is.
class MeridionalSides {
 public:
  /// of_node: numbers of the nodes of the sides, -1: no side.
  MeridionalSides(Mesh const& mesh, UnstructuredTopology const& topology, NodeGraph const& graph,
                  kernels::RowFrame const& frame, std::vector<Index32> const& of_node,
                  std::vector<Index32> const& nodes)
      : frame_(frame), is_plane_(mesh.dimension == 2), n_(Index32(nodes.size())) {
    // Machines may stand far from the origin of their axis.
    frame_.origin =
        frame_.origin + dot(mesh.coordinates[nodes.front()] - frame_.origin, frame_.direction) * frame_.direction;
    plane_.dimension = 2;
    plane_.source = mesh.source;
    double size = 0;
    for (Index32 const n : nodes) {
      place_.push_back(place(mesh.coordinates[n]));
      size = std::max(size, distance(place_.back(), place_.front()));
    }
    int const copies = is_plane_ ? 2 : 1;
    Vec3 const across = leads(0) ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    plane_.add_zone("sides", Index(copies) * n_);
    plane_.coordinates = Coordinates(Index(copies) * n_);
    for (int copy = 0; copy < copies; ++copy)
      for (Index32 k = 0; k < n_; ++k)
        plane_.coordinates.set(copy * n_ + k, place_[k] + (is_plane_ ? (2 * copy - 1) * size : 0) * across);
    for (Index f = 0; f < topology.boundary.size(); ++f) {
      std::vector<Index32> corners;
      for (Index32 const n : topology.boundary.nodes[f]) corners.push_back(of_node[graph.representative[n]]);
      if (std::none_of(corners.begin(), corners.end(), [](Index32 k) { return k < 0; })) add(corners);
    }
  }

  [[nodiscard]] bool empty() const { return plane_.n_elements() == 0; }
  /// Whether anything changes along the axis (0), or away from it (1).
  [[nodiscard]] bool leads(int a) const { return !is_plane_ || a == (frame_.is_linear ? 0 : 1); }
  [[nodiscard]] Vec3 place(Vec3 const& x) const {
    Vec3 const d = x - frame_.origin;
    kernels::RowBasis const basis = frame_.basis(x);
    return {leads(0) ? dot(d, basis.along) : 0, leads(1) ? dot(d, basis.away) : 0, 0};
  }
  /// That of node k of the sides.
  [[nodiscard]] Vec3 const& place_of_side(Index32 k) const { return place_[k]; }
  [[nodiscard]] std::vector<Location> locate(HostInstance const& host, std::vector<Vec3> const& places) const {
    return gridmorph::locate(host, plane_, places);
  }
  [[nodiscard]] Vec3 position(Location const& at) const { return gridmorph::position(plane_, at); }
  /// The length of the longest edge of an element along the sides.
  [[nodiscard]] double size(Location const& at) const {
    auto const corners = plane_.elements.corners(at.element);
    double longest = 0;
    for (std::size_t k = 0; k < corners.size(); ++k)
      longest = std::max(longest, distance(plane_.coordinates[corners[k] % n_],
                                           plane_.coordinates[corners[(k + 1) % corners.size()] % n_]));
    return longest;
  }
  [[nodiscard]] InterpolationOperator rows(HostInstance const& host, std::vector<Location> const& at,
                                           std::vector<Index32> const& targets) const {
    InterpolationOperator out = interpolation_rows(host, plane_, at, targets);
    for (Index32& k : out.item) k %= n_;
    return out;
  }

 private:
  void add(std::vector<Index32> const& corners) {
    if (is_plane_) {
      if (corners.size() == 2)
        add(ElementType::quadrilateral, {corners[0], corners[1], corners[1] + n_, corners[0] + n_});
    } else if (corners.size() == 4) {
      add(ElementType::quadrilateral, corners);
    } else {
      for (std::size_t k = 1; k + 1 < corners.size(); ++k)
        add(ElementType::triangle, {corners[0], corners[k], corners[k + 1]});
    }
  }
  /// Seen from the other side faces go the other way round.
  void add(ElementType type, std::vector<Index32> corners) {
    if (face_normal(corners, plane_.coordinates).z < 0) std::reverse(corners.begin(), corners.end());
    plane_.add_element(type, corners);
  }

  kernels::RowFrame frame_;
  bool is_plane_;
  Index32 n_;
  std::vector<Vec3> place_;
  Mesh plane_;
};

/// The rows whose targets count, with their weights to the last bit.
InterpolationOperator rows_of(InterpolationOperator const& rows, std::vector<std::uint8_t> const& counts) {
  InterpolationOperator out;
  for (Index r = 0; r < rows.size(); ++r) {
    if (counts[rows.target[r]] == 0) continue;
    out.target.push_back(rows.target[r]);
    out.item.insert(out.item.end(), rows.item.begin() + rows.first[r], rows.item.begin() + rows.first[r + 1]);
    out.weight.insert(out.weight.end(), rows.weight.begin() + rows.first[r], rows.weight.begin() + rows.first[r + 1]);
    out.first.push_back(Index(out.item.size()));
  }
  return out;
}

/// Nodes in the meridional plane, and the places on the sides there.
struct MeridionalPlaces {
  std::vector<Index32> node;
  std::vector<Vec3> place;
  std::vector<Location> found;

  [[nodiscard]] bool is_whole() const {
    return std::none_of(found.begin(), found.end(), [](Location const& at) { return at.element < 0; });
  }
};

/// Whether sides do different things where they have the same meridional position, as in a wheel whose passages differ.
/// of_node: numbers of the nodes of the sides, `components` what they do.
bool sides_differ(MeridionalSides const& sides, MeridionalPlaces const& at, InterpolationOperator const& rows,
                  std::vector<Index32> const& of_node, std::vector<Vec3> const& components) {
  constexpr double alike = 1e-2;
  double largest = 0;
  for (Vec3 const& c : components) largest = std::max(largest, norm(c));
  for (Index r = 0; r < rows.size(); ++r) {
    Index32 const own = of_node[rows.target[r]];
    if (own < 0) continue;
    double const same_place = 1e-6 * sides.size(at.found[r]);
    for (Index k = rows.first[r]; k < rows.first[r + 1]; ++k) {
      Index32 const other = rows.item[k];
      if (distance(at.place[r], sides.place_of_side(other)) <= same_place &&
          distance(components[own], components[other]) > alike * largest)
        return true;
    }
  }
  return false;
}

/// Sets the places around wall nodes, the length of an element along the sides before and behind each; false where one
/// is not found.
bool find_slopes(HostInstance const& host, MeridionalSides const& sides, MeridionalPlaces const& walls,
                 MotionOfSides& passage) {
  Vec3 const axes[2] = {{1, 0, 0}, {0, 1, 0}};
  std::vector<Vec3> around;
  for (std::size_t k = 0; k < walls.node.size(); ++k)
    for (int a = 0; a < 2; ++a) {
      Vec3 const arm = (sides.leads(a) ? sides.size(walls.found[k]) : 0) * axes[a];
      around.push_back(walls.place[k] - arm);
      around.push_back(walls.place[k] + arm);
    }
  MeridionalPlaces const beside{{}, around, sides.locate(host, around)};
  if (!beside.is_whole()) return false;
  std::vector<Location> all;
  for (std::size_t k = 0; k < walls.node.size(); ++k) {
    Location const& own = walls.found[k];
    all.push_back(own);
    for (int a = 0; a < 2; ++a) {
      Location const *const before = &beside.found[4 * k + 2 * a], *const behind = before + 1;
      all.push_back(*before);
      all.push_back(*behind);
      double const step = dot(axes[a], sides.position(*behind) - sides.position(*before));
      // At the ends of the sides one place is as good as another.
      passage.step.push_back(sides.leads(a) && step > 0.1 * sides.size(own) ? step : 0);
    }
  }
  std::vector<Index32> row(all.size());
  std::iota(row.begin(), row.end(), 0);
  passage.places = sides.rows(host, all, row);
  return true;
}

}  // namespace

std::vector<Index32> UnstructuredPlanner::slots_of_following_sides(std::vector<Vec3> const& given,
                                                                   kernels::RowFrame& frame) const {
  BoundaryConditions const& b = out_.boundary;
  std::optional<kernels::RowFrame> of_rule;
  Mask is_side(b.known.size(), 0), of_row(b.known.size(), 0);
  for (auto const& r : b.requests.requests) {
    CylindricalFrame const* const own = b.motion->row_frame(r.rule);
    if (own == nullptr) continue;
    of_row[r.boundary_node] = 1;
    if (!std::holds_alternative<FollowRule>(b.motion->motion().rules[r.rule].rule)) continue;
    if (of_rule && !(own->row() == *of_rule)) return {};
    of_rule = own->row();
    is_side[r.boundary_node] = is_middle_[b.known[r.boundary_node]] == 0 ? 1 : 0;
  }
  if (!of_rule) return {};
  frame = along_axes(out_.plan.axes, *of_rule);
  std::vector<Index32> slots;
  for (std::size_t k = 0; k < is_side.size(); ++k) {
    if (is_side[k]) slots.push_back(Index32(k));
    // Where others move as well, what the blade does besides does not fade to them.
    if (of_row[k] == 0 && drives_[b.known[k]] == 0 && is_middle_[b.known[k]] == 0 && !(given[k] == Vec3{})) return {};
  }
  return slots;
}

void UnstructuredPlanner::find_passage() {
  UnstructuredPlan& plan = out_.plan;
  ElementOptions const& of = options_.elements;
  bool const may = of.method == NearFieldMethod::automatic || of.method == NearFieldMethod::least_squares;
  std::vector<Vec3> const* const given = shape();
  if (!may || !of.with_sides || of.background || of.tube || given == nullptr || driving_faces_.empty()) return;
  MotionOfSides passage;
  passage.slots = slots_of_following_sides(*given, passage.frame);
  if (passage.empty()) return;
  std::vector<Index32> of_node(mesh_.n_nodes(), -1), nodes;
  for (Index32 const s : passage.slots) {
    of_node[plan.known[s]] = Index32(nodes.size());
    nodes.push_back(plan.known[s]);
  }
  MeridionalSides const sides(mesh_, topology_, out_.graph, passage.frame, of_node, nodes);
  std::vector<Vec3> components;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    kernels::RowBasis const basis = passage.frame.basis(mesh_.coordinates[nodes[k]]);
    components.push_back(basis.components((*given)[passage.slots[k]]));
  }
  bool const do_nothing = std::all_of(components.begin(), components.end(), [](Vec3 const& c) { return c == Vec3{}; });
  if (sides.empty() || do_nothing) return;

  MeridionalPlaces all;
  std::vector<Index32> row_of(mesh_.n_nodes(), -1);
  for (Index32 n = 0; n < Index32(mesh_.n_nodes()); ++n) {
    if (!out_.graph.carries(n) || (out_.graph.neighbours[n].empty() && of_node[n] < 0)) continue;
    row_of[n] = Index32(all.node.size());
    all.node.push_back(n);
    all.place.push_back(sides.place(mesh_.coordinates[n]));
  }
  all.found = sides.locate(host_, all.place);
  if (!all.is_whole()) return;
  // Blades that the sides end at, as in H meshes, are where the sides say nothing.
  for (std::size_t k = 0; k < all.node.size(); ++k)
    if (drives_[all.node[k]] != 0 && all.found[k].distance > 0.5 * sides.size(all.found[k])) return;
  passage.nodes = sides.rows(host_, all.found, all.node);
  if (sides_differ(sides, all, passage.nodes, of_node, components)) return;
  MeridionalPlaces walls;
  for (Index32 const n : plan.driving) {
    walls.node.push_back(n);
    walls.place.push_back(all.place[row_of[n]]);
    walls.found.push_back(all.found[row_of[n]]);
  }
  if (!find_slopes(host_, sides, walls, passage)) return;
  plan.passage = std::move(passage);
  out_.report.with_sides = true;
}

void UnstructuredPlanner::plan_passage() {
  UnstructuredPlan& plan = out_.plan;
  if (plan.passage.empty()) return;
  Mask is_rigid = drives_;
  for (Index32 const n : columns_.node) is_rigid[n] = 1;
  plan.passage.rigid = rows_of(plan.passage.nodes, is_rigid);
  // What walls do besides is nothing at boundaries that are given. Its turns are a difference of two gradients, and
  // say less of what is around than the turns of walls do: half of them, by measurement.
  constexpr double turn_share = 0.5;
  NearestSource const& given = from_given_.distance.empty() ? from_other_ : from_given_;
  for (std::size_t r = 0; r < plan.fit.nodes.target.size(); ++r) {
    plan.fit.room[r] *= turn_share;
    auto const n = std::size_t(plan.fit.nodes.target[r]);
    double const d = beyond_column(n), other = given.distance[n];
    if (!std::isfinite(other)) continue;
    double const kept = faded(d + other > 0 ? d / (d + other) : 0);
    plan.fit.lean[r] = kept * plan.fit.lean[r];
    plan.fit.level[r] *= kept;
  }
}

}  // namespace gridmorph::detail
