#include <gridmorph/app/casefile/detail/toml.hpp>
#include <gridmorph/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>

namespace gridmorph::casefile {

namespace {

/// The parser recurses into brackets; nobody nests them this deep.
constexpr int deepest_nesting = 64;

/// Refuses what is no text at all, and brackets nested so deep that a recursive parser would run out of stack.
void check_text(std::string const& text, std::string const& file) {
  if (text.find('\0') != std::string::npos)
    throw ConfigError(fmt::format("{}: not a text file; a case file (TOML) is wanted, not a mesh", file));
  int line = 1, depth = 0;
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char const c = text[i];
    if (c == '\n') {
      ++line;
      quote = 0;  // one-line strings end here at the latest; longer ones only make the count of brackets less strict
    } else if (quote != 0) {
      if (c == '\\' && quote == '"')
        ++i;
      else if (c == quote)
        quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#') {
      while (i + 1 < text.size() && text[i + 1] != '\n') ++i;
    } else if (c == '[' || c == '{') {
      if (++depth > deepest_nesting)
        throw ConfigError(
            fmt::format("{}:{}: not valid TOML: brackets nested more than {} deep", file, line, deepest_nesting));
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    }
  }
}

/// Where the parser gave up, and its words.
struct Mistake {
  std::string what;
  std::size_t line;
  std::size_t column;  ///< from 1
  std::string text;    ///< of the line
};

/// toml11 draws its messages over several lines; one line says the same.
std::string one_line(std::string_view drawn) {
  auto const first_line = [](std::string_view text) { return text.substr(0, text.find('\n')); };
  std::string_view what = first_line(drawn);
  if (what.starts_with("[error] ")) what.remove_prefix(8);
  if (what.starts_with("toml::"))
    if (auto const colon = what.find(": "); colon != std::string_view::npos) what.remove_prefix(colon + 2);
  std::string out(what);
  while (!out.empty() && out.back() == '.') out.pop_back();
  if (auto const mark = drawn.rfind("^--- "); mark != std::string_view::npos)
    out += fmt::format(" ({})", first_line(drawn.substr(mark + 5)));
  return out;
}

/// What toml11 begins with where it knows a value by its first character and cannot read it.
constexpr char const* words_about_values[] = {"bad ", "value having invalid format", "invalid "};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The value that the parser could not read, for messages that do not show it. TOML asks for digits on both sides of a
/// point, other languages do not.
std::string unreadable_value(Mistake const& mistake) {
  bool const of_value = std::any_of(std::begin(words_about_values), std::end(words_about_values),
                                    [&](char const* words) { return mistake.what.starts_with(words); });
  if (!of_value || mistake.column == 0 || mistake.column > mistake.text.size()) return {};
  std::string_view rest = std::string_view(mistake.text).substr(mistake.column - 1);
  if (auto const equals = rest.find('='); equals != std::string_view::npos) rest.remove_prefix(equals + 1);
  rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
  std::string_view const value = rest.substr(0, rest.find_first_of(",]} \t\r#"));
  if (value.empty()) return {};
  std::string_view const number = value.substr(value.front() == '-' || value.front() == '+' ? 1 : 0);
  bool const bare_point = number.size() > 1 && ((number.front() == '.' && is_digit(number[1])) ||
                                                (number.back() == '.' && is_digit(number.front())));
  return fmt::format("; found {}{}", value, bare_point ? ", write a digit on both sides of the point, as in 0.5" : "");
}

#if TOML11_VERSION_MAJOR >= 4
Mistake mistake_of(toml::syntax_error const& error) {
  if (error.errors().empty() || error.errors().front().locations().empty()) return {one_line(error.what()), 0, 0, {}};
  auto const& first = error.errors().front();
  auto const& [place, note] = first.locations().front();
  return {one_line(first.title() + "\n^--- " + note), place.first_line_number(), place.first_column_number(),
          place.num_lines() > 0 ? place.first_line() : std::string()};
}
using SyntaxError = toml::syntax_error;
#else
Mistake mistake_of(toml::exception const& error) {
  auto const& place = error.location();
  return {one_line(error.what()), place.line(), place.column(), place.line_str()};
}
using SyntaxError = toml::exception;
#endif

}  // namespace

toml::value parse_toml_text(std::string const& text, std::string const& file) {
  check_text(text, file);
  std::istringstream in(text);
  try {
    return toml::parse(in, file);
  } catch (SyntaxError const& error) {
    auto const mistake = mistake_of(error);
    throw ConfigError(
        fmt::format("{}:{}: not valid TOML: {}{}", file, mistake.line, mistake.what, unreadable_value(mistake)));
  } catch (std::exception const& error) {
    throw ConfigError(fmt::format("{}: not valid TOML: {}", file, one_line(error.what())));
  }
}

}  // namespace gridmorph::casefile
