// The same mesh stored in another way: zones cut, turned, mirrored and renumbered, patches and interfaces in another
// order, interfaces stored from either side or from both.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <vector>

namespace gridmorph::test {

struct Scramble {
  unsigned seed = 1;
  int cuts = 0;          ///< random planes through zones, each from one end of its zone to the other
  bool reorient = true;  ///< one of the 48 signed permutations per zone; half of them make it left-handed
  bool reorder = true;   ///< zones, patches and interfaces
  bool resides = true;   ///< which sides of an interface are stored
};

struct ScrambledMesh {
  Mesh mesh;
  std::vector<Index> old_node;  ///< per node of `mesh`: the node of the original mesh it is
};

ScrambledMesh scramble(Mesh const& mesh, Scramble const& what);

/// The 48 signed permutations.
std::vector<Orientation> all_orientations();

/// What is wrong with a mesh, found without the library's topology: interfaces whose nodes are further apart than
/// tolerance (after the declared transform), face cells covered not exactly once. Empty when nothing is.
std::vector<std::string> flaws(Mesh const& mesh, double tolerance);

}  // namespace gridmorph::test
