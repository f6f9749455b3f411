// Unstructured files that are cut short or overwritten: a mesh or a clear error, no crash, no hang.
#include "io/io_support.hpp"
#include "support/unstructured_meshes.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <random>

namespace gridmorph::test {
namespace {

/// Reads a file and derives what follows from it, whatever it holds.
void try_mesh(std::string const& path) {
  try {
    if (mesh_kind(path) != MeshKind::unstructured) return;
    auto const mesh = read_mesh(path);
    find_face_patches(mesh, make_topology(mesh));
  } catch (Error const& e) {
    // IoError or MeshError, as the damage has it; anything else ends the test.
    EXPECT_NE(std::string(e.what()).find("bad"), std::string::npos) << e.what();
  }
}

/// Few patches: HDF5 1.10 frees memory that it never set when a damaged group of more than 8 members is listed
/// (H5G__dense_iterate), before this library sees anything of it.
Mesh small_mesh() {
  auto mesh = to_prisms_and_tetrahedra(unit_box({2, 2, 3}), 1);
  mesh.patches[5].nodes = patch_nodes(mesh.patches[5]);
  mesh.patches[5].faces = {};
  Connection c;
  c.name = "around";
  c.zone = c.donor_zone = 0;
  c.nodes = patch_nodes(mesh.patches[0]);
  c.donor_nodes = patch_nodes(mesh.patches[1]);
  c.periodic = Periodic{};
  c.periodic->translation = c.periodic->declared.translation = {2, 0, 0};
  mesh.connections.push_back(c);
  mesh.patches.erase(mesh.patches.begin() + 1, mesh.patches.begin() + 5);
  return mesh;
}

class DamagedUnstructured : public testing::TestWithParam<FileFormat> {
 protected:
  void SetUp() override {
    write_mesh(folder_.file("good.cgns"), small_mesh(), {.format = GetParam()});
    bytes_ = bytes_of(folder_.file("good.cgns"));
  }
  TemporaryFolder folder_;
  std::string const bad_ = folder_.file("bad.cgns");
  std::string bytes_;
};
INSTANTIATE_TEST_SUITE_P(Formats, DamagedUnstructured, testing::Values(FileFormat::cgns_hdf5, FileFormat::cgns_adf),
                         [](auto const& info) {
                           return std::string(info.param == FileFormat::cgns_hdf5 ? "hdf5" : "adf");
                         });

TEST_P(DamagedUnstructured, CutAnywhereTheyAreRefused) {
  constexpr std::size_t block = 4096;  // of ADF files; HDF5 files end with their last byte
  for (std::size_t length = 300; length < bytes_.size(); length += bytes_.size() / 61) {
    SCOPED_TRACE(length);
    write_bytes(bad_, bytes_.substr(0, length));
    try {
      read_mesh(bad_);
      EXPECT_TRUE(GetParam() == FileFormat::cgns_adf && length + block > bytes_.size());
    } catch (IoError const& e) {
      EXPECT_NE(std::string(e.what()).find("bad.cgns"), std::string::npos);
    }
  }
}

TEST_P(DamagedUnstructured, OverwrittenBytesGiveAMeshOrAnErrorAndNothingElse) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string damaged = bytes_;
    for (unsigned n = 0; n <= seed % 10; ++n) damaged[random() % damaged.size()] = char(random());
    write_bytes(bad_, damaged);
    try_mesh(bad_);
  }
}

/// Overwrites 32-bit numbers that stand in the lists, so that the damage is in what the reader interprets.
TEST_P(DamagedUnstructured, WrongNumbersInListsGiveAMeshOrAnErrorAndNothingElse) {
  std::array<std::int32_t, 6> const values{-1, 0, 1, 1 << 20, 0x7fffffff, -0x7fffffff - 1};
  unsigned changed = 0;
  for (std::size_t at = 0; at + 4 <= bytes_.size(); at += 4) {
    std::int32_t number = 0;
    std::memcpy(&number, bytes_.data() + at, 4);
    if (number <= 0 || number > 200 || at % 20 != 0) continue;
    std::string damaged = bytes_;
    std::memcpy(damaged.data() + at, &values[changed % values.size()], 4);
    write_bytes(bad_, damaged);
    try_mesh(bad_);
    if (++changed > 250) break;
  }
  EXPECT_GT(changed, 20u);
}

TEST(DamagedSu2, CutAndOverwrittenFilesGiveAMeshOrAnError) {
  TemporaryFolder const folder;
  std::string text = "NDIME= 3\nNELEM= 2\n13 0 1 3 4 5 7\n13 0 3 2 4 7 6\nNPOIN= 8\n";
  for (int n = 0; n < 8; ++n)
    text += std::to_string(n & 1) + " " + std::to_string(n >> 1 & 1) + " " + std::to_string(n >> 2) + "\n";
  text += "NMARK= 1\nMARKER_TAG= wall\nMARKER_ELEMS= 1\n5 0 1 3\n";
  auto const bad = folder.file("bad.su2");
  for (std::size_t length = 0; length < text.size(); ++length) {
    write_bytes(bad, text.substr(0, length));
    try_mesh(bad);
  }
  std::string const alphabet = "0123456789-+.eENMARK_= %\n\t\0x\xff";
  for (unsigned seed = 0; seed < 3000; ++seed) {
    std::mt19937 random(seed);
    std::string damaged = text;
    for (unsigned n = 0; n <= seed % 6; ++n) damaged[random() % damaged.size()] = alphabet[random() % alphabet.size()];
    write_bytes(bad, damaged);
    try_mesh(bad);
  }
}

}  // namespace
}  // namespace gridmorph::test
