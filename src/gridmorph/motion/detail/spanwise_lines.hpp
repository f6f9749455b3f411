// Spanwise grid lines of the patches of a blade or wing, put together. Internal to motion.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <array>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace gridmorph::detail {

/// Numbers along a line of a grid of points whose direction 0 varies fastest.
std::vector<int> grid_line(std::array<int, 2> const& extent, int direction, int line);

/// The direction of a grid along which more of the length of its lines goes into span; -1 where that is less than 0.3
/// of it (a tip face). `rise(a, b)`: how far points a and b of the grid are apart in span, a length.
int spanwise_direction(std::array<int, 2> const& extent, std::function<Vec3(int)> const& point,
                       std::function<double(int, int)> const& rise);

/// Lines of vertices from the lower to the upper end of the span. Equal ones are one.
class SpanwiseLines {
 public:
  using Line = std::vector<int>;

  /// The next line of a patch, beside the one added before; `first`: of a new patch.
  void add(Line line, bool first);
  /// A line that ends where another begins continues in it; what was beside one of its parts is beside the whole.
  void join_in_span();

  [[nodiscard]] std::vector<Line> const& lines() const { return lines_; }
  /// The numbers of the lines beside each line, ascending.
  [[nodiscard]] std::vector<std::vector<int>> neighbours() const;

 private:
  std::vector<Line> lines_;
  std::map<Line, int> number_;
  std::set<std::pair<int, int>> beside_;
  int previous_ = -1;
};

}  // namespace gridmorph::detail
