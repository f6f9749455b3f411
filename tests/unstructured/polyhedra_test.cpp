// NGON_n and NFACE_n, written by the CGNS mid-level library.
#include "io/io_support.hpp"
#include "support/unstructured_meshes.hpp"

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
  std::vector<std::vector<cgsize_t>> faces_of(std::size_t(mesh.n_elements()));
  cgsize_t n_faces = 0;
  std::array<Index32, max_face_corners> room{};
  for (int const boundary : {0, 1})
    for (Index e = 0; e < mesh.n_elements(); ++e) {
      auto const neighbours = topology.sides.of(e);
      for (std::size_t s = 0; s < neighbours.size(); ++s) {
        if ((neighbours[s] < 0) != (boundary == 1) || (boundary == 0 && neighbours[s] < e)) continue;
        for (Index32 const n : side_nodes(mesh, e, int(s), room)) nodes.push_back(n + 1);
        node_start.push_back(cgsize_t(nodes.size()));
        faces_of[std::size_t(e)].push_back(++n_faces);
        if (boundary == 0) faces_of[std::size_t(neighbours[s])].push_back(-n_faces);
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

}  // namespace
}  // namespace gridmorph::test
