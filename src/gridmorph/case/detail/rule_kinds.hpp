// Rules of one kind each, read from the keys of their tables. Internal to casefile.
#pragma once

#include <gridmorph/case/case_file.hpp>
#include <gridmorph/case/detail/rule_reader.hpp>
#include <gridmorph/case/detail/table_reader.hpp>
#include <gridmorph/motion/inflation_heights.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::casefile {

/// Reads rule = "bulb".
TimedRule read_bulbs(TableReader& table, RuleContext const& shared);

/// Reads rule = "ffd".
TimedRule read_ffd(TableReader& table, RuleContext const& shared);

/// Reads a `field` rule; its fields are added to the case file. The files that it names are read.
TimedRule read_field(TableReader& table, RuleContext const& shared, CaseFile& out);

/// Reads rule = "target".
Rule read_target_rule(TableReader& table, RuleContext const& shared);

/// Reads rule = "inflate".
TimedRule read_inflate(TableReader& table, RuleContext const& shared);

/// Lines of numbers under a header line that names the columns span, chord, height and perhaps side (1, -1, or empty
/// for both), in any order of columns and lines. Throws ConfigError with all problems, each as "source:line: ...".
std::vector<HeightTable::Station> parse_heights(std::string_view text, std::string const& source);

}  // namespace gridmorph::casefile
