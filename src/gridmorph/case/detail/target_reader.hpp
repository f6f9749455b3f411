// Reads the keys of rule = "target". Internal to casefile.
#pragma once

#include <gridmorph/case/detail/rule_reader.hpp>

namespace gridmorph::casefile {

Rule read_target_rule(TableReader& table, RuleContext const& shared);

}  // namespace gridmorph::casefile
