// What share of each body's turn and shift a node makes: by its distances, and in narrow surroundings, of plane meshes
// and of bodies from one slip surface to another, by what it sees.
#include <gridmorph/core/for_all.hpp>
#include <gridmorph/geometry/symmetric_eigen.hpp>
#include <gridmorph/plan/elements/facet_distance.hpp>
#include <gridmorph/plan/elements/turning_bodies.hpp>
#include <gridmorph/plan/elements/unstructured_planner.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace gridmorph::detail {

namespace {

/// Boundary faces that are a body's, or turn with some bodies, or with none.
struct FaceGroup {
  Index32 surface = -1;  ///< slip surface that they lie on, where a body turns along it
  CsrGraph faces;
  double layer = 0;    ///< what stays with them: columns, and the first cells of bodies without any
  double columns = 0;  ///< columns alone
  bool counts = true;  ///< unless all bodies turn along it
};

// How much farther than the nearest one an image has no share, in pitches.
constexpr double pitches_in_sight = 1.5;

// What a rule displaces; what no body turns along.
constexpr std::size_t given = 0, crosswise = 1;

/// What places are measured against.
struct Boundaries {
  HostInstance const& host;
  Mesh const& mesh;
  BoundaryFaces const& faces;
  std::vector<WallBody> const& bodies;
  std::vector<Vec3> const& centre;
  std::vector<double> const& size;   ///< of bodies
  std::vector<double> const& moved;  ///< how far they shift; 0: not known
  std::vector<RigidTransform> const& moves;
  RestingFaces const& resting;
  std::vector<SlipSurface> const& surfaces;
  std::vector<double> const &column_height, &standing_height;
};

/// Where faces cut the plane dot(axis, x) = height.
std::vector<SeenPiece> section(Coordinates const& x, CsrGraph const& faces, Vec3 const& axis, double height) {
  std::vector<SeenPiece> out;
  std::vector<Vec3> cuts;
  for (Index f = 0; f < faces.size(); ++f) {
    auto const face = faces[f];
    cuts.clear();
    for (std::size_t k = 0; k < face.size(); ++k) {
      Vec3 const a = x[face[k]], b = x[face[(k + 1) % face.size()]];
      double const of_a = dot(axis, a) - height, of_b = dot(axis, b) - height;
      if ((of_a < 0) != (of_b < 0)) cuts.push_back(a + (of_a / (of_a - of_b)) * (b - a));
    }
    for (std::size_t k = 1; k < cuts.size(); k += 2)
      out.push_back({0.5 * (cuts[k - 1] + cuts[k]), gridmorph::distance(cuts[k - 1], cuts[k])});
  }
  return out;
}

/// Faces seen along an axis, as if all of them were as high as a body: a plane would miss some of them between walls
/// that are cones.
std::vector<SeenPiece> plan_view(Coordinates const& x, CsrGraph const& faces, Vec3 const& axis, double height) {
  std::vector<SeenPiece> out;
  for (Index f = 0; f < faces.size(); ++f) {
    auto const face = faces[f];
    Vec3 const area = 0.5 * face_normal(face, x);
    Vec3 centre;
    for (Index32 const n : face) centre += (1 / double(face.size())) * x[n];
    out.push_back({centre, norm(area - dot(area, axis) * axis) / height});
  }
  return out;
}

/// What is in sight of a body: in its plane, or in sections along its span and linear between these.
struct Sight {
  Vec3 axis;
  std::vector<double> height;  ///< of sections, ascending; none in plane meshes
  std::vector<Surroundings> at;

  void operator()(Vec3 const& p, std::span<double> seen) const {
    std::fill(seen.begin(), seen.end(), 0.0);
    if (height.empty()) return at.front().add(p, 1, seen);
    double const h = std::clamp(dot(axis, p), height.front(), height.back());
    auto const above = std::upper_bound(height.begin() + 1, height.end() - 1, h);
    auto const k = std::size_t(above - height.begin());
    double const t = (h - height[k - 1]) / (height[k] - height[k - 1]);
    at[k - 1].add(p, 1 - t, seen);
    at[k].add(p, t, seen);
  }
};

class Places {
 public:
  explicit Places(Boundaries const& b);

