// Formatted PLOT3D files: numbers as text, as Fortran and other programs write them.
#pragma once

#include <gridmorph/io/plot3d/plot3d_layout.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::plot3d {

/// One number of a text, or the same number several times ("3*0.5").
struct Token {
  double value = 0;
  std::uint64_t repeat = 1;
  std::string_view text;    ///< as it stands, with the repeat count
  std::string_view number;  ///< without it
};

/// Takes the next number off the front of a text; false at its end. Blanks, line ends and commas separate. Understands
/// D exponents, exponents without a letter (1.0-101) and repeat counts. Throws IoError, naming the line, on anything
/// else.
class Scanner {
 public:
  Scanner(std::string_view text, std::string const& path) : text_(text), path_(path) {}
  bool next(Token& token);
  /// Where the token just taken begins in the text.
  [[nodiscard]] std::size_t begin() const { return begin_; }
  [[nodiscard]] std::size_t end() const { return at_; }

 private:
  [[noreturn]] void refuse(std::string_view word) const;

  std::string_view text_;
  std::string const& path_;
  std::size_t begin_ = 0, at_ = 0;
};

/// How the numbers of a file are written, so that new ones look like them.
struct NumberStyle {
  enum class Kind { fixed, scientific } kind = Kind::scientific;
  int digits = 17;       ///< fixed: after the point; scientific: significant
  bool capital = false;  ///< E
  int significant = 0;   ///< most digits of any number
};

struct TextLayout {
  FileLayout file;
  std::vector<double> values;      ///< all numbers after the extents, in the order of the file
  std::size_t first_value_at = 0;  ///< bytes before them
  NumberStyle style;
};

/// Whether the beginning of a file can be one of numbers as text.
bool looks_like_numbers(std::string_view head);

/// Reads a whole formatted file. Throws IoError as detect_binary does. Memory: the text and 8 bytes per number.
TextLayout read_text(std::string_view text, std::string const& path, Stated const& stated);

/// The text with other coordinates: numbers that are the same keep their text, others are written in the style of the
/// file and, where there is room, in the columns of those they replace. coordinates[z] are the values of zone z,
/// component after component.
std::string replace_coordinates(std::string_view text, std::string const& path, TextLayout const& layout,
                                std::vector<std::vector<double>> const& coordinates);

}  // namespace gridmorph::plot3d
