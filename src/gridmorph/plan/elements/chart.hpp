// Coordinates in which the domain of a mesh is a box, or nearly: what wrap and background mesh are made in.
//
// Three coordinates in a frame: straight (x, y, z); cylindrical about an axis (along it, radius, and angle times a mean
// radius); or those of a disc of radius R about an axis, which becomes the square around it by the elliptical map (M.
// Fong, Analytical methods for squaring the disc, 2014: no pole; only the four corners are singular),
//
//     x = u sqrt(1 - v^2 / 2),   y = v sqrt(1 - u^2 / 2),   (x, y) = place / R, |u|, |v| <= 1,
//
// and along the axis.
//
// Where the domain ends on surfaces rather than planes in such a frame, a coordinate q becomes its share of the way
// between them,
//
//     q' = width (q - low(p)) / (high(p) - low(p)),
//
// p being the chart coordinates before it: radius between hub and case over the axial position, pitch between the sides
// of a passage over axial position and span. low and high are tables, linear between their knots, so both ways are
// explicit and undo one another to round-off. All coordinates are lengths, true ones where the walls are.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// A box along the axes.
struct LatticeBox {
  std::array<double, 3> low{}, high{};
};

struct Chart {
  enum class Frame { straight, cylindrical, disc };
  Frame frame = Frame::straight;
  Vec3 origin;                                          ///< a point on the axis
  Vec3 axis{1, 0, 0}, zero{0, 1, 0}, quarter{0, 0, 1};  ///< right-handed, unit; angles begin at `zero`
  double radius = 1;                                    ///< cylindrical: of which angles are arcs; disc: of its rim

  /// The limits of one coordinate, over the coordinates that come before it in `order`.
  struct Limits {
    std::array<int, 2> over{-1, -1};  ///< coordinates; -1: none
    std::array<double, 2> first{}, step{1, 1};
    std::array<int, 2> knots{1, 1};
    std::vector<double> low, high;  ///< (knots), the first of them fastest
    double width = 1;               ///< of the chart there
  };
  std::array<int, 3> order{0, 1, 2};  ///< limits of a coordinate are over earlier ones
  std::array<std::optional<Limits>, 3> limits;

  [[nodiscard]] bool is_identity() const;
  /// Chart coordinates of a place, and the place of chart coordinates; beyond the tables their ends count.
  [[nodiscard]] Vec3 operator()(Vec3 const& place) const;
  [[nodiscard]] Vec3 place(Vec3 const& coordinates) const;
  /// Chart coordinates of all nodes; the same memory where nothing changes.
  [[nodiscard]] Coordinates mapped(HostInstance const& host, Coordinates const& coordinates) const;
  /// The name of the chart for reports: "box", "box between surfaces", "annular sector", "disc".
  [[nodiscard]] std::string name() const;
};

/// The box that a domain is in its chart, and what its sides are.
struct ChartedDomain {
  enum class Side : std::uint8_t {
    open,    ///< the mesh does not end on it: the background goes a little further where the wrap comes close
    stands,  ///< it ends there, and moves as the boundaries with a rule do
    slips,   ///< there, and nodes slide on it
    free     ///< there, and goes along with the background
  };
  Chart chart;
  LatticeBox box;
  std::array<std::array<Side, 2>, 3> side{};  ///< of each coordinate, low and high

  [[nodiscard]] bool ends(int coordinate, int which) const { return side[coordinate][which] != Side::open; }
};

}  // namespace gridmorph
