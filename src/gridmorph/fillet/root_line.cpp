#include <gridmorph/fillet/mitre_path.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/geometry/unit.hpp>
#include <gridmorph/mesh/undeclared_connections.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace gridmorph {

namespace {

std::uint64_t key(Index32 a, Index32 b) {
  auto const [low, high] = std::minmax(a, b);
  return (std::uint64_t(low) << 32) | std::uint64_t(high);
}

/// The element along a root edge where that is the only one; -1: two or more share the angle between the walls.
Index32 only_element(JoinedElements const& elements, std::array<Index32, 2> const& edge) {
  auto const around = elements.with(edge);
  return around.size() == 1 ? around.front() : -1;
}

/// Whether two elements have a face of four corners in common.
bool share_quadrilateral(JoinedElements const& elements, Index32 a, Index32 b) {
  int common = 0;
  for (Index32 const n : elements.mesh().elements.corners(a)) common += elements.has(b, elements.place(n)) ? 1 : 0;
  return common == 4;
}

/// The normal of a face into the mesh, as long as the face's area, whichever way its element is numbered.
Vec3 inward_normal(Mesh const& mesh, std::span<Index32 const> nodes, Index32 element) {
  Vec3 middle, centre, normal;
  for (Index32 const n : nodes) middle += (1 / double(nodes.size())) * mesh.coordinates[n];
  for (std::size_t k = 0; k < nodes.size(); ++k)
    normal +=
        0.5 * cross(mesh.coordinates[nodes[k]] - middle, mesh.coordinates[nodes[(k + 1) % nodes.size()]] - middle);
  auto const corners = mesh.elements.corners(element);
  for (Index32 const n : corners) centre += (1 / double(corners.size())) * mesh.coordinates[n];
  return dot(normal, centre - middle) < 0 ? -normal : normal;
}

/// Faces of the walls along a root edge are those of prisms and hexahedra: nothing else has layers that could be bent
/// around an arc.
void require_layers(JoinedElements const& elements, WallEdges const& edges, std::array<Index32, 2> const& edge) {
  Mesh const& mesh = elements.mesh();
  BoundaryFaces const& faces = elements.topology().boundary;
  for (Index32 const node : elements.nodes_at(edge[0]))
    for (Index32 const f : elements.topology().faces_of_nodes[node]) {
      int const wall = edges.wall_of_face(f);
      Index32 const e = faces.element[f];
      if (wall < 0 || !elements.has(e, edge[1])) continue;
      ElementType const type = mesh.elements.type[e];
      if (type == ElementType::prism || type == ElementType::hexahedron) continue;
      throw MeshError(
          mesh.source + ": " + describe_element(mesh, e) + " has a face on the " + (wall == 0 ? "blade" : "end wall") +
          " beside the corner and is neither a prism nor a hexahedron; a fillet needs layers of these along both "
          "walls that meet in the corner");
    }
}

}  // namespace

JoinedElements::JoinedElements(Mesh const& mesh, UnstructuredTopology const& topology)
    : mesh_(mesh), topology_(topology), place_(nodes_at_one_place(mesh)) {
  for (std::size_t n = 0; n < place_.size(); ++n)
    if (place_[n] != Index32(n)) further_[place_[n]].push_back(Index32(n));
}

std::vector<Index32> JoinedElements::nodes_at(Index32 place) const {
  std::vector<Index32> out{place};
  if (auto const found = further_.find(place); found != further_.end())
    out.insert(out.end(), found->second.begin(), found->second.end());
  return out;
}

std::vector<Index32> JoinedElements::around(Index32 place) const {
  std::vector<Index32> out;
  for (Index32 const n : nodes_at(place)) {
    auto const here = topology_.elements_of_nodes[n];
    out.insert(out.end(), here.begin(), here.end());
  }
  return out;
}

std::vector<Index32> JoinedElements::with(std::span<Index32 const> places) const {
  std::vector<Index32> out = around(places.front());
  std::erase_if(out, [&](Index32 e) {
    return !std::all_of(places.begin() + 1, places.end(), [&](Index32 p) { return has(e, p); });
  });
  return out;
}

bool JoinedElements::has(Index32 element, Index32 place) const { return node_at(element, place) >= 0; }

Index32 JoinedElements::node_at(Index32 element, Index32 place) const {
  for (Index32 const n : mesh_.elements.corners(element))
    if (place_[n] == place) return n;
  return -1;
}

WallEdges::WallEdges(JoinedElements const& elements, BoundaryFacePatches const& face_patches,
                     std::span<int const> blade, std::span<int const> end_wall) {
  BoundaryFaces const& faces = elements.topology().boundary;
  wall_.assign(faces.size(), -1);
  for (Index f = 0; f < faces.size(); ++f) {
    int const patch = face_patches.patch[f];
    bool const of_blade = std::find(blade.begin(), blade.end(), patch) != blade.end();
    bool const of_end_wall = std::find(end_wall.begin(), end_wall.end(), patch) != end_wall.end();
    if (patch < 0 || of_blade == of_end_wall) continue;
    wall_[f] = of_blade ? 0 : 1;
    auto const nodes = faces.nodes[f];
    Vec3 const normal = inward_normal(elements.mesh(), nodes, faces.element[f]);
    for (Index32 const n : nodes) normals_[of_blade ? 0 : 1][elements.place(n)] += normal;
    for (std::size_t k = 0; k < nodes.size(); ++k)
      edges_[key(elements.place(nodes[k]), elements.place(nodes[(k + 1) % nodes.size()]))] |= of_blade ? 1 : 2;
  }
}

