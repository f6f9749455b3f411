// What a flow solver found on a mesh: values of named variables.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

namespace gridmorph {

/// Values on the nodes of a mesh, or in its cells.
struct FlowSolution {
  std::string source;  ///< file and FlowSolution_t, for messages
  bool at_nodes = true;
  /// The fields by the names of the CGNS SIDS ("Pressure", "VelocityX", ...), each with a value for every node of the
  /// mesh, as it numbers them, or for every cell: blocks zone after zone, i fastest; elements by their numbers.
  std::map<std::string, std::vector<double>> values;
  std::vector<std::string> available;  ///< all that the solution holds, wanted or not

  [[nodiscard]] std::vector<double> const* find(std::string const& name) const {
    auto const at = values.find(name);
    return at == values.end() ? nullptr : &at->second;
  }
  [[nodiscard]] bool has(std::initializer_list<char const*> names) const {
    return std::all_of(names.begin(), names.end(), [this](char const* name) { return find(name) != nullptr; });
  }
};

}  // namespace gridmorph
