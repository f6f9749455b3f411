// Meshes as pictures see them: facets that look into the mesh, cells with faces, cuts that leave no gap.
#include <support/mesh_builders.hpp>
#include <support/unstructured_meshes.hpp>

#include <gridmorph/page/section.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace gridmorph::page {
namespace {

using test::box;
using test::Shape;

struct Elements {
  explicit Elements(Mesh m)
      : mesh(std::move(m)),
        topology(make_topology(mesh)),
        patches(find_face_patches(mesh, topology)),
        signs(numbering_signs(mesh, topology.sides, volume_signs(mesh))),
        pictures(picture_mesh(mesh, topology, patches, signs)) {}
  Mesh mesh;
  UnstructuredTopology topology;
  BoundaryFacePatches patches;
  std::vector<signed char> signs;
  std::unique_ptr<PictureMesh> pictures;
};

std::unique_ptr<PictureMesh> of_blocks(Mesh const& mesh) {
  return picture_mesh(mesh, zone_handedness(Kokkos::DefaultHostExecutionSpace(), mesh, views(mesh.coordinates)));
}

double area_of(Section const& section) {
  double sum = 0;
  for (std::size_t p = 0; p < section.cell.size(); ++p) {
    double area = 0;
    std::size_t const begin = section.first[p], n = section.first[p + 1] - begin;
    for (std::size_t c = 0; c < n; ++c) {
      Flat const &a = section.corner[begin + c], &b = section.corner[begin + (c + 1) % n];
      area += 0.5 * (a[0] * b[1] - b[0] * a[1]);
    }
    sum += std::fabs(area);
  }
  return sum;
}

Cut at_x(double x) {
  Cut cut;
  cut.levels = [x](Coordinates const& nodes, std::span<double> level) {
    for (std::size_t n = 0; n < level.size(); ++n) level[n] = nodes[Index(n)].x - x;
  };
  cut.flat = [](Vec3 const& p) { return Flat{p.y, p.z}; };
  return cut;
}

TEST(Sections, CoverTheWholeCutOnce) {
  Mesh const blocks = box({9, 7, 6}, Shape::straight, 1);  // 2 x 1 x 1.2
  auto const pictures = of_blocks(blocks);
  Elements const hexahedra(test::to_hexahedra(blocks)), mixed(test::to_prisms_and_tetrahedra(blocks, 2));
  std::vector<signed char> const walls(blocks.patches.size(), 0);
  for (double const x : {0.1, 0.25, 1.0, 1.99})  // 0.25 and 1 go through nodes
    for (auto const* mesh : {pictures.get(), hexahedra.pictures.get(), mixed.pictures.get()}) {
      Section const section = cut_mesh(*mesh, mesh->boundary(), mesh->mesh().coordinates, at_x(x), walls);
      EXPECT_NEAR(area_of(section), 1.2, 1e-12) << x;
      double rim = 0;
      for (auto const& wall : section.walls) rim += std::hypot(wall.a[0] - wall.b[0], wall.a[1] - wall.b[1]);
      EXPECT_NEAR(rim, 4.4, 1e-12) << x;
    }
}

TEST(Sections, AlongPlanesOfNodesAreThoseOfTheirCoordinate) {
  Mesh const blocks = box({9, 7, 6}, Shape::straight, 1);  // 2 x 1 x 1.2
  auto const pictures = of_blocks(blocks);
  std::vector<signed char> const walls(blocks.patches.size(), 0);
  for (auto const& [index, x] : {std::pair(0, 0.0), std::pair(3, 0.75), std::pair(8, 2.0)}) {
    Cut cut = at_x(x);
    cut.index_plane = {0, index};
    auto const plane = pictures->index_plane(0, index);
    for (Facet const& facet : plane.facets)
      for (Index32 const n : facet.node) EXPECT_NEAR(blocks.coordinates[n].x, x, 1e-12);
    cut.levels = nullptr;
    Section const section = cut_mesh(*pictures, {}, blocks.coordinates, cut, walls);
    EXPECT_EQ(section.cell.size(), 6U * 5U);
    EXPECT_NEAR(area_of(section), 1.2, 1e-12);
    double rim = 0;
    for (auto const& wall : section.walls) rim += std::hypot(wall.a[0] - wall.b[0], wall.a[1] - wall.b[1]);
    EXPECT_NEAR(rim, 4.4, 1e-12) << index;
  }
  EXPECT_TRUE(pictures->index_plane(1, 7).facets.empty());
}

TEST(Sections, AreEmptyBesideTheMesh) {
  Mesh const blocks = box({4, 4, 4}, Shape::straight, 1);
  EXPECT_TRUE(cut_mesh(*of_blocks(blocks), {}, blocks.coordinates, at_x(-1), {}).cell.empty());
}

/// Volume of the box by its facets: a third of the sum of their places times their areas.
double volume_by(std::vector<Facet> const& facets, Coordinates const& at) {
  double sum = 0;
  for (Facet const& f : facets)
    for (std::size_t c = 2; c < f.size(); ++c) {
      Vec3 const a = at[f.node[0]], b = at[f.node[c - 1]], d = at[f.node[c]];
      sum -= dot(a, cross(b, d)) / 6;  // they look inwards
    }
  return sum;
}

TEST(Facets, LookIntoTheMeshWhateverItsHandedness) {
  Mesh right = box({5, 4, 6}, Shape::straight, 1), left = box({5, 4, 6}, Shape::straight, 1);
  for (Index n = 0; n < left.n_nodes(); ++n) left.coordinates.x(n) *= -1;
  EXPECT_NEAR(volume_by(of_blocks(right)->boundary(), right.coordinates), 2.4, 1e-12);
  EXPECT_NEAR(volume_by(of_blocks(left)->boundary(), left.coordinates), 2.4, 1e-12);
  Elements const mixed(test::to_prisms_and_tetrahedra(right, 2));
  EXPECT_NEAR(volume_by(mixed.pictures->boundary(), mixed.mesh.coordinates), 2.4, 1e-12);
}

TEST(Cells, HaveTheNamesAndMeasuresOfTheReport) {
  Mesh const blocks = box({6, 5, 4}, Shape::curved, 3);
  auto const pictures = of_blocks(blocks);
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(blocks.coordinates);
  QualityReport const report = measure_quality(Kokkos::DefaultHostExecutionSpace(), blocks, input);
  MeasureStatistics const& worst = report.far_field[Measure::determinant_3x3x3];
  Index const cell = pictures->number_of(worst.worst_zone, worst.worst_cell);
  EXPECT_DOUBLE_EQ(pictures->measures(cell, blocks.coordinates).determinant_3x3x3, worst.worst);
  CellName const name = pictures->name(cell);
  EXPECT_EQ(name.index,
            (std::vector<Index>{worst.worst_cell[0] + 1, worst.worst_cell[1] + 1, worst.worst_cell[2] + 1}));
  Elements const elements(test::to_hexahedra(blocks));
  for (Index e = 0; e < elements.mesh.n_elements(); ++e) {
    CellName const n = elements.pictures->name(e);
    EXPECT_EQ(elements.pictures->number_of(0, {int(n.index[0] - 1), 0, 0}), e);
    EXPECT_DOUBLE_EQ(elements.pictures->measures(e, elements.mesh.coordinates).determinant_3x3x3,
                     pictures->measures(e, blocks.coordinates).determinant_3x3x3);
  }
}

TEST(Cells, HaveNeighboursOnAllSides) {
  Mesh const blocks = box({5, 5, 5}, Shape::straight, 1);
  auto const pictures = of_blocks(blocks);
  EXPECT_EQ(pictures->around(pictures->number_of(0, {1, 1, 1})).size(), 26u);
  EXPECT_EQ(pictures->around(pictures->number_of(0, {0, 0, 0})).size(), 7u);
  Elements const elements(test::to_hexahedra(blocks));
  EXPECT_EQ(elements.pictures->around(21).size(), 26u);
}

}  // namespace
}  // namespace gridmorph::page
