// Periodic_t of a connection.
#pragma once

#include <gridmorph/io/cgns/cgns_file.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph::cgns {

/// Periodicity of a connection node; nothing where it has none, or one that moves nothing.
///
/// x_donor = R (x - RotationCenter) + RotationCenter + Translation with R = Rz Ry Rx of RotationAngle. Angles are in
/// the units that DimensionalUnits_t of the array, of Periodic_t, of the zone or of the base names; radians where none
/// does, unless an angle exceeds a full turn of radians, which only degrees explain (noted).
std::optional<Periodic> read_periodic(File const& file, Node const& base, Node const& zone, Node const& connection,
                                      std::string const& where, std::vector<std::string>& notes);

}  // namespace gridmorph::cgns
