// Runs one example in a folder of its own and keeps both meshes.
#pragma once

#include "examples/reference.hpp"
#include "support/shared_mesh.hpp"

#include <gridmorph/io/mesh_io.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include <sys/wait.h>

namespace gridmorph::test {

inline std::string contents(std::filesystem::path const& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

struct Cylindrical {
  double axial, r, theta;
};

/// About a coordinate axis; theta is right-handed and zero along the next axis of the cycle x, y, z.
inline Cylindrical cylindrical(Vec3 const& p, int axis) {
  double const c[3] = {p.x, p.y, p.z};
  double const b = c[(axis + 1) % 3], d = c[(axis + 2) % 3];
  return {c[axis], std::hypot(b, d), std::atan2(d, b)};
}

/// Angle in (-pi, pi].
inline double wrapped(double angle) { return std::remainder(angle, 2 * std::acos(-1.0)); }

class Example : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "gridmorph-examples-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Exit status of a shell command; what it printed is in the files out and err of the test's folder.
  [[nodiscard]] int shell(std::string const& command) const {
    std::string const line = "{ " + command + "; } >'" + path("out") + "' 2>'" + path("err") + "'";
    int const code = std::system(line.c_str());
    return WIFEXITED(code) ? WEXITSTATUS(code) : 128 + WTERMSIG(code);
  }
  /// Some meshes are made by Gmsh, which is no part of what gridmorph needs.
  [[nodiscard]] bool has_gmsh() const { return shell("command -v gmsh") == 0; }
  [[nodiscard]] std::string path(std::string const& name) const { return (folder_ / name).string(); }
  /// meshes: folder of meshes that are used instead of their stand-ins; none: "".
  [[nodiscard]] std::string run_command(std::string const& meshes, std::string const& name) const {
    return "GRIDMORPH_MESHES= '" GRIDMORPH_EXAMPLES "/run' --gridmorph '" GRIDMORPH_EXECUTABLE "' --meshes '" + meshes +
           "' --out '" + folder_.string() + "' " + name;
  }
  /// Where examples/run puts the mesh of an example: beside its case file if it is made, in a folder "meshes" if it is
  /// the project's.
  [[nodiscard]] std::string mesh_of(std::string const& name, std::string const& mesh) const {
    auto const made = path(name + "/" + mesh);
    return std::filesystem::exists(made) ? made : path(name + "/meshes/" + mesh);
  }
  /// The project's meshes where a case file in the test's folder looks for them.
  void link_meshes() const { std::filesystem::create_directory_symlink(GRIDMORPH_EXAMPLES "/meshes", path("meshes")); }

  /// Runs the example: done, nothing inverted, and where it was before.
  void run(std::string const& name) const {
    int const status = shell(run_command(meshes_, name));
    ASSERT_EQ(status, 0) << contents(path("out")) << contents(path("err")) << contents(path(name + "/log.txt"));
    auto const report = nlohmann::json::parse(contents(path(name + "/" + name + ".json")));
    for (auto const* region : {"near_field", "far_field"})
      EXPECT_EQ(report["morphed"][region]["inverted"], 0) << region;
    for (std::string const ending : {".cgns", ".su2"})
      if (auto const made = path(name + "/" + name + "_morphed" + ending);
          meshes_.empty() && std::filesystem::exists(made))
        expect_as_before(name, read_mesh(made));
  }

  /// Morphs and checks what holds for every structured example: run(), interfaces closed as before.
  void morph(std::string const& name, std::string const& mesh) {
    ASSERT_NO_FATAL_FAILURE(run(name));
    before = read_mesh(mesh_of(name, mesh));
    after = read_mesh(path(name + "/" + name + "_morphed.cgns"));
    ASSERT_EQ(before.n_nodes(), after.n_nodes());
    expect_interfaces_closed();
  }

  /// Copies that coincide in the baseline do so bit for bit afterwards; others keep their distance to round-off, a
  /// share of the size.
  void expect_interfaces_closed(double round_off = 1e-14) const {
    for (auto const& link : before.interfaces) {
      if (link.periodic) continue;
      for_nodes(before.zones[link.zone], link.range, [&](Index own, Index3 const& p) {
        Index const donor = before.zones[link.donor_zone].node(link.to_donor(p));
        Vec3 const gap = before.coordinates[own] - before.coordinates[donor];
        Vec3 const gap_after = after.coordinates[own] - after.coordinates[donor];
        if (gap == Vec3{0, 0, 0}) {
          EXPECT_TRUE(gap_after == gap) << link.name << " " << describe_node(before, own);
        } else {
          EXPECT_LT(distance(gap, gap_after), round_off * before.size())
              << link.name << " " << describe_node(before, own);
        }
      });
    }
  }

  /// Both copies of a rotational-periodic node move alike, whatever the pitch.
  void expect_periodic_copies_move_alike(int axis) const {
    Index checked = 0;
    for (auto const& link : before.interfaces) {
      if (!link.periodic) continue;
      for_nodes(before.zones[link.zone], link.range, [&](Index own, Index3 const& p) {
        Index const donor = before.zones[link.donor_zone].node(link.to_donor(p));
        Cylindrical const a = motion(own, axis), b = motion(donor, axis);
        double const tolerance = 1e-12 * before.size();
        EXPECT_NEAR(a.axial, b.axial, tolerance) << describe_node(before, own);
        EXPECT_NEAR(a.r, b.r, tolerance) << describe_node(before, own);
        EXPECT_NEAR(a.theta, b.theta, 1e-12) << describe_node(before, own);
        ++checked;
      });
    }
    EXPECT_GT(checked, 0);
  }

  /// Change of axial position, radius and angle.
  [[nodiscard]] Cylindrical motion(Index n, int axis) const {
    Cylindrical const a = cylindrical(before.coordinates[n], axis), b = cylindrical(after.coordinates[n], axis);
    return {b.axial - a.axial, b.r - a.r, wrapped(b.theta - a.theta)};
  }

  static void for_nodes(Zone const& zone, IndexRange const& range,
                        std::function<void(Index, Index3 const&)> const& visit) {
    for (int k = range.begin[2]; k < range.end[2]; ++k)
      for (int j = range.begin[1]; j < range.end[1]; ++j)
        for (int i = range.begin[0]; i < range.end[0]; ++i) visit(zone.node({i, j, k}), {i, j, k});
  }
  /// Nodes of the patches of a family, or of a BC name, in one zone or in all.
  Index for_patch(std::string const& name, std::string const& zone, std::function<void(Index)> const& visit) const {
    Index count = 0;
    for (auto const& patch : before.patches) {
      bool const named = patch.name == name || (!patch.families.empty() && patch.families.front() == name);
      if (!named || (!zone.empty() && before.zones[patch.zone].name != zone)) continue;
      for_nodes(before.zones[patch.zone], patch.range, [&](Index n, Index3 const&) { visit(n), ++count; });
    }
    EXPECT_GT(count, 0) << name;
    return count;
  }
  /// Every node of a patch moves by `wanted` of its baseline position, to round-off of the mesh size.
  void expect_motion(std::string const& name, std::string const& zone,
                     std::function<Vec3(Vec3 const&)> const& wanted) const {
    double worst = 0;
    for_patch(name, zone, [&](Index n) {
      Vec3 const x = before.coordinates[n];
      worst = std::max(worst, distance(after.coordinates[n], x + wanted(x)));
    });
    EXPECT_LT(worst, 1e-14 * before.size()) << name;
  }
  void expect_fixed(std::string const& name, std::string const& zone = "") const {
    for_patch(name, zone, [&](Index n) { EXPECT_TRUE(after.coordinates[n] == before.coordinates[n]); });
  }

  std::string meshes_;  ///< as run_command() has it
  std::filesystem::path folder_;
  Mesh before, after;
};

/// Examples whose mesh is a stand-in: with that, and with the mesh it stands in for where that is there.
template <class Base>
class StandInTest : public Base, public ::testing::WithParamInterface<bool> {
 protected:
  void SetUp() override {
    Base::SetUp();
    if (GetParam()) return;
    // Any of them tells where they are.
    for (auto const* file : {"axialTurbine_7blk.cgns", "multi.cgns", "HeatingCoil.cgns"})
      if (auto const found = test::shared_mesh(file); !found.empty())
        this->meshes_ = std::filesystem::path(found).parent_path().string();
    if (this->meshes_.empty()) GTEST_SKIP() << "the mesh itself is not there; its stand-in is tested";
  }
};
inline std::string stand_in_or_not(::testing::TestParamInfo<bool> const& info) {
  return info.param ? "stand_in" : "of_others";
}

}  // namespace gridmorph::test
