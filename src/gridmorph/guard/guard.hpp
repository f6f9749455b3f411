// After a morph: displacements smoothed where elements came out bad.
#pragma once

#include <gridmorph/mesh/unstructured_topology.hpp>

#include <vector>

namespace gridmorph {

struct PreparedUnstructured;  ///< MorphPlan::elements()

struct RelaxOptions {
  double share = 0.2;              ///< an element is bad when its determinant is not above this share of the baseline's
  int rounds = 6;                  ///< of finding bad elements and smoothing around them
  int rings = 3;                   ///< of nodes around a bad element that may move
  int sweeps = 8;                  ///< of Jacobi iterations per round
  std::vector<signed char> signs;  ///< numbering_signs() of the mesh; left empty, they are found again
};

struct RelaxReport {
  Index before = 0, after = 0;  ///< bad elements
  int rounds = 0;
};

/// Where the 3x3x3 determinant of an element is not above share times the baseline's (or not positive, or negative where the
/// baseline's is zero), the displacements of the
/// nodes around are smoothed: each becomes the value, at its node, of the affine function that fits its neighbours' best (weights
/// 1 / length of the edge), so that a field that is affine already stays. A fixed number of Jacobi sweeps per round; nodes on
/// boundaries that are held and in columns keep theirs. A round that leaves more bad elements than there were is taken back, and
/// the next ones have half as many sweeps. Explicit, deterministic; cost: the determinants of all elements once,
/// per round those around the nodes that move.
RelaxReport relax_bad_elements(Mesh const& mesh, UnstructuredTopology const& topology,
                               PreparedUnstructured const& prepared, Coordinates& morphed,
                               RelaxOptions const& options = {});

}  // namespace gridmorph
