// Unstructured CGNS files: written by this library and by the CGNS mid-level library.
#include "io/io_support.hpp"
#include "quality/test_meshes.hpp"
#include "support/made_bodies.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_file.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/write_series.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <cgnslib.h>

#include <algorithm>
#include <array>
#include <map>

namespace gridmorph::test {
namespace {

void check(int status) {
  if (status != CG_OK) throw std::runtime_error(cg_get_error());
}

Mesh mixed_box() {
  auto mesh = to_prisms_and_tetrahedra(unit_box({4, 3, 5}), 2);
  mesh.patches[4].families = {"bottom", "walls"};
  mesh.patches[5].nodes = patch_nodes(mesh.patches[5]);
  mesh.patches[5].faces = {};
  return mesh;
}

class UnstructuredCgns : public testing::TestWithParam<FileFormat> {
 protected:
  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Formats, UnstructuredCgns, testing::Values(FileFormat::cgns_hdf5, FileFormat::cgns_adf),
                         [](auto const& info) {
                           return std::string(info.param == FileFormat::cgns_hdf5 ? "hdf5" : "adf");
                         });

TEST_P(UnstructuredCgns, WhatIsWrittenReadsBackTheSame) {
  auto const file = folder_.file("mesh.cgns");
  for (auto mesh : {mixed_box(), to_hexahedra(two_zones({}, true)), flat_box(5, 4, 2)}) {
    mesh.zones[0].single_precision = false;
    write_mesh(file, mesh, {.format = GetParam()});
    EXPECT_EQ(mesh_kind(file), MeshKind::unstructured);
    expect_same_mesh(read_mesh(file), mesh);
  }
}

TEST_P(UnstructuredCgns, PeriodicConnectionsComeThrough) {
  auto mesh = to_hexahedra(unit_box({3, 2, 2}));
  Connection c;
  c.name = "around";
  c.zone = c.donor_zone = 0;
  c.nodes = patch_nodes(mesh.patches[0]);
  c.donor_nodes = patch_nodes(mesh.patches[1]);
  c.periodic = Periodic{};
  c.periodic->translation = {3, 0, 0};
  c.periodic->declared.translation = {3, 0, 0};
  mesh.connections = {c};
  mesh.patches.erase(mesh.patches.begin(), mesh.patches.begin() + 2);
  write_mesh(folder_.file("mesh.cgns"), mesh, {.format = GetParam()});
  auto const read = read_mesh(folder_.file("mesh.cgns"));
  expect_same_mesh(read, mesh);
  EXPECT_LT(largest_mismatch(read, read.connections[0]), 1e-12);
  auto const topology = make_topology(read);
  EXPECT_TRUE(find_face_patches(read, topology).problems.empty());
  EXPECT_EQ(
      std::count_if(topology.boundary.across.begin(), topology.boundary.across.end(), [](Index32 e) { return e >= 0; }),
      2 * 4);
}

/// `mesh` with nodes that nothing has, at places of their own: before, between and behind the others of each zone.
Mesh with_unused_nodes(Mesh const& mesh) {
  NodesOfFile file;
  std::vector<Vec3> x;
  Mesh out = mesh;
  out.file_order.left_out = 3 * Index(mesh.zones.size());
  for (auto const& zone : mesh.zones) {
    Index const in_front = zone.size() / 2;
    x.push_back({1e5, -0.0, 0});
    for (Index n = 0; n < zone.size(); ++n) {
      if (n == in_front) x.push_back({-7, 1e5, 0});
      out.file_order.node.push_back(Index32(zone.first_node + n + (n < in_front ? 1 : 2)));
      x.push_back(mesh.coordinates[zone.first_node + n]);
    }
    x.push_back({1, 1, -1e5});
    file.n_nodes.push_back(zone.size() + 3);
  }
  file.coordinates = Coordinates(Index(x.size()));
  for (std::size_t n = 0; n < x.size(); ++n) file.coordinates.set(Index(n), x[n]);
  return with_all_nodes(out, file);
}

TEST_P(UnstructuredCgns, NodesOfNoElementAreLeftToTheFile) {
  for (Mesh const& mesh : {mixed_box(), to_hexahedra(two_zones({}, true))}) {
    auto const input = folder_.file("in.cgns"), output = folder_.file("out.cgns"), plain = folder_.file("plain.cgns");
    Mesh const all = with_unused_nodes(mesh);
    ASSERT_EQ(all.n_nodes(), mesh.n_nodes() + 3 * Index(mesh.zones.size()));
    write_mesh(input, all, {.format = GetParam()});
    write_mesh(plain, mesh, {.format = GetParam()});
    Mesh read = read_mesh(input);
    expect_same_mesh(read, read_mesh(plain));
    EXPECT_NE(read.notes.back().find("belong to no element"), std::string::npos);
    EXPECT_EQ(node_number_in_file(read, 0), 2);
    EXPECT_EQ(read_mesh(plain).file_order.node, std::vector<Index32>());
    for (bool const ordered : {false, true}) {
      if (ordered) reorder(read, order_by_position(read));
      Coordinates after(read.n_nodes());
      for (Index n = 0; n < read.n_nodes(); ++n) after.set(n, wavy(read.coordinates[n], 0.1));
      OutputFields const fields{
          true, {{"x", {read.coordinates.x.data(), read.coordinates.x.data() + read.n_nodes()}}}, {}};
      write_morphed(input, output, read, after, fields);
      SeriesWriter series(input, folder_.file("series.cgns"), read, {0, 1});
      series.add(read.coordinates);
      series.add(after);
      series.commit();
      // As the file has them, whatever is read of it.
      cgns::File const file(output, cgns::File::Mode::read), steps(folder_.file("series.cgns"), cgns::File::Mode::read);
      auto const tree = file.tree(), tree_of_steps = steps.tree();
      for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
        auto const at = [](cgns::Node const& root, std::size_t zone) {
          std::size_t n = 0;
          for (auto const* base : root.all("CGNSBase_t"))
            for (auto const* one : base->all("Zone_t"))
              if (n++ == zone) return one;
          throw std::runtime_error("no such zone");
        };
        auto const* morphed = at(tree, z)->child("GridCoordinates")->child("CoordinateX");
        auto const* step = at(tree_of_steps, z)->child("GridCoordinates_2")->child("CoordinateX");
        std::vector<double> const x = file.reals(*morphed), x_of_step = steps.reals(*step);
        ASSERT_EQ(Index(x.size()), all.zones[z].size());
        EXPECT_EQ(x, x_of_step);
        Index const first = all.zones[z].first_node, middle = mesh.zones[z].size() / 2 + 1;
        EXPECT_EQ(x.front(), 1e5);
        EXPECT_EQ(x[middle], -7);
        EXPECT_EQ(x.back(), 1);
        for (Index n = 0; n < all.zones[z].size(); ++n)
          if (n != 0 && n != middle && n + 1 != all.zones[z].size()) {
            EXPECT_EQ(x[n], wavy(all.coordinates[first + n], 0.1).x) << n;
          }
      }
    }
  }
}

TEST_P(UnstructuredCgns, FilesOfAnOrderedMeshAreInTheOrderOfTheFile) {
  for (auto const& mesh : {mixed_box(), to_hexahedra(two_zones({}, true))}) {
    auto ordered = mesh;
    reorder(ordered, order_by_position(mesh));
    ASSERT_NE(ordered.elements.nodes.item, mesh.elements.nodes.item);
    Coordinates after(mesh.n_nodes()), ordered_after(mesh.n_nodes());
    OutputFields fields{true, {{"number", {}}}, {{"element", {}}}}, ordered_fields = fields;
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      after.set(n, wavy(mesh.coordinates[n], 0.1));
      ordered_after.set(n, wavy(ordered.coordinates[n], 0.1));
      fields.nodes[0].values.push_back(double(n));
      ordered_fields.nodes[0].values.push_back(ordered.file_order.node[n]);
    }
    for (Index e = 0; e < mesh.n_elements(); ++e) {
      fields.cells[0].values.push_back(double(e));
      ordered_fields.cells[0].values.push_back(ordered.file_order.element[e]);
    }
    auto const input = folder_.file("in.cgns"), one = folder_.file("one.cgns"), two = folder_.file("two.cgns");
    write_mesh(input, mesh, {.format = GetParam()});
    write_mesh(two, ordered, {.format = GetParam()});
    EXPECT_EQ(dump_tree(input), dump_tree(two));
    write_morphed(input, one, mesh, after, fields);
    write_morphed(input, two, ordered, ordered_after, ordered_fields);
    auto const expected = dump_tree(one);
    EXPECT_EQ(dump_tree(two), expected);
    write_mesh(two, ordered, ordered_after, ordered_fields, {.format = GetParam()});
    EXPECT_EQ(dump_tree(two), expected);
  }
}

