// Pictures as PNG (ISO/IEC 15948): 8 bits each of red, green, blue and opacity.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace gridmorph::io {

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  ///< (height, width, 4), rows from the top; colours are not multiplied by opacity

  Picture() = default;
  Picture(int w, int h) : width(w), height(h), rgba(std::size_t(w) * std::size_t(h) * 4, 0) {}
  [[nodiscard]] std::uint8_t const* at(int x, int y) const {
    return rgba.data() + 4 * (std::size_t(y) * std::size_t(width) + std::size_t(x));
  }
  [[nodiscard]] std::uint8_t* at(int x, int y) {
    return rgba.data() + 4 * (std::size_t(y) * std::size_t(width) + std::size_t(x));
  }
};

/// The bytes of the file. A picture of 256 colours or fewer has a palette. Packed by zlib, or stored where gridmorph is
/// built without it.
std::string png_bytes(Picture const& picture);

/// A picture as a PNG in a URI that pages can hold: "data:image/png;base64,...".
std::string png_data_uri(Picture const& picture);

}  // namespace gridmorph::io
