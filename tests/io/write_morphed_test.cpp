// Writing coordinates back: everything else in the file stays what it was, and failures leave nothing behind.
#include "block_lattice.hpp"
#include "io_support.hpp"
#include "support/file_size_limit.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_file.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <algorithm>
#include <cstring>

#include <sys/stat.h>

namespace gridmorph::test {
namespace {

Coordinates copy_of(Coordinates const& c) {
  Coordinates out(c.size());
  Kokkos::deep_copy(out.x, c.x);
  Kokkos::deep_copy(out.y, c.y);
  Kokkos::deep_copy(out.z, c.z);
  return out;
}

Coordinates moved(Coordinates const& c) {
  Coordinates out(c.size());
  for (Index n = 0; n < c.size(); ++n) {
    Vec3 const p = c[n];
    out.set(n, {p.x + 0.01 * std::sin(p.y), p.y - 0.02 * p.x, p.z});
  }
  return out;
}

bool is_coordinate(std::string const& path) { return path.find("/GridCoordinates/Coordinate") != std::string::npos; }

/// The trees of two files without their coordinates.
void expect_same_but_coordinates(std::string const& a, std::string const& b) {
  auto const before = dump_tree(a), after = dump_tree(b);
  for (auto const& [path, content] : before) {
    ASSERT_TRUE(after.contains(path)) << path;
    auto const& found = after.at(path);
    if (is_coordinate(path)) {
      EXPECT_EQ(found.substr(0, found.find('\n')), content.substr(0, content.find('\n'))) << path;
      EXPECT_EQ(found.size(), content.size()) << path;
    } else {
      EXPECT_EQ(found, content) << path;
    }
  }
}

char const* const shared[] = {"axial_turbine_stage_H.cgns",
                              "water_turbine.cgns",
                              "axialTurbine_7blk.cgns",
                              "rotorstator.cgns",
                              "mdo_tutorial_000_vol.cgns",
                              "slotted_airfoil.cgns",
                              "multi.cgns",
                              "717_wl_L2.cgns"};

TEST(WriteMorphed, ZeroDisplacementLeavesEveryNodeOfRealFilesBitIdentical) {
  TemporaryFolder const folder;
  for (auto const* name : shared) {
    auto const path = shared_mesh(name);
    if (path.empty()) continue;
    Mesh const mesh = read_mesh(path);
    auto const out = folder.file(name);
    write_morphed(path, out, mesh, mesh.coordinates);
    EXPECT_EQ(dump_tree(path), dump_tree(out)) << name;
  }
}

TEST(WriteMorphed, RealFilesChangeInTheirCoordinatesAlone) {
  TemporaryFolder const folder;
  for (auto const* name : shared) {
    auto const path = shared_mesh(name);
    if (path.empty()) continue;
    Mesh const mesh = read_mesh(path);
    Coordinates const morphed = moved(mesh.coordinates);
    auto const out = folder.file(name);
    write_morphed(path, out, mesh, morphed);
    expect_same_but_coordinates(path, out);
    expect_same_coordinates(read_mesh(out).coordinates, morphed);
  }
}

class Formats : public testing::TestWithParam<FileFormat> {
 protected:
  Mesh write_lattice(Lattice const& lattice, WriteOptions options = {}) {
    options.format = GetParam();
    write_mesh(input_, LatticeBuilder(lattice, 4).build(), options);
    return read_mesh(input_);
  }
  TemporaryFolder folder_;
  std::string const input_ = folder_.file("in.cgns");
  std::string const output_ = folder_.file("out.cgns");
  Lattice const brick_{{{{0, 3, 7}, {0, 4}, {0, 2, 5}}}};
};
INSTANTIATE_TEST_SUITE_P(WriteMorphed, Formats, testing::Values(FileFormat::cgns_hdf5, FileFormat::cgns_adf),
                         [](auto const& info) {
                           return std::string(info.param == FileFormat::cgns_hdf5 ? "hdf5" : "adf");
                         });

TEST_P(Formats, SinglePrecisionArraysAreRoundedOnceAndStaySingle) {
  Lattice lattice = brick_;
  lattice.single_precision = true;
  Mesh const mesh = write_lattice(lattice);
  write_morphed(input_, output_, mesh, mesh.coordinates);
  EXPECT_EQ(dump_tree(input_), dump_tree(output_));
  Coordinates const morphed = moved(mesh.coordinates);
  write_morphed(input_, output_, mesh, morphed);
  expect_same_but_coordinates(input_, output_);
  Mesh const back = read_mesh(output_);
  for (Index n = 0; n < morphed.size(); ++n) {
    EXPECT_EQ(back.coordinates.x(n), double(float(morphed.x(n))));
    EXPECT_EQ(back.coordinates.y(n), double(float(morphed.y(n))));
  }
}

TEST_P(Formats, TwoDimensionalFilesGetPlaneZeroBack) {
  Lattice lattice{{{{0, 3, 7}, {0, 4, 6}, {0, 1}}}};
  lattice.two_dimensional = true;
  for (int physical : {2, 3}) {
    Mesh const mesh = write_lattice(lattice, {.physical_dimension = physical});
    Coordinates const morphed = moved(mesh.coordinates);
    OutputFields fields;
    fields.displacement = true;
    fields.cells.push_back({"Number", {}});
    for (Index c = 0; c < mesh.n_cells(); ++c) fields.cells[0].values.push_back(double(c));
    write_morphed(input_, output_, mesh, morphed, fields);
    expect_same_but_coordinates(input_, output_);
    Mesh const back = read_mesh(output_);
    for (auto const& zone : back.zones)
      for (int j = 0; j < zone.extent[1]; ++j)
        for (int i = 0; i < zone.extent[0]; ++i)
          EXPECT_EQ(back.coordinates[zone.node({i, j, 0})], morphed[zone.node({i, j, 0})]);
    auto const tree = dump_tree(output_);
    auto const& number = tree.at("/Base/Zone 1/MorphCells/Number");
    Index const cells = Index(mesh.zones[0].extent[0] - 1) * (mesh.zones[0].extent[1] - 1);
    EXPECT_EQ(payload(number).size(), std::size_t(cells) * sizeof(double));
    EXPECT_EQ(tree.contains("/Base/Zone 1/MorphNodes/DisplacementZ"), physical == 3);
  }
}

TEST_P(Formats, FieldsAreAddedForEveryZone) {
  Mesh const mesh = write_lattice(brick_);
  Coordinates const morphed = moved(mesh.coordinates);
  OutputFields fields;
  fields.displacement = true;
  fields.nodes.push_back({"NodeNumber", {}});
  for (Index n = 0; n < mesh.n_nodes(); ++n) fields.nodes[0].values.push_back(double(n));
  fields.cells.push_back({"CellNumber", {}});
  for (Index c = 0; c < mesh.n_cells(); ++c) fields.cells[0].values.push_back(double(c));
  write_morphed(input_, output_, mesh, morphed, fields);
  expect_same_but_coordinates(input_, output_);
  auto const tree = dump_tree(output_);
  Index first_cell = 0;
  for (auto const& zone : mesh.zones) {
    auto const nodes = "/Base/" + zone.name + "/MorphNodes", cells = "/Base/" + zone.name + "/MorphCells";
    EXPECT_EQ(payload(tree.at(nodes + "/GridLocation")), "Vertex");
    EXPECT_EQ(payload(tree.at(cells + "/GridLocation")), "CellCenter");
    auto const values = [&](std::string const& path) {
      auto const raw = payload(tree.at(path));
      std::vector<double> out(raw.size() / sizeof(double));
      std::memcpy(out.data(), raw.data(), raw.size());
      return out;
    };
    auto const dx = values(nodes + "/DisplacementX"), numbers = values(nodes + "/NodeNumber"),
               cell_numbers = values(cells + "/CellNumber");
    ASSERT_EQ(Index(dx.size()), zone.size());
    for (Index n = 0; n < zone.size(); ++n) {
      EXPECT_EQ(dx[n], morphed.x(zone.first_node + n) - mesh.coordinates.x(zone.first_node + n));
      EXPECT_EQ(numbers[n], double(zone.first_node + n));
    }
    ASSERT_EQ(Index(cell_numbers.size()), Index(zone.extent[0] - 1) * (zone.extent[1] - 1) * (zone.extent[2] - 1));
    EXPECT_EQ(cell_numbers.front(), double(first_cell));
    first_cell += Index(cell_numbers.size());
  }
  // Once more onto its own output: what is there stays, and what is added stands beside it.
  write_morphed(output_, output_, mesh, mesh.coordinates, fields);
  auto const twice = dump_tree(output_);
  EXPECT_EQ(twice.at("/Base/Zone 1/MorphNodes/DisplacementX"), tree.at("/Base/Zone 1/MorphNodes/DisplacementX"));
  EXPECT_TRUE(twice.contains("/Base/Zone 1/MorphNodes/MorphDisplacementX"));
  EXPECT_TRUE(twice.contains("/Base/Zone 1/MorphCells/MorphCellNumber"));
  EXPECT_FALSE(twice.contains("/Base/Zone 1/MorphNodes2"));
}

/// A solution as solvers write them: one array, with rind planes around it or without.
double add_solution(cgns::File& file, double zone, std::string const& name, char const* location,
                    std::vector<Index> const& sizes, std::vector<std::int32_t> const& rind = {}) {
  double const id = file.create(zone, name, "FlowSolution_t");
  file.create_text(id, "GridLocation", "GridLocation_t", location);
  if (!rind.empty()) file.create(id, "Rind", "Rind_t", "I4", {Index(rind.size())}, rind.data());
  std::size_t n = 1;
  for (Index const size : sizes) n *= std::size_t(size);
  std::vector<double> const values(n, 1.25);
  file.create(id, "Density", "DataArray_t", "R8", sizes, values.data());
  return id;
}

TEST_P(Formats, FieldsGoToTheSolutionsThatViewersShow) {
  Mesh const mesh = write_lattice(Lattice{{{{0, 3}, {0, 4}, {0, 3}}}});
  Index3 const e = mesh.zones[0].extent;
  {
    cgns::File file(input_, cgns::File::Mode::modify);
    auto const tree = file.tree();
    auto const* zone = tree.children.back().labelled("Zone_t");
    for (auto const& base : tree.children)
      if (base.label == "CGNSBase_t") zone = base.labelled("Zone_t");
    ASSERT_NE(zone, nullptr);
    std::vector<Index> const nodes{e[0], e[1], e[2]}, cells{e[0] - 1, e[1] - 1, e[2] - 1};
    double const part = add_solution(file, file.id(*zone), "Part", "CellCenter", {1, 1, 1});
    std::vector<std::int32_t> const range{1, 1, 1, 1, 1, 1};
    file.create(part, "PointRange", "IndexRange_t", "I4", {3, 2}, range.data());
    add_solution(file, file.id(*zone), "Flow", "CellCenter", {e[0] + 1, e[1], e[2] - 1}, {1, 1, 0, 1, 0, 0});
    add_solution(file, file.id(*zone), "Restart", "CellCenter", cells);
    add_solution(file, file.id(*zone), "Walls", "Vertex", nodes);
    auto const* grid = zone->labelled("GridCoordinates_t");
    ASSERT_NE(grid, nullptr);
    file.create_text(file.id(*grid->child("CoordinateX")), "DataClass", "DataClass_t", "Dimensional");
    file.close();
  }
  Coordinates const morphed = moved(mesh.coordinates);
  OutputFields fields;
  fields.displacement = true;
  fields.cells.push_back({"Number", {}});
  for (Index c = 0; c < mesh.n_cells(); ++c) fields.cells[0].values.push_back(double(c));
  fields.cells.push_back({"Angle", std::vector<double>(std::size_t(mesh.n_cells()), 30.0), FieldUnit::degree});
  write_morphed(input_, output_, mesh, morphed, fields);
  expect_same_but_coordinates(input_, output_);
  auto const tree = dump_tree(output_);
  std::string const zone = "/Base/" + mesh.zones[0].name;
  for (auto const* own : {"/MorphNodes", "/MorphCells"}) EXPECT_FALSE(tree.contains(zone + own)) << own;
  EXPECT_FALSE(tree.contains(zone + "/Restart/Number")) << "viewers show the first";
  EXPECT_EQ(payload(tree.at(zone + "/Flow/Number/DataClass")), "NondimensionalParameter");
  EXPECT_EQ(payload(tree.at(zone + "/Flow/Angle/DataClass")), "Dimensional");
  EXPECT_EQ(payload(tree.at(zone + "/Walls/DisplacementX/DataClass")), "Dimensional");
  EXPECT_TRUE(tree.contains(zone + "/Walls/DisplacementX/DimensionalExponents"));
  EXPECT_FALSE(tree.contains(zone + "/Walls/DisplacementY/DataClass")) << "the coordinate has none";
  // Every stored value, those of the rind from the cell beside it.
  auto const raw = payload(tree.at(zone + "/Flow/Number"));
  std::vector<double> stored(raw.size() / sizeof(double));
  std::memcpy(stored.data(), raw.data(), raw.size());
  ASSERT_EQ(Index(stored.size()), Index(e[0] + 1) * e[1] * (e[2] - 1));
  std::size_t n = 0;
  for (int k = 0; k < e[2] - 1; ++k)
    for (int j = 0; j < e[1]; ++j)
      for (int i = 0; i < e[0] + 1; ++i) {
        int const ci = std::clamp(i - 1, 0, e[0] - 2), cj = std::min(j, e[1] - 2);
        EXPECT_EQ(stored[n++], double(ci + (e[0] - 1) * (cj + Index(e[1] - 1) * k)));
      }
}

TEST_P(Formats, FieldsGoToTheSolutionThatTheFilePointsTo) {
  Mesh const mesh = write_lattice(Lattice{{{{0, 3}, {0, 4}, {0, 3}}}});
  Index3 const e = mesh.zones[0].extent;
  {
    cgns::File file(input_, cgns::File::Mode::modify);
    auto const tree = file.tree();
    for (auto const& base : tree.children) {
      if (base.label != "CGNSBase_t") continue;
      double const zone = file.id(*base.labelled("Zone_t"));
      for (char const* name : {"Initial", "Step1", "Step2"})
        add_solution(file, zone, name, "CellCenter", {e[0] - 1, e[1] - 1, e[2] - 1});
      double const iterative = file.create(zone, "ZoneIterativeData", "ZoneIterativeData_t");
      std::string names = "Step1";
      names.resize(32, ' ');
      names += "Step2";
      names.resize(64, ' ');
      file.create(iterative, "FlowSolutionPointers", "DataArray_t", "C1", {32, 2}, names.data());
    }
    file.close();
  }
  OutputFields fields;
  fields.cells.push_back({"Number", std::vector<double>(std::size_t(mesh.n_cells()), 1.0)});
  write_morphed(input_, output_, mesh, moved(mesh.coordinates), fields);
  auto const tree = dump_tree(output_);
  std::string const zone = "/Base/" + mesh.zones[0].name;
  EXPECT_TRUE(tree.contains(zone + "/Step1/Number"));
  EXPECT_TRUE(tree.contains(zone + "/Step2/Number"));
  EXPECT_FALSE(tree.contains(zone + "/Initial/Number"));
}

TEST_P(Formats, OutputMayBeTheInput) {
  Mesh const mesh = write_lattice(brick_);
  Coordinates const morphed = moved(mesh.coordinates);
  write_morphed(input_, input_, mesh, morphed);
  expect_same_coordinates(read_mesh(input_).coordinates, morphed);
  EXPECT_EQ(folder_.names().size(), 1U);
}

TEST_P(Formats, ReadOnlyInputsGiveWritableOutputs) {
  Mesh const mesh = write_lattice(brick_);
  ASSERT_EQ(chmod(input_.c_str(), 0444), 0);
  write_morphed(input_, output_, mesh, mesh.coordinates);
  struct stat status {};
  ASSERT_EQ(stat(output_.c_str(), &status), 0);
  EXPECT_NE(status.st_mode & S_IWUSR, 0U);
}

TEST_P(Formats, AnotherFileThanTheMeshCameFromIsRefused) {
  Mesh mesh = write_lattice(brick_);
  mesh.zones[1].name = "Other";
  auto const message = message_of<IoError>([&] { write_morphed(input_, output_, mesh, mesh.coordinates); });
  EXPECT_NE(message.find("Other"), std::string::npos) << message;
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"in.cgns"});
}

