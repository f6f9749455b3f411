// Elements of a mesh as arrays, and meshes from such arrays.
#include "objects.hpp"

#include <gridmorph/io/element_orders.hpp>
#include <gridmorph/io/polyhedron.hpp>
#include <gridmorph/mesh/found_blocks.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/quality/indexed_mesh.hpp>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace gridmorph::python {

namespace {

using Numbers = nb::ndarray<std::int64_t const, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Table = nb::ndarray<std::int64_t const, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

/// Number of the type in ElementType, nodes of each element.
using Section = std::tuple<int, Table>;
/// Offsets and nodes of faces; elements on the side their normals come from, and on the other (-1: none).
using Faces = std::tuple<Numbers, Numbers, Numbers, Numbers>;
/// Name, kind, families, then offsets and nodes of its faces, then nodes instead of faces.
using NamedPatch = std::tuple<std::string, std::string, std::vector<std::string>, Numbers, Numbers, Numbers>;

std::span<std::int64_t const> list(Numbers const& a) { return {a.data(), a.shape(0)}; }

/// Nodes of a mesh as 32-bit numbers. Throws MeshError for one that there is not.
class NodeList {
 public:
  NodeList(Index n_nodes, std::string what) : n_nodes_(n_nodes), what_(std::move(what)) {}

  std::span<Index32 const> operator()(std::span<std::int64_t const> nodes, std::size_t row) {
    room_.clear();
    for (std::int64_t const n : nodes) {
      if (n < 0 || n >= n_nodes_)
        throw MeshError(what_ + " " + std::to_string(row) + " has node " + std::to_string(n) + ", and there are " +
                        std::to_string(n_nodes_) + " points, counted from 0");
      room_.push_back(Index32(n));
    }
    return room_;
  }

