#include <gridmorph/app/casefile/side_file.hpp>
#include <gridmorph/app/cli/run_files.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/file_kind.hpp>

#include <fmt/format.h>

#include <map>
#include <system_error>
#include <utility>

#include <sys/stat.h>

namespace gridmorph::cli {

namespace fs = std::filesystem;

namespace {

/// Equal for two paths that are one file, or would be.
std::string identity(fs::path const& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) == 0) return fmt::format("{}:{}", found.st_dev, found.st_ino);
  std::error_code error;
  auto const canonical = fs::weakly_canonical(fs::absolute(path, error), error);
  return (error ? path : canonical).string();
}

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
  for (auto const& file : mesh.linked) files.push_back({"file that the mesh links to", file});
  if (auto const side = side_file ? side_file : find_side_file(mesh.path)) files.push_back({"side file", *side});
  return files;
}

RunFiles inputs_of(CaseFile const& case_file, MeshSource const& mesh) {
  RunFiles files = inputs_of_mesh(mesh, case_file.side_file);
  files.push_back({"case file", case_file.source});
  for (auto const& file : case_file.files) files.push_back({"input file", file});
  return files;
}

RunFiles outputs_of(fs::path const& output, std::optional<fs::path> const& report) {
  RunFiles files{{"output", output}};
  if (report) files.push_back({"report", *report});
  return files;
}

void check_run_files(RunFiles const& inputs, RunFiles const& outputs) {
  std::map<std::string, RunFile const*> taken;
  for (auto const& file : inputs) taken.emplace(identity(file.path), &file);
  std::map<std::string, RunFile const*> written;
  Problems problems;
  for (auto const& file : outputs) {
    std::string const name = fmt::format("{} '{}'", file.what, file.path.string());
    if (auto const why = unwritable(file, inputs); !why.empty()) {
      problems.add(fmt::format("{}: {}", name, why));
      continue;
    }
    if (auto const why = wrong_ending(file, inputs); !why.empty()) problems.add(fmt::format("{}: {}", name, why));
    std::string const key = identity(file.path);
    if (auto const input = taken.find(key); input != taken.end())
      problems.add(fmt::format("{} is the {} '{}'; give another file name, inputs are never overwritten", name,
                               input->second->what, input->second->path.string()));
    if (auto const [other, added] = written.emplace(key, &file); !added)
      problems.add(fmt::format("{} is the same file as {} '{}'; give two names", name, other->second->what,
                               other->second->path.string()));
  }
  problems.throw_if_any<ConfigError>();
}

}  // namespace gridmorph::cli
