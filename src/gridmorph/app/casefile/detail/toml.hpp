// toml11, and what differs between its versions 3 and 4. Internal to casefile.
#pragma once

#include <toml.hpp>

#include <string>

namespace gridmorph::casefile {

/// A value that is a string.
inline std::string const& string_of(toml::value const& value) {
#if TOML11_VERSION_MAJOR >= 4
  return value.as_string();
#else
  return value.as_string().str;
#endif
}

/// Line of a value in the case file. Cost: the text before it is read.
inline unsigned line_of(toml::value const& value) {
#if TOML11_VERSION_MAJOR >= 4
  return static_cast<unsigned>(value.location().first_line_number());
#else
  return value.location().line();
#endif
}

/// The tables of a TOML text; ConfigError with file and line when it is none.
toml::value parse_toml_text(std::string const& text, std::string const& file);

}  // namespace gridmorph::casefile
