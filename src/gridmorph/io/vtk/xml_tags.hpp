// The tags of an XML file with their places in it. Internal to io.
//
// Not a library's: files are copied with a few places changed, so that places are what is wanted of them, and VTK's
// files are no XML where raw bytes follow the tags (AppendedData), which parsers of XML refuse.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::vtk {

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

}  // namespace gridmorph::vtk
