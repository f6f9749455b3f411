#include <gridmorph/core/error.hpp>
#include <gridmorph/io/zlib_blocks.hpp>

#include <algorithm>
#include <utility>

#ifdef GRIDMORPH_WITH_ZLIB
#include <zlib.h>
#endif

namespace gridmorph::io {

#ifdef GRIDMORPH_WITH_ZLIB

std::optional<std::string> unpacked_block(std::string_view packed, std::size_t size) {
  constexpr std::size_t most_packing = 1100;  // more than deflate can do
  if (size / most_packing > packed.size()) return std::nullopt;
  std::string out(size, '\0');
  uLongf length = uLongf(size);
  if (::uncompress(reinterpret_cast<Bytef*>(out.data()), &length, reinterpret_cast<Bytef const*>(packed.data()),
                   uLong(packed.size())) != Z_OK)
    return std::nullopt;
  return length == size ? std::optional(std::move(out)) : std::nullopt;
}

namespace {

std::string packed_at(int level, std::string const& path, std::string_view bytes) {
  std::string out(::compressBound(uLong(bytes.size())), '\0');
  uLongf length = uLongf(out.size());
  if (::compress2(reinterpret_cast<Bytef*>(out.data()), &length, reinterpret_cast<Bytef const*>(bytes.data()),
                  uLong(bytes.size()), level) != Z_OK)
    throw MachineError(path + ": zlib cannot pack a block");
  out.resize(length);
  return out;
}

}  // namespace

std::string packed_block(std::string const& path, std::string_view bytes) {
  return packed_at(Z_DEFAULT_COMPRESSION, path, bytes);
}

std::string zlib_stream(std::string_view bytes) {
  constexpr int level = 1;  // of pictures of report pages: a quarter longer than by default, in a third of the time
  return packed_at(level, "a stream", bytes);
}

#else

std::optional<std::string> unpacked_block(std::string_view, std::size_t) { return std::nullopt; }

std::string packed_block(std::string const& path, std::string_view) {
  throw IoError(path + ": is to be packed by zlib, and this gridmorph was built without it");
}

std::string zlib_stream(std::string_view bytes) {
  constexpr std::size_t most = 65535;  // of a stored block, RFC 1951, 3.2.4
  std::string out("\x78\x01", 2);
  std::size_t at = 0;
  do {
    std::size_t const n = std::min(most, bytes.size() - at);
    out += char(at + n == bytes.size());
    for (std::size_t const length : {n, ~n}) out += {char(length & 0xFFU), char(length >> 8U & 0xFFU)};
    out += bytes.substr(at, n);
    at += n;
  } while (at < bytes.size());
  unsigned a = 1, b = 0;  // Adler-32
  for (char const c : bytes) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  for (unsigned const half : {b, a}) out += {char(half >> 8U), char(half & 0xFFU)};
  return out;
}

#endif

}  // namespace gridmorph::io
