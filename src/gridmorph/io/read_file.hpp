// Whole files.
#pragma once

#include <string>

namespace gridmorph::io {

/// "it was looked for at /home/me/mesh.cgns": to end a message with about a file that is not there.
std::string looked_for_at(std::string const& path);

/// All bytes of an ordinary file (a pipe would block for ever). Throws IoError beginning with the path.
std::string read_file(std::string const& path);

/// The first 256 kB of a file; what cannot be read is empty.
std::string read_head(std::string const& path);

}  // namespace gridmorph::io
