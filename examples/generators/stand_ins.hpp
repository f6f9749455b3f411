// Meshes of the examples that were made on meshes which may not be passed on: of the same kind and difficulty, with the
// same names of zones and patches, so that one case file serves both. Shapes are given by formulas and by a few points
// of our own.
#pragma once

#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace gridmorph {

/// Axial water turbine about z, 5 sectors: guide vane, runner and draft tube in 7 zones of 6,050 nodes, H grids between
/// the cylinders r = 0.05 and 0.1. Blades are whole i faces of GV_vane and RU_blade; every zone but those is periodic
/// with itself; the rows meet at mixing planes that match neither in angle nor node for node. Each interface is stored
/// from both sides.
Mesh make_water_turbine();

/// Airfoil with slat and flap, chord about 1: C grids around flap (Zone 1), main element (Zone 2) and slat (Zone 3)
/// inside a fourth one, two node planes y = 0 and -1, 58,576 nodes. All 16 interfaces lie on parts of faces, 6 are wake
/// cuts of a zone with itself; walls are sub-ranges of k_min; first cells of 2.2e-6 in a domain of 20.
Mesh make_slotted_airfoil();

/// Tube bent around the body of an annular duct about z, from one side of the strut that holds the body to the other:
/// prisms on the tube, which end before the strut in pyramids, tetrahedra beyond (FluidZone), tetrahedra in the tube
/// (SolidZone). The zones share the nodes of the tube's wall without saying so.
Mesh make_heated_coil();

/// Names of these meshes: "turbine", "slat", "coil".
std::vector<std::string> const& stand_in_names();

/// Makes the folder if it is missing and writes the mesh of that name: water_turbine.cgns, slotted_airfoil.cgns (ADF)
/// or heated_coil.cgns (ADF, boundary conditions as lists of nodes). Returns its path. Throws ConfigError (no such
/// name), IoError or MachineError (writing).
std::filesystem::path write_stand_in(std::string const& name, std::filesystem::path const& folder);

}  // namespace gridmorph
