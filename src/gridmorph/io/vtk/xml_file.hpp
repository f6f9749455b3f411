// A file of VTK's XML formats: its tags, and the arrays of numbers between or behind them. Internal to io.
//
// Format: "VTK File Formats" (docs.vtk.org), XML: DataArray as text (ascii), base64 (binary) or behind all tags
// (appended, raw or base64), binary ones with the number of their bytes before them and whole or in blocks packed by
// zlib.
#pragma once

#include <gridmorph/core/index.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::vtk {

// Tags with their places are not a library's: files are copied with a few places changed, so that places are what is
// wanted of them, and VTK's files are no XML where raw bytes follow the tags (AppendedData), which parsers of XML
// refuse.

struct Attribute {
  std::string name, value;
  std::size_t begin = 0, end = 0;  ///< bytes of the value, without its quotes
};

struct Tag {
  std::string name;
  std::vector<Attribute> attributes;
  std::vector<Tag> children;
  std::size_t begin = 0, end = 0;          ///< from its '<' to behind the '>' of its closing tag
  std::size_t inside = 0, inside_end = 0;  ///< between opening and closing tag; the same where there is but one tag
  bool closed = false;                     ///< <name/>

  /// The attribute of that name; nothing where there is none.
  [[nodiscard]] Attribute const* attribute(std::string_view name) const;
  /// The value of the attribute of that name; empty where there is none.
  [[nodiscard]] std::string_view operator[](std::string_view name) const;
  /// The first child of that name; nothing where there is none.
  [[nodiscard]] Tag const* child(std::string_view name) const;
};

/// The outermost tag. What is inside AppendedData is not looked at. Throws IoError with the line.
Tag parse_tags(std::string const& path, std::string_view text);

/// A text as the value of an attribute.
std::string escaped(std::string_view text);

/// "path:line: what" at a byte of a text.
[[noreturn]] void fail_at(std::string const& path, std::string_view text, std::size_t at, std::string const& what);

/// Bytes begin <= b < end of a file become `by`.
struct Edit {
  std::size_t begin = 0, end = 0;
  std::string by;
};

class XmlFile {
 public:
  /// Reads a file whose type is one of those. Throws IoError.
  XmlFile(std::string const& path, std::vector<std::string_view> const& types);

  [[nodiscard]] std::string const& path() const { return path_; }
  [[nodiscard]] Tag const& root() const { return root_; }
  [[nodiscard]] std::string const& text() const { return text_; }
  [[noreturn]] void fail(Tag const& tag, std::string const& what) const { fail_at(path_, text_, tag.begin, what); }

  /// Whether an array holds whole numbers.
  [[nodiscard]] static bool is_integer(Tag const& array);
  /// All values of an array. `n`: how many there have to be, or -1. Throws IoError with the line of the array.
  [[nodiscard]] std::vector<std::int64_t> integers(Tag const& array, Index n = -1) const;
  [[nodiscard]] std::vector<double> reals(Tag const& array, Index n = -1) const;
  /// The coordinates of points that an array holds; throws for an array of whole numbers, which could not hold where
  /// the points go.
  [[nodiscard]] std::vector<double> coordinates(Tag const& array, Index n) const;
  /// The strings of an array of type String: characters, or their codes as words, each string with a zero behind it.
  [[nodiscard]] std::vector<std::string> strings(Tag const& array) const;
  /// A whole number that an attribute gives.
  [[nodiscard]] Index count(Tag const& tag, char const* attribute) const;

  /// What makes an array hold other values, in the way and precision it has; nothing where none changes. Of text the
  /// numbers that change alone, of packed arrays all.
  void replace(Tag const& array, std::span<double const> values, std::vector<Edit>& edits) const;
  /// A new array, stored as `like` is if that is text, else base64 and packed as the file is.
  [[nodiscard]] std::string array_text(std::string const& name, int components, std::span<double const> values,
                                       Tag const& like) const;
  /// The text with edits, in any order; offsets of appended arrays behind what grows go along.
  [[nodiscard]] std::string edited(std::vector<Edit> edits) const;

 private:
  enum class Storage { ascii, binary, appended };
  /// The bytes of an array, in this machine's order, and where they stand.
  struct Bytes {
    std::string bytes;
    std::size_t begin = 0, end = 0;
  };
  [[nodiscard]] Storage storage(Tag const& array) const;
  [[nodiscard]] std::string_view type(Tag const& array) const;
  [[nodiscard]] std::size_t value_bytes(Tag const& array) const;
  [[nodiscard]] Bytes bytes(Tag const& array) const;
  [[nodiscard]] std::string encoded(std::string bytes, std::size_t value_bytes, bool base64) const;
  [[nodiscard]] std::string_view inline_text(Tag const& array) const;
  [[nodiscard]] std::uint64_t head_number(char const* bytes) const;
  void append_head_number(std::uint64_t value, std::string& out) const;
  template <class T>
  [[nodiscard]] std::vector<T> values(Tag const& array, Index n) const;
  template <class T>
  [[nodiscard]] std::vector<T> words(Tag const& array) const;
  void find_appended(Tag const& tag);

  std::string path_, text_;
  Tag root_;
  bool swapped_ = false, packed_ = false, appended_base64_ = false;
  std::size_t head_bytes_ = 4, appended_begin_ = 0, appended_end_ = 0;
  std::vector<Attribute const*> offsets_;  ///< of appended arrays
};

}  // namespace gridmorph::vtk
