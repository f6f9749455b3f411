// Runs `gridmorph wheel` in a folder of its own.
#pragma once

#include "support/temporary_folder.hpp"
#include "wheel/wheel_file.hpp"

#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/wheel/turn.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include <sys/wait.h>

namespace gridmorph::test {

struct CylindricalPoint {
  double axial, radius, angle;
};

/// About the x axis.
inline CylindricalPoint cylindrical(Vec3 const& p) { return {p.x, std::hypot(p.y, p.z), std::atan2(p.z, p.y)}; }

/// Ends and sides of a row go along with its blade.
inline std::string const row_followers = R"(
[[motion]]
patches = ["inlet", "outlet"]
rule    = "circumferential-slide"
of      = "blade"
[[motion]]
patches = "type:periodic"
rule    = "follow"
of      = "blade"
)";

/// All but the blade of the demo passage goes along with it.
inline std::string const followers = row_followers + R"(
[[motion]]
patches = ["hub", "case"]
rule    = "slip"
surface = "revolution"
)";

/// The blade of the demo passage turns and shifts along the axis; the rest goes along.
inline std::string const demo_rules = R"(
[[motion]]
patches = "blade"
rule    = "formula"
dtheta  = "0.06 * sin(axial / 0.05) + 0.1 * axial"
daxial  = "0.1 * (r - 0.12) * axial"
)" + followers;

class WheelTest : public ::testing::Test {
 protected:
  [[nodiscard]] int gridmorph(std::string const& arguments) const {
    std::string const line = "cd '" + folder.file("") + "' && '" GRIDMORPH_EXECUTABLE "' " + arguments + " >out 2>err";
    int const code = std::system(line.c_str());
    return WIFEXITED(code) ? WEXITSTATUS(code) : 128 + WTERMSIG(code);
  }
  [[nodiscard]] std::string text(std::string const& name) const { return bytes_of(folder / name); }

  /// Appends [wheel] to a case file of the folder and makes the wheel.
  WheelFile wheel(std::string const& case_file, std::string const& keys, int status = 0) const {
    folder.write("wheel.toml", text(case_file) + "\n[wheel]\noutput = \"wheel.cgns\"\n" + keys);
    std::filesystem::remove(folder / "wheel.cgns");
    EXPECT_EQ(gridmorph("wheel wheel.toml"), status) << text("out") << text("err");
    return WheelFile(folder.file("wheel.cgns"));
  }
  /// The message of a wheel that is refused; nothing is left behind.
  std::string refusal(std::string const& case_text, std::string const& keys) const {
    folder.write("wheel.toml", case_text + "\n[wheel]\noutput = \"wheel.cgns\"\n" + keys);
    auto const before = folder.names().size();
    EXPECT_EQ(gridmorph("wheel wheel.toml"), 2) << text("out");
    EXPECT_FALSE(std::filesystem::exists(folder / "wheel.cgns"));
    EXPECT_LE(folder.names().size(), before + 2);  // out and err, unless they were there
    return text("err");
  }

  /// The largest distance between passage p of a wheel, turned back, and a mesh of one passage.
  template <class File>
  static double distance_from(File const& wheel, int p, int of, Mesh const& passage) {
    double worst = 0;
    for (auto const& zone : passage.zones) {
      FileZone const& copy = wheel.zones.at(name(zone.name, p));
      for (Index n = 0; n < zone.size(); ++n)
        worst = std::max(worst, distance(Turn(Axis{}, -p, of)(copy.at(n)), passage.coordinates[zone.first_node + n]));
    }
    return worst;
  }
  /// The same between passage p of one wheel and passage q of another.
  template <class File>
  static double distance_between(File const& a, int p, File const& b, int q, int of) {
    double worst = 0;
    std::string const end = name("", p);
    for (auto const& [zone_name, zone] : a.zones) {
      if (!zone_name.ends_with(end)) continue;
      FileZone const& other = b.zones.at(name(zone_name.substr(0, zone_name.size() - end.size()), q));
      for (std::size_t n = 0; n < zone.x.size(); ++n)
        worst = std::max(worst, distance(Turn(Axis{}, -p, of)(zone.at(n)), Turn(Axis{}, -q, of)(other.at(n))));
    }
    return worst;
  }
  static std::string name(std::string const& zone, int p) {
    return zone + (p < 9 ? "_P0" : "_P") + std::to_string(p + 1);
  }

  TemporaryFolder folder;
};

}  // namespace gridmorph::test
