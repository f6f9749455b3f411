#include <gridmorph/core/error.hpp>
#include <gridmorph/io/blanks.hpp>
#include <gridmorph/io/printable.hpp>
#include <gridmorph/io/read_file.hpp>
#include <gridmorph/io/real_text.hpp>
#include <gridmorph/io/ugrid/ugrid_bytes.hpp>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>

namespace gridmorph::ugrid {

namespace {

constexpr std::array<Storage, 10> storages{{{"b8", false, true, false, 8, 4},
                                            {"b4", false, true, false, 4, 4},
                                            {"lb8", false, false, false, 8, 4},
                                            {"lb4", false, false, false, 4, 4},
                                            {"r8", false, true, true, 8, 4},
                                            {"r4", false, true, true, 4, 4},
                                            {"lr8", false, false, true, 8, 4},
                                            {"lr4", false, false, true, 4, 4},
                                            {"b8l", false, true, false, 8, 8},
                                            {"lb8l", false, false, false, 8, 8}}};

}  // namespace

Storage storage_of(std::string_view path) {
  auto const stem = path.substr(0, path.rfind('.'));
  auto const dot = stem.find_last_of("./");
  auto const word = dot == std::string_view::npos || stem[dot] == '/' ? std::string_view() : stem.substr(dot + 1);
  auto const found = std::find_if(storages.begin(), storages.end(), [&](Storage const& s) { return s.word == word; });
  return found == storages.end() ? Storage{{}, true, false, false, 8, 4} : *found;
}

Bytes::Bytes(std::string const& path) : path_(path), text_(io::read_file(path)), storage_(storage_of(path)) {}

bool Bytes::swapped() const { return storage_.big != (std::endian::native == std::endian::big); }

void Bytes::fail_at(std::size_t at, std::string const& what) const {
  at = std::min(at, text_.size());
  std::string const place =
      storage_.text ? ":" + std::to_string(1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(at), '\n'))
                    : ", byte " + std::to_string(at);
  throw IoError(path_ + place + ": " + what);
}

template <class T>
T Bytes::raw(char const* what) {
  if (text_.size() - at_ < sizeof(T))
    fail("the file ends where " + std::string(what) + " has to follow; get a whole copy of it");
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), text_.data() + at_, sizeof(T));
  if (swapped()) std::reverse(bytes.begin(), bytes.end());
  at_ += sizeof(T);
  return std::bit_cast<T>(bytes);
}

std::string_view Bytes::word(char const* what) {
  while (at_ < text_.size() && io::is_blank(text_[at_])) ++at_;
  std::size_t const begin = at_;
  while (at_ < text_.size() && !io::is_blank(text_[at_])) ++at_;
  if (begin == at_) fail("the file ends where " + std::string(what) + " has to follow; get a whole copy of it");
  return std::string_view(text_).substr(begin, at_ - begin);
}

std::int64_t Bytes::integer(char const* what) {
  if (!storage_.text) return storage_.integer_bytes == 8 ? raw<std::int64_t>(what) : raw<std::int32_t>(what);
  auto const found = word(what);
  std::int64_t value = 0;
  auto const [end, failure] = std::from_chars(found.data(), found.data() + found.size(), value);
  if (failure != std::errc() || end != found.data() + found.size())
    fail_at(at_ - found.size(), "expected " + std::string(what) + ", found '" + io::printable(found) +
                                    "'; binary files say so in their name (mesh.b8.ugrid, mesh.lb8.ugrid, ...)");
  return value;
}

double Bytes::real(char const* what) {
  if (!storage_.text) return storage_.real_bytes == 8 ? raw<double>(what) : double(raw<float>(what));
  auto const found = word(what);
  auto const value = io::real_of(found);
  if (!value) fail_at(at_ - found.size(), "expected " + std::string(what) + ", found '" + io::printable(found) + "'");
  return *value;
}

void Bytes::expect(std::uint64_t integers, std::uint64_t reals) const {
  std::uint64_t const per_integer = storage_.text ? 2 : std::uint64_t(storage_.integer_bytes),
                      per_real = storage_.text ? 2 : std::uint64_t(storage_.real_bytes);
  std::uint64_t const left = text_.size() - at_ + (storage_.text ? 1 : 0);
  if (integers > left / per_integer || reals > left / per_real || integers * per_integer + reals * per_real > left)
    fail("the counts at the beginning ask for " + std::to_string(integers) + " whole numbers and " +
         std::to_string(reals) +
         " coordinates, more than the rest of the file holds; get a whole copy of it, or name it as it is stored (b8, "
         "lb8, r8, lr8, b4, ... before .ugrid)");
}

void Bytes::mark(std::uint64_t length) {
  if (!storage_.records) return;
  // Markers have 4 bytes, which records of 4 GB and more go beyond.
  auto const found = raw<std::uint32_t>("the length of a record");
  if (found != std::uint32_t(length))
    fail("a record of " + std::to_string(length) + " bytes is marked with " + std::to_string(found) +
         "; the file is damaged, or stored in another way than its name says");
}

}  // namespace gridmorph::ugrid
