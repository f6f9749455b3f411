// Meshes of OpenFOAM, made here by a writer of their own: text and binary, packed and not, cyclics, planes, damage.
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/write_series.hpp>
#include <gridmorph/mesh/file_order.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>
#include "support/expect_error.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace gridmorph::test {
namespace {

namespace fs = std::filesystem;

/// How a mesh is stored.
struct Storage {
  bool binary = false;
  int label_bits = 32, scalar_bits = 64;
};

/// Writes lists as OpenFOAM does.
class FoamWriter {
 public:
  FoamWriter(fs::path folder, Storage storage) : folder_(std::move(folder)), storage_(storage) {
    fs::create_directories(folder_);
  }

  void labels(char const* name, std::vector<std::int64_t> const& values) const {
    write(name, "labelList", list(values));
  }
  void points(std::vector<Vec3> const& values) const {
    std::string body = std::to_string(values.size()) + "\n(";
    for (Vec3 const& p : values) {
      if (storage_.binary) {
        for (double const c : {p.x, p.y, p.z}) raw_scalar(c, body);
      } else {
        std::array<char, 100> line{};
        std::snprintf(line.data(), line.size(), "\n(%.17g %.17g %.17g)", p.x, p.y, p.z);
        body += line.data();
      }
    }
    write("points", "vectorField", body + (storage_.binary ? ")" : "\n)"));
  }
  void faces(std::vector<std::vector<std::int64_t>> const& values) const {
    if (!storage_.binary) {
      std::string body = std::to_string(values.size()) + "\n(\n";
      for (auto const& face : values) body += list(face) + "\n";
      return write("faces", "faceList", body + ")");
    }
    std::vector<std::int64_t> first{0}, nodes;
    for (auto const& face : values) {
      nodes.insert(nodes.end(), face.begin(), face.end());
      first.push_back(std::int64_t(nodes.size()));
    }
    write("faces", "faceCompactList", list(first) + "\n" + list(nodes));
  }
  /// cellZones with `cellLabels` or faceZones with `faceLabels` and a flipMap.
  void zones(char const* name, char const* key,
             std::vector<std::pair<std::string, std::vector<std::int64_t>>> const& values) const {
    bool const of_faces = std::string(key) == "faceLabels";
    std::string body = std::to_string(values.size()) + "\n(\n";
    for (auto const& [zone, labels] : values) {
      body += zone + "\n{\n    type " + (of_faces ? "faceZone" : "cellZone") + ";\n" + key + "      List<label> \n" +
              list(labels) + ";\n";
      if (of_faces) {
        body += "flipMap         List<bool> \n" + std::to_string(labels.size()) + "(";
        for (std::size_t n = 0; n < labels.size(); ++n)
          body += storage_.binary ? std::string(1, '\0') : std::string(n > 0 ? " 0" : "0");
        body += ");\n";
      }
      body += "}\n";
    }
    write(name, "regIOobject", body + ")");
  }
  void boundary(std::string const& body) const {
    Storage const kept = storage_;
    write("boundary", "polyBoundaryMesh", body);
    storage_ = kept;
  }

 private:
  void raw_label(std::int64_t v, std::string& out) const {
    auto const four = std::int32_t(v);
    storage_.label_bits == 64 ? out.append(reinterpret_cast<char const*>(&v), 8)
                              : out.append(reinterpret_cast<char const*>(&four), 4);
  }
  void raw_scalar(double v, std::string& out) const {
    auto const single = float(v);
    storage_.scalar_bits == 64 ? out.append(reinterpret_cast<char const*>(&v), 8)
                               : out.append(reinterpret_cast<char const*>(&single), 4);
  }
  std::string list(std::vector<std::int64_t> const& values) const {
    std::string out = std::to_string(values.size()) + "(";
    for (std::size_t n = 0; n < values.size(); ++n) {
      if (storage_.binary)
        raw_label(values[n], out);
      else
        out += (n > 0 ? " " : "") + std::to_string(values[n]);
    }
    return out + ")";
  }
  void write(char const* name, char const* of_class, std::string const& body) const {
    std::ofstream out(folder_ / name, std::ios::binary);
    out << "/*---- C++ ----*\\\n\\*---- ----*/\nFoamFile\n{\n    version     2.0;\n    format      "
        << (storage_.binary ? "binary" : "ascii") << ";\n    arch        \"LSB;label=" << storage_.label_bits
        << ";scalar=" << storage_.scalar_bits << "\";\n    class       " << of_class << ";\n    object      " << name
        << ";\n}\n// * * * //\n\n"
        << body << "\n\n// ***** //\n";
  }

  fs::path folder_;
  mutable Storage storage_;
};

/// What a polyMesh folder says.
struct FoamLists {
  using Labels = std::vector<std::int64_t>;
  struct PatchOfFaces {
    std::string name, keys;
    std::size_t start, size;
  };
  std::vector<Vec3> points;
  std::vector<Labels> faces;
  Labels owner, neighbour;
  std::vector<PatchOfFaces> patches;

  void write(fs::path const& folder, Storage storage = {}) const {
    FoamWriter const out(folder, storage);
    out.points(points);
    out.faces(faces);
    out.labels("owner", owner);
    out.labels("neighbour", neighbour);
    std::string boundary = std::to_string(patches.size()) + "\n(\n";
    for (auto const& patch : patches)
      boundary += patch.name + "\n{\n " + patch.keys + "\n nFaces " + std::to_string(patch.size) + ";\n startFace " +
                  std::to_string(patch.start) + ";\n}\n";
    out.boundary(boundary + ")");
  }
};

/// A box of n[0] x n[1] x n[2] cells, its nodes at place(i, j, k), i fastest; patches x0, x1, y0, ... with `keys`.
struct FoamBox {
  Index3 n{3, 2, 2};
  std::function<Vec3(Index3 const&)> place = [](Index3 const& p) { return Vec3{0.1 * p[0], 0.3 * p[1], 0.7 * p[2]}; };
  std::map<std::string, std::string> keys;  ///< "type wall;" where nothing else is said
  std::vector<std::string> patches{"x0", "x1", "y0", "y1", "z0", "z1"};

  void write(fs::path const& folder, Storage storage = {}) const { lists().write(folder, storage); }

