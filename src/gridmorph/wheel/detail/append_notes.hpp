// Notes of several motions, which mostly say the same.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace gridmorph::detail {

/// Those that are not there yet.
inline void append_notes(std::vector<std::string>& to, std::vector<std::string> const& from) {
  for (auto const& text : from)
    if (std::find(to.begin(), to.end(), text) == to.end()) to.push_back(text);
}

}  // namespace gridmorph::detail
