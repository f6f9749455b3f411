#include <gridmorph/motion/target/section_rows.hpp>

#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace gridmorph {

namespace {

using Line = std::vector<int>;

class RowFinder {
 public:
  RowFinder(PatchSurface const& surface, std::function<double(Vec3 const&)> const& span, std::string const& name)
      : surface_(surface), span_(span), name_(name) {
    for (PatchGrid const& grid : surface.grids) add(grid);
  }

  SectionRows run() {
    if (lines_.empty())
      throw MotionError(name_ + ": no grid line of the patches runs along the span; check the span direction");
    join_in_span();
    auto const contour = contour_lines();
    for (int const l : contour)
      if (lines_[l].size() != lines_[contour.front()].size())
        throw MotionError(name_ + ": the spanwise grid lines have " + std::to_string(lines_[l].size()) + " and " +
                          std::to_string(lines_[contour.front()].size()) +
                          " nodes, so that they make no sections; use mapping = \"projection\"");
    out_.rows.resize(lines_[contour.front()].size());
    for (std::size_t k = 0; k < out_.rows.size(); ++k)
      for (int const l : contour) out_.rows[k].push_back(lines_[l][k]);
    return std::move(out_);
  }

 private:
  /// How much of the length of the lines along a direction goes into span.
  [[nodiscard]] double spanwise_share(PatchGrid const& grid, int direction) const {
    double risen = 0, length = 0;
    for (int l = 0; l < grid.extent[1 - direction]; ++l) {
      Line const nodes = line(grid, direction, l);
      risen += std::fabs(span_(surface_.points[nodes.back()]) - span_(surface_.points[nodes.front()]));
      for (std::size_t n = 1; n < nodes.size(); ++n)
        length += distance(surface_.points[nodes[n - 1]], surface_.points[nodes[n]]);
    }
    return length > 0 ? risen / length : 0;
  }

  static Line line(PatchGrid const& grid, int direction, int l) {
    Line out;
    for (int n = 0; n < grid.extent[direction]; ++n) out.push_back(direction == 0 ? grid.at(n, l) : grid.at(l, n));
    return out;
  }

  void add(PatchGrid const& grid) {
    std::array<double, 2> const share{spanwise_share(grid, 0), spanwise_share(grid, 1)};
    int const direction = share[0] > share[1] ? 0 : 1;
    if (!(share[direction] > 0.3)) {
      out_.left_out.push_back(grid.patch);
      return;
    }
    int previous = -1;
    for (int l = 0; l < grid.extent[1 - direction]; ++l) {
      Line nodes = line(grid, direction, l);
      if (span_(surface_.points[nodes.front()]) > span_(surface_.points[nodes.back()]))
        std::reverse(nodes.begin(), nodes.end());
      int const own = number(lines_, known_, std::move(nodes));
      if (previous >= 0 && previous != own) beside_.insert(std::minmax(previous, own));
      previous = own;
    }
  }

  static int number(std::vector<Line>& lines, std::map<Line, int>& known, Line line) {
    auto const [at, fresh] = known.try_emplace(line, int(lines.size()));
    if (fresh) lines.push_back(std::move(line));
    return at->second;
  }

  /// A line that ends where another begins continues in it.
  void join_in_span() {
    std::map<int, int> begins_at;
    std::set<int> ends;
    for (std::size_t l = 0; l < lines_.size(); ++l) {
      begins_at.try_emplace(lines_[l].front(), int(l));
      ends.insert(lines_[l].back());
    }
    std::vector<int> whole(lines_.size(), -1);
    std::vector<Line> joined;
    std::map<Line, int> known;
    for (std::size_t l = 0; l < lines_.size(); ++l) {
      if (ends.contains(lines_[l].front())) continue;
      Line nodes = lines_[l];
      std::vector<int> parts{int(l)};
      for (auto next = begins_at.find(nodes.back()); next != begins_at.end() && parts.size() <= lines_.size();
           next = begins_at.find(nodes.back())) {
        parts.push_back(next->second);
        nodes.insert(nodes.end(), lines_[next->second].begin() + 1, lines_[next->second].end());
      }
      int const own = number(joined, known, std::move(nodes));
      for (int const part : parts)
        if (whole[part] < 0) whole[part] = own;
    }
    std::set<std::pair<int, int>> beside;
    for (auto const& [a, b] : beside_)
      if (whole[a] >= 0 && whole[b] >= 0 && whole[a] != whole[b]) beside.insert(std::minmax(whole[a], whole[b]));
    lines_ = std::move(joined);
    beside_ = std::move(beside);
  }

  std::vector<int> contour_lines() {
    std::vector<std::vector<int>> neighbours(lines_.size());
    for (auto const& [a, b] : beside_) {
      neighbours[a].push_back(b);
      neighbours[b].push_back(a);
    }
    int start = -1, ends = 0;
    for (int l = 0; l < int(lines_.size()); ++l) {
      if (neighbours[l].size() > 2)
        throw MotionError(name_ + ": more than two patches meet in a spanwise line at " + where(lines_[l].front()) +
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
        if (n != before && (next < 0 || n < next)) next = n;
      if (next < 0 || next == order.front()) break;
      order.push_back(next);
      before = at;
      at = next;
    }
    if (order.size() != lines_.size())
      throw MotionError(
          name_ + ": the patches are " + (ends > 2 ? "several surfaces" : "more than one surface") +
          " around sections, one of which holds " + where(lines_[order.front()].front()) +
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
  std::vector<Line> lines_;
  std::map<Line, int> known_;
  std::set<std::pair<int, int>> beside_;
  SectionRows out_;
};

}  // namespace

SectionRows find_section_rows(PatchSurface const& surface, std::function<double(Vec3 const&)> const& span,
                              std::string const& name) {
  return RowFinder(surface, span, name).run();
}

}  // namespace gridmorph
