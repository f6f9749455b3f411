#include <gridmorph/core/error.hpp>
#include <gridmorph/io/plot3d/plot3d_layout.hpp>

#include <algorithm>
#include <cctype>

namespace gridmorph::plot3d {

std::string to_string(Variant const& v) {
  std::string text;
  switch (v.storage) {
    case Storage::formatted: text = "formatted"; break;
    case Storage::unformatted: text = "unformatted"; break;
    case Storage::binary: text = "binary"; break;
  }
  if (v.storage == Storage::unformatted && v.marker_bytes == 8) text += ", 8-byte-markers";
  if (v.storage != Storage::formatted) {
    text += v.big_endian ? ", big-endian" : ", little-endian";
    text += v.double_precision ? ", double" : ", single";
  }
  text += v.multi_block ? ", multi-block" : ", single-block";
  text += v.dimensions == 2 ? ", 2-D" : ", 3-D";
  text += v.iblank ? ", iblank" : ", no-iblank";
  return text + (v.planes ? ", planes" : "");
}

bool Stated::allows(Variant const& v) const {
  auto const agrees = [](auto const& wanted, auto found) { return !wanted || *wanted == found; };
  bool const text = v.storage == Storage::formatted;
  return agrees(storage, v.storage) && agrees(multi_block, v.multi_block) && agrees(iblank, v.iblank) &&
         agrees(dimensions, v.dimensions) && agrees(planes, v.planes) &&
         (text || (agrees(big_endian, v.big_endian) && agrees(double_precision, v.double_precision))) &&
         (v.storage != Storage::unformatted || agrees(marker_bytes, v.marker_bytes));
}

Stated parse_variant(std::string_view words, std::string const& where) {
  Stated out;
  while (!words.empty()) {
    std::size_t const length = std::min(words.find_first_of(", \t"), words.size());
    std::string word(words.substr(0, length));
    words.remove_prefix(std::min(length + 1, words.size()));
    if (word.empty()) continue;
    std::transform(word.begin(), word.end(), word.begin(),
                   [](char c) { return c == '_' ? '-' : char(std::tolower(static_cast<unsigned char>(c))); });
    if (word == "formatted" || word == "ascii")
      out.storage = Storage::formatted;
    else if (word == "unformatted")
      out.storage = Storage::unformatted;
    else if (word == "binary")
      out.storage = Storage::binary;
    else if (word == "4-byte-markers" || word == "8-byte-markers")
      out.marker_bytes = word.front() - '0';
    else if (word == "little-endian" || word == "big-endian")
      out.big_endian = word == "big-endian";
    else if (word == "single" || word == "double")
      out.double_precision = word == "double";
    else if (word == "single-block" || word == "multi-block")
      out.multi_block = word == "multi-block";
    else if (word == "2-d" || word == "3-d")
      out.dimensions = word.front() - '0';
    else if (word == "iblank" || word == "no-iblank")
      out.iblank = word == "iblank";
    else if (word == "planes" || word == "whole")
      out.planes = word == "planes";
    else
      throw IoError(where + ": the word '" + word +
                    "' says nothing about a PLOT3D file; known are formatted, unformatted, binary, little-endian, "
                    "big-endian, single, double, multi-block, single-block, 2-D, 3-D, iblank, no-iblank, planes, "
                    "whole, 8-byte-markers");
  }
  return out;
}

}  // namespace gridmorph::plot3d