TEST_P(UnstructuredCgns, MorphedFilesDifferInTheirCoordinatesAlone) {
  auto mesh = mixed_box();
  auto const input = folder_.file("in.cgns"), output = folder_.file("out.cgns");
  write_mesh(input, mesh, {.format = GetParam()});
  Coordinates after(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) after.set(n, wavy(mesh.coordinates[n], 0.1));
  write_morphed(input, output, mesh, after);
  expect_same_coordinates(read_mesh(output).coordinates, after);
  auto const before = dump_tree(input), now = dump_tree(output);
  ASSERT_EQ(before.size(), now.size());
  for (auto const& [path, text] : before)
    EXPECT_EQ(text == now.at(path), path.find("/Coordinate") == std::string::npos) << path;
  // No motion: the same bytes in every node.
  write_morphed(input, output, mesh, mesh.coordinates);
  EXPECT_EQ(dump_tree(output), before);
}

TEST_P(UnstructuredCgns, ASeriesHoldsEveryStepAsTheFileNumbersNodes) {
  auto const mesh = mixed_box();
  auto ordered = mesh;
  reorder(ordered, order_by_position(mesh));
  auto const input = folder_.file("in.cgns"), output = folder_.file("series.cgns");
  write_mesh(input, mesh, {.format = GetParam()});
  std::vector<double> const times{0, 0.25, 1};
  SeriesWriter writer(input, output, ordered, times);
  for (double const t : times) {
    Coordinates moved(mesh.n_nodes());
    for (Index n = 0; n < mesh.n_nodes(); ++n) moved.set(n, ordered.coordinates[n] + Vec3{0, 0, 3 * t});
    writer.add(moved);
  }
  writer.commit();
  auto const before = dump_tree(input), after = dump_tree(output);
  for (auto const& [path, text] : before) {
    ASSERT_TRUE(after.contains(path)) << path;
    EXPECT_EQ(after.at(path), text) << path;
  }
  for (std::size_t step = 0; step < times.size(); ++step) {
    auto const bytes = payload(after.at("/Base/box/GridCoordinates_" + std::to_string(step + 1) + "/CoordinateZ"));
    ASSERT_EQ(bytes.size(), sizeof(double) * std::size_t(mesh.n_nodes()));
    std::vector<double> z(mesh.n_nodes());
    std::memcpy(z.data(), bytes.data(), bytes.size());
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      EXPECT_EQ(z[n], mesh.coordinates.z(n) + 3 * times[step]) << step << " " << n;
  }
  EXPECT_TRUE(after.contains("/Base/box/ZoneIterativeData/GridCoordinatesPointers"));
}

