// Checksums of files: those of the program cksum.
#include "support/temporary_folder.hpp"

#include <gridmorph/io/checksum.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <random>
#include <string>

namespace gridmorph::io {
namespace {

/// Bit by bit, as POSIX.1 defines it.
std::uint32_t by_definition(std::string bytes) {
  for (std::size_t n = bytes.size(); n != 0; n >>= 8U) bytes += char(n & 255U);
  std::uint32_t crc = 0;
  for (char const byte : bytes) {
    crc ^= std::uint32_t(static_cast<unsigned char>(byte)) << 24U;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x80000000U) != 0 ? (crc << 1U) ^ 0x04C11DB7U : crc << 1U;
  }
  return ~crc;
}

class FileChecksum : public ::testing::Test {
 protected:
  [[nodiscard]] std::string file_of(std::string const& bytes) const {
    std::string const path = folder_.path("file").string();
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  test::TemporaryFolder folder_;
};

TEST_F(FileChecksum, IsThatOfTheProgramCksum) {
  EXPECT_EQ(posix_checksum(file_of("123456789"))->value, 930766865U);  // printf 123456789 | cksum
  EXPECT_EQ(posix_checksum(file_of(""))->value, 4294967295U);
}

TEST_F(FileChecksum, IsTheOneDefinedForFilesOfAnyLength) {
  std::mt19937 random(7);
  for (std::size_t const length : {1U, 7U, 8U, 9U, 63U, 262143U, 262144U, 262151U, 600001U}) {
    std::string bytes(length, '\0');
    for (char& byte : bytes) byte = char(random());
    auto const sum = posix_checksum(file_of(bytes));
    ASSERT_TRUE(sum);
    EXPECT_EQ(sum->value, by_definition(bytes)) << length;
    EXPECT_EQ(sum->bytes, length);
  }
}

TEST_F(FileChecksum, OfFoldersAndOfWhatIsNotThereIsNone) {
  EXPECT_FALSE(posix_checksum(folder_.path("").string()));
  EXPECT_FALSE(posix_checksum(folder_.path("nothing").string()));
}

}  // namespace
}  // namespace gridmorph::io
