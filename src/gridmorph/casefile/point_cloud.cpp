#include <gridmorph/casefile/point_cloud.hpp>
#include <gridmorph/core/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <optional>
#include <system_error>

namespace gridmorph {

namespace {

constexpr std::size_t most_problems = 10;
constexpr std::array<std::string_view, 6> column_names{"x", "y", "z", "dx", "dy", "dz"};

std::string_view trimmed(std::string_view text) {
  auto const blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Splits one line; blanks count as one separator however many there are, the others each end a field.
void split(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  if (separator == ' ') {
    while (!(line = trimmed(line)).empty()) {
      std::size_t const end = std::min(line.find_first_of(" \t"), line.size());
      fields.push_back(line.substr(0, end));
      line.remove_prefix(end);
    }
    return;
  }
  for (;;) {
    std::size_t const end = line.find(separator);
    fields.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

char separator_of(std::string_view line) {
  for (char const c : {';', ','})
    if (line.find(c) != std::string_view::npos) return c;
  return ' ';
}

std::optional<double> to_number(std::string_view field) {
  if (!field.empty() && field.front() == '+') field.remove_prefix(1);
  double value = 0;
  auto const [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error == std::errc::result_out_of_range && end == field.data() + field.size()) {
    // Too small to represent is zero for a length; too large is not a number of use.
    std::size_t const exponent = field.find_first_of("eE");
    bool const tiny = exponent != std::string_view::npos && field.find('-', exponent) != std::string_view::npos;
    return tiny ? 0.0 : HUGE_VAL;
  }
  if (error != std::errc() || end != field.data() + field.size() || field.empty()) return std::nullopt;
  return value;
}

/// A header's name for one of the six columns, or nothing.
std::optional<int> column_of(std::string_view field) {
  std::string name;
  for (char const c : field)
    if (c != '"' && c != '\'' && c != ' ') name += char(std::tolower(static_cast<unsigned char>(c)));
  for (int c = 0; c < 6; ++c) {
    char const axis = "xyz"[c % 3];
    bool const position = c < 3;
    std::array<std::string, 4> const spellings{std::string(column_names[c]),
                                               std::string(position ? "coordinate" : "displacement") + axis,
                                               fmt::format("{}:{}", position ? "points" : "displacement", c % 3),
                                               fmt::format("{}_{}", position ? "points" : "displacement", c % 3)};
    if (std::find(spellings.begin(), spellings.end(), name) != spellings.end()) return c;
  }
  return std::nullopt;
}

/// What the lines of one file look like.
struct Layout {
  char separator = ',';
  std::array<std::size_t, 6> column{0, 1, 2, 3, 4, 5};
  std::size_t n_columns = 6;
};

/// Decides from the first line with content; true when it is a header, not data.
bool read_layout(std::vector<std::string_view>& fields, std::string_view line, std::string const& where,
                 Layout& layout) {
  layout.separator = separator_of(line);
  split(line, layout.separator, fields);
  layout.n_columns = fields.size();
  bool const any_number = std::any_of(fields.begin(), fields.end(), [](auto f) { return to_number(f).has_value(); });
  if (any_number) {
    if (fields.size() != 6)
      throw ConfigError(fmt::format(
          "{}: expected 6 columns x, y, z, dx, dy, dz, found {}; {}", where, fields.size(),
          fields.size() < 6 ? "every line needs a position and a displacement" : "name the columns in a header line"));
    return false;
  }
  std::array<bool, 6> found{};
  for (std::size_t f = 0; f < fields.size(); ++f)
    if (auto const c = column_of(fields[f])) {
      if (found[*c]) throw ConfigError(fmt::format("{}: the header names column '{}' twice", where, column_names[*c]));
      found[*c] = true;
      layout.column[*c] = f;
    }
  std::vector<std::string_view> missing;
  for (std::size_t c = 0; c < 6; ++c)
    if (!found[c]) missing.push_back(column_names[c]);
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
  std::int64_t number = 0;
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);  // byte order mark of spreadsheet programs
  while (!text.empty() && problems.messages().size() < most_problems) {
    std::size_t const end = text.find('\n');
    std::string_view const line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++number;
    if (line.empty() || line.front() == '#') continue;
    std::string const where = started ? std::string() : fmt::format("{}:{}", source, number);
    if (!started) {
      started = true;
      if (read_layout(fields, line, where, layout)) continue;
    }
    split(line, layout.separator, fields);
    if (fields.size() < layout.n_columns) {
      problems.add(fmt::format("{}:{}: expected {} columns, found {}: \"{}\"", source, number, layout.n_columns,
                               fields.size(), line.substr(0, 80)));
      continue;
    }
    std::array<double, 6> value{};
    bool good = true;
    for (std::size_t c = 0; c < 6 && good; ++c) {
      std::string_view const field = fields[layout.column[c]];
      auto const read = to_number(field);
      good = read && std::isfinite(*read);
      if (good)
        value[c] = *read;
      else
        problems.add(fmt::format("{}:{}: {} = \"{}\" is not {}", source, number, column_names[c], field.substr(0, 40),
                                 read ? "finite" : "a number (decimal point, not comma; exponents as 1e-3)"));
    }
    if (!good) continue;
    cloud.position.push_back({value[0], value[1], value[2]});
    cloud.displacement.push_back({value[3], value[4], value[5]});
    cloud.line.push_back(number);
  }
  if (problems.messages().size() >= most_problems) problems.add(source + ": further problems are not listed");
  problems.throw_if_any<ConfigError>();
  if (cloud.size() == 0) throw ConfigError(source + ": holds no points; expected lines of x, y, z, dx, dy, dz");
  return cloud;
}

PointCloud read_point_cloud(std::filesystem::path const& path) {
  std::error_code error;
  auto const status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status))
    throw ConfigError(fmt::format("displacement file '{}' does not exist; check the path", path.string()));
  if (std::filesystem::is_directory(status))
    throw ConfigError(fmt::format("displacement file '{}' is a directory; give a file", path.string()));
  std::ifstream in(path, std::ios::binary);
  if (!in)
    throw ConfigError(fmt::format("displacement file '{}' cannot be opened; check its permissions", path.string()));
  std::string text;
  auto const size = std::filesystem::file_size(path, error);
  if (!error) text.reserve(size);
  std::array<char, 1 << 16> chunk;
  while (in.read(chunk.data(), chunk.size()) || in.gcount() > 0) text.append(chunk.data(), std::size_t(in.gcount()));
  if (in.bad()) throw ConfigError(fmt::format("displacement file '{}' cannot be read to its end", path.string()));
  return parse_point_cloud(text, path.string());
}

}  // namespace gridmorph