TEST_P(UnstructuredCgns, FieldsAreAddedPerNodeAndPerElement) {
  auto const mesh = mixed_box();
  auto const input = folder_.file("in.cgns");
  write_mesh(input, mesh, {.format = GetParam()});
  OutputFields fields;
  fields.displacement = true;
  fields.cells.push_back({"Number", {}});
  for (Index e = 0; e < mesh.n_elements(); ++e) fields.cells[0].values.push_back(double(e));
  Coordinates after(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) after.set(n, mesh.coordinates[n] + Vec3{0.5, 0, 0});
  write_morphed(input, input, mesh, after, fields);
  auto const tree = dump_tree(input);
  ASSERT_TRUE(tree.contains("/Base/box/MorphNodes/DisplacementX"));
  ASSERT_TRUE(tree.contains("/Base/box/MorphCells/Number"));
  auto const bytes = payload(tree.at("/Base/box/MorphNodes/DisplacementX"));
  double first = 0;
  std::memcpy(&first, bytes.data(), sizeof first);
  EXPECT_EQ(first, 0.5);
  EXPECT_EQ(payload(tree.at("/Base/box/MorphCells/Number")).size(), sizeof(double) * std::size_t(mesh.n_elements()));
  fields.cells[0].values.pop_back();
  EXPECT_THROW(write_morphed(input, input, mesh, after, fields), MeshError);
}

