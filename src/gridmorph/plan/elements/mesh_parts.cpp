#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/plan/elements/unstructured_planner.hpp>

#include <algorithm>
#include <span>
#include <utility>

namespace gridmorph::detail {

std::vector<Index32> parts_of_nodes(Mesh const& mesh, NodeGraph const& graph, std::vector<std::uint8_t> const& cuts) {
  auto const n_nodes = std::size_t(mesh.n_nodes());
  DisjointSets<Index32> sets(n_nodes);
  std::vector<std::uint8_t> used(n_nodes, 0);
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    auto const nodes = mesh.elements.nodes[e];
    for (Index32 const n : nodes) {
      used[n] = 1;
      sets.join(nodes.front(), n);
    }
  }
  for (std::size_t n = 0; n < n_nodes; ++n) {
    Index32 const o = graph.representative[n];
    if (cuts.empty() || cuts[o] == 0) sets.join(Index32(n), o);
  }
  for (auto const& connection : mesh.connections) {
    if (!connection.periodic) continue;  // the others are at one place
    for (std::size_t k = 0; k < connection.nodes.size(); ++k) sets.join(connection.nodes[k], connection.donor_nodes[k]);
  }
  auto const root = sets.roots();
  std::vector<Index32> number(n_nodes, -1), part(n_nodes, -1);
  Index32 count = 0;
  for (std::size_t n = 0; n < n_nodes; ++n) {
    if (used[n] == 0) continue;
    Index32& own = number[root[n]];
    if (own < 0) own = count++;
    part[n] = own;
  }
  return part;
}

namespace {

/// Takes a part out of a mesh.
class PartTaker {
 public:
  PartTaker(Mesh const& mesh, NodeGraph const& graph, BoundaryConditions const& boundary,
            std::vector<std::uint8_t> const& of_part)
      : mesh_(mesh),
        graph_(graph),
        boundary_(boundary),
        of_part_(of_part),
        place_(of_part.size(), -1),
        carrier_(of_part.size(), -1) {}

  MeshPart run(HostInstance const& host) && {
    take_nodes();
    take_elements();
    take_patches();
    out_.topology = make_topology(host, out_.mesh);
    out_.face_patches = find_face_patches(out_.mesh, out_.topology);
    take_graph();
    take_boundary();
    return std::move(out_);
  }

 private:
  [[nodiscard]] bool has(Index32 n) const { return of_part_[n] != 0; }
  [[nodiscard]] Index32 place(Index32 n) const { return place_[n]; }

  void take_nodes() {
    for (std::size_t n = 0; n < of_part_.size(); ++n)
      if (of_part_[n] != 0) {
        place_[n] = Index32(out_.nodes.size());
        out_.nodes.push_back(Index32(n));
        Index32& carrier = carrier_[graph_.representative[n]];
        if (carrier < 0) carrier = place_[n];
      }
    Mesh& mesh = out_.mesh;
    mesh.dimension = mesh_.dimension;
    mesh.families = mesh_.families;
    mesh.source = mesh_.source;
    mesh.first_number = mesh_.first_number;
    mesh.coordinates = Coordinates(Index(out_.nodes.size()));
    for (std::size_t k = 0; k < out_.nodes.size(); ++k)
      mesh.coordinates.set(Index(k), mesh_.coordinates[out_.nodes[k]]);
  }

  void take_elements() {
    Mesh& mesh = out_.mesh;
    auto const& polyhedra = mesh_.polyhedra;
    std::vector<Index32> nodes;
    std::size_t p = 0, n = 0;
    for (Zone const& zone : mesh_.zones) {
      Zone own = zone;
      own.extent = {0, 0, 0};  // cells of blocks beside elements are elements here
      own.first_node = Index(n);
      own.first_element = mesh.elements.size();
      for (; n < out_.nodes.size() && out_.nodes[n] < zone.first_node + zone.size(); ++n) ++own.n_nodes;
      own.n_nodes = Index(n) - own.first_node;
      for (Index e = zone.first_element; e < zone.first_element + zone.n_elements; ++e) {
        auto const all = mesh_.elements.nodes[e];
        bool const is_polyhedron = p < polyhedra.element.size() && polyhedra.element[p] == e;
        if (has(all.front())) {
          if (is_polyhedron) take_polyhedron(p);
          out_.elements.push_back(Index32(e));
          mesh.elements.type.push_back(mesh_.elements.type[e]);
          mesh.elements.nodes.add(placed(all, nodes));
          if (!mesh_.elements.number.empty()) mesh.elements.number.push_back(mesh_.elements.number[e]);
        }
        if (is_polyhedron) ++p;
      }
      own.n_elements = mesh.elements.size() - own.first_element;
      mesh.zones.push_back(std::move(own));
    }
  }

  void take_polyhedron(std::size_t p) {
    Polyhedra& to = out_.mesh.polyhedra;
    auto const& from = mesh_.polyhedra;
    if (to.first_face.empty()) to.first_face.push_back(0);
    to.element.push_back(Index32(out_.elements.size()));
    std::vector<Index32> nodes;
    for (Index f = from.first_face[p]; f < from.first_face[p + 1]; ++f) to.faces.add(placed(from.faces[f], nodes));
    to.first_face.push_back(to.faces.size());
  }

  /// The numbers that nodes of the mesh have in the part; valid until `room` is used again.
  std::span<Index32 const> placed(std::span<Index32 const> nodes, std::vector<Index32>& room) const {
    room.clear();
    for (Index32 const n : nodes) room.push_back(place(n));
    return room;
  }

