// Reads the keys of rule = "ffd". Internal to casefile.
#pragma once

#include <gridmorph/case/detail/rule_reader.hpp>

namespace gridmorph::casefile {

TimedRule read_ffd(TableReader& table, RuleContext const& shared);

}  // namespace gridmorph::casefile
