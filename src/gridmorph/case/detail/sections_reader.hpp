// Reads the keys of a [[motion]] table with rule = "sections". Internal to casefile.
#pragma once

#include <gridmorph/case/detail/table_reader.hpp>
#include <gridmorph/motion/motion.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gridmorph::casefile {

/// Tables in the case file itself, in a file that it names, or both. `has_axis`: whether [mesh] gives the machine axis,
/// which blades need and which makes them the default.
SectionsRule read_sections(TableReader& table, bool has_axis);

/// The redesign of a rule with the values of all its tables times `share`: half of a chord that is 10 % shorter is one
/// that is 5 % shorter, half of a twist a twist by half the angle. resolve() refuses values beyond their limits.
SectionsRule share_of(SectionsRule rule, double share);

/// The keys that say what sections are of: kind, span and flow.
void read_section_search(TableReader& table, bool has_axis, SectionsRule& rule);

/// The value of a key: one number for the whole span, or [[span fraction, value], ...].
std::vector<std::pair<double, double>> read_stations(TableReader& table, std::string const& key);
/// Notes span fractions beyond 0 to 1 or out of order, of the table `name`, at the key `where`.
void check_spans(TableReader& table, std::string const& where, std::string const& name,
                 std::vector<std::pair<double, double>> const& stations);

/// One column of a table of spanwise values: its name and (span fraction, value) where the column is not empty.
struct SpanwiseColumn {
  std::string name;
  std::vector<std::pair<double, double>> stations;
};

/// Columns under a header line that names them, one of them `span`; separated by commas, semicolons or blanks. Cells
/// may be empty between commas or semicolons. Blank lines and lines that begin with '#' are skipped. `known` are the
/// names that columns may have besides `span`. Throws ConfigError with all problems, each as "source:line: ...".
std::vector<SpanwiseColumn> parse_spanwise_columns(std::string_view text, std::string const& source,
                                                   std::vector<std::string> const& known);

}  // namespace gridmorph::casefile
