// Branch and bound over the designs of one cell: is it valid in all of them, and where is it not? Internal to the
// quality part; on the host, of the few cells that kernels::screen_design_cell() leaves open.
#pragma once

#include <gridmorph/kernels/design_cell.hpp>

#include <vector>

namespace gridmorph::detail {

/// A cell with corners x + sum of t_i modes[i].
struct DesignCell {
  kernels::ElementType type = kernels::ElementType::hexahedron;
  double sign = 1;
  Vec3 plane_normal;
  kernels::ElementCorners x;
  std::vector<kernels::ElementCorners> modes;
  double deviation = 0;  ///< what coordinates may be wrong by [length]

  [[nodiscard]] kernels::ElementCorners corners(std::vector<double> const& t) const;
  /// The sign that the certificate gives to a design.
  [[nodiscard]] kernels::JacobianSign sign_at(std::vector<double> const& t) const;
  [[nodiscard]] bool broken_at(std::vector<double> const& t) const {
    return sign_at(t) >= kernels::JacobianSign::negative;
  }
};

/// A design in which a cell is inverted; empty t: none was found. scale: largest |t_i|.
struct BrokenCell {
  double scale = kernels::unbounded;
  std::vector<double> t;

  [[nodiscard]] bool found() const { return !t.empty(); }
};

/// Looks for the smallest box |t_i| <= scale <= limit with a design that breaks the cell: from the corner to which the
/// slopes of its smallest coefficient point, along the ray from the centre, and on to the corners to which the slopes
/// point from there. Cost: some 200 signs of the certificate.
BrokenCell look_for_broken_design(DesignCell const& cell, double limit);

struct DesignAnswer {
  enum class Kind { valid, broken, undecided } kind = Kind::undecided;
  BrokenCell broken;
  int pieces = 0;  ///< that the box and the cell were cut into
};

/// Whether the cell is valid in all designs |t_i| <= scale.
///
/// Over a box of half widths h about its own centre, a coefficient b is not smaller than at the corners of the box,
/// less what it may sag between them: along t_i, where b'' <= 2 k, by k (h - |b'| / 2k)^2 while the slope b' is below 2
/// k h, and by nothing where it is not. At corners b is computed from the corners of the design. Not at all 2^n of
/// them: parameters are set to +-h one after another, the most influential first, and what those that are still at
/// their centre can do at most, sum of h |b'|, cuts off the branches in which b stays positive. Bounds of slopes over
/// the box are exact slopes at its centre and permanents for their changes (kernels/design_cell.hpp). Where this does
/// not tell, the box is halved along the parameter by which b sags most, or the cell where it is not valid by its
/// coefficients but by its values; at most `most_pieces` pieces.
///
/// Cost: 6 n permanents, n slopes and as many bends per piece; an evaluation of the coefficients (600 flops) per
/// branch, tens to hundreds of 2^n.
DesignAnswer search_designs(DesignCell const& cell, double scale, int most_pieces);

}  // namespace gridmorph::detail
