// Reads the keys of rule = "bulb". Internal to casefile.
#pragma once

#include <gridmorph/case/detail/rule_reader.hpp>

namespace gridmorph::casefile {

TimedRule read_bulbs(TableReader& table, RuleContext const& shared);

}  // namespace gridmorph::casefile
