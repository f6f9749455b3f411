// A tube: convex sections strung along a straight axis, their centres on a line that need not be straight. The simplest
// wrap of a wing, a blade, a rope.
#pragma once

#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/plan/elements/chart.hpp>

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gridmorph {

/// Sections lie in planes across the axis. Between two of them the tube is ruled: the points of their rings are joined
/// by straight lines, neighbouring lines by bilinear faces. Both ends are flat.
struct Tube {
  int box_axis = 2;  ///< coordinate axis nearest to the tube's
  Vec3 u, v, axis;   ///< right-handed, orthonormal; u near coordinate axis box_axis + 1
  int around = 0;    ///< points of a ring, a multiple of 4; ring point 0 lies towards -u -v, the next ones towards u
  /// Symmetric matrix (uu, uv, vv) that makes sections about round: the rings' points lie at equal angles after it.
  std::array<double, 3> rounding{1, 0, 1};
  std::vector<double> station;  ///< position of each section along the axis, ascending
  std::vector<Vec3> centre;     ///< of each section
  std::vector<Vec3> ring;       ///< (sections, around)

  [[nodiscard]] int sections() const { return int(station.size()); }
  [[nodiscard]] Vec3 const& point(int section, int k) const {
    return ring[std::size_t(section) * std::size_t(around) + std::size_t(k % around)];
  }
  [[nodiscard]] double length() const { return station.back() - station.front(); }
  /// Largest distance of a ring point from its section's centre.
  [[nodiscard]] double largest_radius() const;
  [[nodiscard]] bool contains(Vec3 const& point) const;
  /// Whether a box meets the tube: looks at 27 points of the box, and for boxes that these miss at the rings' points.
  [[nodiscard]] bool meets(LatticeBox const& box) const;
};

/// Fits a tube around walls: along their principal axis, sections with the convex hull of the walls near them, made
/// larger by the offset and smooth along the axis. Hollows and details of the sections go; all wall nodes are inside.
/// Nothing, and the reason in `note`, where the walls are less than 1.25 times as long as wide or leave gaps along
/// their axis. Linear cost.
std::optional<Tube> fit_tube(Mesh const& mesh, std::span<CsrGraph const> walls, double offset, std::string& note);

}  // namespace gridmorph
