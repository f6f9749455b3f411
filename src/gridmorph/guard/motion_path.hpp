// The way of boundary nodes from where they are to where they go.
#pragma once

#include <gridmorph/motion/boundary_conditions.hpp>

#include <vector>

namespace gridmorph {

/// Connected pieces of moving walls that stay in shape, within 1 % of their size, turn on the way as they shift:
///
///   x(s) = from + s (to - from) + R(s) (x - from + s d)
///
/// R(s): the rotation by s times the angle of the rigid motion that fits the piece's best; d: what the displacement is
/// beyond it, turned back.
///
/// All other known nodes go straight.
class MotionPath {
 public:
  /// `displacement` of the known nodes, all the way. Cost: O(known nodes).
  MotionPath(Coordinates const& coordinates, NodeGraph const& graph, BoundaryConditions const& boundary,
             std::vector<Vec3> displacement);

  /// Displacement of the known nodes at share s of the way; s = 1: as it was given, bit for bit.
  [[nodiscard]] std::vector<Vec3> at(double share) const;

 private:
  struct Body {
    Vec3 from, shift, turn;  ///< turn: angle times axis
  };
  struct Follower {
    std::size_t slot;
    int body;
    Vec3 arm, rest;  ///< x - from; d
  };

  void add_body(Coordinates const& coordinates, std::vector<Index32> const& known,
                std::vector<std::size_t> const& slots);

  std::vector<Vec3> displacement_;
  std::vector<Body> bodies_;
  std::vector<Follower> followers_;
};

}  // namespace gridmorph
