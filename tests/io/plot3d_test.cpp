// PLOT3D files of every kind: read, written again in the same kind, and refused when damaged.
#include "block_lattice.hpp"
#include "io_support.hpp"
#include "support/plot3d_file.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <random>

namespace gridmorph::test {
namespace {

Mesh lattice(Plot3dStorage const& s, unsigned seed = 4) {
  Lattice what;
  what.cuts = s.multi ? std::array<std::vector<int>, 3>{{{0, 3, 5}, {0, 4}, {0, 2, 3}}}
                      : std::array<std::vector<int>, 3>{{{0, 5}, {0, 4}, {0, 3}}};
  what.single_precision = !s.wide;
  return LatticeBuilder(what, seed).build();
}

std::vector<Plot3dStorage> every_storage() {
  std::vector<Plot3dStorage> out;
  for (char const kind : {'f', 'u', 'b'})
    for (bool const big : {false, true})
      for (bool const wide : {false, true})
        for (bool const multi : {false, true})
          for (int const dimensions : {2, 3})
            for (bool const blank : {false, true}) {
              if (kind == 'f' && (big || !wide)) continue;
              Plot3dStorage s;
              s.kind = kind;
              s.big = big;
              s.wide = wide;
              s.multi = multi;
              s.dimensions = dimensions;
              s.blank = blank;
              out.push_back(s);
              if (kind != 'u') continue;
              s.longest_record = 37;
              out.push_back(s);
              s.planes = dimensions == 3;
              if (s.planes) out.push_back(s);
              s.longest_record = 0;
              if (s.planes) out.push_back(s);
              s.planes = false;
              s.marker = 8;
              out.push_back(s);
            }
  return out;
}

class Plot3d : public testing::TestWithParam<Plot3dStorage> {
 protected:
  void SetUp() override {
    original_ = lattice(GetParam());
    bytes_ = Plot3dFile(GetParam()).bytes(original_);
    write_bytes(in_, bytes_);
  }
  TemporaryFolder folder_;
  std::string const in_ = folder_.file("in.p3d"), out_ = folder_.file("out.p3d");
  Mesh original_;
  std::string bytes_;
};

INSTANTIATE_TEST_SUITE_P(Storages, Plot3d, testing::ValuesIn(every_storage()),
                         [](auto const& info) { return info.param.name(); });

TEST_P(Plot3d, IsRecognisedAndReadToTheBit) {
  Mesh const mesh = read_mesh(in_);
  ASSERT_EQ(mesh.zones.size(), original_.zones.size());
  bool const flat = GetParam().dimensions == 2;
  EXPECT_EQ(mesh.dimension == 2, flat);
  EXPECT_TRUE(mesh.interfaces.empty());
  EXPECT_EQ(mesh.patches.size(), flat ? 2 * mesh.zones.size() : 0);
  for (std::size_t z = 0; z < mesh.zones.size(); ++z) {
    auto const& zone = mesh.zones[z];
    auto const& from = original_.zones[z];
    EXPECT_EQ(zone.single_precision, GetParam().kind != 'f' && !GetParam().wide);
    for (int k = 0; k < (flat ? 1 : zone.extent[2]); ++k)
      for (int j = 0; j < zone.extent[1]; ++j)
        for (int i = 0; i < zone.extent[0]; ++i) {
          Vec3 p = original_.coordinates[from.node({i, j, k})];
          if (flat) p.z = 0;
          if (!GetParam().wide) p = {float(p.x), float(p.y), float(p.z)};
          ASSERT_EQ(mesh.coordinates[zone.node({i, j, k})], p) << mesh.file_variant;
        }
  }
}

TEST_P(Plot3d, ComesOutByteForByteWhenNothingMoves) {
  Mesh const mesh = read_mesh(in_);
  write_morphed(in_, out_, mesh, mesh.coordinates);
  EXPECT_EQ(bytes_of(out_), bytes_);
}

TEST_P(Plot3d, CarriesNewCoordinatesAndKeepsTheRest) {
  Mesh mesh = read_mesh(in_);
  Mesh expected = original_;
  for (Mesh* m : {&mesh, &expected})
    for (Index n = 0; n < m->n_nodes(); ++n)
      m->coordinates.set(n, {float(2 * m->coordinates.x(n) - 1), float(m->coordinates.y(n) / 4), -m->coordinates.z(n)});
  write_morphed(in_, out_, mesh, mesh.coordinates);
  if (GetParam().kind == 'f') {
    Mesh const again = read_mesh(out_);
    EXPECT_EQ(again.file_variant, mesh.file_variant);
    if (GetParam().dimensions == 3) expect_same_coordinates(again.coordinates, mesh.coordinates);
  } else {
    EXPECT_EQ(bytes_of(out_), Plot3dFile(GetParam()).bytes(expected));
  }
  write_morphed(in_, in_, mesh, mesh.coordinates);  // onto itself
  EXPECT_EQ(bytes_of(in_), bytes_of(out_));
}

TEST_P(Plot3d, CutAnywhereItIsRefused) {
  // A number that is cut short is a number all the same.
  std::size_t const last_number = GetParam().kind == 'f' ? bytes_.find_last_of(' ') + 1 : bytes_.size();
  for (std::size_t length = 0; length < last_number; length += 1 + length / 40) {
    SCOPED_TRACE(length);
    write_bytes(in_, bytes_.substr(0, length));
    auto const message = message_of<IoError>([&] { read_mesh(in_); });
    EXPECT_NE(message.find("in.p3d"), std::string::npos) << message;
  }
  write_bytes(in_, bytes_ + std::string(5, '7'));
  EXPECT_THROW(read_mesh(in_), IoError);
}

TEST_P(Plot3d, OverwrittenBytesGiveAMeshOrAnErrorAndNothingElse) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string damaged = bytes_;
    // Half of them in the header, where they hurt.
    for (unsigned n = 0; n <= seed % 6; ++n)
      damaged[random() % (seed % 2 == 0 ? damaged.size() : std::min<std::size_t>(damaged.size(), 64))] = char(random());
    write_bytes(in_, damaged);
    try {
      Mesh const mesh = read_mesh(in_);
      write_morphed(in_, out_, mesh, mesh.coordinates);
    } catch (Error const&) {
    }
  }
}

