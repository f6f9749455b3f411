#include <gridmorph/core/error.hpp>
#include <gridmorph/io/zlib_blocks.hpp>

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

std::string packed_block(std::string const& path, std::string_view bytes) {
  std::string out(::compressBound(uLong(bytes.size())), '\0');
  uLongf length = uLongf(out.size());
  if (::compress(reinterpret_cast<Bytef*>(out.data()), &length, reinterpret_cast<Bytef const*>(bytes.data()),
                 uLong(bytes.size())) != Z_OK)
    throw MachineError(path + ": zlib cannot pack a block");
  out.resize(length);
  return out;
}

#else

std::optional<std::string> unpacked_block(std::string_view, std::size_t) { return std::nullopt; }

std::string packed_block(std::string const& path, std::string_view) {
  throw IoError(path + ": is to be packed by zlib, and this gridmorph was built without it");
}

#endif

}  // namespace gridmorph::io