  /// Room to compute shares in, for one thread.
  struct Room {
    std::vector<int> start;
    std::vector<double> distance;  ///< (moves, groups) of the place that each move takes to the node
    std::vector<double> nearest;   ///< per group: of all moves
    std::vector<double> turn;      ///< per image: share
    std::vector<double> shift;     ///< per body: share
    std::vector<double> seen, closeness, parts, beyond;
    std::vector<std::pair<double, std::size_t>> least;  ///< least distances of images, and the images
    std::vector<std::uint8_t> out_of_sight;             ///< per image
  };
  [[nodiscard]] Room room() const;
  /// Sets room.turn and room.shift to the shares at a place.
  void shares(Vec3 const& x, Room& room) const;

 private:
  void add_resting_faces();
  void add_bodies();
  void look_around(std::size_t body, double edges);
  /// By group, as body sees them; in space its own section is left out.
  [[nodiscard]] std::vector<std::vector<SeenPiece>> walls_around(std::size_t body) const;
  [[nodiscard]] bool turns_along(std::size_t body, Index32 surface) const;
  [[nodiscard]] bool turns_with(std::size_t body, std::size_t group) const {
    return group == first_body_ + body || (group < first_body_ && turns_along(body, groups_[group].surface));
  }
  [[nodiscard]] double& distance(Room& room, std::size_t move, std::size_t group) const {
    return room.distance[move * groups_.size() + group];
  }
  [[nodiscard]] TurnDistances distances(Room& room, std::size_t image) const;
  void turns_in_sight(Vec3 const& x, std::size_t body, Room& room) const;
  void shifts(Room& room) const;
  void measure(Vec3 const& x, Room& room) const;
  /// Measures the distance of the place that a move takes to x.
  void measure(Vec3 const& x, std::size_t move, std::size_t group, Room& room) const;
  /// Measures those from the images of a single body, but for images that have no share.
  void measure_row(Vec3 const& x, Room& room) const;
  /// The distance from one image of a body to the next.
  [[nodiscard]] double pitch(std::size_t body) const {
    return gridmorph::distance(b_.moves[1](b_.centre[body]), b_.centre[body]);
  }

