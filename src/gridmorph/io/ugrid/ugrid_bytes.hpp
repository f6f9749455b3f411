// How the numbers of a UGRID file are stored, and the numbers one after another. Internal to io.
#pragma once

#include <gridmorph/core/index.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace gridmorph::ugrid {

struct Storage {
  std::string_view word;  ///< before the ending of a file's name: "b8", "lr4", ...; empty for text
  bool text = false, big = false, records = false;
  int real_bytes = 8, integer_bytes = 4;
};

/// How a file is stored by its name; text where that says nothing else.
Storage storage_of(std::string_view path);

class Bytes {
 public:
  /// Reads the whole file. Throws IoError.
  explicit Bytes(std::string const& path);

  [[nodiscard]] std::string const& text() const { return text_; }
  [[nodiscard]] Storage const& storage() const { return storage_; }
  [[nodiscard]] bool swapped() const;
  [[nodiscard]] std::size_t at() const { return at_; }

  std::int64_t integer(char const* what);
  double real(char const* what);
  /// Throws unless the rest of the file can hold so many numbers of each kind.
  void expect(std::uint64_t integers, std::uint64_t reals) const;
  /// The length before or behind a record, where there are records.
  void mark(std::uint64_t length);
  [[noreturn]] void fail(std::string const& what) const { fail_at(at_, what); }
  [[noreturn]] void fail_at(std::size_t at, std::string const& what) const;

 private:
  template <class T>
  T raw(char const* what);
  std::string_view word(char const* what);

  std::string path_, text_;
  Storage storage_;
  std::size_t at_ = 0;
};

}  // namespace gridmorph::ugrid
