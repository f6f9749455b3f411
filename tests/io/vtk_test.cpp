// Meshes in VTK's XML format, made here by a writer of their own: all ways to store arrays, patches, polyhedra, fields,
// damage.
#include "io/damage.hpp"
#include "io/second_order.hpp"
#include "support/expect_error.hpp"
#include "support/made_bodies.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <ostream>
#include <vector>

namespace gridmorph::test {
namespace {

struct Storage {
  char const* name = "ascii";
  char const* format = "ascii";  ///< ascii, binary, appended
  bool base64 = false;           ///< of appended arrays
  bool wide = false;             ///< UInt64 heads
  bool single = false, packed = false, swapped = false;
};
void PrintTo(Storage const& s, std::ostream* out) { *out << s.name; }

/// Base 64 by its definition: bits in groups of six.
std::string base64(std::string const& bytes) {
  std::string const alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  std::vector<bool> bits;
  for (unsigned char const b : bytes)
    for (int k = 7; k >= 0; --k) bits.push_back((b >> k & 1) != 0);
  while (bits.size() % 6 != 0) bits.push_back(false);
  for (std::size_t n = 0; n < bits.size(); n += 6) {
    int v = 0;
    for (std::size_t k = 0; k < 6; ++k) v = 2 * v + (bits[n + k] ? 1 : 0);
    out += alphabet[v];
  }
  while (out.size() % 4 != 0) out += '=';
  return out;
}

/// A zlib stream (RFC 1950) of one stored block.
std::string stored(std::string const& bytes) {
  std::string out = "\x78\x01\x01";
  auto const n = std::uint16_t(bytes.size());
  for (std::uint16_t const v : {n, std::uint16_t(~n)}) out += {char(v & 255), char(v >> 8)};
  out += bytes;
  std::uint32_t a = 1, b = 0;
  for (unsigned char const c : bytes) {
    a = (a + c) % 65521;
    b = (b + a) % 65521;
  }
  for (int const v : {int(b >> 8), int(b & 255), int(a >> 8), int(a & 255)}) out += char(v);
  return out;
}

struct VtuWriter {
  Storage how;
  std::string data = {};
  bool shared_faces = false;  ///< polyhedra as VTK 9.4 and later have them

  template <class T>
  void raw(T value, std::string& out) const {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (how.swapped) std::reverse(bytes.begin(), bytes.end());
    out.append(bytes.data(), bytes.size());
  }
  void head(std::uint64_t v, std::string& out) const { how.wide ? raw(v, out) : raw(std::uint32_t(v), out); }

  template <class T>
  std::string stored_bytes(std::vector<T> const& values, bool as_base64) const {
    std::string bytes, top;
    for (T const v : values) raw(v, bytes);
    if (!how.packed) {
      head(bytes.size(), top);
      return as_base64 ? base64(top + bytes) : top + bytes;
    }
    std::size_t const block = 64, n = (bytes.size() + block - 1) / block;
    head(n, top);
    head(block, top);
    head(bytes.size() % block, top);
    std::string body;
    for (std::size_t k = 0; k < n; ++k) {
      std::string const one = stored(bytes.substr(k * block, block));
      head(one.size(), top);
      body += one;
    }
    return as_base64 ? base64(top) + base64(body) : top + body;
  }

  template <class T>
  std::string array(std::string const& name, std::string const& type, int components, std::vector<T> const& values) {
    std::string out = "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                      std::to_string(components) + "\" format=\"" + how.format + "\"";
    if (std::string(how.format) == "appended") {
      out += " offset=\"" + std::to_string(data.size()) + "\"/>\n";
      data += stored_bytes(values, how.base64);
      return out;
    }
    out += ">\n  ";
    if (std::string(how.format) == "binary") {
      out += stored_bytes(values, true);
    } else {
      for (T const v : values) {
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "%.17g ", double(v));
        out += text.data();
      }
    }
    return out + "\n<InformationKey name=\"RANGE\"><Value index=\"0\">17</Value></InformationKey></DataArray>\n";
  }

  std::string reals(std::string const& name, int components, std::vector<double> const& values) {
    return how.single ? array(name, "Float32", components, std::vector<float>(values.begin(), values.end()))
                      : array(name, "Float64", components, values);
  }

  std::string arrays_of_faces(Mesh const& mesh, std::vector<std::uint8_t> const& type) {
    std::vector<std::int64_t> nodes, ends, of_cells, cell_ends;
    std::array<Index32, max_face_corners> room{};
    for (std::size_t c = 0; c < type.size(); ++c) {
      for (int f = 0; type[c] == 42 && f < n_sides(mesh, Index(c)); ++f) {
        auto const face = side_nodes(mesh, Index(c), f, room);
        of_cells.push_back(std::int64_t(ends.size()));
        nodes.insert(nodes.end(), face.begin(), face.end());
        ends.push_back(std::int64_t(nodes.size()));
      }
      cell_ends.push_back(std::int64_t(of_cells.size()));
    }
    return array("face_connectivity", "Int64", 1, nodes) + array("face_offsets", "Int64", 1, ends) +
           array("polyhedron_to_faces", "Int64", 1, of_cells) + array("polyhedron_offsets", "Int64", 1, cell_ends);
  }

