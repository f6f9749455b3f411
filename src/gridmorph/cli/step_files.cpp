#include <gridmorph/cli/step_files.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/unstructured_io.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>

#include <unistd.h>

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

StepFiles::~StepFiles() {
  if (series_ || committed_) return;
  // The last one too: a write that failed leaves nothing, and then there is nothing to remove.
  for (int step = 0; step < written_; ++step) std::remove(beside(step).c_str());
}

std::filesystem::path StepFiles::beside(int step) const {
  return step_path(*case_file_.sequence, step).string() + fmt::format(".{}.part", getpid());
}

void StepFiles::add(Coordinates const& morphed, OutputFields const& fields) {
  if (series_)
    series_->add(morphed);
  else if (unstructured_ != nullptr)
    write_morphed(case_file_.input.string(), beside(written_).string(), *unstructured_, morphed, fields);
  else
    write_morphed(case_file_.input.string(), beside(written_).string(), *structured_, morphed, fields);
  ++written_;
}

void StepFiles::commit() {
  if (series_) {
    series_->commit();
    return;
  }
  for (int step = 0; step < written_; ++step) {
    auto const to = step_path(*case_file_.sequence, step);
    if (std::rename(beside(step).c_str(), to.c_str()) == 0) continue;
    std::string const reason = std::strerror(errno);
    for (int done = 0; done < step; ++done) std::remove(step_path(*case_file_.sequence, done).c_str());
    throw MachineError(fmt::format("'{}' cannot be put in place: {}", to.string(), reason));
  }
  committed_ = true;
}

}  // namespace gridmorph::cli
