#include <gridmorph/core/error.hpp>
#include <gridmorph/io/files_read.hpp>
#include <gridmorph/io/output_file.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
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

/// A temporary file that is there, or about to be, as a signal handler can read it. Never freed; used again once its
/// name is taken out.
struct PendingName {
  std::string name;
  std::atomic<char const*> shown{nullptr};  ///< name, or nothing
  PendingName* next = nullptr;
};

namespace {

std::atomic<PendingName*> all_pending{nullptr};
static_assert(std::atomic<char const*>::is_always_lock_free);

PendingName* show(std::string name) {
  static std::mutex one_at_a_time;
  std::lock_guard const lock(one_at_a_time);
  PendingName* free = all_pending.load();
  while (free != nullptr && free->shown.load() != nullptr) free = free->next;
  if (free == nullptr) {
    free = new PendingName;
    free->next = all_pending.load();
    all_pending.store(free);
  }
  free->name = std::move(name);
  free->shown.store(free->name.c_str());
  return free;
}

void remove_pending(int signal) {
  remove_pending_files();
  ::raise(signal);  // the default action again, once this handler has returned
}

/// FNV-1a: the same in every process, unlike std::hash.
std::string short_hash(std::string const& text) {
  std::uint32_t h = 2166136261u;
  for (char const c : text) h = (h ^ static_cast<unsigned char>(c)) * 16777619u;
  std::array<char, 9> digits{};
  std::snprintf(digits.data(), digits.size(), "%08x", unsigned(h));
  return digits.data();
}

/// What the names of temporary files begin with that this machine makes for an output; the number of the process
/// follows.
std::string temporary_prefix(fs::path const& output) {
  std::array<char, 256> host{};
  static_cast<void>(::gethostname(host.data(), host.size() - 1));
  return ".gridmorph-" + short_hash(output.filename().string()) + "-" + short_hash(host.data()) + "-";
}

/// Temporary files that were in a folder when it was first looked at.
std::vector<std::string> const& left_in(fs::path const& folder) {
  static std::map<std::string, std::vector<std::string>> known;
  auto const [at, added] = known.try_emplace(folder.string());
  if (added) {
    std::error_code failure;
    for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure))
      if (auto name = entry->path().filename().string(); name.starts_with(".gridmorph-") && name.ends_with(".part"))
        at->second.push_back(std::move(name));
  }
  return at->second;
}

void remove_stale(fs::path const& folder, std::string const& prefix) {
  static std::mutex one_at_a_time;
  std::lock_guard const lock(one_at_a_time);
  for (auto const& name : left_in(folder)) {
    if (!name.starts_with(prefix)) continue;
    char* end = nullptr;
    long const process = std::strtol(name.c_str() + prefix.size(), &end, 10);
    if (process <= 0 || *end != '-' || ::kill(pid_t(process), 0) == 0 || errno != ESRCH) continue;
    ::unlink((folder / name).c_str());
  }
}

}  // namespace

void remove_pending_files() {
  for (PendingName const* p = all_pending.load(); p != nullptr; p = p->next)
    if (char const* const name = p->shown.load()) ::unlink(name);
}

