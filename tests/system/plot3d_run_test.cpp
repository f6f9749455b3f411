// PLOT3D meshes on the command line: inspect finds what the file does not say, and morph moves them as it moves CGNS
// meshes.
#include "run_command.hpp"
#include "support/plot3d_file.hpp"
#include "support/temporary_folder.hpp"

#include <gridmorph/io/mesh_io.hpp>

#include <algorithm>

namespace gridmorph::test {
namespace {

class Plot3dRun : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    mesh_ = read_mesh(path("passage.cgns").string());
  }

  /// The passage mesh as a PLOT3D file with the patches of the CGNS file in its side file.
  void write_plot3d(test::Plot3dStorage const& storage, std::string const& top = "") const {
    test::write_bytes(path("passage.p3d"), test::Plot3dFile(storage).bytes(mesh_));
    std::string text = top + "zone_names = [";
    for (auto const& zone : mesh_.zones) text += "\"" + zone.name + "\", ";
    text += "]\n";
    for (auto const& patch : mesh_.patches) {
      text += "[[patch]]\nname = \"" + patch.name + "\"\nkind = \"" + std::string(to_string(patch.kind)) +
              "\"\nzone = \"" + mesh_.zones[patch.zone].name + "\"\nfamily = \"" + patch.families.at(0) + "\"\n";
      auto const node = [](Index3 const& p) {
        return "[" + std::to_string(p[0]) + ", " + std::to_string(p[1]) + ", " + std::to_string(p[2]) + "]";
      };
      auto const& b = patch.range.begin;
      text += "range = [" + node({b[0] + 1, b[1] + 1, b[2] + 1}) + ", " + node(patch.range.end) + "]\n";
    }
    write("passage.toml", text);
  }

  Mesh mesh_;
};

TEST_F(Plot3dRun, MovesToTheBitAsTheCgnsMeshDoes) {
  ASSERT_EQ(gridmorph("morph rotation.toml -o moved.cgns").status, 0);
  Mesh const expected = read_mesh(path("moved.cgns").string());
  std::string text = contents(path("rotation.toml"));
  text.replace(text.find("\"passage.cgns\""), 14, "\"passage.p3d\"");
  write("p3d.toml", text);
  test::Plot3dStorage formatted, binary;
  formatted.kind = 'f';
  binary.kind = 'b';
  binary.big = binary.blank = true;
  for (auto const& storage : {test::Plot3dStorage{}, formatted, binary}) {
    write_plot3d(storage);
    Outcome const found = gridmorph("inspect passage.p3d --write-side-file found.toml");
    ASSERT_EQ(found.status, 0) << found.err;
    std::filesystem::rename(path("found.toml"), path("passage.toml"));
    Outcome const run = gridmorph("morph p3d.toml -o moved.p3d");
    ASSERT_EQ(run.status, 0) << run.err;
    Mesh const moved = read_mesh(path("moved.p3d").string());
    for (Index n = 0; n < expected.n_nodes(); ++n)
      ASSERT_EQ(moved.coordinates[n], expected.coordinates[n]) << storage.name() << " " << describe_node(expected, n);
  }
}

/// A grid file has no place for fields, so that stages are CGNS files with the patches and interfaces that the side
/// file gives.
TEST_F(Plot3dRun, StagesAreCgnsFiles) {
  write_plot3d({});
  ASSERT_EQ(gridmorph("inspect passage.p3d --write-side-file found.toml").status, 0);
  std::filesystem::rename(path("found.toml"), path("passage.toml"));
  std::string text = contents(path("rotation.toml"));
  text.replace(text.find("\"passage.cgns\""), 14, "\"passage.p3d\"");
  write("p3d.toml", text + "\n[output]\nstages = \"stages\"\n");
  Outcome const run = gridmorph("morph p3d.toml -o moved.p3d");
  ASSERT_EQ(run.status, 0) << run.err;
  Mesh const moved = read_mesh(path("moved.p3d").string());
  std::filesystem::path last;
  for (auto const& entry : std::filesystem::directory_iterator(path("stages")))
    if (entry.path().extension() == ".cgns") last = std::max(last, entry.path());
  Mesh const stage = read_mesh(last.string());
  EXPECT_EQ(stage.interfaces.empty(), false);
  ASSERT_EQ(stage.n_nodes(), moved.n_nodes());
  for (Index n = 0; n < moved.n_nodes(); ++n) ASSERT_EQ(stage.coordinates[n], moved.coordinates[n]);
}

TEST_F(Plot3dRun, TheSideFileOfABareMeshMakesItWhole) {
  test::write_bytes(path("bare.p3d"), test::Plot3dFile({}).bytes(mesh_));
  Outcome const before = gridmorph("inspect bare.p3d");
  EXPECT_EQ(before.status, 0) << before.err;
  EXPECT_NE(before.out.find("--write-side-file"), std::string::npos);
  Outcome const found = gridmorph("inspect bare.p3d --write-side-file bare.toml");
  EXPECT_EQ(found.status, 0) << found.err;
  EXPECT_NE(found.out.find("rotation of 10 degrees"), std::string::npos);
  Outcome const suggested = gridmorph("inspect bare.p3d --suggest case.toml");
  EXPECT_EQ(suggested.status, 0) << suggested.err;
  Outcome const run = gridmorph("morph case.toml");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(contents(path("bare_morphed.p3d")), contents(path("bare.p3d")));
  EXPECT_EQ(gridmorph("inspect bare.p3d").out.find("Problems"), std::string::npos);
}

TEST_F(Plot3dRun, SolutionsHaveNoPlaceInAGridFile) {
  write_plot3d({});
  write("case.toml",
        "[mesh]\ninput = \"passage.p3d\"\noutput = \"out.p3d\"\nopen_faces = \"open\"\n"
        "[[motion]]\npatches = \"blade\"\nrule = \"fixed\"\n[output]\nquality = true\n");
  expect_bad_input(gridmorph("morph case.toml"), {"case.toml", "PLOT3D", "quality"});
}

TEST_F(Plot3dRun, ProblemsOfTheSideFileAreReportedWithTheirLines) {
  write_plot3d({}, "formatt = 1\n");
  expect_bad_input(gridmorph("inspect passage.p3d"), {"passage.toml:1", "unknown key 'formatt'", "format"});
  write_plot3d({}, "format = \"formatted\"\n");
  expect_bad_input(gridmorph("inspect passage.p3d"), {"passage.p3d"});
}

}  // namespace
}  // namespace gridmorph::test
