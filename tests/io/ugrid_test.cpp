// Meshes in AFLR3's format, made here by a writer of their own: all ways to store them, names of surfaces, damage.
#include "io/damage.hpp"
#include "support/expect_error.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>

#include <algorithm>
#include <ostream>
#include <vector>

namespace gridmorph::test {
namespace {

struct Storage {
  std::string word;  ///< empty: text
  bool big = false, records = false;
  int real = 8, integer = 4;
};
void PrintTo(Storage const& s, std::ostream* out) { *out << (s.word.empty() ? "text" : s.word); }

class Writer {
 public:
  explicit Writer(Storage how) : how_(std::move(how)) {}

  /// Faces of the k-th patch have the number 10 - k. `pyramid`: order in which nodes of a pyramid are listed.
  std::string run(Mesh const& mesh, std::array<std::size_t, 5> const& pyramid) {
    std::array<std::vector<std::vector<Index32>>, 6> lists;
    std::array<std::vector<int>, 2> numbers;
    for (std::size_t p = 0; p < mesh.patches.size(); ++p)
      for (Index f = 0; f < mesh.patches[p].faces.size(); ++f) {
        auto const face = mesh.patches[p].faces[f];
        lists[face.size() - 3].emplace_back(face.begin(), face.end());
        numbers[face.size() - 3].push_back(10 - int(p));
      }
    for (Index e = 0; e < mesh.n_elements(); ++e) {
      auto const nodes = mesh.elements.nodes[e];
      std::vector<Index32> row(nodes.begin(), nodes.end());
      if (row.size() == 5)
        for (std::size_t k = 0; k < 5; ++k) row[k] = nodes[pyramid[k]];
      lists[row.size() == 8 ? 5 : row.size() - 2].push_back(row);
    }
    std::string head, body;
    integer(mesh.n_nodes(), head);
    for (auto const& list : lists) integer(Index(list.size()), head);
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      for (double const c : {mesh.coordinates.x(n), mesh.coordinates.y(n), mesh.coordinates.z(n)}) real(c, body);
    auto const add = [&](std::vector<std::vector<Index32>> const& list) {
      for (auto const& row : list)
        for (Index32 const n : row) integer(n + 1, body);
    };
    add(lists[0]);
    add(lists[1]);
    for (auto const& list : numbers)
      for (int const n : list) integer(n, body);
    for (std::size_t k = 2; k < 6; ++k) add(lists[k]);
    return record(head) + record(body);
  }

 private:
  template <class T>
  void raw(T value, std::string& out) const {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (how_.big) std::reverse(bytes.begin(), bytes.end());
    out.append(bytes.data(), bytes.size());
  }
  void integer(Index v, std::string& out) const {
    if (how_.word.empty())
      out += std::to_string(v) + "\n";
    else
      how_.integer == 8 ? raw(std::int64_t(v), out) : raw(std::int32_t(v), out);
  }
  void real(double v, std::string& out) const {
    if (how_.word.empty()) {
      std::array<char, 32> text{};
      std::snprintf(text.data(), text.size(), "%.17g\n", v);
      out += text.data();
    } else {
      how_.real == 8 ? raw(v, out) : raw(float(v), out);
    }
  }
  std::string record(std::string const& bytes) const {
    if (!how_.records) return bytes;
    std::string mark;
    raw(std::uint32_t(bytes.size()), mark);
    return mark + bytes + mark;
  }

