#include "support/made_bodies.hpp"

#include "support/unstructured_meshes.hpp"

#include <gridmorph/mesh/unstructured_topology.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

namespace gridmorph::test {
namespace {

Vec3 centre_of(Mesh const& mesh, Index e) {
  Vec3 sum;
  auto const corners = mesh.elements.corners(e);
  for (Index32 const n : corners) sum += mesh.coordinates[n];
  return (1.0 / double(corners.size())) * sum;
}

/// Elements of one zone after another with nodes of their own; `number` of a zone: old node -> new one, -1 where it has
/// none.
class Copier {
 public:
  explicit Copier(Mesh const& from) : from_(from) {
    out.dimension = from.dimension;
    out.source = from.source;
    out.families = from.families;
  }

  void add_zone(std::string const& name, std::vector<Index> const& elements) {
    auto& number = numbers.emplace_back(std::size_t(from_.n_nodes()), -1);
    for (Index const e : elements)
      for (Index32 const n : from_.elements.nodes[e]) number[n] = 0;
    Index32 next = Index32(points_.size());
    Index32 const first = next;
    for (std::size_t n = 0; n < number.size(); ++n)
      if (number[n] == 0) {
        number[n] = next++;
        points_.push_back(from_.coordinates[Index(n)]);
      }
    out.add_zone(name, next - first);
    for (Index const e : elements) {
      std::vector<Index32> nodes;
      for (Index32 const n : from_.elements.nodes[e]) nodes.push_back(number[n]);
      out.add_element(from_.elements.type[e], nodes);
    }
    for (auto const& patch : from_.patches) {
      Patch mine = patch;
      mine.zone = int(out.zones.size()) - 1;
      mine.faces = {};
      for (Index f = 0; f < patch.faces.size(); ++f) {
        std::vector<Index32> face;
        for (Index32 const n : patch.faces[f])
          if (number[n] >= 0) face.push_back(number[n]);
        if (face.size() == patch.faces[f].size()) mine.faces.add(face);
      }
      if (mine.faces.size() > 0) out.patches.push_back(std::move(mine));
    }
  }

  Mesh finish() {
    out.coordinates = Coordinates(Index(points_.size()));
    for (std::size_t n = 0; n < points_.size(); ++n) out.coordinates.set(Index(n), points_[n]);
    return std::move(out);
  }

  Mesh out;
  std::vector<std::vector<Index32>> numbers;

