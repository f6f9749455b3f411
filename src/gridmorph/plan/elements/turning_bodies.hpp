// Which moving walls turn as a whole: bodies that stand free, or on slip surfaces that they slide along;
// and how much of a body's turn and shift a place makes: all of it at the body, none at other boundaries; turns like
// the logarithm of the distance between, shifts like the distance.
#pragma once

#include <gridmorph/core/host_instance.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/motion/boundary_conditions.hpp>
#include <gridmorph/plan/elements/facet_distance.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace gridmorph {

/// Walls that touch.
struct WallBody {
  std::vector<Index32> faces;    ///< in UnstructuredTopology::boundary
  std::vector<Index32> nodes;    ///< representatives, ascending
  Vec3 axis;                     ///< unit: the only one about which it may turn; zero: any
  std::vector<Index32> ends_on;  ///< slip surfaces, ascending
  bool ends_curved = false;      ///< not all of them are planes
  /// Where it is whole along its axis, as dot(axis, x), if it ends on slip surfaces at both ends; else the first is not
  /// below the second.
  double span[2] = {0, 0};
  [[nodiscard]] bool is_spanned() const { return span[0] < span[1]; }
  /// Whether it ends on boundaries that could not turn with it: given ones, periodic ones, slip surfaces whose normals
  /// point in several directions around it, free ones.
  bool attached = false;
};

/// Boundary faces that do not move with the driving walls.
struct RestingFaces {
  CsrGraph faces;                      ///< given, periodic, slipping; representatives
  std::vector<Index32> slides_on;      ///< per face: number of the slip surface, -1: given or periodic
  std::vector<std::uint8_t> given;     ///< per face: whether all its nodes are displaced by a rule
  std::vector<std::uint8_t> periodic;  ///< per face: whether it is of a free periodic connection
};

struct WallBodies {
  std::vector<WallBody> bodies;
  RestingFaces resting;
};

/// driving_faces: those of moving walls. plane_normal: of a 2-D mesh, about which everything turns there. Serial,
/// linear.
WallBodies find_wall_bodies(Mesh const& mesh, UnstructuredTopology const& topology,
                            BoundaryFacePatches const& face_patches, NodeGraph const& graph,
                            BoundaryConditions const& boundary, std::vector<Index32> const& driving_faces,
                            std::vector<SlipSurface> const& surfaces, Vec3 const& plane_normal);

/// Whether two unit vectors point along one line.
bool are_parallel(Vec3 const& a, Vec3 const& b);

/// Distances of a place.
struct TurnDistances {
  double body = 0;         ///< from the body that turns
  double others = 0;       ///< from all boundaries that do not turn with it; infinite where there are none
  double body_layer = 0;   ///< what turns with the body whole: its columns
  double other_layer = 0;  ///< what stays with the others whole: their columns
  double size = 0;         ///< largest distance of the body's walls from its centre
};

/// The share of a body's turn that a place makes, with d from the end of the columns on the body to the place, D from
/// there to the end of those on the others:
///
///   f = 1 - Q(d / L) / Q(D / L),   Q(s) = log(1 + s) - e log(1 + s / e)
///   e = 0.25 g, 0.02 at least,   L = 0.21 (S^3 F)^(1/4) / sqrt(g),   F = max(W, 8 S),   g = min(1, W / (8 S))
///
/// S the size of the body, W the distance from it plus that from the others. Around a body that turns by a(r) the shear
/// is r da/dr, which is smallest at its worst where it is the same everywhere: a logarithm. Q is one, but for having no
/// slope at its start: Q'(s) = (1 - e) s / ((1 + s) (e + s)). In gaps narrower than the body (g < 1) the turn begins to
/// fade sooner and then evenly: there the shear is that between two walls. Where the way is very short, f is 1 - (d /
/// D)^2. e and L by measurement, on an airfoil in a C mesh, viscous spheres and squares beside one another
/// (docs/unstructured.md). Columns count as a third of the way at most. Continuous in all distances.
double turn_share(TurnDistances const& at);

/// Makes the turn shares of several bodies together, in place: f_b times the product over the other bodies of 1 - 0.4
/// f. Each turns what is around it about its own centre, far from what lies between two of them, where both would add
/// up to more than either wall moves. 0.4 by measurement on squares that turn beside one another.
void share_between(std::span<double> turn_shares);

