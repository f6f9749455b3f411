// The mesh of a wheel, all but its coordinates: zones, patches and connections of every passage.
#pragma once

#include <gridmorph/wheel/rows.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// One zone of the wheel.
struct WheelZone {
  int zone = -1;  ///< of the sector mesh
  int passage = 0;
};

struct WheelMesh {
  Mesh mesh;  ///< no coordinates. Zones of elements share the nodes and the elements of their zone of the sector
  std::vector<WheelZone> zones;  ///< per Mesh::zones; passage after passage

  /// The nodes of all zones.
  [[nodiscard]] Index n_nodes() const;
};

enum class WheelFamilies {
  shared,   ///< "blade" in every passage
  suffixed  ///< "blade_P01", "blade_P02", ...
};

/// "_P01": two digits, more where there are 100 passages or more.
std::string passage_suffix(int passage, int passages);

/// passages: per row, how many are made (1 for rows that are not periodic,
/// which keep their names). Periodic interfaces and connections between
/// neighbours become plain ones, both sides of each; the last passage of a
/// whole wheel meets the first. The two ends of a part of a wheel and of a
/// straight row stay periodic, by its pitches. Faces of elements that the
/// sector has as a patch and on a periodic side are in the patch at the ends
/// alone: between passages they are no boundary. Throws MeshError for zone or
/// family names that would exceed 32 characters.
WheelMesh make_wheel_mesh(Mesh const& sector, PassageLinks const& links, WheelRows const& rows,
                          std::vector<int> const& passages, WheelFamilies families);

}  // namespace gridmorph
