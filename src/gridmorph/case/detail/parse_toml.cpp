#include <gridmorph/case/detail/toml.hpp>
#include <gridmorph/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gridmorph::casefile {

namespace {

/// The parser recurses into brackets and into the parts of a key; nobody nests them this deep.
constexpr int deepest_nesting = 64;
/// The parser reads the whole line for each value in it. Arrays are given to it in lines of about this length, and the
/// rest (tables in braces) may cost it so many characters in all.
constexpr std::size_t long_line = 200;
constexpr std::uint64_t most_read_again = 1'000'000'000;

/// Looks through a text before the parser does. Refuses what is no text at all, brackets and keys nested so deep that a
/// recursive parser would run out of stack, and lines of more values than it can read in time; breaks long arrays into
/// lines.
class Preparation {
 public:
  Preparation(std::string const& text, std::string const& file) : text_(text), file_(file) {}

  void run() {
    if (text_.find('\0') != std::string::npos)
      throw ConfigError(fmt::format("{}: not a text file; a case file (TOML) is wanted, not a mesh", file_));
    out_.reserve(text_.size() + text_.size() / long_line);
    lines_.push_back(1);
    while (at_ < text_.size()) step();
    end_line();
  }
  std::string const& out() const { return out_; }
  std::vector<unsigned> lines() { return std::move(lines_); }

 private:
  [[noreturn]] void refuse(std::string const& what) const {
    throw ConfigError(fmt::format("{}:{}: not valid TOML: {}", file_, line_, what));
  }

  void step() {
    char const c = text_[at_];
    if (c == '\n') {
      end_line();
      ++line_;
      put(c);
      lines_.push_back(line_);
    } else if (c == '"' || c == '\'') {
      string(c);
    } else if (c == '#') {
      while (at_ < text_.size() && text_[at_] != '\n') put(text_[at_]);
    } else {
      mark(c);
      put(c);
      if (c == ',' && !open_.empty() && open_.back() == '[' && out_.size() - line_began_ > long_line) {
        end_line();
        out_ += '\n';
        line_began_ = out_.size();
        lines_.push_back(line_);
      }
    }
  }

  /// What a character outside of strings means for the depth.
  void mark(char c) {
    if (c == '.') {
      if (++dots_ > deepest_nesting) refuse(fmt::format("a key of more than {} parts", deepest_nesting));
      return;
    }
    if (c == ',' || c == '=' || c == '[' || c == ']' || c == '{' || c == '}') dots_ = 0;
    if (c == '=' || c == ',') ++values_;
    if (c == '[' || c == '{') {
      open_ += c;
      if (open_.size() > std::size_t(deepest_nesting))
        refuse(fmt::format("brackets nested more than {} deep", deepest_nesting));
    } else if ((c == ']' || c == '}') && !open_.empty()) {
      open_.pop_back();
    }
  }

  /// To the end of a string; those of one line end with it at the latest, and the parser says what is wrong.
  void string(char quote) {
    std::string const three(3, quote), ends = text_.compare(at_, 3, three) == 0 ? three : std::string(1, quote);
    for (std::size_t k = 0; k < ends.size(); ++k) put(quote);
    while (at_ < text_.size()) {
      char const c = text_[at_];
      if (c == '\n') {
        if (ends.size() == 1) return;
        ++line_;
        put(c);
        lines_.push_back(line_);
      } else if (text_.compare(at_, ends.size(), ends) == 0) {
        for (std::size_t k = 0; k < ends.size(); ++k) put(quote);
        return;
      } else {
        put(c);
        if (c == '\\' && quote == '"' && at_ < text_.size() && text_[at_] != '\n') put(text_[at_]);
      }
    }
  }

  void put(char c) {
    out_ += c;
    ++at_;
    if (c == '\n') line_began_ = out_.size();
  }

  void end_line() {
    read_again_ += values_ * (out_.size() - line_began_);
    if (read_again_ > most_read_again)
      refuse(fmt::format("a line of {} characters with {} values in braces; write them as a table, one in a line",
                         out_.size() - line_began_, values_));
    values_ = 0;
    dots_ = 0;
  }

  std::string const& text_;
  std::string const& file_;
  std::string out_;
  std::vector<unsigned> lines_;
  std::string open_;  ///< brackets
  std::size_t at_ = 0, line_began_ = 0;
  unsigned line_ = 1;
  int dots_ = 0;
  std::uint64_t values_ = 0, read_again_ = 0;
};

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

unsigned TomlLines::of(toml::value const& value) const {
#if TOML11_VERSION_MAJOR >= 4
  return original(value.location().first_line_number());
#else
  // The parser would count the line breaks from the beginning of the text.
  auto const* const place = dynamic_cast<toml::detail::region const*>(toml::detail::get_region(value));
  if (place == nullptr || !place->is_ok()) return 1;
  if (!std::exchange(found_breaks_, true))
    for (auto c = place->begin(); c != place->end(); ++c)
      if (*c == '\n') breaks_.push_back(c - place->begin());
  auto const before = std::lower_bound(breaks_.begin(), breaks_.end(), place->first() - place->begin());
  return original(std::size_t(before - breaks_.begin()) + 1);
#endif
}

TomlText parse_toml_text(std::string const& text, std::string const& file) {
  Preparation preparation(text, file);
  preparation.run();
  auto const lines = std::make_shared<TomlLines const>(preparation.lines());
  std::istringstream in(preparation.out());
  try {
    return {toml::parse(in, file), lines};
  } catch (SyntaxError const& error) {
    auto const mistake = mistake_of(error);
    throw ConfigError(fmt::format("{}:{}: not valid TOML: {}{}", file,
                                  mistake.line == 0 ? 0 : lines->original(mistake.line), mistake.what,
                                  unreadable_value(mistake)));
  } catch (std::exception const& error) {
    throw ConfigError(fmt::format("{}: not valid TOML: {}", file, one_line(error.what())));
  }
}

}  // namespace gridmorph::casefile