/// Two hexahedra side by side, x from 0 to 2, with sections and boundary conditions as the test asks for.
class HandMadeFile {
 public:
  explicit HandMadeFile(std::string const& path, bool with_structured_zone = false) {
    check(cg_set_file_type(CG_FILE_HDF5));
    check(cg_open(path.c_str(), CG_MODE_WRITE, &file_));
    check(cg_base_write(file_, "Base", 3, 3, &base_));
    cgsize_t size[3] = {12, 2, 0};
    check(cg_zone_write(file_, base_, "Hexa", size, CGNS_ENUMV(Unstructured), &zone_));
    coordinates(zone_);
    cgsize_t const nodes[16] = {1, 2, 5, 4, 7, 8, 11, 10, 2, 3, 6, 5, 8, 9, 12, 11};
    int section = 0;
    check(cg_section_write(file_, base_, zone_, "Cells", CGNS_ENUMV(HEXA_8), 1, 2, 0, nodes, &section));
    cgsize_t const sides[8] = {1, 4, 10, 7, 3, 9, 12, 6};
    check(cg_section_write(file_, base_, zone_, "sides", CGNS_ENUMV(QUAD_4), 3, 4, 0, sides, &section));
    if (with_structured_zone) {
      cgsize_t box[9] = {3, 2, 2, 2, 1, 1, 0, 0, 0};
      int structured = 0;
      check(cg_zone_write(file_, base_, "Box", box, CGNS_ENUMV(Structured), &structured));
      coordinates(structured);
    }
  }
  ~HandMadeFile() { cg_close(file_); }
  HandMadeFile(HandMadeFile const&) = delete;
  HandMadeFile& operator=(HandMadeFile const&) = delete;

  void bc(char const* name, CGNS_ENUMT(PointSetType_t) set, std::vector<cgsize_t> const& points,
          CGNS_ENUMT(GridLocation_t) location = CGNS_ENUMV(Vertex)) {
    int number = 0;
    check(cg_boco_write(file_, base_, zone_, name, CGNS_ENUMV(BCWall), set, cgsize_t(points.size()), points.data(),
                        &number));
    if (location != CGNS_ENUMV(Vertex)) check(cg_boco_gridlocation_write(file_, base_, zone_, number, location));
  }
  void section(char const* name, CGNS_ENUMT(ElementType_t) type, cgsize_t first, cgsize_t last,
               std::vector<cgsize_t> const& nodes) {
    int section = 0;
    check(cg_section_write(file_, base_, zone_, name, type, first, last, 0, nodes.data(), &section));
  }
  void family(char const* name, CGNS_ENUMT(BCType_t) type, char const* own_name = nullptr) {
    int family = 0, bc = 0;
    check(cg_family_write(file_, base_, name, &family));
    check(cg_fambc_write(file_, base_, family, "FamilyBC", type, &bc));
    if (own_name != nullptr) check(cg_family_name_write(file_, base_, family, own_name, own_name));
  }
  void family_of(int condition, char const* name) {
    check(cg_goto(file_, base_, "Zone_t", zone_, "ZoneBC_t", 1, "BC_t", condition, "end"));
    check(cg_famname_write(name));
  }

 private:
  void coordinates(int zone) {
    for (int c = 0; c < 3; ++c) {
      std::vector<double> x;
      for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j)
          for (int i = 0; i < 3; ++i) x.push_back(std::array{i, j, k}[c]);
      static constexpr std::array names{"CoordinateX", "CoordinateY", "CoordinateZ"};
      int number = 0;
      check(cg_coord_write(file_, base_, zone, CGNS_ENUMV(RealDouble), names[c], x.data(), &number));
    }
  }
  int file_ = 0, base_ = 0, zone_ = 0;
};

std::vector<Index32> const x_min{0, 3, 6, 9}, x_max{2, 5, 8, 11};

TEST(UnstructuredBoundary, PointListsRangesElementListsAndNodesAllNameTheSameFaces) {
  TemporaryFolder const folder;
  auto const path = folder.file("bc.cgns");
  {
    HandMadeFile file(path);
    file.bc("list", CGNS_ENUMV(PointList), {3}, CGNS_ENUMV(FaceCenter));
    file.bc("range", CGNS_ENUMV(PointRange), {4, 4}, CGNS_ENUMV(FaceCenter));
    file.bc("cells", CGNS_ENUMV(PointRange), {3, 4}, CGNS_ENUMV(CellCenter));
    file.bc("nodes", CGNS_ENUMV(PointList), {10, 1, 4, 7, 1});
    file.bc("node range", CGNS_ENUMV(PointRange), {1, 12});
  }
  auto const mesh = read_mesh(path);
  ASSERT_EQ(mesh.patches.size(), 5u);
  EXPECT_EQ(patch_nodes(mesh.patches[0]), x_min);
  EXPECT_EQ(patch_nodes(mesh.patches[1]), x_max);
  EXPECT_EQ(mesh.patches[2].faces.size(), 2);
  EXPECT_EQ(mesh.patches[3].nodes, x_min);
  EXPECT_EQ(mesh.patches[4].nodes.size(), 12u);
  for (auto const& patch : mesh.patches) EXPECT_EQ(patch.kind, PatchKind::wall);
}

