// PNG files, decoded here by their standard.
#include <gridmorph/io/png.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#ifdef GRIDMORPH_TEST_ZLIB
#include <zlib.h>

namespace gridmorph::io {
namespace {

struct Chunk {
  std::string name, data;
};

std::uint32_t big_endian(std::string const& bytes, std::size_t at) {
  std::uint32_t out = 0;
  for (std::size_t n = 0; n < 4; ++n) out = out << 8U | static_cast<unsigned char>(bytes[at + n]);
  return out;
}

/// Checks the checksum of each as zlib has it.
std::vector<Chunk> chunks_of(std::string const& file) {
  std::vector<Chunk> out;
  EXPECT_EQ(file.substr(0, 8), std::string("\x89PNG\r\n\x1a\n", 8));
  for (std::size_t at = 8; at < file.size();) {
    std::uint32_t const length = big_endian(file, at);
    std::string const both = file.substr(at + 4, 4 + length);
    EXPECT_EQ(big_endian(file, at + 8 + length),
              ::crc32(0, reinterpret_cast<Bytef const*>(both.data()), uInt(both.size())));
    out.push_back({both.substr(0, 4), both.substr(4)});
    at += 12 + length;
  }
  return out;
}

int paeth_of(int a, int b, int c) {
  int const p = a + b - c, pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
  return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
}

/// Colours of all pixels, four bytes each.
std::vector<std::uint8_t> decoded(std::string const& file, int width, int height) {
  auto const chunks = chunks_of(file);
  EXPECT_EQ(chunks.front().name, "IHDR");
  EXPECT_EQ(chunks.back().name, "IEND");
  EXPECT_EQ(int(big_endian(chunks.front().data, 0)), width);
  EXPECT_EQ(int(big_endian(chunks.front().data, 4)), height);
  EXPECT_EQ(chunks.front().data[8], 8);
  bool const palette = chunks.front().data[9] == 3;
  EXPECT_TRUE(palette || chunks.front().data[9] == 6);
  std::string packed, colours, opacity;
  for (auto const& chunk : chunks) {
    if (chunk.name == "IDAT") packed += chunk.data;
    if (chunk.name == "PLTE") colours = chunk.data;
    if (chunk.name == "tRNS") opacity = chunk.data;
  }
  std::size_t const bytes = palette ? 1 : 4, row = bytes * std::size_t(width);
  std::vector<std::uint8_t> rows((row + 1) * std::size_t(height));
  uLongf length = uLongf(rows.size());
  EXPECT_EQ(::uncompress(rows.data(), &length, reinterpret_cast<Bytef const*>(packed.data()), uLong(packed.size())),
            Z_OK);
  EXPECT_EQ(length, rows.size());
  std::vector<std::uint8_t> plain(row * std::size_t(height)), out;
  for (std::size_t y = 0; y < std::size_t(height); ++y)
    for (std::size_t x = 0; x < row; ++x) {
      int const a = x < bytes ? 0 : plain[y * row + x - bytes], b = y == 0 ? 0 : plain[(y - 1) * row + x];
      int const c = x < bytes || y == 0 ? 0 : plain[(y - 1) * row + x - bytes];
      int const filter = rows[y * (row + 1)];
      int const guess = filter == 0   ? 0
                        : filter == 1 ? a
                        : filter == 2 ? b
                        : filter == 3 ? (a + b) / 2
                                      : paeth_of(a, b, c);
      plain[y * row + x] = std::uint8_t(rows[y * (row + 1) + 1 + x] + guess);
    }
  for (std::uint8_t const p : plain) {
    if (!palette) {
      out.push_back(p);
      continue;
    }
    for (std::size_t n = 0; n < 3; ++n) out.push_back(std::uint8_t(colours.at(3 * p + n)));
    out.push_back(p < opacity.size() ? std::uint8_t(opacity[p]) : 255);
  }
  return out;
}

TEST(Png, HoldsEveryPixelOfAnyPicture) {
  std::mt19937 random(7);
  for (auto const& [width, height, colours] : {std::tuple(1, 1, 1), std::tuple(37, 5, 3), std::tuple(16, 16, 256),
                                               std::tuple(64, 33, 257), std::tuple(200, 90, 4000)}) {
    std::vector<std::array<std::uint8_t, 4>> palette;
    for (int n = 0; n < colours; ++n)
      palette.push_back({std::uint8_t(random()), std::uint8_t(random()), std::uint8_t(n), std::uint8_t(1 + n % 255)});
    Picture picture(width, height);
    for (int p = 0; p < width * height; ++p)
      for (std::size_t c = 0; c < 4; ++c)
        picture.rgba[4 * std::size_t(p) + c] = palette[p < colours ? p : int(random() % unsigned(colours))][c];
    EXPECT_EQ(decoded(png_bytes(picture), width, height), picture.rgba) << width << " x " << height;
  }
}

TEST(Png, IsTheSameForEqualPictures) {
  Picture picture(50, 40);
  for (std::size_t n = 0; n < picture.rgba.size(); ++n) picture.rgba[n] = std::uint8_t(n * n / 7);
  EXPECT_EQ(png_bytes(picture), png_bytes(picture));
  EXPECT_EQ(png_data_uri(picture).substr(0, 22), "data:image/png;base64,");
}

}  // namespace
}  // namespace gridmorph::io
#endif
