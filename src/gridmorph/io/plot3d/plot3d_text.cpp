#include <gridmorph/core/error.hpp>
#include <gridmorph/io/plot3d/plot3d_text.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <utility>

namespace gridmorph::plot3d {

namespace {

constexpr std::string_view separators = " \t\r\n,";
/// Numbers that repeat counts may make of a file, per byte of it.
constexpr std::uint64_t most_repeats_per_byte = 16;
constexpr double most_zones = 1e6;

/// The whole of a word as a number.
std::optional<double> to_number(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  if (word.empty() || word.front() == '+') return std::nullopt;
  double value = 0;
  auto const parse = [&](char const* begin, char const* end) {
    auto const [stop, error] = std::from_chars(begin, end, value);
    // Too small or too large for a double: strtod says which.
    if (error == std::errc::result_out_of_range && stop == end) {
      value = std::strtod(std::string(begin, end).c_str(), nullptr);
      return true;
    }
    return error == std::errc() && stop == end;
  };
  if (parse(word.data(), word.data() + word.size())) return value;
  // Fortran: D or no letter before the exponent.
  constexpr std::size_t longest = 64;
  if (word.size() >= longest) return std::nullopt;
  std::array<char, longest + 1> copy{};
  std::size_t n = 0;
  for (std::size_t i = 0; i < word.size(); ++i) {
    char const c = word[i];
    if (c == 'd' || c == 'D' || c == 'q' || c == 'Q')
      copy[n++] = 'e';
    else {
      if ((c == '-' || c == '+') && i > 0 && (word[i - 1] == '.' || (word[i - 1] >= '0' && word[i - 1] <= '9')))
        copy[n++] = 'e';
      copy[n++] = c;
    }
    if (n >= longest) return std::nullopt;
  }
  if (parse(copy.data(), copy.data() + n)) return value;
  return std::nullopt;
}

/// What one number says about the style of all.
struct Look {
  bool point = false, exponent = false, capital = false;
  int decimals = 0, significant = 0;
};

Look look_at(std::string_view number) {
  Look out;
  bool leading = true;
  int digits = 0;
  for (char const c : number) {
    if (c >= '0' && c <= '9') {
      ++digits;
      leading = leading && c == '0';
      if (!leading) ++out.significant;
      if (out.point) ++out.decimals;
    } else if (c == '.') {
      out.point = true;
    } else if (c != '-' && c != '+') {
      out.exponent = true;
      out.capital = c < 'a';
      break;
    }
  }
  if (leading) out.significant = digits;  // a zero has them all
  return out;
}

/// Numbers that all look alike are written so; otherwise with as many digits as the longest, and enough of them.
class StyleFinder {
 public:
  void add(std::string_view number) {
    Look const l = look_at(number);
    most_ = std::max(most_, l.significant);
    capital_ = capital_ || l.capital;
    if (first_) {
      kind_ = l.exponent ? NumberStyle::Kind::scientific : NumberStyle::Kind::fixed;
      decimals_ = l.decimals;
      alike_ = l.point;
      first_ = false;
    }
    alike_ = alike_ && l.point && l.exponent == (kind_ == NumberStyle::Kind::scientific) && l.decimals == decimals_;
  }
  [[nodiscard]] NumberStyle style() const {
    constexpr int few = 4;  // short numbers are alike by chance
    NumberStyle out;
    out.capital = capital_;
    out.significant = most_;
    if (alike_ && kind_ == NumberStyle::Kind::fixed && decimals_ >= few) {
      out.kind = kind_;
      out.digits = decimals_;
    } else if (alike_ && most_ >= few) {
      out.digits = most_;
    } else {
      out.digits = most_ <= 9 ? 9 : 17;
    }
    return out;
  }

