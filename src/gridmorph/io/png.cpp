#include <gridmorph/io/png.hpp>
#include <gridmorph/io/vtk/base64.hpp>
#include <gridmorph/io/zlib_blocks.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <unordered_map>

namespace gridmorph::io {

namespace {

/// CRC-32 of the standard's annex D.
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

/// Rows as they are packed: each as it stands, less its left or less its upper neighbours, whichever differences are smallest (the standard's
/// advice for colours; palettes go as they stand).
std::string filtered_rows(std::vector<std::uint8_t> const& pixels, std::size_t row, std::size_t pixel, bool plain) {
  std::string out;
  out.reserve(pixels.size() + pixels.size() / row);
  // A row and the one above it, after a pixel of zeros.
  std::vector<std::uint8_t> now(pixel + row, 0), above(pixel + row, 0);
  std::array<std::vector<std::uint8_t>, 3> tried;
  for (auto& t : tried) t.resize(row);
  for (std::size_t begin = 0; begin < pixels.size(); begin += row) {
    std::copy_n(pixels.begin() + std::ptrdiff_t(begin), row, now.begin() + std::ptrdiff_t(pixel));
    std::uint8_t const *const here = now.data() + pixel, *const left = now.data(), *const up = above.data() + pixel;
    for (std::size_t n = 0; n < row; ++n) {
      tried[0][n] = here[n];
      tried[1][n] = std::uint8_t(here[n] - left[n]);
      tried[2][n] = std::uint8_t(here[n] - up[n]);
    }
    std::size_t best = 0;
    long best_sum = -1;
    for (std::size_t f = 0; f < (plain ? 1 : tried.size()); ++f) {
      long sum = 0;
      for (std::uint8_t const v : tried[f]) sum += v < 128 ? v : 256 - v;
      if (best_sum >= 0 && sum >= best_sum) continue;
      best = f;
      best_sum = sum;
    }
    out += char(best);
    out.append(tried[best].begin(), tried[best].end());
    std::swap(now, above);
  }
  return out;
}

/// Numbers of colours, and these; nothing where there are more than a palette holds.
bool make_palette(Picture const& picture, std::vector<std::uint8_t>& number, std::vector<std::uint32_t>& colours) {
  std::unordered_map<std::uint32_t, std::uint8_t> known;
  std::size_t const n = picture.rgba.size() / 4;
  number.resize(n);
  for (std::size_t p = 0; p < n; ++p) {
    std::uint32_t colour = 0;
    if (picture.rgba[4 * p + 3] != 0) std::memcpy(&colour, picture.rgba.data() + 4 * p, 4);
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
