// A displacement file: points and their displacement, one per line.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph {

struct PointCloud {
  std::string source;              ///< file name, for messages
  std::vector<Vec3> position;      ///< (n) [length of the file]
  std::vector<Vec3> displacement;  ///< (n) [length of the file]; of a complex mode the real part
  std::vector<Vec3> imaginary;     ///< (n) imaginary part of a complex mode; empty where there is none
  std::vector<std::int64_t> id;    ///< (n) numbers that elements call the points by; empty: 1, 2, 3, ...
  std::vector<std::int64_t> line;  ///< (n) line of the file, or number in it, 1-based
  char const* counted_in = ":";    ///< between source and line in messages: ":" for lines, ", node " in CGNS files

  [[nodiscard]] std::size_t size() const { return position.size(); }
  /// Where a point stands in its file: "blade.csv:14".
  [[nodiscard]] std::string where(std::size_t point) const { return source + counted_in + std::to_string(line[point]); }
};

/// Reads a displacement file. Columns x, y, z, dx, dy, dz separated by commas, semicolons, tabs or blanks, in this
/// order, or in any order and among others under a header line that names them (also CoordinateX ..., Points:0 ...,
/// DisplacementX ..., Displacement:0 ..., in any case). With a header there may also be `id` (or `node`), a whole
/// number that no other point has, and dx_im, dy_im, dz_im, the imaginary part of a complex mode. Blank lines and lines
/// that begin with '#' are skipped.
///
/// Throws ConfigError (file:line, what was found) for a missing or empty file, too few columns, numbers that cannot be
/// read and values that are not finite; at most the first ten problems are listed. Cost O(size of the file).
PointCloud read_point_cloud(std::filesystem::path const& path);

/// The point cloud in a text; `source` names it in messages.
PointCloud parse_point_cloud(std::string_view text, std::string const& source);

}  // namespace gridmorph
