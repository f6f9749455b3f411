// Multi-block meshes made in memory: every kind of topology that real files have, small.
//
// Most are made of bricks: index boxes of one big index box whose nodes sit at position(u, v, w), (u, v, w) in [0,
// 1]^3. Brick faces that meet are joined; opposite faces of the big box may close on themselves (O-grids) or be
// periodic. Interfaces are stored from one side only; scramble() adds the other side here and there.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph::test {

/// A smooth random map of the unit cube onto itself that keeps its faces and has period 1 in every parameter.
class Distortion {
 public:
  explicit Distortion(unsigned seed, double amplitude = 0.3);
  Vec3 operator()(Vec3 const& uvw) const;

 private:
  double amplitude_;
  std::array<double, 9> phase_{};
};

/// All nodes of a zone, [0, extent).
inline IndexRange whole(Zone const& zone) { return {{0, 0, 0}, zone.extent}; }
/// Nodes of one face of a box of nodes.
IndexRange face_of(IndexRange const& box, int axis, int side);
/// The axis along which a face range has one node.
int face_axis(IndexRange const& range);

/// Adds to a mesh.
class MeshBuilder {
 public:
  explicit MeshBuilder(std::string source) { mesh_.source = std::move(source); }
  int zone(std::string name, Index3 extent, std::function<Vec3(Index3 const&)> position);
  void patch(std::string const& family, PatchKind kind, int zone, IndexRange const& range);
  void patch(std::string const& family, PatchKind kind, int zone, int axis, int side);
  /// Joins two face ranges. `across` says how the tangential axes and their senses correspond; the sense along the
  /// normal follows from the two sides.
  void join(int zone, IndexRange const& range, int donor_zone, IndexRange const& donor_range, Orientation across = {},
            std::optional<Periodic> const& periodic = std::nullopt);
  Mesh finish();
  [[nodiscard]] Mesh const& mesh() const { return mesh_; }

 private:
  Mesh mesh_;
  std::vector<std::function<Vec3(Index3 const&)>> position_;
};

/// How the two opposite faces of the big box along one axis are connected, if they are.
struct Ends {
  enum class Kind { none, closed, periodic } kind = Kind::none;
  Periodic periodic;  ///< from the upper face (parameter 1) to the lower face (parameter 0)
};

struct Bricks {
  std::string name;
  Index3 extent{};                ///< nodes of the big box
  std::vector<IndexRange> zones;  ///< boxes of nodes, bounding planes included; all of it when empty
  std::function<Vec3(Vec3 const&)> position;
  std::array<Ends, 3> ends{};
  /// Family and kind of the six outer faces u_min, u_max, v_min, ...; faces inside the big box with no brick beyond
  /// them are walls of family "step".
  std::array<std::string, 6> family{"u_min", "u_max", "v_min", "v_max", "w_min", "w_max"};
  std::array<PatchKind, 6> kind{PatchKind::wall,    PatchKind::inflow,   PatchKind::outflow,
                                PatchKind::outflow, PatchKind::farfield, PatchKind::farfield};
};
Mesh make(Bricks const& bricks);

Periodic rotation(Vec3 const& center, Vec3 const& unit_axis, double angle_rad);

/// One zone; straight: a uniform 2 x 1 x 1.2 box, otherwise sheared, curved and distorted.
enum class Shape { straight, curved };
Mesh box(Index3 extent, Shape shape, unsigned seed);
/// Five curved bricks that meet at T-junctions: faces with two neighbours, cuts that travel.
Mesh bricks_with_t_junctions(unsigned seed);
/// Three bricks around a concave edge.
Mesh l_shape(unsigned seed);
/// The middle brick of a 3 x 3 arrangement left out: a wall with blocks all round (family "step").
Mesh around_a_box(unsigned seed);
/// Annulus sector, w around the axis (arbitrary line), v from inner to outer radius, u along the axis. Families hub,
/// case, inlet, outlet. inner_radius 0: a wedge whose v_min face (family "pole") is collapsed onto the axis.
struct Sector {
  Vec3 origin{0.3, -0.2, 0.5};
  Vec3 axis{1, 2, -0.5};  ///< any length
  int copies = 9;         ///< in the full wheel
  double inner_radius = 1;
  bool single_precision_angle = true;  ///< the declared angle is rounded as in files
};
Mesh annulus_sector(Sector const& sector, unsigned seed);
/// Position of the sector's mesh for cylindrical coordinates about its axis.
Vec3 sector_position(Sector const& sector, double axial, double radius, double theta);
/// Axial, radius, theta about the sector's axis.
Vec3 sector_coordinates(Sector const& sector, Vec3 const& p);
/// Annulus sector of the same axis and families whose flow path turns from axial to radial: hub and case are quarter
/// circles about one centre in the meridional plane.
Mesh bend_sector(Sector const& sector, unsigned seed);
/// O-grid: one zone whose ends in u meet, wall (family "body") at v_min, farfield at v_max; inner_radius 0: a pole
/// line.
Mesh o_grid(double inner_radius, unsigned seed);
/// C-grid around a body with a blunt nose; the wake is an interface of the zone with itself, the wall a part of j_min.
Mesh c_grid(unsigned seed);
/// n zones around one inner edge (3 or 5: irregular), extruded; family "rim" outside, "front" and "back".
Mesh star(int n, unsigned seed);
/// One of those n zones, its two radial faces periodic with one another: the inner edge (the z axis) maps onto itself.
Mesh star_sector(int n, unsigned seed);
/// Periodic by translation along w, or along v and w.
Mesh translational(int directions, unsigned seed);

}  // namespace gridmorph::test
