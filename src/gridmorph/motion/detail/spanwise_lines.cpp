#include <gridmorph/motion/detail/spanwise_lines.hpp>

#include <algorithm>
#include <cstddef>

namespace gridmorph::detail {

namespace {

using Line = SpanwiseLines::Line;

int numbered(std::vector<Line>& lines, std::map<Line, int>& known, Line line) {
  auto const [at, fresh] = known.try_emplace(line, int(lines.size()));
  if (fresh) lines.push_back(std::move(line));
  return at->second;
}

}  // namespace

std::vector<int> grid_line(std::array<int, 2> const& extent, int direction, int line) {
  std::vector<int> out;
  for (int n = 0; n < extent[direction]; ++n)
    out.push_back(direction == 0 ? n + extent[0] * line : line + extent[0] * n);
  return out;
}

int spanwise_direction(std::array<int, 2> const& extent, std::function<Vec3(int)> const& point,
                       std::function<double(int, int)> const& rise) {
  constexpr double least = 0.3;
  std::array<double, 2> share{};
  for (int direction = 0; direction < 2; ++direction) {
    double risen = 0, length = 0;
    for (int l = 0; l < extent[1 - direction]; ++l) {
      auto const line = grid_line(extent, direction, l);
      risen += rise(line.front(), line.back());
      for (std::size_t n = 1; n < line.size(); ++n) length += distance(point(line[n - 1]), point(line[n]));
    }
    share[direction] = length > 0 ? risen / length : 0;
  }
  int const direction = share[0] > share[1] ? 0 : 1;
  return share[direction] > least ? direction : -1;
}

void SpanwiseLines::add(Line line, bool first) {
  int const own = numbered(lines_, number_, std::move(line));
  if (!first && previous_ != own) beside_.insert(std::minmax(previous_, own));
  previous_ = own;
}

void SpanwiseLines::join_in_span() {
  std::map<int, int> begins_at;
  std::set<int> ends;
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    begins_at.try_emplace(lines_[l].front(), int(l));
    ends.insert(lines_[l].back());
  }
  std::vector<int> whole(lines_.size(), -1);
  std::vector<Line> joined;
  number_.clear();
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    if (ends.contains(lines_[l].front())) continue;  // has something below it
    Line line = lines_[l];
    std::vector<int> parts{int(l)};
    for (auto next = begins_at.find(line.back()); next != begins_at.end() && parts.size() <= lines_.size();
         next = begins_at.find(line.back())) {
      parts.push_back(next->second);
      line.insert(line.end(), lines_[next->second].begin() + 1, lines_[next->second].end());
    }
    int const own = numbered(joined, number_, std::move(line));
    for (int const part : parts)
      if (whole[part] < 0) whole[part] = own;
  }
  std::set<std::pair<int, int>> beside;
  for (auto const& [a, b] : beside_)
    if (whole[a] >= 0 && whole[b] >= 0 && whole[a] != whole[b]) beside.insert(std::minmax(whole[a], whole[b]));
  lines_ = std::move(joined);
  beside_ = std::move(beside);
}

std::vector<std::vector<int>> SpanwiseLines::neighbours() const {
  std::vector<std::vector<int>> out(lines_.size());
  for (auto const& [a, b] : beside_) {
    out[a].push_back(b);
    out[b].push_back(a);
  }
  return out;
}

}  // namespace gridmorph::detail
