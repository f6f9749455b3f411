#include <gridmorph/boundary/link_nodes.hpp>
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

}  // namespace

PitchFraction::PitchFraction(Mesh const& mesh, Links const& links, WheelRows const& rows, int row, Axis const& axis,
                             std::vector<int> const& patches)
    : origin_(axis.origin),
      direction_((1 / norm(axis.direction)) * axis.direction),
      passages_(rows.rows[row].passages) {
  Vec3 const d = direction_;
  Vec3 const other = std::abs(d.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  zero_ = cross(d, other);
  zero_ = (1 / norm(zero_)) * zero_;
  quarter_ = cross(d, zero_);

  for (int const p : patches) {
    Patch const& patch = mesh.patches[p];
    if (rows.row_of_zone[patch.zone] != row) continue;
    for (int const l : links.of_zone[patch.zone]) {
      if (rows.pitches_of_link[l] != 1) continue;
      IndexRange const line = common(patch.range, links.all[l].range);
      if (line.size() < 2) continue;
      std::vector<Place> places;
      for_each_node(mesh.zones[patch.zone], line, [&](Index n) { places.push_back(place(mesh.coordinates[n])); });
      for (std::size_t n = 1; n < places.size(); ++n) {
        Segment s{places[n - 1], places[n]};
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
