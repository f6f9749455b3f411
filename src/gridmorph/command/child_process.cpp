#include <gridmorph/command/child_process.hpp>
#include <gridmorph/core/error.hpp>

#include <array>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;  // POSIX declares it nowhere

namespace gridmorph::cli {

namespace {

/// Starts the program with `output` as its standard output. Nothing where that fails.
std::optional<pid_t> start_child(std::vector<std::string>& words, int output) {
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  if (posix_spawn_file_actions_init(&actions) != 0) return std::nullopt;
  pid_t child = -1;
  bool const started = posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO) == 0 &&
                       posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ) == 0;
  posix_spawn_file_actions_destroy(&actions);
  return started ? std::optional(child) : std::nullopt;
}

void read_lines(int input, std::function<void(std::string_view)> const& on_line) {
  std::string pending;
  std::array<char, 4096> piece;
  while (true) {
    ssize_t const n = read(input, piece.data(), piece.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    pending.append(piece.data(), std::size_t(n));
    for (std::size_t end; (end = pending.find('\n')) != std::string::npos; pending.erase(0, end + 1))
      on_line(std::string_view(pending).substr(0, end));
  }
  if (!pending.empty()) on_line(pending);
}

}  // namespace

std::optional<int> run_child(std::vector<std::string> words, std::function<void(std::string_view)> const& on_line) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    throw MachineError("no pipe to another program: " + std::string(std::strerror(errno)));
  auto const child = start_child(words, ends[1]);
  close(ends[1]);
  if (child) read_lines(ends[0], on_line);
  close(ends[0]);
  if (!child) return std::nullopt;
  int code = 0;
  while (waitpid(*child, &code, 0) < 0)
    if (errno != EINTR)
      throw MachineError("another program cannot be waited for: " + std::string(std::strerror(errno)));
  return WIFEXITED(code) ? WEXITSTATUS(code) : 128 + WTERMSIG(code);
}

}  // namespace gridmorph::cli
