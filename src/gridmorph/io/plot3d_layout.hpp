// Where the numbers of a PLOT3D grid file are, found out from the file.
#pragma once

#include <gridmorph/core/index.hpp>
#include <gridmorph/io/plot3d_variant.hpp>

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
  /// False when the range is not in the file or cannot be read.
  [[nodiscard]] bool read(std::uint64_t at, void* to, std::uint64_t count);

 private:
  std::ifstream file_;
  std::uint64_t size_ = 0;
};

struct Segment {
  std::uint64_t at = 0, count = 0;  ///< bytes of the file
};

/// One zone: x of all nodes, then y, (z), (iblank); i fastest.
struct ZoneData {
  Index3 extent{1, 1, 1};         ///< as in the file; k 1 in 2-D files
  std::vector<Segment> segments;  ///< of binary files: one, or several where a Fortran record had to be split

  [[nodiscard]] Index nodes() const { return Index(extent[0]) * extent[1] * extent[2]; }
};

struct FileLayout {
  Variant variant;
  std::vector<ZoneData> zones;
};

/// Detects the layout of an unformatted or binary file: record markers, counts and sizes must all agree to the byte.
/// Throws IoError when nothing fits (what came nearest, and where it ends to fit) or several variants do. Reads the headers and the record
/// markers only, unless several variants fit the size: then the numbers decide.
FileLayout detect_binary(std::string const& path, Stated const& stated);

/// Calls visit(file offset, number before it, count) for the pieces of the file that hold bytes [begin, begin + count) of a
/// zone's data.
template <class Visit>
void for_each_piece(ZoneData const& zone, std::uint64_t begin, std::uint64_t count, Visit visit) {
  std::uint64_t start = 0;  // of the segment, in the zone's data
  for (auto const& s : zone.segments) {
    std::uint64_t const from = std::max(start, begin), to = std::min(start + s.count, begin + count);
    if (from < to) visit(s.at + (from - start), from - begin, to - from);
    start += s.count;
  }
}

}  // namespace gridmorph::plot3d
