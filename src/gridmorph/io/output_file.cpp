#include <gridmorph/core/error.hpp>
#include <gridmorph/io/output_file.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#ifdef __linux__
#include <linux/fs.h>
#include <sys/ioctl.h>
#endif

namespace gridmorph::io {

namespace fs = std::filesystem;

namespace {

/// Owner of a POSIX file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(Descriptor const&) = delete;
  Descriptor& operator=(Descriptor const&) = delete;
  [[nodiscard]] int get() const { return fd_; }
  /// close() reports writes that failed late (quota, network file systems).
  [[nodiscard]] bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

std::string system_reason() { return std::strerror(errno); }

bool write_all(int fd, char const* data, std::size_t n) {
  while (n > 0) {
    ssize_t const done = ::write(fd, data, n);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    data += done;
    n -= std::size_t(done);
  }
  return true;
}

/// Makes `to` a copy that shares its blocks with `from`, on file systems that can (Btrfs, XFS, NFS 4.2, ...).
bool share_blocks([[maybe_unused]] int from, [[maybe_unused]] int to) {
#ifdef FICLONE
  return ::ioctl(to, FICLONE, from) == 0;
#else
  return false;
#endif
}

/// Sets room aside for `bytes`, so that a full disk is known at once and the system need not find blocks on each write.
/// False, with errno, when there is no room; true also where the file system cannot tell.
bool allocate([[maybe_unused]] int fd, [[maybe_unused]] std::uintmax_t bytes) {
#ifdef __linux__
  if (bytes > 0 && ::fallocate(fd, 0, 0, off_t(bytes)) != 0)
    return errno != ENOSPC && errno != EFBIG && errno != EDQUOT;
#endif
  return true;
}

}  // namespace

OutputFile::OutputFile(std::string const& output) : output_(output) {
  std::error_code failure;
  if (fs::is_symlink(output, failure)) {
    auto const target = fs::weakly_canonical(output, failure);
    if (!failure) output_ = target.string();
  }
  if (fs::is_directory(output_, failure)) throw IoError(output + ": is a folder; name the file to write");
  fs::path const folder = fs::path(output_).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, failure))
    throw IoError(output + ": there is no folder '" + folder.string() + "'; create it first");
  constexpr int attempts = 1000;
  for (int n = 0; n < attempts; ++n) {
    temporary_ = output_ + ".part-" + std::to_string(::getpid()) + (n == 0 ? "" : "-" + std::to_string(n));
    Descriptor file(::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.get() >= 0) return;
    if (errno != EEXIST) break;
  }
  throw MachineError(output + ": cannot be written: " + system_reason() +
                     "; check space and permissions of the folder");
}

OutputFile::~OutputFile() {
  if (!committed_) ::unlink(temporary_.c_str());
}

void OutputFile::copy_from(std::string const& input) const {
  Descriptor from(::open(input.c_str(), O_RDONLY | O_CLOEXEC));
  if (from.get() < 0) throw IoError(input + ": cannot be opened for reading: " + system_reason());
  Descriptor to(::open(temporary_.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC));
  if (to.get() < 0) throw MachineError(output_ + ": cannot be written: " + system_reason());
  if (share_blocks(from.get(), to.get())) return;
  if (!allocate(to.get(), fs::file_size(input)))
    throw MachineError(output_ + ": cannot be written: " + system_reason() + "; make room for a copy of the input");
  constexpr std::size_t chunk = std::size_t(256) << 10;  // stays in cache between read and write
  auto const buffer = std::make_unique_for_overwrite<char[]>(chunk);
  for (;;) {
    ssize_t const n = ::read(from.get(), buffer.get(), chunk);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw IoError(input + ": cannot be read: " + system_reason());
    if (n == 0) break;
    if (!write_all(to.get(), buffer.get(), std::size_t(n)))
      throw MachineError(output_ + ": cannot be written: " + system_reason() + "; make room for a copy of the input");
  }
  if (!to.close()) throw MachineError(output_ + ": cannot be written: " + system_reason());
}

void OutputFile::reserve(std::uint64_t bytes) const {
  auto const size = fs::file_size(temporary_);
  Descriptor const file(::open(temporary_.c_str(), O_WRONLY | O_CLOEXEC));
  errno = 0;
  if (file.get() >= 0) errno = ::posix_fallocate(file.get(), 0, off_t(std::max<std::uint64_t>(size + bytes, 1)));
  if (errno != 0)
    throw MachineError(output_ + ": cannot be written: " + system_reason() + "; up to " +
                       std::to_string((size + bytes) / 1000000 + 1) + " MB are needed");
  if (::ftruncate(file.get(), off_t(size)) != 0)
    throw MachineError(output_ + ": cannot be written: " + system_reason());
}

void OutputFile::commit() {
  if (::rename(temporary_.c_str(), output_.c_str()) != 0)
    throw MachineError(output_ + ": cannot be put in place: " + system_reason() + "; check permissions of the folder");
  committed_ = true;
}

}  // namespace gridmorph::io
