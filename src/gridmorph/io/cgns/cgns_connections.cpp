#include <gridmorph/io/blanks.hpp>
#include <gridmorph/io/cgns/cgns_boundary.hpp>
#include <gridmorph/io/cgns/cgns_families.hpp>
#include <gridmorph/io/cgns/cgns_interface.hpp>
#include <gridmorph/io/cgns/cgns_periodic.hpp>
#include <gridmorph/io/cgns/cgns_ranges.hpp>

#include <algorithm>

namespace gridmorph::cgns {

namespace {

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

    std::vector<std::int64_t> transform(std::size_t(zone.index_dimension));
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
    mesh.notes.push_back(file.path() + ": zone '" + layout.zones[std::size_t(zone)].name + "', overset holes '" +
                         node.name + "': left alone, holes play no part in morphing");
  if (node.label == "GridConnectivity1to1_t") reader.one_to_one(zone, node);
  if (node.label == "GridConnectivity_t") reader.general(zone, node);
}

void read_connections(File const& file, Layout const& layout, Mesh& mesh, Problems& problems) {
  for (std::size_t z = 0; z < layout.zones.size(); ++z)
    for (auto const* connectivity : layout.zones[z].node->all("ZoneGridConnectivity_t"))
      for (auto const& node : connectivity->children) read_block_connection(file, layout, int(z), node, mesh, problems);
}

}  // namespace gridmorph::cgns