  void take_patches() {
    std::vector<Index32> nodes;
    for (Patch const& patch : mesh_.patches) {
      Patch own = patch;
      own.range = {};
      own.faces = {};
      own.nodes.clear();
      for (Index f = 0; f < patch.faces.size(); ++f)
        if (auto const face = patch.faces[f]; std::all_of(face.begin(), face.end(), [&](Index32 n) { return has(n); }))
          own.faces.add(placed(face, nodes));
      for (Index32 const n : patch.nodes)
        if (has(n)) own.nodes.push_back(place(n));
      out_.mesh.patches.push_back(std::move(own));
    }
    for (Connection const& connection : mesh_.connections) {
      Connection own = connection;
      own.nodes.clear();
      own.donor_nodes.clear();
      for (std::size_t k = 0; k < connection.nodes.size(); ++k)
        if (has(connection.nodes[k]) && has(connection.donor_nodes[k])) {
          own.nodes.push_back(place(connection.nodes[k]));
          own.donor_nodes.push_back(place(connection.donor_nodes[k]));
        }
      out_.mesh.connections.push_back(std::move(own));
    }
  }

  void take_graph() {
    std::vector<Index32> ends;
    for (std::size_t k = 0; k < out_.nodes.size(); ++k) {
      Index32 const o = graph_.representative[out_.nodes[k]], own = carrier_[o];
      out_.graph.representative.push_back(own);
      ends.clear();
      if (own == Index32(k))
        for (Index32 const end : graph_.neighbours[o])
          if (Index32 const e = carrier_[end]; e >= 0) ends.push_back(e);
      std::sort(ends.begin(), ends.end());
      out_.graph.neighbours.add(ends);
    }
  }

  void take_boundary() {
    BoundaryConditions& to = out_.boundary;
    to.motion = boundary_.motion;
    to.rotations = boundary_.rotations;
    to.driving_patches = boundary_.driving_patches;
    to.sliding_patches = boundary_.sliding_patches;
    to.standing_patches = boundary_.standing_patches;
    std::vector<std::pair<Index32, Index32>> order;  // nodes of the part, slots or places in a list
    auto const gather = [&](std::vector<Index32> const& nodes) {
      order.clear();
      for (std::size_t k = 0; k < nodes.size(); ++k)
        if (Index32 const n = carrier_[nodes[k]]; n >= 0) order.emplace_back(n, Index32(k));
      std::sort(order.begin(), order.end());
    };
    gather(boundary_.known);
    std::vector<Index32> slot(boundary_.known.size(), -1);
    // A node at a cut drives the parts on those sides of it that have a moving wall there.
    std::vector<std::uint8_t> drives(out_.nodes.size(), 0);
    for (int const p : to.driving_patches)
      for (Index32 const n : patch_nodes(out_.mesh.patches[p])) drives[out_.graph.representative[n]] = 1;
    for (auto const& [n, s] : order) {
      slot[s] = Index32(to.known.size());
      to.known.push_back(n);
      to.drives.push_back(boundary_.drives[s] != 0 && drives[n] != 0 ? 1 : 0);
      out_.slots.push_back(s);
    }
    to.requests.n_boundary_nodes = Index(to.known.size());
    to.requests.defaults_yield = boundary_.requests.defaults_yield;
    for (auto request : boundary_.requests.requests) {
      if (slot[request.boundary_node] < 0) continue;
      request.boundary_node = slot[request.boundary_node];
      request.node = to.known[request.boundary_node];
      to.requests.requests.push_back(request);
    }
    gather(boundary_.slip_nodes);
    for (auto const& [n, k] : order) {
      to.slip_nodes.push_back(n);
      to.slip_surfaces.add(boundary_.slip_surfaces[k]);
    }
    take_joint_slip();
    for (PeriodicImage const& image : boundary_.images) {
      Index32 const n = carrier_[image.node], o = carrier_[image.owner];
      if (n >= 0 && o >= 0) to.images.push_back({n, o, image.rotation});
    }
    std::sort(to.images.begin(), to.images.end(),
              [](PeriodicImage const& a, PeriodicImage const& b) { return a.node < b.node; });
  }

  /// Displacements that are given are put back before they come to parts.
  void take_joint_slip() {
    JointSlip const& from = boundary_.joint_slip;
    JointSlip& to = out_.boundary.joint_slip;
    out_.boundary.across_axes = boundary_.across_axes;
    for (std::size_t k = 0; k < from.of.size(); ++k) {
      Index32 const n = carrier_[from.of[k]];
      if (n < 0) continue;
      to.of.push_back(n);
      for (Index s = from.first[k]; s < from.first[k + 1]; ++s) {
        Index32 const at = from.place[s];
        to.surface.push_back(from.surface[s]);
        to.place.push_back(has(at) ? place(at) : carrier_[graph_.representative[at]]);
        to.turned.push_back(from.turned[s]);
      }
      to.first.push_back(Index(to.surface.size()));
    }
  }

  Mesh const& mesh_;
  NodeGraph const& graph_;
  BoundaryConditions const& boundary_;
  std::vector<std::uint8_t> const& of_part_;
  std::vector<Index32> place_;  ///< of the mesh's nodes in the part, -1: not in it
  std::vector<Index32>
      carrier_;  ///< of the mesh's carrying nodes: who carries their displacement in the part, -1: nobody
  MeshPart out_;
};

}  // namespace

MeshPart mesh_part(HostInstance const& host, Mesh const& mesh, NodeGraph const& graph,
                   BoundaryConditions const& boundary, std::vector<std::uint8_t> const& of_part) {
  return PartTaker(mesh, graph, boundary, of_part).run(host);
}

}  // namespace gridmorph::detail
