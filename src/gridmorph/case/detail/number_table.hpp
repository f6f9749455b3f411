// Text tables of numbers under a header line that names their columns. Internal to casefile.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::casefile {

struct NumberColumn {
  std::string name;
  std::string wanted;                  ///< what its cells are, for messages: "a fraction from 0 to 1"
  std::function<bool(double)> fits{};  ///< empty: any finite number
  bool required = true;                ///< otherwise the header may leave it out
  std::optional<double> when_empty{};  ///< value of an empty cell, and of a column that is not there; nothing: an error
};

struct NumberLine {
  std::string where;           ///< "source:line"
  std::vector<double> values;  ///< in the order of the columns asked for
};

/// Columns and lines in any order. Throws ConfigError with all problems, each as "source:line: ..."; also where there
/// is no line of `what` ("heights").
std::vector<NumberLine> read_number_table(std::string_view text, std::string const& source,
                                          std::vector<NumberColumn> const& columns, std::string const& what);

}  // namespace gridmorph::casefile
