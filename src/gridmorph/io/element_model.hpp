// A structural model from a CGNS file: nodes, displacement, and the faces that bound its elements.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace gridmorph {

struct ElementModel {
  std::vector<Vec3> position;      ///< (n) nodes of all zones one after another
  std::vector<Vec3> displacement;  ///< (n) real part of a complex mode
  std::vector<Vec3> imaginary;     ///< (n) or empty
  /// Triangles (last number -1) and quadrilaterals by node numbers, 0-based, in order around; empty where the file has
  /// no elements.
  std::vector<std::array<std::int32_t, 4>> facets;
  std::string solution;            ///< name of the solution that was taken
  std::vector<std::string> notes;  ///< what was left out
};

/// Reads the zones of the file:
/// - unstructured: sections of TRI_3, TRI_6, QUAD_4, QUAD_8, QUAD_9, of TETRA_4, TETRA_10, PYRA_5, PENTA_6, PENTA_15,
///   HEXA_8, HEXA_20, and MIXED ones of these. Of solid elements the faces that belong to one element alone are taken;
///   if a file has shells and solids, the shells alone. Elements with nodes amid their edges are split at them into
///   triangles and quadrilaterals, so that every node of the file counts. Nodes and lines as elements are passed over;
/// - structured with two index directions: its cells as quadrilaterals.
///
/// Displacement: DisplacementX, DisplacementY, DisplacementZ at the nodes (a missing component is zero, one must be
/// there), and DisplacementX_im ... for the imaginary part, in the FlowSolution_t named `solution`, or where that is
/// empty in the first one that has them. All zones must have it. Throws IoError (not readable, damaged, other kinds of
/// elements, no displacement) and MeshError (numbers of nodes that are not there, values that are not finite).
ElementModel read_element_model(std::string const& path, std::string const& solution = {});

}  // namespace gridmorph
