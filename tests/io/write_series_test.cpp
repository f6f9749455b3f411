// Meshes over time in one file, read back with the CGNS library itself.
#include "io_support.hpp"
#include "support/file_size_limit.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/write_series.hpp>

#include <cgnslib.h>

namespace gridmorph::test {
namespace {

Coordinates at_step(Mesh const& mesh, int step) {
  Coordinates out(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    out.set(n, {p.x + 0.01 * step, p.y * (1 + 0.1 * step), p.z - 1e-9 * step});
  }
  return out;
}

std::vector<double> times_of(int steps) {
  std::vector<double> times;
  for (int s = 0; s < steps; ++s) times.push_back(0.25 * s);
  return times;
}

void write_steps(std::string const& input, std::string const& output, Mesh const& mesh, int steps) {
  SeriesWriter writer(input, output, mesh, times_of(steps));
  for (int s = 0; s < steps; ++s) writer.add(at_step(mesh, s));
  writer.commit();
}

/// A file of several small zones.
std::string small_file(TemporaryFolder const& folder) {
  auto const path = folder.file("in.cgns");
  write_mesh(path, read_mesh(shared_mesh("water_turbine.cgns")));
  return path;
}

TEST(WriteSeries, TheCgnsLibraryReadsEveryStep) {
  TemporaryFolder const folder;
  auto const in = small_file(folder), out = folder.file("out.cgns");
  Mesh const mesh = read_mesh(in);
  int const steps = 12;
  write_steps(in, out, mesh, steps);

  int file = 0, n_steps = 0, n_zones = 0;
  char name[33];
  ASSERT_EQ(cg_open(out.c_str(), CG_MODE_READ, &file), CG_OK);
  ASSERT_EQ(cg_biter_read(file, 1, name, &n_steps), CG_OK);
  EXPECT_EQ(n_steps, steps);
  ASSERT_EQ(cg_goto(file, 1, "BaseIterativeData_t", 1, "end"), CG_OK);
  std::vector<double> times(steps);
  int arrays = 0;
  ASSERT_EQ(cg_narrays(&arrays), CG_OK);
  for (int a = 1; a <= arrays; ++a) {
    CGNS_ENUMT(DataType_t) type;
    int rank = 0;
    cgsize_t size[12];
    ASSERT_EQ(cg_array_info(a, name, &type, &rank, size), CG_OK);
    if (std::string(name) != "TimeValues") continue;
    ASSERT_EQ(cg_array_read(a, times.data()), CG_OK);
  }
  EXPECT_EQ(times, times_of(steps));
  CGNS_ENUMT(SimulationType_t) simulation;
  ASSERT_EQ(cg_simulation_type_read(file, 1, &simulation), CG_OK);
  EXPECT_EQ(simulation, CGNS_ENUMV(TimeAccurate));

  ASSERT_EQ(cg_nzones(file, 1, &n_zones), CG_OK);
  ASSERT_EQ(n_zones, int(mesh.zones.size()));
  for (int z = 1; z <= n_zones; ++z) {
    ASSERT_EQ(cg_ziter_read(file, 1, z, name), CG_OK);
    ASSERT_EQ(cg_goto(file, 1, "Zone_t", z, "ZoneIterativeData_t", 1, "end"), CG_OK);
    std::string pointers(std::size_t(32 * steps), '\0');
    ASSERT_EQ(cg_array_read(1, pointers.data()), CG_OK);
    Zone const* zone = nullptr;
    char zone_name[33];
    cgsize_t size[9];
    ASSERT_EQ(cg_zone_read(file, 1, z, zone_name, size), CG_OK);
    for (auto const& candidate : mesh.zones)
      if (candidate.name == zone_name) zone = &candidate;
    ASSERT_NE(zone, nullptr);
    for (int s = 0; s < steps; ++s) {
      std::string grid = pointers.substr(std::size_t(32 * s), 32);
      grid.resize(grid.find_last_not_of(' ') + 1);
      ASSERT_EQ(cg_goto(file, 1, "Zone_t", z, grid.c_str(), 0, "end"), CG_OK) << grid;
      std::vector<double> y(zone->size());
      ASSERT_EQ(cg_array_read_as(2, CGNS_ENUMV(RealDouble), y.data()), CG_OK);
      Coordinates const wanted = at_step(mesh, s);
      for (Index n = 0; n < zone->size(); ++n) ASSERT_EQ(y[n], wanted.y(zone->first_node + n));
    }
  }
  cg_close(file);
}

TEST(WriteSeries, EverythingOfTheInputComesThroughAndTheBaselineStaysTheFirstGrid) {
  TemporaryFolder const folder;
  for (auto const* name : {"axial_turbine_stage_H.cgns", "slotted_airfoil.cgns", "multi.cgns", "rotorstator.cgns"}) {
    auto const path = shared_mesh(name);
    if (path.empty()) continue;
    Mesh const mesh = read_mesh(path);
    auto const out = folder.file(name);
    write_steps(path, out, mesh, 2);
    auto const before = dump_tree(path), after = dump_tree(out);
    for (auto const& [node, content] : before) {
      if (node.find("IterativeData") != std::string::npos || node.find("TimeIterValues") != std::string::npos)
        continue;  // a series of a single step in multi.cgns gives way
      ASSERT_TRUE(after.contains(node)) << name << node;
      EXPECT_EQ(after.at(node), content) << name << node;
    }
    expect_same_coordinates(read_mesh(out).coordinates, mesh.coordinates);
  }
}

TEST(WriteSeries, KeepsThePrecisionOfTheZone) {
  TemporaryFolder const folder;
  Mesh mesh = read_mesh(shared_mesh("water_turbine.cgns"));
  for (auto& zone : mesh.zones) zone.single_precision = true;
  write_mesh(folder.file("in.cgns"), mesh);
  mesh = read_mesh(folder.file("in.cgns"));
  write_steps(folder.file("in.cgns"), folder.file("out.cgns"), mesh, 3);
  int found = 0;
  for (auto const& [node, content] : dump_tree(folder.file("out.cgns")))
    if (node.find("/GridCoordinates_2/CoordinateX") != std::string::npos) {
      EXPECT_NE(content.find("|R4|"), std::string::npos) << node;
      ++found;
    }
  EXPECT_EQ(found, int(mesh.zones.size()));
}

TEST(WriteSeries, NothingIsLeftWithoutCommitOrWhenAStepFails) {
  TemporaryFolder const folder;
  auto const in = small_file(folder), out = folder.file("out.cgns");
  Mesh const mesh = read_mesh(in);
  {
    SeriesWriter writer(in, out, mesh, times_of(3));
    writer.add(at_step(mesh, 0));
    Coordinates broken = at_step(mesh, 1);
    broken.y(7) = std::nan("");
    EXPECT_NE(message_of<MeshError>([&] { writer.add(broken); }).find("step 2 of the series"), std::string::npos);
    EXPECT_NE(message_of<MeshError>([&] { writer.commit(); }).find("1 of 3 steps"), std::string::npos);
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"in.cgns"});
}

TEST(WriteSeries, RefusesFilesThatHoldASeriesAlready) {
  TemporaryFolder const folder;
  auto const in = small_file(folder), out = folder.file("out.cgns");
  Mesh const mesh = read_mesh(in);
  write_steps(in, out, mesh, 2);
  auto const message = message_of<IoError>([&] { SeriesWriter(out, folder.file("again.cgns"), mesh, times_of(2)); });
  EXPECT_NE(message.find("holds a time series already"), std::string::npos) << message;
  EXPECT_FALSE(std::filesystem::exists(folder.path("again.cgns")));
}

TEST(WriteSeries, ADiskThatIsFullIsKnownBeforeTheFirstStep) {
  TemporaryFolder const folder;
  auto const in = small_file(folder);
  Mesh const mesh = read_mesh(in);
  auto const room = std::filesystem::file_size(in) + 100000;
  {
    FileSizeLimit const limit(room);
    EXPECT_THROW(SeriesWriter(in, folder.file("out.cgns"), mesh, times_of(50)), MachineError);
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"in.cgns"});
}

}  // namespace
}  // namespace gridmorph::test
