// The ball demo as files: mesh and case file. And its motion: the ball swings towards the mast of the crane.
//
// The rope bends along a circular arc below the jib and is straight from there; each of its sections stays plane, keeps
// its shape, and turns with the rope, and the ball turns with its lower end:
//
//   phi = angle min((top - z) / bend, 1)      rho = bend / angle      s = max(top - z - bend, 0)
//   dx = rho (1 - cos phi) + s sin phi + x (cos phi - 1)
//   dz = top - z - rho sin phi - s cos phi + x sin phi                dy = 0
//
// Nothing moves at the jib (z = top); below the bend, rope and ball move as one rigid body that has turned by the
// angle.
#pragma once

#include <generators/ball.hpp>

#include <filesystem>
#include <string>

namespace gridmorph {

struct BallSwing {
  double angle_deg = 30;  ///< positive: towards the mast
  double bend = 2;        ///< length of the rope that bends, in radii of the ball
};

/// Displacement of a point of ball or rope. Cost: O(1).
Vec3 ball_displacement(BallOptions const& options, BallSwing const& swing, Vec3 const& point);

/// Throws ConfigError when the ball would come closer than half a radius to jib, mast or box, or the bend is longer
/// than the rope.
void check_swing(BallOptions const& options, BallSwing const& swing);

struct BallFiles {
  std::filesystem::path mesh;       ///< CGNS
  std::filesystem::path case_file;  ///< TOML
  std::filesystem::path morphed;    ///< CGNS that the case file will write; not there yet
};

/// Text of the case file. Ball and rope swing, the crane stands; the box keeps the defaults of its patches' kinds:
/// fixed, but nodes slide on the ground.
std::string ball_case_file(BallOptions const& options, BallSwing const& swing, BallFiles const& files);

/// Where the demo puts its files.
BallFiles ball_files(std::filesystem::path const& folder);

/// Makes the folder if it is missing and writes ball.cgns and swing.toml into it; paths inside the case file are
/// relative to it. Throws ConfigError (options), IoError or MachineError (writing).
BallFiles write_ball_demo(std::filesystem::path const& folder, BallOptions const& options, BallSwing const& swing);

}  // namespace gridmorph
