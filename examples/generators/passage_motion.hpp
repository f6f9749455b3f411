// The two motions of the demo passage (paper, sections 2 and 3.1) as displacements of the blade's surface.
//
// Every section moves in its own developed surface (axial, R theta) at constant span fraction, so the nodes on hub and
// case stay there to round-off.
#pragma once

#include <generators/passage.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

/// Turn about mid chord and change of chord, mid chord held and thickness kept.
struct PassageMotion {
  std::string name;         ///< for file names and reports
  double rotation_deg = 0;  ///< of every section, positive towards a higher stagger angle
  /// (span fraction, factor on the chord) through which a smooth curve is put: C1, monotone between the stations, level
  /// where they have an extreme. Constant outside the first and the last. Empty: 1.
  std::vector<std::pair<double, double>> chord_factor;
  double gap_factor = 1;  ///< on the tip gap: the blade grows from the hub on, evenly in span fraction
};

/// Sections rotated by 10 degrees, chord shortened by 5 % (paper, Figure 10). The sections turn towards axial.
PassageMotion rotated_sections();
/// Chord -10 % at 15 % and 90 % span, +10 % at 50 % span (paper, section 3.1), unchanged at hub and case.
PassageMotion chord_redesign();
/// The blade grows until the gap over its tip is half as high.
PassageMotion gap_halved();
/// By name: "rotation", "chord" or "gap". Throws ConfigError that lists them.
PassageMotion passage_motion(std::string const& name);

/// Factor on the chord at a span fraction.
double chord_factor(PassageMotion const& motion, double span);

/// Displacement of a point of the blade, its tip and what is cut into it made with these options. Cost: O(1).
Vec3 passage_displacement(PassageOptions const& options, PassageMotion const& motion, Vec3 const& point);

/// Writes "x,y,z,dx,dy,dz" of the nodes of these families' patches, each point once, with 17 digits, so that reading
/// gives back the same numbers. Throws MeshError when no patch has one of the families, MachineError when writing
/// fails.
void write_displacement_csv(std::string const& path, Mesh const& mesh, std::vector<std::string> const& families,
                            std::function<Vec3(Vec3 const&)> const& displacement);

}  // namespace gridmorph