  /// Cells of a mesh, then faces of its patches with the numbers 10, 20, ... in `markers` (none: without).
  std::string run(Mesh const& mesh, std::string const& markers, bool with_faces = true) {
    std::map<ElementType, int> const types{{ElementType::triangle, 5},     {ElementType::quadrilateral, 9},
                                           {ElementType::tetrahedron, 10}, {ElementType::hexahedron, 12},
                                           {ElementType::prism, 13},       {ElementType::pyramid, 14},
                                           {ElementType::polyhedron, 42}};
    std::vector<std::int32_t> connectivity, offsets, numbers, faces, face_offsets;
    std::vector<std::uint8_t> type;
    auto const end = [&](int t, std::span<Index32 const> nodes, int number) {
      connectivity.insert(connectivity.end(), nodes.begin(), nodes.end());
      offsets.push_back(int(connectivity.size()));
      type.push_back(std::uint8_t(t));
      numbers.push_back(number);
      face_offsets.push_back(-1);
    };
    for (Index e = 0; e < mesh.n_elements(); ++e) {
      end(types.at(mesh.elements.type[e]), mesh.elements.nodes[e], 1);
      if (type.back() != 42) continue;
      std::array<Index32, max_face_corners> room{};
      faces.push_back(n_sides(mesh, e));
      for (int f = 0; f < n_sides(mesh, e); ++f) {
        auto const nodes = side_nodes(mesh, e, f, room);
        faces.push_back(int(nodes.size()));
        faces.insert(faces.end(), nodes.begin(), nodes.end());
      }
      face_offsets.back() = int(faces.size());
    }
    int number = 0;
    for (auto const& patch : mesh.patches) {
      number += 10;
      for (Index f = 0; f < patch.faces.size() && with_faces; ++f) {
        std::size_t const n = patch.faces[f].size();
        end(n == 2 ? 3 : n == 3 ? 5 : 9, patch.faces[f], number);
      }
    }
    std::vector<double> places, pressure;
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      Vec3 const p = mesh.coordinates[n];
      places.insert(places.end(), {p.x, p.y, p.z});
      pressure.push_back(double(n));
    }
    std::string out = std::string(
                          "<?xml version=\"1.0\"?>\n<!-- a <comment> -->\n<VTKFile type=\"UnstructuredGrid\" "
                          "version=\"1.0\" byte_order=\"") +
                      (how.swapped ? "BigEndian" : "LittleEndian") + "\" header_type=\"" +
                      (how.wide ? "UInt64" : "UInt32") + "\"" +
                      (how.packed ? " compressor=\"vtkZLibDataCompressor\"" : "") +
                      ">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" + std::to_string(mesh.n_nodes()) +
                      "\" NumberOfCells=\"" + std::to_string(type.size()) + "\">\n";
    out += "<Points>\n" + reals("Points", 3, places) + "</Points>\n<PointData Scalars=\"p\">\n" +
           reals("p", 1, pressure) + "</PointData>\n";
    if (!markers.empty()) out += "<CellData>\n" + array(markers, "Int32", 1, numbers) + "</CellData>\n";
    out += "<Cells>\n" + array("connectivity", "Int32", 1, connectivity) + array("offsets", "Int32", 1, offsets) +
           array("types", "UInt8", 1, type);
    if (!faces.empty() && shared_faces)
      out += arrays_of_faces(mesh, type);
    else if (!faces.empty())
      out += array("faces", "Int32", 1, faces) + array("faceoffsets", "Int32", 1, face_offsets);
    out += "</Cells>\n</Piece>\n</UnstructuredGrid>\n";
    if (std::string(how.format) == "appended")
      out += std::string("<AppendedData encoding=\"") + (how.base64 ? "base64" : "raw") + "\">\n _" + data +
             "\n</AppendedData>\n";
    return out + "</VTKFile>\n";
  }
};

Mesh box() { return to_prisms_and_tetrahedra(unit_box({2, 3, 3}), 1); }

class Vtu : public testing::TestWithParam<Storage> {
 protected:
  Mesh read(Mesh const& mesh, std::string const& markers = "CellEntityIds") {
    write_bytes(path_, VtuWriter{GetParam()}.run(mesh, markers));
    return read_mesh(path_);
  }
  /// Arrays packed by zlib need it.
  void SetUp() override {
    if (!GetParam().packed) return;
    try {
      read(box());
    } catch (IoError const& e) {
      if (std::string(e.what()).find("without zlib") == std::string::npos) throw;
      GTEST_SKIP() << e.what();
    }
  }
  TemporaryFolder folder_;
  std::string const path_ = folder_.file("mesh.vtu");
};
INSTANTIATE_TEST_SUITE_P(As, Vtu,
                         testing::Values(Storage{}, Storage{"single", "ascii", false, false, true},
                                         Storage{"binary", "binary"}, Storage{"binary64", "binary", false, true, true},
                                         Storage{"packed", "binary", false, false, false, true},
                                         Storage{"raw", "appended", false, true},
                                         Storage{"rawpacked", "appended", false, true, false, true},
                                         Storage{"base64", "appended", true},
                                         Storage{"base64packed", "appended", true, true, true, true},
                                         Storage{"big", "appended", false, false, false, false, true},
                                         Storage{"bigpacked", "binary", false, true, false, true, true}),
                         [](auto const& info) { return std::string(info.param.name); });

TEST_P(Vtu, MeshesAreReadAsTheyAre) {
  for (Mesh const& want : {box(), to_hexahedra(unit_box({2, 2, 3})), flat_box(4, 3, 1)}) {
    Mesh const mesh = read(want);
    EXPECT_EQ(look_at_mesh(path_).format, MeshFormat::vtk);
    EXPECT_EQ(mesh_kind(path_), MeshKind::unstructured);
    EXPECT_EQ(mesh.dimension, want.dimension);
    EXPECT_EQ(mesh.elements.type, want.elements.type);
    EXPECT_EQ(mesh.elements.nodes.item, want.elements.nodes.item);
    ASSERT_EQ(mesh.n_nodes(), want.n_nodes());
    for (Index n = 0; n < mesh.n_nodes(); ++n) EXPECT_EQ(mesh.coordinates[n], want.coordinates[n]);
    ASSERT_EQ(mesh.patches.size(), want.patches.size());
    for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
      EXPECT_EQ(mesh.patches[p].name, "CellEntityIds " + std::to_string(10 * (p + 1)));
      EXPECT_EQ(mesh.patches[p].faces.item, want.patches[p].faces.item);
    }
  }
}

