// After a morph: nodes moved where cells came out bad.
#pragma once

#include <gridmorph/morph/morph.hpp>

namespace gridmorph {

/// What a guard found and left. Bad are cells of blocks with a corner whose scaled Jacobian is below 0.2 and below half
/// of what it was, and elements whose determinant is not above a fifth of the baseline's; inverted ones among them.
struct GuardReport {
  Index before = 0, after = 0;
  int rounds = 0;                                 ///< of smoothing, of blocks those that were kept
  Index inverted_before = 0, inverted_after = 0;  ///< by the certificate, and not so in the baseline
  Index middles = 0;                              ///< nodes between corners of second-order elements that were pulled
};

/// Moves nodes around bad cells so that the relative shapes of all corners around become better, those of boundaries
/// that slide on their surfaces; nothing moves where no cell is bad, and nothing gets worse (docs/quality.md: of blocks
/// smooth_shapes(), of elements relax_bad_elements() has what is done, in which order). mesh: what the plan was made
/// for; morphed: what a Morpher of it made. Explicit, the same bits for any number of threads; elements work on the
/// default host instance. Cost: one look at all cells; where some are bad, about 1 kB per node around them and a few
/// microseconds per sweep and node.
GuardReport guard(HostInstance const& host, IndexedMesh const& mesh, MorphPlan const& plan, Coordinates& morphed);

}  // namespace gridmorph
