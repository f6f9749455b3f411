#include <gridmorph/core/error.hpp>
#include <gridmorph/plan/detail/whole_file.hpp>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace gridmorph::detail {

namespace fs = std::filesystem;

namespace {

bool write_all(int fd, std::span<std::byte const> bytes) {
  while (!bytes.empty()) {
    ssize_t const done = ::write(fd, bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes = bytes.subspan(std::size_t(done));
  }
  return true;
}

[[noreturn]] void cannot_write(fs::path const& path, int reason) {
  throw MachineError(path.string() + ": cannot be written: " + std::strerror(reason) +
                     "; check space and permissions of the folder");
}

}  // namespace

void write_whole(fs::path const& path, std::span<std::byte const> bytes) {
  std::error_code failure;
  fs::path output = path;
  if (fs::is_symlink(output, failure)) {
    auto const target = fs::weakly_canonical(output, failure);
    if (!failure) output = target;
  }
  if (fs::is_directory(output, failure)) throw IoError(path.string() + ": is a folder; name the file to write");
  if (fs::path const folder = output.parent_path(); !folder.empty() && !fs::is_directory(folder, failure))
    throw IoError(path.string() + ": there is no folder '" + folder.string() + "'; create it first");

  // In the same folder, so that the rename is one step of the file system.
  constexpr int attempts = 1000;
  std::string temporary;
  int fd = -1;
  for (int n = 0; n < attempts && fd < 0; ++n) {
    temporary = output.string() + ".part-" + std::to_string(::getpid()) + (n == 0 ? "" : "-" + std::to_string(n));
    fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0 && errno != EEXIST) break;
  }
  if (fd < 0) cannot_write(path, errno);
  bool const written = write_all(fd, bytes);
  int reason = errno;
  // close() reports writes that failed late (quota, network file systems).
  bool const closed = ::close(fd) == 0;
  if (written && !closed) reason = errno;
  if (written && closed) {
    if (::rename(temporary.c_str(), output.c_str()) == 0) return;
    reason = errno;
  }
  ::unlink(temporary.c_str());
  cannot_write(path, reason);
}

std::vector<std::byte> read_whole(fs::path const& path, std::string_view magic) {
  std::error_code failure;
  if (!fs::exists(path, failure)) throw IoError(path.string() + ": there is no such file");
  if (!fs::is_regular_file(path, failure)) throw IoError(path.string() + ": is not a file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path.string() + ": cannot be opened for reading; check its permissions");
  std::string found(magic.size(), '\0');
  if (!file.read(found.data(), std::streamsize(found.size())) || found != magic)
    throw IoError(path.string() + ": is not a gridmorph plan");
  file.seekg(0);
  std::vector<std::byte> bytes(fs::file_size(path, failure));
  if (failure || !file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size())))
    throw IoError(path.string() + ": cannot be read");
  return bytes;
}

}  // namespace gridmorph::detail