TEST(UnstructuredBoundary, SectionsThatNoConditionNamesBecomePatchesOfTheirFamily) {
  TemporaryFolder const folder;
  auto const path = folder.file("bc.cgns");
  {
    HandMadeFile file(path);
    file.family("sides", CGNS_ENUMV(BCInflow));
  }
  auto const mesh = read_mesh(path);
  ASSERT_EQ(mesh.patches.size(), 1u);
  EXPECT_EQ(mesh.patches[0].name, "sides");
  EXPECT_EQ(mesh.patches[0].kind, PatchKind::inflow);
  EXPECT_EQ(mesh.patches[0].faces.size(), 2);
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_NE(mesh.notes[0].find("no boundary condition names them"), std::string::npos);
}

/// As Gmsh writes its physical groups: a family for each piece of geometry, which has the group's name below it.
TEST(UnstructuredBoundary, NamesThatAFamilyGivesItselfAreFamiliesOfThePatch) {
  TemporaryFolder const folder;
  auto const path = folder.file("bc.cgns");
  {
    HandMadeFile file(path);
    file.family("S_1", CGNS_ENUMV(BCInflow), "left side");
    file.family("S_2", CGNS_ENUMV(BCOutflow), "right side");
    file.family("S_3", CGNS_ENUMV(BCWall), "S_1");  // a family above it
    file.bc("one", CGNS_ENUMV(PointList), {3}, CGNS_ENUMV(FaceCenter));
    file.family_of(1, "S_1");
    file.bc("other", CGNS_ENUMV(PointList), {4}, CGNS_ENUMV(FaceCenter));
    file.family_of(2, "S_2");
    file.bc("third", CGNS_ENUMV(PointList), {3, 4}, CGNS_ENUMV(FaceCenter));
    file.family_of(3, "S_3");
  }
  auto const mesh = read_mesh(path);
  ASSERT_EQ(mesh.patches.size(), 3u);
  EXPECT_EQ(mesh.patches[2].families, (std::vector<std::string>{"S_3", "S_1"}));
  EXPECT_EQ(mesh.patches[0].families, (std::vector<std::string>{"left side", "S_1"}));
  EXPECT_EQ(mesh.patches[1].families, (std::vector<std::string>{"right side", "S_2"}));
  EXPECT_EQ(select_patches(mesh, {"right side"}), std::vector<int>{1});
}

TEST(UnstructuredBoundary, ANodeListTakesTheFacesOfTheSectionOfItsName) {
  TemporaryFolder const folder;
  auto const path = folder.file("bc.cgns");
  {
    HandMadeFile file(path);
    file.bc("sides", CGNS_ENUMV(PointList), {1, 3, 4, 6, 7, 9, 10, 12});
  }
  auto const mesh = read_mesh(path);
  ASSERT_EQ(mesh.patches.size(), 1u);
  EXPECT_EQ(mesh.patches[0].faces.size(), 2);
  EXPECT_TRUE(mesh.patches[0].nodes.empty());
}

/// As meshers write them: the family, the condition on nodes and the section have one name; nodes on the edge between
/// two conditions are listed by one of them only.
TEST(UnstructuredBoundary, AConditionOnNodesItsFamilyAndItsSectionOfOneNameAreOnePatch) {
  TemporaryFolder const folder;
  for (auto const& nodes : {std::vector<cgsize_t>{1, 3, 4, 6, 7, 9, 10, 12}, std::vector<cgsize_t>{1, 3, 4, 6, 7, 9}}) {
    auto const path = folder.file("bc.cgns");
    {
      HandMadeFile file(path);
      file.family("sides", CGNS_ENUMV(BCInflow));
      file.bc("sides", CGNS_ENUMV(PointList), nodes);
    }
    auto const mesh = read_mesh(path);
    ASSERT_EQ(mesh.patches.size(), 1u);
    EXPECT_EQ(mesh.patches[0].families, (std::vector<std::string>{"sides"}));
    EXPECT_EQ(mesh.patches[0].faces.size(), 2);
    EXPECT_TRUE(mesh.patches[0].nodes.empty());
  }
}

