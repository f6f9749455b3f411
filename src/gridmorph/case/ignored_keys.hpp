// Keys that are right in themselves and mean nothing for the mesh at hand.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/io/file_kind.hpp>

namespace gridmorph {

/// What a case file is used for, known once its mesh has been looked at.
struct CaseUse {
  enum class Run { morph, sequence, wheel };
  using Format = MeshFormat;
  bool unstructured = false;
  Run run = Run::morph;
  Format format = Format::cgns;
  bool found_blocks = false;  ///< not `unstructured`, since blocks are looked for among the elements of the file
};

/// Throws one ConfigError that lists every key of the case file without an effect on such a run, each as
/// "file:line: key, why, what to do". Keys of [wheel] may stand beside those of a single morph, because one case file
/// serves both.
void refuse_ignored_keys(CaseFile const& case_file, CaseUse const& use);

}  // namespace gridmorph