  [[nodiscard]] FoamLists lists() const {
    FoamLists out;
    auto const node = [&](int i, int j, int k) {
      return std::int64_t(i) + (n[0] + 1) * (j + std::int64_t(n[1] + 1) * k);
    };
    auto const cell = [&](Index3 const& c) { return std::int64_t(c[0]) + n[0] * (c[1] + std::int64_t(n[1]) * c[2]); };
    // The face of a cell at its upper or lower end along an axis, outwards.
    auto const face = [&](Index3 c, int axis, int side) {
      c[axis] += side;
      int const u = (axis + 1) % 3, v = (axis + 2) % 3;
      FoamLists::Labels of_face;
      for (auto const& [a, b] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
        Index3 p = c;
        p[u] += a;
        p[v] += b;
        of_face.push_back(node(p[0], p[1], p[2]));
      }
      if (side == 0) std::reverse(of_face.begin() + 1, of_face.end());
      return of_face;
    };
    auto& [points, faces, owner, neighbour, of_patches] = out;
    auto const each_cell = [&](auto&& visit) {
      Index3 c{};
      for (c[2] = 0; c[2] < n[2]; ++c[2])
        for (c[1] = 0; c[1] < n[1]; ++c[1])
          for (c[0] = 0; c[0] < n[0]; ++c[0]) visit(c);
    };
    each_cell([&](Index3 const& c) {
      for (int axis = 0; axis < 3; ++axis) {
        if (c[axis] + 1 == n[axis]) continue;
        Index3 next = c;
        ++next[axis];
        faces.push_back(face(c, axis, 1));
        owner.push_back(cell(c));
        neighbour.push_back(cell(next));
      }
    });
    for (std::string const& name : patches) {
      std::size_t const start = faces.size();
      // "xy0": the faces of several sides in one patch.
      int const side = name.back() - '0';
      for (char const letter : name.substr(0, name.size() - 1)) {
        int const axis = letter - 'x';
        for (int const end : side == 2 ? std::vector<int>{0, 1} : std::vector<int>{side})
          each_cell([&](Index3 const& c) {
            if (c[axis] != (end == 0 ? 0 : n[axis] - 1)) return;
            faces.push_back(face(c, axis, end));
            owner.push_back(cell(c));
          });
      }
      auto const own = keys.find(name);
      of_patches.push_back(
          {name, own == keys.end() ? "type wall; inGroups 1(wall);" : own->second, start, faces.size() - start});
    }
    for (int k = 0; k <= n[2]; ++k)
      for (int j = 0; j <= n[1]; ++j)
        for (int i = 0; i <= n[0]; ++i) points.push_back(place({i, j, k}));
    return out;
  }
};

/// A mesh cut into parts as decomposePar does it: a folder processor<p> with the cells that part(cell) says. Of each
/// part's points their number in the whole mesh.
class Cut {
 public:
  Cut(FoamLists const& whole, int n_parts, std::function<int(std::int64_t)> part)
      : all_(whole), part_(std::move(part)) {
    for (auto const& patch : all_.patches)
      for (std::size_t k = 0; k < patch.size; ++k) patch_of_face_[patch.start + k] = {&patch, k};
    for (int p = 0; p < n_parts; ++p) add(p, n_parts);
  }

  void write(fs::path const& of_case, bool addressing, Storage storage = {}) const {
    for (std::size_t p = 0; p < parts.size(); ++p) {
      fs::path const folder = of_case / ("processor" + std::to_string(p)) / "constant" / "polyMesh";
      parts[p].lists.write(folder, storage);
      if (!addressing) continue;
      FoamWriter const out(folder, storage);
      out.labels("pointProcAddressing", parts[p].points);
      out.labels("cellProcAddressing", parts[p].cells);
      out.labels("faceProcAddressing", parts[p].faces);
    }
  }

  struct PartOfMesh {
    FoamLists lists;
    FoamLists::Labels points, cells, faces;
  };
  std::vector<PartOfMesh> parts;

 private:
  using Labels = FoamLists::Labels;

  /// The face of the other side of a cyclic patch; none of others.
  [[nodiscard]] std::int64_t opposite(std::size_t f) const {
    auto const found = patch_of_face_.find(f);
    std::string const key = "neighbourPatch ";
    if (found == patch_of_face_.end()) return -1;
    auto const& [patch, k] = found->second;
    std::size_t const at = patch->keys.find(key);
    if (at == std::string::npos) return -1;
    std::string const name = patch->keys.substr(at + key.size(), patch->keys.find(';', at) - at - key.size());
    for (auto const& other : all_.patches)
      if (other.name == name) return std::int64_t(other.start + k);
    return -1;
  }
  [[nodiscard]] int owner_part(std::size_t f) const { return part_(all_.owner[f]); }

  void add(int p, int n_parts) {
    PartOfMesh out;
    std::map<std::int64_t, std::int64_t> cell, node;
    for (std::size_t f = 0; f < all_.faces.size(); ++f) {
      if (owner_part(f) == p) cell[all_.owner[f]];
      if (f < all_.neighbour.size() && part_(all_.neighbour[f]) == p) cell[all_.neighbour[f]];
    }
    for (auto& [number, own] : cell) {
      own = std::int64_t(out.cells.size());
      out.cells.push_back(number);
    }
    auto const take = [&](std::size_t f, bool other_way = false) {
      Labels face = all_.faces[f];
      if (other_way) std::reverse(face.begin() + 1, face.end());
      out.lists.faces.push_back(face);
      out.lists.owner.push_back(cell.at(other_way ? all_.neighbour[f] : all_.owner[f]));
      out.faces.push_back(other_way ? -std::int64_t(f) - 1 : std::int64_t(f) + 1);
    };
    auto const patch = [&](std::string const& name, std::string const& keys, auto const& body) {
      std::size_t const start = out.faces.size();
      body();
      out.lists.patches.push_back({name, keys, start, out.faces.size() - start});
    };
    std::size_t const n_inside = all_.neighbour.size();
    for (std::size_t f = 0; f < n_inside; ++f)
      if (owner_part(f) == p && part_(all_.neighbour[f]) == p) {
        take(f);
        out.lists.neighbour.push_back(cell.at(all_.neighbour[f]));
      }
    for (auto const& whole : all_.patches)
      patch(whole.name, whole.keys, [&] {
        for (std::size_t f = whole.start; f < whole.start + whole.size; ++f)
          if (owner_part(f) == p && (opposite(f) < 0 || owner_part(std::size_t(opposite(f))) == p)) take(f);
      });
    for (int q = 0; q < n_parts; ++q) {
      if (q == p) continue;
      std::string const name = "procBoundary" + std::to_string(p) + "to" + std::to_string(q),
                        keys = " myProcNo " + std::to_string(p) + "; neighbProcNo " + std::to_string(q) + ";";
      patch(name, "type processor; inGroups 1(processor);" + keys, [&] {
        for (std::size_t f = 0; f < n_inside; ++f) {
          if (owner_part(f) == p && part_(all_.neighbour[f]) == q) take(f);
          if (owner_part(f) == q && part_(all_.neighbour[f]) == p) take(f, true);
        }
      });
      for (auto const& whole : all_.patches) {
        if (whole.keys.find("type cyclic;") == std::string::npos) continue;
        patch(name + "through" + whole.name, "type processorCyclic;" + keys + " referPatch " + whole.name + ";", [&] {
          for (std::size_t f = whole.start; f < whole.start + whole.size; ++f)
            if (owner_part(f) == p && owner_part(std::size_t(opposite(f))) == q) take(f);
        });
      }
    }
    for (auto const& face : out.lists.faces)
      for (std::int64_t const n : face) node[n];
    for (auto& [number, own] : node) {
      own = std::int64_t(out.points.size());
      out.points.push_back(number);
      out.lists.points.push_back(all_.points[number]);
    }
    for (auto& face : out.lists.faces)
      for (std::int64_t& n : face) n = node.at(n);
    parts.push_back(std::move(out));
  }

