#include <gridmorph/io/blanks.hpp>
#include <gridmorph/io/cgns/cgns_boundary.hpp>
#include <gridmorph/io/cgns/cgns_families.hpp>
#include <gridmorph/io/cgns/cgns_periodic.hpp>
#include <gridmorph/io/cgns/cgns_ranges.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace gridmorph::cgns {

namespace {

/// The two ranges of a matching connection as an index map.
struct Joined {
  enum class Outcome { joined, skipped, wrong };
  Outcome outcome = Outcome::joined;
  std::string why;   ///< the reason unless joined; where joined, what was assumed (may be empty)
  IndexRange range;  ///< own nodes, ascending
  IndexMap to_donor;
};

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

/// Joins two vertex ranges through a SIDS Transform: Index2 = T.(Index1 - Begin1) + Begin2. Both ranges are inside
/// their zones.
///
/// A zero in Transform is rebuilt: its axis goes to the donor axis nobody else goes to, in the direction that the
/// ranges run, or for the face normal in the direction that leads out of one zone into the other. The sign for the
/// normal is not needed to match nodes, and files are seen with either; the map always continues into the donor.
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

/// Axis and sign of a unit step; nothing for any other step.
std::optional<std::pair<int, int>> unit_step(Index3 const& d) {
  if (std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]) != 1) return std::nullopt;
  int const axis = d[0] != 0 ? 0 : d[1] != 0 ? 1 : 2;
  return std::pair{axis, d[axis]};
}

/// Joins two point sets whose points correspond one by one, if they are rectangles and the correspondence is a signed
/// permutation of the axes. `own_face` is the node range of `own`; donor points are two corners if `donor_is_range`.
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

class ConnectionReader {
 public:
  ConnectionReader(File const& file, Layout const& layout, Mesh& mesh, Problems& problems)
      : file_(file), layout_(layout), mesh_(mesh), problems_(problems) {}

  void one_to_one(int z, Node const& node) {
    auto const& zone = layout_.zones[z];
    where_ = file_.path() + ": zone '" + zone.name + "', interface '" + node.name + "'";
    Interface1to1 face = start(z, node);
    auto const own = corners(node, "PointRange", zone);
    if (!own) return;
    if (!inside(zone, *own)) return outside(zone, *own, "range");
    if (leads_out(zone, file_.text(node))) return one_sided(z, node, *own);
    face.donor_zone = donor_zone(zone, file_.text(node), *own);
    if (face.donor_zone < 0) return;
    auto const& donor = layout_.zones[face.donor_zone];
    auto const other = corners(node, "PointRangeDonor", donor);
    if (!other) return;
    if (!inside(donor, *other)) return outside(donor, *other, "donor range");

    std::vector<std::int64_t> transform(zone.index_dimension);
    for (std::size_t a = 0; a < transform.size(); ++a) transform[a] = std::int64_t(a) + 1;
    if (auto const* t = node.child("Transform")) transform = file_.integers(*t);
    auto const joined = join(zone, *own, donor, *other, transform);
    if (joined.outcome == Joined::Outcome::skipped) return note("skipped, " + joined.why);
    if (joined.outcome == Joined::Outcome::wrong) return problem(joined.why);
    if (!joined.why.empty()) note(joined.why);
    face.range = joined.range;
    face.to_donor = joined.to_donor;
    face.periodic = read_periodic(file_, *zone.base, *zone.node, node, where_, mesh_.notes);
    mesh_.interfaces.push_back(std::move(face));
  }

  void general(int z, Node const& node) {
    auto const& zone = layout_.zones[z];
    where_ = file_.path() + ": zone '" + zone.name + "', connection '" + node.name + "'";
    auto const* type_node = node.labelled("GridConnectivityType_t");
    std::string const type = type_node ? file_.text(*type_node) : "Overset";  // the default of the SIDS
    std::string why;
    auto const set = read_point_set(file_, zone, node, why);
    if (!set) return note("skipped, " + why);
    auto const face = face_range(zone, *set);
    if (face.misfit == Misfit::out_of_bounds) return problem(face.why);
    if (type == "Abutting1to1" && matched(z, node, *set, face)) return;
    if (face.misfit == Misfit::not_a_face) return note("skipped, " + face.why);
    Patch patch;
    patch.name = node.name;
    patch.bc_type = type;
    patch.kind = PatchKind::connection;
    patch.families = families_of(file_, *layout_.zones[z].base, node);
    patch.zone = z;
    patch.range = face.range;
    mesh_.patches.push_back(std::move(patch));
  }

 private:
  void problem(std::string const& what) { problems_.add(where_ + ": " + what); }
  void note(std::string const& what) { mesh_.notes.push_back(where_ + ": " + what); }
  void outside(ZoneLayout const& zone, Corners const& found, std::string const& which) {
    problem(which + " " + to_string(found, zone.index_dimension) + " is outside zone '" + zone.name + "', which is " +
            to_string(Corners{{1, 1, 1}, zone.extent}, zone.index_dimension));
  }

  Interface1to1 start(int z, Node const& node) const {
    Interface1to1 face;
    face.name = node.name;
    face.families = families_of(file_, *layout_.zones[z].base, node);
    face.zone = z;
    return face;
  }

  std::optional<Corners> corners(Node const& node, std::string_view name, ZoneLayout const& zone) {
    auto const* range = node.child(name);
    auto const tuples = range ? read_tuples(file_, *range, zone.index_dimension) : std::nullopt;
    if (tuples && tuples->size() == 2) return Corners{(*tuples)[0], (*tuples)[1]};
    problem(std::string(name) + (range ? " does not hold two corners" : " is missing"));
    return std::nullopt;
  }

