#include <gridmorph/io/cgns/cgns_interface.hpp>

#include <cstdlib>
#include <map>
#include <tuple>
#include <utility>

namespace gridmorph::cgns {

namespace {

Joined refuse(Joined::Outcome outcome, std::string why) {
  Joined out;
  out.outcome = outcome;
  out.why = std::move(why);
  return out;
}

std::string text(std::vector<std::int64_t> const& transform) {
  std::string out = "[";
  for (std::size_t a = 0; a < transform.size(); ++a) out += (a ? ", " : "") + std::to_string(transform[a]);
  return out + "]";
}

}  // namespace

Joined join(ZoneLayout const& zone, Corners const& own, ZoneLayout const& donor, Corners const& other,
            std::vector<std::int64_t> const& transform) {
  using enum Joined::Outcome;
  std::string const own_text = to_string(own, zone.index_dimension);
  std::string const both =
      "range " + own_text + " with donor zone '" + donor.name + "' range " + to_string(other, donor.index_dimension);
  std::string const with_transform = both + " and Transform " + text(transform);
  if (zone.index_dimension != donor.index_dimension)
    return refuse(wrong, both + ": the zones have different numbers of index directions");
  if (int(transform.size()) != zone.index_dimension)
    return refuse(wrong, with_transform + ": Transform needs one entry per index direction");

  IndexRange const range = node_range(zone, own);
  IndexRange const donor_range = node_range(donor, other);
  int thick = 0;
  for (int a = 0; a < 3; ++a) thick += range.extent(a) > 1;
  if (thick < 2)
    return refuse(skipped,
                  "range " + own_text + " is a line or point: it joins nothing that the faces around it do not");
  auto const normal = face_normal(zone, range);
  auto const donor_normal = face_normal(donor, donor_range);
  if (!normal) return refuse(wrong, both + ": the range is not on a face of its zone");
  if (!donor_normal) return refuse(wrong, both + ": the donor range is not on a face of the donor zone");

  std::array<int, 3> t{0, 0, 3};
  for (int a = 0; a < zone.index_dimension; ++a) {
    if (std::llabs(transform[a]) > zone.index_dimension)
      return refuse(wrong, with_transform + ": the Transform is not a signed permutation of the axes");
    t[a] = int(transform[a]);
  }
  // The missing direction of 2-D zones: both were given their second plane on the same side.
  if (zone.flat_axis >= 0 && zone.index_dimension == 3) t[zone.flat_axis] = donor.flat_axis + 1;
  // Flat axes have two planes in the mesh, whatever the file says of them.
  auto const in_mesh = [](ZoneLayout const& z, Corners corners) {
    if (z.flat_axis >= 0) std::tie(corners.begin[z.flat_axis], corners.end[z.flat_axis]) = std::pair(1, 2);
    return corners;
  };
  Joined out;
  std::string why;
  auto const map = detail::join_faces({in_mesh(zone, own), range, *normal},
                                      {in_mesh(donor, other), donor_range, *donor_normal}, t, why);
  if (!map) return refuse(wrong, with_transform + ": " + why);
  out.range = range;
  out.to_donor = *map;
  if (!why.empty()) out.why = with_transform + ": " + why;
  return out;
}

namespace {

Index3 minus(Index3 const& a, Index3 const& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// Axis and sign of a unit step; nothing for any other step.
std::optional<std::pair<int, int>> unit_step(Index3 const& d) {
  if (std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]) != 1) return std::nullopt;
  int const axis = d[0] != 0 ? 0 : d[1] != 0 ? 1 : 2;
  return std::pair{axis, d[axis]};
}

}  // namespace

Joined join_lists(ZoneLayout const& zone, PointSet const& own, IndexRange const& own_face, ZoneLayout const& donor,
                  std::vector<Index3> const& donor_points, bool donor_is_range) {
  using enum Joined::Outcome;
  PointSet other = own;
  other.points.clear();
  if (donor_is_range && donor_points.size() == 2) other.corners = {donor_points[0], donor_points[1]};
  if (!donor_is_range) {
    other.points = donor_points;
    other.corners = {donor_points.front(), donor_points.front()};
    for (auto const& p : donor_points)
      for (int a = 0; a < 3; ++a) {
        other.corners.begin[a] = std::min(other.corners.begin[a], p[a]);
        other.corners.end[a] = std::max(other.corners.end[a], p[a]);
      }
  }
  auto const donor_face = face_range(donor, other);
  if (donor_face.misfit != Misfit::none) return refuse(skipped, "on the donor side " + donor_face.why);

  auto const own_points = own.points.empty() ? all_points(own.corners) : own.points;
  auto const images = donor_is_range ? all_points(other.corners) : donor_points;
  if (own_points.size() != images.size())
    return refuse(skipped, "its lists have " + std::to_string(own_points.size()) + " and " +
                               std::to_string(images.size()) + " points");
  std::map<Index3, Index3> image;
  for (std::size_t n = 0; n < own_points.size(); ++n) image.emplace(own_points[n], images[n]);

  Index3 const corner = image.begin()->first;  // smallest in every index, because the points fill their box
  Index3 const corner_image = image.begin()->second;
  int const normal = *face_normal(zone, own_face);
  int const donor_normal = *face_normal(donor, donor_face.range);
  Orientation o;
  o.axis[normal] = donor_normal;
  o.sign[normal] = detail::sign_through(own_face, normal, donor_face.range, donor_normal);
  for (int a = 0; a < 3; ++a) {
    if (a == normal) continue;
    if (a == zone.flat_axis) {
      o.axis[a] = donor.flat_axis;
      o.sign[a] = 1;
      continue;
    }
    Index3 next = corner;
    ++next[a];
    auto const neighbour = image.find(next);
    if (neighbour == image.end()) return refuse(skipped, "it is one cell wide, so that its orientation is not known");
    auto const step = unit_step(minus(neighbour->second, corner_image));
    if (!step) return refuse(skipped, "its lists do not run along index lines on both sides");
    o.axis[a] = step->first;
    o.sign[a] = step->second;
  }
  std::array<int, 3> t{};
  for (int a = 0; a < 3; ++a) t[a] = o.sign[a] * (o.axis[a] + 1);
  if (!detail::as_orientation(t, o)) return refuse(skipped, "its lists are no signed permutation of the axes");
  for (auto const& [p, q] : image) {
    Index3 expected = o.apply(minus(p, corner));
    Index3 found = minus(q, corner_image);
    expected[donor_normal] = found[donor_normal] = 0;
    if (expected != found) return refuse(skipped, "its lists are no signed permutation of the axes");
  }

  // The map carries the smallest own node to that corner of the donor's node range where falling directions end.
  Joined out;
  out.range = own_face;
  out.to_donor = {o, own_face.begin, {0, 0, 0}};
  for (int a = 0; a < 3; ++a) {
    int const d = o.axis[a];
    bool const low = a == normal || o.sign[a] > 0;
    out.to_donor.donor_origin[d] = low ? donor_face.range.begin[d] : donor_face.range.end[d] - 1;
    if (out.range.extent(a) != donor_face.range.extent(d))
      return refuse(skipped, "its two sides have different shapes");
  }
  return out;
}

}  // namespace gridmorph::cgns
