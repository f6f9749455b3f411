// Reads the keys of a `field` rule. Internal to casefile.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/case/detail/rule_reader.hpp>
#include <gridmorph/case/detail/table_reader.hpp>

namespace gridmorph::casefile {

/// The rule; its fields are added to the case file. The files that it names are read.
TimedRule read_field(TableReader& table, RuleContext const& shared, CaseFile& out);

}  // namespace gridmorph::casefile
