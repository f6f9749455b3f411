// NGON_n and NFACE_n, written by the CGNS mid-level library.
#include "io/io_support.hpp"
#include "support/made_bodies.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <cgnslib.h>

#include <algorithm>
#include <map>

namespace gridmorph::test {
namespace {

void check(int status) {
  if (status != CG_OK) throw std::runtime_error(cg_get_error());
}

/// A mesh as polygons and polyhedra: faces numbered from 1, those of the boundary last; the elements behind them.
void write_polyhedra(std::string const& path, Mesh const& mesh, bool parents_only) {
  auto const topology = make_topology(mesh);
  std::vector<cgsize_t> nodes, node_start{0}, parents_left, parents_right;
  std::vector<std::vector<cgsize_t>> faces_of(mesh.n_elements());
  cgsize_t n_faces = 0;
  std::array<Index32, max_face_corners> room{};
  for (int const boundary : {0, 1})
    for (Index e = 0; e < mesh.n_elements(); ++e) {
      auto const neighbours = topology.sides.of(e);
      for (std::size_t s = 0; s < neighbours.size(); ++s) {
        if ((neighbours[s] < 0) != (boundary == 1) || (boundary == 0 && neighbours[s] < e)) continue;
        for (Index32 const n : side_nodes(mesh, e, int(s), room)) nodes.push_back(n + 1);
        node_start.push_back(cgsize_t(nodes.size()));
        faces_of[e].push_back(++n_faces);
        if (boundary == 0) faces_of[neighbours[s]].push_back(-n_faces);
        parents_left.push_back(e + 1000);
        parents_right.push_back(boundary == 0 ? neighbours[s] + 1000 : 0);
      }
    }
  int file = 0, base = 0, zone = 0, number = 0;
  check(cg_set_file_type(CG_FILE_HDF5));
  check(cg_open(path.c_str(), CG_MODE_WRITE, &file));
  check(cg_base_write(file, "Base", 3, 3, &base));
  cgsize_t size[3] = {cgsize_t(mesh.n_nodes()), cgsize_t(mesh.n_elements()), 0};
  check(cg_zone_write(file, base, "Zone", size, CGNS_ENUMV(Unstructured), &zone));
  check(cg_coord_write(file, base, zone, CGNS_ENUMV(RealDouble), "CoordinateX", mesh.coordinates.x.data(), &number));
  check(cg_coord_write(file, base, zone, CGNS_ENUMV(RealDouble), "CoordinateY", mesh.coordinates.y.data(), &number));
  check(cg_coord_write(file, base, zone, CGNS_ENUMV(RealDouble), "CoordinateZ", mesh.coordinates.z.data(), &number));
  check(cg_poly_section_write(file, base, zone, "Faces", CGNS_ENUMV(NGON_n), 1, n_faces, 0, nodes.data(),
                              node_start.data(), &number));
  if (parents_only) {
    std::vector<cgsize_t> parents = parents_left;
    parents.insert(parents.end(), parents_right.begin(), parents_right.end());
    parents.resize(2 * parents.size(), 0);  // ParentElementsPosition follows
    check(cg_parent_data_write(file, base, zone, number, parents.data()));
  } else {
    std::vector<cgsize_t> faces, face_start{0};
    for (auto const& list : faces_of) {
      faces.insert(faces.end(), list.begin(), list.end());
      face_start.push_back(cgsize_t(faces.size()));
    }
    check(cg_poly_section_write(file, base, zone, "Cells", CGNS_ENUMV(NFACE_n), n_faces + 1,
                                n_faces + cgsize_t(mesh.n_elements()), 0, faces.data(), face_start.data(), &number));
  }
  cgsize_t const last[2] = {n_faces, n_faces};
  check(cg_boco_write(file, base, zone, "last face", CGNS_ENUMV(BCWall), CGNS_ENUMV(PointRange), 2, last, &number));
  check(cg_boco_gridlocation_write(file, base, zone, number, CGNS_ENUMV(FaceCenter)));
  check(cg_close(file));
}

std::vector<Index32> sorted(std::span<Index32 const> list) {
  std::vector<Index32> out(list.begin(), list.end());
  std::sort(out.begin(), out.end());
  return out;
}

TEST(Polyhedra, UsualShapesAreRecognised) {
  TemporaryFolder const folder;
  for (bool const parents_only : {false, true})
    for (auto const& mesh : {to_hexahedra(unit_box({3, 2, 2})), to_prisms_and_tetrahedra(unit_box({3, 2, 4}), 2)}) {
      write_polyhedra(folder.file("poly.cgns"), mesh, parents_only);
      auto const read = read_mesh(folder.file("poly.cgns"));
      ASSERT_EQ(read.elements.type, mesh.elements.type);
      for (Index e = 0; e < mesh.n_elements(); ++e)
        EXPECT_EQ(sorted(read.elements.corners(e)), sorted(mesh.elements.corners(e)));
      auto const a = make_topology(read), b = make_topology(mesh);
      EXPECT_EQ(a.boundary.size(), b.boundary.size());
      ASSERT_EQ(read.patches.size(), 1u);
      EXPECT_EQ(find_face_patches(read, a).faces_of_patch[0], 1);
    }
}

TEST(Polyhedra, OtherShapesKeepTheirFaces) {
  // Two unit cubes as one element of ten faces.
  TemporaryFolder const folder;
  auto const path = folder.file("poly.cgns");
  auto const boxes = to_hexahedra(unit_box({2, 1, 1}));
  auto const topology = make_topology(boxes);
  std::vector<cgsize_t> nodes, start{0}, faces, face_start{0};
  for (Index f = 0; f < topology.boundary.size(); ++f) {
    for (Index32 const n : topology.boundary.nodes[f]) nodes.push_back(n + 1);
    start.push_back(cgsize_t(nodes.size()));
    faces.push_back(cgsize_t(f) + 1);
  }
  face_start.push_back(cgsize_t(faces.size()));
  int file = 0, base = 0, zone = 0, number = 0;
  check(cg_set_file_type(CG_FILE_HDF5));
  check(cg_open(path.c_str(), CG_MODE_WRITE, &file));
  check(cg_base_write(file, "Base", 3, 3, &base));
  cgsize_t size[3] = {12, 1, 0};
  check(cg_zone_write(file, base, "Zone", size, CGNS_ENUMV(Unstructured), &zone));
  check(cg_coord_write(file, base, zone, CGNS_ENUMV(RealDouble), "CoordinateX", boxes.coordinates.x.data(), &number));
  check(cg_coord_write(file, base, zone, CGNS_ENUMV(RealDouble), "CoordinateY", boxes.coordinates.y.data(), &number));
  check(cg_coord_write(file, base, zone, CGNS_ENUMV(RealDouble), "CoordinateZ", boxes.coordinates.z.data(), &number));
  check(cg_poly_section_write(file, base, zone, "Faces", CGNS_ENUMV(NGON_n), 1, 10, 0, nodes.data(), start.data(),
                              &number));
  check(cg_poly_section_write(file, base, zone, "Cells", CGNS_ENUMV(NFACE_n), 11, 11, 0, faces.data(),
                              face_start.data(), &number));
  check(cg_close(file));
  auto const mesh = read_mesh(path);
  ASSERT_EQ(mesh.n_elements(), 1);
  EXPECT_EQ(mesh.elements.type[0], ElementType::polyhedron);
  EXPECT_EQ(mesh.elements.corners(0).size(), 12u);
  auto const derived = make_topology(mesh);
  EXPECT_EQ(derived.boundary.size(), 10);
  EXPECT_EQ(sorted(derived.boundary.nodes[0]), sorted(topology.boundary.nodes[0]));
}

/// The corners of each element, and each face of a polyhedron, in ascending order: however they were listed.
std::vector<std::vector<Index32>> corners_and_faces(Mesh const& mesh) {
  std::vector<std::vector<Index32>> out;
  for (Index e = 0; e < mesh.n_elements(); ++e) out.push_back(sorted(mesh.elements.corners(e)));
  for (std::size_t p = 0; p < mesh.polyhedra.element.size(); ++p) {
    std::vector<std::vector<Index32>> faces;
    for (Index f = mesh.polyhedra.first_face[p]; f < mesh.polyhedra.first_face[p + 1]; ++f)
      faces.push_back(sorted(mesh.polyhedra.faces[f]));
    std::sort(faces.begin(), faces.end());
    out.insert(out.end(), faces.begin(), faces.end());
  }
  return out;
}

std::vector<std::vector<Index32>> faces_of(Patch const& patch) {
  std::vector<std::vector<Index32>> out;
  for (Index f = 0; f < patch.faces.size(); ++f) out.push_back(sorted(patch.faces[f]));
  std::sort(out.begin(), out.end());
  return out;
}

TEST(Polyhedra, ThatDoNotCloseAreRefused) {
  Mesh mesh = as_polyhedra(to_hexahedra(unit_box({2, 2, 2})));
  EXPECT_NO_THROW(check_mesh(mesh));
  auto& p = mesh.polyhedra;
  ASSERT_FALSE(p.element.empty());
  // A corner of one face is another one of the cell.
  auto const face = p.faces[p.first_face[0]];
  auto const other = p.faces[p.first_face[0] + 1];
  for (Index32 const n : other)
    if (std::find(face.begin(), face.end(), n) == face.end()) {
      p.faces.item[p.faces.first[p.first_face[0]]] = n;
      break;
    }
  std::string const said = message_of<MeshError>([&] { check_mesh(mesh); });
  EXPECT_NE(said.find("1 polyhedra do not close"), std::string::npos) << said;
}

TEST(Polyhedra, OfTwoClosedSurfacesAreRefused) {
  Mesh const boxes = as_polyhedra(to_hexahedra(unit_box({3, 1, 1})));
  // The first and the last of three cells in a row as one.
  Mesh mesh = boxes;
  mesh.elements = {};
  mesh.polyhedra = {};
  mesh.patches.clear();
  mesh.zones.front().n_elements = 0;
  mesh.polyhedra.first_face = {0};
  std::vector<Index32> nodes;
  for (std::size_t k : {std::size_t(0), boxes.polyhedra.element.size() - 1}) {
    for (Index f = boxes.polyhedra.first_face[k]; f < boxes.polyhedra.first_face[k + 1]; ++f)
      mesh.polyhedra.faces.add(boxes.polyhedra.faces[f]);
    auto const own = boxes.elements.nodes[boxes.polyhedra.element[k]];
    nodes.insert(nodes.end(), own.begin(), own.end());
  }
  mesh.polyhedra.element.push_back(0);
  mesh.polyhedra.first_face.push_back(mesh.polyhedra.faces.size());
  mesh.add_element(ElementType::polyhedron, nodes);
  std::string const said = message_of<MeshError>([&] { check_mesh(mesh); });
  EXPECT_NE(said.find("1 polyhedra have faces that make more than one closed surface"), std::string::npos) << said;
}

TEST(Polyhedra, AreWrittenByTheirFaces) {
  TemporaryFolder const folder;
  auto const path = folder.file("written.cgns");
  for (Mesh const& plain : {to_hexahedra(unit_box({5, 3, 2})), to_prisms_and_tetrahedra(unit_box({3, 2, 4}), 2)}) {
    Mesh const mesh = with_joined_elements(plain, 1);
    ASSERT_GT(mesh.polyhedra.element.size(), 1u);
    ASSERT_LT(Index(mesh.polyhedra.element.size()), mesh.n_elements());
    write_mesh(path, mesh);
    Mesh const back = read_mesh(path);
    EXPECT_EQ(back.elements.type, mesh.elements.type);
    EXPECT_EQ(corners_and_faces(back), corners_and_faces(mesh));
    ASSERT_EQ(back.patches.size(), mesh.patches.size());
    for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
      EXPECT_EQ(back.patches[p].name, mesh.patches[p].name);
      EXPECT_EQ(back.patches[p].kind, mesh.patches[p].kind);
      EXPECT_EQ(faces_of(back.patches[p]), faces_of(mesh.patches[p])) << mesh.patches[p].name;
    }
    for (Index n = 0; n < mesh.n_nodes(); ++n) EXPECT_EQ(back.coordinates[n], mesh.coordinates[n]);
    EXPECT_EQ(make_topology(back).boundary.size(), make_topology(mesh).boundary.size());
  }
}

TEST(Polyhedra, AreWrittenAsTheStandardHasThem) {
  TemporaryFolder const folder;
  auto const path = folder.file("written.cgns");
  Mesh const mesh = with_joined_elements(to_hexahedra(unit_box({3, 2, 2})), 1);
  write_mesh(path, mesh);
  int file = 0, sections = 0;
  check(cg_open(path.c_str(), CG_MODE_READ, &file));
  check(cg_nsections(file, 1, 1, &sections));
  ASSERT_EQ(sections, 2);
  std::vector<std::vector<cgsize_t>> lists[2];
  cgsize_t first[2], last[2];
  for (int s = 0; s < 2; ++s) {
    std::array<char, 66> name{};
    CGNS_ENUMT(ElementType_t) type;
    int boundary = 0, parents = 0;
    check(cg_section_read(file, 1, 1, s + 1, name.data(), &type, &first[s], &last[s], &boundary, &parents));
    EXPECT_EQ(type, s == 0 ? CGNS_ENUMV(NGON_n) : CGNS_ENUMV(NFACE_n));
    cgsize_t size = 0;
    check(cg_ElementDataSize(file, 1, 1, s + 1, &size));
    std::vector<cgsize_t> items(size, 0), offsets(std::size_t(last[s] - first[s] + 2));
    check(cg_poly_elements_read(file, 1, 1, s + 1, items.data(), offsets.data(), nullptr));
    for (std::size_t n = 0; n + 1 < offsets.size(); ++n)
      lists[s].emplace_back(items.begin() + offsets[n], items.begin() + offsets[n + 1]);
  }
  check(cg_close(file));
  EXPECT_EQ(first[0], 1);
  EXPECT_EQ(first[1], last[0] + 1);
  EXPECT_EQ(last[1] - last[0], mesh.n_elements());
  // Each face bounds one element, outwards, or two, and the second one sees it from outside as inwards. Around each
  // element faces close: every edge is passed once each way.
  std::map<cgsize_t, std::vector<int>> signs;
  for (auto const& element : lists[1]) {
    std::map<std::pair<cgsize_t, cgsize_t>, int> edges;
    for (cgsize_t const face : element) {
      signs[std::abs(face)].push_back(face > 0 ? 1 : -1);
      auto nodes = lists[0][std::size_t(std::abs(face)) - 1];
      if (face < 0) std::reverse(nodes.begin(), nodes.end());
      for (std::size_t n = 0; n < nodes.size(); ++n) ++edges[{nodes[n], nodes[(n + 1) % nodes.size()]}];
    }
    for (auto const& [edge, times] : edges) {
      EXPECT_EQ(times, 1);
      EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
  }
  EXPECT_EQ(signs.size(), lists[0].size());
  for (auto const& [face, of] : signs)
    EXPECT_TRUE(of == std::vector<int>{1} || of == (std::vector<int>{1, -1})) << face;
}

TEST(Polyhedra, InOneZoneWithElementsOfSecondOrderAreRefused) {
  TemporaryFolder const folder;
  Mesh mesh = with_joined_elements(to_hexahedra(unit_box({3, 2, 2})), 1);
  Mesh const curved = second_order(to_hexahedra(unit_box({1, 1, 1})));
  Index32 const shift = Index32(mesh.n_nodes());
  std::vector<Index32> nodes;
  for (Index32 const n : curved.elements.nodes[0]) nodes.push_back(n + shift);
  mesh.zones.back().n_nodes += curved.n_nodes();
  mesh.add_element(ElementType::hexahedron, nodes);
  Coordinates x(mesh.n_nodes());
  for (Index n = 0; n < x.size(); ++n)
    x.set(n, n < shift ? mesh.coordinates[n] : Vec3{9, 0, 0} + curved.coordinates[n - shift]);
  mesh.coordinates = x;
  std::string const said = message_of<IoError>([&] { write_mesh(folder.file("no.cgns"), mesh); });
  EXPECT_NE(said.find("second order"), std::string::npos) << said;
  EXPECT_FALSE(std::filesystem::exists(folder.file("no.cgns")));
}

}  // namespace
}  // namespace gridmorph::test
