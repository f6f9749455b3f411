// Root lines cut across at their places: walls, ball, and how layers meet; all such sections of a mesh, and which one a
// point lies in.
#pragma once

#include <gridmorph/fillet/mitre_path.hpp>
#include <gridmorph/geometry/facet_surface.hpp>
#include <gridmorph/geometry/target_tree.hpp>

#include <array>
#include <optional>
#include <unordered_map>
#include <vector>

namespace gridmorph {

struct WallPoint {
  Vec3 point;   ///< from the corner
  Vec3 normal;  ///< unit, into the mesh
};

/// A wall cut across a root line: points and normals over the distance along it from the corner.
class WallProfile {
 public:
  WallProfile() = default;
  /// The profile along the surface, in the plane across `across`, from `root` in the direction `up`; `normal`: into the
  /// mesh at `root`, in the plane; all unit. Normals are those of the profile in its plane. Beyond rims it goes on in
  /// the tangent plane. Cost: some hundred feet.
  WallProfile(FacetSurface const& surface, Vec3 const& root, Vec3 const& across, Vec3 const& up, Vec3 const& normal,
              double length);

  [[nodiscard]] double length() const { return step_ * double(points_.size() - 1); }
  /// The point at a length along the profile; straight on beyond the end.
  [[nodiscard]] WallPoint at(double s) const;
  [[nodiscard]] std::vector<WallPoint> const& points() const { return points_; }
  /// How far along the profile its point nearest to p is; p from the corner. Cost O(points).
  [[nodiscard]] double nearest(Vec3 const& p) const;

 private:
  double step_ = 1;
  std::vector<WallPoint> points_;
};

/// A circle in the plane of two profiles, from the corner.
struct SectionCircle {
  Vec3 centre;
  Vec3 to_middle;  ///< of its arc, unit
  double half_angle_rad = 0;
  std::array<double, 2> contact{0, 0};  ///< along the profiles
};

/// The first circle of a radius that touches both profiles, c(s) = p(s) + r n(s) off the first at the distance r from
/// the second, s by bisection; nothing where there is none before the end.
std::optional<SectionCircle> circle_between(WallProfile const& first, WallProfile const& second, double radius);

/// A point between the walls by how far it is from them. Lengths.
struct CornerPoint {
  std::array<double, 2> off;    ///< from the blade, from the end wall
  std::array<double, 2> along;  ///< the same point along each wall from the corner
};

/// A relation y over x in straight pieces from (0, 0), both ascending, on with slope 1.
class Relation {
 public:
  /// Adds a point of the relation; nothing where that would not ascend.
  void add(double x, double y);
  [[nodiscard]] double operator()(double x) const;

 private:
  std::vector<double> x_{0}, y_{0};
};

/// How layers of the two walls meet, from the places x off the blade and y off the end wall that find_mitre() chose.
/// Where layers are as high on both walls, all relations say x = x.
///
/// The mitre's height there is about the smaller distance, g = ((x^-2 + y^-2) / 2)^(-1/2). The farther off the walls,
/// the less that counts: from 1.4 radii on places stay what they are.
class MitreRelations {
 public:
  MitreRelations() = default;
  MitreRelations(std::vector<MitrePlace> const& places, std::vector<std::array<double, 2>> const& off, double radius);

  /// The relation of a wall between the distance of a layer from it and its distance from the new wall in the mitre,
  /// where lines of the other wall come to its first place and where it leaves its last one: a layer may have several.
  [[nodiscard]] Relation const& first(int wall) const { return first_[wall]; }
  [[nodiscard]] Relation const& last(int wall) const { return last_[wall]; }
  /// The relation of a wall between the distance of a line from the other wall and where it begins on the new wall.
  [[nodiscard]] Relation const& start(int wall) const { return start_[wall]; }

 private:
  std::array<Relation, 2> first_, last_, start_;
};

/// A root line cut across at one of its places.
struct RootSection {
  Vec3 root;
  Vec3 along;            ///< the line, unit
  Vec3 across;           ///< the section, unit: the line, leaning as edges of the blade lean
  double angle_rad = 0;  ///< between the walls
  Vec3 blade_normal;     ///< at the root, unit, into the mesh
  std::array<WallProfile, 2> wall;
  double radius = 0;  ///< 0: sharp
  Vec3 centre;        ///< of the ball, from the root
  Vec3 to_middle;     ///< from there to the middle of the arc, unit
  double half_arc = 0;
  std::array<double, 2> contact{0, 0};  ///< along the walls
  double reach = 0;                     ///< along the walls, from which on nothing moves
  MitreRelations mitre;
};

/// Where a point of the sharp corner goes.
struct CornerMove {
  Vec3 shift;
  int wall = 0;          ///< the one it belongs to
  bool on_arc = false;   ///< whether its foot on the new wall is on the arc
  double arc_share = 0;  ///< of the half arc, where its foot is
  double start = 1;      ///< how much nearer to the corner its line begins than before
  double bend = 0;       ///< 0 on the wall, 1 in the mitre
  double still = 1;      ///< 1: too far from the new wall to move
};

/// What lies between two sections, `share` of the way from one to the other. Refers to them.
class BetweenSections {
 public:
  BetweenSections(RootSection const& a, RootSection const& b, double share) : a_(a), b_(b), share_(share) {}

