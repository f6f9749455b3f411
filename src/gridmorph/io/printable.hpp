// What stands in a file, as messages can show it. Internal to io.
#pragma once

#include <string>
#include <string_view>

namespace gridmorph::io {

/// The text as messages can show it: at most 40 characters, what cannot be printed as '?'.
inline std::string printable(std::string_view text) {
  constexpr std::size_t most = 40;
  std::string out(text.substr(0, most));
  for (char& c : out)
    if (c < ' ' || c > '~') c = '?';
  return out;
}

}  // namespace gridmorph::io
