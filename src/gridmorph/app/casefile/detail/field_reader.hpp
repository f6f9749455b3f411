// Reads the keys of a `field` rule. Internal to casefile.
#pragma once

#include <gridmorph/app/casefile/case_file.hpp>
#include <gridmorph/app/casefile/detail/table_reader.hpp>

namespace gridmorph::casefile {

/// The rule; its fields and, where it has modes, its modal field (for rule number out.motion.rules.size()) are added to the
/// case file. The files that it names are read.
TimedRule read_field(TableReader& table, CaseFile& out);

}  // namespace gridmorph::casefile
