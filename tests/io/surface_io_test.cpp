// Surfaces in files: STL and CGNS.
#include <gtest/gtest.h>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/surface/surface_io.hpp>

#include <cgnslib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include <unistd.h>

#include "support/expect_error.hpp"
#include "support/mesh_builders.hpp"

namespace gridmorph::test {
namespace {

class SurfaceFiles : public ::testing::Test {
 protected:
  SurfaceFiles() { std::filesystem::create_directories(folder_); }
  ~SurfaceFiles() override { std::filesystem::remove_all(folder_); }
  [[nodiscard]] std::string path(std::string const& name) const { return (folder_ / name).string(); }
  std::string write(std::string const& name, std::string const& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }
  static std::string bytes(std::string const& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("gridmorph_surface_" + std::to_string(::getpid()) + "_" +
                                                ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

std::string const one_facet =
    "solid a name with words\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex +1.5e0 0 0\n"
    "   VERTEX 0 2 -1e-3\n  endloop\n endfacet\nendsolid a name with words\n";

Mesh two_boxes() { return box({5, 4, 3}, Shape::curved, 5); }

TEST_F(SurfaceFiles, AsciiStlGivesItsPoints) {
  TargetGeometry const g = read_stl(write("a.stl", one_facet));
  ASSERT_EQ(g.triangles.size(), 1u);
  EXPECT_TRUE(g.points[1] == (Vec3{1.5, 0, 0}));
  EXPECT_TRUE(g.points[2] == (Vec3{0, 2, -1e-3}));
}

TEST_F(SurfaceFiles, AsciiStlSaysWhereItIsDamaged) {
  struct Case {
    std::string from, to, where;
  };
  for (Case const& c :
       {Case{"+1.5e0", "1,5", ":5:"}, Case{"endloop", "endlop", ":7:"}, Case{"0 2 -1e-3", "0 2", ":7:"},
        Case{"0 2 -1e-3", "0 2 nan", ":6:"}, Case{"0 2 -1e-3", "0 2 1e999", ":6:"}, Case{"outer", "inner", ":3:"}}) {
    std::string text = one_facet;
    text.replace(text.find(c.from), c.from.size(), c.to);
    expect_all_in(message_of<IoError>([&] { read_stl(write("a.stl", text)); }), {"a.stl" + c.where, "found"});
  }
  expect_all_in(message_of<IoError>([&] { read_stl(write("a.stl", one_facet.substr(0, 90))); }), {"end of the file"});
  expect_all_in(message_of<IoError>([&] { read_stl(write("a.stl", "solid nothing\nendsolid\n")); }), {"no facets"});
}

TEST_F(SurfaceFiles, StlOfBothKindsComesBackAsWritten) {
  Mesh const mesh = two_boxes();
  SurfaceTriangles const surface = triangulate(mesh, {0, 3}, 2);
  write_stl(path("t.stl"), surface, StlFormat::ascii);
  write_stl(path("b.stl"), surface, StlFormat::binary);
  EXPECT_EQ(std::filesystem::file_size(path("b.stl")), 84 + 50 * surface.triangles.size());
  TargetGeometry const text = read_stl(path("t.stl")), binary = read_stl(path("b.stl"));
  ASSERT_EQ(text.triangles.size(), surface.triangles.size());
  ASSERT_EQ(binary.triangles.size(), surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (int c = 0; c < 3; ++c) {
      Vec3 const p = surface.points[surface.triangles[t][c]];
      EXPECT_TRUE(text.points[text.triangles[t][c]] == p);
      EXPECT_TRUE(binary.points[binary.triangles[t][c]] ==
                  (Vec3{double(float(p.x)), double(float(p.y)), double(float(p.z))}));
    }
}

TEST_F(SurfaceFiles, BinaryStlMayBeginWithTheWordSolid) {
  write_stl(path("b.stl"), triangulate(two_boxes(), {0}), StlFormat::binary);
  std::string data = bytes(path("b.stl"));
  data.replace(0, 5, "solid");
  EXPECT_EQ(read_stl(write("c.stl", data)).triangles.size(), read_stl(path("b.stl")).triangles.size());
}

TEST_F(SurfaceFiles, StlCutOffAnywhereIsRefused) {
  write_stl(path("b.stl"), triangulate(two_boxes(), {0}), StlFormat::binary);
  std::string const data = bytes(path("b.stl"));
  for (std::size_t n = 0; n < data.size(); n += 37) EXPECT_THROW(read_stl(write("c.stl", data.substr(0, n))), IoError);
  expect_all_in(message_of<IoError>([&] { read_stl(write("c.stl", data.substr(0, 200))); }),
                {"facets it would have", "it has 200"});
  EXPECT_THROW(read_stl(write("c.stl", data + "x")), IoError);
  EXPECT_THROW(read_stl(path("none.stl")), IoError);
  EXPECT_THROW(read_stl(folder_.string()), IoError);
}

TEST_F(SurfaceFiles, StlWithRandomBytesChangedNeverCrashes) {
  write_stl(path("b.stl"), triangulate(two_boxes(), {0}), StlFormat::binary);
  std::mt19937 random(11);
  for (std::string const& base : {bytes(path("b.stl")), one_facet})
    for (int n = 0; n < 300; ++n) {
      std::string data = base;
      for (int k = 0; k < 1 + n % 3; ++k) data[random() % data.size()] = char(random());
      try {
        TargetGeometry const g = read_stl(write("c.stl", data));
        for (auto const& t : g.triangles)
          for (int const v : t) EXPECT_LT(std::size_t(v), g.points.size());
      } catch (IoError const&) {
      }
    }
}

TEST_F(SurfaceFiles, TrianglesPointIntoTheMeshAndCoverThePatch) {
  Mesh const mesh = box({5, 4, 3}, Shape::straight, 1);
  Vec3 middle;
  for (Index n = 0; n < mesh.n_nodes(); ++n) middle += (1.0 / double(mesh.n_nodes())) * mesh.coordinates[n];
  for (int split : {1, 3})
    for (int p = 0; p < int(mesh.patches.size()); ++p) {
      SurfaceTriangles const s = triangulate(mesh, {p}, split);
      double area = 0;
      for (auto const& [a, b, c] : s.triangles) {
        Vec3 const n = cross(s.points[b] - s.points[a], s.points[c] - s.points[a]);
        EXPECT_GT(dot(n, middle - s.points[a]), 0);
        area += 0.5 * norm(n);
      }
      Index3 e{};
      for (int a = 0; a < 3; ++a) e[a] = mesh.patches[p].range.extent(a);
      double const wanted = e[0] == 1 ? 1.2 : e[1] == 1 ? 2.4 : 2.0;
      EXPECT_NEAR(area, wanted, 1e-12) << p;
    }
}

TEST_F(SurfaceFiles, StructuredSurfacesOfCgnsAreGrids) {
  int file = 0, base = 0, zone = 0, array = 0;
  ASSERT_EQ(cg_open(path("s.cgns").c_str(), CG_MODE_WRITE, &file), 0);
  ASSERT_EQ(cg_base_write(file, "Base", 2, 3, &base), 0);
  cgsize_t const size[6] = {3, 2, 2, 1, 0, 0};
  ASSERT_EQ(cg_zone_write(file, base, "Surface", size, CGNS_ENUMV(Structured), &zone), 0);
  std::array<double, 6> const x{0, 1, 2, 0, 1, 2}, y{0, 0, 0, 1, 1, 1}, z{0, 1, 0, 0, 2, 0};
  for (auto const& [name, v] :
       {std::pair("CoordinateX", &x), std::pair("CoordinateY", &y), std::pair("CoordinateZ", &z)})
    ASSERT_EQ(cg_coord_write(file, base, zone, CGNS_ENUMV(RealDouble), name, v->data(), &array), 0);
  ASSERT_EQ(cg_close(file), 0);
  TargetGeometry const g = read_cgns_surface(path("s.cgns"));
  ASSERT_EQ(g.grids.size(), 1u);
  EXPECT_EQ(g.grids[0].extent, (std::array{3, 2}));
  EXPECT_TRUE(g.grids[0].points[4] == (Vec3{1, 1, 2}));
}

TEST_F(SurfaceFiles, UnstructuredSurfacesOfCgnsAreTrianglesWhateverTheirSections) {
  int file = 0, base = 0, zone = 0, index = 0;
  ASSERT_EQ(cg_open(path("u.cgns").c_str(), CG_MODE_WRITE, &file), 0);
  ASSERT_EQ(cg_base_write(file, "Base", 2, 3, &base), 0);
  cgsize_t const size[3] = {6, 4, 0};
  ASSERT_EQ(cg_zone_write(file, base, "Surface", size, CGNS_ENUMV(Unstructured), &zone), 0);
  std::array<double, 6> const x{0, 1, 2, 0, 1, 2}, y{0, 0, 0, 1, 1, 1}, z{};
  for (auto const& [name, v] :
       {std::pair("CoordinateX", &x), std::pair("CoordinateY", &y), std::pair("CoordinateZ", &z)})
    ASSERT_EQ(cg_coord_write(file, base, zone, CGNS_ENUMV(RealDouble), name, v->data(), &index), 0);
  std::array<cgsize_t, 3> const triangle{1, 2, 5};
  std::array<cgsize_t, 4> const quad{2, 3, 6, 5};
  std::array<cgsize_t, 9> const mixed{CGNS_ENUMV(TRI_3), 1, 5, 4, CGNS_ENUMV(QUAD_4), 1, 2, 5, 4};
  std::array<cgsize_t, 3> const starts{0, 4, 9};
  ASSERT_EQ(cg_section_write(file, base, zone, "T", CGNS_ENUMV(TRI_3), 1, 1, 0, triangle.data(), &index), 0);
  ASSERT_EQ(cg_section_write(file, base, zone, "Q", CGNS_ENUMV(QUAD_4), 2, 2, 0, quad.data(), &index), 0);
  ASSERT_EQ(
      cg_poly_section_write(file, base, zone, "M", CGNS_ENUMV(MIXED), 3, 4, 0, mixed.data(), starts.data(), &index), 0);
  std::array<cgsize_t, 2> const bar{1, 2};
  ASSERT_EQ(cg_section_write(file, base, zone, "B", CGNS_ENUMV(BAR_2), 5, 5, 0, bar.data(), &index), 0);
  ASSERT_EQ(cg_close(file), 0);
  TargetGeometry const g = read_cgns_surface(path("u.cgns"));
  using T = std::array<int, 3>;
  EXPECT_EQ(g.triangles, (std::vector<T>{{0, 1, 4}, {1, 2, 5}, {1, 5, 4}, {0, 4, 3}, {0, 1, 4}, {0, 4, 3}}));
  EXPECT_EQ(g.points.size(), 6u);
}

TEST_F(SurfaceFiles, ConnectivityOutOfBoundsIsRefused) {
  int file = 0, base = 0, zone = 0, index = 0;
  ASSERT_EQ(cg_open(path("u.cgns").c_str(), CG_MODE_WRITE, &file), 0);
  ASSERT_EQ(cg_base_write(file, "Base", 2, 3, &base), 0);
  cgsize_t const size[3] = {3, 1, 0};
  ASSERT_EQ(cg_zone_write(file, base, "Surface", size, CGNS_ENUMV(Unstructured), &zone), 0);
  std::array<double, 3> const x{0, 1, 2};
  for (char const* name : {"CoordinateX", "CoordinateY", "CoordinateZ"})
    ASSERT_EQ(cg_coord_write(file, base, zone, CGNS_ENUMV(RealDouble), name, x.data(), &index), 0);
  std::array<cgsize_t, 3> const triangle{1, 2, 4};
  ASSERT_EQ(cg_section_write(file, base, zone, "T", CGNS_ENUMV(TRI_3), 1, 1, 0, triangle.data(), &index), 0);
  ASSERT_EQ(cg_close(file), 0);
  expect_all_in(message_of<IoError>([&] { read_cgns_surface(path("u.cgns")); }), {"/Base/Surface/T", "node 4 of 3"});
}

TEST_F(SurfaceFiles, VolumesAndMeshesWithoutSurfacesAreRefusedWithAWayOut) {
  write_mesh(path("v.cgns"), two_boxes());
  expect_all_in(message_of<IoError>([&] { read_cgns_surface(path("v.cgns")); }), {"is a volume", "target_patches"});
}

TEST_F(SurfaceFiles, CgnsCutOffIsRefused) {
  write_mesh(path("v.cgns"), two_boxes());
  std::string const data = bytes(path("v.cgns"));
  for (std::size_t n = 0; n < data.size(); n += data.size() / 15)
    EXPECT_THROW(read_cgns_surface(write("c.cgns", data.substr(0, n))), Error);
}

}  // namespace
}  // namespace gridmorph::test
