#include <gridmorph/io/cgns/cgns_ranges.hpp>

#include <algorithm>
#include <limits>
#include <set>

namespace gridmorph::cgns {

namespace {

Location location_of(File const& file, Node const& owner, bool& known) {
  auto const* node = owner.labelled("GridLocation_t");
  known = true;
  if (!node) return Location::vertex;
  std::string const text = file.text(*node);
  if (text == "FaceCenter" || text == "EdgeCenter") return Location::face;
  if (text == "IFaceCenter") return Location::i_face;
  if (text == "JFaceCenter") return Location::j_face;
  if (text == "KFaceCenter") return Location::k_face;
  if (text == "CellCenter") return Location::cell;
  known = text == "Vertex" || text == "Null" || text == "UserDefined";
  return Location::vertex;
}

Corners bounding_box(std::vector<Index3> const& points) {
  Corners box{points.front(), points.front()};
  for (auto const& p : points)
    for (int a = 0; a < 3; ++a) {
      box.begin[a] = std::min(box.begin[a], p[a]);
      box.end[a] = std::max(box.end[a], p[a]);
    }
  return box;
}

bool fills_box(std::vector<Index3> const& points, Corners const& box) {
  Index size = 1;
  for (int a = 0; a < 3; ++a) {
    size *= Index(box.end[a]) - box.begin[a] + 1;
    if (size > Index(points.size())) return false;
  }
  return Index(std::set<Index3>(points.begin(), points.end()).size()) == size;
}

/// The axis that a box of faces is normal to. A box one face wide may fit several axes; then the one whose face it
/// covers entirely is meant (the usual case in meshes one cell thick), and if that does not decide there is no answer.
std::optional<int> normal_of_faces(ZoneLayout const& zone, Corners const& faces, Location location) {
  std::vector<int> fitting, covering;
  for (int a = 0; a < 3; ++a) {
    if (a == zone.flat_axis) continue;
    if (location == Location::i_face && a != 0) continue;
    if (location == Location::j_face && a != 1) continue;
    if (location == Location::k_face && a != 2) continue;
    if (faces.begin[a] != faces.end[a]) continue;
    if (location == Location::face && faces.begin[a] != 1 && faces.begin[a] != zone.extent[a]) continue;
    bool fits = faces.begin[a] >= 1 && faces.begin[a] <= zone.extent[a];
    bool covers = true;
    for (int t = 0; t < 3; ++t) {
      if (t == a || t == zone.flat_axis) continue;
      fits = fits && faces.begin[t] >= 1 && faces.end[t] <= zone.extent[t] - 1;
      covers = covers && faces.begin[t] == 1 && faces.end[t] == zone.extent[t] - 1;
    }
    if (fits) fitting.push_back(a);
    if (fits && covers) covering.push_back(a);
  }
  if (fitting.size() == 1) return fitting.front();
  if (covering.size() == 1) return covering.front();
  return std::nullopt;
}

/// Whether a box reaches the last node along an axis of its own face: faces are one fewer than nodes and never do.
bool reaches_like_nodes(ZoneLayout const& zone, Corners const& box) {
  int reached = 0, thin = 0;
  for (int a = 0; a < 3; ++a) {
    if (a == zone.flat_axis) continue;
    bool const single = box.begin[a] == box.end[a];
    thin += single;
    reached += !single && box.end[a] == zone.extent[a];
  }
  return thin == 1 && reached >= 1 && inside(zone, box);
}

}  // namespace

std::string to_string(Corners const& corners, int index_dimension) {
  std::string out = "[";
  for (int a = 0; a < index_dimension; ++a)
    out += (a ? ", " : "") + std::to_string(corners.begin[a]) + ":" + std::to_string(corners.end[a]);
  return out + "]";
}

std::optional<std::vector<Index3>> read_tuples(File const& file, Node const& node, int index_dimension) {
  auto const values = file.integers(node);
  if (values.empty() || Index(values.size()) % index_dimension != 0) return std::nullopt;
  std::vector<Index3> points(values.size() / std::size_t(index_dimension), Index3{1, 1, 1});
  for (std::size_t v = 0; v < values.size(); ++v) {
    // Numbers that fit no zone stay what they are for the message, as far as an int can hold them.
    auto const clamped =
        std::clamp<std::int64_t>(values[v], std::numeric_limits<int>::min() / 4, std::numeric_limits<int>::max() / 4);
    points[v / std::size_t(index_dimension)][v % std::size_t(index_dimension)] = int(clamped);
  }
  return points;
}

std::optional<PointSet> read_point_set(File const& file, ZoneLayout const& zone, Node const& owner, std::string& why) {
  PointSet set;
  for (auto const& child : owner.children) {
    bool const range = child.label == "IndexRange_t" && (child.name == "PointRange" || child.name == "ElementRange");
    bool const list = child.label == "IndexArray_t" && (child.name == "PointList" || child.name == "ElementList");
    if (!range && !list) continue;
    auto points = read_tuples(file, child, zone.index_dimension);
    if (!points || (range && points->size() != 2)) {
      why = child.name + " does not hold " + (range ? "two corners" : "whole index tuples");
      return std::nullopt;
    }
    set.elements = child.name.starts_with("Element");
    bool known = true;
    set.location = location_of(file, owner, known);
    if (!known) {
      why = "its GridLocation '" + file.text(*owner.labelled("GridLocation_t")) + "' is not known";
      return std::nullopt;
    }
    if (range) {
      set.corners = {(*points)[0], (*points)[1]};
    } else {
      set.points = std::move(*points);
      set.corners = bounding_box(set.points);
    }
    return set;
  }
  why = "it has neither PointRange nor PointList";
  return std::nullopt;
}

bool inside(ZoneLayout const& zone, Corners const& corners) {
  for (int a = 0; a < 3; ++a)
    if (std::min(corners.begin[a], corners.end[a]) < 1 || std::max(corners.begin[a], corners.end[a]) > zone.extent[a])
      return false;
  return true;
}

std::vector<Index3> all_points(Corners const& c) {
  std::vector<Index3> out;
  auto const direction = [](int from, int to) { return to < from ? -1 : 1; };
  int const si = direction(c.begin[0], c.end[0]), sj = direction(c.begin[1], c.end[1]),
            sk = direction(c.begin[2], c.end[2]);
  for (int k = c.begin[2]; k != c.end[2] + sk; k += sk)
    for (int j = c.begin[1]; j != c.end[1] + sj; j += sj)
      for (int i = c.begin[0]; i != c.end[0] + si; i += si) out.push_back({i, j, k});
  return out;
}

IndexRange node_range(ZoneLayout const& zone, Corners const& corners) {
  IndexRange range;
  for (int a = 0; a < 3; ++a) {
    range.begin[a] = std::min(corners.begin[a], corners.end[a]) - 1;
    range.end[a] = std::max(corners.begin[a], corners.end[a]);
    if (a == zone.flat_axis) range.end[a] = 2;
  }
  return range;
}

std::optional<int> face_normal(ZoneLayout const& zone, IndexRange const& range) {
  std::optional<int> normal;
  for (int a = 0; a < 3; ++a) {
    if (range.extent(a) != 1) continue;
    if (normal) return std::nullopt;
    normal = a;
  }
  if (!normal) return std::nullopt;
  bool const first = range.begin[*normal] == 0;
  bool const last = range.end[*normal] == zone.mesh_extent()[*normal];
  return first || last ? normal : std::nullopt;
}

FaceRange face_range(ZoneLayout const& zone, PointSet const& set) {
  FaceRange out;
  Corners box = set.corners;
  for (int a = 0; a < 3; ++a)
    if (box.begin[a] > box.end[a]) std::swap(box.begin[a], box.end[a]);
  std::string const shown = to_string(set.corners, zone.index_dimension);
  if (!inside(zone, box)) {
    out.misfit = Misfit::out_of_bounds;
    Corners const whole{{1, 1, 1}, zone.extent};
    out.why = "range " + shown + " is outside the zone, which is " + to_string(whole, zone.index_dimension);
    return out;
  }
  if (!set.points.empty() && !fills_box(set.points, box)) {
    out.misfit = Misfit::not_a_face;
    out.why = "its list of " + std::to_string(set.points.size()) + " points does not fill the rectangle " + shown;
    return out;
  }
  bool const as_faces = set.location != Location::vertex || set.elements;
  if (as_faces && !reaches_like_nodes(zone, box)) {
    // CellCenter on a boundary means the cells behind it in 3-D, but edges are what bounds a 2-D zone.
    Location const location = set.location == Location::vertex ? Location::face : set.location;
    auto const normal = location == Location::cell && zone.flat_axis < 0
                            ? std::nullopt
                            : normal_of_faces(zone, box, location == Location::cell ? Location::face : location);
    if (!normal) {
      out.misfit = Misfit::not_a_face;
      out.why = location == Location::cell ? "range " + shown + " counts cells (CellCenter), not faces or nodes"
                                           : "range " + shown + " of faces is not clearly on one face of the zone";
      return out;
    }
    for (int a = 0; a < 3; ++a)
      if (a != *normal && a != zone.flat_axis) ++box.end[a];
  }
  out.range = node_range(zone, box);
  if (!face_normal(zone, out.range)) {
    out.misfit = Misfit::not_a_face;
    int thick = 0;
    for (int a = 0; a < 3; ++a) thick += out.range.extent(a) > 1;
    out.why = "range " + shown +
              (thick == 3   ? zone.flat_axis >= 0 ? " is the whole plane of a 2-D zone" : " is a volume"
               : thick == 2 ? " is inside the zone, not on a face of it"
               : thick == 1 ? " is a line"
                            : " is a point");
  }
  return out;
}

}  // namespace gridmorph::cgns
