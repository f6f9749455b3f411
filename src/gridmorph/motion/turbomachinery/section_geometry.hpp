// Leading edge, trailing edge, chord line and camber of blades and wings along the span, found from their surfaces.
#pragma once

#include <gridmorph/motion/turbomachinery/blade_surface.hpp>
#include <gridmorph/motion/turbomachinery/row_motion.hpp>
#include <gridmorph/motion/turbomachinery/span_table.hpp>

#include <memory>
#include <string>
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
  /// What stitch_blade() takes for the span and the flow.
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

/// A section's chord line in its plane, from leading to trailing edge, and the length of a unit of t there.
struct ChordLine {
  double s = 0, t = 0;  ///< leading edge, t in the units of SectionPoint
  double length = 0;
  double cos_stagger = 1, sin_stagger = 0;  ///< stagger angle: from s towards t
  double scale = 1;
};

/// A point of a section's plane relative to its leading edge: along the chord line and across it, as lengths.
struct ChordPoint {
  double along = 0;
  double across = 0;
};

/// One blade or wing.
///
/// Sections are taken at evenly spaced span fractions from the spanwise grid lines (polynomials through four nodes).
/// The leading and trailing edge of a section are the two points farthest apart, the leading one upstream. Where the
/// surface has corners there (a line in which it turns by more than 50 degrees, an end of an open surface) within a
/// tenth of the chord, the edge is the middle of the corners: one corner of a sharp edge, two of a blunt base.
/// Otherwise it is found between grid lines by a parabola. R, the length of a unit of t, is the mean of the two. Camber
/// is the mean of the two sides, measured across the chord line at equal chord fraction. Between the sections: C1
/// cubics.
class SectionGeometry {
 public:
  /// One line along the span as it lies in the section frame.
  struct Line {
    std::vector<double> span;             ///< strictly increasing
    std::vector<SpanTable::Value> place;  ///< s, t, unit
    bool end = false;                     ///< of an open surface
  };
  /// Lines once around the sections. The second side of an H mesh has been turned onto the first.
  struct Outline {
    std::vector<Line> lines;
    double shift = 0;        ///< t by which some of the lines were moved; 0: none
    bool one_sided = false;  ///< only one side is there: it has a chord line and no camber
  };

  /// Throws MotionError when the lines have no span in common or the sections no length.
  explicit SectionGeometry(Outline outline);

  [[nodiscard]] ChordLine chord_line(double span) const;
  /// Height of the camber line above the chord line at a chord fraction (clamped to 0 ... 1), as a length.
  [[nodiscard]] double camber(double span, double chord_length, double chord_fraction) const;
  [[nodiscard]] bool has_camber() const { return !camber_.empty(); }
  /// Displacements of t of the images of this blade: 0, and the shift of an H mesh's second side.
  [[nodiscard]] std::vector<double> const& images() const { return images_; }

  [[nodiscard]] double first_span() const { return span_lo_; }
  [[nodiscard]] double last_span() const { return span_hi_; }
  /// What was found, for notes: "41 spanwise lines (O), span 0 to 1, chord ... ".
  [[nodiscard]] std::string const& description() const { return description_; }

 private:
  double span_lo_ = 0, span_hi_ = 0;
  int n_sections_ = 0;
  SpanTable edges_;             ///< s and t of the leading edge, s and t of the trailing edge
  SpanTable scales_;            ///< scale
  std::vector<double> camber_;  ///< (n_sections, n_chord) in chords, chord fastest
  std::vector<double> images_;
  std::string description_;
};

/// The blades or wings that the patches of one rule make up. Closed contours and those whose ends lie together are
/// whole; two open ones are the sides of one blade in an H mesh, possibly a pitch apart. Throws MotionError otherwise.
std::vector<SectionGeometry> find_sections(Boundary const& boundary, SectionFrame const& frame,
                                           std::vector<int> const& patches, std::vector<std::string>& notes);

}  // namespace gridmorph