  Boundaries b_;
  std::vector<RigidTransform> back_;  ///< per move
  bool images_shift_alike_ = true;    ///< no move turns
  std::vector<FaceGroup> groups_;
  std::size_t first_body_ = 0;
  std::vector<FacetDistance> from_;  ///< per group
  std::vector<double> in_sight_;     ///< per body: how much what is in sight has a say in narrow surroundings
  std::vector<std::optional<Sight>> around_;
};

Places::Places(Boundaries const& b) : b_(b) {
  for (RigidTransform const& move : b_.moves) {
    back_.push_back(move.inverse());
    for (Vec3 const& e : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
      images_shift_alike_ = images_shift_alike_ && gridmorph::distance(move.rotation * e, e) < 1e-9;
  }
  add_resting_faces();
  first_body_ = groups_.size();
  add_bodies();
}

bool Places::turns_along(std::size_t body, Index32 surface) const {
  Vec3 const axis = b_.bodies[body].axis;
  auto const& ends = b_.bodies[body].ends_on;
  if (std::binary_search(ends.begin(), ends.end(), surface)) return true;
  return surface >= 0 && b_.mesh.dimension == 3 && b_.surfaces[surface].kind == SlipSurface::Kind::plane &&
         dot(axis, axis) > 0 && are_parallel(b_.surfaces[surface].direction, axis);
}

void Places::add_resting_faces() {
  groups_.resize(2);
  for (Index f = 0; f < b_.resting.faces.size(); ++f) {
    // Images turn behind them.
    if (b_.moves.size() > 1 && b_.resting.periodic[f] != 0) continue;
    Index32 const s = b_.resting.slides_on[f];
    bool own = false;
    for (std::size_t b = 0; b < b_.bodies.size(); ++b) own = own || turns_along(b, s);
    std::size_t g = b_.resting.given[f] != 0 ? given : crosswise;
    if (own) {
      for (g = 2; g < groups_.size() && groups_[g].surface != s;) ++g;
      if (g == groups_.size()) groups_.emplace_back().surface = s;
    }
    groups_[g].faces.add(b_.resting.faces[f]);
    for (Index32 const n : b_.resting.faces[f])
      groups_[g].layer = std::max({groups_[g].layer, b_.standing_height[n], b_.column_height[n]});
    groups_[g].columns = groups_[g].layer;
  }
  for (FaceGroup const& g : groups_) from_.emplace_back(b_.mesh.coordinates, g.faces);
}

void Places::add_bodies() {
  std::vector<double> edges;
  for (WallBody const& body : b_.bodies) {
    FaceGroup& g = groups_.emplace_back();
    edges.push_back(0);
    Index n_edges = 0;
    for (Index32 const f : body.faces) {
      auto const face = b_.faces.nodes[f];
      g.faces.add(face);
      for (std::size_t k = 0; k < face.size(); ++k, ++n_edges)
        edges.back() +=
            gridmorph::distance(b_.mesh.coordinates[face[k]], b_.mesh.coordinates[face[(k + 1) % face.size()]]);
    }
    for (Index32 const n : body.nodes) g.columns = std::max(g.columns, b_.column_height[n]);
    // Without columns the first cells turn with the wall, about as high as its faces are long.
    g.layer = g.columns > 0 ? g.columns : edges.back() / double(n_edges);
    from_.emplace_back(b_.mesh.coordinates, g.faces);
  }
  for (std::size_t k = given + 1; k < first_body_; ++k) {
    groups_[k].counts = false;
    for (std::size_t b = 0; b < b_.bodies.size(); ++b) groups_[k].counts = groups_[k].counts || !turns_with(b, k);
  }
  for (std::size_t b = 0; b < b_.bodies.size(); ++b) look_around(b, edges[b]);
}

void Places::look_around(std::size_t body, double edges) {
  in_sight_.push_back(0);
  around_.emplace_back();
  WallBody const& of = b_.bodies[body];
  bool const in_space = b_.mesh.dimension == 3, has_images = b_.moves.size() > 1;
  // In space, around corners, it falls off too fast: cubes in boxes fare better by distances.
  if (in_space && !of.is_spanned()) return;
  CsrGraph const& own_faces = groups_[first_body_ + body].faces;
  auto const own_section = [&](double height) { return section(b_.mesh.coordinates, own_faces, of.axis, height); };
  double perimeter = in_space ? 0 : 0.5 * edges;
  Moments extent;
  if (in_space) {
    for (auto const& [centre, length] : own_section(0.5 * (of.span[0] + of.span[1]))) {
      Vec3 const arm = centre - b_.centre[body];
      extent.add(length, arm - dot(arm, of.axis) * of.axis);
      perimeter += length;
    }
  }
  in_sight_[body] = has_images ? 1 : compactness(perimeter, b_.size[body]);
  if (!(in_sight_[body] > 0)) return;
  double gap = infinity;
  std::vector<int> start(from_.size(), 0);
  for (Index32 const n : of.nodes)
    for (std::size_t k = 0; k < from_.size(); ++k)
      if (!turns_with(body, k)) gap = std::min(gap, from_[k](b_.mesh.coordinates[n], start[k]));
  if (!has_images && !(narrowness(gap, b_.size[body]) > 0)) return;
  Sight& sight = around_[body].emplace();
  auto walls = walls_around(body);
  if (!in_space) {
    sight.at.emplace_back(b_.host, SightPlane{b_.centre[body]}, walls, from_, b_.size[body]);
    return;
  }
  sight.axis = of.axis;
  // Lattices lie along the section, so that they turn with the mesh.
  Vec3 const along = PrincipalAxes(extent).direction[0], across = cross(of.axis, along);
  constexpr int sections = 5;
  for (int k = 0; k < sections; ++k) {
    double const height = of.span[0] + (of.span[1] - of.span[0]) * (k + 0.5) / sections;
    Vec3 const centre = b_.centre[body] + (height - dot(of.axis, b_.centre[body])) * of.axis;
    walls[first_body_ + body] = own_section(height);
    sight.height.push_back(height);
    sight.at.emplace_back(b_.host, SightPlane{centre, along, across}, walls, from_, b_.size[body]);
  }
}

std::vector<std::vector<SeenPiece>> Places::walls_around(std::size_t body) const {
  std::vector<std::vector<SeenPiece>> out;
  auto const& x = b_.mesh.coordinates;
  WallBody const& of = b_.bodies[body];
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    auto& wall = out.emplace_back();
    CsrGraph const& faces = groups_[k].faces;
    if (b_.mesh.dimension == 2)
      for (Index f = 0; f < faces.size(); ++f) {
        Vec3 const a = x[faces[f][0]], b = x[faces[f][1]];
        wall.push_back({0.5 * (a + b), gridmorph::distance(a, b)});
      }
    else if (!turns_with(body, k))
      wall = plan_view(x, faces, of.axis, of.span[1] - of.span[0]);
  }
  return out;
}

Places::Room Places::room() const {
  std::size_t const n = groups_.size() * b_.moves.size();
  Room out;
  out.start.assign(n, 0);
  out.distance.resize(n);
  out.nearest.resize(groups_.size());
  out.turn.resize(b_.bodies.size() * b_.moves.size());
  out.shift.resize(b_.bodies.size());
  out.seen.resize(groups_.size());
  out.closeness.resize(n);
  out.parts.resize(b_.moves.size());
  out.beyond.resize(b_.bodies.size());
  out.least.resize(b_.moves.size());
  out.out_of_sight.assign(b_.moves.size(), 0);
  return out;
}

void Places::measure(Vec3 const& x, std::size_t move, std::size_t group, Room& room) const {
  Vec3 const y = move == 0 ? x : back_[move](x);
  double const d = distance(room, move, group) = from_[group](y, room.start[move * groups_.size() + group]);
  room.nearest[group] = std::min(room.nearest[group], d);
}

void Places::measure(Vec3 const& x, Room& room) const {
  std::fill(room.nearest.begin(), room.nearest.end(), infinity);
  bool const is_row = b_.moves.size() > 1 && b_.bodies.size() == 1 && around_[0] && in_sight_[0] == 1;
  for (std::size_t m = 0; m < b_.moves.size(); ++m)
    for (std::size_t k = 0; k < groups_.size(); ++k)
      if (groups_[k].counts && !(is_row && k == first_body_)) measure(x, m, k, room);
  if (is_row) measure_row(x, room);
}

void Places::measure_row(Vec3 const& x, Room& room) const {
  // Far images cost most: blades that are seen from afar at an angle have many boxes that are about as near.
  for (std::size_t m = 0; m < b_.moves.size(); ++m) {
    room.least[m] = {m == 0 ? 0 : from_[first_body_].at_least(back_[m](x)), m};
    room.out_of_sight[m] = 0;
    distance(room, m, first_body_) = infinity;
  }
  std::sort(room.least.begin(), room.least.end());
  double& nearest = room.nearest[first_body_];
  double second = infinity;
  for (auto const& [least, m] : room.least) {
    if (least > std::max(second, nearest + pitches_in_sight * pitch(0))) {
      room.out_of_sight[m] = 1;
      continue;
    }
    double const last = nearest;
    measure(x, m, first_body_, room);
    second = std::min(second, std::max(last, distance(room, m, first_body_)));
  }
  double others = second;
  for (std::size_t k = 0; k < first_body_; ++k)
    if (!turns_with(0, k)) others = std::min(others, room.nearest[k]);
  if (narrowness(nearest + others, b_.size[0]) == 1) return;
  for (std::size_t m = 0; m < b_.moves.size(); ++m) {
    if (room.out_of_sight[m] != 0) measure(x, m, first_body_, room);
    room.out_of_sight[m] = 0;
  }
}

void Places::shares(Vec3 const& x, Room& room) const {
  measure(x, room);
  for (std::size_t e = 0; e < room.turn.size(); ++e)
    room.turn[e] = room.out_of_sight[e / b_.bodies.size()] != 0 ? 0 : turn_share(distances(room, e));
  share_between(room.turn);
  for (std::size_t b = 0; b < b_.bodies.size(); ++b)
    if (around_[b]) turns_in_sight(x, b, room);
  shifts(room);
}

TurnDistances Places::distances(Room& room, std::size_t image) const {
  std::size_t const move = image / b_.bodies.size(), body = image % b_.bodies.size();
  TurnDistances at{distance(room, move, first_body_ + body), infinity, groups_[first_body_ + body].layer, 0,
                   b_.size[body]};
  auto const is_beside = [&](double d, std::size_t group) {
    at.others = std::min(at.others, d);
    at.other_layer = std::max(at.other_layer, groups_[group].layer);
  };
  for (std::size_t k = 0; k < first_body_; ++k)
    if (!turns_with(body, k)) is_beside(room.nearest[k], k);
  for (std::size_t m = 0; m < b_.moves.size(); ++m)
    for (std::size_t b = 0; b < b_.bodies.size(); ++b)
      if (m != move || b != body) is_beside(distance(room, m, first_body_ + b), first_body_ + b);
  return at;
}

void Places::turns_in_sight(Vec3 const& x, std::size_t body, Room& room) const {
  std::size_t const n_bodies = b_.bodies.size(), n_groups = groups_.size(), own = first_body_ + body;
  std::size_t home = 0;
  for (std::size_t m = 1; m < b_.moves.size(); ++m)
    if (distance(room, m, own) < distance(room, home, own)) home = m;
  TurnDistances const at = distances(room, home * n_bodies + body);
  double const way = at.body + at.others, narrow = in_sight_[body] * narrowness(way, b_.size[body]);
  if (!(narrow > 0)) return;
  // Images much farther than the nearest one do not count: they are listed up to some passage only.
  auto const counts = [&](std::size_t move, std::size_t group) {
    if (b_.moves.size() == 1 || group < first_body_) return 1.0;
    double const t = (distance(room, move, group) - room.nearest[group]) / (pitches_in_sight * pitch(body));
    return t < 1 ? (1 - t * t) * (1 - t * t) : 0.0;
  };
  double beside = 0, all = 0;
  for (std::size_t m = 0; m < b_.moves.size(); ++m) {
    (*around_[body])(m == 0 ? x : back_[m](x), room.seen);
    for (std::size_t k = 0; k < n_groups; ++k) {
      if ((turns_with(body, k) && k != own) || groups_[k].faces.size() == 0) continue;
      double const d = distance(room, m, k), e = d - std::min(groups_[k].columns, way / 3);
      double const closeness = e > 0 ? counts(m, k) * room.seen[k] / e : infinity;
      room.closeness[m * n_groups + k] = closeness;
      (k == own ? all : beside) += closeness;
    }
  }
  double const together = turn_share_in_sight(all, beside);
  double sum = 0;
  std::vector<double>& parts = room.parts;
  for (std::size_t m = 0; m < b_.moves.size(); ++m) {
    double rest = 0;
    for (std::size_t k = 0; k < b_.moves.size(); ++k)
      if (k != m) rest += room.closeness[k * n_groups + own];
    double const c = room.closeness[m * n_groups + own];
    sum += parts[m] = b_.moves.size() == 1 ? 1 : c > 0 ? turn_share_in_sight(c, rest) : 0;
  }
  for (std::size_t m = 0; m < b_.moves.size(); ++m) {
    double& share = room.turn[m * n_bodies + body];
    share += narrow * (together * (sum > 0 ? parts[m] / sum : 0) - share);
  }
}

void Places::shifts(Room& room) const {
  auto const from_body = [&](std::size_t b) {
    return images_shift_alike_ ? room.nearest[first_body_ + b] : distance(room, 0, first_body_ + b);
  };
  // As columns count for turns.
  double const from_given = room.nearest[given];
  double nearest = from_given;
  for (std::size_t b = 0; b < b_.bodies.size(); ++b) {
    double others = from_given;
    for (std::size_t k = 0; k < b_.bodies.size(); ++k)
      if (k != b) others = std::min(others, from_body(k));
    double const d = from_body(b), way = d + others;
    room.beyond[b] = std::max(0.0, d - std::min(groups_[first_body_ + b].layer, way / 3));
    nearest = std::min(nearest, from_given - std::min(groups_[given].layer, (d + from_given) / 3));
  }
  shift_shares(room.beyond, b_.size, b_.moved, std::max(0.0, nearest), room.shift);
}

}  // namespace

