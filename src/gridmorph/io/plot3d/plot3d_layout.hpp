// Where the numbers of a PLOT3D grid file are, found out from the file.
#pragma once

#include <gridmorph/core/index.hpp>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::plot3d {

enum class Storage {
  formatted,    ///< numbers as text
  unformatted,  ///< Fortran records: a byte count before and after each
  binary        ///< the bytes alone, as C programs write them
};

/// The way in which a PLOT3D grid file is stored. The file does not say which one it uses.
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

/// Bytes of a file, never beyond its end.
class Bytes {
 public:
  /// Throws IoError when the file cannot be opened.
  explicit Bytes(std::string const& path);
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Reads a range of bytes; false when the range is not in the file or cannot be read.
  [[nodiscard]] bool read(std::uint64_t at, void* to, std::uint64_t count);

 private:
  std::ifstream file_;
  std::uint64_t size_ = 0;
};

struct Segment {
  std::uint64_t at = 0, count = 0;  ///< bytes of the file
};

/// One zone: x of all nodes, then y, (z), (iblank); i fastest. What a file holds plane by plane is put into this order
/// by its segments.
struct ZoneData {
  Index3 extent{1, 1, 1};         ///< as in the file; k 1 in 2-D files
  std::vector<Segment> segments;  ///< of binary files, in the order of the data: one, or several where a Fortran record
                                  ///< had to be split or a file goes plane by plane

  [[nodiscard]] Index nodes() const { return Index(extent[0]) * extent[1] * extent[2]; }
};

struct FileLayout {
  Variant variant;
  std::vector<ZoneData> zones;
};

/// Detects the layout of an unformatted or binary file: record markers, counts and sizes must all agree to the byte.
/// Throws IoError when nothing fits (what came nearest, and where it ends to fit) or several variants do. Reads the
/// headers and the record markers only, unless several variants fit the size: then the numbers decide.
FileLayout detect_binary(std::string const& path, Stated const& stated);

/// Calls visit(file offset, number before it, count) for the pieces of the file that hold bytes [begin, begin + count)
/// of a zone's data.
template <class Visit>
void for_each_piece(ZoneData const& zone, std::uint64_t begin, std::uint64_t count, Visit visit) {
  std::uint64_t start = 0;  // of the segment, in the zone's data
  for (auto const& s : zone.segments) {
    std::uint64_t const from = std::max(start, begin), to = std::min(start + s.count, begin + count);
    if (from < to) visit(s.at + (from - start), from - begin, to - from);
    start += s.count;
  }
}

/// Calls visit(place in the file's order, place in the zone's order, count) for runs of coordinates of a zone that lie
/// together in both, counted in numbers from the zone's first one: x, y, (z) of all nodes, or of one plane k after the
/// other.
template <class Visit>
void for_each_run(ZoneData const& zone, Variant const& variant, Visit visit) {
  Index const per_node = variant.dimensions + (variant.iblank ? 1 : 0);
  int const planes = variant.planes ? zone.extent[2] : 1;
  Index const plane = zone.nodes() / planes;
  for (int k = 0; k < planes; ++k)
    for (int c = 0; c < variant.dimensions; ++c) visit(plane * (k * per_node + c), c * zone.nodes() + k * plane, plane);
}

}  // namespace gridmorph::plot3d
