#include <gridmorph/motion/detail/edge_distances.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace gridmorph {

std::vector<VertexImage> vertex_images(Boundary const& boundary, PatchSurface const& surface) {
  std::vector<VertexImage> out;
  for (auto const& c : boundary.connections()) {
    // Those of other zones too: the rim of a patch may be a node of a zone beside it that has the periodic side.
    if (!c.periodic) continue;
    Mat3 const rotation = boundary.transform(c.number).rotation;
    for (auto const& [own, donor] : boundary.pairs(c.number)) {
      int const a = surface.numbers.find(boundary.coordinates()[own]),
                b = surface.numbers.find(boundary.coordinates()[donor]);
      if (a < 0 || b < 0 || a == b) continue;
      out.push_back({a, b, rotation});
      out.push_back({b, a, transpose(rotation)});
    }
  }
  // Files store most connections once per side.
  auto const pair = [](VertexImage const& i) { return std::pair(i.vertex, i.image); };
  std::stable_sort(out.begin(), out.end(), [&](auto const& a, auto const& b) { return pair(a) < pair(b); });
  out.erase(std::unique(out.begin(), out.end(), [&](auto const& a, auto const& b) { return pair(a) == pair(b); }),
            out.end());
  return out;
}

EdgeDistances edge_distances_and_sources(PatchSurface const& surface, std::vector<VertexImage> const& images,
                                         std::vector<int> const& sources) {
  auto const& points = surface.points;
  auto const neighbours = surface.neighbours();
  std::vector<std::vector<int>> same(points.size());
  for (VertexImage const& image : images) same[image.vertex].push_back(image.image);
  EdgeDistances out{std::vector<double>(points.size(), std::numeric_limits<double>::infinity()),
                    std::vector<int>(points.size(), -1)};
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  auto const reach = [&](int v, double there, int source) {
    if (there >= out.distance[v]) return;
    out.distance[v] = there;
    out.source[v] = source;
    front.emplace(there, v);
  };
  for (std::size_t s = 0; s < sources.size(); ++s) reach(sources[s], 0, int(s));
  while (!front.empty()) {
    auto const [d, v] = front.top();
    front.pop();
    if (d > out.distance[v]) continue;
    int const source = out.source[v];
    for (int const w : neighbours[v]) reach(w, d + distance(points[v], points[w]), source);
    for (int const w : same[v]) reach(w, d, source);
  }
  return out;
}

}  // namespace gridmorph
