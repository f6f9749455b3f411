#include <gridmorph/io/cgns/cgns_families.hpp>
#include <gridmorph/io/cgns/cgns_periodic.hpp>
#include <gridmorph/io/cgns/cgns_unstructured_boundary.hpp>
#include <gridmorph/io/cgns/cgns_unstructured_points.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <algorithm>

namespace gridmorph::cgns {

namespace {

/// Of the mesh size: single-precision coordinates agree to 1e-7 of their size.
constexpr double matching_tolerance = 1e-6;

class ConnectionReader {
 public:
  ConnectionReader(File const& file, Layout const& layout, std::vector<ListedFaces>& faces, Mesh& mesh,
                   Problems& problems)
      : file_(file),
        layout_(layout),
        faces_(faces),
        mesh_(mesh),
        problems_(problems),
        tolerance_(matching_tolerance * mesh.size()) {}

  void read(int z, Node const& node) {
    auto const& zone = layout_.zones[std::size_t(z)];
    where_ = file_.path() + ": zone '" + zone.name + "', connection '" + node.name + "'";
    auto const* type_node = node.labelled("GridConnectivityType_t");
    std::string const type = type_node ? file_.text(*type_node) : "Overset";  // the default of the SIDS
    auto const own = nodes_of(z, node);
    if (!own) return;
    if (type == "Abutting1to1" && matched(z, node, own->all)) return;
    Patch patch;
    patch.name = node.name;
    patch.bc_type = type;
    patch.kind = PatchKind::connection;
    patch.families = families_of(file_, node);
    patch.zone = z;
    patch.faces = own->faces;
    if (patch.faces.size() == 0) patch.nodes = sorted(own->all);
    mesh_.patches.push_back(std::move(patch));
  }

 private:
  struct Set {
    std::vector<Index32> all;  ///< nodes in the order of the file (ascending where it lists faces)
    CsrGraph faces;
  };

  void note(std::string const& what) { mesh_.notes.push_back(where_ + ": " + what); }

  static std::vector<Index32> sorted(std::vector<Index32> list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  }

  std::optional<Set> nodes_of(int z, Node const& node) {
    std::string why;
    std::int64_t const largest = largest_number(layout_.zones[std::size_t(z)], faces_[std::size_t(z)], mesh_, z);
    auto const set = read_number_set(file_, node, largest, why);
    if (!set) {
      note("skipped, " + why);
      return std::nullopt;
    }
    return to_nodes(z, *set, "names");
  }

  std::optional<Set> to_nodes(int z, NumberSet const& set, std::string const& verb) {
    auto const& zone = mesh_.zones[std::size_t(z)];
    auto& faces = faces_[std::size_t(z)];
    Set out;
    for (auto const n : set.numbers) {
      Index const face = set.nodes ? -1 : faces.find(n);
      if (set.nodes ? n < 1 || n > zone.size() : face < 0) {
        problems_.add(where_ + ": " + verb + (set.nodes ? " node " : " face ") + std::to_string(n) + ", which zone '" +
                      zone.name + "' does not have");
        return std::nullopt;
      }
      if (set.nodes) {
        out.all.push_back(Index32(n - 1 + zone.first_node));
      } else {
        faces.claimed[std::size_t(face)] = 1;
        out.faces.add(faces.nodes[face]);
      }
    }
    if (!set.nodes) out.all = sorted(out.faces.item);
    return out;
  }

  int find_zone(ZoneLayout const& own, std::string const& name) const {
    for (std::size_t d = 0; d < layout_.zones.size(); ++d)
      if (layout_.zones[d].base == own.base && layout_.zones[d].node->name == name) return int(d);
    for (std::size_t d = 0; d < layout_.zones.size(); ++d)
      if (layout_.zones[d].base->name + "/" + layout_.zones[d].node->name == name) return int(d);
    return -1;
  }

  /// What PointListDonor (or a donor range) names. Lists of cells are of no use here.
  std::optional<Set> donors(int donor_zone, Node const& node, bool own_are_nodes) {
    for (auto const* name : {"PointListDonor", "PointRangeDonor"})
      if (auto const* list = node.child(name)) {
        NumberSet set;
        set.nodes = own_are_nodes;
        set.numbers = file_.integers(*list);
        return to_nodes(donor_zone, set, "names donor");
      }
    return std::nullopt;
  }

  bool matched(int z, Node const& node, std::vector<Index32> const& own) {
    auto const& zone = layout_.zones[std::size_t(z)];
    int const donor = find_zone(zone, file_.text(node));
    if (donor < 0) {
      note("is Abutting1to1, but donor zone '" + file_.text(node) + "' is not in the file; kept as a patch");
      return false;
    }
    auto const* location = node.labelled("GridLocation_t");
    bool const by_nodes = !location || file_.text(*location) == "Vertex";
    Connection c;
    c.name = node.name;
    c.families = families_of(file_, node);
    c.zone = z;
    c.donor_zone = donor;
    c.periodic = read_periodic(file_, *zone.base, *zone.node, node, where_, mesh_.notes);
    auto const others = donors(donor, node, by_nodes);
    if (others && by_nodes && others->all.size() == own.size()) {
      c.nodes = own;
      c.donor_nodes = others->all;
      if (largest_mismatch(mesh_, c) <= tolerance_) {
        mesh_.connections.push_back(std::move(c));
        return true;
      }
    }
    return by_position(std::move(c), own, others);
  }

  bool by_position(Connection c, std::vector<Index32> const& own, std::optional<Set> const& others) {
    c.nodes = sorted(own);
    std::vector<Index32> const candidates =
        others && !others->all.empty() ? others->all : sorted(faces_[std::size_t(c.donor_zone)].nodes.item);
    c.donor_nodes = match_points(mesh_.coordinates, c.nodes, candidates, tolerance_, c.periodic);
    auto const missing = std::count(c.donor_nodes.begin(), c.donor_nodes.end(), -1);
    if (missing > 0) {
      note("is Abutting1to1, but " + std::to_string(missing) + " of its " + std::to_string(c.nodes.size()) +
           " nodes have none within " + std::to_string(tolerance_) + " in zone '" +
           mesh_.zones[std::size_t(c.donor_zone)].name + "'; kept as a patch");
      return false;
    }
    if (others && !others->all.empty() && others->faces.size() == 0)
      note("its lists do not pair nodes that coincide; they are paired by position");
    mesh_.connections.push_back(std::move(c));
    return true;
  }

  File const& file_;
  Layout const& layout_;
  std::vector<ListedFaces>& faces_;
  Mesh& mesh_;
  Problems& problems_;
  double tolerance_;
  std::string where_;  ///< the connection being read
};

}  // namespace

void read_connections(File const& file, Layout const& layout, std::vector<ListedFaces>& faces, Mesh& mesh,
                      Problems& problems) {
  ConnectionReader reader(file, layout, faces, mesh, problems);
  for (std::size_t z = 0; z < layout.zones.size(); ++z)
    for (auto const* connectivity : layout.zones[z].node->all("ZoneGridConnectivity_t"))
      for (auto const& node : connectivity->children)
        if (node.label == "GridConnectivity_t") reader.read(int(z), node);
}

}  // namespace gridmorph::cgns
