// The lattice around the generated aircraft, and which of its cells are bodies. Internal to it.
#pragma once

#include <gridmorph/core/index.hpp>
#include <gridmorph/kernels/vec3.hpp>

#include <array>
#include <vector>

namespace gridmorph::aircraft {

enum class Part { none, fuselage, wing, htail, vtail, nacelle };

/// Planes of the lattice, named by what they pass.
enum PlaneI {
  i_front,
  i_nose,
  i_shoulder,
  i_nacelle,
  i_leading,
  i_hinge,
  i_trailing,
  i_tail_leading,
  i_tail_trailing,
  i_end,
  i_back
};
enum PlaneJ { j_symmetry, j_fin, j_side, j_nacelle_in, j_nacelle_out, j_aileron, j_tip_begin, j_tip, j_far };
enum PlaneK {
  k_low,
  k_nacelle,
  k_belly,
  k_wing_lower,
  k_wing_upper,
  k_tail_lower,
  k_tail_upper,
  k_crown,
  k_fin_tip,
  k_high
};

/// Planes by their numbers above, nodes by (i, j, k) through the whole lattice. Cells of the lattice are slabs of
/// planes.
struct Lattice {
  std::array<std::vector<int>, 3> plane;  ///< node at each plane
  std::array<std::vector<int>, 3>
      slab;  ///< of each node; of nodes on a plane the one that begins there, or the last one
  std::array<std::vector<double>, 3> share;  ///< of its slab at each node
  int layers = 0;                            ///< cells between body and lattice

  /// Cells as for a mesh of half a million nodes, times `scale` in each direction.
  explicit Lattice(double scale);

  [[nodiscard]] Index3 extent() const { return {int(slab[0].size()), int(slab[1].size()), int(slab[2].size())}; }
  [[nodiscard]] Index number(Index3 const& p) const {
    return p[0] + Index(extent()[0]) * (p[1] + Index(extent()[1]) * p[2]);
  }
  /// Linear between the corners of the cell.
  [[nodiscard]] Vec3 position(Index3 const& p) const;
  /// Nodes of cells from slab `from` to before slab `to`.
  [[nodiscard]] IndexRange nodes(Index3 const& from, Index3 const& to) const;
};

/// In slabs where a lifting surface ends: how many of n cells, the last ones, are beside the rounding of its tip, and
/// where they begin.
[[nodiscard]] constexpr int tip_cells(int n) { return n < 3 ? 1 : n / 3; }
constexpr double wing_tip_begin = 0.65, htail_tip_begin = 0.845, vtail_tip_begin = 0.9;

/// Which body takes the place of a cell of the lattice; cells outside the lattice have none.
[[nodiscard]] Part body(Index3 const& cell);

}  // namespace gridmorph::aircraft