void UnstructuredPlanner::share_turns(Mask const& given) {
  TurningBodies& all = out_.plan.turns_of_bodies;
  std::size_t const n_nodes = std::size_t(mesh_.n_nodes());
  Places const places({host_, mesh_, topology_.boundary, wall_bodies_.bodies, all.centre, body_sizes_, body_shifts_,
                       moves_, wall_bodies_.resting, out_.plan.surfaces, columns_.height, standing_.height});
  constexpr std::size_t at_once = 512;
  for_all_parts(host_, "gridmorph::turn_shares", Index((n_nodes + at_once - 1) / at_once), [&](Index part) {
    Places::Room room = places.room();
    std::size_t const end = std::min(n_nodes, std::size_t(part + 1) * at_once);
    for (std::size_t n = std::size_t(part) * at_once; n < end; ++n) {
      if (given[n] == Given::all) continue;
      places.shares(mesh_.coordinates[Index(n)], room);
      if (given[n] == Given::nothing)
        for (std::size_t e = 0; e < room.turn.size(); ++e) all.share[e * n_nodes + n] = room.turn[e];
      for (std::size_t b = 0; b < room.shift.size(); ++b) all.shift_share[b * n_nodes + n] = room.shift[b];
    }
  });
}

}  // namespace gridmorph::detail
