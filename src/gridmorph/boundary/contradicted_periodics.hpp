// Periodic boundaries whose nodes contradict what the file declares.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <string>
#include <vector>

namespace gridmorph {

/// A line for each periodicity that interfaces or connections declare and that takes their nodes, there or back, more
/// than a thousandth of the mesh past their partners, though another one fits: "interface 'per' and 2 more: the file
/// declares ...; by their nodes it is ...". Morphs go by the nodes (fit_periodic()); solvers may go by the file. Cost:
/// O(nodes of periodic boundaries).
std::vector<std::string> contradicted_periodics(Mesh const& mesh, double mesh_size);

}  // namespace gridmorph
