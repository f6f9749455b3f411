// Random numbers that are the same on every platform (the distributions of <random> are not).
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace gridmorph::test {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  /// In [0, 1).
  double unit() { return double(engine_() >> 11) * 0x1p-53; }
  double between(double lo, double hi) { return lo + (hi - lo) * unit(); }
  /// One of 0 .. n - 1.
  int below(int n) { return int(engine_() % std::uint64_t(n)); }
  bool coin() { return below(2) == 1; }
  Vec3 vector(double amplitude) {
    double const x = between(-amplitude, amplitude), y = between(-amplitude, amplitude);
    return {x, y, between(-amplitude, amplitude)};
  }
  template <class T>
  void shuffle(std::vector<T>& list) {
    for (int n = int(list.size()); n > 1; --n) std::swap(list[n - 1], list[below(n)]);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace gridmorph::test
