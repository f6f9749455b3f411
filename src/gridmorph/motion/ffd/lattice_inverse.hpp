// Places of points in a lattice of any shape: the inverse of a map of three B-splines.
#pragma once

#include <gridmorph/motion/ffd/bspline_basis.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// x(s, t, w) = sum_ijk B_i(s) B_j(t) B_k(w) P_ijk, solved for (s, t, w) point by point.
class LatticeInverse {
 public:
  /// points: P, i fastest. Throws MotionError where the map turns over or has no volume, seen at (degree + 1)^3 places
  /// of each span. Cost O(spans (degree + 1)^6).
  LatticeInverse(std::array<BSplineBasis, 3> const& basis, std::vector<Vec3> points, std::string name);

  /// The place of a point; nothing outside. A point that no span's control points enclose is outside; for the others
  /// the squared distance is made smallest within the unit cube by damped Newton steps (coordinates that would leave it
  /// stay at its sides), from the nearest of the places above. Farther than 1e-9 of the lattice's size: outside. Throws
  /// MotionError where the steps end elsewhere.
  [[nodiscard]] std::optional<Vec3> place(Vec3 const& point) const;
  /// dx in terms of ds, dt, dw: the inverse of the map's derivative, times a step.
  [[nodiscard]] Vec3 step(Vec3 const& place, Vec3 const& step) const;
  [[nodiscard]] std::vector<Vec3> const& points() const { return points_; }

 private:
  struct Derived {
    Vec3 x;
    std::array<Vec3, 3> by;  ///< dx/ds, dx/dt, dx/dw
  };
  /// Where the steps end.
  struct End {
    Vec3 place;
    double distance = 0;
    bool at_side = false;
  };
  struct Sample {
    Vec3 place, x;
  };
  struct Span {
    Vec3 low, high;  ///< of its control points
    std::vector<Sample> samples;
  };

  void sample();
  [[nodiscard]] Derived derived(Vec3 const& place) const;
  [[nodiscard]] End descend(Vec3 const& point, Vec3 place) const;

  std::array<BSplineBasis, 3> basis_;
  std::vector<Vec3> points_;
  std::string name_;
  double size_ = 0;  ///< diagonal of the control points
  std::vector<Span> spans_;
};

}  // namespace gridmorph
