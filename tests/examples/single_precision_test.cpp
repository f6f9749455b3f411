// Every example with its mesh in single precision, as many meshers and solvers hand meshes over: what runs in double
// precision runs.
#include "example_run.hpp"
#include "support/reduced.hpp"

#include <limits>
#include <regex>
#include <vector>

namespace gridmorph::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> all_examples() {
  std::vector<std::string> out;
  for (auto const& file : fs::directory_iterator(GRIDMORPH_EXAMPLES))
    if (file.path().extension() == ".toml") out.push_back(file.path().stem().string());
  std::sort(out.begin(), out.end());
  return out;
}

/// The first group of a pattern in a text; "" where there is none.
std::string found_in(std::string const& text, char const* pattern) {
  std::smatch match;
  return std::regex_search(text, match, std::regex(pattern)) ? match[1].str() : "";
}

/// Rounds the coordinates to single precision. Files of CGNS say that they keep them so; those of SU2 are text, with
/// digits enough.
void write_in_single_precision(std::string const& from, std::string const& to) {
  Mesh mesh = read_mesh(from);
  Coordinates rounded(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    rounded.set(n, {double(float(p.x)), double(float(p.y)), double(float(p.z))});
  }
  if (fs::path(to).extension() != ".cgns") return write_morphed(from, to, mesh, rounded);
  for (Zone& zone : mesh.zones) zone.single_precision = true;
  mesh.coordinates = rounded;
  write_mesh(to, mesh);
}

/// A copy of examples/ with one case file, whose mesh is a file of its folder meshes/ whatever made it.
class SinglePrecisionExample : public Example, public ::testing::WithParamInterface<std::string> {
 protected:
  void SetUp() override {
    if (test::reduced()) GTEST_SKIP() << "examples take long, and other tests have them";
    Example::SetUp();
    fs::create_directories(path("examples/meshes"));
    for (auto const& file : fs::directory_iterator(GRIDMORPH_EXAMPLES))
      if (file.is_regular_file() && file.path().extension() != ".toml")
        fs::copy(file.path(), path("examples") / file.path().filename());
    // What prepares a case takes other case files.
    for (auto const& name : all_examples()) take(name);
  }
  void TearDown() override {
    if (!folder_.empty()) Example::TearDown();
  }

  /// Where the mesh of an example is, made where a command makes it.
  std::string original(std::string const& text, std::string const& input) const {
    std::string const maker = found_in(text, "# mesh: gridmorph (.*)");
    std::string const geometry = found_in(text, "# mesh: gmsh (.*)");
    std::string const made = path("made");
    if (!geometry.empty()) {
      fs::create_directories(made);
      EXPECT_EQ(shell("gmsh -3 '" GRIDMORPH_EXAMPLES "/" + geometry + "' -o '" + made + "/" + input + "'"), 0)
          << contents(path("out"));
      return made + "/" + input;
    }
    if (maker.empty()) return GRIDMORPH_EXAMPLES "/" + input;
    EXPECT_EQ(shell("'" GRIDMORPH_EXECUTABLE "' --quiet " + maker + " --directory '" + made + "'"), 0)
        << contents(path("err"));
    return made + "/" + input;
  }

  [[nodiscard]] std::string text_of_case() const {
    return contents(fs::path(GRIDMORPH_EXAMPLES) / (GetParam() + ".toml"));
  }

  /// Morphs the example of the test as examples/run does, with its mesh in single precision.
  void run() {
    std::string const text = text_of_case();
    std::string const input = found_in(text, "\ninput *= *\"(.*)\"");
    mesh_file_ = path("examples/meshes") + "/" + fs::path(input).filename().string();
    write_in_single_precision(original(text, input), mesh_file_);
    int const status =
        shell("GRIDMORPH_MESHES= '" + path("examples/run") + "' --gridmorph '" GRIDMORPH_EXECUTABLE "' --out '" +
              path("out_of_run") + "' " + GetParam());
    ASSERT_EQ(status, 0) << contents(path("out")) << contents(path("err"))
                         << contents(path("out_of_run/" + GetParam() + "/log.txt"));
  }

  std::string mesh_file_;

 private:
  void take(std::string const& name) const {
    std::string text = contents(fs::path(GRIDMORPH_EXAMPLES) / (name + ".toml"));
    text = std::regex_replace(text, std::regex("# (mesh|stands in for): .*\n"), "");
    text = std::regex_replace(text, std::regex("\ninput *= *\"(meshes/)?"), "\ninput = \"meshes/");
    std::ofstream(path("examples/" + name + ".toml")) << text;
  }
};

TEST_P(SinglePrecisionExample, Passes) {
  if (GetParam() == "aircraft" && !test::everything()) GTEST_SKIP() << "half a minute, and other wings have it";
  if (!found_in(text_of_case(), "# mesh: gmsh (.*)").empty() && !has_gmsh())
    GTEST_SKIP() << "Gmsh, which makes the mesh, is not there";
  ASSERT_NO_FATAL_FAILURE(run());
  auto const morphed = path("out_of_run/" + GetParam() + "/" + GetParam() + "_morphed.cgns");
  bool const is_wheel = contents(path("examples/" + GetParam() + ".toml")).find("[wheel]") != std::string::npos;
  if (is_wheel || !fs::exists(morphed)) return;  // a wheel has passages more; meshes of text have other names
  before = read_mesh(mesh_file_);
  after = read_mesh(morphed);
  ASSERT_EQ(before.n_nodes(), after.n_nodes());
  expect_interfaces_closed(2 * double(std::numeric_limits<float>::epsilon()));
}

INSTANTIATE_TEST_SUITE_P(Of, SinglePrecisionExample, ::testing::ValuesIn(all_examples()),
                         [](auto const& info) { return info.param; });

}  // namespace
}  // namespace gridmorph::test
