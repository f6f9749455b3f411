// Where points stand in a lattice of control points, and what each control point weighs there.
#pragma once

#include <gridmorph/motion/ffd_rule.hpp>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gridmorph {

/// B-splines over clamped uniform knots on [0, 1], and Bernstein polynomials as those without knots between:
/// B_0 ... B_(count-1) of one degree: sum B_n = 1, B_n >= 0. With spans = count - degree the knots between are m /
/// spans, m = 1 ... spans - 1; the motion has degree - 1 continuous derivatives there. Values by the recurrence of Cox
/// and de Boor (Piegl and Tiller, The NURBS Book, 1997, A2.2).
class BSplineBasis {
 public:
  /// degree: 0 where count is 1, else 1 ... min(count - 1, FfdRule::most_degree).
  BSplineBasis(int count, int degree) : count_(count), degree_(degree), spans_(count - degree) {}

  /// The values of those functions that are not zero around a place: numbers first ... first + degree.
  struct Values {
    int first = 0;
    std::array<double, FfdRule::most_degree + 1> value{}, slope{};
  };

  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] int degree() const { return degree_; }
  [[nodiscard]] int spans() const { return spans_; }

  /// The values at s in [0, 1]; exactly 1 and 0 at the ends. Cost O(degree^2).
  [[nodiscard]] Values values(double s) const;
  /// The values at s with the derivatives dB/ds.
  [[nodiscard]] Values with_slopes(double s) const;
  /// Where control point n stands: sum B_n(s) place(n) = s (Greville abscissae).
  [[nodiscard]] double place(int n) const;

 private:
  [[nodiscard]] double knot(int n) const;
  [[nodiscard]] int last_at(double s) const;
  void fill(double s, int last, int degree, std::array<double, FfdRule::most_degree + 1>& out) const;

  int count_, degree_, spans_;
};

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
        double const plane = b.value[j] * c.value[k];
        std::size_t const row = std::size_t(a.first) + std::size_t(basis_[0].count()) *
                                                           (std::size_t(b.first + j) +
                                                            std::size_t(basis_[1].count()) * std::size_t(c.first + k));
        for (int i = 0; i <= basis_[0].degree(); ++i) visit(row + std::size_t(i), a.value[i] * plane);
      }
  }

 private:
  std::array<BSplineBasis, 3> basis_;
  FfdBox box_;
  std::array<Vec3, 3> dual_;  ///< rows of the inverse of the box's edges
  std::shared_ptr<LatticeInverse const> inverse_;
};

}  // namespace gridmorph
