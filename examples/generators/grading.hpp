// Cell sizes that grow with the distance from where they are smallest. Internal to the demo meshes.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace gridmorph::demo {

/// Cells of size min(smallest + rate d, largest) at distance d.
struct Grading {
  double smallest = 1, rate = 0.2, largest = 6;

  /// Cells between the distances 0 and d: the integral of 1 / size.
  [[nodiscard]] double cells(double d) const {
    double const full = (largest - smallest) / rate;
    double const graded = std::log1p(rate * std::min(d, full) / smallest) / rate;
    return d < full ? graded : graded + (d - full) / largest;
  }
  /// The distance within which so many cells lie: the inverse of cells().
  [[nodiscard]] double distance(double n) const {
    double const graded = std::log(largest / smallest) / rate;
    return n < graded ? smallest * std::expm1(rate * n) / rate : (largest - smallest) / rate + (n - graded) * largest;
  }
  /// Whole number of cells between two distances, at least one.
  [[nodiscard]] int count(double from, double to) const {
    return std::max(1, int(std::lround(cells(to) - cells(from))));
  }
  /// Distances of the nodes of n cells between two distances, both included.
  [[nodiscard]] std::vector<double> nodes(double from, double to, int n) const {
    std::vector<double> at;
    double const first = cells(from), step = (cells(to) - first) / n;
    for (int i = 0; i <= n; ++i) at.push_back(distance(first + i * step));
    at.front() = from;
    at.back() = to;
    return at;
  }
};

}  // namespace gridmorph::demo
