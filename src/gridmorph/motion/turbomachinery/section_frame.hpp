// The surfaces that airfoil sections lie on, and their plane coordinates.
#pragma once

#include <gridmorph/motion/turbomachinery/blade_surface.hpp>
#include <gridmorph/motion/turbomachinery/row_motion.hpp>

#include <memory>
#include <vector>

namespace gridmorph {

/// Where a point of a blade or wing is: on which section, and where in it. The plane of a section has the coordinates
/// (s, R t): s along the flow, R the length of a unit of t, which has one value per section.
struct SectionPoint {
  double span = 0;
  double s = 0;
  double t = 0;
  double unit = 1;  ///< length of a unit of t at the point itself
};

/// Splits space into sections. Points that are equal get equal coordinates; copies turned about the axis differ in t
/// alone.
class SectionFrame {
 public:
  virtual ~SectionFrame() = default;

  [[nodiscard]] virtual SectionPoint at(Vec3 const& point) const = 0;
  /// The displacement of a point within its section surface by ds and dt. Exactly zero for zero.
  [[nodiscard]] virtual Vec3 displacement(Vec3 const& point, double ds, double dt) const = 0;
  /// A displacement at one point as it is at another: of a wing the same, of a blade the same along and across the flow
  /// path and about the axis.
  [[nodiscard]] virtual Vec3 carried(Vec3 const& from, Vec3 const& displacement, Vec3 const& to) const = 0;
  /// Length from span fraction 0 to 1: the mean over the nodes.
  [[nodiscard]] virtual double height() const = 0;
  /// What t is periodic in; 0 when it is not.
  [[nodiscard]] virtual double period() const = 0;
  /// The angle or length of t that tells two lines apart.
  [[nodiscard]] virtual double scale_of_t() const { return period(); }
  /// What stitch_blade() takes for the span, the flow and the motion of nodes.
  [[nodiscard]] virtual BladeInput stitching() const = 0;
};

/// Sections at constant span fraction between hub and case: s is the axial position, t the angle about the axis, or the
/// position along the pitch of a linear cascade.
std::unique_ptr<SectionFrame> blade_frame(Boundary const& boundary, ResolvedMotion const& motion,
                                          SlipSurfaces const& surfaces, std::vector<int> const& blades);

/// Plane sections across the span direction of a wing: s along the flow, t = span x s. The span direction is the
/// rule's; without one the normal of a plane mesh, else of the symmetry plane the wing stands on, without that its
/// longest extent. Throws MotionError when the flow runs along the span.
std::unique_ptr<SectionFrame> wing_frame(Boundary const& boundary, SectionsRule const& rule,
                                         std::vector<int> const& patches);

}  // namespace gridmorph
