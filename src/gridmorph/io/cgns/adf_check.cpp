// The ADF file format: numbers as ASCII hexadecimals, "disk pointers" of a 4096-byte block and an offset into it, and
// every record between two four-letter tags. Layout as documented in the ADF core (ADF_internals.c, ADFI_AAA_var).
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/file_check.hpp>

#include <cgns_io.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace gridmorph::cgns {

namespace {

using Offset = std::uint64_t;

constexpr Offset block_size = 4096;
constexpr Offset file_header_size = 186;
constexpr Offset node_header_size = 246;
constexpr Offset tag_size = 4;
constexpr Offset pointer_size = 12;
constexpr Offset name_size = 32;
constexpr Offset entry_size = name_size + pointer_size;  // of a sub-node table
constexpr int max_dimensions = 12;

class AdfWalk {
 public:
  explicit AdfWalk(std::string const& path)
      : path_(path), file_(path, std::ios::binary), size_(std::filesystem::file_size(path)) {}

  /// Names of the files that its links lead to, as they stand there.
  std::vector<std::string> run() {
    if (size_ < file_header_size) damaged("it ends inside the file header", 0);
    std::string const header = bytes(0, file_header_size);
    for (auto const& [tag, at] :
         {std::pair{"AdF0", 32}, {"AdF1", 64}, {"AdF2", 96}, {"AdF3", 102}, {"AdF4", 130}, {"AdF5", 182}})
      if (header.compare(std::size_t(at), tag_size, tag) != 0)
        damaged(std::string("the header lacks its tag ") + tag, Offset(at));
    // "A02011" and before keep pointers as text, "B02012" and later as binary integers in the byte order of the file.
    text_pointers_ = header[25] != 'B';
    big_endian_ = header[100] == 'B';
    if (std::string_view("BLCN").find(header[100]) == std::string_view::npos)
      damaged("its number format is unknown", 100);

    Offset const end = pointer(header, 146);
    if (end >= size_)
      damaged("it is cut short: " + std::to_string(size_) + " bytes are there, its header promises " +
                  std::to_string(end + 1),
              146);
    std::vector<Offset> to_visit{pointer(header, 134)};
    while (!to_visit.empty()) {
      Offset const node = to_visit.back();
      to_visit.pop_back();
      // Each node header belongs to one parent; meeting one twice would make the library loop.
      if (!visited_.insert(node).second) damaged("a node is listed twice", node);
      visit(node, to_visit);
    }
    return std::move(linked_files_);
  }

 private:
  [[noreturn]] void damaged(std::string const& what, Offset at) const {
    throw IoError(path_ + ": the ADF file is damaged: " + what + " (at byte " + std::to_string(at) +
                  "); get a fresh copy of the file");
  }

  std::string bytes(Offset at, Offset n) {
    if (at > size_ || n > size_ - at) damaged("a pointer leads outside the file", at);
    std::string out(n, '\0');
    file_.clear();
    file_.seekg(std::streamoff(at));
    if (!file_.read(out.data(), std::streamsize(n))) damaged("it cannot be read", at);
    return out;
  }

  Offset hexadecimal(std::string const& record, std::size_t at, std::size_t digits) const {
    Offset value = 0;
    for (std::size_t d = at; d < at + digits; ++d) {
      char const c = record[d];
      int const digit = c >= '0' && c <= '9'   ? c - '0'
                        : c >= 'A' && c <= 'F' ? c - 'A' + 10
                        : c >= 'a' && c <= 'f' ? c - 'a' + 10
                                               : -1;
      if (digit < 0) damaged("a number in a header is not one", d);
      value = 16 * value + Offset(digit);
    }
    return value;
  }

  Offset binary(std::string const& record, std::size_t at, std::size_t n) const {
    Offset value = 0;
    for (std::size_t b = 0; b < n; ++b)
      value = 256 * value + static_cast<unsigned char>(record[big_endian_ ? at + b : at + n - 1 - b]);
    return value;
  }

  Offset pointer(std::string const& record, std::size_t at) const {
    Offset const block = text_pointers_ ? hexadecimal(record, at, 8) : binary(record, at, 8);
    Offset const offset = text_pointers_ ? hexadecimal(record, at + 8, 4) : binary(record, at + 8, 4);
    if (block > size_ / block_size || offset > block_size) damaged("a pointer leads outside the file", at);
    return block * block_size + offset;
  }

  void expect_tag(Offset at, std::string_view tag) {
    if (bytes(at, tag_size) != tag) damaged("the tag " + std::string(tag) + " is missing", at);
  }

