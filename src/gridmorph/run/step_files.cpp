#include <gridmorph/core/error.hpp>
#include <gridmorph/run/step_files.hpp>

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <system_error>

namespace gridmorph::cli {

namespace {

std::vector<double> times_of(SequenceOptions const& options) {
  std::vector<double> times;
  for (int step = 0; step < options.steps; ++step) times.push_back(options.time_at(step));
  return times;
}

}  // namespace

std::filesystem::path step_path(SequenceOptions const& options, int step) {
  std::string name = options.output.filename().string();
  std::string const mark = fmt::format("{{{}}}", options.step_word());
  auto const digits = std::to_string(options.steps).size();
  if (auto const at = name.find(mark); at != std::string::npos)
    name.replace(at, mark.size(), fmt::format("{:0{}}", step + 1, digits));
  return options.output.parent_path() / name;
}

std::string wrote_steps(SequenceOptions const& options) {
  return one_file_per_step(options) ? fmt::format("\nwrote {} ... {}\n", step_path(options, 0).string(),
                                                  step_path(options, options.steps - 1).string())
                                    : fmt::format("\nwrote {} ({} steps)\n", options.output.string(), options.steps);
}

StepFiles::StepFiles(CaseFile const& case_file, LoadedMesh const& mesh)
    : case_file_(case_file), mesh_(mesh), format_(mesh_format(case_file.input.string())) {
  auto const& options = *case_file.sequence;
  if (!one_file_per_step(options)) series_.emplace(mesh.series(case_file.input, options.output, times_of(options)));
}

StepFiles::~StepFiles() {
  std::error_code ignored;
  for (auto const& folder : folders_) std::filesystem::remove_all(folder, ignored);
}

void StepFiles::add(int step, Coordinates const& morphed, OutputFields const& fields) {
  if (series_) {
    series_->add(mesh_.in_file(morphed));
    return;
  }
  // What takes several files is written where it belongs.
  auto const ending = case_file_.sequence->output.extension();
  if (format_ == MeshFormat::openfoam || ending == ".vtm" || ending == ".pvtu") {
    auto const folder = step_path(*case_file_.sequence, step);
    std::error_code ignored;
    auto const beside = format_ == MeshFormat::openfoam ? folder : std::filesystem::path(folder).replace_extension();
    for (auto const& p : {folder, beside})
      if (!std::filesystem::exists(p, ignored)) folders_.push_back(p);
    mesh_.write(case_file_.input, folder, morphed, fields);
    return;
  }
  auto const& file = files_.emplace_back(step_path(*case_file_.sequence, step).string());
  mesh_.write(case_file_.input, file.path(), morphed, fields);
}

void commit_steps(std::deque<io::OutputFile>& files) {
  int done = 0;
  try {
    for (; done < int(files.size()); ++done) files[done].commit();
  } catch (MachineError const&) {
    for (int step = 0; step < done; ++step) std::remove(files[step].output().c_str());
    throw;
  }
}

void StepFiles::commit() {
  folders_.clear();
  if (series_) {
    series_->commit();
    return;
  }
  commit_steps(files_);
}

}  // namespace gridmorph::cli
