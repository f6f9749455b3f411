#include <gridmorph/io/cgns/cgns_boundary.hpp>
#include <gridmorph/io/cgns/cgns_families.hpp>
#include <gridmorph/io/cgns/cgns_unstructured_boundary.hpp>
#include <gridmorph/io/cgns/cgns_unstructured_points.hpp>
#include <gridmorph/mesh/block_elements.hpp>

#include <algorithm>
#include <utility>

namespace gridmorph::cgns {

namespace {

class BoundaryReader {
 public:
  BoundaryReader(File const& file, Node const& tree, Layout const& layout, std::vector<ListedFaces>& faces, Mesh& mesh,
                 Problems& problems)
      : file_(file), tree_(tree), layout_(layout), faces_(faces), mesh_(mesh), problems_(problems) {}

  void zone(int z) {
    auto const& zone = layout_.zones[z];
    if (zone.is_block()) return block(z);
    std::int64_t const largest = largest_number(zone, faces_[z], mesh_, z);
    for (auto const* zone_bc : zone.node->all("ZoneBC_t"))
      for (auto const* bc : zone_bc->all("BC_t")) condition(z, *bc, largest);
    smaller();
    sections(z);
  }

 private:
  void block(int z) {
    std::size_t const first = mesh_.patches.size();
    read_block_boundary(file_, tree_, layout_, z, mesh_, problems_);
    for (std::size_t p = first; p < mesh_.patches.size(); ++p)
      mesh_.patches[p] = as_faces(mesh_, std::move(mesh_.patches[p]));
  }

  void condition(int z, Node const& bc, std::int64_t largest) {
    auto const& zone = layout_.zones[z];
    where_ = file_.path() + ": zone '" + zone.name + "', BC '" + bc.name + "'";
    Patch patch;
    patch.name = bc.name;
    patch.zone = z;
    patch.families = families_of(file_, *zone.base, bc);
    // Meshers that call condition and family alike may leave out the name of the family.
    bool const alike = patch.families.empty() &&
                       std::find(mesh_.families.begin(), mesh_.families.end(), bc.name) != mesh_.families.end();
    if (alike) patch.families.push_back(bc.name);
    std::string const unknown = take_bc_type(file_, tree_, *zone.base, bc, patch);
    std::string why;
    auto const set = read_number_set(file_, bc, largest, why);
    if (!set) {
      if (!take_section(z, patch)) return note("skipped, " + why);
      note("has no point set; the elements '" + taken_ + "' are taken");
    } else if (set->nodes) {
      if (!add_nodes(z, set->numbers, patch)) return;
      if (take_section(z, patch)) note("is a list of nodes; its faces are those of the elements '" + taken_ + "'");
    } else if (!add_faces(z, set->numbers, patch)) {
      return;
    }
    if (patch.nodes.empty() && patch.faces.size() == 0) return note("skipped, its point set is empty");
    if (!unknown.empty()) note(unknown);
    mesh_.patches.push_back(std::move(patch));
  }

  /// Programs that name every piece of geometry (Gmsh) have conditions on its corners and edges too.
  void smaller() {
    if (n_smaller_ > 0)
      mesh_.notes.push_back(first_smaller_ +
                            (n_smaller_ > 1 ? " and " + std::to_string(n_smaller_ - 1) + " more of the zone" : "") +
                            ": left alone, of points or edges, which are no part of the boundary");
    n_smaller_ = 0;
  }

  void note(std::string const& what) { mesh_.notes.push_back(where_ + ": " + what); }

  bool add_nodes(int z, std::vector<std::int64_t> const& numbers, Patch& patch) {
    auto const& zone = mesh_.zones[z];
    for (auto const n : numbers) {
      if (n < 1 || n > zone.size()) {
        problems_.add(where_ + ": names node " + std::to_string(n) + ", but the zone has " +
                      std::to_string(zone.size()) + " nodes");
        return false;
      }
      patch.nodes.push_back(Index32(n - 1 + zone.first_node));
    }
    std::sort(patch.nodes.begin(), patch.nodes.end());
    patch.nodes.erase(std::unique(patch.nodes.begin(), patch.nodes.end()), patch.nodes.end());
    return true;
  }

