#include <gridmorph/app/cli/step_files.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/unstructured_io.hpp>

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <string_view>

namespace gridmorph::cli {

namespace {

constexpr std::string_view mark = "{step}";

std::vector<double> times_of(SequenceOptions const& options) {
  std::vector<double> times;
  for (int step = 0; step < options.steps; ++step) times.push_back(options.time_at(step));
  return times;
}

}  // namespace

bool one_file_per_step(SequenceOptions const& options) {
  return options.output.filename().string().find(mark) != std::string::npos;
}

std::filesystem::path step_path(SequenceOptions const& options, int step) {
  std::string name = options.output.filename().string();
  auto const digits = std::to_string(options.steps).size();
  if (auto const at = name.find(mark); at != std::string::npos)
    name.replace(at, mark.size(), fmt::format("{:0{}}", step + 1, digits));
  return options.output.parent_path() / name;
}

StepFiles::StepFiles(CaseFile const& case_file, Mesh const& mesh) : case_file_(case_file), structured_(&mesh) {
  auto const& options = *case_file.sequence;
  if (!one_file_per_step(options))
    series_.emplace(case_file.input.string(), options.output.string(), mesh, times_of(options));
}

StepFiles::StepFiles(CaseFile const& case_file, UnstructuredMesh const& mesh)
    : case_file_(case_file), unstructured_(&mesh) {
  if (!one_file_per_step(*case_file.sequence))
    throw ConfigError(
        fmt::format("{}: a series in one file is for structured meshes, and '{}' is unstructured; write one file per "
                    "step, output = \"step_{{step}}{}\" in [sequence]",
                    case_file.source.string(), case_file.input.string(), case_file.input.extension().string()));
}

std::string const& StepFiles::next_file() {
  return files_.emplace_back(step_path(*case_file_.sequence, int(files_.size())).string()).path();
}

void StepFiles::add(Coordinates const& morphed, OutputFields const& fields) {
  if (series_)
    series_->add(morphed);
  else if (unstructured_ != nullptr)
    write_morphed(case_file_.input.string(), next_file(), *unstructured_, morphed, fields);
  else
    write_morphed(case_file_.input.string(), next_file(), *structured_, morphed, fields);
}

void StepFiles::commit() {
  if (series_) {
    series_->commit();
    return;
  }
  int done = 0;
  try {
    for (; done < int(files_.size()); ++done) files_[std::size_t(done)].commit();
  } catch (MachineError const&) {
    for (int step = 0; step < done; ++step) std::remove(step_path(*case_file_.sequence, step).c_str());
    throw;
  }
}

}  // namespace gridmorph::cli
