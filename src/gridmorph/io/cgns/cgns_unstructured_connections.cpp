#include <gridmorph/core/text.hpp>
#include <gridmorph/io/cgns/cgns_boundary.hpp>
#include <gridmorph/io/cgns/cgns_families.hpp>
#include <gridmorph/io/cgns/cgns_periodic.hpp>
#include <gridmorph/io/cgns/cgns_ranges.hpp>
#include <gridmorph/io/cgns/cgns_unstructured_boundary.hpp>
#include <gridmorph/io/cgns/cgns_unstructured_points.hpp>
#include <gridmorph/mesh/block_elements.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace gridmorph::cgns {

namespace {

class ConnectionReader {
 public:
  ConnectionReader(File const& file, Layout const& layout, std::vector<ListedFaces>& faces, Mesh& mesh,
                   Problems& problems)
      : file_(file),
        layout_(layout),
        faces_(faces),
        mesh_(mesh),
        problems_(problems),
        tolerance_(place_tolerance(1e-6, mesh.size(), coordinate_resolution(mesh))) {}

  void read(int z, Node const& node) {
    auto const& zone = layout_.zones[z];
    bool const connects = node.label == "GridConnectivity_t" || node.label == "GridConnectivity1to1_t";
    if (!connects) {
      if (zone.is_block()) read_block_connection(file_, layout_, z, node, mesh_, problems_);
      return;
    }
    bool const one_to_one = node.label == "GridConnectivity1to1_t";
    where_ =
        file_.path() + ": zone '" + zone.name + "', " + (one_to_one ? "interface '" : "connection '") + node.name + "'";
    int const donor = find_donor(layout_, zone, file_.text(node));
    bool const to_block = donor >= 0 && layout_.zones[donor].is_block();
    if (zone.is_block() && (to_block || donor < 0)) return between_blocks(z, node);
    if (one_to_one && !zone.is_block() && !to_block) return;  // not for unstructured zones (SIDS)
    auto const* type_node = node.labelled("GridConnectivityType_t");
    std::string const type = one_to_one  ? "Abutting1to1"
                             : type_node ? file_.text(*type_node)
                                         : "Overset";  // the default of the SIDS
    auto const own = nodes_of(z, node);
    if (!own) return;
    if (type == "Abutting1to1" && matched(z, node, own->all)) return;
    Patch patch;
    patch.name = node.name;
    patch.bc_type = type;
    patch.kind = PatchKind::connection;
    patch.families = families_of(file_, *layout_.zones[z].base, node);
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

  /// A connection of blocks alone, as the reader of blocks has it.
  void between_blocks(int z, Node const& node) {
    std::size_t const first = mesh_.patches.size();
    read_block_connection(file_, layout_, z, node, mesh_, problems_);
    for (std::size_t p = first; p < mesh_.patches.size(); ++p)
      mesh_.patches[p] = as_faces(mesh_, std::move(mesh_.patches[p]));
    for (auto const& face : mesh_.interfaces) {
      mesh_.connections.push_back(node_pairs(mesh_, face));
      double const apart = largest_mismatch(mesh_, mesh_.connections.back());
      if (!(apart <= tolerance_))
        problems_.add(where_ + ": joins nodes that are " + to_text(apart, 3) + " apart (tolerance " +
                      to_text(tolerance_, 3) + ")");
    }
    mesh_.interfaces.clear();
  }

  std::optional<Set> nodes_of_points(int z, std::vector<Index3> const& points, std::string const& verb) {
    auto const& zone = layout_.zones[z];
    Set out;
    for (auto const& p : points) {
      if (!inside(zone, {p, p})) {
        problems_.add(where_ + ": " + verb + " node " + to_string(Corners{p, p}, zone.index_dimension) +
                      ", which zone '" + zone.name + "' does not have");
        return std::nullopt;
      }
      out.all.push_back(Index32(mesh_.zones[z].node({p[0] - 1, p[1] - 1, p[2] - 1})));
    }
    return out;
  }

  /// The nodes of a block that a set names: nodes one by one, or a rectangle of faces.
  std::optional<Set> nodes_of_block(int z, Node const& node) {
    auto const& zone = layout_.zones[z];
    std::string why;
    auto const set = read_point_set(file_, zone, node, why);
    if (!set) {
      note("skipped, " + why);
      return std::nullopt;
    }
    auto const face = face_range(zone, *set);
    if (face.misfit == Misfit::out_of_bounds) {
      problems_.add(where_ + ": " + face.why);
      return std::nullopt;
    }
    bool const nodes = set->location == Location::vertex && !set->elements;
    if (face.misfit == Misfit::not_a_face && !nodes) {
      note("skipped, " + face.why);
      return std::nullopt;
    }
    Set out;
    if (nodes) out = *nodes_of_points(z, set->points.empty() ? all_points(set->corners) : set->points, "names");
    if (face.misfit == Misfit::none) add_faces(mesh_.zones[z], face.range, out.faces);
    if (!nodes) out.all = sorted(out.faces.item);
    return out;
  }

  std::optional<Set> nodes_of(int z, Node const& node) {
    if (layout_.zones[z].is_block()) return nodes_of_block(z, node);
    std::string why;
    std::int64_t const largest = largest_number(layout_.zones[z], faces_[z], mesh_, z);
    auto const set = read_number_set(file_, node, largest, why);
    if (!set) {
      note("skipped, " + why);
      return std::nullopt;
    }
    return to_nodes(z, *set, "names");
  }

  std::optional<Set> to_nodes(int z, NumberSet const& set, std::string const& verb) {
    auto const& zone = mesh_.zones[z];
    auto& faces = faces_[z];
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
        faces.claimed[face] = 1;
        out.faces.add(faces.nodes[face]);
      }
    }
    if (!set.nodes) out.all = sorted(out.faces.item);
    return out;
  }