  /// Whether a donor is one of the zones that are left out.
  bool leads_out(ZoneLayout const& zone, std::string const& donor) const {
    if (find_donor(layout_, zone, donor) >= 0) return false;
    auto const slash = donor.find('/');
    bool const whole = slash != std::string::npos;
    return is_left_out(layout_.leave_out, whole ? donor.substr(0, slash) : zone.base->name,
                       whole ? donor.substr(slash + 1) : donor);
  }

  void one_sided(int z, Node const& node, Corners const& own) {
    auto const& zone = layout_.zones[z];
    IndexRange const range = node_range(zone, own);
    if (!face_normal(zone, range)) return note("skipped, it leads to a zone that is left out and is on no face");
    note("leads to zone '" + file_.text(node) + "', which is left out; taken as a patch");
    mesh_.patches.push_back(
        {node.name, "Abutting1to1", PatchKind::connection, families_of(file_, *layout_.zones[z].base, node), z, range});
  }

  int donor_zone(ZoneLayout const& zone, std::string const& name, Corners const& range) {
    int const donor = find_donor(layout_, zone, name);
    if (donor < 0) {
      std::string there;
      for (auto const& z : layout_.zones)
        if (there.size() < 200) there += (there.empty() ? "'" : ", '") + z.name + "'";
      problem("range " + to_string(range, zone.index_dimension) + " names donor zone '" + name +
              "', which the file does not have (zones: " + there +
              "); correct the connection, or name the donor in leave_out "
              "to have this face as a patch");
    }
    return donor;
  }

  /// An Abutting1to1 connection between structured zones that is a 1-to-1 interface in other words. False: it is not,
  /// and stays a patch.
  bool matched(int z, Node const& node, PointSet const& own, FaceRange const& face_found) {
    auto const& zone = layout_.zones[z];
    int const donor_number = find_donor(layout_, zone, file_.text(node));
    if (donor_number < 0 || face_found.misfit != Misfit::none) {
      note("is Abutting1to1, but " +
           (donor_number < 0 ? "donor zone '" + file_.text(node) + "' is not in the file" : face_found.why) +
           "; kept as a patch");
      return false;
    }
    auto const& donor = layout_.zones[donor_number];
    auto const* donor_node = node.child("PointListDonor");
    if (!donor_node) donor_node = node.child("PointRangeDonor");
    auto const tuples = donor_node ? read_tuples(file_, *donor_node, donor.index_dimension) : std::nullopt;
    if (!tuples) {
      note("is Abutting1to1 without PointListDonor; kept as a patch");
      return false;
    }
    auto const joined = join_lists(zone, own, face_found.range, donor, *tuples, donor_node->label == "IndexRange_t");
    if (joined.outcome != Joined::Outcome::joined) {
      note("is Abutting1to1, but " + joined.why + "; kept as a patch");
      return false;
    }
    Interface1to1 face = start(z, node);
    face.donor_zone = donor_number;
    face.range = joined.range;
    face.to_donor = joined.to_donor;
    face.periodic = read_periodic(file_, *zone.base, *zone.node, node, where_, mesh_.notes);
    mesh_.interfaces.push_back(std::move(face));
    return true;
  }

  File const& file_;
  Layout const& layout_;
  Mesh& mesh_;
  Problems& problems_;
  std::string where_;  ///< the connection being read
};

}  // namespace

int find_donor(Layout const& layout, ZoneLayout const& zone, std::string const& name) {
  auto const find = [&](auto const& is_meant) {
    auto const at = std::find_if(layout.zones.begin(), layout.zones.end(), is_meant);
    return at == layout.zones.end() ? -1 : int(at - layout.zones.begin());
  };
  // Texts lose the blanks at their end where they are read, names of zones keep them; a zone of the very name goes
  // first.
  for (bool const exactly : {true, false}) {
    auto const is_it = [&](std::string const& own) {
      return exactly ? own == name : io::without_blanks_around(own) == io::without_blanks_around(name);
    };
    int out = find([&](ZoneLayout const& z) { return z.base == zone.base && is_it(z.node->name); });
    if (out < 0) out = find([&](ZoneLayout const& z) { return is_it(z.base->name + "/" + z.node->name); });
    if (out >= 0) return out;
  }
  return -1;
}

void read_block_connection(File const& file, Layout const& layout, int zone, Node const& node, Mesh& mesh,
                           Problems& problems) {
  ConnectionReader reader(file, layout, mesh, problems);
  if (node.label == "OversetHoles_t")
    mesh.notes.push_back(file.path() + ": zone '" + layout.zones[zone].name + "', overset holes '" + node.name +
                         "': left alone, holes play no part in morphing");
  if (node.label == "GridConnectivity1to1_t") reader.one_to_one(zone, node);
  if (node.label == "GridConnectivity_t") reader.general(zone, node);
}

void read_connections(File const& file, Layout const& layout, Mesh& mesh, Problems& problems) {
  for (std::size_t z = 0; z < layout.zones.size(); ++z)
    for (auto const* connectivity : layout.zones[z].node->all("ZoneGridConnectivity_t"))
      for (auto const& node : connectivity->children) read_block_connection(file, layout, int(z), node, mesh, problems);
}

}  // namespace gridmorph::cgns