Vec3 WallEdges::normal(int wall, Index32 place) const {
  auto const found = normals_[wall].find(place);
  return found == normals_[wall].end() ? Vec3{} : unit(found->second);
}

int WallEdges::walls_of(Index32 a, Index32 b) const {
  auto const found = edges_.find(key(a, b));
  return found == edges_.end() ? 0 : found->second;
}

std::vector<std::array<Index32, 2>> WallEdges::common() const {
  std::vector<std::array<Index32, 2>> out;
  for (auto const& [edge, walls] : edges_)
    if (walls == 3) out.push_back({Index32(edge >> 32), Index32(edge & 0xffffffffU)});
  std::sort(out.begin(), out.end());
  return out;
}

bool is_foreign(JoinedElements const& elements, WallEdges const& edges, Index face) {
  if (edges.wall_of_face(Index32(face)) >= 0) return false;
  int const c = elements.topology().boundary.connection[face];
  return c < 0 || elements.mesh().connections[c / 2].periodic.has_value();
}

std::vector<Index32> faces_across_end(JoinedElements const& elements, WallEdges const& edges, RootLine const& line,
                                      int end) {
  constexpr double across = 0.7;  // cosine: elements along the last edge may have faces beside it too
  std::size_t const n = line.places.size();
  Index32 const place = end == 0 ? line.places[0] : line.places[n - 1];
  Index32 const before = end == 0 ? line.places[1] : line.places[n - 2];
  Vec3 const along = unit(elements.position(place) - elements.position(before));
  auto const last = elements.with(std::array{place, before});
  BoundaryFaces const& faces = elements.topology().boundary;
  std::vector<Index32> out;
  for (Index32 const node : elements.nodes_at(place))
    for (Index32 const f : elements.topology().faces_of_nodes[node]) {
      Index32 const element = faces.element[f];
      if (!is_foreign(elements, edges, f) || std::find(last.begin(), last.end(), element) == last.end()) continue;
      Vec3 const normal = inward_normal(elements.mesh(), faces.nodes[f], element);
      if (std::abs(dot(normal, along)) > across * norm(normal)) out.push_back(f);
    }
  return out;
}

std::vector<RootLine> find_root_lines(JoinedElements const& elements, WallEdges const& edges) {
  Mesh const& mesh = elements.mesh();
  auto const common = edges.common();
  if (common.empty())
    throw MeshError(
        mesh.source +
        ": no face of the blade has an edge in common with one of the end wall, so there is no corner to fill; "
        "check --blade and --wall with `gridmorph inspect`");
  std::map<Index32, std::vector<std::size_t>> at;  // edges at a place
  std::vector<Index32> only(common.size());
  for (std::size_t k = 0; k < common.size(); ++k) {
    for (Index32 const p : common[k]) at[p].push_back(k);
    only[k] = only_element(elements, common[k]);
    if (only[k] >= 0 && mesh.elements.type[only[k]] != ElementType::hexahedron)
      throw MeshError(
          mesh.source + ": " + describe_element(mesh, only[k]) +
          " has a face on the blade and one on the end wall and is no hexahedron, so it would be flat where a "
          "fillet makes one wall of both; give both walls layers of prisms that meet in the corner, or hexahedra");
  }
  for (auto const& edge : common) require_layers(elements, edges, edge);
  auto const goes_on = [&](Index32 place) {
    auto const& here = at[place];
    if (here.size() != 2) return false;
    Index32 const a = only[here[0]], b = only[here[1]];
    return (a < 0) == (b < 0) && (a < 0 || share_quadrilateral(elements, a, b));
  };
  std::vector<RootLine> out;
  std::set<std::size_t> left;
  for (std::size_t k = 0; k < common.size(); ++k) left.insert(k);
  auto const follow = [&](Index32 start, std::size_t edge) {
    RootLine line{{start}, false, only[edge] >= 0};
    for (;;) {
      left.erase(edge);
      Index32 const next = common[edge][0] == line.places.back() ? common[edge][1] : common[edge][0];
      if (next == start && goes_on(next)) {
        line.closed = true;
        break;
      }
      line.places.push_back(next);
      if (!goes_on(next)) break;
      auto const& here = at[next];
      edge = here[0] == edge ? here[1] : here[0];
    }
    out.push_back(std::move(line));
  };
  for (auto const& [place, here] : at)
    if (!goes_on(place))
      for (std::size_t const edge : here)
        if (left.contains(edge)) follow(place, edge);
  while (!left.empty()) {
    std::size_t const edge = *left.begin();
    follow(common[edge][0], edge);
  }
  return out;
}

}  // namespace gridmorph