// 1, a, b can be one zone of a x b nodes, or the extents of a zone of 1 x a x b; x, y, z have as many bytes as x, y,
// iblank.
TEST(Plot3dFiles, ThatCouldBeSeveralThingsMustBeStated) {
  TemporaryFolder const folder;
  auto const path = folder.file("plane.p3d");
  std::string bytes;
  auto const put = [&](auto v) { bytes.append(reinterpret_cast<char const*>(&v), 4); };
  for (std::int32_t const n : {1, 3, 4}) put(n);
  for (int n = 0; n < 24; ++n) put(float(n % 3) + float(n % 5));
  for (int n = 0; n < 12; ++n) put(std::int32_t(0));
  write_bytes(path, bytes);
  auto const message = message_of<IoError>([&] { read_mesh(path); });
  for (auto const* part :
       {"plane.p3d", "several", "side file", "binary, little-endian, single, multi-block, 2-D, iblank",
        "binary, little-endian, single, single-block, 3-D, no-iblank"})
    EXPECT_NE(message.find(part), std::string::npos) << message;
  EXPECT_EQ(read_mesh(path, {.plot3d_format = "2-D"}).zones.front().extent, (Index3{3, 4, 2}));
  Mesh const mesh = read_mesh(path, {.plot3d_format = "3-D, single"});
  EXPECT_EQ(mesh.zones.front().extent, (Index3{2, 3, 4}));
  write_morphed(path, folder.file("out.p3d"), mesh, mesh.coordinates);
  EXPECT_EQ(bytes_of(folder.file("out.p3d")), bytes);
  EXPECT_THROW(read_mesh(path, {.plot3d_format = "double"}), IoError);
  EXPECT_NE(message_of<IoError>([&] { read_mesh(path, {.plot3d_format = "dubble"}); }).find("'dubble'"),
            std::string::npos);
  // Marks decide where they are marks and no numbers.
  bytes[bytes.size() - 4] = 1;
  write_bytes(path, bytes);
  EXPECT_EQ(read_mesh(path).zones.front().extent, (Index3{3, 4, 2}));
}

TEST(Plot3dFiles, PlaneByPlaneWithoutRecordsMustBeStated) {
  TemporaryFolder const folder;
  auto const path = folder.file("in.p3d"), out = folder.file("out.p3d");
  for (char const kind : {'f', 'b'})
    for (bool const multi : {false, true})
      for (bool const blank : {false, true}) {
        Plot3dStorage s;
        s.kind = kind;
        s.multi = multi;
        s.blank = blank;
        s.planes = true;
        SCOPED_TRACE(s.name());
        Mesh original = lattice(s);
        write_bytes(path, Plot3dFile(s).bytes(original));
        Mesh mesh = read_mesh(path, {.plot3d_format = "planes"});
        expect_same_coordinates(mesh.coordinates, original.coordinates);
        EXPECT_NE(mesh.file_variant.find("planes"), std::string::npos);
        write_morphed(path, out, mesh, mesh.coordinates);
        EXPECT_EQ(bytes_of(out), bytes_of(path));
        for (Mesh* m : {&mesh, &original})
          for (Index n = 0; n < m->n_nodes(); ++n) m->coordinates.set(n, 2.0 * m->coordinates[n]);
        write_morphed(path, out, mesh, mesh.coordinates);
        expect_same_coordinates(read_mesh(out, {.plot3d_format = "planes"}).coordinates, original.coordinates);
      }
}

