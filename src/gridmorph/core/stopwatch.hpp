// Wall-clock time between two points of a program.
#pragma once

#include <chrono>
#include <utility>

namespace gridmorph {

class Stopwatch {
 public:
  /// Seconds since construction or the last lap(), which begins the next lap.
  double lap() {
    auto const now = Clock::now();
    return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace gridmorph
