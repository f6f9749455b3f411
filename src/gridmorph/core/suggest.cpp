#include <gridmorph/core/suggest.hpp>

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace gridmorph {

int edit_distance(std::string_view a, std::string_view b) {
  std::size_t const n = b.size();
  std::vector<int> before(n + 1), last(n + 1), row(n + 1);
  for (std::size_t j = 0; j <= n; ++j) last[j] = int(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = int(i);
    for (std::size_t j = 1; j <= n; ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[n];
}

namespace {

/// Case and the choice between '-' and '_' never decide what a word means.
std::string folded(std::string_view word) {
  std::string out(word);
  for (char& c : out) c = c == '-' ? '_' : char(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

std::size_t common_prefix(std::string_view a, std::string_view b) {
  return std::size_t(std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin());
}

}  // namespace

std::string nearest_word(std::string_view word, std::vector<std::string> const& known) {
  std::string const wanted = folded(word);
  std::string best;
  int best_distance = std::max(2, int(word.size()) / 3) + 1;
  for (auto const& candidate : known) {
    std::string const other = folded(candidate);
    int distance = edit_distance(wanted, other);
    std::size_t const shorter = std::min(wanted.size(), other.size());
    if (shorter >= 3 && wanted.compare(0, shorter, other, 0, shorter) == 0) distance = std::min(distance, 2);
    // A word of two letters is not a slip of every other word of two letters.
    if (distance >= int(std::max(wanted.size(), other.size()))) continue;
    if (distance < best_distance || (distance == best_distance && !best.empty() &&
                                     common_prefix(wanted, other) > common_prefix(wanted, folded(best)))) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string suggestion(std::string_view word, std::vector<std::string> const& known) {
  if (auto const near = nearest_word(word, known); !near.empty()) return "; did you mean '" + near + "'?";
  std::string list;
  for (auto const& name : known) list += (list.empty() ? "; known here: " : ", ") + name;
  return list;
}

}  // namespace gridmorph
