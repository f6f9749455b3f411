// What a boundary is where its file does not say, by the words that people name it by. Internal to io.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string>

namespace gridmorph::io {

inline PatchKind kind_by_name(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  auto const has = [&](std::initializer_list<char const*> words) {
    return std::any_of(words.begin(), words.end(), [&](char const* w) { return name.find(w) != std::string::npos; });
  };
  if (has({"inflow", "inlet"})) return PatchKind::inflow;
  if (has({"outflow", "outlet"})) return PatchKind::outflow;
  if (has({"farfield", "far_field", "freestream"})) return PatchKind::farfield;
  if (has({"symmetry", "sym_", "sym-"})) return PatchKind::symmetry;
  if (has({"wall", "airfoil", "aerofoil", "blade", "wing", "hub", "shroud"})) return PatchKind::wall;
  return PatchKind::other;
}

}  // namespace gridmorph::io
