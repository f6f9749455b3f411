// The sections across all root lines of a mesh, and which one a point lies in.
#pragma once

#include <gridmorph/fillet/root_section.hpp>
#include <gridmorph/geometry/target_tree.hpp>

#include <array>
#include <optional>
#include <unordered_map>
#include <vector>

namespace gridmorph {

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
