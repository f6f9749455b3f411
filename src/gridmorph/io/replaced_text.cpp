#include <gridmorph/io/blanks.hpp>
#include <gridmorph/io/replaced_text.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <utility>

namespace gridmorph::io {

namespace {

bool ends_word(char c) { return is_blank(c) || c == '<'; }

}  // namespace

ReplacedText::ReplacedText(std::string_view text) : text_(text) { out_.reserve(text.size() + text.size() / 8); }

void ReplacedText::replace(std::size_t begin, std::size_t end, std::string_view by) {
  out_.append(text_, copied_, begin - copied_);
  out_.append(by);
  copied_ = end;
}

std::size_t ReplacedText::replace_word(std::size_t at, double from, double to) {
  while (at < text_.size() && is_blank(text_[at])) ++at;
  std::size_t end = at;
  while (end < text_.size() && !ends_word(text_[end])) ++end;
  if (std::bit_cast<std::uint64_t>(from) == std::bit_cast<std::uint64_t>(to)) return end;
  std::array<char, 32> digits{};
  auto const last = std::to_chars(digits.data(), digits.data() + digits.size(), to).ptr;
  replace(at, end, {digits.data(), std::size_t(last - digits.data())});
  return end;
}

template <class T>
void ReplacedText::raw(std::size_t at, T to, bool swapped) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(to);
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  replace(at, at + bytes.size(), {bytes.data(), bytes.size()});
}

void ReplacedText::replace_raw(std::size_t at, double to, bool swapped) { raw(at, to, swapped); }
void ReplacedText::replace_raw(std::size_t at, float to, bool swapped) { raw(at, to, swapped); }

std::string ReplacedText::take() {
  out_.append(text_, copied_);
  copied_ = text_.size();
  return std::move(out_);
}

}  // namespace gridmorph::io
