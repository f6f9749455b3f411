#include <gridmorph/motion/ffd/ffd_lattice.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace gridmorph {

double BSplineBasis::knot(int n) const {
  if (n <= degree_) return 0;
  return n >= count_ ? 1.0 : double(n - degree_) / spans_;
}

/// Number of the last function that is not zero in the span around s.
int BSplineBasis::last_at(double s) const {
  int last = degree_ + std::clamp(int(std::floor(s * spans_)), 0, spans_ - 1);
  while (last > degree_ && s < knot(last)) --last;  // round-off
  return last;
}

/// out[0 ... degree]: functions last - degree ... last, of that degree over the same knots.
void BSplineBasis::fill(double s, int last, int degree, std::array<double, FfdRule::most_degree + 1>& out) const {
  out[0] = 1;
  for (int d = 1; d <= degree; ++d) {
    double saved = 0;
    for (int r = 0; r < d; ++r) {
      double const right = knot(last + r + 1) - s, left = s - knot(last + 1 - d + r);
      double const term = out[r] / (right + left);
      out[r] = saved + right * term;
      saved = left * term;
    }
    out[d] = saved;
  }
}

BSplineBasis::Values BSplineBasis::values(double s) const {
  Values out;
  int const last = last_at(s);
  out.first = last - degree_;
  if (s == 0 || s == 1)  // the recurrence rounds
    out.value[s == 0 ? 0 : std::size_t(degree_)] = 1;
  else
    fill(s, last, degree_, out.value);
  return out;
}

BSplineBasis::Values BSplineBasis::with_slopes(double s) const {
  Values out = values(s);
  if (degree_ == 0) return out;
  int const last = out.first + degree_;
  std::array<double, FfdRule::most_degree + 1> lower{};
  fill(s, last, degree_ - 1, lower);  // functions last - degree + 1 ... last
  for (int n = 0; n <= degree_; ++n) {
    int const i = out.first + n;
    double slope = 0;
    if (n > 0) slope += lower[n - 1] / (knot(i + degree_) - knot(i));
    if (n < degree_) slope -= lower[n] / (knot(i + degree_ + 1) - knot(i + 1));
    out.slope[n] = degree_ * slope;
  }
  return out;
}

double BSplineBasis::place(int n) const {
  if (degree_ == 0) return 0.5;
  double sum = 0;
  for (int m = n + 1; m <= n + degree_; ++m) sum += knot(m);
  return sum / degree_;
}

}  // namespace gridmorph
