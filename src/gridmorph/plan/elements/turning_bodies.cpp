#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/plan/elements/turning_bodies.hpp>

#include <algorithm>

namespace gridmorph {
namespace {

/// The kinds of boundary nodes, by number.
struct NodeKinds {
  enum Kind : std::uint8_t { none, given, drives, slips, periodic };
  std::vector<std::uint8_t> kind;
  std::vector<Index32> slip;  ///< number in BoundaryConditions::slip_nodes

  NodeKinds(Index n_nodes, BoundaryConditions const& b) : kind(std::size_t(n_nodes), none), slip(kind.size(), -1) {
    for (auto const& image : b.images) kind[image.node] = kind[image.owner] = periodic;
    for (std::size_t k = 0; k < b.slip_nodes.size(); ++k) {
      kind[b.slip_nodes[k]] = slips;
      slip[b.slip_nodes[k]] = Index32(k);
    }
    for (std::size_t k = 0; k < b.known.size(); ++k) kind[b.known[k]] = b.drives[k] ? drives : given;
  }
};

/// A boundary face that is none of a moving wall's.
struct OtherFace {
  enum class Kind { free, resting, slipping };
  Kind kind = Kind::free;
  Index32 surface = -1;
  bool given = false;  ///< all of it

  OtherFace(std::vector<Index32> const& nodes, NodeKinds const& all, BoundaryConditions const& b) {
    std::size_t count[5] = {}, fewest = 0;
    for (Index32 const n : nodes) {
      ++count[all.kind[n]];
      if (Index32 const s = all.slip[n]; s >= 0 && all.kind[n] == NodeKinds::slips) {
        auto const surfaces = b.slip_surfaces[s];
        if (surfaces.empty() || (fewest > 0 && surfaces.size() >= fewest)) continue;
        fewest = surfaces.size();
        surface = surfaces.front();
      }
    }
    if (surface >= 0)
      kind = Kind::slipping;
    else if (count[NodeKinds::none] == 0 && count[NodeKinds::drives] < nodes.size())
      kind = Kind::resting;
    given = kind == Kind::resting && count[NodeKinds::periodic] == 0;
  }
};

void limit_to(Vec3 const& axis, WallBody& body) {
  if (!(dot(body.axis, body.axis) > 0))
    body.axis = axis;
  else if (!are_parallel(axis, body.axis))
    body.attached = true;
}

}  // namespace

bool are_parallel(Vec3 const& a, Vec3 const& b) { return norm(cross(a, b)) < 1e-6; }

WallBodies find_wall_bodies(Mesh const& mesh, UnstructuredTopology const& topology,
                            BoundaryFacePatches const& face_patches, NodeGraph const& graph,
                            BoundaryConditions const& boundary, std::vector<Index32> const& driving_faces,
                            std::vector<SlipSurface> const& surfaces, Vec3 const& plane_normal) {
  WallBodies out;
  std::vector<Index32> nodes;
  auto const nodes_of = [&](Index f) -> std::vector<Index32> const& {
    nodes.clear();
    for (Index32 const n : topology.boundary.nodes[f]) nodes.push_back(graph.representative[n]);
    return nodes;
  };
  DisjointSets<Index32> touching(std::size_t(mesh.n_nodes()));
  for (Index32 const f : driving_faces)
    for (Index32 const n : nodes_of(f)) touching.join(nodes.front(), n);
  // Counted from 0 in the order of their smallest nodes.
  std::vector<Index32> body_of(mesh.n_nodes(), -1), body_of_root(body_of.size(), -1);
  std::vector<std::uint8_t> of_wall(topology.boundary.size(), 0);
  for (Index32 const f : driving_faces) {
    of_wall[f] = 1;
    for (Index32 const n : nodes_of(f)) body_of[n] = 0;
  }
  for (std::size_t n = 0; n < body_of.size(); ++n) {
    if (body_of[n] < 0) continue;
    Index32& number = body_of_root[touching.root(Index32(n))];
    if (number < 0) {
      number = Index32(out.bodies.size());
      out.bodies.emplace_back();
      if (mesh.dimension == 2) out.bodies.back().axis = plane_normal;
    }
    body_of[n] = number;
    out.bodies[number].nodes.push_back(Index32(n));
  }
  for (Index32 const f : driving_faces) out.bodies[body_of[nodes_of(f).front()]].faces.push_back(f);
  NodeKinds const kinds(mesh.n_nodes(), boundary);
  // Those of periodic connections that a rule moves are given, and no less a boundary than those that move freely.
  std::vector<std::uint8_t> paired = periodic_nodes(mesh);
  for (std::size_t n = 0; n < paired.size(); ++n)
    if (paired[n] != 0) paired[graph.representative[n]] = 1;
  for (Index f = 0; f < topology.boundary.size(); ++f) {
    if (of_wall[f] != 0) continue;
    nodes_of(f);
    bool const between_zones = face_patches.patch[f] == BoundaryFacePatches::connection &&
                               !std::all_of(nodes.begin(), nodes.end(), [&](Index32 n) {
                                 return kinds.kind[n] == NodeKinds::periodic || paired[n] != 0;
                               });
    if (between_zones) continue;
    OtherFace const face(nodes, kinds, boundary);
    bool const slips = face.kind == OtherFace::Kind::slipping;
    if (face.kind != OtherFace::Kind::free) {
      out.resting.faces.add(nodes);
      out.resting.slides_on.push_back(slips ? face.surface : -1);
      out.resting.given.push_back(face.given ? 1 : 0);
      bool const periodic =
          std::all_of(nodes.begin(), nodes.end(), [&](Index32 n) { return paired[n] != 0; }) &&
          std::any_of(nodes.begin(), nodes.end(), [&](Index32 n) { return kinds.kind[n] == NodeKinds::periodic; });
      out.resting.periodic.push_back(periodic ? 1 : 0);
    }
    for (Index32 const n : nodes) {
      if (body_of[n] < 0) continue;
      WallBody& body = out.bodies[body_of[n]];
      if (slips && surfaces[face.surface].kind == SlipSurface::Kind::plane)
        limit_to(surfaces[face.surface].direction, body);
      else
        body.attached = true;
    }
  }
  return out;
}

}  // namespace gridmorph
