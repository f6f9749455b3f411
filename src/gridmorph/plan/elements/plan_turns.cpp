#include <gridmorph/core/for_all.hpp>
#include <gridmorph/geometry/smoothstep.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/plan/elements/body_stretch.hpp>
#include <gridmorph/plan/elements/turning_bodies.hpp>
#include <gridmorph/plan/elements/unstructured_planner.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>

namespace gridmorph::detail {

namespace {

/// Wall nodes that are summed in one go.
constexpr std::size_t chunk_size = 512;

constexpr std::size_t most_bodies = 16;

}  // namespace

void UnstructuredPlanner::find_turning_bodies() {
  auto const extent_of = [&](WallBody const& body) {
    Box box;
    for (Index32 const n : body.nodes) box.include(mesh_.coordinates[n]);
    return gridmorph::distance(box.low, box.high);
  };
  wall_bodies_ = find_wall_bodies(mesh_, topology_, face_patches_, out_.graph, out_.boundary, driving_faces_,
                                  out_.plan.surfaces, out_.plan.plane_normal);
  plan_one_rings();
  auto const modes = modes_of_walls();
  std::vector<WallBody> turning;
  auto const rest = [&](WallBody const& body) {
    for (Index32 const f : body.faces) {
      wall_bodies_.resting.faces.add(topology_.boundary.nodes[f]);
      wall_bodies_.resting.slides_on.push_back(-1);
      wall_bodies_.resting.given.push_back(1);
      wall_bodies_.resting.periodic.push_back(0);
    }
  };
  auto const is_whole = [&](WallBody const& body) {
    return !body.attached && std::all_of(body.nodes.begin(), body.nodes.end(),
                                         [&](Index32 n) { return modes[n] == BoundaryLayer::Mode::rotate; });
  };
  auto& bodies = wall_bodies_.bodies;
  if (options_.elements.method == NearFieldMethod::least_squares || std::all_of(bodies.begin(), bodies.end(), is_whole))
    find_passage();
  // Sides that follow a blade between hub and case move with it; to fade towards them would shear what is between.
  bool const sides_move = std::any_of(bodies.begin(), bodies.end(),
                                      [](WallBody const& body) { return body.ends_curved && !body.attached; }) &&
                          !slots_beside_walls(Beside::anywhere).empty();
  for (WallBody const& body : bodies) {
    if (is_whole(body) && !(sides_move && body.ends_curved) && out_.plan.passage.empty())
      turning.push_back(body);
    else
      rest(body);
  }
  // Each costs a distance and 8 bytes per node of the mesh.
  if (turning.size() > most_bodies) {
    std::stable_sort(turning.begin(), turning.end(),
                     [&](WallBody const& a, WallBody const& b) { return extent_of(a) > extent_of(b); });
    std::for_each(turning.begin() + most_bodies, turning.end(), rest);
    out_.notes.push_back("of " + std::to_string(turning.size()) + " bodies that could turn as wholes the largest " +
                         std::to_string(most_bodies) + " do");
    turning.resize(most_bodies);
  }
  bodies = std::move(turning);
  for (WallBody const& body : bodies) add_turning_body(body);
  fitted_ = out_.report.by_least_squares = goes_by_least_squares();
  if (wall_bodies_.bodies.empty()) return;
  add_other_boundaries();
  plan_stretches();
}

bool UnstructuredPlanner::all_walls_turn() const {
  std::size_t n = 0;
  for (WallBody const& body : wall_bodies_.bodies) n += body.nodes.size();
  return n == out_.plan.driving.size();
}

bool UnstructuredPlanner::goes_by_least_squares() {
  ElementOptions const& of = options_.elements;
  if (driving_faces_.empty()) return false;
  bool const asked = of.method == NearFieldMethod::least_squares;
  if (asked && of.background)
    out_.notes.push_back(
        "near field: by the lattice in place of least squares, since there is a background mesh of your own");
  if (of.background) return false;
  if (of.method != NearFieldMethod::automatic) return asked;
  if (!out_.plan.passage.empty()) return true;
  // Walls around the mesh are no bodies in it. In rows of blades whose sides follow them the lattice keeps more.
  bool const is_periodic = std::any_of(mesh_.connections.begin(), mesh_.connections.end(),
                                       [](Connection const& c) { return c.periodic.has_value(); });
  return !of.tube && all_walls_turn() && wall_bodies_.resting.faces.size() > 0 &&
         (!is_periodic || slots_beside_walls(Beside::anywhere).empty());
}

void UnstructuredPlanner::add_turning_body(WallBody const& body) {
  TurningBodies& all = out_.plan.turns_of_bodies;
  auto const area = areas(body.nodes);
  double sum = 0, size = 0;
  Vec3 centre;
  for (std::size_t k = 0; k < body.nodes.size(); ++k) {
    sum += area[k];
    centre += area[k] * mesh_.coordinates[body.nodes[k]];
  }
  centre = (1 / sum) * centre;
  auto const& driving = out_.plan.driving;
  if (all.first_chunk.empty()) all.first_chunk.push_back(0);
  for (std::size_t k = 0; k < body.nodes.size(); ++k) {
    if (k % chunk_size == 0) all.first.push_back(Index(all.wall.size()));
    auto const place = std::lower_bound(driving.begin(), driving.end(), body.nodes[k]) - driving.begin();
    all.wall.push_back(Index32(place));
    all.slot.push_back(out_.plan.driving_slots[place]);
    all.weight.push_back(area[k] / sum);
    Vec3 const arm = mesh_.coordinates[body.nodes[k]] - centre;
    // From wall to wall it is as large as its sections.
    size = std::max(size, norm(body.is_spanned() ? arm - dot(arm, body.axis) * body.axis : arm));
  }
  all.first_chunk.push_back(Index(all.first.size()));
  body_sizes_.push_back(size);
  body_shifts_.push_back(0);
  body_rests_.push_back(0);
  all.centre.push_back(centre);
  all.axis.push_back(body.axis);
}

void UnstructuredPlanner::add_other_boundaries() {
  TurningBodies& all = out_.plan.turns_of_bodies;
  Mask of_body = mask();
  for (WallBody const& body : wall_bodies_.bodies)
    for (Index32 const n : body.nodes) of_body[n] = 1;
  std::vector<Index32> nodes;
  for (std::size_t k = 0; k < out_.plan.known.size(); ++k) {
    Index32 const n = out_.plan.known[k];
    if (of_body[n] != 0 || is_middle_[n] != 0) continue;
    if (nodes.size() % chunk_size == 0) all.first.push_back(Index(all.slot.size()));
    all.slot.push_back(Index32(k));
    nodes.push_back(n);
  }
  auto const area = areas(nodes);
  double const sum = std::accumulate(area.begin(), area.end(), 0.0);
  for (double const a : area) all.weight.push_back(a / sum);
  all.first_chunk.push_back(Index(all.first.size()));
  all.first.push_back(Index(all.slot.size()));
}

std::vector<Vec3> const* UnstructuredPlanner::shape() const {
  if (out_.displacement) return &*out_.displacement;
  return options_.elements.shape.empty() ? nullptr : &options_.elements.shape;
}

std::vector<kernels::Quaternion<Vec3>> UnstructuredPlanner::turns_of_walls(
    std::vector<Vec3> const& displacement) const {
  using Host = Kokkos::HostSpace;
  UnstructuredPlan const& plan = out_.plan;
  std::vector<Vec3> u(mesh_.n_nodes());
  for (std::size_t k = 0; k < plan.known.size(); ++k) u[plan.known[k]] = displacement[k];
  auto const view = [](auto const& list) {
    using T = typename std::decay_t<decltype(list)>::value_type;
    return Kokkos::View<T const*, Host>(list.data(), list.size());
  };
  kernels::WallTable<Host> const walls{view(plan.driving),
                                       view(plan.one_rings.first),
                                       view(plan.one_rings.item),
                                       view(plan.turns),
                                       plan.dimension == 2,
                                       plan.plane_normal,
                                       {},
                                       {}};
  auto const& c = mesh_.coordinates;
  kernels::Field<double const> const x{c.x.data(), c.y.data(), c.z.data()};
  std::vector<Vec3> turn(plan.driving.size());
  kernels::WallTurn<Host, Vec3> const turns{walls, {x}, {x, u.data()}, turn.data()};
  for_all(host_, "gridmorph::wall_turn", Index(turn.size()), [&](Index r) { turns(r); });
  std::vector<kernels::Quaternion<Vec3>> out;
  for (Vec3 const& t : turn) out.push_back(kernels::quaternion_of(t));
  return out;
}

void UnstructuredPlanner::plan_stretches() {
  auto const* const given = shape();
  if (given == nullptr) return;
  TurningBodies& all = out_.plan.turns_of_bodies;
  auto const turn = turns_of_walls(*given);
  // A body's shift is what it moves by beyond the mean of all other boundaries.
  Vec3 shift_of_others;
  for (std::size_t k = all.wall.size(); k < all.slot.size(); ++k)
    shift_of_others += all.weight[k] * (*given)[all.slot[k]];
  double reach = 0, rest_reach = 0;
  Mask of_body(given->size(), 0);
  std::size_t first = 0;
  for (std::size_t b = 0; b < wall_bodies_.bodies.size(); ++b) {
    std::size_t const end = first + wall_bodies_.bodies[b].nodes.size();
    Vec3 shift;
    BodyStretch const stretch = stretch_of(b, first, end, *given, turn, shift);
    all.limits.push_back(stretch.limits());
    body_rests_[b] = stretch.largest_rest();
    if (out_.displacement) body_shifts_[b] = norm(shift - shift_of_others);
    for (std::size_t k = first; k < end; ++k) {
      Vec3 const rest = stretch.rest(arm_in_body(b, k), (*given)[all.slot[k]]);
      reach = std::max(reach, norm(rest));
      rest_reach = std::max(rest_reach, norm(rest - (shift - shift_of_others)));
      of_body[all.slot[k]] = 1;
    }
    first = end;
  }
  if (std::all_of(all.limits.begin(), all.limits.end(), [](auto const& body) { return body.share == 0; })) {
    all.limits.clear();
    all.lever.clear();
  }
  if (!out_.displacement) return;
  for (std::size_t slot = 0; slot < given->size(); ++slot) {
    if (of_body[slot] != 0 || is_middle_[out_.plan.known[slot]] != 0) continue;
    reach = std::max(reach, norm((*given)[slot]));
    rest_reach = std::max(rest_reach, norm((*given)[slot]));
  }
  reach_ = reach;
  rest_reach_ = rest_reach;
}

Vec3 UnstructuredPlanner::arm_in_body(std::size_t body, std::size_t k) const {
  TurningBodies const& all = out_.plan.turns_of_bodies;
  return mesh_.coordinates[out_.plan.driving[all.wall[k]]] - all.centre[body];
}

BodyStretch UnstructuredPlanner::stretch_of(std::size_t body, std::size_t first, std::size_t end,
                                            std::vector<Vec3> const& given,
                                            std::vector<kernels::Quaternion<Vec3>> const& turn, Vec3& shift) {
  TurningBodies& all = out_.plan.turns_of_bodies;
  auto const moved = [&](std::size_t k) { return given[all.slot[k]]; };
  kernels::VectorMoments s;
  for (std::size_t k = first; k < end; ++k) {
    shift += all.weight[k] * moved(k);
    // The mean of the nodes' rotations is the one that turns unit vectors most nearly as all of them do.
    for (Vec3 const& e : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
      s.add(all.weight[k] * e, e + turn[all.wall[k]].turned(e));
  }
  BodyStretch out(all.axis[body], kernels::quaternion_of(kernels::best_turn<Vec3>(s, {}, all.axis[body])), fitted_);
  for (std::size_t k = first; k < end; ++k) out.add_place(all.weight[k], arm_in_body(body, k));
  out.find_axes();
  for (std::size_t k = first; k < end; ++k) {
    all.lever.push_back(out.lever(all.weight[k], arm_in_body(body, k)));
    out.add_displacement(moved(k), all.lever.back());
  }
  out.fit();
  for (std::size_t k = first; k < end; ++k) out.add_rest(all.weight[k], arm_in_body(body, k), moved(k) - shift);
  out.decide(body_sizes_[body]);
  return out;
}

std::vector<Vec3> UnstructuredPlanner::stretched_arms() const {
  // By their lengths: at sharp edges columns lean on the wall, and are of no height above it.
  std::vector<double> longest(mesh_.n_nodes(), 0);
  std::vector<Vec3> arm;
  for (std::size_t k = 0; k < columns_.node.size(); ++k) {
    auto const root = columns_.root[k];
    arm.push_back(mesh_.coordinates[columns_.node[k]] - mesh_.coordinates[root]);
    longest[root] = std::max(longest[root], norm(arm.back()));
  }
  for (std::size_t k = 0; k < arm.size(); ++k) arm[k] = smoothstep(norm(arm[k]) / longest[columns_.root[k]]) * arm[k];
  return arm;
}

void UnstructuredPlanner::plan_turns() {
  TurningBodies& all = out_.plan.turns_of_bodies;
  std::size_t const n_bodies = wall_bodies_.bodies.size(), n_nodes = std::size_t(mesh_.n_nodes());
  if (n_bodies == 0) return;
  std::vector<Index32> body_of(n_nodes, -1);
  for (std::size_t b = 0; b < n_bodies; ++b)
    for (Index32 const n : wall_bodies_.bodies[b].nodes) body_of[n] = Index32(b);
  for (Index32 const n : out_.plan.driving) all.body_of_driving.push_back(body_of[n]);
  for (Index32 const n : out_.plan.driving)
    if (body_of[n] >= 0) all.rigid.push_back(n);
  for (std::size_t k = 0; k < columns_.node.size(); ++k)
    if (Index32 const b = body_of[columns_.root[k]]; b >= 0) {
      body_of[columns_.node[k]] = b;
      all.rigid.push_back(columns_.node[k]);
    }
  if (!all.lever.empty() && !fitted_) all.column_arm = stretched_arms();
  // Beyond three passages what turns is out of sight, on meshes whose sides go along with the flow too.
  moves_ = periodic_moves(host_, mesh_, out_.graph, out_.boundary, 3);
  for (RigidTransform const& move : moves_)
    for (std::size_t b = 0; b < n_bodies; ++b) all.images.push_back({{move.rotation, move.translation}, Index32(b)});
  all.share.assign(all.images.size() * n_nodes, 0);
  all.shift_share.assign(n_bodies * n_nodes, 0);
  Mask given = mask();
  for (std::size_t n = 0; n < n_nodes; ++n)
    if (body_of[n] >= 0) {
      all.share[std::size_t(body_of[n]) * n_nodes + n] = all.shift_share[std::size_t(body_of[n]) * n_nodes + n] = 1;
      given[n] = Given::all;
    }
  for (std::size_t n = 0; n < n_nodes; ++n)
    if (!out_.graph.carries(Index32(n)) || out_.graph.neighbours[Index32(n)].empty() || is_known_[n])
      given[n] = Given::all;
  for (Index32 const n : standing_.node) given[n] = Given::all;
  // Where no image turns behind them periodic boundaries do not turn.
  if (moves_.size() == 1)
    for (auto const& image : out_.boundary.images)
      for (Index32 const n : {image.node, image.owner}) given[n] = std::max<std::uint8_t>(given[n], Given::turns);
  share_turns(given);
}

}  // namespace gridmorph::detail