  FoamLists const& all_;
  std::function<int(std::int64_t)> part_;
  std::map<std::size_t, std::pair<FoamLists::PatchOfFaces const*, std::size_t>> patch_of_face_;
};

/// The numbers of a points file in text.
std::vector<Vec3> points_of(fs::path const& file) {
  std::ifstream in(file);
  std::vector<Vec3> out;
  for (std::string line; std::getline(in, line);) {
    Vec3 p;
    if (std::sscanf(line.c_str(), "(%lf %lf %lf)", &p.x, &p.y, &p.z) == 3) out.push_back(p);
  }
  return out;
}

/// Volume of all hexahedra, by their corners in SIDS order: six tetrahedra each.
double volume(Mesh const& mesh) {
  double sum = 0;
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    auto const c = mesh.elements.corners(e);
    EXPECT_EQ(c.size(), 8U);
    auto const x = [&](int k) { return mesh.coordinates[c[k]]; };
    for (auto const& t : {std::array{0, 1, 2, 6}, std::array{0, 2, 3, 6}, std::array{0, 3, 7, 6},
                          std::array{0, 7, 4, 6}, std::array{0, 4, 5, 6}, std::array{0, 5, 1, 6}})
      sum += dot(cross(x(t[1]) - x(t[0]), x(t[2]) - x(t[0])), x(t[3]) - x(t[0])) / 6;
  }
  return sum;
}

void expect_equal(Mesh const& a, Mesh const& b, double tolerance) {
  ASSERT_EQ(a.n_nodes(), b.n_nodes());
  for (Index n = 0; n < a.n_nodes(); ++n) EXPECT_LE(distance(a.coordinates[n], b.coordinates[n]), tolerance);
  EXPECT_EQ(a.elements.nodes.item, b.elements.nodes.item);
  ASSERT_EQ(a.patches.size(), b.patches.size());
  for (std::size_t p = 0; p < a.patches.size(); ++p) EXPECT_EQ(a.patches[p].faces.item, b.patches[p].faces.item);
}

TEST(OpenFoam, ABoxIsHexahedraWithItsPatches) {
  TemporaryFolder const folder;
  FoamBox box;
  box.keys["x0"] = "type patch; inGroups 2(rotor fluid);";
  box.keys["z1"] = "type symmetryPlane;";
  box.write(folder / "case" / "constant" / "polyMesh");
  Mesh const mesh = read_mesh((folder / "case").string());
  EXPECT_EQ(mesh.n_elements(), 12);
  EXPECT_NEAR(volume(mesh), 0.3 * 0.6 * 1.4, 1e-15);
  ASSERT_EQ(mesh.patches.size(), 6U);
  EXPECT_EQ(mesh.patches[0].name, "x0");
  EXPECT_EQ(mesh.patches[0].families, (std::vector<std::string>{"x0", "rotor", "fluid"}));
  EXPECT_EQ(mesh.patches[0].faces.size(), 4);
  EXPECT_EQ(mesh.patches[1].kind, PatchKind::wall);
  EXPECT_TRUE(mesh.patches[1].families.empty());
  EXPECT_EQ(mesh.patches[5].kind, PatchKind::symmetry);
  EXPECT_EQ(look_at_mesh((folder / "case").string()).format, MeshFormat::openfoam);
  // The folder above polyMesh, polyMesh itself, and ParaView's empty file.
  std::ofstream((folder / "case" / "case.foam").string());
  for (char const* path : {"case/constant", "case/constant/polyMesh", "case/case.foam"})
    expect_equal(mesh, read_mesh((folder / path).string()), 0);
}

TEST(OpenFoam, TextAndBinaryOfAllSizesAreTheSameMesh) {
  TemporaryFolder const folder;
  FoamBox const box;
  box.write(folder / "text");
  Mesh const text = read_mesh((folder / "text").string());
  for (int const labels : {32, 64})
    for (int const scalars : {32, 64}) {
      fs::path const path = folder / ("binary" + std::to_string(labels) + std::to_string(scalars));
      box.write(path, {true, labels, scalars});
      expect_equal(text, read_mesh(path.string()), scalars == 64 ? 0 : 1e-7);
    }
}

class OpenFoamStored : public ::testing::TestWithParam<Storage> {};

TEST_P(OpenFoamStored, OnlyPointsThatMoveChangeAndAllElseIsCopied) {
  TemporaryFolder const folder;
  FoamBox const box;
  fs::path const from = folder / "case" / "constant" / "polyMesh", to = folder / "moved" / "constant" / "polyMesh";
  box.write(from, GetParam());
  std::ofstream(from / "pointZones") << "anything";
  Mesh const mesh = read_mesh((folder / "case").string());
  Coordinates same(mesh.n_nodes()), moved(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    same.set(n, mesh.coordinates[n]);
    moved.set(n, mesh.coordinates[n] + (n % 3 == 0 ? Vec3{1.0 / 3, -2.0 / 7, 1e-9} : Vec3{}));
  }
  write_morphed((folder / "case").string(), (folder / "same").string(), mesh, same);
  for (char const* name : {"points", "faces", "owner", "neighbour", "boundary", "pointZones"})
    EXPECT_EQ(bytes_of(folder / "same" / "constant" / "polyMesh" / name), bytes_of(from / name)) << name;
  write_morphed((folder / "case").string(), (folder / "moved").string(), mesh, moved);
  EXPECT_EQ(bytes_of(to / "faces"), bytes_of(from / "faces"));
  Mesh const back = read_mesh((folder / "moved").string());
  bool const single = GetParam().scalar_bits == 32 && GetParam().binary;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Vec3 const want = single ? Vec3{float(moved.x(n)), float(moved.y(n)), float(moved.z(n))} : moved[n];
    EXPECT_EQ(back.coordinates[n], want);
  }
  // Once more onto the same output; onto that of another mesh never.
  write_morphed((folder / "case").string(), (folder / "moved").string(), mesh, same);
  FoamBox other;
  other.n = {2, 2, 2};
  other.write(folder / "other" / "constant" / "polyMesh", GetParam());
  std::string const before = bytes_of(folder / "other" / "constant" / "polyMesh" / "points");
  expect_all_in(
      message_of<IoError>([&] { write_morphed((folder / "case").string(), (folder / "other").string(), mesh, moved); }),
      {"holds something else"});
  EXPECT_EQ(bytes_of(folder / "other" / "constant" / "polyMesh" / "points"), before);
}

INSTANTIATE_TEST_SUITE_P(As, OpenFoamStored,
                         ::testing::Values(Storage{}, Storage{true, 32, 64}, Storage{true, 64, 32}));

TEST(OpenFoam, PackedFilesAreReadAndStayPacked) {
  TemporaryFolder const folder;
  fs::path const plain = folder / "plain", packed = folder / "packed";
  FoamBox const box;
  box.write(plain);
  box.write(packed);
  if (std::system(("gzip -n " + (packed / "points").string() + " " + (packed / "faces").string()).c_str()) != 0)
    GTEST_SKIP() << "no gzip here";
  Mesh const mesh = read_mesh(plain.string());
  try {
    expect_equal(mesh, read_mesh(packed.string()), 0);
  } catch (IoError const& e) {
    if (std::string(e.what()).find("without zlib") != std::string::npos) GTEST_SKIP() << e.what();
    throw;
  }
  Coordinates moved(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) moved.set(n, mesh.coordinates[n] + Vec3{0.1, 0.2, 0.3});
  write_morphed(packed.string(), (folder / "out").string(), mesh, moved);
  EXPECT_TRUE(fs::exists(folder / "out" / "points.gz"));
  EXPECT_FALSE(fs::exists(folder / "out" / "points"));
  Mesh const back = read_mesh((folder / "out").string());
  for (Index n = 0; n < mesh.n_nodes(); ++n) EXPECT_EQ(back.coordinates[n], moved[n]);
  // Cut off anywhere.
  std::string const whole = bytes_of(packed / "points.gz");
  for (std::size_t const keep : {std::size_t(5), std::size_t(20), whole.size() / 2, whole.size() - 1}) {
    std::ofstream(packed / "points.gz", std::ios::binary) << whole.substr(0, keep);
    EXPECT_THROW(read_mesh(packed.string()), Error) << keep;
  }
}

