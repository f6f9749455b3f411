// The wrap: cells of a coarse lattice around the moving walls of an unstructured mesh, or a tube: convex sections
// strung along a straight axis, their centres on a line that need not be straight, the simplest wrap of a wing, a
// blade, a rope.
//
// What lies in it moves with the walls, element layer by element layer; between it and the outer box of the lattice a
// structured background mesh carries the displacement (background.hpp). The wrap is simple on purpose: it walks over
// details of the walls that are smaller than its cells.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/mesh/extent.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/plan/elements/chart.hpp>

#include <array>
#include <cstdint>
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

struct WrapOptions {
  double offset = 0;  ///< every point of the mesh that is closer to a moving wall is wrapped; positive
  /// Coarse cells along the longest extent of the walls, their offset included. Few are best: the steps of a wrap
  /// oblique to the axes send grid lines to different places, and the finer the steps, the steeper the displacement
  /// between those lines. A rod along a space diagonal that turns by 30 degrees keeps all background cells sound with 3
  /// cells, loses 0.3 % with 10.
  int resolution = 4;
  Index max_cells = 2000;  ///< of the lattice; coarser where the resolution asks for more
  double margin = 0;       ///< how far the outer box lies beyond the mesh; more where the wrap would touch it
  /// A tube around walls that are long rather than wide, where one fits and the mesh around it is sound; else (see
  /// Wrap::note) cells of the lattice. Best for walls oblique to the axes: a swept wing, a diagonal rod.
  bool tube = false;
  /// The chart that the lattice is made in, and the sides that end with the mesh: the wrap goes up to these and never
  /// beyond. Absent: x, y and z, all sides open. A tube takes no notice of it.
  std::optional<ChartedDomain> domain{};
};

struct Wrap {
  int dimension = 3;                          ///< 2: one layer of cells in z, from -spacing / 2 to spacing / 2
  double offset = 0;                          ///< WrapOptions::offset
  double spacing = 0;                         ///< largest size of a cell around the walls
  double layer = 0;                           ///< smallest
  ChartedDomain domain;                       ///< planes and boxes are in the coordinates of its chart
  std::array<std::vector<double>, 3> planes;  ///< of the lattice, the outer box included, ascending
  /// Whether the outermost cells of each side, low and high, are cells as any other, since the wrap reaches the end of
  /// the mesh there.
  std::array<std::array<bool, 2>, 3> reaches{};
  std::vector<std::uint8_t> inside;  ///< per cell, i fastest; else never in the outermost cells (of x and y in 2-D)
  std::optional<Tube> tube;          ///< the wrap, instead of cells: then the lattice is one cell, the outer box
  std::string note;                  ///< why it is not the tube that was asked for
  std::vector<std::int32_t> sum;     ///< inside cells below each lattice node: what meets() looks up

