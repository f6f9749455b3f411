// What separates words in texts. Internal to io.
#pragma once

#include <algorithm>
#include <iterator>
#include <string>

namespace gridmorph::io {

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

inline std::string without_blanks_around(std::string const& text) {
  auto const begin = std::find_if_not(text.begin(), text.end(), is_blank);
  auto const end = std::find_if_not(text.rbegin(), std::make_reverse_iterator(begin), is_blank).base();
  return {begin, end};
}

}  // namespace gridmorph::io
