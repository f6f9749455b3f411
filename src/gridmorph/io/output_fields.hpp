// Fields of a morph beside the mesh in a CGNS file: what structured and unstructured writers share. Internal to io.
#pragma once

#include <gridmorph/io/cgns_layout.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <array>
#include <cstdint>
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

/// One FlowSolution_t of a zone.
class SolutionWriter {
 public:
  /// `dimensions` of each array. Another name is taken where the input, which comes through unchanged, has a solution of
  /// the one that is wanted.
  SolutionWriter(cgns::File& file, cgns::Node const& zone, std::string const& wanted_name, char const* location,
                 std::vector<Index> dimensions);
  void add(std::string const& name, double const* values) const;

 private:
  cgns::File& file_;
  double id_ = 0;
  std::vector<Index> dimensions_;
};

}  // namespace gridmorph::io
