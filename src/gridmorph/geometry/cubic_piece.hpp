// Cubic pieces over one variable: what profiles and tables along a span are made of. They differ in their slopes alone.
#pragma once

namespace gridmorph {

/// The cubic with these values and slopes at both ends of a piece of this width, at the fraction t of it (Hermite).
template <class Value>
Value cubic_piece(Value const& a, Value const& b, Value const& slope_a, Value const& slope_b, double width, double t) {
  return a + ((b - a) * t * t * (3 - 2 * t) + width * t * (1 - t) * ((1 - t) * slope_a - t * slope_b));
}

/// The piece from entry k to the next of the ascending values x_of(0) ... x_of(n - 1) that holds x; beyond them the
/// first or the last. Cost O(log n).
template <class XOf>
int piece_at(int n, XOf const& x_of, double x) {
  int low = 0, high = n - 1;
  while (high - low > 1) {
    int const middle = (low + high) / 2;
    (x_of(middle) <= x ? low : high) = middle;
  }
  return low;
}

}  // namespace gridmorph