  /// What PointListDonor (or a donor range) names. Lists of cells are of no use here.
  std::optional<Set> donors(int donor_zone, Node const& node, bool own_are_nodes) {
    for (auto const* name : {"PointListDonor", "PointRangeDonor"})
      if (auto const* list = node.child(name)) {
        if (layout_.zones[donor_zone].is_block())
          return own_are_nodes ? donors_in_block(donor_zone, *list) : std::nullopt;
        // The range of a 1-to-1 interface is one of indices, which elements do not have.
        if (node.label == "GridConnectivity1to1_t") return std::nullopt;
        NumberSet set;
        set.nodes = own_are_nodes;
        set.numbers = file_.integers(*list);
        return to_nodes(donor_zone, set, "names donor");
      }
    return std::nullopt;
  }

  std::optional<Set> donors_in_block(int donor_zone, Node const& list) {
    auto const& zone = layout_.zones[donor_zone];
    auto const points = read_tuples(file_, list, zone.index_dimension);
    bool const range = list.label == "IndexRange_t";
    if (!points || (range && points->size() != 2)) {
      note(list.name + " does not hold " + (range ? "two corners" : "whole index tuples") + " of zone '" + zone.name +
           "'; its nodes are found by position");
      return std::nullopt;
    }
    auto out = nodes_of_points(donor_zone, *points, "names donor");
    return out && range ? nodes_of_points(donor_zone, all_points({(*points)[0], (*points)[1]}), "names donor") : out;
  }

  /// Where the donors of a zone's nodes are looked for that the file does not list: at the faces that it lists, or all
  /// round a block. Elements may leave out the faces that a block lies behind.
  std::vector<Index32> possible_donors(int zone, int donor) {
    auto const& there = mesh_.zones[donor];
    if (there.is_block()) {
      CsrGraph faces;
      for (int axis = 0; axis < 3; ++axis) {
        if (there.extent[axis] < 2) continue;
        for (int const at : {0, there.extent[axis] - 1}) {
          IndexRange side{{0, 0, 0}, there.extent};
          side.begin[axis] = at;
          side.end[axis] = at + 1;
          add_faces(there, side, faces);
        }
      }
      return sorted(std::move(faces.item));
    }
    if (!mesh_.zones[zone].is_block()) return sorted(faces_[donor].nodes.item);
    std::vector<Index32> all(there.size());
    std::iota(all.begin(), all.end(), Index32(there.first_node));
    return all;
  }

  bool matched(int z, Node const& node, std::vector<Index32> const& own) {
    auto const& zone = layout_.zones[z];
    int const donor = find_donor(layout_, zone, file_.text(node));
    if (donor < 0) {
      note("is Abutting1to1, but donor zone '" + file_.text(node) + "' is not in the file; kept as a patch");
      return false;
    }
    auto const* location = node.labelled("GridLocation_t");
    bool const by_nodes = !location || file_.text(*location) == "Vertex";
    Connection c;
    c.name = node.name;
    c.families = families_of(file_, *layout_.zones[z].base, node);
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
        others && !others->all.empty() ? others->all : possible_donors(c.zone, c.donor_zone);
    c.donor_nodes = match_points(mesh_.coordinates, c.nodes, candidates, tolerance_, c.periodic);
    auto const missing = std::count(c.donor_nodes.begin(), c.donor_nodes.end(), -1);
    if (missing > 0) {
      note("is Abutting1to1, but " + std::to_string(missing) + " of its " + std::to_string(c.nodes.size()) +
           " nodes have none within " + std::to_string(tolerance_) + " in zone '" + mesh_.zones[c.donor_zone].name +
           "'; kept as a patch");
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
      for (auto const& node : connectivity->children) reader.read(int(z), node);
}

}  // namespace gridmorph::cgns
