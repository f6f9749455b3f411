// Point sets of boundary conditions and connections, turned into node ranges on a face of a zone.
#pragma once

#include <gridmorph/io/cgns/cgns_layout.hpp>
#include <gridmorph/mesh/point_ranges.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cgns {

/// The corners of a range as in the file. Along an axis the file does not have (2-D zones) both corners are 1.
using Corners = PointRange;

/// A range as messages show it: "[1:33, 1:1, 9:5]", in the file's direction and with as many axes as the file has.
std::string to_string(Corners const& corners, int index_dimension);

/// What a point set refers to (GridLocation_t).
enum class Location { vertex, face, i_face, j_face, k_face, cell };

struct PointSet {
  std::vector<Index3> points;  ///< of a PointList, in file order; empty for a range
  Corners corners;             ///< of the PointRange, or of the box around the list
  Location location = Location::vertex;
  bool elements = false;  ///< ElementRange or ElementList of old files: faces by default
};

/// The point set of a BC_t or GridConnectivity_t node; on failure nothing, and `why` says what is wrong with it.
std::optional<PointSet> read_point_set(File const& file, ZoneLayout const& zone, Node const& owner, std::string& why);

/// Tuples of an index node ("PointList", "PointListDonor", ...), filled up to three indices.
std::optional<std::vector<Index3>> read_tuples(File const& file, Node const& node, int index_dimension);

/// Why a point set is no face range.
enum class Misfit { none, out_of_bounds, not_a_face };

struct FaceRange {
  IndexRange range;  ///< nodes in the mesh, 0-based; a flat axis counts its two planes
  Misfit misfit = Misfit::none;
  std::string why;  ///< for messages, where misfit is not none
};

/// Node range of a point set that covers a rectangle of one face of its zone. Face-centred ranges [b:e] become node
/// ranges [b:e+1]; lists must fill their bounding box. A range that reaches the last node along a face was written as
/// nodes, whatever its location says, and is taken so.
FaceRange face_range(ZoneLayout const& zone, PointSet const& set);

/// The ascending 0-based node range between corners given as vertices; flat axes get their two planes.
IndexRange node_range(ZoneLayout const& zone, Corners const& corners);

/// The axis a face range is normal to: extent 1 there, more elsewhere, and at the first or last node of the zone.
std::optional<int> face_normal(ZoneLayout const& zone, IndexRange const& range);

/// All index tuples of a range from begin to end, first index fastest.
std::vector<Index3> all_points(Corners const& corners);

/// Whether all corners are nodes of the zone as it is in the file.
bool inside(ZoneLayout const& zone, Corners const& corners);

}  // namespace gridmorph::cgns
