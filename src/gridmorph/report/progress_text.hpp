// How far long work has come and how long the rest may take, in words.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph {

/// "8 s", "3 min", "1.5 h": one or two digits are all that an estimate is worth.
std::string duration_text(double seconds);

/// "writing a.cgns, 40 %, about 12 s left"; `share` of all work done after `elapsed` seconds, nothing where the end is
/// not known. The rest is estimated from two seconds and two percent on.
std::string progress_text(std::string_view work, std::optional<double> share, double elapsed);

/// Stages of known cost that follow one another.
class StagedProgress {
 public:
  /// The cost of each stage, in any unit; empty: the end is not known.
  void expect(std::vector<double> costs);
  /// The next stage begins: share of all cost that lies behind it. Nothing where no stage is left.
  std::optional<double> advance();

 private:
  std::vector<double> costs_;
  std::size_t next_ = 0;
};

/// Tells when a log is due for another line: after `interval` seconds without one.
class LogPace {
 public:
  explicit LogPace(double interval) : interval_(interval) {}
  [[nodiscard]] bool due(double now) {
    if (now - last_ < interval_) return false;
    last_ = now;
    return true;
  }

 private:
  double interval_, last_ = 0;
};

}  // namespace gridmorph
