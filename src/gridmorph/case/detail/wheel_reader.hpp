// Reads [wheel] of a case file. Internal to casefile.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/case/detail/rule_reader.hpp>

namespace gridmorph::casefile {

/// Fills CaseFile::wheel if the file has [wheel].
void read_wheel(TableReader& root, RuleContext const& shared, CaseFile& out);

}  // namespace gridmorph::casefile
