// How the passages of a row stand beside each other: round the machine axis, or along a straight line.
#pragma once

#include <gridmorph/geometry/rigid_transform.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/wheel/turn.hpp>

#include <cmath>

namespace gridmorph {

/// Some pitches of a row: a turn about its axis, or a shift. No pitch gives back a point bit for bit.
class Pitches {
 public:
  explicit Pitches(Turn const& turn) : turn_(turn) {}
  explicit Pitches(Vec3 const& shift) : shift_(shift), shifts_(norm(shift) > 0) {}

  [[nodiscard]] Vec3 operator()(Vec3 const& x) const { return shifts_ ? x + shift_ : turn_(x); }

 private:
  Turn turn_{Axis{}, 0, 1};
  Vec3 shift_;
  bool shifts_ = false;
};

/// Where a point lies in its row. Points that differ in `along` alone are at the same place of different passages, or
/// beside each other.
struct PlaceInRow {
  double first, second;  ///< wheel: axial position and radius; straight row:
                         ///< across the pitch [length]
  double along;          ///< in pitches, from anywhere
};

/// What takes a passage onto the next one of its row.
class RowPitch {
 public:
  /// Zones that stand alone.
  RowPitch() = default;
  /// A turn by 360 degrees / passages, right-handed about the axis.
  RowPitch(Axis const& axis, int passages) : axis_(axis), passages_(passages) { set_directions(axis.direction); }
  /// A straight row. Precondition: shift is not zero.
  explicit RowPitch(Vec3 const& shift) : shift_(shift), passages_(0) { set_directions(shift); }

  [[nodiscard]] bool is_straight() const { return passages_ == 0; }
  [[nodiscard]] Vec3 const& shift() const { return shift_; }
  /// The direction of the axis, or of the pitch.
  [[nodiscard]] Vec3 const& direction() const { return direction_; }

  /// Whether so many pitches lead back: 360 degrees, or none at all.
  [[nodiscard]] bool comes_round(int pitches) const { return is_straight() ? pitches == 0 : pitches % passages_ == 0; }
  [[nodiscard]] Pitches times(int pitches) const {
    return is_straight() ? Pitches(double(pitches) * shift_) : Pitches(Turn(axis_, pitches, passages_));
  }
  /// The same as CGNS files say it.
  [[nodiscard]] Periodic periodic(int pitches) const;

  [[nodiscard]] PlaceInRow place(Vec3 const& p) const;
  /// Difference of two `along`, of all that full turns leave open the nearest to `near`.
  [[nodiscard]] double pitches_near(double difference, double near) const {
    return is_straight() ? difference : near + std::remainder(difference - near, double(passages_));
  }

  /// (1 - w) of a and w of b for the point x: in a wheel in cylindrical components, so that two motions that keep
  /// radius or axial position share to one that does; in a straight row in Cartesian ones. Equal motions come back bit
  /// for bit.
  [[nodiscard]] Vec3 share_motion(Vec3 const& x, Vec3 const& a, Vec3 const& b, double w) const;

 private:
  void set_directions(Vec3 const& along);

  Axis axis_;
  Vec3 shift_;
  int passages_ = 1;  ///< in 360 degrees; 0: straight
  Vec3 direction_{1, 0, 0}, zero_{0, 1, 0}, quarter_{0, 0, 1};
};

}  // namespace gridmorph
