// The wakes of blades and wings: what lies behind their trailing edges.
#pragma once

#include <gridmorph/motion/turbomachinery/section_places.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// A point as the wake sees it, in the surface of its section, as lengths there.
struct WakePlace {
  std::optional<RigidTransform>
      image;          ///< the periodic copy of the point that lies in the wake; nothing: the point itself
  double behind = 0;  ///< along the wake from the trailing edge; negative before it
  double across = 0;  ///< off the middle of the wake
  /// The ways from the point to the trailing edge, and to the camber line a tenth of the chord before it: s and t of
  /// SectionPoint.
  std::array<double, 2> to_edge{}, to_camber{};
  double scale = 1;  ///< length of a unit of t
  double chord = 0;  ///< of the section
};

/// The wake of a section begins at its trailing edge and goes straight on in the plane of the section (s, R t): the way
/// the last tenth of the camber line points, or at a given angle from s towards t. So it does not cross span fractions;
/// on a row that turns at constant radius it is the path of free swirl.
class WakePlaces {
 public:
  /// The share of the chord, before the trailing edge, whose camber says where the wake goes, and how it turns.
  static constexpr double last_part = 0.1;

  /// Throws MotionError when the sections cannot be made. Keeps pointers to `surfaces`. Cost O(nodes log nodes).
  WakePlaces(Boundary const& boundary, ResolvedMotion const& motion, SectionsRule const& rule,
             std::vector<int> const& patches, SlipSurfaces const& surfaces, std::optional<double> angle_rad,
             std::vector<std::string>& notes);

  /// The place of that among the point and its periodic copies one pitch to either side which is nearest to the middle
  /// of the wake, reckoned with how far it is before the edge. Cost O(log sections), times blades and copies.
  [[nodiscard]] WakePlace at(Vec3 const& point) const;

  [[nodiscard]] SectionFrame const& frame() const { return places_.frame(); }
  /// What takes a point to its periodic copies one pitch away.
  [[nodiscard]] std::vector<RigidTransform> const& copies() const { return copies_; }

 private:
  [[nodiscard]] WakePlace place(Vec3 const& point) const;

  SectionPlaces places_;
  std::optional<double> angle_rad_;
  std::vector<RigidTransform> copies_;
};

}  // namespace gridmorph