/// Points of a later time with the mesh in constant, by the name of the time or as the latest one.
TEST(OpenFoam, TimesHavePointsOfTheirOwn) {
  TemporaryFolder const folder;
  FoamBox const box;
  box.write(folder / "case" / "constant" / "polyMesh");
  for (auto const& [time, factor] : {std::pair("0.5", 2.0), std::pair("10", 3.0), std::pair("2e-1", 4.0)}) {
    FoamBox other = box;
    other.place = [&, f = factor](Index3 const& p) { return f * box.place(p); };
    other.write(folder / "other");
    fs::create_directories(folder / "case" / time / "polyMesh");
    fs::copy_file(folder / "other" / "points", folder / "case" / time / "polyMesh" / "points");
    fs::remove_all(folder / "other");
  }
  fs::create_directories(folder / "case" / "100");  // a time without points
  Mesh const first = read_mesh((folder / "case").string());
  for (auto const& [time, factor] : {std::pair("0.5", 2.0), std::pair("2e-1", 4.0), std::pair("latestTime", 3.0)}) {
    std::string const path = (folder / "case" / time).string();
    EXPECT_EQ(look_at_mesh(path).format, MeshFormat::openfoam);
    Mesh const mesh = read_mesh(path);
    EXPECT_EQ(mesh.elements.nodes.item, first.elements.nodes.item);
    for (Index n = 0; n < mesh.n_nodes(); ++n) EXPECT_EQ(mesh.coordinates[n], factor * first.coordinates[n]);
    // The output is a case that begins there.
    std::string const out = (folder / ("out" + std::string(time))).string();
    write_morphed(path, out, mesh, mesh.coordinates);
    expect_equal(read_mesh(out), mesh, 0);
  }
  EXPECT_THROW(read_mesh((folder / "case" / "100").string()), Error);
}

TEST(OpenFoam, SeriesAreFoldersOfTimes) {
  TemporaryFolder const folder;
  for (bool const flat : {false, true}) {
    FoamBox box;
    if (flat) {
      box.n = {3, 2, 1};
      box.keys["z0"] = box.keys["z1"] = "type empty;";
    }
    std::string const input = (folder / (flat ? "flat" : "case")).string(), output = input + "_out";
    box.write(fs::path(input) / "constant" / "polyMesh");
    Mesh const mesh = read_mesh(input);
    EXPECT_EQ(mesh.dimension, flat ? 2 : 3);
    auto const at = [&](double t) {
      Coordinates moved(mesh.n_nodes());
      for (Index n = 0; n < mesh.n_nodes(); ++n) moved.set(n, mesh.coordinates[n] + t * Vec3{1.0 / 3, 0.1, 0});
      return moved;
    };
    {
      SeriesWriter unfinished(input, output, mesh, {0, 0.25});
      unfinished.add(at(0));
    }
    EXPECT_FALSE(fs::exists(output));
    SeriesWriter series(input, output, mesh, {0, 0.25, 1e-5 + 1});
    for (double const t : {0.0, 0.25, 1e-5 + 1}) series.add(at(t));
    EXPECT_THROW(series.add(at(2)), MeshError);
    series.commit();
    expect_equal(read_mesh(output), mesh, 0);
    for (auto const& [name, t] : {std::pair("0", 0.0), std::pair("0.25", 0.25), std::pair("1.00001", 1e-5 + 1),
                                  std::pair("latestTime", 1e-5 + 1)}) {
      Mesh const step = read_mesh(output + "/" + name);
      Coordinates const want = at(t);
      for (Index n = 0; n < mesh.n_nodes(); ++n) EXPECT_EQ(step.coordinates[n], want[n]) << name;
    }
    EXPECT_EQ(bytes_of(fs::path(output) / "0" / "polyMesh" / "points"),
              bytes_of(fs::path(input) / "constant" / "polyMesh" / "points"));
    expect_all_in(message_of<IoError>([&] { SeriesWriter(input, input + "_again", mesh, {1, 1}); }), {"two times"});
  }
}

TEST(OpenFoam, CyclicsAreConnectionsWithTheirTransform) {
  TemporaryFolder const folder;
  FoamBox shifted;
  shifted.keys["z0"] = "type cyclic; neighbourPatch z1;";
  shifted.keys["z1"] = "type cyclic; neighbourPatch z0;";
  shifted.write(folder / "shifted");
  double const pitch = 0.4;
  FoamBox turned = shifted;
  turned.place = [=](Index3 const& p) {
    double const r = 1 + 0.2 * p[1], a = pitch * p[2] / 2.0;
    return Vec3{0.3 * p[0], r * std::cos(a), r * std::sin(a)};
  };
  turned.write(folder / "turned");
  for (char const* name : {"shifted", "turned"}) {
    Mesh const mesh = read_mesh((folder / name).string());
    EXPECT_EQ(mesh.patches.size(), 4U);
    ASSERT_EQ(mesh.connections.size(), 1U) << name;
    Connection const& c = mesh.connections.front();
    EXPECT_EQ(c.nodes.size(), 12U);
    ASSERT_TRUE(c.periodic);
    for (std::size_t n = 0; n < c.nodes.size(); ++n)
      EXPECT_LE(distance(c.periodic->declared(mesh.coordinates[c.nodes[n]]), mesh.coordinates[c.donor_nodes[n]]),
                1e-14);
    EXPECT_NEAR(norm(c.periodic->rotation_angle_rad), std::string(name) == "turned" ? pitch : 0, 1e-14);
  }
  // Sides that do not fit are patches of their own.
  FoamBox bent = shifted;
  bent.place = [](Index3 const& p) { return Vec3{0.1 * p[0] + 0.02 * p[0] * p[0] * p[2], 0.3 * p[1], 0.7 * p[2]}; };
  bent.write(folder / "bent");
  Mesh const mesh = read_mesh((folder / "bent").string());
  EXPECT_TRUE(mesh.connections.empty());
  EXPECT_EQ(mesh.patches.size(), 6U);
}

