// Laws of grid lines in case files: a word, and what "formula" needs besides. Internal to casefile.
#pragma once

#include <gridmorph/case/detail/table_reader.hpp>
#include <gridmorph/plan/options.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::casefile {

/// `law` of a table, one of `words`, which start as Law does up to where "formula" stands; with "formula" the
/// expression `w`, which is read into `own`. Returns the number of the word; nothing where the table names no law.
std::optional<std::size_t> read_law(TableReader& table, std::vector<std::string> const& words,
                                    std::map<std::string, double> const& constants, Law& law, OwnLaw& own);

}  // namespace gridmorph::casefile