  [[nodiscard]] int cells(int axis) const { return int(planes[axis].size()) - 1; }
  [[nodiscard]] Index n_cells() const { return Index(cells(0)) * cells(1) * cells(2); }
  [[nodiscard]] Index cell(Index3 const& c) const { return c[0] + Index(cells(0)) * (c[1] + Index(cells(1)) * c[2]); }
  [[nodiscard]] Index3 index(Index cell) const {
    return {int(cell % cells(0)), int(cell / cells(0) % cells(1)), int(cell / (Index(cells(0)) * cells(1)))};
  }
  /// Whether a cell is inside the wrap; false for what is no cell.
  [[nodiscard]] bool is_inside(Index3 const& c) const {
    for (int a = 0; a < 3; ++a)
      if (c[a] < 0 || c[a] >= cells(a)) return false;
    return inside[cell(c)] != 0;
  }
  /// Whether a cell is one of the outermost, which stay free.
  [[nodiscard]] bool is_outermost(Index3 const& c) const {
    for (std::size_t a = 0; a < std::size_t(dimension); ++a)
      if ((c[a] == 0 && !reaches[a][0]) || (c[a] == cells(int(a)) - 1 && !reaches[a][1])) return true;
    return false;
  }
  /// Whether nodes of a background slide on a side. Where the wrap reaches it they go along: beside them the near field
  /// is not on the surface yet either, what takes it there is the residual of the boundaries, and where one of the two
  /// stops short of that elements between them lose shape.
  [[nodiscard]] bool slides(int axis, int which) const {
    auto const a = std::size_t(axis), s = std::size_t(which);
    return domain.side[a][s] == ChartedDomain::Side::slips && !reaches[a][s];
  }
  [[nodiscard]] LatticeBox box(Index3 const& c) const;
  /// The interval of an axis that holds a coordinate, by bisection; the first or last one beyond the ends.
  [[nodiscard]] int interval(int axis, double coordinate) const;
  /// The cell that holds a point of the chart; beyond the outer box one of the outermost. In 2-D z is not looked at.
  [[nodiscard]] Index3 find(Vec3 const& coordinates) const;
  /// Whether chart coordinates are in the wrap.
  [[nodiscard]] bool holds(Vec3 const& coordinates) const {
    return tube ? tube->contains(coordinates) : is_inside(find(coordinates));
  }
  [[nodiscard]] bool contains(Vec3 const& point) const { return holds(domain.chart(point)); }
  /// Whether any point of a box of the chart is in the wrap, as holds() has it; of a tube see Tube::meets. Constant
  /// cost beyond the bisection.
  [[nodiscard]] bool meets(LatticeBox const& box) const;
  [[nodiscard]] Index n_inside() const { return sum.empty() ? 0 : sum.back(); }
};

/// Wraps moving walls. `walls`: corner nodes of their faces (edges in 2-D). A cell is in the wrap when it comes closer
/// to a wall than the offset (along each axis, so at most sqrt(3) times the offset in the cells' corners); then gaps of
/// one cell are closed, enclosed hollows filled, and cells that touch only along an edge or at a corner joined by their
/// neighbours. Lattice: even spacing where there are walls, offset included; single intervals between walls far apart
/// and out to the outer box. Where the mesh ends on a side of WrapOptions::domain within half a cell, cells go on to
/// that side. Throws MeshError without walls, MotionError without a positive offset. Cost: linear in faces and cells.
Wrap make_wrap(HostInstance const& host, Mesh const& mesh, std::span<CsrGraph const> walls, WrapOptions const& options);

/// What the offset of the wrap depends on; lengths, 0 where unknown.
struct OffsetHints {
  double layer_height = 0;  ///< of the prisms and hexahedra on the moving walls
  double wall_edge = 0;     ///< typical edge length on the moving walls
  double motion = 0;        ///< largest displacement
  double body = 0;          ///< diagonal of the box around the moving walls
  double gap = 0;           ///< smallest distance of moving walls from other boundaries they do not touch
};

/// An offset from the size of things,
///
///     offset = max(layer_height, min(max(2 layer_height, 2 wall_edge, motion / 8, body / 25), room)),
///
/// `room` being room_in_gap(gap, motion), a gap of 0 no limit: the layers move with their wall, a few elements outside
/// them damp details of its motion, and of the way to other boundaries enough is left to take the motion up.
double suggest_offset(OffsetHints const& hints);

/// The cells of the wrap as hexahedra (quadrilaterals in 2-D) with its surface as patch "wrap", to look at.
Mesh wrap_mesh(Wrap const& wrap);

}  // namespace gridmorph

namespace gridmorph::detail {

/// How far the offset goes in chart coordinates, for each wall face in turn: the offset times the length of each
/// coordinate's gradient there. So a point of space that is closer than the offset is so in the chart.
using Reaches = std::vector<std::array<double, 3>>;
Reaches reaches_of(Coordinates const& places, Chart const& chart, std::span<CsrGraph const> walls, double offset);

/// Planes of the lattice and a cell flag for each of its cells, all of them 0. `coordinates`: of all nodes, in the
/// chart.
Wrap make_lattice(Mesh const& mesh, Coordinates const& coordinates, std::span<CsrGraph const> walls,
                  Reaches const& reach, LatticeBox const& domain, WrapOptions const& options);

}  // namespace gridmorph::detail