TEST(OpenFoam, MappedSidesAreConnectionsWhereTheirNodesMatch) {
  TemporaryFolder const folder;
  double const pitch = 0.4;
  FoamBox shifted, turned, near, coarse;
  shifted.keys["z0"] = "type cyclicAMI; transform translational; separationVector (0 0 1.4); neighbourPatch z1;";
  shifted.keys["z1"] = "type cyclicAMI; transform translational; separationVector (0 0 -1.4); neighbourPatch z0;";
  turned.keys["z0"] =
      "type cyclicAMI; transform rotational; rotationAxis (2 0 0); rotationCentre (5 0 0); neighbourPatch z1;";
  turned.keys["z1"] =
      "type cyclicAMI; transform rotational; rotationAxis (2 0 0); rotationCentre (5 0 0); neighbourPatch z0;";
  // The sides nearly meet in the axis in the second one.
  for (FoamBox* box : {&turned, &near}) {
    double const inner = box == &turned ? 1 : 0;
    box->keys = turned.keys;
    box->place = [=](Index3 const& p) {
      double const r = inner + 0.2 * p[1] + 1e-3, a = pitch * p[2] / 2.0;
      return Vec3{0.3 * p[0], r * std::cos(a), r * std::sin(a)};
    };
  }
  shifted.write(folder / "shifted");
  turned.write(folder / "turned");
  near.write(folder / "near");
  for (char const* name : {"shifted", "turned", "near"}) {
    Mesh const mesh = read_mesh((folder / name).string());
    EXPECT_EQ(mesh.patches.size(), 4U) << name;
    ASSERT_EQ(mesh.connections.size(), 2U) << name;
    EXPECT_EQ(mesh.connections[0].name, "z0");
    EXPECT_EQ(mesh.connections[1].name, "z1");
    for (Connection const& c : mesh.connections) {
      EXPECT_EQ(c.nodes.size(), 12U);
      ASSERT_TRUE(c.periodic);
      for (std::size_t n = 0; n < c.nodes.size(); ++n)
        EXPECT_LE(distance(c.periodic->declared(mesh.coordinates[c.nodes[n]]), mesh.coordinates[c.donor_nodes[n]]),
                  1e-14);
      EXPECT_NEAR(norm(c.periodic->rotation_angle_rad), std::string(name) == "shifted" ? 0 : pitch, 1e-14);
    }
  }
  // Another node on one side is no match, and nothing is lost.
  coarse.keys = shifted.keys;
  coarse.place = [](Index3 const& p) {
    return Vec3{0.1 * p[0] + (p[0] == 1 && p[2] == 2 ? 0.01 : 0), 0.3 * p[1], 0.7 * p[2]};
  };
  coarse.write(folder / "coarse");
  Mesh const mesh = read_mesh((folder / "coarse").string());
  EXPECT_TRUE(mesh.connections.empty());
  EXPECT_EQ(mesh.patches.size(), 6U);
  EXPECT_EQ(mesh.patches[4].kind, PatchKind::connection);
  EXPECT_TRUE(std::any_of(mesh.notes.begin(), mesh.notes.end(), [](std::string const& note) {
    return note.find("'z0' and 'z1' do not match") != std::string::npos;
  }));
}

TEST(OpenFoam, ZonesOfCellsAndFacesAreSubsets) {
  TemporaryFolder const folder;
  FoamBox const box;  // 3 x 2 x 2 cells
  for (Storage const storage : {Storage{}, Storage{true, 32, 64}, Storage{true, 64, 32}}) {
    fs::path const path = folder / ("box" + std::to_string(storage.label_bits) + (storage.binary ? "b" : ""));
    box.write(path, storage);
    FoamWriter const writer(path, storage);
    writer.zones("cellZones", "cellLabels", {{"rotor", {5, 0, 1}}, {"none", {}}});
    writer.zones("faceZones", "faceLabels", {{"cut", {2, 0}}});
    Mesh const mesh = read_mesh(path.string());
    ASSERT_EQ(mesh.subsets.size(), 3U);
    EXPECT_EQ(mesh.subsets[0].name, "rotor");
    EXPECT_EQ(mesh.subsets[0].elements, (std::vector<Index32>{0, 1, 5}));
    EXPECT_EQ(mesh.subsets[0].faces.size(), 0);
    EXPECT_EQ(mesh.subsets[1].name, "none");
    EXPECT_TRUE(mesh.subsets[1].elements.empty());
    EXPECT_EQ(mesh.subsets[2].name, "cut");
    EXPECT_EQ(mesh.subsets[2].faces.size(), 2);
    EXPECT_EQ(mesh.subsets[2].faces[0].size(), 4U);
    // They follow their elements where the mesh is put in another order, and stay in the file.
    Mesh ordered = mesh;
    reorder(ordered, order_by_position(mesh));
    for (std::size_t k = 0; k < 3; ++k) {
      Index const e = ordered.subsets[0].elements[k];
      EXPECT_TRUE(std::ranges::count(mesh.subsets[0].elements, ordered.file_order.element[e]) == 1);
    }
    Coordinates moved(mesh.n_nodes());
    for (Index n = 0; n < moved.size(); ++n) moved.set(n, mesh.coordinates[n] + Vec3{0.5, 0, 0});
    write_morphed(path.string(), (folder / "out").string(), mesh, moved);
    EXPECT_EQ(bytes_of(path / "cellZones"), bytes_of(folder / "out" / "cellZones"));
    fs::remove_all(folder / "out");
    writer.zones("cellZones", "cellLabels", {{"rotor", {5, 12}}});
    expect_all_in(message_of<MeshError>([&] { (void)read_mesh(path.string()); }), {"cellZones", "'rotor'", "12"});
  }
}

TEST(OpenFoam, AMeshOneCellThickIsAPlaneMeshAndBothPlanesMoveAlike) {
  for (int const axis : {0, 1, 2}) {
    SCOPED_TRACE(axis);
    TemporaryFolder const folder;
    FoamBox box;
    int const u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;  // in the plane
    std::string const names = "xyz";
    box.n[axis] = 1;
    box.n[u] = 3;
    box.n[v] = 2;
    std::string const planes = names.substr(std::size_t(axis), 1) + "2";
    box.patches = {};
    for (int const side : {u, v})
      for (char const* end : {"0", "1"}) box.patches.push_back(names.substr(std::size_t(side), 1) + end);
    box.patches.push_back(planes);
    box.keys[planes] = "type empty; inGroups List<word> 1(empty);";
    box.write(folder / "case");
    Mesh const mesh = read_mesh((folder / "case").string());
    EXPECT_EQ(mesh.dimension, 2);
    EXPECT_EQ(mesh.n_nodes(), 12);
    EXPECT_EQ(mesh.n_elements(), 6);
    ASSERT_EQ(mesh.patches.size(), 4U);
    EXPECT_EQ(mesh.patches[0].faces.size(), 2);
    EXPECT_EQ(mesh.patches[2].faces.size(), 3);
    auto const component = [](Vec3 const& p, int k) { return k == 0 ? p.x : k == 1 ? p.y : p.z; };
    EXPECT_EQ(component(plane_normal(mesh), axis), 1);
    EXPECT_TRUE(negative_elements(mesh).empty());
    Coordinates moved(mesh.n_nodes());
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      std::array<double, 3> by{0.01, 0.01, 0.01};
      by[u] = 0.1 / double(n + 3);
      by[axis] = 0;
      moved.set(n, mesh.coordinates[n] + Vec3{by[0], by[1], by[2]});
    }
    write_morphed((folder / "case").string(), (folder / "out").string(), mesh, moved);
    Mesh const back = read_mesh((folder / "out").string());
    for (Index n = 0; n < mesh.n_nodes(); ++n) EXPECT_EQ(back.coordinates[n], moved[n]);
    // Seen as a mesh of volumes, points across the cell differ in nothing else still.
    for (char const* which : {"case", "out"}) {
      std::string text = bytes_of(folder / which / "boundary");
      text.replace(text.find("type empty"), 10, "type patch");
      write_bytes(folder / which / "boundary", text);
    }
    Mesh const before = read_mesh((folder / "case").string()), after = read_mesh((folder / "out").string());
    EXPECT_EQ(after.dimension, 3);
    ASSERT_EQ(after.n_nodes(), 24);
    Index pairs = 0;
    for (Index n = 0; n < 24; ++n)
      for (Index m = 0; m < n; ++m) {
        Vec3 const across = before.coordinates[n] - before.coordinates[m];
        if (component(across, u) != 0 || component(across, v) != 0) continue;
        ++pairs;
        EXPECT_EQ(component(after.coordinates[n], u), component(after.coordinates[m], u));
        EXPECT_EQ(component(after.coordinates[n], v), component(after.coordinates[m], v));
        EXPECT_EQ(component(after.coordinates[n], axis), component(before.coordinates[n], axis));
      }
    EXPECT_EQ(pairs, 12);
  }
}

