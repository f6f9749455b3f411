// A C mesh of quadrilaterals around a wing section, in the plane z = 0: the kind that airfoils are computed on.
#pragma once

#include <gridmorph/mesh/unstructured_mesh.hpp>

namespace gridmorph {

struct AirfoilOptions {
  double thickness =
      0.12;          ///< of the symmetric NACA section over its chord, which is 1 from the origin along x (0.02 to 0.3)
  int around = 256;  ///< cells on the section (even)
  int wake = 64;     ///< along the wake
  int across = 64;   ///< from the wall to the outer boundary
  double first_cell = 2e-4;  ///< height of the first cell about the middle of the section, in chords
  double distance = 29;      ///< of the outer boundary from the leading edge, in chords (2 to 1000)
};

/// The mesh: one zone of (around + 2 wake) x across quadrilaterals, patches "airfoil" (BCWallViscous) and "farfield"
/// (BCFarfield), numbered row by row. Sheared parabolic coordinates (A. Jameson, Comm. Pure Appl. Math. 27 (1974) 283):
/// with z = z0 + w^2, z0 just behind the leading edge, the section is a low bump over the real axis of w, and lines are
/// straight from it to a line of constant height; the wake is a line of nodes that both sides share. Throws ConfigError
/// when the options make no such mesh. Linear in the cells.
Mesh make_airfoil(AirfoilOptions const& options);

}  // namespace gridmorph
