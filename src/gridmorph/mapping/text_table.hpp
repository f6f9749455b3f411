// Tables in text files: lines of numbers under an optional header. Internal.
#pragma once

#include <gridmorph/core/text.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::mapping {

/// Problems of one file that are listed before the rest is left out.
inline constexpr std::size_t most_problems_per_file = 10;

/// A text without blanks and carriage returns at both ends.
std::string_view trimmed(std::string_view text);

/// The largest number of columns: more are no table of numbers by point, element or span.
inline constexpr std::size_t most_columns = 1000;

/// Splits one line; after most_columns fields the rest is one field more; blanks count as one separator however many
/// there are, the others each end a field.
void split(std::string_view line, char separator, std::vector<std::string_view>& fields);

/// ';' or ',' where the line has one, else a blank (tabs count as blanks).
char separator_of(std::string_view line);

/// A header's name for a column as it is compared: lower case, without quotes and blanks.
std::string plain_name(std::string_view field);

/// The lines of a text that hold something: no blank lines, no comments, no byte order mark.
class Lines {
 public:
  explicit Lines(std::string_view text);
  /// Moves on to the next line; false at the end.
  bool next();
  [[nodiscard]] std::string_view line() const { return line_; }
  [[nodiscard]] std::int64_t number() const { return number_; }  ///< 1-based

 private:
  std::string_view text_, line_;
  std::int64_t number_ = 0;
};

/// A whole file. `what` names it in messages ("displacement file"). Throws ConfigError, also for what is no ordinary
/// file (a pipe would block for ever) and for more than `most` bytes.
std::string read_text_file(std::filesystem::path const& path, std::string_view what, std::uintmax_t most = UINTMAX_MAX);

}  // namespace gridmorph::mapping
