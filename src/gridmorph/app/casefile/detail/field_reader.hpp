// Reads the keys of a `field` rule. Internal to casefile.
#pragma once

#include <gridmorph/app/casefile/case_file.hpp>
#include <gridmorph/app/casefile/detail/rule_reader.hpp>
#include <gridmorph/app/casefile/detail/table_reader.hpp>

namespace gridmorph::casefile {

/// The rule; its fields are added to the case file. The files that it names are read.
TimedRule read_field(TableReader& table, RuleContext const& shared, CaseFile& out);

}  // namespace gridmorph::casefile
