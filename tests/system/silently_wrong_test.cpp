// Inputs that do not say what was meant are refused, or said to be so, however quiet the run.
#include "run_command.hpp"
#include "support/mesh_builders.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/io/mesh_io.hpp>

namespace gridmorph::testing {
namespace {

class SilentlyWrong : public CommandTest {
 protected:
  [[nodiscard]] static bool says(std::string const& text, std::string const& words) {
    return text.find(words) != std::string::npos;
  }
};

TEST_F(SilentlyWrong, ControlCharactersOfNamesDoNotReachTheTerminal) {
  Mesh mesh = as_hexahedra(test::box({3, 3, 3}, test::Shape::straight, 1));
  write_mesh(path("box.vtu").string(), mesh);
  Outcome const typed = gridmorph("inspect $'no\\x1b[2J\\rsuch.vtu'");
  EXPECT_EQ(typed.status, 2);
  EXPECT_FALSE(says(typed.err, "\x1b") || says(typed.err, "\r")) << typed.err;
  EXPECT_TRUE(says(typed.err, "no?[2J?such.vtu")) << typed.err;
}

TEST_F(SilentlyWrong, NamesThatBeginWithAZeroAreToldInWords) {
  write("zero.toml", "[mesh]\ninput = \"\\u0000m.vtu\"\n[[motion]]\npatches = [\"x\"]\nrule = \"fixed\"\n");
  expect_bad_input(gridmorph("morph zero.toml"), {"zero.toml:2", "\\u0000"});
  write("zero.vtm", std::string("<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet><DataSet file=\"") +
                        '\0' + "q.vtu\"/></vtkMultiBlockDataSet></VTKFile>");
  expect_bad_input(gridmorph("inspect zero.vtm"), {"zero.vtm:1", "zero byte"});
}

}  // namespace
}  // namespace gridmorph::testing