 private:
  bool first_ = true, alike_ = true, capital_ = false;
  NumberStyle::Kind kind_ = NumberStyle::Kind::scientific;
  int decimals_ = 0, most_ = 0;
};

std::string write_number(double value, NumberStyle const& style) {
  std::array<char, 400> text{};
  if (style.kind == NumberStyle::Kind::fixed)
    std::snprintf(text.data(), text.size(), "%.*f", std::min(style.digits, 40), value);
  else
    std::snprintf(text.data(), text.size(), style.capital ? "%.*E" : "%.*e", std::min(style.digits, 40) - 1, value);
  return text.data();
}

std::optional<std::int64_t> whole(double value) {
  if (!(value >= 1 && value <= 2147483647.0) || value != std::floor(value)) return std::nullopt;
  return std::int64_t(value);
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// All numbers of a text, and what tells how they are written.
class TextNumbers {
 public:
  TextNumbers(std::string_view text, std::string const& path) : text_(text) {
    Scanner scanner(text, path);
    std::uint64_t const room = most_repeats_per_byte * text.size() + 64;
    for (Token token; scanner.next(token);) {
      if (token.repeat > room || all_.size() + token.repeat > room)
        throw IoError(path + ": '" + std::string(token.text.substr(0, 40)) +
                      "' repeats a number more often than a mesh file of this size does; repair it or write it again");
      all_.insert(all_.end(), token.repeat, token.value);
      if (ends_.size() < header_most)
        ends_.insert(ends_.end(), std::min<std::size_t>(token.repeat, header_most - ends_.size()), scanner.end());
      if (token.number.find('.') != std::string_view::npos) style_.add(token.number);
    }
  }

  [[nodiscard]] std::vector<double> const& all() const { return all_; }
  [[nodiscard]] NumberStyle style() const { return style_.style(); }
  /// Where the first `header` numbers end in the text.
  [[nodiscard]] std::size_t end_of(std::size_t header) const { return ends_[header - 1]; }
  /// Whether a repeat count has numbers before and behind that end.
  [[nodiscard]] bool runs_across(std::size_t header) const {
    return header < ends_.size() && ends_[header] == ends_[header - 1];
  }
  /// Number of zones, extents and coordinates are read by statements of their own: each begins on a new line.
  [[nodiscard]] bool line_ends_after(std::size_t numbers) const {
    if (numbers > ends_.size()) return false;
    auto const rest = text_.substr(ends_[numbers - 1]);
    auto const next = rest.find_first_not_of(" \t\r,");
    return next == std::string_view::npos || rest[next] == '\n';
  }

 private:
  static constexpr std::size_t header_most = 3 * std::size_t(most_zones) + 1;

  std::string_view text_;
  std::vector<double> all_;
  std::vector<std::size_t> ends_;  ///< of the first numbers, to know where the extents end
  StyleFinder style_;
};

struct TextCandidate {
  FileLayout layout;
  std::size_t header = 0;  ///< numbers before the coordinates
};

/// Which layouts the numbers of a formatted file fit.
class TextTrials {
 public:
  TextTrials(TextNumbers const& numbers, Stated const& stated) : numbers_(numbers), stated_(stated) {
    for (bool const multi : {true, false})
      for (int const dimensions : {3, 2}) try_header(multi, dimensions);
  }

  /// The one that fits. Throws IoError where there is none, or several.
  [[nodiscard]] TextCandidate only(std::string const& path) && {
    if (good_.size() > 1) {
      std::string message =
          path + ": could be several kinds of PLOT3D files; state which with format = \"...\" in its side file:";
      for (auto const& c : good_) message += "\n  " + to_string(c.layout.variant);
      throw IoError(message);
    }
    if (good_.empty())
      throw IoError(path + ": is no formatted PLOT3D file: " +
                    (nearest_.empty() ? "its first numbers are no extents of zones" : nearest_) +
                    "; it is cut short, damaged or something else: write it again");
    return std::move(good_.front());
  }

 private:
  void try_header(bool multi, int dimensions) {
    auto const& all = numbers_.all();
    TextCandidate c;
    auto& v = c.layout.variant;
    v.storage = Storage::formatted;
    v.multi_block = multi;
    v.dimensions = dimensions;
    v.planes = stated_.planes.value_or(false);  // nothing in the file would tell
    if (all.empty() || (multi && !(whole(all[0]) && all[0] <= most_zones))) return;
    std::size_t const n = multi ? std::size_t(all[0]) : 1;
    c.header = (multi ? 1 : 0) + n * std::size_t(dimensions);
    if (c.header > all.size()) return;
    auto const nodes = take_extents(c, n);
    if (!nodes || !numbers_.line_ends_after(c.header) || (multi && !numbers_.line_ends_after(1))) return;
    try_contents(c, *nodes);
  }

  /// The nodes of all n zones; nothing where the numbers are no extents.
  [[nodiscard]] std::optional<std::uint64_t> take_extents(TextCandidate& c, std::size_t n) const {
    auto const& all = numbers_.all();
    int const dimensions = c.layout.variant.dimensions;
    std::size_t next = c.layout.variant.multi_block ? 1 : 0;
    std::uint64_t nodes = 0;
    for (std::size_t z = 0; z < n; ++z) {
      ZoneData zone;
      std::uint64_t product = 1;
      for (int a = 0; a < dimensions; ++a) {
        auto const extent = whole(all[next++]);
        if (!extent || product > all.size() / std::uint64_t(*extent)) return std::nullopt;
        product *= std::uint64_t(*extent);
        zone.extent[a] = int(*extent);
      }
      nodes += product;
      c.layout.zones.push_back(zone);
    }
    return nodes;
  }

  /// Tries both: with iblank and without.
  void try_contents(TextCandidate& c, std::uint64_t nodes) {
    auto& v = c.layout.variant;
    auto const count = numbers_.all().size();
    for (bool const blank : {false, true}) {
      v.iblank = blank;
      std::uint64_t const wanted = c.header + nodes * std::uint64_t(v.dimensions + (blank ? 1 : 0));
      if (!stated_.allows(v)) continue;
      if (wanted == count) good_.push_back(c);
      if (nearest_.empty())
        nearest_ = "it should have " + std::to_string(wanted) + " numbers as " + to_string(v) + ", but it has " +
                   std::to_string(count);
    }
  }

  TextNumbers const& numbers_;
  Stated const& stated_;
  std::vector<TextCandidate> good_;
  std::string nearest_;  ///< how many numbers the first layout whose header fits has
};

}  // namespace

void Scanner::refuse(std::string_view word) const {
  auto const line = 1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(begin_), '\n');
  throw IoError(path_ + ":" + std::to_string(line) + ": '" + std::string(word.substr(0, 40)) +
                "' is not a number; a formatted PLOT3D file has nothing but numbers: repair it or write it again");
}

bool Scanner::next(Token& token) {
  begin_ = std::min(text_.find_first_not_of(separators, at_), text_.size());
  at_ = std::min(text_.find_first_of(separators, begin_), text_.size());
  if (begin_ == text_.size()) return false;
  token.text = text_.substr(begin_, at_ - begin_);
  token.number = token.text;
  token.repeat = 1;
  if (auto const star = token.text.find('*'); star != std::string_view::npos) {
    auto const [stop, error] = std::from_chars(token.text.data(), token.text.data() + star, token.repeat);
    if (error != std::errc() || stop != token.text.data() + star || token.repeat == 0) refuse(token.text);
    token.number.remove_prefix(star + 1);
  }
  auto const value = to_number(token.number);
  if (!value) refuse(token.text);
  token.value = *value;
  return true;
}

bool looks_like_numbers(std::string_view head) {
  constexpr std::string_view allowed = "0123456789+-.*eEdDqQ \t\r\n,";
  auto const first = head.find_first_not_of(separators);
  return first != std::string_view::npos && head[first] >= '0' && head[first] <= '9' &&
         head.find_first_not_of(allowed) == std::string_view::npos;
}

TextLayout read_text(std::string_view text, std::string const& path, Stated const& stated) {
  TextNumbers const numbers(text, path);
  TextCandidate found = TextTrials(numbers, stated).only(path);
  std::size_t const header = found.header;
  if (numbers.runs_across(header))
    throw IoError(path + ": a repeat count runs from the extents of the zones into the coordinates; write it again");
  TextLayout out;
  out.first_value_at = numbers.end_of(header);
  out.file = std::move(found.layout);
  out.style = numbers.style();
  out.file.variant.double_precision = out.style.significant > 9;
  out.values.assign(numbers.all().begin() + std::ptrdiff_t(header), numbers.all().end());
  return out;
}

std::string replace_coordinates(std::string_view text, std::string const& path, TextLayout const& layout,
                                std::vector<std::vector<double>> const& coordinates) {
  // The new value of each number of the file; iblank marks have none.
  std::vector<double> wanted = layout.values;
  std::size_t at = 0;
  auto const& v = layout.file.variant;
  for (std::size_t z = 0; z < layout.file.zones.size(); ++z) {
    for_each_run(layout.file.zones[z], v, [&](Index in_file, Index in_zone, Index count) {
      std::copy_n(coordinates[z].begin() + in_zone, count, wanted.begin() + std::ptrdiff_t(at) + in_file);
    });
    at += std::size_t(layout.file.zones[z].nodes()) * std::size_t(v.dimensions + (v.iblank ? 1 : 0));
  }

  std::string out(text.substr(0, layout.first_value_at));
  out.reserve(text.size() + text.size() / 16);
  auto const rest = text.substr(layout.first_value_at);
  Scanner scanner(rest, path);
  std::size_t copied = 0, n = 0;
  for (Token token; scanner.next(token); n += token.repeat) {
    out += rest.substr(copied, scanner.begin() - copied);
    copied = scanner.end();
    bool same = true;
    for (std::uint64_t r = 0; r < token.repeat; ++r) same = same && same_bits(wanted[n + r], token.value);
    if (same) {
      out += token.text;
      continue;
    }
    std::string fresh;
    for (std::uint64_t r = 0; r < token.repeat; ++r)
      fresh += (r == 0 ? "" : " ") + write_number(wanted[n + r], layout.style);
    // The same columns: blanks before it where it is shorter, fewer of the blanks before it where it is longer.
    if (fresh.size() < token.text.size()) out.append(token.text.size() - fresh.size(), ' ');
    for (std::size_t longer = fresh.size(); longer > token.text.size() && out.ends_with("  "); --longer) out.pop_back();
    out += fresh;
  }
  out += rest.substr(copied);
  return out;
}

}  // namespace gridmorph::plot3d
