// Keys that are right in themselves and mean nothing for the mesh at hand.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/io/file_kind.hpp>

#include <string>

namespace gridmorph {

/// What a case file is used for, known once its mesh has been looked at.
struct CaseUse {
  enum class Run { morph, sequence, wheel };
  using Format = MeshFormat;
  bool unstructured = false;
  Run run = Run::morph;
  Format format = Format::cgns;
  bool found_blocks = false;  ///< not `unstructured`, since the elements of the file are blocks
};

/// Why no blocks are to be looked for among the hexahedra of a mesh, as the end of a sentence; empty: they are. [mesh]
/// blocks decides where it is given, otherwise what only elements have: their keys, regions by the names of their zones
/// and subsets, shocks of a flow that is solved on them, and wheels.
std::string why_elements(CaseFile const& case_file);

/// Throws one ConfigError that lists every key of the case file without an effect on such a run, each as
/// "file:line: key, why, what to do". Keys of [wheel] may stand beside those of a single morph, because one case file
/// serves both.
void refuse_ignored_keys(CaseFile const& case_file, CaseUse const& use);

}  // namespace gridmorph
