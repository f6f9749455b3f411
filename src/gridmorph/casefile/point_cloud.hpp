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
  std::vector<Vec3> displacement;  ///< (n) [length of the file]
  std::vector<std::int64_t> line;  ///< (n) line of the file, 1-based

  [[nodiscard]] std::size_t size() const { return position.size(); }
  /// "blade.csv:14"
  [[nodiscard]] std::string where(std::size_t point) const { return source + ":" + std::to_string(line[point]); }
};

/// Reads a displacement file. Columns x, y, z, dx, dy, dz separated by commas, semicolons, tabs or blanks, in this order,
/// or in any order and among others under a header line that names them (also CoordinateX ..., Points:0 ...,
/// DisplacementX ..., Displacement:0 ..., in any case). Blank lines and lines that begin with '#' are skipped.
///
/// Throws ConfigError (file:line, what was found) for a missing or empty file, too few columns, numbers that cannot be
/// read and values that are not finite; at most the first ten problems are listed. Cost O(size of the file).
PointCloud read_point_cloud(std::filesystem::path const& path);

/// The same from text; `source` names it in messages.
PointCloud parse_point_cloud(std::string_view text, std::string const& source);

}  // namespace gridmorph