TEST(Plot3dFiles, OfPlanesThatAreStatedToBeWholeAreRefused) {
  TemporaryFolder const folder;
  Plot3dStorage s;
  s.planes = true;
  write_bytes(folder.file("in.p3d"), Plot3dFile(s).bytes(lattice(s)));
  EXPECT_EQ(read_mesh(folder.file("in.p3d")).file_variant.substr(0, 11), "unformatted");
  EXPECT_THROW(read_mesh(folder.file("in.p3d"), {.plot3d_format = "whole"}), IoError);
}

TEST(Plot3dText, IsReadAsFortranCompilersWriteIt) {
  TemporaryFolder const folder;
  auto const path = folder.file("in.fmt"), out = folder.file("out.fmt");
  std::string const text =
      "           1\r\n 2,2, 2\n 0.D0 1.0d+00 0. +1 2*0,1*1.0E0 1\n 4*0.0000000000000000E+00 4*1.5\n 2*0 2*.25-1 2*0 "
      "2*1.25e-2\n";
  write_bytes(path, text);
  Mesh mesh = read_mesh(path);
  ASSERT_EQ(mesh.n_nodes(), 8);
  EXPECT_EQ(mesh.coordinates[3], (Vec3{1, 0, 0.025}));
  EXPECT_EQ(mesh.coordinates[7], (Vec3{1, 1.5, 0.0125}));
  write_morphed(path, out, mesh, mesh.coordinates);
  EXPECT_EQ(bytes_of(out), text);
  mesh.coordinates.y(5) = 1.0 / 3;
  write_morphed(path, out, mesh, mesh.coordinates);
  expect_same_coordinates(read_mesh(out).coordinates, mesh.coordinates);
}

TEST(Plot3dText, KeepsItsColumns) {
  TemporaryFolder const folder;
  auto const path = folder.file("in.fmt"), out = folder.file("out.fmt");
  std::string text = "1\n2 2 2\n";
  for (int n = 0; n < 24; ++n) text += n % 4 == 3 ? "    1.250000\n" : "    0.500000";
  write_bytes(path, text);
  Mesh mesh = read_mesh(path);
  mesh.coordinates.x(1) = -10.0625;
  mesh.coordinates.x(2) = 7;
  write_morphed(path, out, mesh, mesh.coordinates);
  std::string expected = text;
  expected.replace(expected.find("0.500000", 24) - 4, 24, "  -10.062500    7.000000");
  EXPECT_EQ(bytes_of(out).size(), text.size());
  EXPECT_EQ(bytes_of(out), expected);
}

TEST(Plot3dText, RefusesWordsAndRunawayRepeatsByName) {
  TemporaryFolder const folder;
  auto const path = folder.file("in.fmt");
  auto const refused = [&](std::string const& text, std::string const& reason) {
    write_bytes(path, text);
    auto const message = message_of<IoError>([&] { read_mesh(path); });
    EXPECT_NE(message.find(reason), std::string::npos) << message;
  };
  refused("1\n2 2 2\n" + std::string(5000, ' ') + "one\n", "in.fmt:3: 'one' is not a number");
  refused("1\n2 2 2\n4000000000*0.5\n", "repeats a number more often");
  refused("1\n100000 100000 100000\n0.5\n", "no extents of zones");
  refused("1\n2 2 2\n24*0.5 3\n", "it should have 28 numbers");
}

TEST(Plot3dFiles, HaveNoPlaceForSolutions) {
  TemporaryFolder const folder;
  Plot3dStorage const storage;
  write_bytes(folder.file("in.p3d"), Plot3dFile(storage).bytes(lattice(storage)));
  Mesh const mesh = read_mesh(folder.file("in.p3d"));
  OutputFields fields;
  fields.displacement = true;
  EXPECT_THROW(write_morphed(folder.file("in.p3d"), folder.file("out.p3d"), mesh, mesh.coordinates, fields), IoError);
  EXPECT_FALSE(std::filesystem::exists(folder.file("out.p3d")));
}

}  // namespace
}  // namespace gridmorph::test