TEST_P(Vtu, OnlyPointsThatMoveChange) {
  read(box());
  expect_coordinates_replaced(path_, folder_.file("out.vtu"), GetParam().single);
}

/// Fields go beside those that are there; everything else reads as before, wherever it has moved to.
TEST_P(Vtu, FieldsComeBesideWhatIsThere) {
  Mesh const mesh = read(box());
  Coordinates moved(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) moved.set(n, mesh.coordinates[n] + Vec3{0.01 * double(n % 7), 0, 1.0 / 3});
  OutputFields fields;
  fields.displacement = true;
  fields.cells.push_back({"Size", std::vector<double>(std::size_t(mesh.n_elements()), 0.5)});
  std::string const out = folder_.file("out.vtu");
  write_morphed(path_, out, mesh, moved, fields);
  Mesh const back = read_mesh(out);
  EXPECT_EQ(back.elements.nodes.item, mesh.elements.nodes.item);
  ASSERT_EQ(back.patches.size(), mesh.patches.size());
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    EXPECT_EQ(back.patches[p].faces.item, mesh.patches[p].faces.item);
  std::string const text = bytes_of(out);
  expect_all_in(
      text, {"Name=\"p\"", "Name=\"Displacement\" NumberOfComponents=\"3\"", "Name=\"Size\" NumberOfComponents=\"1\""});
  // Again onto that: names are taken now.
  write_morphed(out, out, back, mesh.coordinates, fields);
  expect_all_in(bytes_of(out), {"Name=\"MorphDisplacement\"", "Name=\"MorphSize\""});
  read_mesh(out);
}

/// Two boxes beside one another, coordinates of thirds.
std::array<Mesh, 2> halves() {
  std::array<Mesh, 2> out{to_hexahedra(unit_box({2, 2, 2})), to_prisms_and_tetrahedra(unit_box({1, 2, 2}), 2)};
  for (std::size_t m = 0; m < 2; ++m)
    for (Index n = 0; n < out[m].n_nodes(); ++n)
      out[m].coordinates.set(n, 1.0 / 3 * (out[m].coordinates[n] + Vec3{m == 1 ? 2.0 : 0, 0, 0}));
  return out;
}

/// One file with two pieces: what is before the first one, both, and what is behind the second one.
std::string in_pieces(Storage const& how, std::array<Mesh, 2> const& meshes) {
  VtuWriter writer{how};
  std::array<std::string, 2> text;
  for (std::size_t m = 0; m < 2; ++m) text[m] = writer.run(meshes[m], "CellEntityIds", false);
  std::string const end = "</Piece>\n";
  auto const first = text[0].find("<Piece"), behind = text[0].find(end) + end.size();
  return text[1].substr(0, text[1].find("<Piece")) + text[0].substr(first, behind - first) +
         text[1].substr(text[1].find("<Piece"));
}

void expect_two_pieces(Mesh const& mesh) {
  ASSERT_EQ(mesh.zones.size(), 2U);
  EXPECT_EQ(mesh.zones[1].name, "piece 2");
  EXPECT_EQ(mesh.n_elements(), 8 + 8);
  ASSERT_EQ(mesh.connections.size(), 1U);
  EXPECT_EQ(mesh.connections[0].nodes.size(), 9U);
  EXPECT_EQ(largest_mismatch(mesh, mesh.connections[0]), 0);
  EXPECT_FALSE(mesh.connections[0].periodic);
  auto const topology = make_topology(mesh);
  auto const faces = find_face_patches(mesh, topology);
  EXPECT_TRUE(faces.problems.empty());
  EXPECT_EQ(std::count(faces.patch.begin(), faces.patch.end(), BoundaryFacePatches::connection), 4 + 4);
  ASSERT_EQ(mesh.patches.size(), 2U);
  EXPECT_EQ(mesh.patches[0].name, "boundary");
  EXPECT_EQ(mesh.patches[0].faces.size(), 20);
}

TEST_P(Vtu, SeveralPiecesAreZonesJoinedWhereTheyTouch) {
  auto const meshes = halves();
  read(meshes[0]);
  std::string const text = in_pieces(GetParam(), meshes);
  write_bytes(path_, text);
  Mesh const mesh = read_mesh(path_);
  expect_two_pieces(mesh);
  std::string const out = folder_.file("out.vtu");
  write_morphed(path_, out, mesh, mesh.coordinates);
  EXPECT_EQ(bytes_of(out), text);
  expect_coordinates_replaced(path_, out, GetParam().single);
  OutputFields fields;
  fields.displacement = true;
  fields.cells.push_back({"Number", {}});
  for (Index e = 0; e < mesh.n_elements(); ++e) fields.cells.back().values.push_back(double(e));
  Coordinates moved(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) moved.set(n, mesh.coordinates[n] + Vec3{0.25, 0.1 * double(n % 5), 0});
  write_morphed(path_, out, mesh, moved, fields);
  Mesh const back = read_mesh(out);
  EXPECT_EQ(back.elements.nodes.item, mesh.elements.nodes.item);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    EXPECT_EQ(back.coordinates[n].y, GetParam().single ? double(float(moved[n].y)) : moved[n].y);
}