void remove_pending_on_signals() {
  for (int const signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction present {};
    if (::sigaction(signal, nullptr, &present) != 0 || present.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = remove_pending;
    action.sa_flags = int(SA_RESETHAND);
    sigfillset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
  }
}

OutputFile::OutputFile(std::string const& output) : output_(output) {
  std::error_code failure;
  if (fs::is_symlink(output, failure)) {
    auto const target = fs::weakly_canonical(output, failure);
    if (!failure) output_ = target.string();
  }
  if (fs::is_directory(output_, failure)) throw IoError(output + ": is a folder; name the file to write");
  if (auto const found = fs::status(output_, failure); fs::exists(found) && !fs::is_regular_file(found))
    throw IoError(output + ": is no ordinary file (a device, a pipe or a socket); name the file to write");
  if (auto const input = FilesRead::name_of(output_))
    throw IoError(output + ": is a file of the input ('" + *input +
                  "'), and inputs are never overwritten; give another name");
  fs::path const folder = fs::path(output_).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, failure))
    throw IoError(output + ": there is no folder '" + folder.string() + "'; create it first");
  std::string const prefix = temporary_prefix(output_);
  remove_stale(folder.empty() ? fs::path(".") : folder, prefix);
  static std::atomic<int> made{0};
  constexpr int attempts = 1000;
  for (int n = 0; n < attempts; ++n) {
    temporary_ = (folder / (prefix + std::to_string(::getpid()) + "-" + std::to_string(made++) + ".part")).string();
    // Shown before it is there: a signal in between would leave it behind.
    pending_ = show(temporary_);
    Descriptor file(::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.get() >= 0) return;
    int const failed = errno;
    pending_->shown.store(nullptr);
    errno = failed;
    if (failed != EEXIST) break;
  }
  pending_ = nullptr;
  throw MachineError(output + ": cannot be written: " + system_reason() +
                     "; check space and permissions of the folder");
}

OutputFile::~OutputFile() {
  if (pending_ == nullptr) return;
  ::unlink(temporary_.c_str());
  pending_->shown.store(nullptr);
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

void OutputFile::write(std::string_view bytes) const {
  errno = 0;
  Descriptor file(::open(temporary_.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.get() < 0 || !write_all(file.get(), bytes.data(), bytes.size()) ||
      ::ftruncate(file.get(), off_t(bytes.size())) != 0 || !file.close())
    throw MachineError(output_ + ": cannot be written: " + system_reason() + "; check space and permissions");
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
  struct stat present {
  }, own{};
  if (::stat(output_.c_str(), &present) == 0 && ::stat(temporary_.c_str(), &own) == 0) {
    // Giving a file away may be forbidden; it then stays with who writes it. The mode comes last: a change of owner
    // takes bits of it away.
    bool const kept = (present.st_uid == own.st_uid && present.st_gid == own.st_gid) ||
                      ::chown(temporary_.c_str(), present.st_uid, present.st_gid) == 0;
    constexpr mode_t permissions = 0777, all_bits = 07777;
    ::chmod(temporary_.c_str(), present.st_mode & (kept ? all_bits : permissions));
  }
  if (::rename(temporary_.c_str(), output_.c_str()) != 0)
    throw MachineError(output_ + ": cannot be put in place: " + system_reason() + "; check permissions of the folder");
  std::exchange(pending_, nullptr)->shown.store(nullptr);
}

bool OutputFile::hold_present() const {
  std::error_code failure;
  if (!fs::exists(output_, failure)) return false;
  ::unlink(temporary_.c_str());
  // File systems without hard links get a copy.
  if (::link(output_.c_str(), temporary_.c_str()) == 0) return true;
  fs::copy_file(output_, temporary_, failure);
  if (failure) throw MachineError(output_ + ": cannot be kept while others are put in place: " + failure.message());
  return true;
}

void OutputFile::put_back() {
  if (::rename(temporary_.c_str(), output_.c_str()) == 0) std::exchange(pending_, nullptr)->shown.store(nullptr);
}

void OutputFile::take_away() const { ::unlink(output_.c_str()); }

void OutputFiles::commit() {
  std::deque<OutputFile> present;
  std::vector<OutputFile*> before;  // of each that is in place; null where there was nothing
  try {
    for (OutputFile& file : files_) {
      OutputFile& held = present.emplace_back(file.output());
      OutputFile* const kept = held.hold_present() ? &held : nullptr;
      file.commit();
      before.push_back(kept);
    }
  } catch (...) {
    for (std::size_t n = 0; n < before.size(); ++n)
      if (before[n] != nullptr)
        before[n]->put_back();
      else
        files_[n].take_away();
    throw;
  }
}

}  // namespace gridmorph::io