/// The turn share in narrow surroundings of plane meshes: where the way W is less than 6 S, what a place sees on all
/// sides decides, not what is nearest (Surroundings):
///
///   f = k h + (1 - k) f_log,   h = 0.62 q + 0.38 (3 q^2 - 2 q^3),
///   q = C_b / (C_b + sum of the C of all that does not turn with the body),
///   k = 1 - 3 t^2 + 2 t^3,   t = (W / S - 3) / 3, between 0 and 1
///
/// f_log what the functions above make of it. With C = c / e, c from the lattice and e the exact distance beyond the
/// columns, so that f is 1 and 0 where it has to be. 0.38, 3 and 6 by measurement on squares that turn beside a wall,
/// beside one another and in boxes. closeness: c_b / e_b and the sum of the others'; infinite where e is zero.
double turn_share_in_sight(double body, double others);
/// The share k that what is in sight has in f, to be multiplied by compactness().
double narrowness(double way, double size);
/// How compact a body is: (P / (2 pi S) - 0.7) / 0.15 between 0 and 1, P the perimeter of the body: 1 of circles and
/// squares, 0 of blades (0.64 and somewhat more), whose ends, which move most, little of them is in sight of: a blade
/// in a cascade is better off by distances from 12 degrees on.
double compactness(double perimeter, double size);

/// How much is left of a shift at a share t of the way to where nothing is: 1 - 0.9 t - 0.1 (3 t^2 - 2 t^3).
double faded(double t);

/// How much of each body's shift a place makes:
///
///   s_b = faded(t),   t = g_b / (g_b + D),
///   1 / D = 1 / d + sum over the other bodies k of 1 / g_k,
///   g_b = d_b - l log(1 + d_b / l),   l = min(S_b min(1, W / (8 S_b))^2, 0.1 W (W / m_b - 1))
///
/// d_b the distances from the ends of the columns on the bodies, S_b the sizes of these, d the distance from the
/// others, W the distance from body b plus that from what is nearest else, m_b how far the body shifts, where that is
/// known (`moved`; 0: not). A shift strains what is on its way, so an
/// even fade is best; far from all else without slope beside the body, where cells are small and must not shear;
/// as far as the way that is left allows. By
/// measurement on spheres in outer ones 20 and 60 diameters away and on an airfoil in a C mesh (docs/unstructured.md).
/// All of it where nothing else is there. Continuous in all distances; the sum over bodies is 1 at most.
void shift_shares(std::span<double const> from_bodies, std::span<double const> sizes, std::span<double const> moved,
                  double from_others, std::span<double> shares);

/// A plane that places are seen in.
struct SightPlane {
  Vec3 centre;
  Vec3 u{1, 0, 0}, v{0, 1, 0};  ///< unit, at right angles
};

/// A short piece of a wall in such a plane.
struct SeenPiece {
  Vec3 centre;
  double length;
};

/// The closeness of some walls, each a list of pieces in a plane,
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

  /// plane, size: at the centre of the body, its size there. from: distances from the walls.
  Surroundings(HostInstance const& host, SightPlane const& plane, std::span<std::vector<SeenPiece> const> walls,
               std::span<FacetDistance const> from, double size);

  /// Adds C d / pi of each wall at a place, times a factor; beyond the lattice that of its nearest place.
  void add(Vec3 const& p, double factor, std::span<double> seen) const;

 private:
  struct Source {
    Vec3 at;
    double length, softening;  ///< where r is below it, edges between sources would be missed
  };

  [[nodiscard]] std::vector<Source> sources(std::vector<SeenPiece> const& wall) const;

  SightPlane plane_;
  double size_;
  std::vector<double> planes_;  ///< of both axes, from the centre
  std::vector<double> seen_;    ///< walls fastest, then x, y
  std::size_t n_walls_;
};

/// The moves from the places of a mesh to those of its images: the identity, then the transforms of its free periodic
/// connections and their inverses, each up to `passages` times. Those that come out alike, as behind the last passage
/// of a wheel, once. Transforms are fitted to the nodes, as those of BoundaryConditions::images are. Cost O(nodes of
/// the connections).
std::vector<RigidTransform> periodic_moves(HostInstance const& host, Mesh const& mesh, NodeGraph const& graph,
                                           BoundaryConditions const& boundary, int passages);

}  // namespace gridmorph
