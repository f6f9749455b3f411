// Reads the keys of rule = "inflate". Internal to casefile.
#pragma once

#include <gridmorph/case/detail/rule_reader.hpp>
#include <gridmorph/motion/height_table.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::casefile {

TimedRule read_inflate(TableReader& table, RuleContext const& shared);

/// Lines of numbers under a header line that names the columns span, chord, height and perhaps side (1, -1, or empty
/// for both), in any order of columns and lines. Throws ConfigError with all problems, each as "source:line: ...".
std::vector<HeightTable::Station> parse_heights(std::string_view text, std::string const& source);

}  // namespace gridmorph::casefile
