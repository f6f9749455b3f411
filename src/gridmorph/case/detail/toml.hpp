// toml11, and what differs between its versions 3 and 4. Internal to casefile.
#pragma once

#include <toml.hpp>

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::casefile {

/// A value that is a string.
inline std::string const& string_of(toml::value const& value) {
#if TOML11_VERSION_MAJOR >= 4
  return value.as_string();
#else
  return value.as_string().str;
#endif
}

/// Lines of the values of one text.
class TomlLines {
 public:
  /// `original`: line of the text for each line that the parser was given.
  explicit TomlLines(std::vector<unsigned> original) : original_(std::move(original)) {}
  /// Cost: O(log(lines)); the first one reads the text.
  [[nodiscard]] unsigned of(toml::value const& value) const;
  [[nodiscard]] unsigned original(std::size_t line) const {
    return line - 1 < original_.size() ? original_[line - 1] : unsigned(line);
  }

 private:
  std::vector<unsigned> original_;
  mutable std::vector<std::ptrdiff_t> breaks_;  ///< places of the line breaks in what the parser was given
  mutable bool found_breaks_ = false;
};

struct TomlText {
  toml::value root;
  std::shared_ptr<TomlLines const> lines;
};

/// The tables of a TOML text; ConfigError with file and line when it is none. Cost: O(length), whatever is in it.
TomlText parse_toml_text(std::string const& text, std::string const& file);

}  // namespace gridmorph::casefile
