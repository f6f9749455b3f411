// Keys as reports give them, put into case files.
#pragma once

#include <sstream>
#include <string>

namespace gridmorph::test {

/// A case file with the keys that a report gives: each "[table] key = value" in its table, in place of that key.
inline std::string with_keys(std::string text, std::string const& report) {
  std::istringstream keys(report);
  for (std::string key; std::getline(keys >> std::ws, key, ',');) {
    auto const end = key.find("] ") + 1;
    std::string const table = key.substr(0, end), value = key.substr(end + 1), name = value.substr(0, value.find(' '));
    auto at = text.find("\n" + table);
    if (at == std::string::npos) {
      text += "\n" + table + "\n" + value + "\n";
      continue;
    }
    for (auto const& old : {"\nmode ", "\nlaw "})  // no key stands twice
      if (std::string(old).find(name) != std::string::npos) {
        auto const line = text.find(old, at);
        if (line != std::string::npos) text.erase(line, text.find('\n', line + 1) - line);
      }
    at = text.find('\n', at + 1);
    text.insert(at, "\n" + value);
  }
  return text;
}

}  // namespace gridmorph::test
