#include <gridmorph/case/side_file.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/file_kind.hpp>
#include <gridmorph/io/files_read.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/run/run_files.hpp>

#include <fmt/format.h>

#include <map>
#include <system_error>
#include <utility>

namespace gridmorph::cli {

namespace fs = std::filesystem;

namespace {

/// Why a path cannot be an output, whatever the other files are; empty when it can.
std::string unwritable(RunFile const& file, RunFiles const& inputs) {
  std::error_code error;
  bool const is_folder =
      file.what == "output" && !inputs.empty() && inputs.front().format == to_string(MeshFormat::openfoam);
  auto const folder = file.path.has_parent_path() ? file.path.parent_path() : fs::path(".");
  if (auto const found = fs::status(folder, error); !fs::exists(found)) {
    if (!file.folder_is_made) return fmt::format("the folder '{}' does not exist; make it first", folder.string());
  } else if (!fs::is_directory(found)) {
    return fmt::format("'{}' is no folder; give another name", folder.string());
  }
  auto const status = fs::status(file.path, error);
  if (is_folder && fs::exists(status) && !fs::is_directory(status))
    return "is a file, and a mesh of OpenFOAM is a folder; give another name";
  if (is_folder) return {};
  if (fs::is_directory(status)) return "is a folder; give a file name";
  if (fs::exists(status) && !fs::is_regular_file(status))
    return "is no ordinary file (a device, a pipe or a socket); give a file name";
  return {};
}

/// The format in which an output is written; empty where any name is as good. Meshes keep the format of the input.
std::string_view format_of(RunFile const& file, RunFiles const& inputs) {
  if (file.what == "report") return "JSON";
  if (file.what == "page") return "HTML";
  if (file.what == "VTK file") return to_string(MeshFormat::vtk);
  if (file.what == "case file" || file.what == "side file") return "TOML";
  if (file.what == "wheel") return to_string(MeshFormat::cgns);
  if (file.what != "output" || inputs.empty()) return {};
  return inputs.front().format;
}

/// An ending that stands for another format is a mistake, or would become one.
std::string wrong_ending(RunFile const& file, RunFiles const& inputs) {
  auto const stands_for = format_of_ending(file.path.string());
  auto const format = stands_for.empty() ? std::string_view() : format_of(file, inputs);
  if (format.empty() || stands_for == format) return {};
  return fmt::format("its ending stands for {}, and it is written as {}{}; give it another ending", stands_for, format,
                     file.what == "output" ? ", the format of the input" : "");
}

}  // namespace

RunFiles inputs_of_mesh(MeshSource const& mesh, std::optional<fs::path> const& side_file) {
  RunFiles files{{"input mesh", mesh.path, false, to_string(mesh.format)}};
  for (auto const& file : mesh.linked)
    files.push_back({mesh.format == MeshFormat::cgns ? "file that the mesh links to" : "part of the input mesh", file});
  if (auto const side = side_file ? side_file : find_side_file(mesh.path)) files.push_back({"side file", *side});
  return files;
}

RunFiles inputs_of(CaseFile const& case_file, MeshSource const& mesh) {
  RunFiles files = inputs_of_mesh(mesh, case_file.side_file);
  files.push_back({"case file", case_file.source});
  for (auto const& file : case_file.files) files.push_back({"input file", file});
  return files;
}

RunFiles outputs_of(RunFiles meshes, OutputOptions const& options) {
  if (options.report) meshes.push_back({"report", *options.report});
  if (options.page) meshes.push_back({"page", *options.page});
  return meshes;
}

namespace {

/// What was read, by identity: the inputs with what they are, and whatever else a reader has opened.
class Taken {
 public:
  explicit Taken(RunFiles const& inputs) {
    for (auto const& file : inputs) known_.emplace(io::identity_of(file.path), &file);
  }
  /// "input mesh 'a.cgns'"; empty for what is none of them.
  [[nodiscard]] std::string name_of(fs::path const& path) const {
    if (auto const input = known_.find(io::identity_of(path)); input != known_.end())
      return fmt::format("{} '{}'", input->second->what, input->second->path.string());
    auto const read = io::FilesRead::name_of(path);
    return read ? fmt::format("input file '{}'", *read) : std::string();
  }

 private:
  std::map<std::string, RunFile const*> known_;
};

/// An output mesh may be several files.
std::vector<std::string> all_files(RunFile const& file, RunFiles const& inputs) {
  if (file.what != "output" || inputs.empty() || inputs.front().format.empty()) return {file.path.string()};
  return files_to_write(inputs.front().path.string(), file.path.string(), file.times);
}

}  // namespace

void check_run_files(RunFiles const& inputs, RunFiles const& outputs) {
  Taken const taken(inputs);
  std::map<std::string, RunFile const*> written;
  Problems problems;
  for (auto const& file : outputs) {
    std::string const name = fmt::format("{} '{}'", file.what, file.path.string());
    if (auto const why = unwritable(file, inputs); !why.empty()) {
      problems.add(fmt::format("{}: {}", name, why));
      continue;
    }
    if (auto const why = wrong_ending(file, inputs); !why.empty()) problems.add(fmt::format("{}: {}", name, why));
    bool input_said = false, other_said = false;
    for (std::string const& path : all_files(file, inputs)) {
      std::string const of_several = path == file.path ? "" : fmt::format(" would write '{}', which", path);
      if (auto const input = taken.name_of(path); !input.empty() && !std::exchange(input_said, true))
        problems.add(fmt::format("{}{} is the {}; give another file name, inputs are never overwritten", name,
                                 of_several, input));
      if (auto const [other, added] = written.emplace(io::identity_of(path), &file);
          !added && other->second != &file && !std::exchange(other_said, true))
        problems.add(fmt::format("{}{} is the same file as {} '{}'; give two names", name, of_several,
                                 other->second->what, other->second->path.string()));
    }
  }
  problems.throw_if_any<ConfigError>();
}

}  // namespace gridmorph::cli