TEST_P(Vtu, PolyhedraInTheLayoutOfNowAreThoseOfBefore) {
  Mesh polyhedra = as_polyhedra(to_prisms_and_tetrahedra(unit_box({1, 2, 2}), 1));
  read(box());
  write_bytes(path_, VtuWriter{GetParam()}.run(polyhedra, "CellEntityIds"));
  Mesh const before = read_mesh(path_);
  VtuWriter writer{GetParam()};
  writer.shared_faces = true;
  std::string const text = writer.run(polyhedra, "CellEntityIds");
  EXPECT_EQ(text.find("\"faceoffsets\""), std::string::npos);
  write_bytes(path_, text);
  Mesh const mesh = read_mesh(path_);
  EXPECT_EQ(mesh.elements.type, before.elements.type);
  EXPECT_EQ(mesh.elements.nodes.item, before.elements.nodes.item);
  EXPECT_EQ(mesh.polyhedra.faces.item, before.polyhedra.faces.item);
  ASSERT_EQ(mesh.patches.size(), before.patches.size());
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    EXPECT_EQ(mesh.patches[p].faces.item, before.patches[p].faces.item);
  std::string const out = folder_.file("out.vtu");
  write_morphed(path_, out, mesh, mesh.coordinates);
  EXPECT_EQ(bytes_of(out), text);
  expect_coordinates_replaced(path_, out, GetParam().single);
  std::string const bad = folder_.file("bad.vtu");
  expect_refused_where_cut(text, bad, 67, 2);
  expect_no_harm_where_overwritten(text, bad, 200);
}

TEST_P(Vtu, DamagedFilesGiveAMeshOrAnError) {
  std::string const whole =
      VtuWriter{GetParam()}.run(to_prisms_and_tetrahedra(unit_box({1, 1, 2}), 1), "CellEntityIds");
  std::string const bad = folder_.file("bad.vtu");
  expect_refused_where_cut(whole, bad, 7, 2);
  expect_no_harm_where_overwritten(whole, bad, 400);
}

class VtuRead : public testing::Test {
 protected:
  Mesh read(std::string const& text) {
    write_bytes(path_, text);
    return read_mesh(path_);
  }
  TemporaryFolder folder_;
  std::string const path_ = folder_.file("mesh.vtu");
};

TEST_F(VtuRead, FacesWithoutCellsAreThePatchBoundary) {
  Mesh const bare = read(VtuWriter{}.run(box(), "", false));
  ASSERT_EQ(bare.patches.size(), 1U);
  EXPECT_EQ(bare.patches[0].name, "boundary");
  Index faces = 0;
  Mesh const all = box();
  for (auto const& patch : all.patches) faces += patch.faces.size();
  EXPECT_EQ(bare.patches[0].faces.size(), faces);
  // Without numbers the faces are one surface; of a part of them the rest is the boundary.
  EXPECT_EQ(read(VtuWriter{}.run(box(), "")).patches.size(), 1U);
  Mesh part = box();
  part.patches.resize(2);
  Mesh const mixed = read(VtuWriter{}.run(part, "medit:ref"));
  ASSERT_EQ(mixed.patches.size(), 3U);
  EXPECT_EQ(mixed.patches[1].name, "medit:ref 20");
  EXPECT_EQ(mixed.patches[2].name, "boundary");
}

/// Blocks as hexahedra; names with characters that XML has other uses for.
TEST_F(VtuRead, WhatIsWrittenIsReadAgain) {
  for (Mesh mesh : {box(), to_hexahedra(unit_box({2, 2, 2})), flat_box(3, 2, 1), unit_box({2, 3, 2})}) {
    mesh.patches[0].name = "blade \"<1>\" & more";
    OutputFields fields;
    fields.displacement = true;
    Mesh const want = mesh.is_structured() ? to_hexahedra(mesh) : mesh;
    fields.cells.push_back({"Size", std::vector<double>(std::size_t(want.n_elements()), 0.5)});
    write_vtk(path_, mesh, mesh.coordinates, fields);
    Mesh const back = read_mesh(path_);
    EXPECT_EQ(back.dimension, want.dimension);
    EXPECT_EQ(back.elements.type, want.elements.type);
    EXPECT_EQ(back.elements.nodes.item, want.elements.nodes.item);
    ASSERT_EQ(back.patches.size(), want.patches.size());
    for (std::size_t p = 0; p < back.patches.size(); ++p) {
      EXPECT_EQ(back.patches[p].name, want.patches[p].name);
      EXPECT_EQ(back.patches[p].faces.item, want.patches[p].faces.item);
    }
    for (Index n = 0; n < back.n_nodes(); ++n) EXPECT_EQ(back.coordinates[n], want.coordinates[n]);
    if (mesh.is_structured()) continue;
    // The same file from a mesh in another order.
    Mesh scattered = mesh;
    FileOrder order;
    for (Index n = 0; n < mesh.n_nodes(); ++n) order.node.push_back(Index32(mesh.n_nodes() - 1 - n));
    for (Index e = 0; e < mesh.n_elements(); ++e) order.element.push_back(Index32(mesh.n_elements() - 1 - e));
    reorder(scattered, order);
    std::string const first = bytes_of(path_);
    write_vtk(path_, scattered, scattered.coordinates, fields);
    EXPECT_EQ(bytes_of(path_), first);
  }
}