TEST_P(Formats, NonFiniteCoordinatesAreNotWritten) {
  Mesh const mesh = write_lattice(brick_);
  Coordinates const morphed = copy_of(mesh.coordinates);
  morphed.y(7) = std::nan("");
  auto const message = message_of<MeshError>([&] { write_morphed(input_, output_, mesh, morphed); });
  EXPECT_NE(message.find("1 node of zone 'Zone 1'"), std::string::npos) << message;
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"in.cgns"});
}

TEST_P(Formats, AFullDiskIsNoticedAndLeavesNothingBehind) {
  Mesh const mesh = write_lattice(brick_);
  auto const size = rlim_t(std::filesystem::file_size(input_));
  write_bytes(output_, "precious");
  OutputFields fields;
  fields.displacement = true;
  fields.nodes.push_back({"Large", std::vector<double>(std::size_t(mesh.n_nodes()), 1.0)});
  // At the first limits the copy fails, at the later ones the fields that are added to it.
  for (rlim_t const limit : {rlim_t(1), size / 2, size - 1, size, size + 512, size + 4096, size + 8192}) {
    SCOPED_TRACE(limit);
    std::string message;
    {
      FileSizeLimit const full(limit);
      message = message_of<MachineError>([&] { write_morphed(input_, output_, mesh, mesh.coordinates, fields); });
    }
    EXPECT_NE(message.find("cannot be"), std::string::npos) << message;
    EXPECT_EQ(bytes_of(output_), "precious");
    EXPECT_EQ(folder_.names().size(), 2U);
  }
  // And the library is still in order afterwards.
  write_morphed(input_, output_, mesh, mesh.coordinates, fields);
  expect_same_coordinates(read_mesh(output_).coordinates, mesh.coordinates);
}

TEST_P(Formats, AFullDiskStopsNewFilesToo) {
  Mesh const mesh = LatticeBuilder(brick_, 4).build();
  write_mesh(input_, mesh, {.format = GetParam()});
  auto const size = rlim_t(std::filesystem::file_size(input_));
  for (rlim_t limit = 0; limit < size; limit += std::max<rlim_t>(1, size / 17)) {
    SCOPED_TRACE(limit);
    {
      FileSizeLimit const full(limit);
      EXPECT_THROW(write_mesh(output_, mesh, {.format = GetParam()}), MachineError);
    }
    EXPECT_EQ(folder_.names().size(), 1U);
  }
}

TEST_P(Formats, MissingFoldersAreNamed) {
  Mesh const mesh = write_lattice(brick_);
  auto const message =
      message_of<IoError>([&] { write_morphed(input_, folder_.file("no/such/out.cgns"), mesh, mesh.coordinates); });
  EXPECT_NE(message.find("there is no folder"), std::string::npos) << message;
}

}  // namespace
}  // namespace gridmorph::test
