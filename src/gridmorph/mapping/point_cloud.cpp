#include <gridmorph/core/error.hpp>
#include <gridmorph/mapping/point_cloud.hpp>
#include <gridmorph/mapping/text_table.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace gridmorph {

namespace {

using mapping::Lines;
using mapping::most_problems_per_file;
using mapping::split;

constexpr std::size_t n_required = 6, n_known = 10;
constexpr std::array<std::string_view, n_known> column_names{"x",  "y",     "z",     "dx",    "dy",
                                                             "dz", "dx_im", "dy_im", "dz_im", "id"};
constexpr std::size_t first_imaginary = 6, id_column = 9;
/// Doubles hold whole numbers exactly up to here.
constexpr double largest_id = 9007199254740992.0;
constexpr std::size_t absent = std::size_t(-1);

/// A header's name for one of the columns, or nothing.
std::optional<std::size_t> column_of(std::string_view field) {
  std::string const name = mapping::plain_name(field);
  if (name == "id" || name == "node") return id_column;
  for (std::size_t c = 0; c < id_column; ++c) {
    char const axis = "xyz"[c % 3];
    bool const position = c < 3;
    std::string const part = c < first_imaginary ? "" : "_im";
    std::array<std::string, 4> const spellings{
        std::string(column_names[c]), std::string(position ? "coordinate" : "displacement") + axis + part,
        fmt::format("{}:{}{}", position ? "points" : "displacement", c % 3, part),
        fmt::format("{}_{}{}", position ? "points" : "displacement", c % 3, part)};
    if (std::find(spellings.begin(), spellings.end(), name) != spellings.end()) return c;
  }
  if (name == "dx_re" || name == "dy_re" || name == "dz_re") return std::size_t(3 + name[1] - 'x');
  return std::nullopt;
}

/// The layout of the lines of one file: their separator and columns.
struct Layout {
  char separator = ',';
  std::array<std::size_t, n_known> column{0, 1, 2, 3, 4, 5, absent, absent, absent, absent};
  std::size_t n_columns = n_required;

  [[nodiscard]] bool has(std::size_t c) const { return column[c] != absent; }
};

/// Decides from the first line with content; true when it is a header, not data.
bool read_layout(std::vector<std::string_view>& fields, std::string_view line, std::string const& where,
                 Layout& layout) {
  layout.separator = mapping::separator_of(line);
  split(line, layout.separator, fields);
  layout.n_columns = fields.size();
  if (fields.size() > mapping::most_columns)
    throw ConfigError(
        fmt::format("{}: more than {} columns; expected x, y, z, dx, dy, dz", where, mapping::most_columns));
  bool const any_number = std::any_of(fields.begin(), fields.end(), [](auto f) { return to_number(f).has_value(); });
  if (any_number) {
    if (fields.size() != n_required)
      throw ConfigError(fmt::format("{}: expected 6 columns x, y, z, dx, dy, dz, found {}; {}", where, fields.size(),
                                    fields.size() < n_required ? "every line needs a position and a displacement"
                                                               : "name the columns in a header line"));
    return false;
  }
  layout.column.fill(absent);
  for (std::size_t f = 0; f < fields.size(); ++f)
    if (auto const c = column_of(fields[f])) {
      if (layout.has(*c))
        throw ConfigError(fmt::format("{}: the header names column '{}' twice", where, column_names[*c]));
      layout.column[*c] = f;
    }
  std::size_t const n_imaginary = layout.has(6) + layout.has(7) + layout.has(8);
  std::vector<std::string_view> missing;
  for (std::size_t c = 0; c < (n_imaginary > 0 ? id_column : n_required); ++c)
    if (!layout.has(c)) missing.push_back(column_names[c]);
  if (!missing.empty())
    throw ConfigError(
        fmt::format("{}: the first line holds no numbers and, as a header, does not name {}; it reads \"{}\"; "
                    "write x,y,z,dx,dy,dz",
                    where, fmt::join(missing, ", "), line.substr(0, 80)));
  return true;
}

}  // namespace

PointCloud parse_point_cloud(std::string_view text, std::string const& source) {
  PointCloud cloud;
  cloud.source = source;
  Problems problems;
  Layout layout;
  bool started = false;
  std::vector<std::string_view> fields;
  Lines lines(text);
  while (problems.messages().size() < most_problems_per_file && lines.next()) {
    std::string_view const line = lines.line();
    if (!started) {
      started = true;
      if (read_layout(fields, line, fmt::format("{}:{}", source, lines.number()), layout)) continue;
    }
    split(line, layout.separator, fields);
    if (fields.size() < layout.n_columns) {
      problems.add(fmt::format("{}:{}: expected {} columns, found {}: \"{}\"", source, lines.number(), layout.n_columns,
                               fields.size(), line.substr(0, 80)));
      continue;
    }
    std::array<double, n_known> value{};
    bool good = true;
    for (std::size_t c = 0; c < n_known && good; ++c) {
      if (!layout.has(c)) continue;
      std::string_view const field = fields[layout.column[c]];
      auto const read = to_number(field);
      good = read && std::isfinite(*read);
      if (!good) {
        problems.add(fmt::format("{}:{}: {} = \"{}\" is not {}", source, lines.number(), column_names[c],
                                 field.substr(0, 40),
                                 read ? "finite" : "a number (decimal point, not comma; exponents as 1e-3)"));
      } else if (c == id_column && (*read != std::floor(*read) || std::fabs(*read) > largest_id)) {
        good = false;
        problems.add(fmt::format("{}:{}: id = \"{}\" is not a whole number", source, lines.number(), field));
      } else {
        value[c] = *read;
      }
    }
    if (!good) continue;
    cloud.position.push_back({value[0], value[1], value[2]});
    cloud.displacement.push_back({value[3], value[4], value[5]});
    if (layout.has(first_imaginary)) cloud.imaginary.push_back({value[6], value[7], value[8]});
    if (layout.has(id_column)) cloud.id.push_back(std::int64_t(value[id_column]));
    cloud.line.push_back(lines.number());
  }
  if (problems.messages().size() >= most_problems_per_file) problems.add(source + ": further problems are not listed");
  problems.throw_if_any<ConfigError>();
  if (cloud.size() == 0) throw ConfigError(source + ": holds no points; expected lines of x, y, z, dx, dy, dz");
  return cloud;
}

PointCloud read_point_cloud(std::filesystem::path const& path) {
  return parse_point_cloud(mapping::read_text_file(path, "displacement file"), path.string());
}

}  // namespace gridmorph