/// In the order of vtkQuadraticTetra, vtkQuadraticPyramid, vtkBiQuadraticQuadraticWedge and vtkTriQuadraticHexahedron;
/// and back.
TEST_F(VtuRead, NodesOfSecondOrderElementsComeInTheOrderOfTheStandard) {
  struct Case {
    ElementType type;
    int vtk_type;
    std::vector<std::vector<int>> amid;
  };
  std::vector<std::vector<int>> const hexahedron{{0, 1},
                                                 {1, 2},
                                                 {2, 3},
                                                 {3, 0},
                                                 {4, 5},
                                                 {5, 6},
                                                 {6, 7},
                                                 {7, 4},
                                                 {0, 4},
                                                 {1, 5},
                                                 {2, 6},
                                                 {3, 7},
                                                 {0, 3, 4, 7},
                                                 {1, 2, 5, 6},
                                                 {0, 1, 4, 5},
                                                 {2, 3, 6, 7},
                                                 {0, 1, 2, 3},
                                                 {4, 5, 6, 7},
                                                 {0, 1, 2, 3, 4, 5, 6, 7}};
  std::vector<std::vector<int>> const prism{{0, 1}, {1, 2}, {2, 0}, {3, 4},       {4, 5},       {5, 3},
                                            {0, 3}, {1, 4}, {2, 5}, {0, 1, 3, 4}, {1, 2, 4, 5}, {0, 2, 3, 5}};
  auto const first = [](auto const& list, std::size_t n) {
    return std::vector<std::vector<int>>(list.begin(), list.begin() + std::ptrdiff_t(n));
  };
  for (Case const& one :
       {Case{ElementType::tetrahedron, 24, {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}},
        Case{ElementType::pyramid, 27, {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}},
        Case{ElementType::prism, 26, first(prism, 9)}, Case{ElementType::prism, 32, prism},
        Case{ElementType::hexahedron, 25, first(hexahedron, 12)}, Case{ElementType::hexahedron, 29, hexahedron}}) {
    std::string points, nodes;
    auto const places = places_amid(one.type, one.amid);
    for (std::size_t n = 0; n < places.size(); ++n) {
      points +=
          std::to_string(places[n].x) + " " + std::to_string(places[n].y) + " " + std::to_string(places[n].z) + " ";
      nodes += std::to_string(n) + " ";
    }
    auto const array = [](std::string const& type, std::string const& name, std::string const& values) {
      return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
             (name == "Points" ? "3" : "1") + "\" format=\"ascii\">" + values + "</DataArray>";
    };
    Mesh const mesh =
        read("<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"" +
             std::to_string(places.size()) + "\" NumberOfCells=\"1\"><Points>" + array("Float64", "Points", points) +
             "</Points><Cells>" + array("Int64", "connectivity", nodes) +
             array("Int64", "offsets", std::to_string(places.size())) +
             array("UInt8", "types", std::to_string(one.vtk_type)) + "</Cells></Piece></UnstructuredGrid></VTKFile>");
    ASSERT_EQ(mesh.elements.type[0], one.type);
    ASSERT_EQ(mesh.elements.nodes[0].size(), places.size());
    expect_nodes_amid(mesh);
    std::string const out = folder_.file("out.vtu");
    write_vtk(out, mesh, mesh.coordinates);
    Mesh const back = read_mesh(out);
    EXPECT_EQ(back.elements.nodes.item, mesh.elements.nodes.item);
  }
}

/// Boundary conditions of CGNS files may list nodes: the faces between them are written.
TEST_F(VtuRead, PatchesOfNodesAreWrittenAsTheirFaces) {
  Mesh mesh = box();
  for (std::size_t const p : {std::size_t(1), std::size_t(3)}) {
    mesh.patches[p].nodes = patch_nodes(mesh.patches[p]);
    mesh.patches[p].faces = {};
  }
  write_vtk(path_, mesh, mesh.coordinates);
  Mesh const back = read_mesh(path_), want = box();
  ASSERT_EQ(back.patches.size(), want.patches.size());
  for (auto const& patch : want.patches) {
    auto const same =
        std::find_if(back.patches.begin(), back.patches.end(), [&](Patch const& b) { return b.name == patch.name; });
    ASSERT_NE(same, back.patches.end()) << patch.name;
    EXPECT_EQ(same->faces.size(), patch.faces.size());
    EXPECT_EQ(patch_nodes(*same), patch_nodes(patch));
  }
}

/// A prism of six sides, its faces looking anywhere.
TEST_F(VtuRead, PolyhedraAreReadWrittenAndTurnedOutwards) {
  std::string points, ring = "6 0 1 2 3 4 5", top = "6 6 7 8 9 10 11", sides;
  for (int k = 0; k < 12; ++k)
    points += std::to_string(std::cos(k * 1.0471975511965976)) + " " +
              std::to_string(std::sin(k * 1.0471975511965976)) + " " + std::to_string(k / 6) + "\n";
  for (int k = 0; k < 6; ++k) {
    int const next = (k + 1) % 6;
    sides += " 4 " + std::to_string(k) + " " + std::to_string(k % 2 == 0 ? next : k + 6) + " " +
             std::to_string(next + 6) + " " + std::to_string(k % 2 == 0 ? k + 6 : next);
  }
  auto const array = [](std::string const& type, std::string const& name, std::string const& values) {
    return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
           (name == "Points" ? "3" : "1") + "\" format=\"ascii\">" + values + "</DataArray>\n";
  };
  std::string const text =
      "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"12\" NumberOfCells=\"1\"><Points>" +
      array("Float64", "Points", points) + "</Points><Cells>" +
      array("Int64", "connectivity", "0 1 2 3 4 5 6 7 8 9 10 11") + array("Int64", "offsets", "12") +
      array("UInt8", "types", "42") + array("Int64", "faces", "8 " + ring + " " + top + sides) +
      array("Int64", "faceoffsets", "45") + "</Cells></Piece></UnstructuredGrid></VTKFile>";
  Mesh const mesh = read(text);
  ASSERT_EQ(mesh.elements.type, (std::vector{ElementType::polyhedron}));
  double volume = 0;
  for (Index f = 0; f < mesh.polyhedra.faces.size(); ++f) {
    auto const face = mesh.polyhedra.faces[f];
    for (std::size_t k = 2; k < face.size(); ++k)
      volume += dot(mesh.coordinates[face[0]], cross(mesh.coordinates[face[k - 1]], mesh.coordinates[face[k]])) / 6;
  }
  EXPECT_NEAR(volume, 1.5 * std::sqrt(3.0), 1e-5);
  std::string const out = folder_.file("out.vtu");
  write_vtk(out, mesh, mesh.coordinates);
  Mesh const back = read_mesh(out);
  EXPECT_EQ(back.polyhedra.faces.item, mesh.polyhedra.faces.item);
  std::string const bad = folder_.file("bad.vtu");
  expect_refused_where_cut(text, bad, 3, 0);
  expect_no_harm_where_overwritten(text, bad, 1000);
  expect_no_harm_where_overwritten(bytes_of(out), bad, 400);
}