  [[nodiscard]] Vec3 root() const { return mean(a_.root, b_.root); }
  [[nodiscard]] Vec3 across() const;
  [[nodiscard]] double radius() const { return mean(a_.radius, b_.radius); }
  [[nodiscard]] double reach() const { return mean(a_.reach, b_.reach); }

  [[nodiscard]] CornerPoint point(std::array<double, 2> const& off) const;
  /// The move of a node at `at`; `in_mitre`: find_mitre() chose it. It keeps what it is beside the section, less the
  /// nearer it comes to the mitre.
  [[nodiscard]] CornerMove move(Vec3 const& at, CornerPoint const& p, bool in_mitre) const;
  /// The place on the fillet beside a point: the point of the arc's tube nearest to it across the corner.
  [[nodiscard]] Vec3 on_arc(Vec3 const& p, int wall, double arc_share) const;
  /// The corner's new place.
  [[nodiscard]] Vec3 middle() const;

 private:
  [[nodiscard]] double mean(double a, double b) const { return a + share_ * (b - a); }
  [[nodiscard]] Vec3 mean(Vec3 const& a, Vec3 const& b) const { return a + share_ * (b - a); }
  /// The direction between two vectors, as long as the mean of their lengths.
  [[nodiscard]] Vec3 turned(Vec3 const& a, Vec3 const& b) const;
  [[nodiscard]] WallPoint wall_at(int w, double s) const;
  struct Arc {
    Vec3 centre, outwards;
  };
  [[nodiscard]] Arc arc(int w, double share) const;

  RootSection const &a_, &b_;
  double share_;
};

/// Distance of a point from a wall where it has this foot; beyond a rim from the tangent plane there.
double off_wall(kernels::FacetFoot const& foot, Vec3 const& p);
/// Distances of a point from two walls.
std::array<double, 2> off_walls(std::array<FacetSurface const*, 2> const& walls, Vec3 const& p);

/// A point's section: between two of a line.
struct SectionPlace {
  std::size_t line = 0, first = 0, second = 0;
  double share = 0;
};

/// What is known of places of the mesh that belong to a place of a line: those of the mitre, and the first ones off a
/// line to be cut.
struct KnownPlace {
  SectionPlace section;
  bool in_mitre = false;
};

/// All sections along all root lines, and which one a point lies in.
class RootSections {
 public:
  /// Throws MotionError for a radius that does not fit, with one that would.
  RootSections(JoinedElements const& elements, BoundaryFacePatches const& face_patches, WallEdges const& edges,
               std::vector<RootLine> const& lines, std::vector<Mitre> const& mitres,
               std::vector<std::vector<double>> const& radii, FacetSurface const& blade, FacetSurface const& end_wall);

  [[nodiscard]] double largest_reach() const { return largest_reach_; }
  [[nodiscard]] BetweenSections between(SectionPlace const& at) const {
    return {sections_[at.line][at.first], sections_[at.line][at.second], at.share};
  }
  /// The section whose plane across the line a point lies in, of those nearby whose blade looks about the same way
  /// (`blade_normal`: off the blade where the point is, unit, or zero), the last one beyond an end; nothing farther
  /// than `within` from all lines. Cost O(log places).
  [[nodiscard]] std::optional<SectionPlace> find(Vec3 const& p, Vec3 const& blade_normal, double within) const;
  /// What is known of a place; null: nothing.
  [[nodiscard]] KnownPlace const* known(Index32 place) const;
  [[nodiscard]] std::vector<std::vector<RootSection>> const& all() const { return sections_; }

 private:
  struct Segment {
    std::size_t line, first, second;
  };
  [[nodiscard]] std::optional<SectionPlace> nearest_section(Vec3 const& p, Vec3 const& blade_normal,
                                                            double within) const;
  [[nodiscard]] bool beyond_end(SectionPlace const& at, Vec3 const& p) const;
  [[nodiscard]] Segment next(Segment const& of, int step) const;
  [[nodiscard]] double ahead(Vec3 const& p, std::size_t line, std::size_t section) const;
  void limit_reach(JoinedElements const& elements, BoundaryFacePatches const& face_patches, WallEdges const& edges,
                   std::vector<std::vector<double>> const& radii);

  std::vector<RootLine> const& lines_;
  std::vector<std::vector<RootSection>> sections_;  ///< per line and place
  std::vector<Segment> segments_;
  TargetTree tree_;  ///< the segments, as triangles without area
  std::unordered_map<Index32, KnownPlace> known_;
  double largest_reach_ = 0;
};

}  // namespace gridmorph
