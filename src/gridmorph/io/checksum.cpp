#include <gridmorph/io/checksum.hpp>

#include <array>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <vector>

namespace gridmorph::io {

namespace {

/// 16 bytes at a time ("slicing", Kounavis and Berry, 2008): [k][b] is what byte b does k bytes before the end.
using CrcTables = std::array<std::array<std::uint32_t, 256>, 16>;

CrcTables make_crc_tables() {
  constexpr std::uint32_t polynomial = 0x04C11DB7U;
  CrcTables t{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t c = n << 24U;
    for (int bit = 0; bit < 8; ++bit) c = (c & 0x80000000U) != 0 ? (c << 1U) ^ polynomial : c << 1U;
    t[0][n] = c;
  }
  for (std::size_t k = 1; k < t.size(); ++k)
    for (std::size_t n = 0; n < 256; ++n) t[k][n] = (t[k - 1][n] << 8U) ^ t[0][t[k - 1][n] >> 24U];
  return t;
}

std::uint32_t big_endian_word(unsigned char const* p) {
  return std::uint32_t(p[0]) << 24U | std::uint32_t(p[1]) << 16U | std::uint32_t(p[2]) << 8U | p[3];
}

std::uint32_t add_byte(CrcTables const& t, std::uint32_t crc, std::uint32_t byte) {
  return (crc << 8U) ^ t[0][(crc >> 24U) ^ byte];
}

std::uint32_t add_bytes(CrcTables const& t, std::uint32_t crc, unsigned char const* p, std::size_t n) {
  // What four bytes do that end `after` bytes before the end.
  auto const word = [&](std::uint32_t w, std::size_t after) {
    return t[after + 3][w >> 24U] ^ t[after + 2][w >> 16U & 255U] ^ t[after + 1][w >> 8U & 255U] ^ t[after][w & 255U];
  };
  for (; n >= 16; p += 16, n -= 16)
    crc = word(crc ^ big_endian_word(p), 12) ^ word(big_endian_word(p + 4), 8) ^ word(big_endian_word(p + 8), 4) ^
          word(big_endian_word(p + 12), 0);
  for (; n > 0; ++p, --n) crc = add_byte(t, crc, *p);
  return crc;
}

}  // namespace

std::optional<Checksum> posix_checksum(std::string const& path) {
  static CrcTables const tables = make_crc_tables();
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> const file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) return std::nullopt;
  std::setvbuf(file.get(), nullptr, _IONBF, 0);
  std::vector<unsigned char> piece(std::size_t(1) << 18U);  // stays in the cache
  Checksum out;
  while (std::size_t const n = std::fread(piece.data(), 1, piece.size(), file.get())) {
    out.value = add_bytes(tables, out.value, piece.data(), n);
    out.bytes += n;
  }
  if (std::ferror(file.get()) != 0) return std::nullopt;
  for (std::uint64_t n = out.bytes; n != 0; n >>= 8U) out.value = add_byte(tables, out.value, std::uint32_t(n & 255U));
  out.value = ~out.value;
  return out;
}

}  // namespace gridmorph::io
