// Plain structures as bytes: every number little-endian, one after another without gaps; lists with their count first.
//
// A structure says once what its fields are (Fields); writing, reading and measuring go through the same list. It is
// taken apart by structured bindings, so a field that is added and not listed does not compile.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace gridmorph::detail {

/// visit(whole, each) calls each(field, field, ...) in the order of the file.
template <class T>
struct Fields;

#define GRIDMORPH_DETAIL_FIELDS(Type, ...)          \
  template <>                                       \
  struct Fields<Type> {                             \
    template <class T, class Each>                  \
    static void visit(T& whole, Each const& each) { \
      auto& [__VA_ARGS__] = whole;                  \
      each(__VA_ARGS__);                            \
    }                                               \
  };

template <class T>
concept Arithmetic = std::is_arithmetic_v<T> || std::is_enum_v<T>;

template <class T>
struct IsList : std::false_type {};
template <class T>
struct IsList<std::vector<T>> : std::true_type {};
template <>
struct IsList<std::string> : std::true_type {};

/// Hands a value to an archive, piece by piece.
template <class Archive, class T>
void pass(Archive& archive, T& value) {
  using Plain = std::remove_const_t<T>;
  if constexpr (Arithmetic<Plain>) {
    archive.number(value);
  } else if constexpr (std::is_array_v<Plain> || requires { std::tuple_size<Plain>::value; }) {
    for (auto& element : value) pass(archive, element);
  } else if constexpr (IsList<Plain>::value) {
    archive.list(value);
  } else {
    Fields<Plain>::visit(value, [&](auto&... field) { (pass(archive, field), ...); });
  }
}

/// The unsigned integer that has the bits of a number.
template <class T>
using Bits =
    std::conditional_t<sizeof(T) == 1, std::uint8_t, std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>;

class ByteWriter {
 public:
  template <Arithmetic T>
  void number(T const& value) {
    auto const bits = std::bit_cast<Bits<T>>(value);
    std::byte little_endian[sizeof bits];
    for (std::size_t b = 0; b < sizeof bits; ++b) little_endian[b] = std::byte(bits >> (8 * b));
    raw(little_endian);
  }
  template <class List>
  void list(List const& values) {
    number(std::uint64_t(values.size()));
    if constexpr (Arithmetic<typename List::value_type> && std::endian::native == std::endian::little) {
      raw(std::as_bytes(std::span(values.data(), values.size())));
    } else {
      for (auto const& value : values) pass(*this, value);
    }
  }
  void raw(std::span<std::byte const> bytes) {
    if (bytes.empty()) return;
    std::size_t const at = bytes_.size();
    bytes_.resize(at + bytes.size());
    std::memcpy(bytes_.data() + at, bytes.data(), bytes.size());
  }
  [[nodiscard]] std::vector<std::byte> const& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// Bytes that a value takes at least: all its lists empty.
class LeastSize {
 public:
  template <Arithmetic T>
  void number(T const&) {
    n_ += sizeof(T);
  }
  template <class List>
  void list(List const&) {
    n_ += sizeof(std::uint64_t);
  }
  template <class T>
  static std::size_t of() {
    LeastSize size;
    T const empty{};
    pass(size, empty);
    return size.n_;
  }

 private:
  std::size_t n_ = 0;
};

/// The bytes do not hold what is asked of them.
class Damaged : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws Damaged where bytes end early. Allocates no more than a few times the bytes there are, whatever they say.
class ByteReader {
 public:
  explicit ByteReader(std::span<std::byte const> bytes) : bytes_(bytes) {}

  template <Arithmetic T>
  void number(T& value) {
    if (bytes_.size() < sizeof(T)) throw Damaged("it ends too early");
    Bits<T> bits = 0;
    for (std::size_t b = 0; b < sizeof(T); ++b) bits |= Bits<T>(Bits<T>(bytes_[b]) << (8 * b));
    bytes_ = bytes_.subspan(sizeof(T));
    if constexpr (std::is_same_v<T, bool>)
      value = bits != 0;
    else
      value = std::bit_cast<T>(bits);
  }
  template <class List>
  void list(List& values) {
    using T = typename List::value_type;
    std::uint64_t count = 0;
    number(count);
    if (count > bytes_.size() / LeastSize::of<T>())
      throw Damaged("a table of " + std::to_string(count) + " entries is larger than the file");
    values.resize(count);
    if constexpr (Arithmetic<T> && std::endian::native == std::endian::little) {
      if (count > 0) std::memcpy(values.data(), bytes_.data(), count * sizeof(T));
      bytes_ = bytes_.subspan(count * sizeof(T));
    } else {
      for (T& value : values) pass(*this, value);
    }
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

 private:
  std::span<std::byte const> bytes_;
};

}  // namespace gridmorph::detail
