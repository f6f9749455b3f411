// What a Gmsh file (MSH 2.2, 4.0, 4.1) holds, as it stands there. Internal to io.
//
// Format: Gmsh reference manual, "MSH file format" (4.1) and "MSH file format version 2 (Legacy)".
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/core/index.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gridmorph::gmsh {

/// The format of a file, as $MeshFormat says it.
struct Format {
  int version = 0;  ///< 22, 40, 41
  bool binary = false;
  bool swapped = false;  ///< binary numbers are of the other byte order
};

/// The bytes of a file: words of text, or numbers as they are in memory. Reads one after another. Everything throws
/// IoError with the line (text) or the byte (binary files) where it is not what it has to be.
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

/// Elements that lie on one piece of geometry and belong to the same physical groups.
struct Group {
  int dimension = 0;
  std::int64_t entity = 0;
  std::vector<std::int64_t> physical;  ///< ascending, each once, positive
  bool between_parts = false;          ///< of a mesh in parts: faces that two of them share, no boundary
};

/// Nodes of one piece of geometry and those they repeat.
struct PeriodicLink {
  int dimension = 0;
  std::int64_t entity = 0, master = 0;
  std::optional<std::array<double, 16>> affine;  ///< rows; masters onto their images
  std::vector<std::array<Index32, 2>> nodes;     ///< image, master; places in File::tag
};

struct File {
  // Nodes in the order of the file.
  std::vector<std::int64_t> tag;
  std::vector<double> coordinates;  ///< three each
  std::vector<std::size_t> at;      ///< byte at which the three begin
  bool parametric = false;          ///< nodes have parameters on the geometry, too

  // Elements in the order of the file; nodes are places in `tag`.
  std::vector<std::uint8_t> type;  ///< Gmsh's number
  std::vector<std::int64_t> number;
  std::vector<Index32> group;
  CsrGraph nodes;
  std::vector<Group> groups;
  bool repeats_elements = false;  ///< an element is there once for each of its physical groups (2.2)

  std::map<std::pair<int, std::int64_t>, std::string> names;  ///< of physical groups, by dimension and number
  std::vector<PeriodicLink> periodic;
  std::vector<std::string> passed_over;  ///< sections without a part in morphing
};

/// Everything from behind $MeshFormat to the end. Throws IoError.
File parse(Text& text);

}  // namespace gridmorph::gmsh
