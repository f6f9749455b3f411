// How much of a body's motion is a stretch that it makes as a whole, and the tables that the stretch is summed by.
#pragma once

#include <gridmorph/kernels/body_stretch.hpp>

namespace gridmorph {

/// The stretch of one body (kernels/body_stretch.hpp): E, and the share q of it that the body makes as a whole,
///
///   q = 3 t^2 - 2 t^3,   t = (e - 0.5) / 0.4 between 0 and 1,   e = 1 - sum of w |v - E v_0|^2 / sum of w |v|^2
///
/// where v is what the body's turn and shift leave of the displacement, seen from the turned body, E the best linear
/// map by least squares and v_0 the places: e is how much of what is left is a stretch. Where half of it is something
/// else (a flap, a bump), what goes with the body far from its walls does more harm than good. Along a principal axis
/// on which the body extends by less than 0.03 of the longest one the stretch fades, by 0.01 there is none: what
/// thickens a plate moves little, and must not move all around it. By measurement on an airfoil and an ellipsoid
/// (docs/unstructured.md).
///
/// Evenly: what the body grows by in all directions alike, where that is nearly all that is left (t = (e - 0.8) /
/// 0.15): least squares carry the rest, but would let elements around a body that grows become flat.
///
/// Calls in this order: add_place() for all wall nodes, find_axes(), add_displacement() for all, fit(), add_rest() for
/// all, decide(). w: their shares in the area of the body; arms: from its centre.
class BodyStretch {
 public:
  /// axis: that about which alone the body may turn, whose planes it stretches in; zero: any. whole: its rotation.
  BodyStretch(Vec3 const& axis, kernels::Quaternion<Vec3> const& whole, bool evenly) : axis_(axis), whole_(whole) {
    limits_.even = evenly;
  }

  void add_place(double w, Vec3 const& arm);
  void find_axes();
  [[nodiscard]] Vec3 lever(double w, Vec3 const& arm) const;
  void add_displacement(Vec3 const& u, Vec3 const& lever) { moments_of_u_.add(u, lever); }
  void fit();
  /// u: less the shift of the body.
  void add_rest(double w, Vec3 const& arm, Vec3 const& u);
  /// size: of the body; what is below 1e-12 of it is rounding and counts as none.
  void decide(double size);
  [[nodiscard]] kernels::StretchLimits const& limits() const { return limits_; }
  /// What turn and shift leave of displacements, at most; 0 below 1e-6 of the size, which the rounding of data in
  /// single precision may be.
  [[nodiscard]] double largest_rest() const { return largest_rest_; }
  /// What the turn and the stretch as a whole leave of a displacement.
  [[nodiscard]] Vec3 rest(Vec3 const& arm, Vec3 const& u) const;

 private:
  Vec3 axis_;
  kernels::Quaternion<Vec3> whole_;
  double moments_[3][3] = {}, inverse_[3][3] = {};  ///< M, M^-1
  kernels::StretchLimits limits_{{}, 1};
  kernels::StretchMap moments_of_u_, stretch_;
  double before_ = 0, after_ = 0, largest_rest_ = 0;
};

}  // namespace gridmorph
