// [near_field] and [background] of case files: what is particular to unstructured meshes. Internal to casefile.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/case/detail/table_reader.hpp>

#include <map>
#include <string>

namespace gridmorph::casefile {

/// Reads both tables where they are; notes every problem. constants: of formulas.
void read_near_field(TableReader& root, std::map<std::string, double> const& constants, CaseFile& out);

}  // namespace gridmorph::casefile
