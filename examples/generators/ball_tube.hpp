// The tube of cells around ball and rope: columns off the wall, straight below the ball's equator, curved above it.
// Internal to the ball demo; lengths as in ball_counts.hpp.
#pragma once

#include <generators/ball_counts.hpp>

#include <functional>
#include <vector>

namespace gridmorph::demo {

struct BallPatches {
  int ball = 0, rope = 0, crane = 0;
};

class BallTube {
 public:
  BallTube(BallOptions const& options, BallCounts const& counts);

  /// Lattice lines of the tube's sides: x and y; z.
  [[nodiscard]] std::vector<double> const& across() const { return across_; }
  [[nodiscard]] std::vector<double> const& along() const { return along_; }

  /// outer(ix, iy, iz): the node at these lines of the tube's sides, where a column ends.
  [[nodiscard]] WallShell shell(BallPatches const& patches, LayerElements elements,
                                std::function<Index32(int, int, int)> const& outer) const;
  /// Nodes of all columns without their last ones, column after column, as the shell numbers them.
  [[nodiscard]] std::vector<Vec3> nodes() const;

 private:
  /// Where a column begins and ends: distance from the axis and z.
  struct Ring {
    double r = 0, z = 0;
    double elevation = 0;  ///< of the column's first direction over the horizontal plane
  };
  struct Corner {
    int x = 0, y = 0;
  };

  void make_rings(BallOptions const& options);
  [[nodiscard]] Index32 cap_column(int ix, int iy) const { return ix + Index32(counts_.side + 1) * iy; }
  /// Ring 0 is the edge of the cap; rings begin at x max, y min and run counter-clockwise.
  [[nodiscard]] Index32 ring_column(int ring, int at) const;
  [[nodiscard]] Corner corner(int at) const;
  void append_straight(Vec3 const& end, std::vector<Vec3>& nodes) const;
  void append_curved(Ring const& ring, Vec3 const& end, std::vector<Vec3>& nodes) const;

  BallCounts counts_;
  std::vector<double> across_, along_;
  std::vector<Ring> upper_;  ///< rings lower + 1 ... rings()
};

}  // namespace gridmorph::demo