/// Nodes j = 0 of the two ends k become one, as blockMesh collapses them; the faces between them go.
FoamLists collapsed(FoamBox const& box) {
  FoamLists all = box.lists();
  std::int64_t const layer = (box.n[0] + 1) * (box.n[1] + 1);
  std::map<std::int64_t, std::int64_t> number;
  auto const kept = [&](std::int64_t n) { return n >= layer && n - layer <= box.n[0] ? n - layer : n; };
  FoamLists out;
  for (std::int64_t n = 0; n < std::int64_t(all.points.size()); ++n)
    if (kept(n) == n) {
      number[n] = std::int64_t(out.points.size());
      out.points.push_back(all.points[n]);
    }
  out.neighbour = all.neighbour;
  out.patches = all.patches;
  for (auto& patch : out.patches) patch.size = 0;
  for (std::size_t f = 0; f < all.faces.size(); ++f) {
    FoamLists::Labels face;
    for (std::int64_t const n : all.faces[f])
      if (auto const to = number.at(kept(n)); std::find(face.begin(), face.end(), to) == face.end()) face.push_back(to);
    if (face.size() < 3) continue;
    for (std::size_t p = 0; p < all.patches.size(); ++p)
      if (f >= all.patches[p].start && f < all.patches[p].start + all.patches[p].size && out.patches[p].size++ == 0)
        out.patches[p].start = out.faces.size();
    out.faces.push_back(face);
    out.owner.push_back(all.owner[f]);
  }
  for (auto& patch : out.patches)
    if (patch.size == 0) patch.start = out.faces.size();
  return out;
}

TEST(OpenFoam, TheTwoPlanesOfAWedgeStayPlanesAndCopies) {
  double const half = 2.5 * std::numbers::pi / 180;
  for (int const turn : {0, 1, 2})  // the axis along x, y, z
    for (bool const hole : {false, true}) {
      SCOPED_TRACE(std::to_string(turn) + (hole ? ", with a hole" : ""));
      auto const to_mesh = [&](Vec3 const& p) {
        return turn == 0 ? p : turn == 1 ? Vec3{p.z, p.x, p.y} : Vec3{p.y, p.z, p.x};
      };
      auto const on_side = [&](Vec3 const& p, double angle) {  // of a point between
        return to_mesh({p.x, p.y * std::cos(angle), p.y * std::sin(angle)});
      };
      TemporaryFolder const folder;
      FoamBox box;
      box.n = {4, 3, 1};
      for (char const* side : {"z0", "z1"}) box.keys[side] = "type wedge;";
      if (!hole) box.keys["y0"] = "type empty;";
      auto const between = [&](Index3 const& p) { return Vec3{0.3 * p[0], (hole ? 0.5 : 0) + 0.2 * p[1], 0}; };
      box.place = [&](Index3 const& p) { return on_side(between(p), p[2] == 0 ? -half : half); };
      (hole ? box.lists() : collapsed(box)).write(folder / "case");
      Mesh const mesh = read_mesh((folder / "case").string());
      ASSERT_EQ(mesh.dimension, 2);
      ASSERT_EQ(mesh.n_nodes(), 20);
      EXPECT_EQ(mesh.n_elements(), 12);
      EXPECT_TRUE(negative_elements(mesh).empty());
      ASSERT_EQ(mesh.patches.size(), 4U);
      Patch const& inner = *std::find_if(mesh.patches.begin(), mesh.patches.end(),
                                         [](Patch const& patch) { return patch.name == "y0"; });
      EXPECT_EQ(inner.faces.size(), 4);
      EXPECT_EQ(inner.kind, hole ? PatchKind::wall : PatchKind::symmetry);
      // What is moved, by where it was.
      auto const goes_to = [&](Vec3 const& p) {
        return p + Vec3{0.01 + 0.02 * p.y * p.y, p.y == 0 ? 0 : 0.03 * std::sin(5 * p.x), 0};
      };
      auto const back = [&](Vec3 const& p) {
        return turn == 0 ? p : turn == 1 ? Vec3{p.y, p.z, p.x} : Vec3{p.z, p.x, p.y};
      };
      Coordinates moved(mesh.n_nodes());
      for (Index n = 0; n < mesh.n_nodes(); ++n) {
        Vec3 const p = back(mesh.coordinates[n]);
        EXPECT_EQ(p.z, 0);
        EXPECT_NEAR(std::remainder(p.x, 0.3), 0, 1e-15);
        EXPECT_NEAR(std::remainder(p.y - (hole ? 0.5 : 0), 0.2), 0, 1e-14);
        moved.set(n, to_mesh(goes_to(p)));
      }
      write_morphed((folder / "case").string(), (folder / "same").string(), mesh, mesh.coordinates);
      EXPECT_EQ(bytes_of(folder / "same" / "points"), bytes_of(folder / "case" / "points"));
      write_morphed((folder / "case").string(), (folder / "out").string(), mesh, moved);
      auto const before = points_of(folder / "case" / "points"), after = points_of(folder / "out" / "points");
      ASSERT_EQ(before.size(), hole ? 40U : 35U);
      ASSERT_EQ(after.size(), before.size());
      for (std::size_t n = 0; n < before.size(); ++n) {
        Vec3 const p = back(before[n]);
        double const r = std::hypot(p.y, p.z);
        EXPECT_LT(distance(after[n], on_side(goes_to({p.x, r, 0}), std::atan2(p.z, p.y))), 1e-14) << n;
      }
    }
  // Planes that are no copies of one another are sides of a mesh of volumes.
  TemporaryFolder const folder;
  FoamBox box;
  box.n = {4, 3, 1};
  for (char const* side : {"z0", "z1"}) box.keys[side] = "type wedge;";
  box.place = [&](Index3 const& p) {
    double const r = 0.5 + 0.2 * p[1] + (p[0] == 1 && p[2] == 1 ? 0.01 : 0), a = p[2] == 0 ? -half : half;
    return Vec3{0.3 * p[0], r * std::cos(a), r * std::sin(a)};
  };
  box.write(folder / "case");
  Mesh const mesh = read_mesh((folder / "case").string());
  EXPECT_EQ(mesh.dimension, 3);
  ASSERT_FALSE(mesh.notes.empty());
  EXPECT_NE(mesh.notes.back().find("no copies of one another"), std::string::npos);
}

