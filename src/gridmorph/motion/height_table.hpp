// Heights of an inflated blade as a table over span and chord.
#pragma once

#include <gridmorph/motion/motion.hpp>

#include <array>
#include <utility>
#include <vector>

namespace gridmorph {

/// Heights at stations: along the chord between those of one span fraction, then along the span between these, both
/// times as SpanwiseTable does. Beyond the first and last station: theirs. Stations of a span fraction need not be at
/// the chord fractions of another.
class HeightTable {
 public:
  struct Station {
    double span = 0, chord = 0;
    double side = 0;  ///< 1, -1, or 0 for both (SurfacePlace::side)
    double height = 0;
  };
  /// A table of stations in any order. Throws MotionError where two have the same place, or one side has stations and
  /// the other none.
  HeightTable(std::vector<Station> stations, SpanwiseTable::Interpolation interpolation);

  /// The height at a place; exactly the station's at a station. Cost O(stations along the span, and log of those along
  /// the chord).
  [[nodiscard]] double at(double span, double chord, double side) const;
  /// Whether heights depend on the side.
  [[nodiscard]] bool has_sides() const { return has_sides_; }

 private:
  using Row = std::pair<double, SpanwiseTable>;  ///< span fraction, and heights over the chord
  std::array<std::vector<Row>, 2> rows_;         ///< of side -1 or both, and of side 1
  SpanwiseTable::Interpolation interpolation_;
  bool has_sides_ = false;
};

}  // namespace gridmorph
