// The guard of elements: nodes moved where elements came out bad.
#pragma once

#include <gridmorph/guard/guard.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>
#include <gridmorph/plan/guarded_elements.hpp>

#include <vector>

namespace gridmorph {

struct RelaxOptions {
  double share = 0.2;              ///< an element is bad when its determinant is not above this share of the baseline's
  int rounds = 6;                  ///< of finding bad elements and smoothing around them
  int rings = 3;                   ///< of nodes around a bad element that may move in the first round
  int sweeps = 8;                  ///< over these nodes in the first round
  std::vector<signed char> signs;  ///< numbering_signs() of the mesh; left empty, they are found again
};

/// Where the 3x3x3 determinant of an element is not above share times the baseline's (or not positive, or negative
/// where the baseline's is zero), or the certificate finds it inside out (but for cells that were flat and are so
/// still, kernels/flat_cells.hpp), nodes around move so that the sum of the relative shapes f
/// (kernels/relative_shape.hpp) of all corners around becomes smaller: coloured Gauss-Seidel sweeps, a step per node
/// that does not let the sum over its corners grow. Nodes on boundaries that are held and in columns stay. While
/// elements are inverted, the next round has twice the rings and sweeps. A round that leaves more inverted elements, or
/// as many and more bad ones, is taken back; those after it, and all in 2-D, smooth displacements: each becomes the
/// value, at its node, of the affine function that fits its neighbours' best (weights 1 / length of the edge), in
/// Jacobi sweeps, half as many after each round that is taken back. Elements of second order that are broken by the
/// nodes between their corners alone have these pulled first, and what is left of them once more at the end: towards
/// places between those that boundaries give, or straight, as far as they need to (guard/detail/middle_nodes.hpp).
/// Explicit, the same bits for any number of threads. Cost: the determinants of all elements once, per round those
/// around the nodes that move; 1 kB and a few microseconds per sweep and node that moves.
GuardReport relax_bad_elements(Mesh const& mesh, UnstructuredTopology const& topology, GuardedElements const& plan,
                               Coordinates& morphed, RelaxOptions const& options = {});

/// morph_in_steps() of a mesh and a plan in parts. signs: numbering_signs() of the mesh; left empty, they are found
/// again in each step.
Coordinates morph_in_steps(Mesh const& mesh, UnstructuredTopology const& topology,
                           BoundaryFacePatches const& face_patches, MorphPlan const& plan,
                           std::vector<Vec3> const& displacement, StepOptions const& options,
                           std::vector<signed char> const& signs = {});

}  // namespace gridmorph
