// Bytes as text (RFC 4648), as VTK's XML files have them. Internal to io.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace gridmorph::vtk {

std::string to_base64(std::string_view bytes);

/// Reads bytes out of a text, four characters at a time; blanks are passed over. A group that ends in '=' ends a piece,
/// and another may follow: heads of arrays are written apart or not.
class Base64Reader {
 public:
  /// Reads from byte `at` of a text on.
  Base64Reader(std::string_view text, std::size_t at) : text_(text), at_(at) {}

  /// The next n bytes; nothing where the text ends before, or goes on as something else.
  std::optional<std::string> read(std::size_t n);
  /// The place behind the last character that was looked at.
  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  std::string_view text_;
  std::size_t at_;
  std::string rest_;  ///< of the last group
};

}  // namespace gridmorph::vtk