 private:
  Mesh const& from_;
  std::vector<Vec3> points_;
};

}  // namespace

Mesh part_of(Mesh const& mesh, std::function<bool(Vec3 const&)> const& keep, std::string const& cut, PatchKind kind) {
  std::vector<Index> elements;
  for (Index e = 0; e < mesh.n_elements(); ++e)
    if (keep(centre_of(mesh, e))) elements.push_back(e);
  Copier copier(mesh);
  copier.add_zone("zone", elements);
  Mesh out = copier.finish();
  auto const topology = make_topology(out);
  auto const face_patches = find_face_patches(out, topology);
  Patch patch;
  patch.name = cut;
  patch.kind = kind;
  patch.bc_type = kind == PatchKind::wall ? "BCWall" : kind == PatchKind::symmetry ? "BCSymmetryPlane" : "BCFarfield";
  patch.zone = 0;
  for (Index f = 0; f < topology.boundary.size(); ++f)
    if (face_patches.patch[f] < 0) patch.faces.add(topology.boundary.nodes[f]);
  if (patch.faces.size() > 0) out.patches.push_back(std::move(patch));
  return out;
}

Mesh in_two_zones(Mesh const& mesh, std::function<bool(Vec3 const&)> const& first) {
  std::array<std::vector<Index>, 2> elements;
  for (Index e = 0; e < mesh.n_elements(); ++e) elements[first(centre_of(mesh, e)) ? 0 : 1].push_back(e);
  Copier copier(mesh);
  copier.add_zone("first", elements[0]);
  copier.add_zone("second", elements[1]);
  Mesh out = copier.finish();
  for (int const zone : {0, 1}) {
    Connection connection;
    connection.name = zone == 0 ? "to second" : "to first";
    connection.zone = zone;
    connection.donor_zone = 1 - zone;
    for (std::size_t n = 0; n < copier.numbers[0].size(); ++n) {
      Index32 const a = copier.numbers[zone][n], b = copier.numbers[1 - zone][n];
      if (a < 0 || b < 0) continue;
      connection.nodes.push_back(a);
      connection.donor_nodes.push_back(b);
    }
    out.connections.push_back(std::move(connection));
  }
  return out;
}

Mesh second_order(Mesh const& mesh, bool all_nodes, std::function<Vec3(Vec3 const&)> const& to) {
  std::map<std::vector<Index32>, Index32> middle;  // of the corners around it, ascending
  std::vector<Vec3> points;
  for (Index n = 0; n < mesh.n_nodes(); ++n) points.push_back(mesh.coordinates[n]);
  std::vector<std::vector<Index32>> nodes;
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    ElementType const type = mesh.elements.type[e];
    auto const corners = mesh.elements.corners(e);
    auto& list = nodes.emplace_back(corners.begin(), corners.end());
    auto const add_amid = [&](std::vector<Index32> around) {
      std::sort(around.begin(), around.end());
      auto const [at, fresh] = middle.try_emplace(around, Index32(points.size()));
      if (fresh) {
        Vec3 sum;
        for (Index32 const n : around) sum += points[n];
        points.push_back((1.0 / double(around.size())) * sum);
      }
      list.push_back(at->second);
    };
    for (int k = 0; k < n_edges(type); ++k)
      add_amid({corners[edge_corner(type, k, 0)], corners[edge_corner(type, k, 1)]});
    if (!all_nodes) continue;
    if (is_surface(type)) {
      if (type == ElementType::quadrilateral) add_amid({corners.begin(), corners.end()});
      continue;
    }
    for (int f = 0; f < n_faces(type); ++f) {
      std::array<Index32, max_face_corners> room;
      auto const face = side_nodes(mesh, e, f, room);
      if (face.size() == 4) add_amid({face.begin(), face.end()});
    }
    if (type == ElementType::hexahedron) add_amid({corners.begin(), corners.end()});
  }
  Mesh out;
  out.source = mesh.source;
  out.dimension = mesh.dimension;
  out.add_zone("zone", Index(points.size()));
  for (Index e = 0; e < mesh.n_elements(); ++e) out.add_element(mesh.elements.type[e], nodes[e]);
  out.patches = mesh.patches;
  out.coordinates = Coordinates(Index(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n) out.coordinates.set(Index(n), to ? to(points[n]) : points[n]);
  return out;
}

Mesh as_polyhedra(Mesh const& mesh) {
  Mesh out;
  out.source = mesh.source;
  out.add_zone("zone", mesh.n_nodes());
  std::array<Index32, max_face_corners> room{};
  out.polyhedra.first_face.push_back(0);
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    out.add_element(ElementType::polyhedron, mesh.elements.corners(e));
    for (int s = 0; s < n_sides(mesh, e); ++s) out.polyhedra.faces.add(side_nodes(mesh, e, s, room));
    out.polyhedra.element.push_back(Index32(e));
    out.polyhedra.first_face.push_back(out.polyhedra.faces.size());
  }
  out.patches = mesh.patches;
  out.coordinates = mesh.coordinates;
  return out;
}