  Storage how_;
};

/// A cube of six pyramids between prisms and tetrahedra would take a mesher; here they stand beside them.
Mesh all_volumes() {
  Mesh mesh = to_prisms_and_tetrahedra(unit_box({2, 2, 3}), 1);
  Mesh const cube = to_hexahedra(unit_box({1, 1, 1}));
  Mesh out;
  out.add_zone("zone 1", mesh.n_nodes() + 9);
  out.coordinates = Coordinates(out.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) out.coordinates.set(n, mesh.coordinates[n]);
  Index const first = mesh.n_nodes();
  for (Index n = 0; n < 8; ++n) out.coordinates.set(first + n, cube.coordinates[n] + Vec3{5, 0, 0});
  out.coordinates.set(first + 8, {5.5, 0.5, 0.5});
  // In the order of the file: tetrahedra, pyramids, prisms.
  for (ElementType const type : {ElementType::tetrahedron, ElementType::pyramid, ElementType::prism}) {
    for (Index e = 0; e < mesh.n_elements(); ++e)
      if (mesh.elements.type[e] == type) out.add_element(type, mesh.elements.nodes[e]);
    if (type != ElementType::pyramid) continue;
    std::array<Index32, max_face_corners> room{};
    for (int f = 0; f < 6; ++f) {
      auto const face = side_nodes(cube, 0, f, room);
      std::vector<Index32> row(face.rbegin(), face.rend());
      row.push_back(8);
      for (Index32& n : row) n += Index32(first);
      out.add_element(type, row);
    }
  }
  out.patches = mesh.patches;
  Patch shell;
  shell.name = "shell";
  shell.zone = 0;
  std::array<Index32, max_face_corners> room{};
  for (int f = 0; f < 6; ++f) {
    auto const face = side_nodes(cube, 0, f, room);
    std::vector<Index32> row(face.begin(), face.end());
    for (Index32& n : row) n += Index32(first);
    shell.faces.add(row);
  }
  out.patches.push_back(shell);
  return out;
}

/// Nodes of a pyramid as a file lists them, by their places in the SIDS: the base is its 1st, 4th, 5th and 2nd, the
/// apex its 3rd.
constexpr std::array<std::size_t, 5> as_ugrid{0, 3, 4, 1, 2}, other_way_round{0, 1, 4, 3, 2};

class Ugrid : public testing::TestWithParam<Storage> {
 protected:
  static std::string bytes(Mesh const& mesh) { return Writer(GetParam()).run(mesh, as_ugrid); }
  [[nodiscard]] std::string path(std::string const& stem) const {
    return folder_.file(stem + (GetParam().word.empty() ? "" : "." + GetParam().word) + ".ugrid");
  }
  TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(As, Ugrid,
                         testing::Values(Storage{}, Storage{"b8", true}, Storage{"lb8"}, Storage{"b4", true, false, 4},
                                         Storage{"lb4", false, false, 4}, Storage{"r8", true, true},
                                         Storage{"lr8", false, true}, Storage{"r4", true, true, 4},
                                         Storage{"lr4", false, true, 4}, Storage{"b8l", true, false, 8, 8},
                                         Storage{"lb8l", false, false, 8, 8}),
                         [](auto const& info) {
                           return info.param.word.empty() ? std::string("text") : info.param.word;
                         });

TEST_P(Ugrid, MeshesAreReadAsTheyAre) {
  for (Mesh const& want : {all_volumes(), to_hexahedra(unit_box({2, 3, 2}))}) {
    write_bytes(path("mesh"), bytes(want));
    Mesh const mesh = read_mesh(path("mesh"));
    EXPECT_EQ(look_at_mesh(path("mesh")).format, MeshFormat::ugrid);
    EXPECT_EQ(mesh.elements.type, want.elements.type);
    EXPECT_EQ(mesh.elements.nodes.item, want.elements.nodes.item);
    EXPECT_TRUE(negative_elements(mesh).empty());
    ASSERT_EQ(mesh.n_nodes(), want.n_nodes());
    for (Index n = 0; n < mesh.n_nodes(); ++n) EXPECT_EQ(mesh.coordinates[n], want.coordinates[n]);
    ASSERT_EQ(mesh.patches.size(), want.patches.size());
    for (auto const& patch : mesh.patches) {
      auto const& other = want.patches[10 - std::stoi(patch.name.substr(8))];
      EXPECT_EQ(patch.faces.size(), other.faces.size());
      EXPECT_EQ(patch_nodes(patch), patch_nodes(other));
    }
  }
}

/// The apex of a file's pyramid stands third, and its base goes around either way.
TEST_P(Ugrid, PyramidsAreTurnedWhereTheirBaseLooksOutwards) {
  Mesh const want = all_volumes();
  write_bytes(path("mesh"), Writer(GetParam()).run(want, other_way_round));
  EXPECT_TRUE(negative_elements(read_mesh(path("mesh"))).empty());
}

TEST_P(Ugrid, OnlyCoordinatesThatMoveChange) {
  write_bytes(path("mesh"), bytes(all_volumes()) + (GetParam().word.empty() ? "0\nfurther data\n" : "further data"));
  expect_coordinates_replaced(path("mesh"), path("out"), GetParam().real == 4);
}

TEST_P(Ugrid, NamesAndKindsComeFromTheFileBesideIt) {
  write_bytes(path("mesh"), bytes(to_hexahedra(unit_box({2, 2, 2}))));
  write_bytes(folder_.file("mesh.mapbc"),
              "6\n10 4000 wing\n9 5000 outer\n8 6662 side\n\n7 7011 left\n6 7012 right\n5 3000\n");
  Mesh const mesh = read_mesh(path("mesh"));
  ASSERT_EQ(mesh.patches.size(), 6U);
  std::vector<PatchKind> const kinds{PatchKind::wall,   PatchKind::farfield, PatchKind::symmetry,
                                     PatchKind::inflow, PatchKind::outflow,  PatchKind::wall};
  std::vector<std::string> const names{"wing", "outer", "side", "left", "right", "surface 5"};
  for (std::size_t p = 0; p < 6; ++p) {
    EXPECT_EQ(mesh.patches[p].name, names[p]);
    EXPECT_EQ(mesh.patches[p].kind, kinds[p]);
  }
  write_bytes(folder_.file("mesh.mapbc"), "1\nwing 4000\n");
  expect_all_in(message_of<IoError>([&] { read_mesh(path("mesh")); }), {"mesh.mapbc:2", "'wing 4000'"});
}

TEST_P(Ugrid, DamagedFilesGiveAMeshOrAnError) {
  std::string const whole = bytes(to_prisms_and_tetrahedra(unit_box({1, 1, 2}), 1));
  expect_refused_where_cut(whole, path("bad"), 3, GetParam().word.empty() ? 2 : GetParam().records ? 4 : 0);
  expect_no_harm_where_overwritten(whole, path("bad"), 400);
}

TEST(UgridErrors, SayWhereWhatAndWhatToDo) {
  TemporaryFolder const folder;
  Mesh const mesh = to_hexahedra(unit_box({1, 1, 1}));
  std::string const text = Writer({}).run(mesh, as_ugrid), binary = Writer({"b8", true}).run(mesh, as_ugrid);
  auto const error = [&](std::string const& name, std::string const& bytes) {
    write_bytes(folder.file(name), bytes);
    return message_of<Error>([&] { read_mesh(folder.file(name)); });
  };
  expect_all_in(error("mesh.lb8.ugrid", binary),
                {"mesh.lb8.ugrid, byte 28", "402653184 coordinates", "name it as it is stored"});
  expect_all_in(error("mesh.ugrid", binary), {"mesh.ugrid:1", "binary files say so in their name"});
  expect_all_in(error("mesh.r8.ugrid", binary), {"mesh.r8.ugrid, byte 4", "a record of 28 bytes is marked with 8"});
  expect_all_in(error("mesh.ugrid", "9999999" + text), {"mesh.ugrid:7", "299999994 coordinates", "whole copy"});
  expect_all_in(error("mesh.ugrid", "-" + text), {"mesh.ugrid:1", "-8 nodes"});
  std::string bad = text;
  bad.replace(bad.rfind("8\n"), 2, "9\n");
  expect_all_in(error("mesh.ugrid", bad), {"hexahedron 1 has node 9", "there are 8"});
  // Names of outputs say how they are stored.
  write_bytes(folder.file("mesh.ugrid"), text);
  Mesh const read = read_mesh(folder.file("mesh.ugrid"));
  expect_all_in(message_of<IoError>([&] {
                  write_morphed(folder.file("mesh.ugrid"), folder.file("out.b8.ugrid"), read, read.coordinates);
                }),
                {"out.b8.ugrid", "written as text"});
}

}  // namespace
}  // namespace gridmorph::test
