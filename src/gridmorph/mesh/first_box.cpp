#include <gridmorph/mesh/first_box.hpp>

#include <algorithm>
#include <numeric>

namespace gridmorph::detail {

namespace {

bool is_inside(IndexRange const& a, IndexRange const& b) {
  for (int d = 0; d < 3; ++d)
    if (a.begin[d] < b.begin[d] || a.end[d] > b.end[d]) return false;
  return true;
}

/// Those of the boxes that a region has to do with: behind the first that holds all of it none does.
std::vector<int> boxes_of(IndexRange const& region, std::span<int const> boxes, std::span<IndexRange const> all) {
  std::vector<int> out;
  for (int const b : boxes) {
    if (intersection(all[b], region).size() == 0) continue;
    out.push_back(b);
    if (is_inside(region, all[b])) break;
  }
  return out;
}

struct Plane {
  int axis, place;
};

/// The one of three planes, each in the middle of the limits of boxes across its axis, that leaves fewest boxes on its
/// fuller side. There is one wherever a box holds a region in part.
Plane dividing_plane(IndexRange const& region, std::span<int const> boxes, std::span<IndexRange const> all) {
  Plane best{FirstBox::none, 0};
  std::size_t fewest = 0;
  for (int a = 0; a < 3; ++a) {
    std::vector<int> limits;
    for (int const b : boxes)
      for (int const limit : {all[b].begin[a], all[b].end[a]})
        if (limit > region.begin[a] && limit < region.end[a]) limits.push_back(limit);
    if (limits.empty()) continue;
    auto const middle = limits.begin() + std::ptrdiff_t(limits.size() / 2);
    std::nth_element(limits.begin(), middle, limits.end());
    std::size_t below = 0, above = 0;
    for (int const b : boxes) {
      below += all[b].begin[a] < *middle ? 1 : 0;
      above += all[b].end[a] > *middle ? 1 : 0;
    }
    std::size_t const fuller = std::max(below, above);
    if (best.axis == FirstBox::none || fuller < fewest) {
      best = {a, *middle};
      fewest = fuller;
    }
  }
  return best;
}

}  // namespace

FirstBox::FirstBox(IndexRange const& region, std::span<IndexRange const> boxes) : region_(region) {
  std::vector<int> every(boxes.size());
  std::iota(every.begin(), every.end(), 0);
  divide(region, boxes_of(region, every, boxes), boxes);
}

void FirstBox::divide(IndexRange const& region, std::vector<int> const& boxes, std::span<IndexRange const> all) {
  if (boxes.empty() || is_inside(region, all[boxes.front()])) {
    nodes_.push_back({none, boxes.empty() ? none : boxes.front(), 0});
    return;
  }
  auto const [axis, place] = dividing_plane(region, boxes, all);
  auto const here = nodes_.size();
  nodes_.push_back({axis, place, 0});
  IndexRange below = region, above = region;
  below.end[axis] = above.begin[axis] = place;
  divide(below, boxes_of(below, boxes, all), all);
  nodes_[here].upper = int(nodes_.size());
  divide(above, boxes_of(above, boxes, all), all);
}

int FirstBox::operator()(Index3 const& p) const {
  if (!region_.contains(p)) return none;
  int n = 0;
  while (nodes_[n].axis != none) n = p[nodes_[n].axis] < nodes_[n].plane_or_box ? n + 1 : nodes_[n].upper;
  return nodes_[n].plane_or_box;
}

}  // namespace gridmorph::detail