std::int32_t type_in_3_0(std::int32_t type) { return type == 21 ? 13 : type >= 13 && type <= 20 ? type + 1 : type; }

/// A MIXED list with the types of CGNS 3.0, as its integers are stored; returns how many changed.
template <class Integer>
int rewrite_mixed(cgns::File& file, cgns::Node const& list) {
  std::map<std::int64_t, int> const nodes{{5, 3}, {7, 4}, {10, 4}, {12, 5}, {14, 6}, {17, 8}};
  auto const now = file.integers(list);
  std::vector<Integer> old(now.begin(), now.end());
  int changed = 0;
  for (std::size_t at = 0; at < now.size(); at += 1 + std::size_t(nodes.at(now[at]))) {
    old[at] = type_in_3_0(std::int32_t(now[at]));
    changed += old[at] != now[at] ? 1 : 0;
  }
  file.write(list, old.data());
  return changed;
}

TEST(UnstructuredFiles, ElementNumbersOfCgns30AreThoseOfThatVersion) {
  TemporaryFolder const folder;
  auto const path = folder.file("old.cgns");
  auto const mesh = mixed_box();
  write_mesh(path, mesh);
  int changed = 0;
  {
    cgns::File file(path, cgns::File::Mode::modify);
    auto const tree = file.tree();
    float const version = 3.0F;
    file.write(*tree.labelled("CGNSLibraryVersion_t"), &version);
    for (auto const* node : tree.labelled("CGNSBase_t")->labelled("Zone_t")->all("Elements_t")) {
      auto const head = file.integers(*node);
      std::array<std::int32_t, 2> const stored{type_in_3_0(std::int32_t(head[0])), std::int32_t(head[1])};
      file.write(*node, stored.data());
      if (head[0] != 20) continue;
      auto const& list = *node->child("ElementConnectivity");
      changed +=
          file.type(list) == "I8" ? rewrite_mixed<std::int64_t>(file, list) : rewrite_mixed<std::int32_t>(file, list);
    }
    file.close();
  }
  ASSERT_GT(changed, 0) << "the mesh is meant to have prisms";
  expect_same_mesh(read_mesh(path), mesh);
}

TEST(UnstructuredFiles, ZonesThatAreLeftOutByNameAreNoPartOfTheMeshAndStayAsTheyAre) {
  TemporaryFolder const folder;
  auto const path = folder.file("two.cgns"), out = folder.file("out.cgns");
  auto const box = to_hexahedra(unit_box({2, 2, 2}));
  write_mesh(path, in_two_zones(box, [](Vec3 const& c) { return c.x < 1; }));
  auto const whole = read_mesh(path);
  ASSERT_EQ(whole.zones.size(), 2u);
  ReadOptions options;
  options.leave_out = {whole.zones[0].name};
  auto const mesh = read_mesh(path, options);
  ASSERT_EQ(mesh.zones.size(), 1u);
  EXPECT_EQ(mesh.n_elements(), 4);
  EXPECT_TRUE(mesh.connections.empty());
  EXPECT_TRUE(find_face_patches(mesh, make_topology(mesh)).problems.empty()) << "the connection is a patch";
  Coordinates moved(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) moved.set(n, mesh.coordinates[n] + Vec3{0.125, 0, 0});
  write_morphed(path, out, mesh, moved);
  auto const after = read_mesh(out);
  Index const first = whole.zones[1].first_node;
  for (Index n = 0; n < after.n_nodes(); ++n)
    EXPECT_EQ(after.coordinates[n], n < first ? whole.coordinates[n] : moved[n - first]);
  options.leave_out = {"nothing"};
  EXPECT_NE(message_of<IoError>([&] { read_mesh(path, options); }).find("'nothing'"), std::string::npos);
  options.leave_out = {"*"};
  EXPECT_THROW(read_mesh(path, options), IoError);
}

