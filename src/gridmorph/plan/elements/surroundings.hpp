// What a place near a body of a plane mesh sees of the walls around it: how close they are on all sides, not only where
// they are nearest.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/plan/elements/facet_distance.hpp>

#include <span>
#include <vector>

namespace gridmorph {

/// The closeness of some walls, each a list of edges in a plane z = constant,
///
///   C(x) = integral along the wall of ds / |y - x|^2
///
/// which beside a straight wall is pi / d and around corners follows what is in sight: an edge at height h fills the
/// angle h ds / r^2. C d / pi, d the exact distance from the wall, is kept on a lattice around the body, fine beside it
/// and growing outwards, and linear between its nodes; so C is singular where it should be, and continuous in the place
/// and in the walls: edges are deposited with bilinear weights on lattices of 0.05 of the body's size, and of twice as
/// much each time they are twice as far from it.
///
/// Cost: sources (about a thousand) times nodes of the lattice (12 thousand), 10 flops each, on all cores; 8 bytes per
/// node and wall.
class Surroundings {
 public:
  /// How far the lattice reaches beyond the centre of the body, in sizes of it.
  static constexpr double reach = 6;

  /// centre, size: of the body. from: distances from the walls.
  Surroundings(HostInstance const& host, Coordinates const& coordinates, std::span<CsrGraph const> walls,
               std::span<FacetDistance const> from, Vec3 const& centre, double size);

  /// Evaluates C d / pi of each wall at a place; beyond the lattice that of its nearest place.
  void operator()(Vec3 const& p, std::span<double> seen) const;

 private:
  struct Source {
    Vec3 at;
    double length, softening;  ///< where r is below it, edges between sources would be missed
  };

  [[nodiscard]] std::vector<Source> sources(Coordinates const& coordinates, CsrGraph const& edges) const;

  Vec3 centre_;
  double size_;
  std::vector<double> planes_;  ///< of both axes, from the centre
  std::vector<double> seen_;    ///< walls fastest, then x, y
  std::size_t n_walls_;
};

}  // namespace gridmorph
