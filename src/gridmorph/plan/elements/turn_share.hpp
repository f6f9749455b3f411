// How much of a body's turn a place makes: all of it at the body, none at other boundaries, like the logarithm of the distance between.
#pragma once

namespace gridmorph {

/// Distances of a place.
struct TurnDistances {
  double body = 0;         ///< from the body that turns
  double others = 0;       ///< from all boundaries that do not turn with it; infinite where there are none
  double body_layer = 0;   ///< what turns with the body whole: its columns
  double other_layer = 0;  ///< the same of the others
  double size = 0;         ///< largest distance of the body's walls from its centre
};

/// With d from the end of the columns on the body to the place, D from there to the end of those on the others:
///
///   f = 1 - Q(d / L) / Q(D / L),   Q(s) = log(1 + s) - e log(1 + s / e),   e = 0.25,   L = 0.21 (S^3 W)^(1/4)
///
/// S the size of the body, W the distance from it plus that from the others, 8 S at least. Around a body that turns by a(r) the shear is r da/dr, which is
/// smallest at its worst where it is the same everywhere: a logarithm. Q is one, but for having no slope at its start:
/// Q'(s) = (1 - e) s / ((1 + s) (e + s)). Where the way is much shorter than the body, f is 1 - (d / D)^2. e and L by measurement, on an airfoil in
/// a C mesh, viscous spheres and squares beside one another (docs/unstructured.md): shorter L favour narrow gaps and coarse cells
/// far out. Columns count as a third of the way at most. Continuous in all distances.
double turn_share(TurnDistances const& at);

}  // namespace gridmorph
