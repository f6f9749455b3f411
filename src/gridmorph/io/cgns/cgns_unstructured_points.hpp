// Point sets of unstructured zones.
#pragma once

#include <gridmorph/io/cgns/cgns_sections.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cgns {

/// What a PointList, PointRange, ElementList or ElementRange names: nodes, or elements by their numbers.
struct NumberSet {
  std::vector<std::int64_t> numbers;  ///< as in the file; ranges written out
  bool nodes = true;
};

/// The point set of a BC_t or GridConnectivity_t; on failure nothing, and `why` says what is wrong with it. Ranges that
/// reach beyond `largest` are not written out.
std::optional<NumberSet> read_number_set(File const& file, Node const& owner, std::int64_t largest, std::string& why);

/// The largest number that a point set of a zone can hold.
std::int64_t largest_number(ZoneLayout const& zone, ListedFaces const& faces, Mesh const& mesh, int z);

}  // namespace gridmorph::cgns
