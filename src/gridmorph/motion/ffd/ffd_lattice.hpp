// Where points stand in a lattice of control points, and what each control point weighs there.
#pragma once

#include <gridmorph/motion/ffd/bspline_basis.hpp>
#include <gridmorph/motion/ffd/lattice_inverse.hpp>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// The lattice of an ffd rule as it stands, before anything is displaced. A value that is not changed.
class FfdLattice {
 public:
  /// The lattice of a rule with a box, or with points that make a lattice of any shape. Throws MotionError where that
  /// folds. `name` begins messages.
  FfdLattice(FfdRule const& rule, std::string const& name);

  /// (s, t, w) of a point, each in [0, 1]; nothing for points outside. Points within 1e-9 of the lattice are inside.
  /// Throws MotionError where Newton's method finds no place (lattices that are no boxes).
  [[nodiscard]] std::optional<Vec3> place(Vec3 const& point) const;
  /// Where a control point stands; those of a box so that displacements linear in it displace points by the same linear
  /// function.
  [[nodiscard]] Vec3 control_point(int i, int j, int k) const;
  /// Change of (s, t, w) along a straight step from a place, to first order.
  [[nodiscard]] Vec3 step(Vec3 const& place, Vec3 const& step) const;
  [[nodiscard]] bool is_box() const { return inverse_ == nullptr; }

  /// Calls visit(number of the control point, weight) for those that weigh anything around a place, i fastest.
  template <class Visit>
  void for_each_weight(Vec3 const& place, Visit visit) const {
    auto const a = basis_[0].values(place.x), b = basis_[1].values(place.y), c = basis_[2].values(place.z);
    for (int k = 0; k <= basis_[2].degree(); ++k)
      for (int j = 0; j <= basis_[1].degree(); ++j) {
        double const plane = b.value[std::size_t(j)] * c.value[std::size_t(k)];
        std::size_t const row = std::size_t(a.first) + std::size_t(basis_[0].count()) *
                                                           (std::size_t(b.first + j) +
                                                            std::size_t(basis_[1].count()) * std::size_t(c.first + k));
        for (int i = 0; i <= basis_[0].degree(); ++i) visit(row + std::size_t(i), a.value[std::size_t(i)] * plane);
      }
  }

 private:
  std::array<BSplineBasis, 3> basis_;
  FfdBox box_;
  std::array<Vec3, 3> dual_;  ///< rows of the inverse of the box's edges
  std::shared_ptr<LatticeInverse const> inverse_;
};

}  // namespace gridmorph