  bool add_faces(int z, std::vector<std::int64_t> const& numbers, Patch& patch) {
    auto& faces = faces_[z];
    if (!numbers.empty() &&
        std::all_of(numbers.begin(), numbers.end(), [&](auto const n) { return faces.is_smaller(n); })) {
      if (n_smaller_++ == 0) first_smaller_ = where_;
      return false;
    }
    Index missing = 0;
    std::int64_t first = 0;
    for (auto const n : numbers) {
      Index const face = faces.find(n);
      if (face < 0) {
        if (missing++ == 0) first = n;
        continue;
      }
      faces.claimed[face] = 1;
      patch.faces.add(faces.nodes[face]);
    }
    if (missing == 0) return true;
    auto const& zone = mesh_.zones[z];
    auto const begin = mesh_.elements.number.begin() + zone.first_element, end = begin + zone.n_elements;
    bool const cell = std::find(begin, end, Index32(first)) != end;
    std::string const what = std::to_string(missing) + " of its " + std::to_string(numbers.size()) +
                             " elements are no boundary faces, the first is element " + std::to_string(first);
    if (cell) {
      note((patch.faces.size() == 0 ? "skipped, " : "") + what + ", an element of the volume");
      return patch.faces.size() > 0;
    }
    problems_.add(where_ + ": " + what + ", which no section of the zone has");
    return false;
  }

  /// The faces of the section that has the name of the patch, or of its family. Where the patch lists nodes, they must
  /// be those of the section: all of the patch's, because each node may be listed by one condition only where several
  /// meet, or all of the section's.
  bool take_section(int z, Patch& patch) {
    auto& faces = faces_[z];
    for (auto const& group : faces.groups) {
      bool const own = group.name == patch.name;
      bool const of_family = !patch.families.empty() && group.name == patch.families.front();
      bool const claimed = std::any_of(faces.claimed.begin() + group.begin, faces.claimed.begin() + group.end,
                                       [](char c) { return c != 0; });
      if (!(own || of_family) || group.begin == group.end || claimed) continue;
      CsrGraph list;
      for (Index f = group.begin; f < group.end; ++f) list.add(faces.nodes[f]);
      auto nodes = list.item;
      std::sort(nodes.begin(), nodes.end());
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      bool const whole = std::includes(patch.nodes.begin(), patch.nodes.end(), nodes.begin(), nodes.end());
      bool const part = own && std::includes(nodes.begin(), nodes.end(), patch.nodes.begin(), patch.nodes.end());
      if (!whole && !part) continue;
      taken_ = group.name;
      std::fill(faces.claimed.begin() + group.begin, faces.claimed.begin() + group.end, char(1));
      patch.faces = std::move(list);
      patch.nodes.clear();
      return true;
    }
    return false;
  }

  /// Sections of faces that no boundary condition names, under their own names.
  void sections(int z) {
    auto const& zone = layout_.zones[z];
    auto& faces = faces_[z];
    for (auto const& group : faces.groups) {
      bool const unclaimed = std::none_of(faces.claimed.begin() + group.begin, faces.claimed.begin() + group.end,
                                          [](char c) { return c != 0; });
      if (group.polygons || group.begin == group.end || !unclaimed) continue;
      where_ = file_.path() + ": zone '" + zone.name + "', elements '" + group.name + "'";
      Patch patch;
      patch.name = group.name;
      patch.zone = z;
      if (std::find(mesh_.families.begin(), mesh_.families.end(), group.name) != mesh_.families.end()) {
        patch.families.push_back(group.name);
        patch.bc_type = family_bc_type(file_, tree_, *zone.base, {group.name}).value_or("");
      }
      patch.kind = patch_kind(patch.bc_type);
      for (Index f = group.begin; f < group.end; ++f) patch.faces.add(faces.nodes[f]);
      note("no boundary condition names them; taken as a patch of that name");
      mesh_.patches.push_back(std::move(patch));
    }
  }

  File const& file_;
  Node const& tree_;
  Layout const& layout_;
  std::vector<ListedFaces>& faces_;
  Mesh& mesh_;
  Problems& problems_;
  std::string where_;  ///< the boundary condition being read
  std::string first_smaller_;
  Index n_smaller_ = 0;  ///< conditions of the zone on points or edges
  std::string taken_;    ///< the section whose faces it got
};

}  // namespace

void read_boundary(File const& file, Node const& tree, Layout const& layout, std::vector<ListedFaces>& faces,
                   Mesh& mesh, Problems& problems) {
  BoundaryReader reader(file, tree, layout, faces, mesh, problems);
  add_families(layout, mesh);
  for (std::size_t z = 0; z < layout.zones.size(); ++z) reader.zone(int(z));
}

}  // namespace gridmorph::cgns