/// Two boxes side by side in files of their own, and the planes around them as surfaces in single precision.
class Vtm : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "in");
    Mesh left = to_hexahedra(unit_box({2, 2, 2})), right = to_hexahedra(unit_box({2, 2, 2}));
    for (Mesh* m : {&left, &right})
      for (Index n = 0; n < m->n_nodes(); ++n)
        m->coordinates.set(n, 1.0 / 3 * (m->coordinates[n] + Vec3{m == &right ? 2.0 : 0, 0, 0}));
    write_bytes(folder_ / "in" / "left.vtu", VtuWriter{Storage{"raw", "appended", false, true}}.run(left, "", false));
    write_bytes(folder_ / "in" / "right.vtu", VtuWriter{Storage{"ascii"}}.run(right, "", false));
    // The floor of both boxes, and the end of the right one.
    write_bytes(folder_ / "in" / "floor.vtp", surface(4, 2, [](int i, int j) { return Vec3{i / 3.0, j / 3.0, 0}; }));
    write_bytes(folder_ / "in" / "outlet.vtp", surface(2, 2, [](int i, int j) {
                  return Vec3{4 / 3.0, i / 3.0, j / 3.0};
                }));
    write_bytes(path_, text_);
  }
  template <class Place>
  static std::string surface(int ni, int nj, Place const& place) {
    VtuWriter writer{Storage{"single", "ascii", false, false, true}};
    std::vector<double> points;
    std::vector<std::int32_t> nodes, ends;
    for (int j = 0; j <= nj; ++j)
      for (int i = 0; i <= ni; ++i)
        for (double const c : {place(i, j).x, place(i, j).y, place(i, j).z}) points.push_back(c);
    for (int j = 0; j < nj; ++j)
      for (int i = 0; i < ni; ++i) {
        int const n = i + (ni + 1) * j;
        nodes.insert(nodes.end(), {n, n + 1, n + ni + 2, n + ni + 1});
        ends.push_back(int(nodes.size()));
      }
    std::string out =
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt32\"><PolyData><Piece NumberOfPoints=\"" +
        std::to_string(points.size() / 3) + "\" NumberOfPolys=\"" + std::to_string(ends.size()) + "\"><Points>";
    out += writer.reals("Points", 3, points) + "</Points><Polys>" + writer.array("connectivity", "Int32", 1, nodes);
    return out + writer.array("offsets", "Int32", 1, ends) + "</Polys></Piece></PolyData></VTKFile>\n";
  }
  TemporaryFolder folder_;
  std::string const path_ = folder_.file("mesh.vtm");
  std::string const text_ =
      "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\">\n<vtkMultiBlockDataSet>\n<Block index=\"0\" "
      "name=\"volumes\">\n"
      "<DataSet index=\"0\" name=\"left\" file=\"in/left.vtu\"/>\n<DataSet index=\"1\" name=\"right\" "
      "file=\"in/right.vtu\"/>\n</Block>\n"
      "<Block index=\"1\">\n<DataSet index=\"0\" name=\"floor\" file=\"in/floor.vtp\"/>\n<DataSet index=\"1\" "
      "name=\"outlet\" file=\"in/outlet.vtp\"/>\n"
      "<DataSet index=\"2\" name=\"empty\"/>\n</Block>\n</vtkMultiBlockDataSet>\n</VTKFile>\n";
};

TEST_F(Vtm, BlocksOfVolumesAreZonesAndSurfacesTheirPatches) {
  auto const facts = look_at_mesh(path_);
  EXPECT_EQ(facts.format, MeshFormat::vtk);
  EXPECT_EQ(facts.kind, MeshKind::unstructured);
  EXPECT_EQ(facts.linked.size(), 4U);
  Mesh const mesh = read_mesh(path_);
  ASSERT_EQ(mesh.zones.size(), 2U);
  EXPECT_EQ(mesh.zones[1].name, "volumes/right");
  EXPECT_EQ(mesh.n_elements(), 16);
  EXPECT_EQ(mesh.n_nodes(), 54);
  ASSERT_EQ(mesh.patches.size(), 5U);
  std::vector<std::string> const names{"floor", "floor", "outlet", "boundary", "boundary"};
  std::vector<int> const zones{0, 1, 1, 0, 1};
  std::vector<Index> const faces{4, 4, 4, 20, 16};
  for (std::size_t p = 0; p < names.size(); ++p) {
    EXPECT_EQ(mesh.patches[p].name, names[p]);
    EXPECT_EQ(mesh.patches[p].zone, zones[p]);
    EXPECT_EQ(mesh.patches[p].faces.size(), faces[p]);
  }
  EXPECT_EQ(mesh.patches[2].kind, PatchKind::outflow);
}

TEST_F(Vtm, OutputsOfSeveralFilesAppearTogetherOrNotAtAll) {
  Mesh const mesh = read_mesh(path_);
  std::filesystem::create_directories(folder_ / "out" / "out_2.vtp");  // a file cannot take its place
  write_bytes(folder_ / "out" / "out_0.vtu", "of another run");
  EXPECT_THROW(write_morphed(path_, folder_.file("out.vtm"), mesh, mesh.coordinates), IoError);
  EXPECT_EQ(bytes_of(folder_ / "out" / "out_0.vtu"), "of another run");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "out_1.vtu"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.vtm"));
  // Nor is the folder left where it was not there before.
  std::filesystem::create_directories(folder_ / "new.vtm");
  EXPECT_THROW(write_morphed(path_, folder_.file("new.vtm"), mesh, mesh.coordinates), IoError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "new"));
}