TEST(OpenFoam, DecomposedMeshesAreReadAsOneAndWrittenAsTheyLie) {
  FoamBox box;
  box.n = {4, 3, 2};
  box.keys["z0"] = "type cyclic; neighbourPatch z1;";
  box.keys["z1"] = "type cyclic; neighbourPatch z0;";
  box.keys["x1"] = "type patch; inGroups 1(rotor);";
  FoamLists const lists = box.lists();
  auto const moved_by = [](Vec3 const& p) { return p + Vec3{0.01 * std::sin(9 * p.y), 1.0 / 3 * p.x, -0.02 * p.z}; };
  struct How {
    int n_parts;
    std::function<int(std::int64_t)> part;
  };
  for (How const& how :
       {How{2, [](std::int64_t c) { return int(c % 4 / 2); }}, How{2, [](std::int64_t c) { return int(c / 12); }},
        How{3, [](std::int64_t c) { return int(7 * c % 3); }}})
    for (auto const& [addressing, binary] : {std::pair(true, false), {false, how.n_parts == 3}}) {
      SCOPED_TRACE(std::to_string(how.n_parts) + (addressing ? " with" : " without") + " addressing");
      TemporaryFolder const folder;
      lists.write(folder / "whole" / "constant" / "polyMesh");
      Cut const cut(lists, how.n_parts, how.part);
      cut.write(folder / "case", addressing, {binary, 32, 64});
      std::string const path = (folder / "case").string(), out = (folder / "out").string();
      Mesh const whole = read_mesh((folder / "whole").string()), mesh = read_mesh(path);
      EXPECT_EQ(look_at_mesh(path).format, MeshFormat::openfoam);
      ASSERT_EQ(mesh.n_nodes(), whole.n_nodes());
      EXPECT_NEAR(volume(mesh), volume(whole), 1e-15);
      if (addressing) expect_equal(mesh, whole, 0);
      ASSERT_EQ(mesh.patches.size(), whole.patches.size());
      for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
        EXPECT_EQ(mesh.patches[p].name, whole.patches[p].name);
        EXPECT_EQ(mesh.patches[p].families, whole.patches[p].families);
        EXPECT_EQ(mesh.patches[p].faces.size(), whole.patches[p].faces.size());
      }
      ASSERT_EQ(mesh.connections.size(), 1U);
      EXPECT_EQ(mesh.connections[0].nodes.size(), whole.connections[0].nodes.size());
      for (std::size_t n = 0; n < mesh.connections[0].nodes.size(); ++n)
        EXPECT_LT(distance(mesh.coordinates[mesh.connections[0].nodes[n]] + Vec3{0, 0, 1.4},
                           mesh.coordinates[mesh.connections[0].donor_nodes[n]]),
                  1e-14);
      if (addressing) {
        EXPECT_EQ(mesh.connections[0].nodes, whole.connections[0].nodes);
      }
      Coordinates moved(mesh.n_nodes());
      for (Index n = 0; n < mesh.n_nodes(); ++n) moved.set(n, moved_by(mesh.coordinates[n]));
      write_morphed(path, out, mesh, moved);
      expect_equal(read_mesh((folder / "out" / "processor1").string()), read_mesh(out), 0);
      for (std::size_t p = 0; p < cut.parts.size(); ++p) {
        fs::path const place = fs::path("processor" + std::to_string(p)) / "constant" / "polyMesh";
        for (char const* name : {"faces", "owner", "neighbour", "boundary"})
          EXPECT_EQ(bytes_of(folder / "out" / place / name), bytes_of(folder / "case" / place / name)) << name;
        if (binary) continue;
        auto const points = points_of(folder / "out" / place / "points");
        ASSERT_EQ(points.size(), cut.parts[p].points.size());
        for (std::size_t n = 0; n < points.size(); ++n)
          EXPECT_EQ(points[n], moved_by(lists.points[cut.parts[p].points[n]])) << n;
      }
      SeriesWriter series(path, (folder / "times").string(), mesh, {0.25});
      series.add(moved);
      series.commit();
      Mesh const step = read_mesh((folder / "times" / "0.25").string());
      for (Index n = 0; n < mesh.n_nodes(); ++n) EXPECT_EQ(step.coordinates[n], moved[n]);
    }
}

TEST(OpenFoam, PlaneMeshesMayBeDecomposed) {
  FoamBox box;
  box.n = {4, 1, 3};
  box.keys["y0"] = box.keys["y1"] = "type empty;";
  FoamLists const lists = box.lists();
  TemporaryFolder const folder;
  Cut const cut(lists, 2, [](std::int64_t c) { return int(c % 4 / 2); });
  cut.write(folder / "case", true);
  std::string const path = (folder / "case").string();
  Mesh const mesh = read_mesh(path);
  EXPECT_EQ(mesh.dimension, 2);
  ASSERT_EQ(mesh.n_nodes(), 20);
  auto const moved_by = [](Vec3 const& p) { return p + Vec3{0.01 * p.z, 0, 0.02 * p.x}; };
  Coordinates moved(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) moved.set(n, moved_by(mesh.coordinates[n]));
  write_morphed(path, (folder / "out").string(), mesh, moved);
  for (std::size_t p = 0; p < cut.parts.size(); ++p) {
    auto const points =
        points_of(folder / "out" / ("processor" + std::to_string(p)) / "constant" / "polyMesh" / "points");
    ASSERT_EQ(points.size(), cut.parts[p].points.size());
    for (std::size_t n = 0; n < points.size(); ++n)
      EXPECT_EQ(points[n], moved_by(lists.points[cut.parts[p].points[n]])) << n;
  }
}

TEST(OpenFoam, PartsThatAreMissingOrElsewhereAreSaid) {
  FoamBox const box;
  FoamLists const lists = box.lists();
  TemporaryFolder const folder;
  Cut cut(lists, 2, [](std::int64_t c) { return int(c % 3 / 2); });
  cut.write(folder / "case", false);
  std::string const path = (folder / "case").string();
  auto const said = [&] { return message_of<MeshError>([&] { (void)read_mesh(path); }); };
  fs::rename(folder / "case" / "processor1", folder / "processor1");
  expect_all_in(said(), {"'procBoundary0to1'", "processor1", "reconstructParMesh"});
  for (auto& p : cut.parts[1].lists.points) p.y += 1e-3;
  cut.write(folder / "case", false);
  expect_all_in(said(), {"face 0 of patch 'procBoundary0to1'", "0.001 apart", "decomposePar"});
  for (auto& p : cut.parts[1].lists.points) p.y -= 1e-3;
  cut.parts[1].lists.patches.back().size -= 1;
  cut.write(folder / "case", false);
  EXPECT_THROW((void)read_mesh(path), Error);
  fs::create_directories(folder / "collated" / "processors4" / "constant");
  expect_all_in(message_of<IoError>([&] { (void)read_mesh((folder / "collated").string()); }), {"uncollated"});
  // The mesh as a whole comes first, and a note says that there are parts.
  cut.parts[1].lists.patches.back().size += 1;
  cut.write(folder / "case", false);
  lists.write(folder / "case" / "constant" / "polyMesh");
  Mesh const whole = read_mesh(path);
  ASSERT_FALSE(whole.notes.empty());
  expect_all_in(whole.notes.back(), {"processor0"});
  EXPECT_TRUE(read_mesh((folder / "case" / "processor0").string()).notes.empty());
}