  /// Length of a record's payload between its start tag with end pointer and its end tag.
  Offset payload(Offset at, std::string_view start_tag, std::string_view end_tag) {
    expect_tag(at, start_tag);
    Offset const end = pointer(bytes(at + tag_size, pointer_size), 0);
    Offset const begin = at + tag_size + pointer_size;
    if (end < begin) damaged("a record ends before it begins", at);
    expect_tag(end, end_tag);
    return end - begin;
  }

  void visit(Offset at, std::vector<Offset>& to_visit) {
    std::string const header = bytes(at, node_header_size);
    if (header.compare(0, tag_size, "NoDe") != 0 || header.compare(242, tag_size, "TaiL") != 0)
      damaged("a node header lacks its tags", at);

    Offset const children = hexadecimal(header, 68, 8);
    Offset const entries = hexadecimal(header, 76, 8);
    if (children > entries) damaged("a node has more children than its table holds", at);
    if (children > 0) {
      Offset const table = pointer(header, 84);
      Offset const length = payload(table, "SNTb", "snTE");
      if (length / entry_size < entries) damaged("a table of children is too short", table);
      std::string const list = bytes(table + tag_size + pointer_size, children * entry_size);
      for (Offset c = 0; c < children; ++c) to_visit.push_back(pointer(list, c * entry_size + name_size));
    }
    check_data(header, at);
  }

  void check_data(std::string const& header, Offset at) {
    Offset const rank = hexadecimal(header, 128, 2);
    if (rank > max_dimensions) damaged("an array has more than 12 dimensions", at);
    auto const element = element_size(std::string_view(header).substr(96, name_size));
    Offset needed = element.value_or(0);
    for (Offset d = 0; d < rank; ++d) {
      Offset const n = text_pointers_ ? hexadecimal(header, 130 + 8 * d, 8) : binary(header, 130 + 8 * d, 8);
      if (n != 0 && needed > size_ / n) damaged("an array is larger than the file", at);
      needed *= n;
    }
    Offset const chunks = hexadecimal(header, 226, 4);
    if (chunks == 0) return;
    Offset const first = pointer(header, 230);
    if (!data_.insert(first).second) damaged("two nodes have the same data", at);
    Offset held = 0;
    if (chunks == 1) {
      held = payload(first, "DaTa", "dEnD");
    } else {
      if (payload(first, "DCtb", "dcTE") / (2 * pointer_size) < chunks) damaged("a table of data is too short", first);
      std::string const table = bytes(first + tag_size + pointer_size, chunks * 2 * pointer_size);
      for (Offset c = 0; c < chunks; ++c) held += payload(pointer(table, c * 2 * pointer_size), "DaTa", "dEnD");
    }
    if (rank > 0 && held < needed) damaged("an array is longer than the data it has", at);
    if (header.compare(96, 2, "LK") == 0) check_link(first, chunks, needed, at);
  }

  /// "file>path" or ">path"; the library has buffers of fixed size for both.
  void check_link(Offset data, Offset chunks, Offset length, Offset at) {
    constexpr Offset longest_file = 1024, longest_path = 4096;
    if (chunks != 1 || length > longest_file + longest_path) damaged("a link is too long", at);
    std::string const text = bytes(data + tag_size + pointer_size, length);
    auto const separator = text.find('>');
    if (separator == std::string::npos || separator > longest_file || text.size() - separator > longest_path)
      damaged("a link has no file and path of allowed lengths", at);
    if (separator > 0) linked_files_.push_back(text.substr(0, separator));
  }

  /// Bytes per element on disk; nothing for compound types, and for long integers, whose size depends on the writer.
  static std::optional<Offset> element_size(std::string_view type) {
    type = type.substr(0, type.find_first_of(std::string_view(" \0", 2)));
    if (type == "C1" || type == "B1" || type == "U1" || type == "LK") return 1;
    if (type == "I4" || type == "U4" || type == "R4") return 4;
    if (type == "R8") return 8;
    return std::nullopt;
  }

  std::string path_;
  std::ifstream file_;
  Offset size_;
  bool text_pointers_ = true;
  bool big_endian_ = false;
  std::unordered_set<Offset> visited_;
  std::unordered_set<Offset> data_;
  std::vector<std::string> linked_files_;
};

}  // namespace

void check_adf(std::string const& path) {
  std::set<std::string> known{path};
  std::vector<std::string> to_check{path};
  while (!to_check.empty()) {
    std::string const file = to_check.back();
    to_check.pop_back();
    for (auto const& name : AdfWalk(file).run()) {
      std::array<char, CGIO_MAX_FILE_LENGTH + 1> found{};
      bool const there =
          cgio_find_file(file.c_str(), name.c_str(), CGIO_FILE_NONE, int(found.size()), found.data()) == CGIO_ERR_NONE;
      if (there && known.insert(found.data()).second) to_check.emplace_back(found.data());
    }
  }
}

}  // namespace gridmorph::cgns
