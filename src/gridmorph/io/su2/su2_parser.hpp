// The text of an SU2 mesh file, line by line.
#pragma once

#include <gridmorph/core/index.hpp>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::su2 {

/// MARKER_TAG with what follows it; node numbers 0-based and of the zone.
struct Marker {
  std::string name;
  Index line = 0;        ///< of its MARKER_TAG
  int send_to = 0;       ///< of SEND_RECEIVE markers: positive sends, negative receives
  std::vector<int> vtk;  ///< type of each element
  std::vector<Index> start{0};
  std::vector<std::int64_t> nodes;
  std::vector<int> transform;  ///< of SEND_RECEIVE markers: PERIODIC_INDEX of each node
};

/// One PERIODIC_INDEX: rotation centre, angles and translation.
struct PeriodicEntry {
  double center[3] = {}, angle[3] = {}, translation[3] = {};
};

/// The mesh of one IZONE, or of a file without any.
struct ZoneText {
  std::string name;
  Index line = 0;
  int dimension = 0;
  bool has_elements = false, has_points = false;
  bool numbered = false;  ///< has an IZONE
  std::vector<int> vtk;
  std::vector<Index> start{0};
  std::vector<std::int64_t> nodes;
  std::vector<double> coordinates;  ///< dimension values per point
  bool index_differs = false;       ///< the index column of the points is not 0, 1, 2, ...
  std::vector<Marker> markers;
  std::vector<PeriodicEntry> periodic;
};

/// One coordinate in the text: which point and component, bytes begin <= b < end, and its value.
struct CoordinateText {
  std::size_t zone = 0;
  Index point = 0;
  int component = 0;
  std::size_t begin = 0, end = 0;
  double value = 0;
};

/// Number of nodes of a VTK cell type that SU2 meshes use; 0 for others.
int vtk_nodes(int vtk_type);

/// Parses a whole file. Throws IoError "file:line: ..." for what is wrong with it. `each_coordinate`, where given, is
/// called for every coordinate in the order of the file. notes: keywords that were skipped.
std::vector<ZoneText> parse(std::string const& path, std::string_view text, std::vector<std::string>& notes,
                            std::function<void(CoordinateText const&)> const& each_coordinate = {});

}  // namespace gridmorph::su2
