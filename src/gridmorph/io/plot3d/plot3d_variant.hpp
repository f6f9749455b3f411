// The ways in which PLOT3D grid files are stored. The files do not say which one they use.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace gridmorph::plot3d {

enum class Storage {
  formatted,    ///< numbers as text
  unformatted,  ///< Fortran records: a byte count before and after each
  binary        ///< the bytes alone, as C programs write them
};

struct Variant {
  Storage storage = Storage::unformatted;
  int marker_bytes = 4;  ///< of the byte counts of Fortran records, 4 or 8
  bool big_endian = false;
  bool double_precision = true;  ///< 8 bytes per coordinate, otherwise 4
  bool multi_block = true;       ///< begins with the number of zones
  int dimensions = 3;            ///< 2: ni, nj and x, y; 3: ni, nj, nk and x, y, z
  bool iblank = false;           ///< one 4-byte integer per node after the coordinates
  bool planes = false;           ///< one plane k after the other, each with all of its coordinates and marks

  [[nodiscard]] int coordinate_bytes() const { return double_precision ? 8 : 4; }
  [[nodiscard]] int bytes_per_node() const { return dimensions * coordinate_bytes() + (iblank ? 4 : 0); }
};

/// "unformatted, little-endian, double, multi-block, 3-D, no iblank"; also what users write to state a variant.
std::string to_string(Variant const& variant);

/// What a user says about a file; what is left out is detected.
struct Stated {
  std::optional<Storage> storage;
  std::optional<int> marker_bytes;
  std::optional<bool> big_endian, double_precision, multi_block, iblank, planes;
  std::optional<int> dimensions;

  [[nodiscard]] bool allows(Variant const& variant) const;
};

/// Words as in to_string(), in any order, separated by commas or blanks. Throws IoError on a word that means nothing;
/// `where` says where they are from.
Stated parse_variant(std::string_view words, std::string const& where);

}  // namespace gridmorph::plot3d
