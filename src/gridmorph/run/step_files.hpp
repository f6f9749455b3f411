// The meshes of a sequence on disk: one file per step, or one file with a series. All of them appear, or none.
#pragma once

#include <gridmorph/io/output_file.hpp>
#include <gridmorph/run/loaded_mesh.hpp>

#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// "blade_{step}.cgns" -> "blade_007.cgns" for step 6 of 100: as many digits as the last step needs. Without "{step}",
/// of a sweep "{design}", the output as it is.
std::filesystem::path step_path(SequenceOptions const& options, int step);

/// "wrote step_1.cgns ... step_8.cgns" or "wrote series.cgns (8 steps)", on a line of its own.
std::string wrote_steps(SequenceOptions const& options);

/// Puts files of steps, from the first on, in place: all or none. Throws MachineError.
void commit_steps(std::deque<io::OutputFile>& files);

class StepFiles {
 public:
  /// `mesh` must outlive the files.
  StepFiles(CaseFile const& case_file, LoadedMesh const& mesh);
  StepFiles(StepFiles const&) = delete;
  StepFiles& operator=(StepFiles const&) = delete;
  ~StepFiles();

  /// Writes a step, a later one than those before, beside its place. Fields only with one file per step.
  void add(int step, Coordinates const& morphed, OutputFields const& fields);
  /// Puts everything in place. Throws MachineError when a file cannot be renamed; those that were put in place before
  /// it are taken away again.
  void commit();

 private:
  CaseFile const& case_file_;
  LoadedMesh const& mesh_;
  MeshFormat format_;
  std::deque<io::OutputFile> files_;  ///< of the steps so far
  std::vector<std::filesystem::path>
      folders_;  ///< of the steps so far, where each takes several files; emptied once they are to stay
  std::optional<SeriesWriter> series_;
};

}  // namespace gridmorph::cli
