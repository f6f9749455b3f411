#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/kernels/box_tree.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace gridmorph {

std::string_view to_string(ElementType type) {
  switch (type) {
    case ElementType::triangle: return "triangle";
    case ElementType::quadrilateral: return "quadrilateral";
    case ElementType::tetrahedron: return "tetrahedron";
    case ElementType::pyramid: return "pyramid";
    case ElementType::prism: return "prism";
    case ElementType::hexahedron: return "hexahedron";
    case ElementType::polyhedron: return "polyhedron";
  }
  return "element";
}

namespace {

std::size_t place_of_polyhedron(Mesh const& mesh, Index element) {
  auto const& list = mesh.polyhedra.element;
  return std::size_t(std::lower_bound(list.begin(), list.end(), Index32(element)) - list.begin());
}

}  // namespace

int n_sides(Mesh const& mesh, Index element) {
  ElementType const type = mesh.elements.type[element];
  if (type != ElementType::polyhedron) return n_faces(type);
  std::size_t const p = place_of_polyhedron(mesh, element);
  return int(mesh.polyhedra.first_face[p + 1] - mesh.polyhedra.first_face[p]);
}

std::span<Index32 const> side_nodes(Mesh const& mesh, Index element, int side,
                                    std::array<Index32, max_face_corners>& room) {
  ElementType const type = mesh.elements.type[element];
  if (type == ElementType::polyhedron)
    return mesh.polyhedra.faces[mesh.polyhedra.first_face[place_of_polyhedron(mesh, element)] + side];
  Index32 const* const node = mesh.elements.nodes.item.data() + mesh.elements.nodes.first[element];
  int const n = n_face_corners(type, side);
  std::size_t kept = 0;
  for (int c = 0; c < n; ++c) {
    Index32 const corner = node[face_corner(type, side, c)];
    if (std::find(room.begin(), room.begin() + kept, corner) == room.begin() + kept) room[kept++] = corner;
  }
  return {room.data(), kept};
}

std::vector<MiddleNode> side_middle_nodes(Mesh const& mesh, Index element, int side) {
  std::vector<MiddleNode> out;
  ElementType const type = mesh.elements.type[element];
  auto const nodes = mesh.elements.nodes[element];
  int const corners = int(mesh.elements.corners(element).size());
  if (type == ElementType::polyhedron || int(nodes.size()) == corners) return out;
  auto const on_side = [&](int corner) {
    for (int c = 0; c < n_face_corners(type, side); ++c)
      if (face_corner(type, side, c) == corner) return true;
    return false;
  };
  auto const take = [&](int place, std::vector<Index32> amid) {
    if (std::size_t(place) >= nodes.size()) return;
    std::sort(amid.begin(), amid.end());
    out.push_back({nodes[place], std::move(amid)});
  };
  auto const corner = [&](int c) { return nodes[c]; };
  for (int e = 0; e < n_edges(type); ++e)
    if (on_side(edge_corner(type, e, 0)) && on_side(edge_corner(type, e, 1)))
      take(corners + e, {corner(edge_corner(type, e, 0)), corner(edge_corner(type, e, 1))});
  if (is_surface(type) || n_face_corners(type, side) != 4) return out;
  int squares_before = 0;
  for (int f = 0; f < side; ++f) squares_before += n_face_corners(type, f) == 4 ? 1 : 0;
  std::array<Index32, max_face_corners> room{};
  auto const all = side_nodes(mesh, element, side, room);
  take(corners + n_edges(type) + squares_before, {all.begin(), all.end()});
  return out;
}

Vec3 face_normal(std::span<Index32 const> nodes, Coordinates const& coordinates) {
  auto const arm = [&](std::size_t k) { return coordinates[nodes[k]] - coordinates[nodes[0]]; };
  Vec3 sum;
  for (std::size_t k = 1; k + 1 < nodes.size(); ++k) sum += cross(arm(k), arm(k + 1));
  return sum;
}

