#include <gridmorph/boundary/range_nodes.hpp>
#include <gridmorph/wheel/detail/pitch_fraction.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmorph {

namespace {

using Edges = std::vector<std::array<Index, 2>>;

/// The edges of a patch of a block: those of the grid line in which it meets the link.
Edges edges_of_line(Zone const& zone, Patch const& patch, PassageLink const& link) {
  IndexRange const line = intersection(patch.range, link.range);
  std::vector<Index> nodes;
  if (line.size() >= 2) for_each_node(zone, line, [&](Index n) { nodes.push_back(n); });
  Edges out;
  for (std::size_t n = 1; n < nodes.size(); ++n) out.push_back({nodes[n - 1], nodes[n]});
  return out;
}

/// The edges of a patch of elements: those of its faces whose ends the link has. Patches of a plane mesh meet it in
/// single nodes.
Edges edges_of_faces(Boundary const& boundary, int patch, PassageLink const& link) {
  std::vector<Index> side;
  for (auto const& pair : link.pairs) side.push_back(pair[0]);
  std::sort(side.begin(), side.end());
  auto const on_side = [&](Index n) { return std::binary_search(side.begin(), side.end(), n); };
  BoundarySurface const& surface = boundary.surface(patch);
  Edges out;
  if (boundary.is_plane()) {
    for (Index const n : surface.nodes)
      if (on_side(n)) out.push_back({n, n});
    return out;
  }
  for (GridFacet const& face : surface.faces) {
    std::size_t const corners = face[3] < 0 ? 3 : 4;
    for (std::size_t k = 0; k < corners; ++k) {
      Index const a = surface.nodes[face[k]], b = surface.nodes[face[(k + 1) % corners]];
      if (on_side(a) && on_side(b)) out.push_back({a, b});
    }
  }
  return out;
}

}  // namespace

PitchFraction::PitchFraction(Boundary const& boundary, PassageLinks const& links, WheelRows const& rows, int row,
                             std::vector<int> const& patches)
    : pitch_(rows.rows[row].pitch) {
  for (int const p : patches) {
    Patch const& patch = boundary.patches()[p];
    if (rows.row_of_zone[patch.zone] != row) continue;
    for (int const l : links.of_zone[patch.zone]) {
      if (rows.pitches_of_link[l] != 1) continue;
      for (auto const& [from, to] : boundary.surface(p).grid
                                        ? edges_of_line(boundary.zones()[patch.zone], patch, links.all[l])
                                        : edges_of_faces(boundary, p, links.all[l])) {
        Segment s{pitch_.place(boundary.coordinates()[from]), pitch_.place(boundary.coordinates()[to])};
        s.to.along = s.from.along + pitch_.pitches_near(s.to.along - s.from.along, 0);
        segments_.push_back(s);
      }
    }
  }
}

double PitchFraction::operator()(Vec3 const& p) const {
  PlaceInRow const at = pitch_.place(p);
  double nearest = std::numeric_limits<double>::infinity(), along_side = 0;
  for (Segment const& s : segments_) {
    double const d1 = s.to.first - s.from.first, d2 = s.to.second - s.from.second, length = d1 * d1 + d2 * d2;
    double const along = (at.first - s.from.first) * d1 + (at.second - s.from.second) * d2;
    double const t = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
    double const gap = std::hypot(at.first - s.from.first - t * d1, at.second - s.from.second - t * d2);
    if (gap < nearest) {
      nearest = gap;
      along_side = s.from.along + t * (s.to.along - s.from.along);
    }
  }
  // Of all the turns that the difference leaves open, the one nearest to the middle of the passage.
  return std::clamp(pitch_.pitches_near(at.along - along_side, 0.5), 0.0, 1.0);
}

}  // namespace gridmorph