TEST_F(Vtm, SurfacesMoveWithTheNodesThatLieThere) {
  Mesh const mesh = read_mesh(path_);
  std::string const out = folder_.file("out.vtm");
  write_morphed(path_, out, mesh, mesh.coordinates);
  std::vector<std::string> const files{"left.vtu", "right.vtu", "floor.vtp", "outlet.vtp"};
  auto const written = [&](std::size_t k) {
    return folder_ / "out" / ("out_" + std::to_string(k) + (k < 2 ? ".vtu" : ".vtp"));
  };
  for (std::size_t k = 0; k < files.size(); ++k)
    EXPECT_EQ(bytes_of(written(k)), bytes_of(folder_ / "in" / files[k])) << files[k];
  Coordinates moved(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const p = mesh.coordinates[n];
    moved.set(n, p + Vec3{0.1 * p.x, 0.2, -0.3 * p.y});
  }
  OutputFields fields;
  fields.displacement = true;
  fields.cells.push_back({"Number", {}});
  for (Index e = 0; e < mesh.n_elements(); ++e) fields.cells.back().values.push_back(double(e));
  write_morphed(path_, out, mesh, moved, fields);
  Mesh const back = read_mesh(out);
  ASSERT_EQ(back.n_nodes(), mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) EXPECT_EQ(back.coordinates[n], moved[n]);
  ASSERT_EQ(back.patches.size(), mesh.patches.size());
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    EXPECT_EQ(back.patches[p].faces.item, mesh.patches[p].faces.item);
  expect_all_in(bytes_of(written(1)), {"Name=\"Displacement\"", "Name=\"Number\"", "15"});
  expect_all_in(message_of<IoError>([&] { write_morphed(path_, folder_.file("out.vtu"), mesh, moved); }),
                {"ending .vtm"});
  std::string const left = (folder_ / "in" / "left.vtu").string();
  Mesh const alone = read_mesh(left);
  expect_all_in(message_of<IoError>([&] { write_morphed(left, out, alone, alone.coordinates); }), {"ending .vtu"});
}

TEST_F(Vtm, DamagedFilesGiveAMeshOrAnError) {
  std::string const bad = folder_.file("bad.vtm");
  expect_refused_where_cut(text_, bad, 3, 2);
  for (unsigned seed = 0; seed < 300; ++seed) {  // names of files among what is damaged, which errors name
    std::mt19937 random(seed);
    std::string damaged = text_;
    damaged[random() % damaged.size()] = char(random());
    write_bytes(bad, damaged);
    try {
      if (mesh_kind(bad) == MeshKind::unstructured) read_mesh(bad);
    } catch (Error const& e) {
      EXPECT_FALSE(std::string(e.what()).empty());
    }
  }
  for (char const* file : {"floor.vtp", "left.vtu"}) {
    std::string const whole = bytes_of(folder_ / "in" / file);
    for (std::size_t length = 0; length + 2 < whole.size(); length += 41) {
      write_bytes(folder_ / "in" / file, whole.substr(0, length));
      EXPECT_THROW(read_mesh(path_), Error) << file << " " << length;
    }
    write_bytes(folder_ / "in" / file, whole);
  }
  std::filesystem::remove(folder_ / "in" / "outlet.vtp");
  expect_all_in(message_of<IoError>([&] { read_mesh(path_); }), {"outlet.vtp", "no such file"});
}

/// The halves in files of their own, which a parallel file names.
class Pvtu : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "in");
    auto const meshes = halves();
    write_bytes(folder_ / "in" / "0.vtu", VtuWriter{Storage{"raw", "appended", false, true}}.run(meshes[0], "", false));
    write_bytes(folder_ / "in" / "1.vtu", VtuWriter{Storage{"ascii"}}.run(meshes[1], "", false));
    write_bytes(path_, text_);
  }
  TemporaryFolder folder_;
  std::string const path_ = folder_.file("mesh.pvtu");
  std::string const text_ =
      "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\">\n<PUnstructuredGrid GhostLevel=\"0\">\n"
      "<PPointData>\n<PDataArray type=\"Float64\" Name=\"p\"/>\n</PPointData>\n<PPoints><PDataArray type=\"Float64\" "
      "NumberOfComponents=\"3\"/></PPoints>\n<Piece Source=\"in/0.vtu\"/>\n<Piece "
      "Source=\"in/1.vtu\"/>\n</PUnstructuredGrid>\n</VTKFile>\n";
};

TEST_F(Pvtu, FilesOfPiecesAreOneMeshAndAreWrittenTogether) {
  auto const facts = look_at_mesh(path_);
  EXPECT_EQ(facts.format, MeshFormat::vtk);
  EXPECT_EQ(facts.kind, MeshKind::unstructured);
  EXPECT_EQ(facts.linked.size(), 2U);
  Mesh const mesh = read_mesh(path_);
  expect_two_pieces(mesh);
  std::string const out = folder_.file("out.pvtu");
  write_morphed(path_, out, mesh, mesh.coordinates);
  auto const written = [&](int k) { return folder_ / "out" / ("out_" + std::to_string(k) + ".vtu"); };
  for (int k = 0; k < 2; ++k)
    EXPECT_EQ(bytes_of(written(k)), bytes_of(folder_ / "in" / (std::to_string(k) + ".vtu"))) << k;
  expect_all_in(bytes_of(out), {"Source=\"out/out_0.vtu\"", "Source=\"out/out_1.vtu\""});
  OutputFields fields;
  fields.displacement = true;
  fields.cells.push_back({"Number", std::vector<double>(std::size_t(mesh.n_elements()), 3)});
  Coordinates moved(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) moved.set(n, mesh.coordinates[n] + Vec3{0.1, 0, mesh.coordinates[n].x});
  write_morphed(path_, out, mesh, moved, fields);
  Mesh const back = read_mesh(out);
  expect_two_pieces(back);
  for (Index n = 0; n < mesh.n_nodes(); ++n) EXPECT_EQ(back.coordinates[n], moved[n]);
  expect_all_in(bytes_of(out),
                {"Name=\"p\"", "<PDataArray type=\"Float64\" Name=\"Displacement\" NumberOfComponents=\"3\"/>",
                 "<PCellData>", "Name=\"Number\""});
  // Once more onto that: one piece has the name, so that all give way.
  write_morphed(out, folder_.file("again.pvtu"), back, moved, fields);
  expect_all_in(bytes_of(folder_.file("again.pvtu")), {"Name=\"MorphDisplacement\"", "Name=\"MorphNumber\""});
}

