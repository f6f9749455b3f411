#include <gridmorph/plan/blocks/wall_roots.hpp>

#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/kernels/box_tree.hpp>

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>
#include <utility>

namespace gridmorph {

RootFace::RootFace(PlanContext const& context, FaceSide const& face)
    : piece(face.piece), axis(face.axis), side(face.side) {
  Lattice const& lattice = context.topology.lattice;
  zone = lattice.zone_of(face.entity);
  int n = 0;
  for (int d = 0; d < 3; ++d)
    if (d != axis) along[n++] = d;
  nodes = closed_nodes(lattice, face.entity);
  of_node.resize(nodes.size());
  Index3 const place = lattice.position(face.entity);
  for (int dq = -1; dq <= 1; ++dq)
    for (int dp = -1; dp <= 1; ++dp) {
      Index3 part = place;
      part[along[0]] += dp;
      part[along[1]] += dq;
      int const entity = lattice.entity(zone, part);
      auto const rows = context.skeleton.rows(entity);
      if (!rows) continue;
      for (int q = 0; q < rows->n_q; ++q)
        for (int p = 0; p < rows->n_p; ++p) {
          Index3 const node = node_at(*rows, p, q);
          of_node[std::size_t(node[along[0]] - nodes.begin[along[0]]) +
                  std::size_t(nodes.extent(along[0])) * (node[along[1]] - nodes.begin[along[1]])] = {
              rows->slot + p + rows->slot_q * q, &lattice.copy_of(entity)};
        }
    }
}

bool points_out(Mesh const& mesh, RootFace const& face, int p, int q) {
  Zone const& zone = mesh.zones[face.zone];
  Index const inwards = face.side == 0 ? zone.strides()[face.axis] : -zone.strides()[face.axis];
  auto const x = [&](int dp, int dq) { return mesh.coordinates[zone.node(face.at(p + dp, q + dq))]; };
  Vec3 const normal = cross(x(1, 1) - x(0, 0), x(0, 1) - x(1, 0));
  double in = 0;
  for (int dq = 0; dq < 2; ++dq)
    for (int dp = 0; dp < 2; ++dp)
      in += dot(normal, mesh.coordinates[zone.node(face.at(p + dp, q + dq)) + inwards] - x(dp, dq));
  return in < 0;
}

kernels::RootNeighbour neighbour(PlanContext const& context, RootFace const& face, Index3 const& corner,
                                 RootFace::Node const& root, Index3 const& other_corner, RootFace::Node const& other) {
  Zone const& zone = context.mesh.zones[face.zone];
  Vec3 const arm = context.mesh.coordinates[zone.node(other_corner)] - context.mesh.coordinates[zone.node(corner)];
  Mat3 const to_root = transpose(root.copy->transform.rotation);
  bool const same = (!root.copy->moved && !other.copy->moved) ||
                    same_rotation(root.copy->transform.rotation, other.copy->transform.rotation);
  return {other.slot, same ? -1 : context.rotations.number(to_root * other.copy->transform.rotation),
          root.copy->moved ? to_root * arm : arm};
}

Vec3 fan_normal(std::vector<kernels::RootNeighbour> const& around) {
  Vec3 sum;
  for (std::size_t k = 0; k + 1 < around.size(); k += 2) sum += cross(around[k].arm, around[k + 1].arm);
  return sum;
}

WallRoots::Place WallRoots::at(Index node) const {
  auto const found = place_.find(node);
  return found == place_.end() ? Place{} : found->second;
}

void WallRoots::add_walls(std::vector<int> const& patches, double turn) {
  Lattice const& lattice = context_.topology.lattice;
  std::vector<char> wanted(is_wall_.size(), 0);
  for (int const p : patches) is_wall_[p] = wanted[p] = 1;
  of_slot_.resize(context_.skeleton.size(), -1);
  for (int c = 0; c < lattice.n_classes(); ++c) {
    int const patch = context_.topology.blocks.patch_of_face()[c];
    if (patch < 0 || wanted[patch] == 0) continue;
    RootFace face(context_, lattice.face_sides(c).front());
    face.patch = patch;
    Zone const& zone = context_.mesh.zones[face.zone];
    for (int q = 0; q < face.nodes.extent(face.along[1]); ++q)
      for (int p = 0; p < face.nodes.extent(face.along[0]); ++p) {
        RootFace::Node const& node = face(p, q);
        std::int32_t& root = of_slot_[node.slot];
        if (root < 0) {
          root = std::int32_t(nodes_.size());
          nodes_.push_back({.slot = node.slot, .centre = node.slot, .turn = turn});
        }
        place_[zone.node(face.at(p, q))] = {root, node.copy};
      }
    add_neighbours(
        context_, face, [&](Index slot) { return of_slot(slot); }, nodes_);
    faces_.push_back(std::move(face));
  }
}

void WallRoots::mark(Known& known) const {
  Lattice const& lattice = context_.topology.lattice;
  for (RootFace const& face : faces_)
    for (int dq = -1; dq <= 1; ++dq)
      for (int dp = -1; dp <= 1; ++dp) {
        Index3 which{1, 1, 1};
        which[face.axis] = 2 * face.side;
        which[face.along[0]] += dp;
        which[face.along[1]] += dq;
        int const c = lattice.class_of(lattice.entity_of_piece(face.piece, which));
        known.turns[c] = 1;
        if (!centre_.empty()) known.body[c] = body_[of_slot(face(0, 0).slot)];
      }
}

void WallRoots::find_bodies() {
  DisjointSets<std::int32_t> sets(nodes_.size());
  for (std::size_t r = 0; r < nodes_.size(); ++r)
    for (kernels::RootNeighbour const& k : nodes_[r].around) sets.join(std::int32_t(r), of_slot(k.slot));
  std::vector<std::int32_t> const number = sets.set_numbers();
  body_.assign(number.begin(), number.end());
  for (int const body : body_) n_bodies_ = std::max(n_bodies_, body + 1);
}

TurningRoots WallRoots::turning_roots() const {
  constexpr std::size_t chunk_size = 512;
  auto const n_bodies = std::size_t(n_bodies_);
  std::vector<std::vector<std::int32_t>> of_body(n_bodies);
  std::vector<char> one_frame(n_bodies, 1);
  for (std::size_t r = 0; r < body_.size(); ++r) {
    auto const body = std::size_t(body_[r]);
    of_body[body].push_back(std::int32_t(r));
    for (kernels::RootNeighbour const& k : nodes_[r].around)
      if (k.matrix >= 0) one_frame[body] = 0;
  }
  TurningRoots out;
  for (std::size_t b = 0; b < n_bodies; ++b) {
    if (one_frame[b] == 0) of_body[b].clear();
    double area = 0;
    for (std::int32_t const r : of_body[b]) area += norm(fan_normal(nodes_[r].around));
    for (std::size_t k = 0; k < of_body[b].size(); ++k) {
      out.root.push_back(of_body[b][k]);
      out.weight.push_back(area > 0 ? norm(fan_normal(nodes_[of_body[b][k]].around)) / area : 0);
      if ((k + 1) % chunk_size == 0 || k + 1 == of_body[b].size()) out.first.push_back(Index(out.root.size()));
    }
    out.first_chunk.push_back(Index(out.first.size()) - 1);
  }
  return out;
}

template <class Visit>
void WallRoots::for_nodes(Visit const& visit) const {
  for (RootFace const& face : faces_)
    for (int q = 0; q < face.nodes.extent(face.along[1]); ++q)
      for (int p = 0; p < face.nodes.extent(face.along[0]); ++p)
        visit(face, face(p, q), context_.mesh.zones[face.zone].node(face.at(p, q)));
}

void WallRoots::find_centres() {
  centre_.assign(n_bodies_, {});
  std::vector<kernels::Box> box(centre_.size());
  std::vector<double> area(centre_.size(), 0);
  std::vector<char> seen(nodes_.size(), 0);
  for_nodes([&](RootFace const&, RootFace::Node const& node, Index n) {
    auto const root = std::size_t(of_slot(node.slot)), body = std::size_t(body_[root]);
    if (std::exchange(seen[root], 1) != 0) return;
    Vec3 const x = context_.mesh.coordinates[n];
    double const weight = norm(fan_normal(nodes_[root].around));
    centre_[body] += weight * x;
    area[body] += weight;
    box[body].include(x);
  });
  for (std::size_t b = 0; b < centre_.size(); ++b) {
    if (area[b] > 0) centre_[b] = (1 / area[b]) * centre_[b];
    body_size_ = std::max(body_size_, norm(box[b].high - box[b].low));
  }
}

std::vector<WallRoots::BodySample> WallRoots::sample_bodies(Index most) const {
  std::vector<BodySample> samples(centre_.size());
  if (samples.empty()) return samples;
  Index const step = 1 + Index(nodes_.size()) / most;
  Index passed = 0;
  for_nodes([&](RootFace const& face, RootFace::Node const& node, Index n) {
    if (passed++ % step != 0) return;
    BodySample& sample = samples[body_[of_slot(node.slot)]];
    sample.places.push_back(context_.mesh.coordinates[n]);
    sample.patches.push_back(face.patch);
  });
  return samples;
}

void WallRoots::add_line(std::int32_t root, Vec3 const& line) {
  RootNode& node = nodes_[root];
  bool const same = node.n_lines == 1 && distance(node.line, line) < 1e-6;
  if (same) return;
  node.line = node.n_lines++ == 0 ? line : Vec3{};
}

void WallRoots::join_coincident() {
  bool any = false;
  DisjointSets<std::int32_t> sets(nodes_.size());
  for (std::size_t r = 0; r < nodes_.size(); ++r)
    for (kernels::RootNeighbour const& k : nodes_[r].around) {
      if (norm(k.arm) > 0 || k.matrix >= 0) continue;
      sets.join(std::int32_t(r), of_slot(k.slot));
      any = true;
    }
  if (!any) return;
  std::vector<std::int32_t> const first = sets.roots();
  std::vector<std::vector<kernels::RootNeighbour>> together(nodes_.size());
  for (std::size_t r = 0; r < nodes_.size(); ++r) {
    auto& list = together[first[r]];
    list.insert(list.end(), nodes_[r].around.begin(), nodes_[r].around.end());
  }
  for (std::size_t r = 0; r < nodes_.size(); ++r) nodes_[r].around = together[first[r]];
}

double WallRoots::largest_coordinate() const {
  double largest = 0;
  for_nodes([&](RootFace const&, RootFace::Node const&, Index n) {
    Vec3 const x = context_.mesh.coordinates[n];
    largest = std::max({largest, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
  });
  return largest;
}

void WallRoots::turn_as_resolved(CoordinatePrecision const& precision, double roundings) {
  double const least = roundings * precision.at(largest_coordinate());
  resolved_arm_ = least;
  auto const is_resolved = [&](RootNode const& node) {
    return std::ranges::none_of(node.around, [&](kernels::RootNeighbour const& k) {
      double const length = norm(k.arm);
      return length > 0 && length < least;
    });
  };
  std::vector<char> resolved(nodes_.size());
  std::ranges::transform(nodes_, resolved.begin(), is_resolved);
  std::vector<std::int32_t> source(nodes_.size(), -1);
  using Reached = std::tuple<double, std::int32_t, std::int32_t>;  // length of the way, its end, its source
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> ways;
  // Turns are vectors in the frame of a slot, so that ways end where that changes.
  auto const for_neighbours = [&](std::int32_t r, auto const& visit) {
    for (kernels::RootNeighbour const& k : nodes_[r].around)
      if (k.matrix < 0) visit(of_slot(k.slot), norm(k.arm));
  };
  for (std::int32_t r = 0; r < std::int32_t(nodes_.size()); ++r)
    if (!resolved[r])
      for_neighbours(r, [&](std::int32_t other, double length) {
        if (resolved[other]) ways.emplace(length, r, other);
      });
  while (!ways.empty()) {
    auto const [length, r, from] = ways.top();
    ways.pop();
    if (source[r] >= 0) continue;
    source[r] = from;
    // Named one by one: clang below 16 captures no bindings.
    for_neighbours(r, [&, length = length, from = from](std::int32_t other, double step) {
      if (!resolved[other] && source[other] < 0) ways.emplace(length + step, other, from);
    });
  }
  for (std::size_t r = 0; r < nodes_.size(); ++r) {
    if (source[r] < 0) continue;
    nodes_[r].around = nodes_[source[r]].around;
    nodes_[r].centre = nodes_[source[r]].slot;
  }
}

}  // namespace gridmorph