 private:
  Index n_nodes_;
  std::string what_;
  std::vector<Index32> room_;
};

void check_offsets(Numbers const& offsets, Numbers const& nodes, std::string const& what) {
  auto const o = list(offsets);
  if (o.empty() || o.front() != 0 || o.back() != std::int64_t(nodes.shape(0)) || !std::is_sorted(o.begin(), o.end()))
    throw MeshError(what + ": offsets must ascend from 0 to the number of nodes, " + std::to_string(nodes.shape(0)));
}

CsrGraph graph(Numbers const& offsets, Numbers const& nodes, Index n_nodes, std::string const& what) {
  check_offsets(offsets, nodes, what);
  CsrGraph out;
  NodeList nodes_of(n_nodes, what + ": face");
  auto const o = list(offsets), all = list(nodes);
  for (std::size_t f = 0; f + 1 < o.size(); ++f)
    out.add(nodes_of(all.subspan(std::size_t(o[f]), std::size_t(o[f + 1] - o[f])), f));
  return out;
}

void add_section(Mesh& mesh, Section const& section) {
  auto const& [type, table] = section;
  std::string const word(to_string(ElementType(type)));
  NodeList nodes(mesh.n_nodes(), word);
  for (std::size_t e = 0; e < table.shape(0); ++e)
    mesh.add_element(ElementType(type), nodes({table.data() + e * table.shape(1), table.shape(1)}, e));
}

/// Elements by their faces, in ascending order.
void add_by_faces(Mesh& mesh, Faces const& given) {
  auto const& [offsets, nodes, owner, neighbour] = given;
  CsrGraph const faces = graph(offsets, nodes, mesh.n_nodes(), "faces");
  if (Index(owner.shape(0)) != faces.size() || Index(neighbour.shape(0)) != faces.size())
    throw MeshError("faces: owner and neighbour have " + std::to_string(owner.shape(0)) + " and " +
                    std::to_string(neighbour.shape(0)) + " entries; give one for each of the " +
                    std::to_string(faces.size()) + " faces");
  std::int64_t n_elements = 0;
  for (Index f = 0; f < faces.size(); ++f)
    n_elements = std::max({n_elements, list(owner)[f] + 1, list(neighbour)[f] + 1});
  if (n_elements > 2 * faces.size())
    throw MeshError("faces: owner and neighbour count elements up to " + std::to_string(n_elements - 1) + ", and " +
                    std::to_string(faces.size()) + " faces bound far fewer; number them from 0 without gaps");
  std::vector<std::vector<std::pair<Index, bool>>> of(static_cast<std::size_t>(n_elements));
  for (Index f = 0; f < faces.size(); ++f) {
    if (auto const o = list(owner)[f]; o >= 0) of[o].emplace_back(f, true);
    if (auto const n = list(neighbour)[f]; n >= 0) of[n].emplace_back(f, false);
  }
  io::ElementsByFaces elements(mesh);
  for (std::size_t e = 0; e < of.size(); ++e) {
    if (of[e].size() < 4)
      throw MeshError("faces: element " + std::to_string(e) + " has " + std::to_string(of[e].size()) +
                      " of them; an element has at least 4");
    for (auto const& [f, outward] : of[e]) elements.add_face(faces[f], outward);
    elements.end_element(std::int64_t(e));
  }
  mesh.elements.number.clear();  // they count as they stand
}

PatchKind kind_of(std::string const& word, std::string const& patch) {
  for (int k = 0; k <= int(PatchKind::other); ++k)
    if (to_string(PatchKind(k)) == word) return PatchKind(k);
  throw MeshError("patch '" + patch + "': kind '" + word +
                  "' is none of wall, inflow, outflow, symmetry, farfield, degenerate, connection, other");
}

void add_patch(Mesh& mesh, NamedPatch const& given) {
  auto const& [name, kind, families, offsets, nodes, only_nodes] = given;
  Patch patch;
  patch.name = name;
  patch.kind = kind_of(kind, name);
  patch.families = families;
  patch.zone = 0;
  patch.faces = graph(offsets, nodes, mesh.n_nodes(), "patch '" + name + "'");
  auto const numbers = NodeList(mesh.n_nodes(), "patch '" + name + "': list")(list(only_nodes), 0);
  patch.nodes.assign(numbers.begin(), numbers.end());
  std::sort(patch.nodes.begin(), patch.nodes.end());
  patch.nodes.erase(std::unique(patch.nodes.begin(), patch.nodes.end()), patch.nodes.end());
  for (auto const& family : families)
    if (std::find(mesh.families.begin(), mesh.families.end(), family) == mesh.families.end())
      mesh.families.push_back(family);
  mesh.patches.push_back(std::move(patch));
}

PyMesh from_elements(Vectors const& points, int dimension, std::vector<Section> const& sections,
                     std::optional<Faces> const& faces, std::vector<NamedPatch> const& patches,
                     std::string const& zone) {
  PyMesh out{Session::get(), std::make_shared<Mesh>()};
  auto const x = as_vectors(points, "points");
  if (x.size() > std::size_t(std::numeric_limits<Index32>::max()))
    throw MeshError("points: " + std::to_string(x.size()) + " are more than can be numbered with 32 bits");
  Mesh& mesh = *out.mesh;
  mesh.source = "NumPy arrays";
  mesh.dimension = dimension;
  mesh.first_number = 0;
  mesh.add_zone(zone, Index(x.size()));
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (std::size_t n = 0; n < x.size(); ++n) mesh.coordinates.set(Index(n), x[n]);
  for (auto const& section : sections) add_section(mesh, section);
  if (faces) add_by_faces(mesh, *faces);
  for (auto const& patch : patches) add_patch(mesh, patch);
  check_mesh(mesh);
  return out;
}

/// types (of ElementType), offsets, nodes; then elements that are polyhedra, where the faces of each begin, offsets and
/// nodes of these.
nb::tuple elements(PyMesh const& self) {
  auto const& [type, nodes, number] = self.mesh->elements;
  auto const& p = self.mesh->polyhedra;
  std::vector<std::uint8_t> types(type.size());
  std::transform(type.begin(), type.end(), types.begin(), [](ElementType t) { return std::uint8_t(t); });
  auto const wide = [](auto const& values) { return std::vector<std::int64_t>(values.begin(), values.end()); };
  return nb::make_tuple(new_numbers(std::move(types)), new_numbers(wide(nodes.first)), new_numbers(wide(nodes.item)),
                        new_numbers(wide(p.element)), new_numbers(wide(p.first_face)), new_numbers(wide(p.faces.first)),
                        new_numbers(wide(p.faces.item)));
}

/// VTK's number of a type of cells with so many nodes (0: none), and which node of the SIDS stands where in VTK's
/// order.
nb::tuple vtk_order(int type, int nodes) {
  std::vector<Index32> sids(static_cast<std::size_t>(nodes));
  std::iota(sids.begin(), sids.end(), 0);
  std::vector<std::int64_t> row(sids.begin(), sids.end());
  if (ElementType(type) == ElementType::polyhedron) return nb::make_tuple(42, new_numbers(std::move(row)));
  for (int const cell : {5, 9, 10, 12, 13, 14, 22, 23, 24, 25, 26, 27, 28, 29, 32}) {
    auto const shape = io::vtk_shape(cell);
    if (shape.type != ElementType(type) || shape.nodes != nodes) continue;
    if (shape.type == ElementType::prism) io::turn_prism(sids);  // VTK's bottom triangles look outwards
    for (std::size_t k = 0; k < sids.size(); ++k) row[shape.order.empty() ? k : shape.order[k]] = sids[k];
    return nb::make_tuple(cell, new_numbers(std::move(row)));
  }
  return nb::make_tuple(0, new_numbers(std::move(row)));
}

nb::tuple blocks_of(PyMesh const& self) {
  if (self.mesh->is_structured()) throw MeshError(self.mesh->source + ": is a mesh of blocks already");
  FoundBlocks found;
  {
    Call const call;
    IndexedMesh const indexed(*self.mesh);
    found = find_blocks(HostInstance(), indexed.mesh(), indexed.topology(), indexed.face_patches());
  }
  if (found.n_left > 0)
    throw MeshError(self.mesh->source + ": " + std::to_string(found.n_left) + " of " +
                    std::to_string(self.mesh->n_elements()) +
                    " elements lie in no block of grid lines; the first: " + found.why_left);
  return nb::make_tuple(PyMesh{self.session, std::make_shared<Mesh>(std::move(found.mesh))},
                        new_numbers(std::vector<std::int64_t>(found.in_blocks.begin(), found.in_blocks.end())),
                        new_numbers(std::vector<std::int64_t>(found.element.begin(), found.element.end())));
}

}  // namespace

void bind_elements(nb::class_<PyMesh>& mesh) {
  mesh.def_static("_from_elements", &from_elements, nb::arg("points"), nb::arg("dimension"), nb::arg("sections"),
                  nb::arg("faces").none(), nb::arg("patches"), nb::arg("zone"))
      .def("_elements", &elements)
      .def(
          "find_blocks", &blocks_of,
          nb::sig("def find_blocks(self) -> tuple[Mesh, numpy.typing.NDArray[numpy.int64], "
                  "numpy.typing.NDArray[numpy.int64]]"),
          "The blocks of grid lines in a mesh of hexahedra, or of quadrilaterals in the plane, which plans take as any "
          "other mesh of blocks; (n_nodes) a node of theirs for each node of this mesh, -1 for none; and (blocks' "
          "n_cells) the element that each cell is.\n\n"
          "Where plan is one of the blocks, plan.positions()[nodes] are the morphed nodes of this mesh. Raises "
          "MeshError "
          "that names an element in no block. Cost: linear.")
      .def_static("_vtk_order", &vtk_order);
}

}  // namespace gridmorph::python
