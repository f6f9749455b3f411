// Files with blocks beside zones of elements: read as if all were elements, written back as they were.
#include "hybrid_file.hpp"
#include "quality/test_meshes.hpp"
#include "support/mesh_builders.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/write_series.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/morph/morph.hpp>

#include <algorithm>
#include <array>
#include <numeric>

namespace gridmorph::test {
namespace {

/// Two bricks side by side, periodic across.
Mesh periodic_bricks() {
  Bricks b;
  b.name = "periodic";
  b.extent = {8, 5, 4};
  b.zones = {{{0, 0, 0}, {5, 5, 4}}, {{4, 0, 0}, {8, 5, 4}}};
  b.position = [d = Distortion(7)](Vec3 const& q) {
    Vec3 const p = d(q);
    return Vec3{2 * p.x, p.y, p.z};
  };
  b.ends[2] = {Ends::Kind::periodic, periodic_translation(Vec3{0, 0, -1})};
  b.family = {"in", "out", "hub", "case", "", ""};
  b.kind = {PatchKind::inflow, PatchKind::outflow, PatchKind::wall,
            PatchKind::wall,   PatchKind::other,   PatchKind::other};
  return make(b);
}

Coordinates wavy_coordinates(Mesh const& mesh) {
  Coordinates out(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) out.set(n, wavy(mesh.coordinates[n], 0.05));
  return out;
}

/// Replaces the integers of a node of the file.
void patch_integers(std::string const& path, std::string const& node_path, std::vector<std::int32_t> const& values) {
  cgns::File file(path, cgns::File::Mode::modify);
  auto const tree = file.tree();
  cgns::Node const* node = &tree;
  std::size_t at = 1;
  while (node != nullptr && at < node_path.size()) {
    auto const end = std::min(node_path.find('/', at), node_path.size());
    node = node->child(node_path.substr(at, end - at));
    at = end + 1;
  }
  ASSERT_NE(node, nullptr) << node_path;
  file.write(*node, values.data());
  file.close();
}

/// The only path of a file that ends so.
std::string path_of(std::string const& file, std::string const& ending) {
  for (auto const& [path, text] : dump_tree(file))
    if (path.ends_with(ending)) return path;
  ADD_FAILURE() << ending << " is not in " << file;
  return "";
}

class HybridFormats : public testing::TestWithParam<FileFormat> {
 protected:
  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Formats, HybridFormats, testing::Values(FileFormat::cgns_hdf5, FileFormat::cgns_adf),
                         [](auto const& info) {
                           return std::string(info.param == FileFormat::cgns_hdf5 ? "hdf5" : "adf");
                         });

TEST_P(HybridFormats, BlocksAreReadAsHexahedraAndKeepTheirIndices) {
  for (auto const& mesh : {bricks_with_t_junctions(3), around_a_box(4), periodic_bricks()}) {
    Hybrid const hybrid(folder_, mesh, {}, GetParam());
    EXPECT_EQ(mesh_kind(hybrid.path), MeshKind::unstructured);
    auto const read = read_mesh(hybrid.path);
    EXPECT_FALSE(read.is_structured());
    EXPECT_EQ(read.notes, std::vector<std::string>());
    expect_same_mesh(read, hybrid.expected);
    for (std::size_t z = 0; z < read.zones.size(); ++z)
      EXPECT_EQ(read.zones[z].extent, z % 2 == 0 ? hybrid.blocks.zones[z].extent : (Index3{0, 0, 0}));
    EXPECT_EQ(describe_node(read, 1), describe_node(hybrid.blocks, 1));
    EXPECT_EQ(describe_element(read, read.zones[0].extent[0] - 1),
              "zone '" + read.zones[0].name + "' cell (i 1, j 2, k 1)");
    auto const topology = make_topology(read);
    EXPECT_TRUE(find_face_patches(read, topology).problems.empty());
  }
}

TEST(Hybrid, LeftHandedBlocksAreTurnedInEveryOrientation) {
  TemporaryFolder const folder;
  for (auto const& orientation : all_orientations()) {
    Hybrid const hybrid(folder, two_zones(orientation, true), {"first"});
    auto const read = read_mesh(hybrid.path);
    expect_same_mesh(read, hybrid.expected);
    for (auto const& c : read.connections) EXPECT_LT(largest_mismatch(read, c), 1e-12);
  }
}

TEST_P(HybridFormats, MorphsLikeTheSameMeshOfElementsAndWritesOnlyCoordinates) {
  for (auto const& mesh : {around_a_box(4), periodic_bricks()}) {
    bool const periodic = mesh.zones.size() == 2;
    Hybrid const hybrid(folder_, mesh, {}, GetParam());
    auto const read = read_mesh(hybrid.path);
    Motion motion;
    motion.rules.push_back({{periodic ? "hub" : "step"}, RigidRule{{}, {0.01, 0.02, 0.005}}, 0, "test"});
    motion.rules.push_back(
        {periodic ? std::vector<std::string>{"in", "out"} : std::vector<std::string>{"w_min", "w_max"}, FreeRule{}, 0,
         "test"});
    Kokkos::DefaultHostExecutionSpace const exec;
    auto const moved = morph(exec, read, motion);
    expect_same_coordinates(moved, morph(exec, hybrid.expected, motion));

    auto const output = folder_.file("out.cgns");
    write_morphed(hybrid.path, output, read, moved);
    expect_same_coordinates(read_mesh(output).coordinates, moved);
    auto const before = dump_tree(hybrid.path), after = dump_tree(output);
    ASSERT_EQ(before.size(), after.size());
    for (auto const& [path, text] : before)
      EXPECT_EQ(text == after.at(path), path.find("/GridCoordinates/Coordinate") == std::string::npos) << path;
    write_morphed(hybrid.path, output, read, read.coordinates);
    EXPECT_EQ(dump_tree(output), before);
  }
}

TEST_P(HybridFormats, FieldsAndSeriesHaveTheShapeOfTheirZone) {
  Hybrid const hybrid(folder_, two_zones({}, true), {"second"}, GetParam());
  auto const read = read_mesh(hybrid.path);
  auto const moved = wavy_coordinates(read);
  OutputFields fields{true, {{"number", std::vector<double>(std::size_t(read.n_nodes()))}}, {{"cell", {}}}};
  std::iota(fields.nodes[0].values.begin(), fields.nodes[0].values.end(), 0);
  for (Index e = 0; e < read.n_elements(); ++e) fields.cells[0].values.push_back(double(e));
  auto const output = folder_.file("out.cgns");
  write_morphed(hybrid.path, output, read, moved, fields);
  {
    cgns::File const file(output, cgns::File::Mode::read);
    auto const tree = file.tree();
    for (auto const& zone : read.zones) {
      auto solution = [&](char const* name) {
        auto out = *tree.labelled("CGNSBase_t")->child(zone.name)->child(name);
        file.load_children(out);
        return out;
      };
      auto const nodes = solution("MorphNodes"), cells = solution("MorphCells");
      auto const& e = zone.extent;
      EXPECT_EQ(file.dimensions(*nodes.child("number")),
                zone.is_block() ? (std::vector<Index>{e[0], e[1], e[2]}) : std::vector<Index>{zone.size()});
      EXPECT_EQ(file.dimensions(*nodes.child("DisplacementX")), file.dimensions(*nodes.child("number")));
      EXPECT_EQ(file.dimensions(*cells.child("cell")), zone.is_block()
                                                           ? (std::vector<Index>{e[0] - 1, e[1] - 1, e[2] - 1})
                                                           : std::vector<Index>{zone.n_elements});
      EXPECT_EQ(file.reals(*nodes.child("number")).front(), double(zone.first_node));
      EXPECT_EQ(file.reals(*cells.child("cell")).back(), double(zone.first_element + zone.n_elements - 1));
    }
  }
  expect_same_coordinates(read_mesh(output).coordinates, moved);

  SeriesWriter writer(hybrid.path, output, read, {0, 1});
  writer.add(read.coordinates);
  writer.add(moved);
  writer.commit();
  cgns::File const file(output, cgns::File::Mode::read);
  auto const tree = file.tree();
  for (auto const& zone : read.zones) {
    auto step = *tree.labelled("CGNSBase_t")->child(zone.name)->child("GridCoordinates_2");
    file.load_children(step);
    auto const* x = step.child("CoordinateX");
    EXPECT_EQ(file.dimensions(*x).size(), zone.is_block() ? 3u : 1u);
    EXPECT_EQ(file.reals(*x).back(), moved.x(zone.first_node + zone.size() - 1));
  }
}

TEST(Hybrid, TetrahedraAndPrismsStandBesideBlocks) {
  TemporaryFolder const folder;
  auto const path = folder.file("hybrid.cgns"), output = folder.file("out.cgns");
  auto const blocks = two_zones({}, true);
  auto split = to_prisms_and_tetrahedra(blocks, 2);
  split.connections = as_hexahedra(blocks).connections;
  HybridFile(path, blocks, split, {"second"});
  auto const read = read_mesh(path);
  auto const hexahedra = as_hexahedra(blocks);
  EXPECT_EQ(count_types(read, 0), count_types(hexahedra, 0));
  EXPECT_EQ(count_types(read, 1), count_types(split, 1));
  ASSERT_EQ(read.connections.size(), 2u);
  EXPECT_EQ(read.connections[0].nodes, hexahedra.connections[0].nodes);
  auto const moved = wavy_coordinates(read);
  write_morphed(path, output, read, moved);
  expect_same_coordinates(read_mesh(output).coordinates, moved);
}

TEST(Hybrid, SinglePrecisionZonesStaySo) {
  TemporaryFolder const folder;
  auto mesh = two_zones({}, true);
  for (auto& zone : mesh.zones) zone.single_precision = true;
  Hybrid const hybrid(folder, mesh, {"second"});
  auto const read = read_mesh(hybrid.path);
  expect_same_mesh(read, hybrid.expected);
  EXPECT_TRUE(read.zones[0].single_precision && read.zones[1].single_precision);
  auto const moved = wavy_coordinates(read);
  auto const output = folder.file("out.cgns");
  write_morphed(hybrid.path, output, read, moved);
  auto const again = read_mesh(output);
  for (Index n = 0; n < moved.size(); ++n) ASSERT_EQ(again.coordinates.x(n), double(float(moved.x(n))));
}

TEST(Hybrid, WrittenAnewABlockIsElements) {
  TemporaryFolder const folder;
  Hybrid const hybrid(folder, periodic_bricks());
  auto const read = read_mesh(hybrid.path);
  auto const path = folder.file("anew.cgns");
  write_mesh(path, read);
  auto const again = read_mesh(path);
  EXPECT_FALSE(again.zones[0].is_block());
  expect_same_mesh(again, hybrid.expected);
}

TEST(Hybrid, OrderByPositionLeavesBlocksInPlace) {
  TemporaryFolder const folder;
  Hybrid const hybrid(folder, around_a_box(4));
  auto const read = read_mesh(hybrid.path);
  auto ordered = read;
  reorder(ordered, order_by_position(read));
  ASSERT_NE(ordered.file_order.node, std::vector<Index32>());
  EXPECT_NE(ordered.elements.nodes.item, read.elements.nodes.item);
  for (auto const& zone : ordered.zones) {
    if (!zone.is_block()) continue;
    for (Index n = zone.first_node; n < zone.first_node + zone.size(); ++n)
      ASSERT_EQ(ordered.coordinates[n], read.coordinates[n]);
    for (Index e = zone.first_element; e < zone.first_element + zone.n_elements; ++e)
      ASSERT_EQ(ordered.elements.number[e], e - zone.first_element + 1);
    EXPECT_EQ(describe_node(ordered, zone.first_node + 3), describe_node(read, zone.first_node + 3));
  }
  auto const one = folder.file("one.cgns"), two = folder.file("two.cgns");
  write_morphed(hybrid.path, one, read, wavy_coordinates(read));
  write_morphed(hybrid.path, two, ordered, wavy_coordinates(ordered));
  EXPECT_EQ(dump_tree(one), dump_tree(two));

  auto mixed_up = order_by_position(read);
  std::swap(mixed_up.node[0], mixed_up.node[1]);
  auto again = read;
  EXPECT_NE(message_of<MeshError>([&] { reorder(again, mixed_up); }).find(read.zones[0].name), std::string::npos);
}

TEST(Hybrid, ZonesOfEitherKindCanBeLeftOut) {
  TemporaryFolder const folder;
  Hybrid const hybrid(folder, two_zones({}, true), {"second"});
  auto const output = folder.file("out.cgns");
  for (auto const* name : {"first", "second"}) {
    ReadOptions options;
    options.leave_out = {name};
    auto const read = read_mesh(hybrid.path, options);
    ASSERT_EQ(read.zones.size(), 1u);
    EXPECT_EQ(read.is_structured(), read.zones[0].name == "first");
    EXPECT_EQ(mesh_kind(hybrid.path, {name}), read.is_structured() ? MeshKind::structured : MeshKind::unstructured);
    write_morphed(hybrid.path, output, read, wavy_coordinates(read));
    auto const before = dump_tree(hybrid.path), after = dump_tree(output);
    for (auto const& [path, text] : before)
      EXPECT_EQ(text == after.at(path), path.find("/GridCoordinates/Coordinate") == std::string::npos ||
                                            path.find(std::string("/") + name + "/") != std::string::npos)
          << path;
  }
}

TEST(Hybrid, AMeshOfOtherBlocksIsNotWrittenIntoTheFile) {
  TemporaryFolder const folder;
  Hybrid const hybrid(folder, two_zones({}, true), {"second"});
  auto other = read_mesh(hybrid.path);
  std::swap(other.zones[0].extent[0], other.zones[0].extent[1]);
  EXPECT_NE(message_of<IoError>([&] {
              write_morphed(hybrid.path, folder.file("o"), other, other.coordinates);
            }).find("zone 'first'"),
            std::string::npos);
}

TEST(Hybrid, DamagedRangesAndListsAreNamed) {
  TemporaryFolder const folder;
  auto const expect = [&](Mesh const& mesh, std::string const& ending, std::vector<std::int32_t> const& values,
                          std::vector<std::string> const& parts) {
    Hybrid const hybrid(folder, mesh);
    patch_integers(hybrid.path, path_of(hybrid.path, ending), values);
    auto const message = message_of<MeshError>([&] { read_mesh(hybrid.path); });
    for (auto const& part : parts) EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  auto const box = around_a_box(4);
  auto const first = box.zones[0].name;
  Hybrid const sound(folder, box);
  auto const bc = sound.expected.patches[0].name;
  expect(box, "/" + first + "/ZoneBC/" + bc + "/PointRange", {1, 1, 1, 1, 99, 4},
         {"hybrid.cgns", "zone '" + first + "'", "BC '" + bc + "'", "outside the zone"});
  // The lists of two zones that meet, damaged in the block, and in the elements for a node of the block.
  auto const pairs = two_zones({}, true);
  auto const n = std::size_t(pairs.zones[0].extent[1] * pairs.zones[0].extent[2]);
  std::vector<std::int32_t> list(3 * n, 1);
  list[4] = 77;
  expect(pairs, "/first/ZoneGridConnectivity/join/PointList", list,
         {"zone 'first'", "connection 'join'", "outside the zone"});
  expect(pairs, "/second/ZoneGridConnectivity/join back/PointListDonor", list,
         {"zone 'second'", "connection 'join back'", "[1:1, 77:77, 1:1]", "zone 'first'"});
  // Two blocks with elements elsewhere.
  Hybrid const three(folder, bricks_with_t_junctions(3));
  auto const& face = three.blocks.interfaces;
  auto const between =
      std::find_if(face.begin(), face.end(), [](auto const& f) { return f.zone % 2 == 0 && f.donor_zone % 2 == 0; });
  ASSERT_NE(between, face.end());
  auto const& zone = three.blocks.zones[between->zone].name;
  expect(bricks_with_t_junctions(3), "/" + zone + "/ZoneGridConnectivity/" + between->name + "/PointRangeDonor",
         {1, 1, 1, 1, 88, 4}, {"zone '" + zone + "'", "interface '" + between->name + "'", "donor range"});
}

TEST(Hybrid, ListsThatDoNotPairNodesAreMatchedByPosition) {
  TemporaryFolder const folder;
  Hybrid const hybrid(folder, two_zones({}, true), {"second"});
  auto const& c = hybrid.expected.connections[0];
  std::vector<std::int32_t> reversed;
  for (auto n = c.donor_nodes.rbegin(); n != c.donor_nodes.rend(); ++n)
    reversed.push_back(std::int32_t(*n - hybrid.expected.zones[1].first_node + 1));
  patch_integers(hybrid.path, path_of(hybrid.path, "/first/ZoneGridConnectivity/join/PointListDonor"), reversed);
  auto const read = read_mesh(hybrid.path);
  ASSERT_EQ(read.connections.size(), 2u);
  EXPECT_EQ(read.connections[0].nodes, c.nodes);
  EXPECT_EQ(read.connections[0].donor_nodes, c.donor_nodes);
}

TEST(Hybrid, InterfacesOfABlockWithElementsAreMatchedByPosition) {
  TemporaryFolder const folder;
  auto const path = folder.file("hybrid.cgns");
  auto const blocks = two_zones({}, true);
  auto const expected = as_hexahedra(blocks);
  HybridFile(path, blocks, expected, {"second"}, FileFormat::cgns_hdf5, true);
  expect_same_mesh(read_mesh(path), expected);
}

/// A block of 4 x 3 nodes beside a triangle and a quadrilateral, each zone with its side of the connection between
/// them.
void write_flat(std::string const& path, bool three_indices, bool turned) {
  cgns::File file(path, cgns::File::Mode::create);
  float const version = 4.0F;
  file.create(file.root(), "CGNSLibraryVersion", "CGNSLibraryVersion_t", "R4", {1}, &version);
  std::array<std::int32_t, 2> const dimensions{2, 3};
  double const base = file.create(file.root(), "Base", "CGNSBase_t", "I4", {2}, dimensions.data());
  Index const rank = three_indices ? 3 : 2;
  auto const integers = [&](double parent, char const* name, char const* label, std::vector<Index> const& sizes,
                            std::vector<std::int32_t> const& values) {
    return file.create(parent, name, label, "I4", sizes, values.data());
  };
  auto const coordinates = [&](double zone, std::vector<Index> const& sizes, std::vector<double> const& x,
                               std::vector<double> const& y) {
    double const grid = file.create(zone, "GridCoordinates", "GridCoordinates_t");
    file.create(grid, "CoordinateX", "DataArray_t", "R8", sizes, x.data());
    file.create(grid, "CoordinateY", "DataArray_t", "R8", sizes, y.data());
  };
  auto const block = three_indices ? integers(base, "Block", "Zone_t", {3, 3}, {4, 3, 1, 3, 2, 0, 0, 0, 0})
                                   : integers(base, "Block", "Zone_t", {2, 3}, {4, 3, 3, 2, 0, 0});
  file.create_text(block, "ZoneType", "ZoneType_t", "Structured");
  std::vector<double> x, y;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 4; ++i) {
      x.push_back(i);
      y.push_back(turned ? 2 - j : j);
    }
  coordinates(block, three_indices ? std::vector<Index>{4, 3, 1} : std::vector<Index>{4, 3}, x, y);
  double const conditions = file.create(block, "ZoneBC", "ZoneBC_t");
  double const wall = file.create_text(conditions, "wall", "BC_t", "BCWall");
  integers(wall, "PointRange", "IndexRange_t", {rank, 2},
           three_indices ? std::vector<std::int32_t>{1, 1, 1, 4, 1, 1} : std::vector<std::int32_t>{1, 1, 4, 1});
  double const connectivity = file.create(block, "ZoneGridConnectivity", "ZoneGridConnectivity_t");
  double const join = file.create_text(connectivity, "join", "GridConnectivity_t", "Elements");
  file.create_text(join, "GridConnectivityType", "GridConnectivityType_t", "Abutting1to1");
  integers(join, "PointRange", "IndexRange_t", {rank, 2},
           three_indices ? std::vector<std::int32_t>{4, 1, 1, 4, 3, 1} : std::vector<std::int32_t>{4, 1, 4, 3});
  integers(join, "PointListDonor", "IndexArray_t", {1, 3},
           turned ? std::vector<std::int32_t>{5, 3, 1} : std::vector<std::int32_t>{1, 3, 5});

  double const zone = integers(base, "Elements", "Zone_t", {1, 3}, {5, 2, 0});
  file.create_text(zone, "ZoneType", "ZoneType_t", "Unstructured");
  coordinates(zone, {5}, {3, 4, 3, 4, 3}, {0, 0, 1, 1, 2});
  double const quadrilateral = integers(zone, "Quads", "Elements_t", {2}, {7, 0});
  integers(quadrilateral, "ElementRange", "IndexRange_t", {2}, {1, 1});
  integers(quadrilateral, "ElementConnectivity", "DataArray_t", {4}, {1, 2, 4, 3});
  double const triangle = integers(zone, "Triangles", "Elements_t", {2}, {5, 0});
  integers(triangle, "ElementRange", "IndexRange_t", {2}, {2, 2});
  integers(triangle, "ElementConnectivity", "DataArray_t", {3}, {3, 4, 5});
  file.close();
}

TEST(Hybrid, PlanesAreQuadrilateralsInTwoDimensions) {
  TemporaryFolder const folder;
  for (bool const three_indices : {false, true})
    for (bool const turned : {false, true}) {
      auto const path = folder.file("flat.cgns"), output = folder.file("out.cgns");
      write_flat(path, three_indices, turned);
      auto const read = read_mesh(path);
      EXPECT_EQ(read.dimension, 2);
      EXPECT_EQ(read.zones[0].extent, (Index3{4, 3, 1}));
      EXPECT_EQ(read.n_nodes(), 17);
      ASSERT_EQ(read.n_elements(), 8);
      auto const cell = read.elements.nodes[4];  // i 2, j 2
      EXPECT_EQ(std::vector<Index32>(cell.begin(), cell.end()),
                turned ? (std::vector<Index32>{5, 9, 10, 6}) : (std::vector<Index32>{5, 6, 10, 9}));
      EXPECT_EQ(describe_element(read, 4), "zone 'Block' cell (i 2, j 2, k 1)");
      ASSERT_EQ(read.patches.size(), 1u);
      EXPECT_EQ(read.patches[0].faces.item, (std::vector<Index32>{0, 1, 1, 2, 2, 3}));
      EXPECT_EQ(read.patches[0].faces.size(), 3);
      ASSERT_EQ(read.connections.size(), 1u);
      EXPECT_EQ(read.connections[0].nodes, (std::vector<Index32>{3, 7, 11}));
      EXPECT_EQ(largest_mismatch(read, read.connections[0]), 0);
      Coordinates moved(read.n_nodes());
      for (Index n = 0; n < read.n_nodes(); ++n) moved.set(n, read.coordinates[n] + Vec3{0.5, 0.25, 0});
      OutputFields const fields{true, {}, {{"cell", std::vector<double>(8, 1.5)}}};
      write_morphed(path, output, read, moved, fields);
      expect_same_coordinates(read_mesh(output).coordinates, moved);
      auto const tree = dump_tree(output);
      EXPECT_EQ(tree.contains("/Base/Block/MorphCells/cell"), !three_indices);
      EXPECT_TRUE(tree.contains("/Base/Block/MorphNodes/DisplacementX"));
      EXPECT_TRUE(tree.contains("/Base/Elements/MorphCells/cell"));
    }
}

TEST(Hybrid, APlaneBesideElementsOfTheVolumeIsRefused) {
  TemporaryFolder const folder;
  auto const path = folder.file("flat.cgns");
  write_flat(path, true, false);
  {
    cgns::File file(path, cgns::File::Mode::modify);
    auto const tree = file.tree();
    double const zone = file.id(*tree.labelled("CGNSBase_t")->child("Elements"));
    std::array<std::int32_t, 2> const type{10, 0}, range{3, 3};
    std::array<std::int32_t, 4> const nodes{1, 2, 3, 4};
    double const section = file.create(zone, "Tetrahedra", "Elements_t", "I4", {2}, type.data());
    file.create(section, "ElementRange", "IndexRange_t", "I4", {2}, range.data());
    file.create(section, "ElementConnectivity", "DataArray_t", "I4", {4}, nodes.data());
    file.close();
  }
  auto const message = message_of<MeshError>([&] { read_mesh(path); });
  EXPECT_NE(message.find("zone 'Block'"), std::string::npos) << message;
  EXPECT_NE(message.find("dimension 3"), std::string::npos) << message;
}

}  // namespace
}  // namespace gridmorph::test
