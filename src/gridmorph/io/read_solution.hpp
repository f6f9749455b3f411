// Flow solutions beside the mesh in a CGNS file.
#pragma once

#include <gridmorph/mesh/flow_solution.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <string>
#include <vector>

namespace gridmorph {

struct SolutionWanted {
  std::vector<std::string> variables;  ///< of these those that are there are read
  std::string solution = {};  ///< name of the FlowSolution_t; empty: the one with most of the variables, of those that
                              ///< FlowSolutionPointers lead to the last, else the first
  std::vector<std::string> leave_out = {};  ///< as in ReadOptions
};

/// Reads a solution on the zones of `mesh` from a file that has zones of the same names and sizes: its own, or another
/// one. Vertex and CellCenter; rind planes are passed over, the one plane of a 2-D file of blocks counts for both
/// planes of the mesh. Throws IoError for files that are no CGNS, zones that are not there or have other sizes, zones
/// without the solution (saying which they have), other locations, arrays that do not fit or belong to a part of the
/// zone, and values that are not finite; one error with all of them. Cost: one stream over the arrays that are read.
FlowSolution read_flow_solution(std::string const& path, Mesh const& mesh, SolutionWanted const& wanted);

}  // namespace gridmorph
