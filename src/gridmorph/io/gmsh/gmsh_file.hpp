// What a Gmsh file (MSH 2.2, 4.0, 4.1) holds, as it stands there. Internal to io.
//
// Format: Gmsh reference manual, "MSH file format" (4.1) and "MSH file format version 2 (Legacy)".
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/io/gmsh/gmsh_text.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::gmsh {

/// Elements that lie on one piece of geometry and belong to the same physical groups.
struct Group {
  int dimension = 0;
  std::int64_t entity = 0;
  std::vector<std::int64_t> physical;  ///< ascending, each once, positive
  bool between_parts = false;          ///< of a mesh in parts: faces that two of them share, no boundary
};

/// Nodes of one piece of geometry and those they repeat.
struct PeriodicLink {
  int dimension = 0;
  std::int64_t entity = 0, master = 0;
  std::optional<std::array<double, 16>> affine;  ///< rows; masters onto their images
  std::vector<std::array<Index32, 2>> nodes;     ///< image, master; places in File::tag
};

struct File {
  // Nodes in the order of the file.
  std::vector<std::int64_t> tag;
  std::vector<double> coordinates;  ///< three each
  std::vector<std::size_t> at;      ///< byte at which the three begin
  bool parametric = false;          ///< nodes have parameters on the geometry, too

  // Elements in the order of the file; nodes are places in `tag`.
  std::vector<std::uint8_t> type;  ///< Gmsh's number
  std::vector<std::int64_t> number;
  std::vector<Index32> group;
  CsrGraph nodes;
  std::vector<Group> groups;
  bool repeats_elements = false;  ///< an element is there once for each of its physical groups (2.2)

  std::map<std::pair<int, std::int64_t>, std::string> names;  ///< of physical groups, by dimension and number
  std::vector<PeriodicLink> periodic;
  std::vector<std::string> passed_over;  ///< sections without a part in morphing
};

/// Everything from behind $MeshFormat to the end. Throws IoError.
File parse(Text& text);

}  // namespace gridmorph::gmsh
