// How much of a body's turn and shift a place makes: all of it at the body, none at other boundaries; turns like the
// logarithm of the distance between, shifts like the distance.
#pragma once

#include <span>

namespace gridmorph {

/// Distances of a place.
struct TurnDistances {
  double body = 0;         ///< from the body that turns
  double others = 0;       ///< from all boundaries that do not turn with it; infinite where there are none
  double body_layer = 0;   ///< what turns with the body whole: its columns
  double other_layer = 0;  ///< what stays with the others whole: their columns
  double size = 0;         ///< largest distance of the body's walls from its centre
};

/// The share of a body's turn that a place makes, with d from the end of the columns on the body to the place, D from
/// there to the end of those on the others:
///
///   f = 1 - Q(d / L) / Q(D / L),   Q(s) = log(1 + s) - e log(1 + s / e)
///   e = 0.25 g, 0.02 at least,   L = 0.21 (S^3 F)^(1/4) / sqrt(g),   F = max(W, 8 S),   g = min(1, W / (8 S))
///
/// S the size of the body, W the distance from it plus that from the others. Around a body that turns by a(r) the shear
/// is r da/dr, which is smallest at its worst where it is the same everywhere: a logarithm. Q is one, but for having no
/// slope at its start: Q'(s) = (1 - e) s / ((1 + s) (e + s)). In gaps narrower than the body (g < 1) the turn begins to
/// fade sooner and then evenly: there the shear is that between two walls. Where the way is very short, f is 1 - (d /
/// D)^2. e and L by measurement, on an airfoil in a C mesh, viscous spheres and squares beside one another
/// (docs/unstructured.md). Columns count as a third of the way at most. Continuous in all distances.
double turn_share(TurnDistances const& at);

/// Makes the turn shares of several bodies together, in place: f_b times the product over the other bodies of 1 - 0.4
/// f. Each turns what is around it about its own centre, far from what lies between two of them, where both would add
/// up to more than either wall moves. 0.4 by measurement on squares that turn beside one another.
void share_between(std::span<double> turn_shares);

/// The turn share in narrow surroundings of plane meshes: where the way W is less than 6 S, what a place sees on all
/// sides decides, not what is nearest (surroundings.hpp):
///
///   f = k h + (1 - k) f_log,   h = 0.62 q + 0.38 (3 q^2 - 2 q^3),
///   q = C_b / (C_b + sum of the C of all that does not turn with the body),
///   k = 1 - 3 t^2 + 2 t^3,   t = (W / S - 3) / 3, between 0 and 1
///
/// f_log what the functions above make of it. With C = c / e, c from the lattice and e the exact distance beyond the
/// columns, so that f is 1 and 0 where it has to be. 0.38, 3 and 6 by measurement on squares that turn beside a wall,
/// beside one another and in boxes. closeness: c_b / e_b and the sum of the others'; infinite where e is zero.
double turn_share_in_sight(double body, double others);
/// The share k that what is in sight has in f, to be multiplied by compactness().
double narrowness(double way, double size);
/// How compact a body is: (P / (2 pi S) - 0.7) / 0.15 between 0 and 1, P the perimeter of the body: 1 of circles and
/// squares, 0 of blades (0.64 and somewhat more), whose ends, which move most, little of them is in sight of: a blade
/// in a cascade is better off by distances from 12 degrees on.
double compactness(double perimeter, double size);

/// How much of each body's shift a place makes:
///
///   s_b = 1 - 0.9 t - 0.1 (3 t^2 - 2 t^3),   t = g_b / (g_b + D),
///   1 / D = 1 / d + sum over the other bodies k of 1 / g_k,
///   g_b = d_b - l log(1 + d_b / l),   l = S_b min(1, W / (8 S_b))^2
///
/// d_b the distances from the ends of the columns on the bodies, S_b the sizes of these, d the distance from the
/// others, W the distance from body b plus that from what is nearest else. A shift strains what is on its way, so an
/// even fade is best; far from all else without slope beside the body, where cells are small and must not shear. By
/// measurement on spheres in outer ones 20 and 60 diameters away and on an airfoil in a C mesh (docs/unstructured.md).
/// All of it where nothing else is there. Continuous in all distances; the sum over bodies is 1 at most.
void shift_shares(std::span<double const> from_bodies, std::span<double const> sizes, double from_others,
                  std::span<double> shares);

}  // namespace gridmorph