TEST(UnstructuredBoundary, NumbersThatAreNotThereAreProblemsThatNameThem) {
  TemporaryFolder const folder;
  auto const path = folder.file("bc.cgns");
  {
    HandMadeFile file(path);
    file.bc("high", CGNS_ENUMV(PointList), {1, 13});
    file.bc("none", CGNS_ENUMV(PointList), {17}, CGNS_ENUMV(FaceCenter));
    file.bc("volume", CGNS_ENUMV(PointList), {1}, CGNS_ENUMV(FaceCenter));
  }
  auto const message = message_of<MeshError>([&] { read_mesh(path); });
  for (auto const* part : {"BC 'high'", "node 13", "12 nodes", "BC 'none'", "element 17"})
    EXPECT_NE(message.find(part), std::string::npos) << message;
  EXPECT_EQ(message.find("volume"), std::string::npos) << message;
}

TEST(UnstructuredFiles, SecondOrderElementsKeepAllTheirNodes) {
  TemporaryFolder const folder;
  auto const path = folder.file("tetra10.cgns");
  int file = 0, base = 0, zone = 0, number = 0;
  check(cg_set_file_type(CG_FILE_HDF5));
  check(cg_open(path.c_str(), CG_MODE_WRITE, &file));
  check(cg_base_write(file, "Base", 3, 3, &base));
  cgsize_t size[3] = {10, 1, 0};
  check(cg_zone_write(file, base, "Zone", size, CGNS_ENUMV(Unstructured), &zone));
  std::array<std::array<double, 10>, 3> const x{
      {{0, 2, 0, 0, 1, 1, 0, 0, 1, 0}, {0, 0, 2, 0, 0, 1, 1, 0, 0, 1}, {0, 0, 0, 2, 0, 0, 0, 1, 1, 1}}};
  check(cg_coord_write(file, base, zone, CGNS_ENUMV(RealDouble), "CoordinateX", x[0].data(), &number));
  check(cg_coord_write(file, base, zone, CGNS_ENUMV(RealDouble), "CoordinateY", x[1].data(), &number));
  check(cg_coord_write(file, base, zone, CGNS_ENUMV(RealDouble), "CoordinateZ", x[2].data(), &number));
  cgsize_t const nodes[10] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, face[6] = {1, 3, 2, 7, 6, 5};
  check(cg_section_write(file, base, zone, "T", CGNS_ENUMV(TETRA_10), 1, 1, 0, nodes, &number));
  check(cg_section_write(file, base, zone, "F", CGNS_ENUMV(TRI_6), 2, 2, 0, face, &number));
  cg_close(file);
  auto const mesh = read_mesh(path);
  EXPECT_EQ(mesh.elements.nodes[0].size(), 10u);
  EXPECT_EQ(mesh.elements.corners(0).size(), 4u);
  auto const topology = make_topology(mesh);
  EXPECT_EQ(topology.boundary.size(), 4);
  EXPECT_EQ(find_face_patches(mesh, topology).faces_of_patch[0], 1);
}

// As the CGNS library writes them; hybrid_test.cpp has the rest.
/// Programs that raise the order of a periodic mesh may list the corners of its sides alone.
TEST(UnstructuredFiles, MiddleNodesOfConnectionsThatListCornersAloneArePaired) {
  for (bool const all_nodes : {false, true}) {
    TemporaryFolder const folder;
    Mesh mesh = second_order(to_hexahedra(unit_box({2, 2, 3})), all_nodes);
    Connection periodic;
    periodic.name = "sides";
    periodic.zone = periodic.donor_zone = 0;
    periodic.periodic = periodic_translation({0, 2, 0});
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      for (Index m = 0; m < mesh.n_nodes(); ++m)
        if (mesh.coordinates[n].y == 0 && distance(mesh.coordinates[n] + Vec3{0, 2, 0}, mesh.coordinates[m]) < 1e-12) {
          periodic.nodes.push_back(Index32(n));
          periodic.donor_nodes.push_back(Index32(m));
        }
    mesh.connections = {periodic};
    std::vector<char> corners(mesh.n_nodes(), 0);
    for (Index e = 0; e < mesh.n_elements(); ++e)
      for (Index32 const n : mesh.elements.corners(e)) corners[n] = 1;
    auto const pairs = periodic;
    for (auto* list : {&mesh.connections[0].nodes, &mesh.connections[0].donor_nodes})
      std::erase_if(*list, [&](Index32 n) { return corners[n] == 0; });
    ASSERT_LT(mesh.connections[0].nodes.size(), pairs.nodes.size());
    write_mesh(folder.file("mesh.cgns"), mesh);
    Mesh const read = read_mesh(folder.file("mesh.cgns"));
    ASSERT_EQ(read.connections.size(), 1u);
    auto const sorted_pairs = [](Connection const& c) {
      std::vector<std::pair<Index32, Index32>> out;
      for (std::size_t n = 0; n < c.nodes.size(); ++n) out.emplace_back(c.nodes[n], c.donor_nodes[n]);
      std::sort(out.begin(), out.end());
      return out;
    };
    EXPECT_EQ(sorted_pairs(read.connections[0]), sorted_pairs(pairs));
  }
}

