// "Did you mean ...?": the nearest of a list of known words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gridmorph {

/// Number of single-character insertions, deletions, substitutions and swaps of neighbours that turn a into b
/// (optimal string alignment). Cost O(|a| |b|).
int edit_distance(std::string_view a, std::string_view b);

/// The known word closest to `word` if it is close enough to be a slip of the finger (a third of its length, at least
/// two characters) or if one begins with the other; empty otherwise.
std::string nearest_word(std::string_view word, std::vector<std::string> const& known);

/// "; did you mean 'x'?" or, when nothing is near, "; known here: a, b, c".
std::string suggestion(std::string_view word, std::vector<std::string> const& known);

}  // namespace gridmorph
