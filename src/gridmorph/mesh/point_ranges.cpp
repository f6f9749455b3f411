#include <gridmorph/core/error.hpp>
#include <gridmorph/mesh/point_ranges.hpp>

#include <algorithm>
#include <cstdlib>

namespace gridmorph {

namespace {

int step_between(int from, int to) { return to < from ? -1 : 1; }

/// Replaces a single zero; false if there are several, or no axis is left for it.
bool rebuild_zero(std::array<int, 3>& t, PointRange const& own, PointRange const& donor, int normal,
                  int sign_of_normal) {
  int zero = -1;
  int left = 6;  // 1 + 2 + 3
  for (int a = 0; a < 3; ++a) {
    if (t[a] == 0 && zero >= 0) return false;
    if (t[a] == 0) zero = a;
    left -= std::abs(t[a]);
  }
  if (zero < 0) return true;
  if (left < 1 || left > 3) return false;
  int const axis = left - 1;
  int const sign =
      zero == normal ? sign_of_normal
                     : step_between(own.begin[zero], own.end[zero]) * step_between(donor.begin[axis], donor.end[axis]);
  t[zero] = sign * left;
  return true;
}

Index3 from_one_to_zero(Index3 const& p) { return {p[0] - 1, p[1] - 1, p[2] - 1}; }

std::string text_of_range(PointRange const& r) {
  std::string out = "[";
  for (int a = 0; a < 3; ++a) out += (a > 0 ? ", " : "") + std::to_string(r.begin[a]) + ":" + std::to_string(r.end[a]);
  return out + "]";
}

/// The face of its zone that a range lies on. Throws MeshError where it lies on none.
detail::FaceOfRange face_of_range(Mesh const& mesh, std::string const& where, int zone, PointRange const& range) {
  if (zone < 0 || zone >= int(mesh.zones.size()))
    throw MeshError(where + "there is no zone " + std::to_string(zone) + " among " + std::to_string(mesh.zones.size()));
  Zone const& z = mesh.zones[zone];
  detail::FaceOfRange out{range, {}, -1};
  int flat = 0;
  for (int a = 0; a < 3; ++a) {
    auto const [low, high] = std::minmax(range.begin[a], range.end[a]);
    if (low < 1 || high > z.extent[a])
      throw MeshError(where + "range " + text_of_range(range) + " leaves zone '" + z.name + "' with " +
                      std::to_string(z.extent[a]) + " nodes along " + "ijk"[a]);
    out.nodes.begin[a] = low - 1;
    out.nodes.end[a] = high;
    if (low != high) continue;
    ++flat;
    if (low == 1 || low == z.extent[a]) out.normal = a;
  }
  if (flat != 1 || out.normal < 0)
    throw MeshError(where + "range " + text_of_range(range) + " is not on a face of zone '" + z.name + "'");
  return out;
}

}  // namespace

namespace detail {

int sign_through(IndexRange const& own, int own_normal, IndexRange const& donor, int donor_normal) {
  bool const own_first = own.begin[own_normal] == 0;
  bool const donor_first = donor.begin[donor_normal] == 0;
  return own_first == donor_first ? -1 : 1;
}

bool as_orientation(std::array<int, 3> const& transform, Orientation& o) {
  std::array<bool, 3> used{};
  for (int a = 0; a < 3; ++a) {
    int const axis = std::abs(transform[a]) - 1;
    if (axis < 0 || axis > 2 || used[axis]) return false;
    used[axis] = true;
    o.axis[a] = axis;
    o.sign[a] = transform[a] > 0 ? 1 : -1;
  }
  return true;
}

std::optional<IndexMap> join_faces(FaceOfRange const& own, FaceOfRange const& donor, std::array<int, 3> transform,
                                   std::string& why) {
  int const sign_of_normal = sign_through(own.nodes, own.normal, donor.nodes, donor.normal);
  Orientation orientation;
  if (!rebuild_zero(transform, own.corners, donor.corners, own.normal, sign_of_normal) ||
      !as_orientation(transform, orientation)) {
    why = "the Transform is not a signed permutation of the axes";
    return std::nullopt;
  }
  if (orientation.axis[own.normal] != donor.normal) {
    why = std::string("the Transform carries the face normal ") + "ijk"[own.normal] + " to " +
          "ijk"[orientation.axis[own.normal]] + ", but the donor range is on a face normal to " + "ijk"[donor.normal];
    return std::nullopt;
  }
  for (int a = 0; a < 3; ++a)
    if (int const d = orientation.axis[a]; own.nodes.extent(a) != donor.nodes.extent(d)) {
      why = "the donor range has another shape (" + std::to_string(own.nodes.extent(a)) + " nodes along " + "ijk"[a] +
            ", " + std::to_string(donor.nodes.extent(d)) + " along donor " + "ijk"[d] + ")";
      return std::nullopt;
    }
  orientation.sign[own.normal] = sign_of_normal;

  // As the standard says, from Begin to Begin; where End then misses End, the donor range was written in ascending
  // order.
  IndexMap const as_declared{orientation, from_one_to_zero(own.corners.begin), from_one_to_zero(donor.corners.begin)};
  IndexMap map{orientation, own.nodes.begin, as_declared(own.nodes.begin)};
  if (as_declared(from_one_to_zero(own.corners.end)) != from_one_to_zero(donor.corners.end)) {
    for (int a = 0; a < 3; ++a) {
      int const d = orientation.axis[a];
      map.donor_origin[d] = orientation.sign[a] > 0 ? donor.nodes.begin[d] : donor.nodes.end[d] - 1;
    }
    why = "PointRangeDonor does not run as Transform says; taken as a range without direction";
  }
  // The own normal is the same node plane throughout, and so is the donor's.
  map.donor_origin[donor.normal] = donor.nodes.begin[donor.normal];
  return map;
}

}  // namespace detail

Interface1to1 interface_from_ranges(Mesh const& mesh, std::string name, int zone, PointRange const& range,
                                    int donor_zone, PointRange const& donor_range,
                                    std::array<int, 3> const& transform) {
  std::string const where = "interface '" + name + "': ";
  detail::FaceOfRange const own = face_of_range(mesh, where, zone, range),
                            donor = face_of_range(mesh, where, donor_zone, donor_range);
  std::string why;
  auto const map = detail::join_faces(own, donor, transform, why);
  if (!map)
    throw MeshError(where + "range " + text_of_range(range) + " with donor range " + text_of_range(donor_range) +
                    " and Transform [" + std::to_string(transform[0]) + ", " + std::to_string(transform[1]) + ", " +
                    std::to_string(transform[2]) + "]: " + why);
  Interface1to1 out;
  out.name = std::move(name);
  out.zone = zone;
  out.donor_zone = donor_zone;
  out.range = own.nodes;
  out.to_donor = *map;
  return out;
}

}  // namespace gridmorph