Mesh with_joined_elements(Mesh const& mesh, int side) {
  UnstructuredTopology const topology = make_topology(mesh);
  std::vector<Index> partner(mesh.n_elements(), -1);
  int pairs = 0;
  for (Zone const& zone : mesh.zones)
    for (Index e = zone.first_element; e < zone.first_element + zone.n_elements; ++e) {
      Index const other = topology.sides.of(e)[side];
      bool const here = other >= zone.first_element && other < zone.first_element + zone.n_elements;
      if (!here || partner[e] >= 0 || partner[other] >= 0 || ++pairs % 3 == 0) continue;
      partner[e] = other;
      partner[other] = e;
    }
  Mesh out = mesh;
  out.zones.clear();
  out.elements = {};
  out.polyhedra.first_face.push_back(0);
  std::array<Index32, max_face_corners> room{};
  for (Zone const& zone : mesh.zones) {
    out.zones.push_back(zone);
    out.zones.back().first_element = out.n_elements();
    out.zones.back().n_elements = 0;
    for (Index e = zone.first_element; e < zone.first_element + zone.n_elements; ++e) {
      Index const other = partner[e];
      if (other < 0) out.add_element(mesh.elements.type[e], mesh.elements.nodes[e]);
      if (other < e) continue;
      std::set<Index32> nodes;
      for (Index const part : {e, other})
        for (int s = 0; s < n_sides(mesh, part); ++s) {
          if (topology.sides.of(part)[s] == (part == e ? other : e)) continue;
          auto const face = side_nodes(mesh, part, s, room);
          out.polyhedra.faces.add(face);
          nodes.insert(face.begin(), face.end());
        }
      out.polyhedra.element.push_back(Index32(out.n_elements()));
      out.polyhedra.first_face.push_back(out.polyhedra.faces.size());
      std::vector<Index32> const list(nodes.begin(), nodes.end());
      out.add_element(ElementType::polyhedron, list);
    }
  }
  return out;
}

Mesh box_around(Index3 n, std::function<bool(Vec3 const&)> const& body, bool tetrahedra) {
  Mesh full = tetrahedra ? to_prisms_and_tetrahedra(unit_box(n), 0) : to_hexahedra(unit_box(n));
  for (auto& patch : full.patches) patch.kind = PatchKind::farfield;
  return part_of(
      full, [&](Vec3 const& c) { return !body(c); }, "body", PatchKind::wall);
}

Mesh airfoil(int around, int layers, double first, double growth, double far) {
  std::vector<double> heights{0};
  double height = first;
  while (heights.back() + height < 0.8 * far) {
    heights.push_back(heights.back() + height);
    height *= growth;
  }
  heights.push_back(far);
  int const rows = int(heights.size());
  Mesh mesh;
  mesh.dimension = 2;
  mesh.source = "airfoil";
  mesh.add_zone("zone", Index(around) * rows);
  mesh.coordinates = Coordinates(mesh.n_nodes());
  auto const node = [&](int i, int j) { return Index32((i % around) + around * j); };
  for (int i = 0; i < around; ++i) {
    // Clockwise from the trailing edge would turn elements inside out: upper side first.
    double const angle = 2 * std::numbers::pi * i / around, x = 0.5 * (1 + std::cos(angle));
    double const half =
        0.6 * (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x);
    Vec3 const wall{x, std::sin(angle) >= 0 ? half : -half, 0};
    Vec3 const outer{0.5 + far * std::cos(angle), far * std::sin(angle), 0};
    for (int j = 0; j < rows; ++j) mesh.coordinates.set(node(i, j), wall + (heights[j] / far) * (outer - wall));
  }
  for (int j = 0; j + 1 < rows; ++j)
    for (int i = 0; i < around; ++i) {
      Index32 const a = node(i, j), b = node(i, j + 1), c = node(i + 1, j + 1), d = node(i + 1, j);
      if (j < layers) {
        mesh.add_element(ElementType::quadrilateral, std::array{a, b, c, d});
      } else {
        mesh.add_element(ElementType::triangle, std::array{a, b, c});
        mesh.add_element(ElementType::triangle, std::array{a, c, d});
      }
    }
  for (int const p : {0, 1}) {
    Patch patch;
    patch.name = p == 0 ? "airfoil" : "farfield";
    patch.kind = p == 0 ? PatchKind::wall : PatchKind::farfield;
    patch.bc_type = p == 0 ? "BCWall" : "BCFarfield";
    patch.zone = 0;
    for (int i = 0; i < around; ++i)
      patch.faces.add(std::array{node(i, p == 0 ? 0 : rows - 1), node(i + 1, p == 0 ? 0 : rows - 1)});
    mesh.patches.push_back(std::move(patch));
  }
  return mesh;
}

}  // namespace gridmorph::test