std::vector<Index32> patch_nodes(Patch const& patch) {
  std::vector<Index32> nodes = patch.faces.size() > 0 ? patch.faces.item : patch.nodes;
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::array<Index, n_element_types> count_types(Mesh const& mesh, int zone) {
  std::array<Index, n_element_types> count{};
  Index const begin = zone < 0 ? 0 : mesh.zones[zone].first_element;
  Index const end = zone < 0 ? mesh.n_elements() : begin + mesh.zones[zone].n_elements;
  for (Index e = begin; e < end; ++e) ++count[std::size_t(mesh.elements.type[e])];
  return count;
}

Index node_number_in_file(BoundaryMesh const& mesh, Index node) {
  auto const& order = mesh.file_order.node;
  Index const place = order.empty() ? node : order[node];
  return place - mesh.zones[mesh.zone_of(node)].first_node + mesh.first_number;
}

Index number_in_file(Mesh const& mesh, Index element) {
  if (!mesh.elements.number.empty()) return mesh.elements.number[element];
  auto const& order = mesh.file_order.element;
  Index const place = order.empty() ? element : order[element];
  return place - mesh.zones[mesh.zone_of_element(element)].first_element + mesh.first_number;
}

std::string describe_element(Mesh const& mesh, Index element) {
  auto const& zone = mesh.zones[mesh.zone_of_element(element)];
  if (zone.is_block()) {
    Index const ni = std::max(zone.extent[0] - 1, 1), nj = std::max(zone.extent[1] - 1, 1);
    Index const cell = element - zone.first_element;
    return "zone '" + zone.name + "' cell (i " + std::to_string(cell % ni + 1) + ", j " +
           std::to_string(cell / ni % nj + 1) + ", k " + std::to_string(cell / (ni * nj) + 1) + ")";
  }
  return "zone '" + zone.name + "' " + std::string(to_string(mesh.elements.type[element])) + " " +
         std::to_string(number_in_file(mesh, element));
}

namespace {

class MeshCheck {
 public:
  explicit MeshCheck(Mesh const& mesh) : mesh_(mesh) {}

  void run() {
    sizes();
    if (problems_.empty()) {
      elements();
      if (problems_.empty()) polyhedra();
      patches();
      connections();
    }
    problems_.throw_if_any<MeshError>();
  }

 private:
  void sizes() {
    constexpr Index most = std::numeric_limits<Index32>::max();
    auto const& e = mesh_.elements;
    Index nodes = 0, elements = 0;
    for (auto const& zone : mesh_.zones) {
      if (zone.size() < 0 || zone.n_elements < 0 || zone.first_node != nodes || zone.first_element != elements)
        problems_.add("zone '" + zone.name + "': its nodes and elements do not follow those of the zone before it");
      nodes = zone.first_node + zone.size();
      elements = zone.first_element + zone.n_elements;
    }
    if (nodes > most || elements > most)
      problems_.add("mesh '" + mesh_.source + "': has " + std::to_string(nodes) + " nodes and " +
                    std::to_string(elements) + " elements; at most " + std::to_string(most) + " can be handled");
    if (elements != e.size() || e.nodes.size() != e.size() || (!e.number.empty() && Index(e.number.size()) != e.size()))
      problems_.add("mesh '" + mesh_.source + "': has " + std::to_string(e.size()) + " element types and " +
                    std::to_string(e.nodes.size()) + " node lists for the " + std::to_string(elements) +
                    " elements of its zones");
    if (mesh_.coordinates.size() != 0 && mesh_.coordinates.size() != nodes)
      problems_.add("mesh '" + mesh_.source + "': has " + std::to_string(mesh_.coordinates.size()) +
                    " coordinates for " + std::to_string(nodes) + " nodes");
    for (Index n = 0; n < mesh_.coordinates.size() && problems_.empty(); ++n)
      if (!is_usable(mesh_.coordinates[n]))
        problems_.add("mesh '" + mesh_.source + "': " + describe_node(mesh_, n) + " is at " +
                      to_text(mesh_.coordinates[n], 9) + ", which cannot be computed with");
  }

  [[nodiscard]] bool inside(Zone const& zone, std::span<Index32 const> nodes) const {
    return std::all_of(nodes.begin(), nodes.end(),
                       [&](Index32 n) { return n >= zone.first_node && n < zone.first_node + zone.size(); });
  }

  void elements() {
    for (auto const& zone : mesh_.zones) {
      Index bad = 0, first = -1;
      for (Index e = zone.first_element; e < zone.first_element + zone.n_elements; ++e) {
        auto const nodes = mesh_.elements.nodes[e];
        ElementType const type = mesh_.elements.type[e];
        bool const fits = (type == ElementType::polyhedron || int(nodes.size()) >= n_corners(type)) &&
                          (mesh_.dimension == 2) == is_surface(type) && inside(zone, nodes);
        if (!fits && bad++ == 0) first = e;
      }
      if (bad > 0)
        problems_.add(mesh_.source + ": " + std::to_string(bad) +
                      " elements name nodes outside their zone or are of the wrong kind, the first is " +
                      describe_element(mesh_, first) + "; zone '" + zone.name + "' has " + std::to_string(zone.size()) +
                      " nodes");
    }
  }

  /// Checks that every polyhedron is one closed surface. Where a face is missing there is no volume to measure; of a
  /// second shell, a void in the cell or a part beside it, nobody knows which side is inside.
  void polyhedra() {
    auto const& p = mesh_.polyhedra;
    Index open = 0, parted = 0, first_open = -1, first_parted = -1;
    std::vector<Index32> nodes;
    for (std::size_t k = 0; k < p.element.size(); ++k) {
      if (is_open(k) && open++ == 0) first_open = p.element[k];
      if (n_shells(k, nodes) > 1 && parted++ == 0) first_parted = p.element[k];
    }
    auto const add = [&](Index count, Index first, char const* what, char const* advice) {
      if (count > 0)
        problems_.add(mesh_.source + ": " + std::to_string(count) + " polyhedra " + what + ", the first is " +
                      describe_element(mesh_, first) + "; " + advice);
    };
    add(open, first_open, "do not close",
        "a face of theirs is missing or belongs to another cell; write the mesh again");
    add(parted, first_parted, "have faces that make more than one closed surface",
        "cells with voids or of separate parts cannot be measured; split them in the mesh generator");
  }

  /// Edges that an odd number of faces have lie on a hole, unless nodes of smaller neighbours lie on them: then the
  /// area vectors close.
  [[nodiscard]] bool is_open(std::size_t polyhedron) const {
    auto const& p = mesh_.polyhedra;
    std::uint64_t odd = 0;
    for (Index f = p.first_face[polyhedron]; f < p.first_face[polyhedron + 1]; ++f) {
      auto const face = p.faces[f];
      for (std::size_t c = 0; c < face.size(); ++c) {
        auto const [a, b] = std::minmax(face[c], face[(c + 1) % face.size()]);
        std::uint64_t h = (std::uint64_t(a) << 32 | std::uint64_t(b)) * 0x9e3779b97f4a7c15ull;
        h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ull;
        odd ^= h ^ (h >> 29);  // what comes twice cancels
      }
    }
    if (odd == 0 || mesh_.coordinates.size() == 0) return odd != 0;
    constexpr double rounding = 1e-6;
    Vec3 sum;
    double areas = 0;
    for (Index f = p.first_face[polyhedron]; f < p.first_face[polyhedron + 1]; ++f) {
      auto const face = p.faces[f];
      Vec3 const origin = mesh_.coordinates[face[0]];
      Vec3 area;
      for (std::size_t c = 2; c < face.size(); ++c)
        area += 0.5 * cross(mesh_.coordinates[face[c - 1]] - origin, mesh_.coordinates[face[c]] - origin);
      sum += area;
      areas += norm(area);
    }
    return norm(sum) > rounding * areas;
  }

  /// Groups of faces that share no node with one another. `nodes`: room.
  [[nodiscard]] int n_shells(std::size_t polyhedron, std::vector<Index32>& nodes) const {
    auto const& p = mesh_.polyhedra;
    auto const all = mesh_.elements.nodes[p.element[polyhedron]];
    nodes.assign(all.begin(), all.end());
    std::sort(nodes.begin(), nodes.end());
    DisjointSets<Index32> groups(nodes.size());
    int shells = int(nodes.size());
    for (Index f = p.first_face[polyhedron]; f < p.first_face[polyhedron + 1]; ++f) {
      Index32 before = -1;
      for (Index32 const node : p.faces[f]) {
        auto const at = std::lower_bound(nodes.begin(), nodes.end(), node);
        if (at == nodes.end() || *at != node) continue;
        auto const own = Index32(at - nodes.begin());
        if (before >= 0 && groups.root(before) != groups.root(own)) {
          groups.join(before, own);
          --shells;
        }
        before = own;
      }
    }
    return shells;
  }

  void patches() {
    for (auto const& patch : mesh_.patches) {
      if (patch.zone < 0 || patch.zone >= int(mesh_.zones.size())) {
        problems_.add(mesh_.source + ": patch '" + patch.name + "' lies in no zone");
        continue;
      }
      auto const& zone = mesh_.zones[patch.zone];
      if (!inside(zone, patch.nodes) || !inside(zone, patch.faces.item))
        problems_.add(mesh_.source + ": patch " + describe_patch(mesh_, patch) +
                      " names nodes outside its zone, which has " + std::to_string(zone.size()) + " nodes");
    }
  }

  void connections() {
    for (auto const& c : mesh_.connections) {
      bool const zones = c.zone >= 0 && c.zone < int(mesh_.zones.size()) && c.donor_zone >= 0 &&
                         c.donor_zone < int(mesh_.zones.size());
      if (!zones || c.nodes.size() != c.donor_nodes.size() || !inside(mesh_.zones[c.zone], c.nodes) ||
          !inside(mesh_.zones[c.donor_zone], c.donor_nodes))
        problems_.add(mesh_.source + ": connection '" + c.name +
                      "' does not pair nodes of its zone with as many of its donor zone");
    }
  }

  Mesh const& mesh_;
  Problems problems_;
};

}  // namespace

void check_mesh(Mesh const& mesh) { MeshCheck(mesh).run(); }

Vec3 plane_normal(Mesh const& mesh) {
  Vec3 const up{0, 0, 1};
  if (mesh.dimension == 3 || mesh.coordinates.size() == 0) return up;
  kernels::Box box;
  for (Index n = 0; n < mesh.coordinates.size(); ++n) box.include(mesh.coordinates[n]);
  double const flat = 1e-9 * distance(box.low, box.high);
  Vec3 const size = box.high - box.low;
  if (size.z <= flat) return up;
  if (size.y <= flat) return {0, 1, 0};
  if (size.x <= flat) return {1, 0, 0};
  Vec3 sum;
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    auto const n = mesh.elements.corners(e);
    Vec3 const origin = mesh.coordinates[n[0]];
    for (std::size_t k = 2; k < n.size(); ++k)
      sum += cross(mesh.coordinates[n[k - 1]] - origin, mesh.coordinates[n[k]] - origin);
  }
  double const length = norm(sum);
  return length > 0 ? (1 / length) * sum : up;
}

}  // namespace gridmorph
