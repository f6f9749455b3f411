#include <gridmorph/io/cgns/cgns_unstructured_points.hpp>

#include <algorithm>
#include <numeric>

namespace gridmorph::cgns {

std::optional<NumberSet> read_number_set(File const& file, Node const& owner, std::int64_t largest, std::string& why) {
  for (auto const& child : owner.children) {
    bool const range = child.label == "IndexRange_t" && (child.name == "PointRange" || child.name == "ElementRange");
    bool const list = child.label == "IndexArray_t" && (child.name == "PointList" || child.name == "ElementList");
    if (!range && !list) continue;
    NumberSet set;
    set.numbers = file.integers(child);
    auto const* location = owner.labelled("GridLocation_t");
    std::string const where = location ? file.text(*location) : "Vertex";
    set.nodes = !child.name.starts_with("Element") && (where == "Vertex" || where == "Null" || where == "UserDefined");
    if (!set.nodes && location && where != "Vertex" && where != "FaceCenter" && where != "EdgeCenter" &&
        where != "CellCenter") {
      why = "its GridLocation '" + where + "' is not known";
      return std::nullopt;
    }
    if (!range) return set;
    if (set.numbers.size() != 2) {
      why = child.name + " does not hold two numbers";
      return std::nullopt;
    }
    auto const begin = std::min(set.numbers[0], set.numbers[1]), end = std::max(set.numbers[0], set.numbers[1]);
    if (begin < 1 || end > largest) return set;  // the ends alone show what is wrong
    set.numbers.resize(std::size_t(end - begin) + 1);
    std::iota(set.numbers.begin(), set.numbers.end(), begin);
    return set;
  }
  why = "it has neither PointRange nor PointList";
  return std::nullopt;
}

std::int64_t largest_number(ZoneLayout const& zone, ListedFaces const& faces, Mesh const& mesh, int z) {
  std::int64_t largest = zone.extent[0];
  for (auto const number : faces.number) largest = std::max(largest, number);
  auto const& own = mesh.zones[z];
  for (Index e = own.first_element; e < own.first_element + own.n_elements; ++e)
    largest = std::max<std::int64_t>(largest, mesh.elements.number[e]);
  return largest;
}

}  // namespace gridmorph::cgns
