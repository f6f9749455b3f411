// Blocks of bytes packed by zlib, where gridmorph is built with it. Internal to io.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace gridmorph::io {

/// A block of `size` bytes when unpacked; nothing where it is not one, and without zlib.
std::optional<std::string> unpacked_block(std::string_view packed, std::size_t size);

/// Throws IoError without zlib; `path`: of what file.
std::string packed_block(std::string const& path, std::string_view bytes);

/// A zlib stream (RFC 1950) of these bytes: packed, or stored as they are without zlib.
std::string zlib_stream(std::string_view bytes);

}  // namespace gridmorph::io
