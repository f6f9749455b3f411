// A copy of a file's bytes with other numbers in it. Internal to io.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace gridmorph::io {

/// Numbers are replaced in ascending order of their places.
class ReplacedText {
 public:
  explicit ReplacedText(std::string_view text);

  /// Bytes begin <= b < end become `by`.
  void replace(std::size_t begin, std::size_t end, std::string_view by);
  /// The word (up to a blank, or the tag of an XML file) that begins at or behind `at`, which reads as `from`: text
  /// that reads back to the bits of `to`, or as it stands where that is `from` bit by bit. Returns where the word
  /// ended.
  std::size_t replace_word(std::size_t at, double from, double to);
  /// The bytes of a number in memory; `swapped`: in the other byte order.
  void replace_raw(std::size_t at, double to, bool swapped);
  void replace_raw(std::size_t at, float to, bool swapped);

  /// Takes the whole text out; the object is of no use after that.
  std::string take();

 private:
  template <class T>
  void raw(std::size_t at, T to, bool swapped);

  std::string_view text_;
  std::string out_;
  std::size_t copied_ = 0;
};

}  // namespace gridmorph::io
