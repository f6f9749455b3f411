// B-splines over clamped uniform knots on [0, 1], and Bernstein polynomials as those without knots between.
#pragma once

#include <gridmorph/motion/ffd_rule.hpp>

#include <array>

namespace gridmorph {

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

}  // namespace gridmorph
