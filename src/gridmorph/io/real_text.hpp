// Numbers as text files of meshes write them. Internal to io.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace gridmorph::io {

/// A word that is a number, with or without a plus before it; nothing where it is none, or more than one.
inline std::optional<double> real_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  auto const [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (failure != std::errc() || end != word.data() + word.size()) return {};
  return value;
}

}  // namespace gridmorph::io
