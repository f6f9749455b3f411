// Rules of one kind each, read from the keys of their tables. Internal to casefile.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/case/detail/rule_reader.hpp>
#include <gridmorph/case/detail/table_reader.hpp>

namespace gridmorph::casefile {

/// Reads rule = "bulb".
TimedRule read_bulbs(TableReader& table, RuleContext const& shared);

/// Reads rule = "ffd".
TimedRule read_ffd(TableReader& table, RuleContext const& shared);

/// Reads a `field` rule; its fields are added to the case file. The files that it names are read.
TimedRule read_field(TableReader& table, RuleContext const& shared, CaseFile& out);

/// Reads rule = "target".
Rule read_target_rule(TableReader& table, RuleContext const& shared);

}  // namespace gridmorph::casefile
