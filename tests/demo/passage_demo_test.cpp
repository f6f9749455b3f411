#include "passage_checks.hpp"

#include <generators/passage_demo.hpp>
#include <gridmorph/case/case_file.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

namespace {

using namespace passage_checks;

class PassageDemo : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove_all(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) /
      (std::string("gridmorph_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

std::map<std::array<double, 3>, Vec3> read_csv(std::filesystem::path const& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "x,y,z,dx,dy,dz");
  std::map<std::array<double, 3>, Vec3> rows;
  while (std::getline(file, line)) {
    std::array<double, 6> v{};
    std::istringstream row(line);
    std::string cell;
    for (double& value : v) {
      std::getline(row, cell, ',');
      value = std::strtod(cell.c_str(), nullptr);
    }
    EXPECT_TRUE(rows.insert({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}}).second) << "twice: " << line;
  }
  return rows;
}

TEST_F(PassageDemo, CsvHoldsEveryBladeNodeOnceAndReadsBackExactly) {
  PassageOptions const options = small();
  Mesh const mesh = make_passage(options);
  std::filesystem::create_directories(folder);
  auto const displacement = [&](Vec3 const& p) { return passage_displacement(options, rotated_sections(), p); };
  write_displacement_csv((folder / "blade.csv").string(), mesh, {"blade"}, displacement);
  auto rows = read_csv(folder / "blade.csv");
  std::size_t const n_rows = rows.size();
  std::map<std::array<double, 3>, Vec3> nodes;
  for (auto const& patch : mesh.patches) {
    if (patch.families.front() != "blade") continue;
    for_each_node(patch.range, [&](Index3 const& at) {
      Vec3 const p = node(mesh, patch.zone, at);
      nodes[{p.x, p.y, p.z}] = displacement(p);
    });
  }
  EXPECT_EQ(n_rows, nodes.size());
  for (auto const& [point, d] : nodes) {
    ASSERT_TRUE(rows.count(point));
    EXPECT_TRUE(rows[point] == d);
  }
}

TEST_F(PassageDemo, UnknownFamilyAndUnwritableFilesAreErrors) {
  Mesh const mesh = make_passage(small());
  auto const zero = [](Vec3 const&) { return Vec3{}; };
  EXPECT_THROW(write_displacement_csv((folder / "x.csv").string(), mesh, {"wing"}, zero), MeshError);
  EXPECT_THROW(write_displacement_csv((folder / "missing" / "x.csv").string(), mesh, {"blade"}, zero), MachineError);
}

TEST_F(PassageDemo, WritesAMeshThatReadsBackBitForBit) {
  PassageOptions options = small();
  options.layout = PassageOptions::Layout::five_zones;
  Mesh const mesh = make_passage(options);
  PassageFiles const files = write_passage_demo(folder, options, chord_redesign());
  Mesh const back = read_mesh(files.mesh.string());
  ASSERT_EQ(back.n_nodes(), mesh.n_nodes());
  ASSERT_EQ(back.zones.size(), mesh.zones.size());
  for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
    int const other = zone_named(back, mesh.zones[z].name);
    ASSERT_GE(other, 0) << mesh.zones[z].name;
    ASSERT_EQ(back.zones[other].extent, mesh.zones[z].extent);
    for_each_node({{0, 0, 0}, mesh.zones[z].extent},
                  [&](Index3 const& p) { ASSERT_TRUE(node(back, other, p) == node(mesh, int(z), p)); });
  }
  EXPECT_EQ(back.patches.size(), mesh.patches.size());
  EXPECT_EQ(back.interfaces.size(), mesh.interfaces.size());
}

TEST_F(PassageDemo, CaseFileIsUnderstoodAndGivesEveryPatchOneRule) {
  PassageOptions options = small();
  options.placement = skew_placement();
  Mesh const mesh = make_passage(options);
  PassageFiles const files = write_passage_demo(folder, options, rotated_sections(), mesh, MeshFile::write);
  CaseFile const case_file = read_case_file(files.case_file);
  EXPECT_EQ(case_file.input, files.mesh);
  EXPECT_EQ(case_file.output, files.morphed);
  ASSERT_TRUE(case_file.axis);
  EXPECT_TRUE(case_file.axis->origin == options.placement.translation);
  EXPECT_LT(norm(case_file.axis->direction - options.placement.rotation * Vec3{1, 0, 0}), 1e-15);
  ResolvedMotion const motion = resolve(mesh, case_file.motion);
  for (auto const& patch : motion.patch) EXPECT_FALSE(patch.by_default);
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i)
    EXPECT_EQ(motion.interface[i].rule >= 0, bool(mesh.interfaces[i].periodic)) << mesh.interfaces[i].name;
}

TEST_F(PassageDemo, SecondMotionSharesTheMeshFile) {
  PassageOptions const options = small();
  Mesh const mesh = make_passage(options);
  PassageFiles const first = write_passage_demo(folder, options, rotated_sections(), mesh, MeshFile::write);
  auto const written = std::filesystem::last_write_time(first.mesh);
  PassageFiles const second = write_passage_demo(folder, options, chord_redesign(), mesh, MeshFile::keep);
  EXPECT_EQ(first.mesh, second.mesh);
  EXPECT_EQ(std::filesystem::last_write_time(second.mesh), written);
  for (auto const& file : {first.displacement, second.displacement, first.case_file, second.case_file})
    EXPECT_TRUE(std::filesystem::exists(file)) << file;
  EXPECT_NE(first.displacement, second.displacement);
  EXPECT_NE(first.morphed, second.morphed);
}

}  // namespace
