// Points of a target in text files: section profiles, and lists of nodes.
#pragma once

#include <gridmorph/motion/target_rule.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph {

/// Reads section profiles: lines of x, y, z with sections set apart by blank lines or by lines that begin with '#' and
/// may name the next section; or lines of section, x, y, z, where a new section begins when the first column changes.
/// Columns are separated by commas, semicolons, tabs or blanks; one header line is allowed. Throws ConfigError
/// (file:line, what was found) for lines that cannot be read, values that are not finite, and sections of fewer than 5
/// points; at most ten problems are listed. Cost O(size of the file).
std::vector<TargetSection> read_target_sections(std::filesystem::path const& path);
std::vector<TargetSection> parse_target_sections(std::string_view text, std::string const& source);

/// Reads positions of nodes: lines of x, y, z, with a header line or without; blank lines and lines that begin with '#'
/// are skipped. Errors as above.
std::vector<Vec3> read_target_nodes(std::filesystem::path const& path);
std::vector<Vec3> parse_target_nodes(std::string_view text, std::string const& source);

/// The target of a rule from whatever file holds it, by the end of its name: .stl; .cgns, .cgn, .adf, .hdf, .h5; all
/// others are text. Throws ConfigError.
struct TargetSource {
  std::filesystem::path file;
  std::vector<std::string> patches;  ///< CGNS: patches of a volume mesh; empty: the file holds surfaces
  bool nodes = false;                ///< text: nodes, not sections
  double length_scale = 1;           ///< multiplies positions
};
TargetGeometry read_target(TargetSource const& source);

}  // namespace gridmorph
