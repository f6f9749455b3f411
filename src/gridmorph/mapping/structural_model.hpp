// A structural model: nodes with their displacement and, where it has them, the elements of its surface.
#pragma once

#include <gridmorph/mapping/point_cloud.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph {

/// A triangle or a quadrilateral of the model's surface, by numbers of nodes in order around it.
struct StructuralFacet {
  std::array<std::int32_t, 4> node{-1, -1, -1, -1};  ///< the last one is -1 in a triangle
  std::int64_t place = 0;                            ///< line of the element file, or element number; for messages

  [[nodiscard]] int corners() const { return node[3] < 0 ? 3 : 4; }
};

struct StructuralModel {
  PointCloud nodes;
  std::vector<StructuralFacet> facets;  ///< empty: a cloud of points
  std::string elements;                 ///< where the facets come from, for messages
  std::vector<std::string> notes;
};

/// The files of a model.
struct ModelFiles {
  std::filesystem::path file;                     ///< points as text, or a CGNS file with elements
  std::optional<std::filesystem::path> elements;  ///< elements as text, for points as text
  std::optional<std::string> solution;  ///< CGNS: the FlowSolution_t with the displacement; else the first fit
};

/// Reads a model. Text files: read_point_cloud for the points, parse_elements for the elements. CGNS files (recognised
/// by their first bytes): read_element_model. Throws ConfigError or IoError.
StructuralModel read_structural_model(ModelFiles const& files);

/// Elements as text: one per line, id, n1, n2, n3 for a triangle and id, n1, n2, n3, n4 for a quadrilateral, where n1
/// ... are ids of the model's nodes in order around the element. A quadrilateral that names its last node twice, or
/// leaves n4 empty, is a triangle. Separators, comments and an optional header as in displacement files. Throws one
/// ConfigError that lists the first ten problems: lines cut short, nodes that are not there, nodes named twice, ids
/// used twice.
std::vector<StructuralFacet> parse_elements(std::string_view text, std::string const& source, PointCloud const& nodes);

}  // namespace gridmorph
