// No output of any command takes the place of a file that was read, whichever of the formats it has and whichever of
// several files it is.
#include "run_command.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace gridmorph::test {
namespace {

std::string const vtu_cube =
    "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n"
    "<UnstructuredGrid><Piece NumberOfPoints=\"8\" NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" "
    "Name=\"Points\" "
    "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1</DataArray></Points>\n"
    "<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3 4 5 6 7</DataArray>\n"
    "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">8</DataArray>\n"
    "<DataArray type=\"UInt8\" Name=\"types\" "
    "format=\"ascii\">12</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>\n";

/// A mesh of one cube in a format, with all files that it consists of; the first of `files` but for OpenFOAM is what
/// the case file names.
struct CubeFormat {
  std::string name, input, ending;
  std::vector<std::string> files;
};

class InputsKept : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("cube.su2",
          "NDIME= 3\nNELEM= 1\n12 0 1 2 3 4 5 6 7 0\nNPOIN= 8\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
          "NMARK= 1\nMARKER_TAG= wall\nMARKER_ELEMS= 6\n9 0 3 2 1\n9 4 5 6 7\n9 0 1 5 4\n9 1 2 6 5\n9 2 3 7 6\n9 3 0 4 "
          "7\n");
    write(
        "cube.msh",
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 "
        "1\n"
        "8 0 1 1\n$EndNodes\n$Elements\n7\n1 3 2 1 1 1 4 3 2\n2 3 2 1 1 5 6 7 8\n3 3 2 1 1 1 2 6 5\n4 3 2 1 1 2 3 7 6\n"
        "5 3 2 1 1 3 4 8 7\n6 3 2 1 1 4 1 5 8\n7 5 2 2 1 1 2 3 4 5 6 7 8\n$EndElements\n");
    write("cube.ugrid",
          "8 0 6 0 0 0 1\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n1 4 3 2\n5 6 7 8\n1 2 6 5\n2 3 7 6\n"
          "3 4 8 7\n4 1 5 8\n1 1 1 1 1 1\n1 2 3 4 5 6 7 8\n");
    write("cube.mapbc", "1\n1 4000 wall\n");
    write("cube.xyz", "2 2 2\n0 1 0 1 0 1 0 1\n0 0 1 1 0 0 1 1\n0 0 0 0 1 1 1 1\n");
    write("cube.vtu", vtu_cube);
    std::filesystem::create_directory(path("part"));
    write("part/a.vtu", vtu_cube);
    write(
        "many.vtm",
        "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet><DataSet index=\"0\" name=\"a\" "
        "file=\"part/a.vtu\"/></vtkMultiBlockDataSet></VTKFile>\n");
    write(
        "many.pvtu",
        "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\"><PUnstructuredGrid GhostLevel=\"0\"><PPoints><PDataArray "
        "type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/></PPoints><Piece Source=\"part/a.vtu\"/>"
        "</PUnstructuredGrid></VTKFile>\n");
    write_foam("case/constant/polyMesh");
    std::filesystem::create_directories(path("case/0.5/polyMesh"));
    std::filesystem::copy(path("case/constant/polyMesh/points"), path("case/0.5/polyMesh/points"));
    write("case/case.foam", "");
    std::filesystem::create_directory(path("out"));
  }

  void write_foam(std::string const& folder) const {
    std::filesystem::create_directories(path(folder));
    auto const file = [&](std::string const& name, std::string const& of_class, std::string const& body) {
      write(folder + "/" + name,
            "FoamFile { version 2.0; format ascii; class " + of_class + "; object " + name + "; }\n" + body + "\n");
    };
    file("points", "vectorField", "8\n((0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 1) (1 0 1) (1 1 1) (0 1 1))");
    file("faces", "faceList", "6\n(4(0 3 2 1) 4(4 5 6 7) 4(0 1 5 4) 4(1 2 6 5) 4(2 3 7 6) 4(3 0 4 7))");
    file("owner", "labelList", "6{0}");
    file("neighbour", "labelList", "0()");
    file("boundary", "polyBoundaryMesh", "1\n(\nwall { type wall; nFaces 6; startFace 0; }\n)");
  }

  static std::vector<CubeFormat> formats() {
    std::string const mesh = "case/constant/polyMesh/";
    return {{"CGNS", "passage.cgns", ".cgns", {"passage.cgns"}},
            {"PLOT3D", "cube.xyz", ".xyz", {"cube.xyz"}},
            {"SU2", "cube.su2", ".su2", {"cube.su2"}},
            {"Gmsh", "cube.msh", ".msh", {"cube.msh"}},
            {"UGRID", "cube.ugrid", ".ugrid", {"cube.ugrid", "cube.mapbc"}},
            {"VTK", "cube.vtu", ".vtu", {"cube.vtu"}},
            {"VTK, blocks", "many.vtm", ".vtm", {"many.vtm", "part/a.vtu"}},
            {"VTK, pieces", "many.pvtu", ".pvtu", {"many.pvtu", "part/a.vtu"}},
            {"OpenFOAM",
             "case",
             "",
             {mesh + "points", mesh + "faces", mesh + "owner", mesh + "neighbour", mesh + "boundary"}},
            {"OpenFOAM, a time", "case/0.5", "", {mesh + "points", "case/0.5/polyMesh/points"}}};
  }

  void write_case_of(std::string const& input, std::string const& output, std::string const& more = "") const {
    write("run.toml", fmt::format("[mesh]\ninput = \"{}\"\noutput = \"{}\"\n{}[[motion]]\npatches = [\"*\"]\nrule = "
                                  "\"formula\"\ndz = \"0\"\n",
                                  input, output, more));
  }

  /// Status 2, what is wrong in words, and every file as it was.
  void expect_kept(std::string const& command, std::string const& of) const {
    auto const before = everything();
    Outcome const run = shell("export OMP_NUM_THREADS=1 OMP_WAIT_POLICY=passive; " + command);
    EXPECT_EQ(run.status, 2) << of << ": " << command << "\n" << run.out << run.err;
    EXPECT_NE(run.err.find("never overwritten"), std::string::npos) << of << ": " << command << "\n" << run.err;
    EXPECT_EQ(everything(), before) << of << ": " << command;
  }

  [[nodiscard]] std::vector<std::pair<std::string, std::string>> everything() const {
    std::vector<std::pair<std::string, std::string>> out;
    for (auto const& entry : std::filesystem::recursive_directory_iterator(path(".")))
      if (std::string const name = entry.path().string();
          name.find(".std") == name.npos && name.find("run.toml") == name.npos)
        out.emplace_back(name, entry.is_regular_file() ? contents(entry.path()) : std::string());
    std::sort(out.begin(), out.end());
    return out;
  }
};

