#include <gridmorph/case/detail/number_table.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/suggest.hpp>
#include <gridmorph/mapping/text_table.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace gridmorph::casefile {

namespace {

std::string joined(std::vector<std::string> const& names, char const* between) {
  std::string out;
  for (auto const& name : names) out += (out.empty() ? "" : between) + name;
  return out;
}

/// Place of each column in the lines; -1: not there.
std::vector<int> read_header(std::vector<std::string_view> const& cells, std::vector<NumberColumn> const& columns,
                             std::string const& where) {
  std::vector<std::string> known;
  for (auto const& column : columns) known.push_back(column.name);
  std::vector<int> place(columns.size(), -1);
  Problems problems;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    std::string const name = mapping::plain_name(cells[c]);
    auto const at = std::find(known.begin(), known.end(), name);
    if (at == known.end())
      problems.add(fmt::format("{}: the header names a column '{}', which is none of {}{}", where, name.substr(0, 40),
                               joined(known, ", "), suggestion(name, known)));
    else if (std::exchange(place[at - known.begin()], int(c)) >= 0)
      problems.add(fmt::format("{}: the header names column '{}' twice", where, name));
  }
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (place[k] < 0 && columns[k].required)
      problems.add(fmt::format("{}: the header names no column '{}'", where, known[k]));
  problems.throw_if_any<ConfigError>();
  return place;
}

/// Nothing where a cell does not fit.
std::optional<std::vector<double>> read_line(std::vector<std::string_view> const& cells, std::vector<int> const& place,
                                             std::vector<NumberColumn> const& columns, std::string const& where,
                                             Problems& problems) {
  std::vector<double> values;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    NumberColumn const& column = columns[k];
    std::string_view const cell = place[k] < 0 ? std::string_view() : cells[place[k]];
    if (cell.empty() && column.when_empty) {
      values.push_back(*column.when_empty);
      continue;
    }
    auto const number = finite_number(cell);
    if (number && (!column.fits || column.fits(*number)))
      values.push_back(*number);
    else
      problems.add(fmt::format("{}: {} = \"{}\" is not {}", where, column.name, cell.substr(0, 40), column.wanted));
  }
  if (values.size() < columns.size()) return std::nullopt;
  return values;
}

}  // namespace

std::vector<NumberLine> read_number_table(std::string_view text, std::string const& source,
                                          std::vector<NumberColumn> const& columns, std::string const& what) {
  std::vector<NumberLine> out;
  std::vector<int> place;
  std::vector<std::string_view> cells;
  std::size_t width = 0;
  Problems problems;
  for (mapping::Lines lines(text); problems.messages().size() < mapping::most_problems_per_file && lines.next();) {
    std::string const where = fmt::format("{}:{}", source, lines.number());
    mapping::split(lines.line(), mapping::separator_of(lines.line()), cells);
    if (width == 0) {
      width = cells.size();
      if (width > mapping::most_columns)
        throw ConfigError(fmt::format("{}: more than {} columns; is it a table?", where, mapping::most_columns));
      place = read_header(cells, columns, where);
    } else if (cells.size() != width) {
      problems.add(fmt::format("{}: expected {} columns, found {}", where, width, cells.size()));
    } else if (auto values = read_line(cells, place, columns, where, problems)) {
      out.push_back({where, std::move(*values)});
    }
  }
  problems.throw_if_any<ConfigError>();
  if (out.empty()) {
    std::vector<std::string> header;
    for (auto const& column : columns)
      if (column.required) header.push_back(column.name);
    throw ConfigError(fmt::format("{}: holds no {}; expected a header line such as {} and lines of numbers", source,
                                  what, joined(header, ",")));
  }
  return out;
}

}  // namespace gridmorph::casefile
