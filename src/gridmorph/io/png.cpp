#include <gridmorph/io/png.hpp>
#include <gridmorph/io/vtk/base64.hpp>
#include <gridmorph/io/zlib_blocks.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace gridmorph::io {

namespace {

/// The CRC-32 of the standard's annex D.
std::uint32_t png_checksum(std::string_view bytes) {
  static std::array<std::uint32_t, 256> const table = [] {
    std::array<std::uint32_t, 256> out{};
    for (std::uint32_t n = 0; n < 256; ++n) {
      std::uint32_t c = n;
      for (int k = 0; k < 8; ++k) c = (c & 1U) != 0 ? 0xEDB88320U ^ (c >> 1U) : c >> 1U;
      out[n] = c;
    }
    return out;
  }();
  std::uint32_t c = 0xFFFFFFFFU;
  for (char const b : bytes) c = table[(c ^ std::uint8_t(b)) & 0xFFU] ^ (c >> 8U);
  return ~c;
}

void append_big_endian(std::string& out, std::uint32_t value) {
  for (unsigned shift : {24U, 16U, 8U, 0U}) out += char(value >> shift & 0xFFU);
}

void append_chunk(std::string& out, char const* name, std::string_view data) {
  append_big_endian(out, std::uint32_t(data.size()));
  std::size_t const at = out.size();
  out.append(name, 4);
  out += data;
  append_big_endian(out, png_checksum(std::string_view(out).substr(at)));
}

/// How far bytes are from zero, of differences: what packs best is smallest (the standard's advice for colours).
long distance_from_zero(std::uint8_t const* bytes, std::size_t n) {
  constexpr std::size_t few = 1024;  // whose sum the compiler keeps in 32 bits, several at a time
  long sum = 0;
  for (std::size_t begin = 0; begin < n; begin += few) {
    std::uint32_t part = 0;
    for (std::size_t k = begin; k < std::min(n, begin + few); ++k) {
      int const v = std::int8_t(bytes[k]);
      part += std::uint32_t(v < 0 ? -v : v);
    }
    sum += part;
  }
  return sum;
}

/// Rows as they are packed: each as it stands, less its left or less its upper neighbours, whichever differences are
/// smallest; palettes go as they stand.
std::string filtered_rows(std::vector<std::uint8_t> const& pixels, std::size_t row, std::size_t pixel, bool plain) {
  std::size_t const rows = pixels.size() / row;
  std::string out(rows * (row + 1), '\0');
  std::vector<std::uint8_t> less_left(row), less_up(row);
  std::vector<std::uint8_t> const nothing(row, 0);
  for (std::size_t r = 0; r < rows; ++r) {
    std::uint8_t const* const here = pixels.data() + r * row;
    std::uint8_t const* best = here;
    char filter = 0;
    if (!plain) {
      std::uint8_t const* const up = r > 0 ? here - row : nothing.data();
      std::copy_n(here, pixel, less_left.data());
      for (std::size_t n = pixel; n < row; ++n) less_left[n] = std::uint8_t(here[n] - here[n - pixel]);
      for (std::size_t n = 0; n < row; ++n) less_up[n] = std::uint8_t(here[n] - up[n]);
      long least = distance_from_zero(here, row);
      for (auto const& [tried, number] : {std::pair(less_left.data(), char(1)), std::pair(less_up.data(), char(2))})
        if (long const sum = distance_from_zero(tried, row); sum < least) {
          least = sum;
          best = tried;
          filter = number;
        }
    }
    char* const to = out.data() + r * (row + 1);
    to[0] = filter;
    std::memcpy(to + 1, best, row);
  }
  return out;
}

/// Numbers of colours, and these; nothing where there are more than a palette holds.
bool make_palette(Picture const& picture, std::vector<std::uint8_t>& number, std::vector<std::uint32_t>& colours) {
  std::unordered_map<std::uint32_t, std::uint8_t> known;
  std::size_t const n = picture.rgba.size() / 4;
  number.resize(n);
  std::uint32_t last = 0;
  for (std::size_t p = 0; p < n; ++p) {
    std::uint32_t colour = 0;
    if (picture.rgba[4 * p + 3] != 0) std::memcpy(&colour, picture.rgba.data() + 4 * p, 4);
    if (p > 0 && colour == last) {  // most pixels are like the one before
      number[p] = number[p - 1];
      continue;
    }
    last = colour;
    auto const [at, added] = known.emplace(colour, std::uint8_t(colours.size()));
    if (added) {
      if (colours.size() == 256) return false;
      colours.push_back(colour);
    }
    number[p] = at->second;
  }
  return true;
}

}  // namespace

std::string png_bytes(Picture const& picture) {
  std::string out("\x89PNG\r\n\x1a\n", 8);
  std::vector<std::uint8_t> number;
  std::vector<std::uint32_t> colours;
  bool const palette = make_palette(picture, number, colours);
  std::string head;
  append_big_endian(head, std::uint32_t(picture.width));
  append_big_endian(head, std::uint32_t(picture.height));
  head += {char(8), char(palette ? 3 : 6), 0, 0, 0};
  append_chunk(out, "IHDR", head);
  if (palette) {
    std::string rgb, opacity;
    for (std::uint32_t const colour : colours) {
      std::array<char, 4> c{};
      std::memcpy(c.data(), &colour, 4);
      rgb.append(c.data(), 3);
      opacity += c[3];
    }
    append_chunk(out, "PLTE", rgb);
    append_chunk(out, "tRNS", opacity);
  }
  auto const width = std::size_t(picture.width);
  std::string const rows =
      palette ? filtered_rows(number, width, 1, true) : filtered_rows(picture.rgba, 4 * width, 4, false);
  append_chunk(out, "IDAT", zlib_stream(rows));
  append_chunk(out, "IEND", {});
  return out;
}

std::string png_data_uri(Picture const& picture) {
  return "data:image/png;base64," + vtk::to_base64(png_bytes(picture));
}

}  // namespace gridmorph::io
