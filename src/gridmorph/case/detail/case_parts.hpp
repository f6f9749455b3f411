// Reads tables of a case file beside [[motion]]: regions, near field and background, the wheel. Internal to casefile.
#pragma once

#include <gridmorph/boundary/regions.hpp>
#include <gridmorph/case/case_file.hpp>
#include <gridmorph/case/detail/rule_reader.hpp>
#include <gridmorph/case/detail/table_reader.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>

#include <map>
#include <optional>
#include <string>

namespace gridmorph::casefile {

/// One region; what it lacks is noted as a problem.
InnerRegion read_region(TableReader& table, std::optional<Axis> const& axis);

/// Reads both tables where they are; notes every problem. constants: of formulas.
void read_near_field(TableReader& root, std::map<std::string, double> const& constants, CaseFile& out);

/// Fills CaseFile::wheel if the file has [wheel].
void read_wheel(TableReader& root, RuleContext const& shared, CaseFile& out);

}  // namespace gridmorph::casefile
