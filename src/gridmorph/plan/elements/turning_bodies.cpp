#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/geometry/symmetric_eigen.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/plan/elements/turning_bodies.hpp>

#include <algorithm>
#include <limits>

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

/// What one body ends on: the normals of slip surfaces at it.
class EndsOfBody {
 public:
  /// normal: of the face, weighed by its length.
  void add(Index32 node, Vec3 const& normal, SlipSurface const& surface, Index32 number) {
    nodes_.push_back(node);
    if (surface.kind == SlipSurface::Kind::plane) {
      if (!(norm(plane_) > 0)) plane_ = surface.direction;
      in_one_plane_ = in_one_plane_ && are_parallel(plane_, surface.direction);
    } else {
      curved_ = true;
    }
    // A node that keeps its axial position alone may leave the boundary that it is on.
    is_surface_ = is_surface_ && surface.kind != SlipSurface::Kind::axial;
    if (double const area = norm(normal); area > 0) normals_.add(1 / area, normal);
    auto const at = std::lower_bound(surfaces_.begin(), surfaces_.end(), number);
    if (at == surfaces_.end() || *at != number) surfaces_.insert(at, number);
  }

  /// Sets what the body may do. x: of all nodes.
  void limit(Coordinates const& x, WallBody& body) const {
    body.ends_on = surfaces_;
    body.ends_curved = curved_;
    if (surfaces_.empty()) return;
    Vec3 axis = plane_;
    bool slides = is_surface_ && in_one_plane_;
    if (curved_) {
      // Around a blade walls of a passage point one way but for some twenty degrees.
      constexpr double alike = 0.9;
      PrincipalAxes const axes(normals_);
      axis = axes.direction[0];
      // Edges of plane meshes have none.
      slides = is_surface_ && axes.moment[0] > 0 &&
               axes.moment[0] >= alike * (axes.moment[0] + axes.moment[1] + axes.moment[2]);
    }
    if (!slides || (norm(body.axis) > 0 && !are_parallel(axis, body.axis)))
      body.attached = true;
    else
      body.axis = axis;
    if (!body.attached) find_span(x, body);
  }

 private:
  void find_span(Coordinates const& x, WallBody& body) const {
    auto const at = [&](Index32 n) { return dot(body.axis, x[n]); };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double low = infinity, high = -infinity;
    for (Index32 const n : body.nodes) {
      low = std::min(low, at(n));
      high = std::max(high, at(n));
    }
    // Of the nodes at either end, the innermost; bodies that end in the domain are whole nowhere.
    double lowest = infinity, highest = -infinity, inner_low = low, inner_high = high;
    for (Index32 const n : nodes_) {
      double const h = at(n);
      lowest = std::min(lowest, h);
      highest = std::max(highest, h);
      if (h < 0.5 * (low + high))
        inner_low = std::max(inner_low, h);
      else
        inner_high = std::min(inner_high, h);
    }
    if (lowest > low || highest < high) return;
    body.span[0] = inner_low;
    body.span[1] = inner_high;
  }

  Moments normals_;
  Vec3 plane_;
  bool in_one_plane_ = true, curved_ = false, is_surface_ = true;
  std::vector<Index32> surfaces_, nodes_;
};

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
  std::vector<EndsOfBody> ends(out.bodies.size());
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
    Vec3 const normal = slips ? face_normal(topology.boundary.nodes[f], mesh.coordinates) : Vec3{};
    for (Index32 const n : nodes) {
      if (body_of[n] < 0) continue;
      if (slips)
        ends[body_of[n]].add(n, normal, surfaces[face.surface], face.surface);
      else
        out.bodies[body_of[n]].attached = true;
    }
  }
  for (std::size_t b = 0; b < ends.size(); ++b) ends[b].limit(mesh.coordinates, out.bodies[b]);
  return out;
}

}  // namespace gridmorph
