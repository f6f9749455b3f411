#include <gridmorph/core/error.hpp>
#include <gridmorph/io/files_read.hpp>
#include <gridmorph/io/read_file.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace gridmorph::io {

std::string looked_for_at(std::string const& path) {
  std::error_code failure;
  auto const whole = std::filesystem::absolute(path, failure);
  return "it was looked for at " + (failure ? path : whole.lexically_normal().string());
}

std::string read_file(std::string const& path) {
  namespace fs = std::filesystem;
  std::error_code failure;
  auto const status = fs::status(path, failure);
  if (!fs::exists(status)) throw IoError(path + ": no such file; " + looked_for_at(path));
  if (!fs::is_regular_file(status)) throw IoError(path + ": is not an ordinary file");
  FilesRead::note(path);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path + ": cannot be opened for reading: " + std::strerror(errno));
  std::string text;
  if (auto const size = fs::file_size(path, failure); !failure) text.reserve(size);
  std::array<char, 1 << 16> chunk;
  while (file.read(chunk.data(), chunk.size()) || file.gcount() > 0)
    text.append(chunk.data(), std::size_t(file.gcount()));
  if (file.bad()) throw IoError(path + ": cannot be read to its end: " + std::strerror(errno));
  return text;
}

std::string read_head(std::string const& path) {
  constexpr std::size_t head_size = 256 << 10;
  std::string out(head_size, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(out.data(), std::streamsize(out.size()));
  out.resize(std::max<std::streamsize>(in.gcount(), 0));
  return out;
}

}  // namespace gridmorph::io
