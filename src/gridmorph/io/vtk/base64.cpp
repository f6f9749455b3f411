#include <gridmorph/io/blanks.hpp>
#include <gridmorph/io/vtk/base64.hpp>

#include <algorithm>
#include <array>
#include <cstdint>

namespace gridmorph::vtk {

namespace {

constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::array<std::int8_t, 256> values() {
  std::array<std::int8_t, 256> out{};
  out.fill(-1);
  for (std::size_t n = 0; n < alphabet.size(); ++n) out[static_cast<unsigned char>(alphabet[n])] = std::int8_t(n);
  return out;
}

}  // namespace

std::string to_base64(std::string_view bytes) {
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t n = 0; n < bytes.size(); n += 3) {
    std::size_t const left = std::min<std::size_t>(3, bytes.size() - n);
    std::uint32_t group = 0;
    for (std::size_t b = 0; b < 3; ++b) group = group << 8 | (b < left ? static_cast<unsigned char>(bytes[n + b]) : 0U);
    for (std::size_t c = 0; c < 4; ++c) out += c <= left ? alphabet[group >> (18 - 6 * c) & 63] : '=';
  }
  return out;
}

std::optional<std::string> Base64Reader::read(std::size_t n) {
  static std::array<std::int8_t, 256> const value = values();
  if (n / 3 > (text_.size() - at_) / 4 + 1) return std::nullopt;
  std::string out = rest_.substr(0, n);
  rest_.erase(0, out.size());
  out.reserve(n);
  while (out.size() < n) {
    std::uint32_t group = 0;
    int characters = 0, padding = 0;
    while (characters + padding < 4) {
      while (at_ < text_.size() && io::is_blank(text_[at_])) ++at_;
      if (at_ >= text_.size()) return std::nullopt;
      char const c = text_[at_++];
      int const v = value[static_cast<unsigned char>(c)];
      if (c == '=' && characters >= 2)
        ++padding;
      else if (v < 0 || padding > 0)
        return std::nullopt;
      else
        ++characters;
      group = group << 6 | std::uint32_t(v < 0 ? 0 : v);
    }
    for (int b = 0; b < 3 - padding; ++b) {
      char const byte = char(group >> (16 - 8 * b) & 255);
      (out.size() < n ? out : rest_) += byte;
    }
  }
  return out;
}

}  // namespace gridmorph::vtk
