// Fillets between blades and end walls, in meshes of blocks: from a sharp corner to a round one, with blocks that suit
// it.
#pragma once

#include <gridmorph/fillet/split_mesh.hpp>

#include <functional>
#include <string>
#include <vector>

namespace gridmorph {

struct FilletOptions {
  std::vector<int> blade, end_wall;  ///< patches
  /// The radius of the ball that rolls along the corner, at a point of it [length]; 0: the corner stays sharp there.
  std::function<double(Vec3 const& corner)> radius;
  /// Layers of cells off the blade and off the end wall that the corner takes; 0: as many as reach the mean
  /// radius and 0.6 of it.
  std::array<int, 2> layers{0, 0};
  /// Where a blade ends inside of the mesh (the edges of H meshes), the fillet runs out: over this many radii before
  /// the end.
  double run_out = 8;
};

/// What is said of a fillet, whatever the mesh.
struct FilletFacts {
  SheetLayers layers;
  int stations = 0;                                ///< nodes of the corner that have a ball
  double smallest_radius = 0, largest_radius = 0;  ///< at these [length]
  double arc_angle_deg[2] = {0, 0};                ///< smallest and largest of their arcs
  int open_ends = 0;                               ///< nodes at which a fillet runs out

  /// Takes one more node of the corner into account.
  void add_station(double radius, double half_angle_rad);
};

struct FilletResult : FilletFacts {
  SplitMesh split;  ///< its mesh has coordinates
  double wall_deviation =
      0;  ///< largest distance of moved wall nodes off the arcs from the walls as they were [length]
  bool first_cells_kept = true;  ///< off both walls; otherwise those of the wall with fewer layers became smaller
};

/// The mesh with a fillet along all corners of `blade` with `end_wall`.
///
/// The corners lose their blocks (split_corners()), and the layers along both walls meet in a mitre instead. Nodes of
/// the walls go along their grid lines, by arc length (CornerStation); layers near the corner are laid anew between
/// wall and their own far side, which stays: with P the cubic with the normal of the wall at its foot, f the share of
/// its length and g the share of the corner in the line,
///
///     x = P_new(f_new) + (1 - g) (x_old - P_old(f_old)),
///
/// f_new such that the first cell keeps its height. Beyond the reach of the corner, four times the layers or three
/// radii, nodes stay as they are, bit for bit, unless their layers are counted anew.
///
/// Throws MeshError for walls that do not meet (find_wall_sheets()) and zones with too few cells, MotionError for a
/// radius that does not fit, with the largest that would. Cost O(nodes), and O(log facets) for the wall nodes near the
/// corner.
FilletResult make_fillet(Mesh const& mesh, Links const& links, FilletOptions const& options);

}  // namespace gridmorph
