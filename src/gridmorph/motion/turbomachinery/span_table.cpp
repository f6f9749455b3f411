#include <gridmorph/geometry/cubic_piece.hpp>
#include <gridmorph/motion/turbomachinery/span_table.hpp>

#include <algorithm>

namespace gridmorph {

double SpanTable::slope(int n, int q) const {
  int const last = int(span_.size()) - 1, m = std::clamp(n, 1, std::max(last - 1, 1));
  auto const secant = [&](int i) { return (value_[i + 1][q] - value_[i][q]) / (span_[i + 1] - span_[i]); };
  if (last < 2) return secant(0);
  double const before = secant(m - 1), after = secant(m);
  double const bend = (after - before) / (span_[m + 1] - span_[m - 1]);
  return before +
         bend * (2 * span_[n] - span_[m - 1] - span_[m]);  // derivative of the parabola through m - 1, m, m + 1
}

SpanTable::Value SpanTable::at(double span) const {
  if (span <= span_.front() || span_.size() < 2) return value_.front();
  if (span >= span_.back()) return value_.back();
  int const lo = piece_at(
      int(span_.size()), [&](int k) { return span_[k]; }, span);
  double const h = span_[lo + 1] - span_[lo], t = (span - span_[lo]) / h;
  Value out{};
  for (int q = 0; q < 4; ++q)
    out[q] = cubic_piece(value_[lo][q], value_[lo + 1][q], slope(lo, q), slope(lo + 1, q), h, t);
  return out;
}

}  // namespace gridmorph