/// Conditions on points and edges, as Gmsh has them for each piece of geometry, bound nothing.
TEST(UnstructuredBoundary, ConditionsOnPointsAndEdgesAreLeftAlone) {
  TemporaryFolder const folder;
  auto const path = folder.file("bc.cgns");
  {
    HandMadeFile file(path);
    file.section("points", CGNS_ENUMV(NODE), 5, 6, {1, 2});
    file.section("edges", CGNS_ENUMV(BAR_2), 7, 7, {1, 2});
    file.bc("P", CGNS_ENUMV(PointRange), {5, 6}, CGNS_ENUMV(CellCenter));
    file.bc("L", CGNS_ENUMV(PointRange), {7, 7}, CGNS_ENUMV(CellCenter));
    file.bc("sides", CGNS_ENUMV(PointRange), {3, 4}, CGNS_ENUMV(CellCenter));
  }
  auto const mesh = read_mesh(path);
  ASSERT_EQ(mesh.patches.size(), 1u);
  EXPECT_EQ(mesh.patches[0].name, "sides");
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_NE(mesh.notes[0].find("BC 'P' and 1 more of the zone: left alone, of points or edges"), std::string::npos);
}

TEST(UnstructuredFiles, BlocksBesideElementsAreRead) {
  TemporaryFolder const folder;
  auto const path = folder.file("hybrid.cgns");
  { HandMadeFile const file(path, true); }
  EXPECT_EQ(mesh_kind(path), MeshKind::unstructured);
  auto const mesh = read_mesh(path);
  ASSERT_EQ(mesh.zones.size(), 2u);
  EXPECT_EQ(mesh.zones[mesh.zones[0].name == "Box" ? 0u : 1u].extent, (Index3{3, 2, 2}));
  EXPECT_EQ(count_types(mesh)[std::size_t(ElementType::hexahedron)], 4);
}

TEST(UnstructuredFiles, ElementsThatNameNodesOutsideTheZoneAreRefused) {
  TemporaryFolder const folder;
  auto const path = folder.file("bad.cgns");
  {
    HandMadeFile file(path);
    file.section("bad", CGNS_ENUMV(TRI_3), 5, 6, {1, 2, 3, 4, 5, 99});
  }
  auto const message = message_of<IoError>([&] { read_mesh(path); });
  for (auto const* part : {"elements 'bad'", "element 6", "node 99", "12 nodes"})
    EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(UnstructuredFiles, ZonesWhoseNamesEndInABlankAreFoundAsDonors) {
  TemporaryFolder const folder;
  auto mesh = to_hexahedra(two_zones({}, false));
  for (Zone& zone : mesh.zones) zone.name += " ";
  write_mesh(folder.file("mesh.cgns"), mesh);
  auto const read = read_mesh(folder.file("mesh.cgns"));
  ASSERT_EQ(read.connections.size(), mesh.connections.size());
  EXPECT_EQ(read.connections[0].donor_nodes, mesh.connections[0].donor_nodes);
  EXPECT_TRUE(read.notes.empty());
}

TEST(UnstructuredFiles, ConnectionsAreFoundByPositionWhereTheirListsAreNotInOrder) {
  TemporaryFolder const folder;
  auto mesh = to_hexahedra(two_zones({}, false));
  auto const good = mesh.connections[0];
  std::reverse(mesh.connections[0].donor_nodes.begin(), mesh.connections[0].donor_nodes.end());
  write_mesh(folder.file("mesh.cgns"), mesh);
  auto const read = read_mesh(folder.file("mesh.cgns"));
  ASSERT_EQ(read.connections.size(), 1u);
  EXPECT_EQ(read.connections[0].nodes, good.nodes);
  EXPECT_EQ(read.connections[0].donor_nodes, good.donor_nodes);
  EXPECT_TRUE(std::any_of(read.notes.begin(), read.notes.end(),
                          [](auto const& n) { return n.find("paired by position") != std::string::npos; }));
}

}  // namespace
}  // namespace gridmorph::test
