// view: pictures of meshes, drawn by the scripts that come along with the program.
#include <gridmorph/command/commands.hpp>
#include <gridmorph/command/own_files.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/files_read.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// Runs a program, looked for in PATH where its name has no slash, and hands on what it prints on standard output line
/// by line, without line feeds; standard error is ours. Its exit status, 128 + signal as shells count; nothing where it
/// cannot be started.
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

constexpr std::string_view structured_script = "picture", unstructured_script = "picture-unstructured";

/// Prints the interpreter's path, then the modules of its arguments that it lacks.
constexpr char const* lacking_modules =
    "import importlib.util, sys; print(sys.executable); print(*[m for m in sys.argv[1:] if importlib.util.find_spec(m) "
    "is None], "
    "sep=', ')";

std::filesystem::path scripts_folder() {
  if (char const* given = std::getenv("GRIDMORPH_SCRIPTS"); given && *given) {
    if (std::filesystem::exists(std::filesystem::path(given) / structured_script)) return given;
    throw ConfigError(
        fmt::format("GRIDMORPH_SCRIPTS is '{}', and no file '{}' is there: name the folder of the scripts that draw",
                    given, structured_script));
  }
  constexpr std::array<std::string_view, 2> names{"share/gridmorph/scripts", "scripts"};
  if (auto const folder = own_folder(names, structured_script)) return *folder;
  throw MachineError(
      fmt::format("view: the scripts that draw, '{}' and '{}', are not part of this installation: install the "
                  "component 'runtime' with them, or "
                  "name the folder 'scripts' of the sources in GRIDMORPH_SCRIPTS",
                  structured_script, unstructured_script));
}

/// What a Python lacks to draw, as a message; empty where it has everything.
std::string what_lacks(std::string const& python) {
  std::vector<std::string> lines;
  auto const status = run_child({python, "-c", lacking_modules, "numpy", "h5py", "matplotlib"},
                                [&](std::string_view line) { lines.emplace_back(line); });
  if (!status) return fmt::format("'{}' is not there", python);
  if (*status != 0 || lines.empty()) return fmt::format("'{}' cannot be run (status {})", python, *status);
  std::string const lacking = lines.size() > 1 ? lines[1] : "";
  return lacking.empty() ? "" : fmt::format("'{}' ({}) has no {}", python, lines[0], lacking);
}

/// A Python that can draw: the one that is named, that of the user, that of the distribution.
std::string drawing_python() {
  std::vector<std::string> candidates{"python3", "/usr/bin/python3"};
  if (char const* given = std::getenv("GRIDMORPH_PYTHON"); given && *given) candidates = {given};
  std::vector<std::string> lacking;
  for (auto const& python : candidates) {
    lacking.push_back(what_lacks(python));
    if (lacking.back().empty()) return python;
  }
  throw MachineError(
      fmt::format("view: pictures are drawn by Python 3 with NumPy, h5py and Matplotlib: {}. Install them (Debian: apt "
                  "install python3-h5py "
                  "python3-matplotlib; elsewhere: python3 -m pip install numpy h5py matplotlib), or name a Python that "
                  "has them in GRIDMORPH_PYTHON",
                  fmt::join(lacking, "; ")));
}

bool is_of_elements(CommandLine const& options) {
  MeshFileFacts const facts = look_at_mesh(options.input.string());
  if (facts.format != MeshFormat::cgns && facts.format != MeshFormat::su2)
    throw ConfigError(
        fmt::format("view '{}': a file of {}; pictures are drawn of CGNS and SU2 meshes. The page of a morph "
                    "(gridmorph morph --html) "
                    "has pictures of meshes of every format",
                    options.input.string(), to_string(facts.format)));
  return facts.kind == MeshKind::unstructured;
}

void check_drawing_options(CommandLine const& options, bool elements) {
  Problems problems;
  for (auto const& given : options.drawing)
    if (!(elements ? given.option->elements : given.option->blocks))
      problems.add(fmt::format("{} is for meshes of {}; '{}' is one of {}: leave it out{}", given.option->name,
                               elements ? "blocks" : "elements", options.input.string(),
                               elements ? "elements" : "blocks", elements ? ", or cut with --plane" : ""));
  problems.throw_if_any<ConfigError>();
}

/// Pictures get the names that the scripts give them; a mesh that has such a name stays where it is.
void check_pictures(CommandLine const& options) {
  Problems problems;
  for (auto const& mesh : {std::optional(options.input), options.second})
    if (mesh && mesh->extension() == ".png" &&
        io::identity_of(mesh->has_parent_path() ? mesh->parent_path() : ".") == io::identity_of(*options.output))
      problems.add(
          fmt::format("view '{}': lies in the folder of the pictures and is named as one, and inputs are never "
                      "overwritten; give another folder, --out FOLDER",
                      mesh->string()));
  problems.throw_if_any<ConfigError>();
}

std::vector<std::string> drawing_words(CommandLine const& options, std::string const& python,
                                       std::filesystem::path const& script) {
  // -B: nothing is written beside the scripts, which may be another user's; -u: pictures are named once they are there.
  std::vector<std::string> words{python, "-B", "-u", script.string(), "--out=" + options.output->string()};
  for (auto const& given : options.drawing) {
    // With a sign of equality what begins with a minus is still a value; of several values argparse sees that they are
    // numbers.
    if (given.values.size() == 1)
      words.push_back(fmt::format("{}={}", given.option->name, given.values[0]));
    else {
      words.emplace_back(given.option->name);
      words.insert(words.end(), given.values.begin(), given.values.end());
    }
  }
  words.emplace_back("--");
  words.push_back(options.input.string());
  if (options.second) words.push_back(options.second->string());
  return words;
}

}  // namespace

int run_view_command(CommandLine const& options, Terminal& terminal) {
  bool const elements = is_of_elements(options);
  check_drawing_options(options, elements);
  check_pictures(options);
  auto const script = scripts_folder() / (elements ? unstructured_script : structured_script);
  auto const words = drawing_words(options, drawing_python(), script);
  nlohmann::json pictures = nlohmann::json::array();
  auto const status = run_child(words, [&](std::string_view line) {
    terminal.say(std::string(line) + '\n');
    pictures.push_back(std::string(line));
  });
  if (status == bad_input) return bad_input;  // and the script has said why
  if (status != done)
    throw MachineError(fmt::format("view: {} ended with status {}", script.string(), status.value_or(-1)));
  nlohmann::json document{
      {"gridmorph", GRIDMORPH_VERSION}, {"baseline", options.input.string()}, {"pictures", pictures}};
  if (options.second) document["morphed"] = options.second->string();
  terminal.document(document);
  return done;
}

}  // namespace gridmorph::cli
