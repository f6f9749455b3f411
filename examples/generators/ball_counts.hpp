// How many cells the ball mesh has in each direction. Internal to the ball demo. All lengths in radii of the ball,
// whose centre is the origin.
#pragma once

#include <generators/ball.hpp>
#include <generators/grading.hpp>
#include <generators/wall_shell.hpp>

namespace gridmorph::demo {

/// Half the width of the square section of the tube of cells around ball and rope.
inline constexpr double tube_half_width = 1.8;

struct BallCounts {
  int side = 0;                                       ///< of the tube's section, along each side
  int lower = 0, upper = 0;                           ///< rings on the ball, below and above its equator
  int rope = 0;                                       ///< rings
  int tetrahedral = 0;                                ///< cells of a column beyond the layers
  int behind = 0, between = 0, mast = 0, beyond = 0;  ///< lattice, along x on either side of the tube
  int beside = 0;                                     ///< lattice, along y on either side
  int below = 0, jib = 0, above = 0;                  ///< lattice, along z
  LayerHeights layers;
  Grading lattice;  ///< sizes by the distance from the tube
  Grading rings_on_rope;

  [[nodiscard]] int rings() const { return lower + upper + rope; }
  [[nodiscard]] int lattice_x() const { return behind + side + between + mast + beyond; }
  [[nodiscard]] int lattice_y() const { return beside + side + beside; }
  [[nodiscard]] int lattice_z() const { return below + rings() + jib + above; }
};

/// Arc from the equator of the ball to the rope.
double upper_arc(BallOptions const& options);

/// Counts for the wanted number of elements. Throws ConfigError.
BallCounts ball_counts(BallOptions const& options);

/// Elements that these counts make, exactly.
Index count_elements(BallOptions const& options, BallCounts const& counts);

}  // namespace gridmorph::demo
