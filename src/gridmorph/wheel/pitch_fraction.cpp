#include <gridmorph/boundary/range_nodes.hpp>
#include <gridmorph/wheel/detail/pitch_fraction.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace gridmorph {

namespace {

IndexRange common(IndexRange const& a, IndexRange const& b) {
  IndexRange out;
  for (int d = 0; d < 3; ++d) {
    out.begin[d] = std::max(a.begin[d], b.begin[d]);
    out.end[d] = std::max(out.begin[d], std::min(a.end[d], b.end[d]));
  }
  return out;
}

using Edges = std::vector<std::array<Index, 2>>;

/// Of a patch of a block: those of the grid line in which it meets the link.
Edges edges_of_line(Mesh const& mesh, Patch const& patch, PassageLink const& link) {
  IndexRange const line = common(patch.range, link.range);
  std::vector<Index> nodes;
  if (line.size() >= 2) for_each_node(mesh.zones[patch.zone], line, [&](Index n) { nodes.push_back(n); });
  Edges out;
  for (std::size_t n = 1; n < nodes.size(); ++n) out.push_back({nodes[n - 1], nodes[n]});
  return out;
}

/// Of a patch of elements: those of its faces whose ends the link has. Patches of a plane mesh meet it in single nodes.
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
                             Axis const& axis, std::vector<int> const& patches)
    : origin_(axis.origin),
      direction_((1 / norm(axis.direction)) * axis.direction),
      passages_(rows.rows[row].passages) {
  Vec3 const d = direction_;
  Vec3 const other = std::abs(d.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  zero_ = cross(d, other);
  zero_ = (1 / norm(zero_)) * zero_;
  quarter_ = cross(d, zero_);

  Mesh const& mesh = boundary.mesh();
  for (int const p : patches) {
    Patch const& patch = mesh.patches[p];
    if (rows.row_of_zone[patch.zone] != row) continue;
    for (int const l : links.of_zone[patch.zone]) {
      if (rows.pitches_of_link[l] != 1) continue;
      for (auto const& [from, to] : boundary.surface(p).grid ? edges_of_line(mesh, patch, links.all[l])
                                                             : edges_of_faces(boundary, p, links.all[l])) {
        Segment s{place(mesh.coordinates[from]), place(mesh.coordinates[to])};
        s.to.angle = s.from.angle + std::remainder(s.to.angle - s.from.angle, 2 * std::numbers::pi);
        segments_.push_back(s);
      }
    }
  }
}

PitchFraction::Place PitchFraction::place(Vec3 const& p) const {
  Vec3 const q = p - origin_;
  double const a = dot(q, zero_), b = dot(q, quarter_);
  return {dot(q, direction_), std::hypot(a, b), std::atan2(b, a)};
}

double PitchFraction::operator()(Vec3 const& p) const {
  Place const at = place(p);
  double nearest = std::numeric_limits<double>::infinity(), angle = 0;
  for (Segment const& s : segments_) {
    double const dx = s.to.axial - s.from.axial, dr = s.to.radius - s.from.radius, length = dx * dx + dr * dr;
    double const along = (at.axial - s.from.axial) * dx + (at.radius - s.from.radius) * dr;
    double const t = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
    double const gap = std::hypot(at.axial - s.from.axial - t * dx, at.radius - s.from.radius - t * dr);
    if (gap < nearest) {
      nearest = gap;
      angle = s.from.angle + t * (s.to.angle - s.from.angle);
    }
  }
  // Of all the turns that the difference leaves open, the one nearest to the middle of the passage.
  double const pitch = 2 * std::numbers::pi / passages_;
  double const fraction = 0.5 + std::remainder((at.angle - angle) / pitch - 0.5, double(passages_));
  return std::clamp(fraction, 0.0, 1.0);
}

}  // namespace gridmorph
