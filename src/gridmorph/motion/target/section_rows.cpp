#include <gridmorph/motion/target/section_rows.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/motion/detail/spanwise_lines.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gridmorph {

namespace {

class RowFinder {
 public:
  RowFinder(PatchSurface const& surface, std::function<double(Vec3 const&)> const& span, std::string const& name)
      : surface_(surface), span_(span), name_(name) {
    for (PatchGrid const& grid : surface.grids) add(grid);
  }

  SectionRows run() {
    if (stitched_.lines().empty())
      throw MotionError(name_ + ": no grid line of the patches runs along the span; check the span direction");
    stitched_.join_in_span();
    auto const& lines = stitched_.lines();
    auto const contour = contour_lines();
    for (int const l : contour)
      if (lines[l].size() != lines[contour.front()].size())
        throw MotionError(name_ + ": the spanwise grid lines have " + std::to_string(lines[l].size()) + " and " +
                          std::to_string(lines[contour.front()].size()) +
                          " nodes, so that they make no sections; use mapping = \"projection\"");
    out_.rows.resize(lines[contour.front()].size());
    for (std::size_t k = 0; k < out_.rows.size(); ++k)
      for (int const l : contour) out_.rows[k].push_back(lines[l][k]);
    return std::move(out_);
  }

 private:
  void add(PatchGrid const& grid) {
    auto const point = [&](int n) { return surface_.points[grid.vertex[n]]; };
    int const direction = detail::spanwise_direction(
        grid.extent, point, [&](int a, int b) { return std::fabs(span_(point(b)) - span_(point(a))); });
    if (direction < 0) {
      out_.left_out.push_back(grid.patch);
      return;
    }
    for (int l = 0; l < grid.extent[1 - direction]; ++l) {
      auto line = detail::grid_line(grid.extent, direction, l);
      for (int& n : line) n = grid.vertex[n];
      if (span_(surface_.points[line.front()]) > span_(surface_.points[line.back()]))
        std::reverse(line.begin(), line.end());
      stitched_.add(std::move(line), l == 0);
    }
  }

  std::vector<int> contour_lines() {
    auto const& lines = stitched_.lines();
    auto const neighbours = stitched_.neighbours();
    int start = -1, ends = 0;
    for (int l = 0; l < int(lines.size()); ++l) {
      if (neighbours[l].size() > 2)
        throw MotionError(name_ + ": more than two patches meet in a spanwise line at " + where(lines[l].front()) +
                          "; name one blade or wing");
      if (neighbours[l].size() < 2) {
        ++ends;
        if (start < 0) start = l;
      }
    }
    bool const closed = start < 0;
    std::vector<int> order{closed ? 0 : start};
    for (int before = -1, at = order.front();;) {
      int next = -1;
      for (int const n : neighbours[at])
        // Around a closed contour either way would do: the lower number decides.
        if (n != before && (next < 0 || n < next)) next = n;
      if (next < 0 || next == order.front()) break;
      order.push_back(next);
      before = at;
      at = next;
    }
    if (order.size() != lines.size())
      throw MotionError(
          name_ + ": the patches are " + (ends > 2 ? "several surfaces" : "more than one surface") +
          " around sections, one of which holds " + where(lines[order.front()].front()) +
          "; a target of sections moves one blade or wing that is whole; sides of a blade that lie a pitch apart "
          "(H mesh) are put together where a periodic interface of the mesh takes an edge of one to the other");
    if (closed) order.push_back(order.front());
    return order;
  }

  [[nodiscard]] std::string where(int vertex) const {
    Vec3 const& p = surface_.points[vertex];
    return "(" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z) + ")";
  }

  PatchSurface const& surface_;
  std::function<double(Vec3 const&)> const& span_;
  std::string const& name_;
  detail::SpanwiseLines stitched_;
  SectionRows out_;
};

}  // namespace

SectionRows find_section_rows(PatchSurface const& surface, std::function<double(Vec3 const&)> const& span,
                              std::string const& name) {
  return RowFinder(surface, span, name).run();
}

}  // namespace gridmorph
