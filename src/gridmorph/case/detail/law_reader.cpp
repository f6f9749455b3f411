#include <gridmorph/case/detail/law_reader.hpp>
#include <gridmorph/case/formula.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/plan/law_table.hpp>

#include <fmt/format.h>

namespace gridmorph::casefile {

namespace {

OwnLaw read_own_law(TableReader& table, std::map<std::string, double> const& constants) {
  OwnLaw own;
  table.require("w", "w = \"t^2 * (3 - 2*t)\"");
  auto const expression = table.string("w");
  if (!expression) return own;
  own.name = fmt::format("w = \"{}\"", *expression);
  Problems& problems = table.context().problems;
  std::size_t const before = problems.messages().size();
  own.weight = make_law_formula({"w", *expression, table.where("w")}, constants, problems);
  if (problems.messages().size() > before) return own;
  try {
    (void)tabulate(own);
  } catch (PlanError const& e) {
    table.problem("w", e.what());
  }
  return own;
}

}  // namespace

std::optional<std::size_t> read_law(TableReader& table, std::vector<std::string> const& words,
                                    std::map<std::string, double> const& constants, Law& law, OwnLaw& own) {
  auto const word = table.choice("law", words);
  if (word && words[*word] == "formula") {
    law = Law::own;
    own = read_own_law(table, constants);
    return word;
  }
  if (word) law = Law(*word);
  if (table.has("w")) {
    (void)table.string("w");
    table.problem("w", "is the expression of law = \"formula\"; set that or remove it");
  }
  return word;
}

}  // namespace gridmorph::casefile
