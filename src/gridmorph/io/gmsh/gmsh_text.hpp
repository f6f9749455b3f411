// The bytes of a Gmsh file (MSH): words of text, or numbers as they are in memory. Internal to io.
#pragma once

#include <gridmorph/core/index.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace gridmorph::gmsh {

/// The format of a file, as $MeshFormat says it.
struct Format {
  int version = 0;  ///< 22, 40, 41
  bool binary = false;
  bool swapped = false;  ///< binary numbers are of the other byte order
};

/// Reads one after another. Everything throws IoError with the line (text) or the byte (binary files) where it is not
/// what it has to be.
class Text {
 public:
  /// Reads the whole file and its $MeshFormat.
  explicit Text(std::string const& path);

  [[nodiscard]] Format const& format() const { return format_; }
  [[nodiscard]] std::string const& bytes() const { return text_; }
  [[nodiscard]] std::string const& path() const { return path_; }
  [[nodiscard]] std::size_t at() const { return at_; }

  /// Name of the section that begins next ("Nodes" of $Nodes), what follows it being next; empty at the end of the
  /// file.
  std::string section();
  /// Goes past $End and the name, which have to be next.
  void end_section(std::string const& name);
  /// Goes past a section without a look at what is in it.
  void skip_section(std::string const& name);

  // Words, in text and binary files alike.
  std::string_view word(char const* what);
  std::int64_t integer_word(char const* what);
  /// A string in quotes.
  std::string quoted(char const* what);
  /// Whether this word is next; it is passed then.
  bool passes(std::string_view word);

  // Words in text files, raw numbers in binary ones: int, size_t, double.
  std::int64_t number32(char const* what) { return format_.binary ? raw<std::int32_t>(what) : integer_word(what); }
  std::int64_t number64(char const* what) { return format_.binary ? raw<std::int64_t>(what) : integer_word(what); }
  double real(char const* what);
  /// Goes past a number of any value, faster than real().
  void skip_real(char const* what);

  /// A count of things that take so many bytes each at least, which the rest of the file has to hold. `wide`: a size_t
  /// of binary files.
  Index count(char const* what, std::size_t least_bytes, bool wide);
  /// A count like count()'s that stands as a word in binary files too.
  Index count_word(char const* what, std::size_t least_bytes) { return checked(integer_word(what), what, least_bytes); }
  /// Goes to where the raw numbers of a binary file begin: behind the line of the words before them.
  void begin_raw();

  [[noreturn]] void fail(std::string const& what) const { fail_at(at_, what); }
  [[noreturn]] void fail_at(std::size_t at, std::string const& what) const;

 private:
  template <class T>
  T raw(char const* what) {
    if (text_.size() - at_ < sizeof(T)) ends(what);
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), text_.data() + at_, sizeof(T));
    if (format_.swapped)
      for (std::size_t b = 0; b < sizeof(T) / 2; ++b) std::swap(bytes[b], bytes[sizeof(T) - 1 - b]);
    at_ += sizeof(T);
    return std::bit_cast<T>(bytes);
  }
  [[noreturn]] void ends(char const* what) const;
  Index checked(std::int64_t n, char const* what, std::size_t least_bytes) const;
  void skip_blanks();
  void read_format();

  std::string path_, text_;
  Format format_;
  std::size_t at_ = 0;
};

}  // namespace gridmorph::gmsh
