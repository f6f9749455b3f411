// HDF5 files made to break readers: attributes that overflow buffers, links in circles, coordinates that are kept
// somewhere else, arrays without end. Changed with HDF5 itself.
#include "block_lattice.hpp"
#include "io_support.hpp"

#include <gridmorph/core/error.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/io/morphed_file.hpp>

#include <hdf5.h>

#include <array>
#include <cmath>
#include <functional>

namespace gridmorph::test {
namespace {

class HostileHdf5 : public testing::Test {
 protected:
  void SetUp() override {
    mesh_ = LatticeBuilder({{{{0, 2, 4}, {0, 2}, {0, 2}}}}, 4).build();
    write_mesh(path_, mesh_);
    zone_ = "/Base/" + mesh_.zones[0].name;
    other_zone_ = "/Base/" + mesh_.zones[1].name;
    x_ = zone_ + "/GridCoordinates/CoordinateX";
  }

  /// The file as HDF5 sees it.
  void change(std::function<void(hid_t file)> const& how) const {
    hid_t const file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(file, 0);
    how(file);
    H5Fclose(file);
  }
  static void replace_attribute(hid_t file, std::string const& node, char const* name, hid_t type,
                                std::vector<hsize_t> const& sizes) {
    H5Adelete_by_name(file, node.c_str(), name, H5P_DEFAULT);
    hid_t const space =
        sizes.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(int(sizes.size()), sizes.data(), nullptr);
    hid_t const made = H5Acreate_by_name(file, node.c_str(), name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    ASSERT_GE(made, 0);
    if (H5Tis_variable_str(type) <= 0) {
      std::vector<char> const filled(H5Tget_size(type) * std::size_t(H5Sget_simple_extent_npoints(space)), 'A');
      H5Awrite(made, type, filled.data());
    }
    H5Aclose(made);
    H5Sclose(space);
  }
  static hid_t text_type(std::size_t length) {
    hid_t const type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, length);
    return type;
  }
  /// A node of CGNS without data.
  static void add_node(hid_t file, std::string const& path, std::string const& label, std::string const& type) {
    hid_t const group = H5Gcreate2(file, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    for (auto const& [name, value, size] :
         {std::tuple{"name", path.substr(path.rfind('/') + 1), 33u}, {"label", label, 33u}, {"type", type, 3u}}) {
      hid_t const text = text_type(size), space = H5Screate(H5S_SCALAR);
      hid_t const made = H5Acreate2(group, name, text, space, H5P_DEFAULT, H5P_DEFAULT);
      std::string padded = value;
      padded.resize(size);
      H5Awrite(made, text, padded.data());
      H5Aclose(made);
      H5Sclose(space);
      H5Tclose(text);
    }
    H5Gclose(group);
  }
  static void add_link(hid_t file, std::string const& path, std::string const& target) {
    add_node(file, path, "", "LK");
    H5Lcreate_soft(target.c_str(), file, (path + "/ link").c_str(), H5P_DEFAULT, H5P_DEFAULT);
  }
  /// Another data set in the place of a node's.
  static void replace_data(hid_t file, std::string const& node, hid_t type, std::vector<hsize_t> const& sizes,
                           hid_t how) {
    H5Ldelete(file, (node + "/ data").c_str(), H5P_DEFAULT);
    hid_t const space = H5Screate_simple(int(sizes.size()), sizes.data(), nullptr);
    hid_t const made = H5Dcreate2(file, (node + "/ data").c_str(), type, space, H5P_DEFAULT, how, H5P_DEFAULT);
    ASSERT_GE(made, 0);
    H5Dclose(made);
    H5Sclose(space);
  }
  [[nodiscard]] std::vector<hsize_t> sizes() const {
    auto const& e = mesh_.zones[0].extent;
    return {hsize_t(e[2]), hsize_t(e[1]), hsize_t(e[0])};
  }

  /// Refused with these words, and nothing is written.
  void expect_unreadable(std::vector<std::string> const& words) const {
    expect([&] { read_mesh(path_); }, words);
  }
  void expect_unwritable(std::vector<std::string> const& words) const {
    expect([&] { write_morphed(path_, folder_.file("out.cgns"), mesh_, mesh_.coordinates); }, words);
    for (auto const& name : folder_.names()) EXPECT_EQ(name.find("out"), name.npos) << name;
    for (auto const& name : folder_.names()) EXPECT_EQ(name.find(".part"), name.npos) << name;
  }
  template <class Call>
  void expect(Call const& call, std::vector<std::string> const& words) const {
    auto const message = message_of<IoError>(call);
    for (auto const& word : words) EXPECT_NE(message.find(word), std::string::npos) << word << " not in: " << message;
  }

  TemporaryFolder folder_;
  std::string const path_ = folder_.file("mesh.cgns");
  Mesh mesh_;
  std::string zone_, other_zone_, x_;
};

TEST_F(HostileHdf5, AttributesThatDoNotFitTheLibrarysBuffersAreRefused) {
  auto const good = bytes_of(path_);
  hid_t const long_text = text_type(4000), endless = text_type(H5T_VARIABLE), pair = text_type(2);
  for (char const* name : {"name", "label", "type"})
    for (std::string const& node : {std::string("/"), std::string("/Base"), zone_, x_}) {
      struct Case {
        hid_t type;
        std::vector<hsize_t> sizes;
      };
      for (auto const& [type, sizes] : {Case{long_text, {}}, Case{endless, {}}, Case{H5T_NATIVE_INT, {}},
                                        Case{pair, {20, 2}}, Case{H5T_NATIVE_CHAR, {2000}}}) {
        write_bytes(path_, good);
        change([&, &t = type, &s = sizes](hid_t file) { replace_attribute(file, node, name, t, s); });
        expect_unreadable({"mesh.cgns", node, std::string("'") + name + "'"});
        expect_unwritable({std::string("'") + name + "'"});
      }
    }
  for (hid_t const type : {long_text, endless, pair}) H5Tclose(type);
}

TEST_F(HostileHdf5, LinksThatLeadBackUpAreRefusedAtOnce) {
  auto const good = bytes_of(path_);
  change([&](hid_t file) {
    add_link(file, zone_ + "/Again", "/Base");
    add_link(file, zone_ + "/AndAgain", "/Base");
  });
  expect_unreadable({"/Base", "leads back"});
  write_bytes(path_, good);
  change(
      [&](hid_t file) { H5Lcreate_hard(file, "/Base", file, (zone_ + "/Again").c_str(), H5P_DEFAULT, H5P_DEFAULT); });
  expect_unreadable({"leads back"});
  write_bytes(path_, good);
  change([&](hid_t file) {
    H5Lcreate_hard(file, (zone_ + "/GridCoordinates").c_str(), file, (zone_ + "/More").c_str(), H5P_DEFAULT,
                   H5P_DEFAULT);
  });
  expect_unreadable({"listed twice"});
}

TEST_F(HostileHdf5, LinksThatMultiplyAreRefusedAtOnce) {
  change([&](hid_t file) {
    constexpr int levels = 22;
    for (int level = 0; level < levels; ++level) add_node(file, "/F" + std::to_string(level), "Family_t", "MT");
    for (int level = 0; level + 1 < levels; ++level)
      for (char const* name : {"/a", "/b"})
        add_link(file, "/F" + std::to_string(level) + name, "/F" + std::to_string(level + 1));
  });
  expect_unreadable({"links lead to the same node"});
}

TEST_F(HostileHdf5, CoordinatesInAnotherFileAreLeftAlone) {
  std::string const raw = folder_.file("raw.bin");
  write_bytes(raw, std::string(100000, 'r'));
  change([&](hid_t file) {
    hid_t const how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(how, raw.c_str(), 0, H5F_UNLIMITED);
    replace_data(file, x_, H5T_IEEE_F64LE, sizes(), how);
    H5Pclose(how);
  });
  expect_unreadable({x_, "external storage"});
  expect_unwritable({x_, "external storage"});
  EXPECT_EQ(bytes_of(raw), std::string(100000, 'r'));
}

TEST_F(HostileHdf5, CoordinatesPutTogetherFromOtherDataAreRefused) {
  change([&](hid_t file) {
    auto const n = sizes();
    hid_t const how = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(3, n.data(), nullptr);
    H5Pset_virtual(how, space, folder_.file("elsewhere.h5").c_str(), "data", space);
    replace_data(file, x_, H5T_IEEE_F64LE, n, how);
    H5Sclose(space);
    H5Pclose(how);
  });
  expect_unwritable({x_, "another file"});
}

TEST_F(HostileHdf5, ADataSetOfTwoZonesIsReadAndNotWritten) {
  ASSERT_EQ(mesh_.zones[0].extent, mesh_.zones[1].extent);
  std::string const other = other_zone_ + "/GridCoordinates/CoordinateX";
  change([&](hid_t file) {
    H5Ldelete(file, (other + "/ data").c_str(), H5P_DEFAULT);
    H5Lcreate_hard(file, (x_ + "/ data").c_str(), file, (other + "/ data").c_str(), H5P_DEFAULT, H5P_DEFAULT);
  });
  Mesh const read = read_mesh(path_);
  EXPECT_EQ(read.coordinates[read.zones[1].first_node].x, mesh_.coordinates[mesh_.zones[0].first_node].x);
  expect_unwritable({other, "same data set", x_});
}

TEST_F(HostileHdf5, AnArrayThatIsNotOfItsNodesTypeIsNotWritten) {
  for (hid_t const type : {H5T_IEEE_F32LE, H5T_STD_I64LE}) {
    change([&](hid_t file) { replace_data(file, x_, type, sizes(), H5P_DEFAULT); });
    expect_unwritable({x_, "R8", type == H5T_IEEE_F32LE ? "R4" : "I8"});
  }
}

TEST_F(HostileHdf5, ArraysFarLargerThanTheFileAreRefused) {
  auto const good = bytes_of(path_);
  for (bool const compressed : {true, false}) {
    SCOPED_TRACE(compressed);
    write_bytes(path_, good);
    change([&](hid_t file) {
      hid_t const how = H5Pcreate(H5P_DATASET_CREATE);
      std::array<hsize_t, 3> const chunk{64, 64, 64};
      if (compressed) {
        H5Pset_chunk(how, 3, chunk.data());
        H5Pset_deflate(how, 9);
      }
      std::array<std::int32_t, 9> const n{1024, 1024, 512, 1023, 1023, 511, 0, 0, 0};
      hid_t const size = H5Dopen2(file, (zone_ + "/ data").c_str(), H5P_DEFAULT);
      H5Dwrite(size, H5T_NATIVE_INT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, n.data());
      H5Dclose(size);
      for (char const* name : {"X", "Y", "Z"})
        replace_data(file, zone_ + "/GridCoordinates/Coordinate" + name, H5T_IEEE_F64LE, {512, 1024, 1024}, how);
      H5Pclose(how);
    });
    expect_unreadable({x_, "more data than the file can hold", "h5repack"});
  }
}

TEST_F(HostileHdf5, FilesThatLinksLeadToAreKnown) {
  EXPECT_TRUE(look_at_mesh(path_).linked.empty());
  std::string const grid = folder_.file("grid.cgns");
  write_bytes(grid, bytes_of(path_));
  change([&](hid_t file) {
    H5Ldelete(file, (zone_ + "/GridCoordinates").c_str(), H5P_DEFAULT);
    add_node(file, zone_ + "/GridCoordinates", "", "LK");
    H5Lcreate_external("grid.cgns", (zone_ + "/GridCoordinates").c_str(), file,
                       (zone_ + "/GridCoordinates/ link").c_str(), H5P_DEFAULT, H5P_DEFAULT);
  });
  ASSERT_EQ(look_at_mesh(path_).linked.size(), 1u);
  EXPECT_TRUE(std::filesystem::equivalent(look_at_mesh(path_).linked[0], grid));
  expect_same_coordinates(read_mesh(path_).coordinates, mesh_.coordinates);
  expect_unwritable({x_, "is a link"});
  std::filesystem::remove(grid);
  EXPECT_THROW(read_mesh(path_), Error);
}

TEST_F(HostileHdf5, CoordinatesBehindALinkOfHdf5ToAnotherFileAreLeftAlone) {
  std::string const other = folder_.file("other.cgns");
  auto const bytes = bytes_of(path_);
  write_bytes(other, bytes);
  std::string const data = x_ + "/ data";
  change([&](hid_t file) {
    H5Ldelete(file, data.c_str(), H5P_DEFAULT);
    ASSERT_GE(H5Lcreate_external("other.cgns", data.c_str(), file, data.c_str(), H5P_DEFAULT, H5P_DEFAULT), 0);
  });
  expect_unreadable({x_, "external link", "other.cgns", "h5copy"});
  expect_unwritable({x_, "external link"});
  EXPECT_EQ(bytes_of(other), bytes);
}

TEST_F(HostileHdf5, CoordinatesUnderAnotherNameOfTheSameFileAreLeftAlone) {
  std::string const data = x_ + "/ data";
  change([&](hid_t file) {
    H5Lmove(file, data.c_str(), file, "/kept", H5P_DEFAULT, H5P_DEFAULT);
    ASSERT_GE(H5Lcreate_soft("/kept", file, data.c_str(), H5P_DEFAULT, H5P_DEFAULT), 0);
  });
  expect_same_coordinates(read_mesh(path_).coordinates, mesh_.coordinates);
  expect_unwritable({x_, "another name in the file"});
}

TEST_F(HostileHdf5, GroupsThatHdf5ItselfLinksToAreKnown) {
  std::string const grid = folder_.file("grid.cgns"), group = zone_ + "/GridCoordinates";
  write_bytes(grid, bytes_of(path_));
  change([&](hid_t file) {
    H5Ldelete(file, group.c_str(), H5P_DEFAULT);
    H5Lcreate_external("grid.cgns", group.c_str(), file, group.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  });
  ASSERT_EQ(look_at_mesh(path_).linked.size(), 1u);
  EXPECT_TRUE(std::filesystem::equivalent(look_at_mesh(path_).linked[0], grid));
  expect_unwritable({x_, "is a link"});
}

TEST_F(HostileHdf5, WhatIsReadBackMustBeWhatWasWritten) {
  auto const first = [&](int c) {
    auto const& x = mesh_.coordinates;
    return std::array<double const*, 3>{x.x.data(), x.y.data(), x.z.data()}[c];
  };
  auto const compare = [&] {
    cgns::File const file(path_, cgns::File::Mode::read);
    auto const tree = file.tree();
    auto const layout = cgns::zones_of(file, tree, mesh_);
    for (int c = 0; c < 3; ++c) check_written(file, layout.zones[0], c, first(c) + mesh_.zones[0].first_node);
  };
  compare();
  change([&](hid_t file) {
    hid_t const data = H5Dopen2(file, (x_ + "/ data").c_str(), H5P_DEFAULT);
    std::vector<double> values(mesh_.zones[0].size());
    H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    values[7] = std::nextafter(values[7], 100.0);
    H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(data);
  });
  auto const message = message_of<MachineError>(compare);
  EXPECT_NE(message.find("value 8"), std::string::npos) << message;
}

TEST(HostileAdf, DataOfTwoNodesAreRefused) {
  TemporaryFolder const folder;
  std::string const path = folder.file("mesh.cgns");
  write_mesh(path, LatticeBuilder({{{{0, 2}, {0, 2}, {0, 2}}}}, 4).build(), {.format = FileFormat::cgns_adf});
  std::string bytes = bytes_of(path);
  auto const node = [&](std::string const& name) { return bytes.find("NoDe" + name); };
  constexpr std::size_t data_pointer = 230, pointer_size = 12;
  ASSERT_NE(node("CoordinateX"), std::string::npos);
  bytes.replace(node("CoordinateY") + data_pointer, pointer_size,
                bytes.substr(node("CoordinateX") + data_pointer, pointer_size));
  write_bytes(path, bytes);
  auto const message = message_of<IoError>([&] { read_mesh(path); });
  EXPECT_NE(message.find("two nodes have the same data"), std::string::npos) << message;
}

TEST(HostileCoordinates, NodesFarBeyondAnyMeshAreNamed) {
  TemporaryFolder const folder;
  std::string const path = folder.file("mesh.cgns");
  Mesh mesh = LatticeBuilder({{{{0, 2}, {0, 2}, {0, 2}}}}, 4).build();
  for (double const huge : {5e154, -1e101, 1e300, 1e16, -1e10}) {
    Vec3 const before = mesh.coordinates[3];
    mesh.coordinates.set(3, {before.x, huge, before.z});
    write_mesh(path, mesh);
    mesh.coordinates.set(3, before);
    auto const message = message_of<MeshError>([&] { read_mesh(path); });
    std::string const limit = std::abs(huge) > 1e100 ? "1e100" : "1e+08 times";
    for (std::string const& word : {limit, std::string("the first is"), mesh.zones[0].name})
      EXPECT_NE(message.find(word), std::string::npos) << word << " not in: " << message;
  }
}

}  // namespace
}  // namespace gridmorph::test