TEST_F(InputsKept, NoReportPageOrDrawingTakesThePlaceOfAnyFileOfAMeshOfAnyFormat) {
  for (CubeFormat const& format : formats())
    for (std::string const& file : format.files) {
      write_case_of(format.input, "out/mesh" + format.ending);
      expect_kept("$G morph run.toml -q -r " + file, format.name);
    }
  for (CubeFormat const& format : formats()) {
    std::string const& last = format.files.back();
    for (char const* key : {"report", "html", "vtk"}) {
      write_case_of(format.input, "out/mesh" + format.ending, fmt::format("[output]\n{} = \"{}\"\n", key, last));
      expect_kept("$G morph run.toml -q", format.name);
    }
    write_case_of(format.input, "out/mesh" + format.ending);
    expect_kept("$G morph run.toml -q --html " + last, format.name);
    expect_kept("$G inspect " + format.input + " --suggest " + last, format.name);
    expect_kept("$G surface " + format.input + " -p wall -o " + last, format.name);
  }
}

TEST_F(InputsKept, NoMorphedMeshTakesThePlaceOfAnyFileOfItsInput) {
  for (CubeFormat const& format : formats()) {
    write_case_of(format.input, "out/mesh" + format.ending);
    for (std::string const& file : format.files)
      if (!format.ending.empty()) expect_kept("$G morph run.toml -q -o " + file, format.name);
  }
  // By another name: a hard link, a link, a link to the folder.
  ASSERT_EQ(
      shell("ln passage.cgns hard.cgns; ln -s cube.su2 soft.su2; ln -s part also; mkdir sub; ln -s ../case/constant "
            "sub/constant")
          .status,
      0);
  write_case_of("passage.cgns", "hard.cgns");
  expect_kept("$G morph run.toml -q", "CGNS");
  write_case_of("cube.su2", "soft.su2");
  expect_kept("$G morph run.toml -q", "SU2");
  write_case_of("case", "sub");
  expect_kept("$G morph run.toml -q", "OpenFOAM");
  expect_kept("$G hexahedra passage.cgns -o hard.cgns", "CGNS");
  expect_kept("$G fillet passage.cgns --blade blade --wall hub --radius 0.001 -o hard.cgns", "CGNS");
  // Files beside the output that its name stands for.
  std::filesystem::create_directory(path("next"));
  write("next/next_0.vtu", vtu_cube);
  write("many.vtm",
        "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet><DataSet index=\"0\" "
        "name=\"a\" file=\"next/next_0.vtu\"/></vtkMultiBlockDataSet></VTKFile>\n");
  write_case_of("many.vtm", "next.vtm");
  expect_kept("$G morph run.toml -q", "VTK, blocks");
}

TEST_F(InputsKept, ACaseOfOpenFoamIsNotItsOwnOutputByWhateverItIsNamed) {
  for (char const* input : {"case", "case/case.foam", "case/constant", "case/latestTime", "case/0.5",
                            "case/constant/polyMesh", "./case/../case"})
    for (char const* output : {"case", "case/constant", "case/constant/polyMesh"}) {
      write_case_of(input, output);
      expect_kept("$G morph run.toml -q", input);
    }
  for (char const* input : {"case/case.foam", "case/constant", "case/latestTime"}) {
    write_case_of(input, "gone");
    write("run.toml",
          fmt::format("[mesh]\ninput = \"{}\"\n[sequence]\ntimes = [0, 0.5, 1]\noutput = \"case\"\n[[motion]]\n"
                      "patches = [\"*\"]\nrule = \"formula\"\ndz = \"0.01 * t\"\n",
                      input));
    expect_kept("$G morph run.toml -q", input);
  }
}

}  // namespace
}  // namespace gridmorph::test