TEST(OpenFoam, KeysOfPatchesMayBeDictionaries) {
  TemporaryFolder const folder;
  FoamBox box;
  box.write(folder / "plain");
  box.keys["x1"] = "type wall; surface { type none; inner { a 1; } } list ((1 2) { b 3; }); last { c \"}\"; };";
  box.write(folder / "nested");
  Mesh const plain = read_mesh((folder / "plain").string()), nested = read_mesh((folder / "nested").string());
  expect_equal(plain, nested, 0);
  EXPECT_EQ(nested.patches[1].name, plain.patches[1].name);
  EXPECT_EQ(nested.patches[1].faces.item, plain.patches[1].faces.item);
  box.keys["x1"] = "type wall; surface { type none;";
  box.write(folder / "open");
  EXPECT_NE(message_of<IoError>([&] { read_mesh((folder / "open").string()); }), "");
}

TEST(OpenFoam, PartsOfDecomposedMeshesAndCasesWithoutMeshAreRefused) {
  TemporaryFolder const folder;
  FoamBox box;
  box.keys["x1"] = "type processor; myProcNo 0;";
  box.write(folder / "part");
  expect_all_in(message_of<MeshError>([&] { read_mesh((folder / "part").string()); }), {"'x1'", "reconstructParMesh"});
  fs::create_directories(folder / "bare" / "system");
  expect_all_in(message_of<IoError>([&] { read_mesh((folder / "bare").string()); }), {"without a mesh", "blockMesh"});
}

TEST(OpenFoam, ListsOfOneValueAskForNoMoreThanTheMeshCanHave) {
  TemporaryFolder const folder;
  FoamBox const box;
  box.write(folder / "case", {});
  fs::path const owner = folder / "case" / "owner";
  std::string const whole = bytes_of(owner), head = whole.substr(0, whole.find('}') + 1);
  for (char const* list : {"2000000000{0}", "\n\n2000000000 { 0 }"}) {
    std::ofstream(owner, std::ios::binary) << head << "\n" << list << "\n";
    expect_all_in(message_of<IoError>([&] { (void)read_mesh((folder / "case").string()); }),
                  {"owner:", "2000000000 values that are all alike"});
  }
}

TEST(OpenFoam, BinaryListsEndBeforeTheFileDoes) {
  TemporaryFolder const folder;
  FoamBox const box;
  box.write(folder / "case", {true, 32, 64});
  for (char const* name : {"owner", "points", "faces"}) {
    fs::path const path = folder / "case" / name;
    std::string const whole = bytes_of(path);
    std::size_t const end = whole.rfind(')');
    for (std::size_t less = 0; less < 4; ++less) {  // without the bracket, and the last number cut
      std::ofstream(path, std::ios::binary) << whole.substr(0, end - less);
      EXPECT_THROW((void)read_mesh((folder / "case").string()), IoError) << name << " " << less;
    }
    std::ofstream(path, std::ios::binary) << whole;
  }
}

TEST(OpenFoam, PackedFilesThatUnpackWithoutEndAreRefused) {
  TemporaryFolder const folder;
  FoamBox const box;
  box.write(folder / "case");
  std::string const points = (folder / "case" / "points").string();
  if (std::system(("{ cat " + points + "; head -c 60000000 /dev/zero | tr '\\0' ' '; } | gzip -9 > " + points +
                   ".gz && rm " + points)
                      .c_str()) != 0)
    GTEST_SKIP() << "no gzip here";
  std::string const said = message_of<IoError>([&] { (void)read_mesh((folder / "case").string()); });
  if (said.find("without zlib") != std::string::npos) GTEST_SKIP() << said;
  expect_all_in(said, {"points.gz", "100 times", "gunzip"});
}

TEST(OpenFoam, CoordinatesThatAreTooLargeAreRefusedWithTheirLine) {
  TemporaryFolder const folder;
  fs::path const path = folder / "large";
  FoamBox const box;
  box.write(path, {});
  std::string points = bytes_of(path / "points");
  auto const line = points.find("\n(", points.find("\n(") + 2);
  auto const end = points.find(' ', line);
  std::ofstream(path / "points", std::ios::binary) << points.replace(line + 2, end - line - 2, "1e400");
  expect_all_in(message_of<Error>([&] { (void)read_mesh(path.string()); }), {"points:", "'1e400'", "larger than"});
}

TEST(OpenFoam, CellsThatDoNotCloseAreRefused) {
  TemporaryFolder const folder;
  fs::path const path = folder / "open";
  FoamBox const box;
  box.write(path, {});
  EXPECT_NO_THROW((void)read_mesh(path.string()));
  // One face of four corners the other way round.
  std::string faces = bytes_of(path / "faces");
  auto const at = faces.find("4(");
  auto const end = faces.find(')', at);
  std::istringstream corners(faces.substr(at + 2, end - at - 2));
  std::array<int, 4> c{};
  for (int& one : c) corners >> one;
  std::string const turned =
      std::to_string(c[3]) + " " + std::to_string(c[2]) + " " + std::to_string(c[1]) + " " + std::to_string(c[0]);
  std::ofstream(path / "faces", std::ios::binary) << faces.replace(at + 2, end - at - 2, turned);
  expect_all_in(message_of<Error>([&] { (void)read_mesh(path.string()); }), {"do not close", "checkMesh"});
}

TEST(OpenFoam, DamagedFilesAreRefusedAndNothingElseHappens) {
  TemporaryFolder const folder;
  for (Storage const storage : {Storage{}, Storage{true, 32, 64}}) {
    fs::path const path = folder / (storage.binary ? "binary" : "text");
    FoamBox const box;
    box.write(path, storage);
    FoamWriter const writer(path, storage);
    writer.zones("cellZones", "cellLabels", {{"rotor", {1, 2, 3, 4, 5, 6, 7, 8}}, {"stator", {0, 9, 10, 11}}});
    writer.zones("faceZones", "faceLabels", {{"cut", {0, 1, 2, 3, 4, 5, 6, 7, 8}}});
    for (char const* name : {"points", "faces", "owner", "neighbour", "boundary", "cellZones", "faceZones"}) {
      std::string const whole = bytes_of(path / name);
      auto const with = [&](std::string const& bytes) {
        std::ofstream(path / name, std::ios::binary) << bytes;
        try {
          (void)read_mesh(path.string());
        } catch (Error const&) {  // or it is another mesh, which is as good
        }
      };
      for (std::size_t keep = 0; keep < whole.size(); keep += whole.size() / 23 + 1) {
        std::ofstream(path / name, std::ios::binary) << whole.substr(0, keep);
        if (keep + 40 < whole.size()) {
          EXPECT_THROW(read_mesh(path.string()), Error) << name << " " << keep;
        }
      }
      Random random(5);
      for (int n = 0; n < 60; ++n) {
        std::string other = whole;
        for (int k = 0; k < 3; ++k) other[random.below(int(other.size()))] = char(random.below(256));
        with(other);
      }
      with(whole + whole);
      std::ofstream(path / name, std::ios::binary) << whole;
    }
    EXPECT_NO_THROW(read_mesh(path.string()));
  }
}

}  // namespace
}  // namespace gridmorph::test
