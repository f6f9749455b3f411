// Files that are missing, cut short, overwritten or something else altogether: one clear error, no crash, no hang.
#include "block_lattice.hpp"
#include "io_support.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <random>

namespace gridmorph::test {
namespace {

class DamagedFiles : public testing::TestWithParam<FileFormat> {
 protected:
  void SetUp() override {
    mesh_ = LatticeBuilder({{{{0, 2, 4}, {0, 2}, {0, 2}}}}, 4).build();
    write_mesh(good_, mesh_, {.format = GetParam()});
  }
  TemporaryFolder folder_;
  std::string const good_ = folder_.file("good.cgns");
  std::string const bad_ = folder_.file("bad.cgns");
  Mesh mesh_;
};
INSTANTIATE_TEST_SUITE_P(Formats, DamagedFiles, testing::Values(FileFormat::cgns_hdf5, FileFormat::cgns_adf),
                         [](auto const& info) {
                           return std::string(info.param == FileFormat::cgns_hdf5 ? "hdf5" : "adf");
                         });

TEST_P(DamagedFiles, CutAnywhereTheyAreRefused) {
  auto const bytes = bytes_of(good_);
  constexpr std::size_t block = 4096;  // of ADF files; HDF5 files end with their last byte
  int refused = 0;
  for (std::size_t length = 0; length < bytes.size(); length += length < 256 ? 17 : bytes.size() / 83) {
    SCOPED_TRACE(length);
    write_bytes(bad_, bytes.substr(0, length));
    try {
      Mesh const mesh = read_mesh(bad_);
      // What the last block of an ADF file leaves unused can be cut without loss.
      EXPECT_TRUE(GetParam() == FileFormat::cgns_adf && length + block > bytes.size());
      expect_same_coordinates(mesh.coordinates, mesh_.coordinates);
    } catch (IoError const& e) {
      EXPECT_NE(std::string(e.what()).find("bad.cgns"), std::string::npos);
      EXPECT_THROW(write_morphed(bad_, folder_.file("out.cgns"), mesh_, mesh_.coordinates), IoError);
      ++refused;
    }
  }
  EXPECT_GT(refused, 60);
  EXPECT_FALSE(std::filesystem::exists(folder_.file("out.cgns")));
  read_mesh(good_);
}

TEST_P(DamagedFiles, OverwrittenBytesGiveAMeshOrAnErrorAndNothingElse) {
  auto const bytes = bytes_of(good_);
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string damaged = bytes;
    for (unsigned n = 0; n <= seed % 10; ++n) damaged[random() % damaged.size()] = char(random());
    write_bytes(bad_, damaged);
    try {
      read_mesh(bad_);
    } catch (Error const&) {
      // IoError or MeshError, as the damage has it; anything else ends the test.
    }
  }
  expect_same_coordinates(read_mesh(good_).coordinates, mesh_.coordinates);
}

TEST(NotCgns, OtherFilesAreRefusedByName) {
  TemporaryFolder const folder;
  auto const expect = [&](std::string const& name, std::string const& reason) {
    auto const message = message_of<IoError>([&] { read_mesh(folder.file(name)); });
    EXPECT_NE(message.find(name), std::string::npos) << message;
    EXPECT_NE(message.find(reason), std::string::npos) << message;
  };
  expect("missing.cgns", "no such file");
  write_bytes(folder.file("empty.cgns"), "");
  expect("empty.cgns", "is empty");
  write_bytes(folder.file("text.cgns"), "a mesh in words\n");
  expect("text.cgns", "is not a CGNS file");
  std::mt19937 random(1);
  std::string noise(100000, ' ');
  for (auto& c : noise) c = char(random());
  write_bytes(folder.file("noise.cgns"), noise);
  expect("noise.cgns", "is not a CGNS file");
  write_bytes(folder.file("only a signature.cgns"), "\x89HDF\r\n\x1a\n");
  expect("only a signature.cgns", "cannot be opened");
  std::filesystem::create_directory(folder.file("folder.cgns"));
  expect("folder.cgns", "is a folder");
}

}  // namespace
}  // namespace gridmorph::test
