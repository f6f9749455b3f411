// Which patch each boundary face of an unstructured mesh belongs to.
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <algorithm>
#include <numeric>

namespace gridmorph {

namespace {

class FacePatchFinder {
 public:
  FacePatchFinder(Mesh const& mesh, UnstructuredTopology const& topology) : mesh_(mesh), topology_(topology) {
    out_.patch.assign(topology.boundary.size(), BoundaryFacePatches::open);
    out_.faces_of_patch.assign(mesh.patches.size(), 0);
  }

  BoundaryFacePatches run() {
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p) listed_faces(int(p));
    other_sides();
    listed_nodes();
    connections();
    count();
    open_faces();
    return std::move(out_);
  }

 private:
  void listed_faces(int p) {
    auto const& patch = mesh_.patches[p];
    Index inside = 0, twice = 0;
    int other = -1;
    for (Index f = 0; f < patch.faces.size(); ++f) {
      Index32 face = find_boundary_face(topology_, patch.faces[f]);
      if (face < 0) {
        ++inside;
        continue;
      }
      if (is_inner(face)) face = side_listed(face, patch.faces[f]);
      int& patch_of_face = out_.patch[face];
      if (patch_of_face >= 0 && patch_of_face != p && twice++ == 0) other = patch_of_face;
      if (patch_of_face < 0) patch_of_face = p;
    }
    if (inside > 0)
      out_.notes.push_back("patch " + describe_patch(mesh_, patch) + ": " + std::to_string(inside) + " of its " +
                           std::to_string(patch.faces.size()) + " faces are not on the boundary of the elements");
    if (twice > 0)
      out_.problems.push_back("patch " + describe_patch(mesh_, patch) + ": " + std::to_string(twice) +
                              " of its faces belong to patch " + describe_patch(mesh_, mesh_.patches[other]) + " too");
  }

  [[nodiscard]] bool is_inner(Index32 face) const {
    auto const& behind = topology_.boundary.behind;
    return !behind.empty() && behind[face] >= 0;
  }

  /// The side of a face inside the mesh whose nodes run as they are listed, unless a patch has it and none the other.
  [[nodiscard]] Index32 side_listed(Index32 face, std::span<Index32 const> listed) const {
    Index32 const other = topology_.boundary.behind[face];
    auto const nodes = topology_.boundary.nodes[face];
    auto const at = std::find(nodes.begin(), nodes.end(), listed[0]) - nodes.begin();
    bool const same_way = nodes[std::size_t(at + 1) % nodes.size()] == listed[1];
    Index32 const first = same_way ? face : other, second = same_way ? other : face;
    auto const taken = [&](Index32 f) { return out_.patch[f] >= 0; };
    return taken(first) && !taken(second) ? second : first;
  }

  /// Gives both sides of faces inside the mesh that are listed once to the patch.
  void other_sides() {
    for (std::size_t f = 0; f < topology_.boundary.behind.size(); ++f) {
      Index32 const other = topology_.boundary.behind[f];
      if (other >= 0 && out_.patch[f] == BoundaryFacePatches::open) out_.patch[f] = out_.patch[other];
    }
  }

  void listed_nodes() {
    std::vector<int> order;
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p)
      if (mesh_.patches[p].faces.size() == 0) order.push_back(int(p));
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return mesh_.patches[a].nodes.size() < mesh_.patches[b].nodes.size(); });
    std::vector<char> listed(mesh_.n_nodes(), 0);
    for (int const p : order) {
      auto const& nodes = mesh_.patches[p].nodes;
      for (Index32 const n : nodes) listed[n] = 1;
      each_face_of(nodes, listed, [&](int& patch_of_face) {
        if (patch_of_face == BoundaryFacePatches::open) patch_of_face = p;
      });
      for (Index32 const n : nodes) listed[n] = 0;
    }
  }

  void connections() {
    std::vector<char> listed(mesh_.n_nodes(), 0);
    for (auto const& c : mesh_.connections)
      for (auto const* nodes : {&c.nodes, &c.donor_nodes}) {
        for (Index32 const n : *nodes) listed[n] = 1;
        each_face_of(*nodes, listed, [&](int& patch_of_face) {
          if (patch_of_face == BoundaryFacePatches::open) patch_of_face = BoundaryFacePatches::connection;
        });
        for (Index32 const n : *nodes) listed[n] = 0;
      }
  }

  template <class Function>
  void each_face_of(std::vector<Index32> const& nodes, std::vector<char> const& listed, Function const& f) {
    for (Index32 const node : nodes)
      for (Index32 const face : topology_.faces_of_nodes[node]) {
        auto const corners = topology_.boundary.nodes[face];
        if (std::all_of(corners.begin(), corners.end(), [&](Index32 n) { return listed[n] != 0; })) f(out_.patch[face]);
      }
  }

  void count() {
    for (int const p : out_.patch)
      if (p >= 0) ++out_.faces_of_patch[p];
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p)
      if (out_.faces_of_patch[p] == 0)
        out_.notes.push_back("patch " + describe_patch(mesh_, mesh_.patches[p]) +
                             ": has no face on the boundary of the elements");
  }

  void open_faces() {
    for (auto const& zone : mesh_.zones) {
      Index open = 0, first = -1;
      for (Index f = 0; f < topology_.boundary.size(); ++f) {
        Index const element = topology_.boundary.element[f];
        if (out_.patch[f] != BoundaryFacePatches::open || element < zone.first_element ||
            element >= zone.first_element + zone.n_elements)
          continue;
        if (open++ == 0) first = f;
      }
      if (open == 0) continue;
      std::string nodes;
      for (Index32 const n : topology_.boundary.nodes[first])
        nodes += (nodes.empty() ? "" : ", ") + std::to_string(node_number_in_file(mesh_, n));
      out_.problems.push_back(mesh_.source + ": zone '" + zone.name + "': " + std::to_string(open) +
                              (open == 1 ? " boundary face belongs" : " boundary faces belong") +
                              " to no patch and no connection, the first is that of " +
                              describe_element(mesh_, topology_.boundary.element[first]) + " with nodes " + nodes);
    }
    if (topology_.crowded_sides > 0)
      out_.problems.push_back(mesh_.source + ": " + std::to_string(topology_.crowded_sides) +
                              " sides of elements are shared by more than two elements; elements overlap");
  }

  Mesh const& mesh_;
  UnstructuredTopology const& topology_;
  BoundaryFacePatches out_;
};

}  // namespace

BoundaryFacePatches find_face_patches(Mesh const& mesh, UnstructuredTopology const& topology) {
  return FacePatchFinder(mesh, topology).run();
}

}  // namespace gridmorph