TEST_F(Pvtu, WhatIsRefusedIsSaid) {
  Mesh const mesh = read_mesh(path_);
  expect_all_in(message_of<IoError>([&] { write_morphed(path_, folder_.file("out.vtu"), mesh, mesh.coordinates); }),
                {"ending .pvtu"});
  std::string const first = (folder_ / "in" / "0.vtu").string();
  Mesh const alone = read_mesh(first);
  expect_all_in(message_of<IoError>([&] { write_morphed(first, folder_.file("out.pvtu"), alone, alone.coordinates); }),
                {"ending .vtu"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.pvtu"));
  auto const with = [&](std::string const& what, std::string const& by) {
    std::string text = text_;
    write_bytes(path_, text.replace(text.find(what), what.size(), by));
    return message_of<IoError>([&] { read_mesh(path_); });
  };
  expect_all_in(with("Source=\"in/1.vtu\"", "Sauce=\"in/1.vtu\""), {"mesh.pvtu:8", "no Source"});
  expect_all_in(with("in/1.vtu", "in/7.vtu"), {"7.vtu", "no such file"});
  // A piece with cells of another one.
  std::string text = bytes_of(folder_ / "in" / "1.vtu");
  text.insert(text.find("<Cells>"),
              "<CellData><DataArray type=\"UInt8\" Name=\"vtkGhostType\" format=\"ascii\">1 1 0 0 0 0 0 "
              "0</DataArray></CellData>\n");
  write_bytes(folder_ / "in" / "1.vtu", text);
  write_bytes(path_, text_);
  expect_all_in(message_of<IoError>([&] { read_mesh(path_); }), {"1.vtu", "2 cells are ghosts", "GhostLevel 0"});
}

TEST_F(Pvtu, DamagedFilesGiveAMeshOrAnError) {
  std::string const bad = folder_.file("bad.pvtu");
  expect_refused_where_cut(text_, bad, 3, 2);
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    std::string damaged = text_;
    damaged[random() % damaged.size()] = char(random());
    write_bytes(bad, damaged);
    try {
      if (mesh_kind(bad) == MeshKind::unstructured) read_mesh(bad);
    } catch (Error const& e) {
      EXPECT_FALSE(std::string(e.what()).empty());
    }
  }
  std::string const whole = bytes_of(folder_ / "in" / "0.vtu");
  for (std::size_t length = 0; length + 2 < whole.size(); length += 61) {
    write_bytes(folder_ / "in" / "0.vtu", whole.substr(0, length));
    EXPECT_THROW(read_mesh(path_), Error) << length;
  }
}

TEST_F(VtuRead, ErrorsSayWhereWhatAndWhatToDo) {
  auto const error = [&](std::string const& what, std::string const& by) {
    std::string text = VtuWriter{}.run(flat_box(2, 1, 1), "CellEntityIds");
    auto const at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return message_of<Error>([&] { read(text.replace(at, what.size(), by)); });
  };
  expect_all_in(error("NumberOfPoints=\"6\"", "NumberOfPoints=\"7\""),
                {"mesh.vtu:7", "'Points' holds 18 values", "21 are wanted"});
  expect_all_in(error("NumberOfPoints=\"6\"", "NumberOfPoints=\"-6\""), {"mesh.vtu:5", "NumberOfPoints=\"-6\""});
  expect_all_in(error("NumberOfPoints=\"6\"", "NumberOfPoints=\"99999999999999\""),
                {"more points or cells than can be handled"});
  expect_all_in(error("format=\"ascii\"", "format=\"octal\""), {"mesh.vtu:7", "'octal'", "ascii, binary and appended"});
  expect_all_in(error("type=\"Float64\"", "type=\"Float16\""), {"'Float16'", "not read"});
  expect_all_in(error("header_type=\"UInt32\"", "compressor=\"vtkLZ4DataCompressor\""),
                {"mesh.vtu:3", "vtkLZ4DataCompressor", "without"});
  expect_all_in(error("  9 9", "  9 69"), {"type 69", "cells of first and second order"});
  expect_all_in(error("type=\"Float64\"", "type=\"Int32\""), {"mesh.vtu:7", "'Int32'", "whole numbers", "Float64"});
  expect_all_in(error("format=\"ascii\"", std::string("format=\"\0\"", 10)), {"'format'", "zero byte"});
  expect_all_in(error("</Points>", "</Point>"), {"</Points> is expected"});
  expect_all_in(error("1 0 0", "1 nan 0"), {"not finite numbers"});
  expect_all_in(error("1 0 0", "1 one 0"), {"mesh.vtu:8", "expected a number, found 'one'"});
  expect_all_in(error("\"connectivity\"", "\"nodes\""), {"no DataArray 'connectivity'"});
}

}  // namespace
}  // namespace gridmorph::test
