// Checksums of files, to say which file a run read.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace gridmorph::io {

struct Checksum {
  std::uint32_t value = 0;
  std::uint64_t bytes = 0;
};

/// What the program cksum prints of a file: the 32-bit CRC of POSIX.1 (cksum), of all bytes and their number, MSB
/// first, polynomial 0x04C11DB7. Nothing of what is no ordinary file or cannot be read. Cost: reading the file; under
/// half a nanosecond a byte.
std::optional<Checksum> posix_checksum(std::string const& path);

}  // namespace gridmorph::io
