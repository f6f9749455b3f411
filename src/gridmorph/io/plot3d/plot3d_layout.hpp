// Where the numbers of a PLOT3D grid file are, found out from the file.
#pragma once

#include <gridmorph/core/index.hpp>
#include <gridmorph/io/plot3d/plot3d_variant.hpp>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace gridmorph::plot3d {

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
