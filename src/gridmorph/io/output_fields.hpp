// Fields of a morph beside the mesh in a CGNS file: what structured and unstructured writers share. Internal to io.
#pragma once

#include <gridmorph/io/cgns/cgns_layout.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace gridmorph::io {

inline std::array<double const*, 3> components(Coordinates const& c) { return {c.x.data(), c.y.data(), c.z.data()}; }

inline constexpr std::array displacement_names{"DisplacementX", "DisplacementY", "DisplacementZ"};

/// Throws MeshError unless the coordinates and all fields have a value for each node or cell.
void check_fields(Index n_nodes, Index n_cells, Coordinates const& baseline, Coordinates const& morphed,
                  OutputFields const& fields);

/// Room that the fields take in a file.
std::uint64_t bytes_of_fields(OutputFields const& fields, std::size_t n_zones, Index n_nodes, Index n_cells);

/// What a zone has before fields are added, with the children that the tree of a file leaves out.
struct ZoneSolutions {
  std::vector<cgns::Node> solutions;          ///< FlowSolution_t
  std::set<std::string> pointed;              ///< those that FlowSolutionPointers name
  std::array<cgns::Node, 3> coordinate = {};  ///< arrays; empty where absent
};

/// The solutions of every zone of the layout. To be called before anything is written: the tree of a file in writing
/// cannot be read.
std::vector<ZoneSolutions> zone_solutions(cgns::File const& file, cgns::Layout const& layout);

/// Adds arrays to the solution of a zone at one location. Viewers read one solution per location, the first, or those
/// that FlowSolutionPointers name: the arrays go there. A solution of our own is made where there is none that can take
/// them (of the whole zone, in this file). What the file has keeps its name and values.
class SolutionWriter {
 public:
  /// own_name: of a solution of our own; another name is taken where that is taken. location: "Vertex" or "CellCenter".
  /// dimensions: of the arrays, without rind planes. names: of all arrays to come; all get the prefix "Morph" where one
  /// of them is taken.
  SolutionWriter(cgns::File& file, cgns::ZoneLayout const& zone, ZoneSolutions const& present,
                 std::string const& own_name, std::string const& location, std::vector<Index> dimensions,
                 std::vector<std::string> const& names);
  void add(std::string const& name, double const* values, FieldUnit unit) const;
  /// Adds a difference of coordinates: data class, units and conversion as those of the coordinate, whose array, grid,
  /// zone or base says them.
  void add_displacement(std::string const& name, double const* values, int component) const;

 private:
  struct Place {
    double id = 0;
    std::vector<std::int64_t> rind;  ///< low and high for each index, or empty
  };
  [[nodiscard]] std::vector<cgns::Node const*> usable(std::string const& location) const;
  [[nodiscard]] bool fits(cgns::Node const& solution, std::string const& location) const;
  template <class Describe>
  void add_array(std::string const& name, double const* values, Describe const& describe) const;
  [[nodiscard]] std::vector<double> with_rind(Place const& place, double const* values,
                                              std::vector<Index>& dimensions) const;

  cgns::File& file_;
  cgns::ZoneLayout const& zone_;
  ZoneSolutions const& present_;
  std::vector<Index> dimensions_;
  std::vector<Place> places_;
  std::string prefix_;
};

/// Names of the arrays that fields make at the nodes and in the cells; `has`: components that the file stores.
std::vector<std::string> names_of_nodes(OutputFields const& fields, std::array<bool, 3> const& has);
std::vector<std::string> names_of_cells(OutputFields const& fields);

}  // namespace gridmorph::io
