#include <gridmorph/geometry/cylindrical.hpp>
#include <gridmorph/geometry/smoothstep.hpp>
#include <gridmorph/motion/boundary_motion.hpp>
#include <gridmorph/plan/elements/locate.hpp>
#include <gridmorph/plan/elements/unstructured_planner.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gridmorph::detail {

namespace {

/// The sides of a passage in the meridional plane: their faces as elements of a plane mesh, along the axis and away
/// from it. Those of a plane mesh are lines, drawn out across the one direction that there is.
class MeridionalSides {
 public:
  /// of_node: numbers of the nodes of the sides, -1: no side.
  MeridionalSides(HostInstance const& host, Mesh const& mesh, UnstructuredTopology const& topology,
                  NodeGraph const& graph, kernels::RowFrame const& frame, std::vector<Index32> const& of_node,
                  std::vector<Index32> const& nodes)
      : host_(host), frame_(frame), is_plane_(mesh.dimension == 2), n_(Index32(nodes.size())) {
    // Machines may stand far from the origin of their axis.
    frame_.origin =
        frame_.origin + dot(mesh.coordinates[nodes.front()] - frame_.origin, frame_.direction) * frame_.direction;
    plane_.dimension = 2;
    plane_.source = mesh.source;
    std::vector<Vec3> at;
    double size = 0;
    for (Index32 const n : nodes) {
      at.push_back(place(mesh.coordinates[n]));
      size = std::max(size, distance(at.back(), at.front()));
    }
    int const copies = is_plane_ ? 2 : 1;
    Vec3 const across = leads(0) ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    plane_.add_zone("sides", Index(copies) * n_);
    plane_.coordinates = Coordinates(Index(copies) * n_);
    for (int copy = 0; copy < copies; ++copy)
      for (Index32 k = 0; k < n_; ++k)
        plane_.coordinates.set(copy * n_ + k, at[k] + (is_plane_ ? (2 * copy - 1) * size : 0) * across);
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
  [[nodiscard]] std::vector<Location> locate(std::vector<Vec3> const& places) const {
    return gridmorph::locate(host_, plane_, places);
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
  [[nodiscard]] InterpolationOperator rows(std::vector<Location> const& at, std::vector<Index32> const& targets) const {
    InterpolationOperator out = interpolation_rows(host_, plane_, at, targets);
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

  HostInstance host_;
  kernels::RowFrame frame_;
  bool is_plane_;
  Index32 n_;
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

bool is_same(CylindricalFrame const& a, CylindricalFrame const& b) {
  return a.origin() == b.origin() && a.direction() == b.direction() && a.is_linear() == b.is_linear() &&
         a.pitch() == b.pitch();
}

}  // namespace

std::vector<Index32> UnstructuredPlanner::slots_of_following_sides(std::vector<Vec3> const& given,
                                                                   kernels::RowFrame& frame) const {
  BoundaryConditions const& b = out_.boundary;
  CylindricalFrame const* of_rule = nullptr;
  Mask is_side(b.known.size(), 0), of_row(b.known.size(), 0);
  for (auto const& r : b.requests.requests) {
    CylindricalFrame const* const own = b.motion->row_frame(r.rule);
    if (own == nullptr) continue;
    of_row[r.boundary_node] = 1;
    if (!std::holds_alternative<FollowRule>(b.motion->motion().rules[r.rule].rule)) continue;
    if (of_rule != nullptr && !is_same(*own, *of_rule)) return {};
    of_rule = own;
    is_side[r.boundary_node] = is_middle_[b.known[r.boundary_node]] == 0 ? 1 : 0;
  }
  if (of_rule == nullptr) return {};
  auto const turned = [&](Vec3 const& v) { return along_axes(out_.plan.axes, v); };
  frame = {turned(of_rule->origin()), turned(of_rule->direction()), turned(of_rule->span()), turned(of_rule->pitch()),
           of_rule->is_linear()};
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
  std::vector<Index32> number(mesh_.n_nodes(), -1), nodes;
  double largest = 0;
  for (Index32 const s : passage.slots) {
    number[plan.known[s]] = Index32(nodes.size());
    nodes.push_back(plan.known[s]);
    largest = std::max(largest, norm((*given)[s]));
  }
  MeridionalSides const sides(host_, mesh_, topology_, out_.graph, passage.frame, number, nodes);
  if (sides.empty() || !(largest > 0)) return;

  std::vector<Index32> targets;
  std::vector<Vec3> places;
  for (Index32 n = 0; n < Index32(mesh_.n_nodes()); ++n) {
    if (!out_.graph.carries(n) || (out_.graph.neighbours[n].empty() && number[n] < 0)) continue;
    targets.push_back(n);
    places.push_back(sides.place(mesh_.coordinates[n]));
  }
  auto const found = sides.locate(places);
  auto const is_lost = [](Location const& at) { return at.element < 0; };
  if (std::any_of(found.begin(), found.end(), is_lost)) return;
  // Blades that the sides end at, as in H meshes, are where the sides say nothing.
  for (std::size_t k = 0; k < targets.size(); ++k)
    if (drives_[targets[k]] != 0 && found[k].distance > 0.5 * sides.size(found[k])) return;
  passage.nodes = sides.rows(found, targets);
  // Passages of a wheel may differ: their sides do, then.
  auto const components = [&](Index32 k) {
    return passage.frame.basis(mesh_.coordinates[nodes[k]]).components((*given)[passage.slots[k]]);
  };
  for (Index r = 0; r < passage.nodes.size(); ++r) {
    Index32 const own = number[passage.nodes.target[r]];
    if (own < 0) continue;
    constexpr double alike = 1e-2;
    for (Index k = passage.nodes.first[r]; k < passage.nodes.first[r + 1]; ++k) {
      Index32 const other = passage.nodes.item[k];
      if (distance(places[r], sides.place(mesh_.coordinates[nodes[other]])) <= 1e-6 * sides.size(found[r]) &&
          distance(components(own), components(other)) > alike * largest)
        return;
    }
  }

  std::vector<Index32> place_of(mesh_.n_nodes(), -1);
  for (std::size_t k = 0; k < targets.size(); ++k) place_of[targets[k]] = Index32(k);
  std::vector<Vec3> around;
  for (Index32 const n : plan.driving) {
    Vec3 const p = places[place_of[n]];
    double const h = sides.size(found[place_of[n]]);
    around.push_back(p);
    for (int a = 0; a < 2; ++a)
      for (double const sign : {-1.0, 1.0})
        around.push_back(sides.leads(a) ? p + sign * h * (a == 0 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}) : p);
  }
  auto const at = sides.locate(around);
  if (std::any_of(at.begin(), at.end(), is_lost)) return;
  std::vector<Index32> row(at.size());
  for (std::size_t k = 0; k < row.size(); ++k) row[k] = Index32(k);
  passage.places = sides.rows(at, row);
  for (std::size_t k = 0; k < plan.driving.size(); ++k)
    for (int a = 0; a < 2; ++a) {
      std::size_t const before = std::size_t(kernels::passage_places) * k + 1 + 2 * std::size_t(a);
      Vec3 const d = sides.position(at[before + 1]) - sides.position(at[before]);
      double const step = a == 0 ? d.x : d.y;
      // At the ends of the sides one place is as good as another.
      passage.step.push_back(sides.leads(a) && step > 0.1 * sides.size(at[before]) ? step : 0);
    }
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
    auto const n = std::size_t(plan.fit.nodes.target[r]);
    double const d = beyond_column(n), other = given.distance[n];
    if (!std::isfinite(other)) continue;
    // As shifts fade, turning_bodies.hpp.
    constexpr double cubic = 0.1;
    double const t = d + other > 0 ? d / (d + other) : 0, kept = 1 - t - cubic * (smoothstep(t) - t);
    plan.fit.lean[r] = kept * plan.fit.lean[r];
    plan.fit.level[r] *= kept;
    plan.fit.room[r] *= turn_share;
  }
}

}  // namespace gridmorph::detail
