// SU2 files: what they may look like, what is wrong with them and where, what stays as it was when they are written.
#include "io/io_support.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

namespace gridmorph::test {
namespace {

std::string const square =
    "% a unit square of a quadrilateral and two triangles\n"
    "NDIME= 2\n"
    "NELEM= 3\n"
    "9 0 1 4 3 0\n"
    "5 1 2 4 1\n"
    "5 2 5 4\n"
    "NPOIN= 6\n"
    "0.0 0.0 0\n"
    "0.5 0.0 1\n"
    "1.0\t0.00\t2\r\n"
    "0 1 3 % a corner\n"
    "\n"
    "5e-1 1 4\n"
    "1 1 5\n"
    "NMARK= 2\n"
    "MARKER_TAG= lower_wall\n"
    "MARKER_ELEMS= 2\n"
    "3 0 1\n"
    "3 1 2 7\n"
    "MARKER_TAG= outlet\n"
    "MARKER_ELEMS= 1\n"
    "3 2 5\n";

class Su2 : public testing::Test {
 protected:
  Mesh read(std::string const& text) {
    write_bytes(path_, text);
    return read_mesh(path_);
  }
  std::string error(std::string const& text) {
    return message_of<Error>([&] { read(text); });
  }
  static std::string replaced(std::string text, std::string const& what, std::string const& by) {
    auto const at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
  }
  TemporaryFolder folder_;
  std::string const path_ = folder_.file("mesh.su2");
};

TEST_F(Su2, FlatMeshesWithMarkersAreRead) {
  auto const mesh = read(square);
  EXPECT_EQ(mesh_kind(path_), MeshKind::unstructured);
  EXPECT_EQ(mesh.dimension, 2);
  EXPECT_EQ(mesh.n_nodes(), 6);
  EXPECT_EQ(mesh.elements.type,
            (std::vector{ElementType::quadrilateral, ElementType::triangle, ElementType::triangle}));
  EXPECT_EQ(mesh.coordinates[4], (Vec3{0.5, 1, 0}));
  ASSERT_EQ(mesh.patches.size(), 2u);
  EXPECT_EQ(mesh.patches[0].name, "lower_wall");
  EXPECT_EQ(mesh.patches[0].kind, PatchKind::wall);
  EXPECT_EQ(mesh.patches[1].kind, PatchKind::outflow);
  EXPECT_EQ(mesh.patches[0].faces.item, (std::vector<Index32>{0, 1, 1, 2}));
  EXPECT_EQ(describe_node(mesh, 0), "zone 'zone 1' node 0");
  EXPECT_TRUE(negative_elements(mesh).empty());
}

TEST_F(Su2, PointsMayLackTheirIndexColumn) {
  std::string text = square;
  for (auto const& [with, without] : {std::pair{"0.0 0.0 0\n", "0.0 0.0\n"}, {"0.5 0.0 1\n", "0.5 0.0\n"}})
    text = replaced(text, with, without);
  expect_same_coordinates(read(text).coordinates, read(square).coordinates);
}

TEST_F(Su2, PointsMayComeBeforeElementsAndUnknownKeywordsAreLeftAlone) {
  auto const elements = square.find("NELEM="), points = square.find("NPOIN="), marks = square.find("NMARK=");
  auto const mesh = read(square.substr(0, elements) + square.substr(points, marks - points) +
                         square.substr(elements, points - elements) + "FFD_NBOX= 1\n1 2 3\n" + square.substr(marks));
  EXPECT_EQ(mesh.n_elements(), 3);
  EXPECT_TRUE(std::any_of(mesh.notes.begin(), mesh.notes.end(),
                          [](auto const& n) { return n.find("FFD_NBOX=") != std::string::npos; }));
}

TEST_F(Su2, ErrorsNameTheLine) {
  auto const expect = [&](std::string const& text, std::string const& line, std::string const& reason) {
    auto const message = error(text);
    EXPECT_NE(message.find("mesh.su2:" + line), std::string::npos) << message;
    EXPECT_NE(message.find(reason), std::string::npos) << message;
  };
  expect(replaced(square, "NDIME= 2", "NDIME= 4"), "2:", "2 or 3 dimensions");
  expect(replaced(square, "NELEM= 3", "NELEM= 4"), "7:", "found 'NPOIN='");
  expect(replaced(square, "NELEM= 3", "NELEM= 2"), "6:", "more lines than the number above");
  expect(replaced(square, "NELEM= 3", "NELEM= 99999999999"), "3:", "more than the file can hold");
  expect(replaced(square, "NELEM= 3", "NELEM= many"), "3:", "'many'");
  expect(replaced(square, "9 0 1 4 3 0", "9 0 1"), "4:", "the end of the line");
  expect(replaced(square, "9 0 1 4 3 0", "12 0 1 4 3 0 1 2 3"), "4:", "element type 12");
  expect(replaced(square, "0.5 0.0 1", "0.5 zero 1"), "9:", "'zero'");
  expect(replaced(square, "3 2 5\n", ""), "21:", "the file ends after 0 of 1 elements of marker 'outlet'");
  expect(replaced(square, "3 1 2 7", "3 1 12"), "16:", "node 12");
  expect(replaced(square, "NPOIN= 6", "POINTS= 6"), "2:", "has no NPOIN=");
}

TEST_F(Su2, NodesThatAreNotThereAndCoordinatesThatAreNoNumbersAreSaid) {
  EXPECT_NE(error(replaced(square, "5 2 5 4\n", "5 2 6 4\n")).find("element 2 has node 6"), std::string::npos);
  EXPECT_NE(error(replaced(square, "0.5 0.0 1", "nan 0.0 1")).find("node 1 "), std::string::npos);
}

TEST_F(Su2, AWrittenFileDiffersInTheCoordinatesThatMoved) {
  auto const mesh = read(square);
  auto const out = folder_.file("out.su2");
  write_morphed(path_, out, mesh, mesh.coordinates);
  EXPECT_EQ(bytes_of(out), square);
  Coordinates after(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) after.set(n, mesh.coordinates[n]);
  after.set(4, {1.0 / 3, 1, 0});
  write_morphed(path_, out, mesh, after);
  EXPECT_EQ(bytes_of(out), replaced(square, "5e-1 1 4", "3.333333333333333e-01 1 4"));
  expect_same_coordinates(read_mesh(out).coordinates, after);
}

TEST_F(Su2, PointsOfNoElementStayAsTheyAre) {
  std::string more = replaced(square, "NPOIN= 6", "NPOIN= 8");
  more = replaced(more, "1 1 5\n", "1 1 5\n-0 1e+5 6\n7.50 -3 7\n");
  auto const plain = read(square), mesh = read(more);
  expect_same_mesh(plain, mesh);
  Coordinates moved(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) moved.set(n, mesh.coordinates[n] + Vec3{0.25, 0, 0});
  std::string const output = folder_.file("out.su2");
  write_morphed(path_, output, mesh, moved);
  std::string const written = bytes_of(output);
  EXPECT_NE(written.find("\n-0 1e+5 6\n7.50 -3 7\n"), std::string::npos) << written;
  EXPECT_EQ(read_mesh(output).coordinates[5], (Vec3{1.25, 1, 0}));
}

TEST_F(Su2, FieldsAndOtherMeshesAreRefused) {
  auto const mesh = read(square);
  auto const out = folder_.file("out.su2");
  OutputFields fields;
  fields.displacement = true;
  EXPECT_THROW(write_morphed(path_, out, mesh, mesh.coordinates, fields), IoError);
  write_bytes(folder_.file("other.su2"), replaced(replaced(square, "NPOIN= 6", "NPOIN= 5"), "1 1 5\n", ""));
  EXPECT_THROW(write_morphed(folder_.file("other.su2"), out, mesh, mesh.coordinates), IoError);
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(Su2, PeriodicMarkersBecomeConnections) {
  auto const mesh = read(square +
                         "MARKER_TAG= SEND_RECEIVE\nMARKER_ELEMS= 2\nSEND_TO= 1\n1 0 1\n1 3 1\n"
                         "MARKER_TAG= SEND_RECEIVE\nMARKER_ELEMS= 2\nSEND_TO= -1\n1 2 1\n1 5 1\n"
                         "NPERIODIC= 2\nPERIODIC_INDEX= 0\n0 0 0\n0 0 0\n0 0 0\n"
                         "PERIODIC_INDEX= 1\n0 0 0\n0 0 0\n1 0 0\n");
  ASSERT_EQ(mesh.connections.size(), 1u);
  EXPECT_EQ(mesh.connections[0].nodes, (std::vector<Index32>{0, 3}));
  EXPECT_EQ(mesh.connections[0].donor_nodes, (std::vector<Index32>{2, 5}));
  ASSERT_TRUE(mesh.connections[0].periodic);
  EXPECT_EQ(largest_mismatch(mesh, mesh.connections[0]), 0);
}

TEST_F(Su2, PeriodicMarkersOfOtherElementsThanVerticesAreLeftOut) {
  std::string const vertices = "MARKER_ELEMS= 2\nSEND_TO= {}\n1 0 1\n1 3 1\n",
                    line = "MARKER_ELEMS= 1\nSEND_TO= {}\n3 2 5\n";
  auto const marker = [](std::string const& text, char const* rank) {
    return "MARKER_TAG= SEND_RECEIVE\n" + replaced(text, "{}", rank);
  };
  std::string const transforms =
      "NPERIODIC= 2\nPERIODIC_INDEX= 0\n0 0 0\n0 0 0\n0 0 0\nPERIODIC_INDEX= 1\n0 0 0\n0 0 0\n1 0 0\n";
  for (bool const first : {false, true}) {  // as many nodes on both sides, but those of the other are no vertices
    auto const mesh =
        read(square + marker(first ? line : vertices, "1") + marker(first ? vertices : line, "-1") + transforms);
    EXPECT_TRUE(mesh.connections.empty());
    ASSERT_FALSE(mesh.notes.empty());
    EXPECT_NE(mesh.notes.back().find("no vertices; skipped"), std::string::npos) << mesh.notes.back();
  }
}

/// A unit cube of two prisms, in the numbering of CGNS or of VTK.
std::string prisms(bool vtk) {
  return std::string("NDIME= 3\nNELEM= 2\n") +
         (vtk ? "13 0 3 1 4 7 5\n13 0 2 3 4 6 7\n" : "13 0 1 3 4 5 7\n13 0 3 2 4 7 6\n") +
         "NPOIN= 8\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\nNMARK= 0\n";
}

TEST_F(Su2, PrismsMayBeNumberedAsInCgnsOrAsInVtk) {
  for (bool const vtk : {false, true}) {
    auto const mesh = read(prisms(vtk));
    EXPECT_TRUE(negative_elements(mesh).empty());
    EXPECT_EQ(mesh.notes.size(), vtk ? 1u : 0u);
    EXPECT_EQ(make_topology(mesh).boundary.size(), 8);
  }
}

TEST_F(Su2, SeveralZonesAreKeptApart) {
  auto const mesh = read("NZONE= 2\nIZONE= 1\n" + square + "IZONE= 2\n" + square);
  ASSERT_EQ(mesh.zones.size(), 2u);
  EXPECT_EQ(mesh.zones[1].name, "zone 2");
  EXPECT_EQ(mesh.elements.corners(3)[0], 6);
  EXPECT_EQ(mesh.patches[2].zone, 1);
  auto const out = folder_.file("out.su2");
  write_morphed(path_, out, mesh, mesh.coordinates);
  EXPECT_EQ(bytes_of(out), bytes_of(path_));
}

TEST_F(Su2, TheDimensionMayStandOnceBeforeTheNumberOfZones) {
  std::string const body = replaced(square, "NDIME= 2\n", "");
  for (std::string const& own : {std::string(), std::string("NDIME= 2\n")}) {
    auto const mesh = read("NDIME= 2\nNZONE= 2\nIZONE= 1\n" + own + body + "IZONE= 2\n" + own + body);
    ASSERT_EQ(mesh.zones.size(), 2u);
    EXPECT_EQ(mesh.zones[0].name, "zone 1");
    EXPECT_EQ(mesh.n_elements(), 6);
    EXPECT_EQ(mesh.patches.size(), 4u);
  }
  EXPECT_EQ(read("NDIME= 2\nNZONE= 1\n" + body).n_elements(), 3);
  EXPECT_NE(error(square + "NDIME= 3\n").find(":23: NDIME= comes after"), std::string::npos);
}

}  // namespace
}  // namespace gridmorph::test
