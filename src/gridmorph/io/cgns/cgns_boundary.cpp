#include <gridmorph/io/cgns/cgns_boundary.hpp>
#include <gridmorph/io/cgns/cgns_families.hpp>
#include <gridmorph/io/cgns/cgns_ranges.hpp>

#include <algorithm>
#include <set>

namespace gridmorph::cgns {

void add_families(Layout const& layout, Mesh& mesh) {
  std::set<Node const*> bases;
  for (auto const& zone : layout.zones)
    if (bases.insert(zone.base).second)
      for (auto& name : family_names(*zone.base))
        if (std::find(mesh.families.begin(), mesh.families.end(), name) == mesh.families.end())
          mesh.families.push_back(std::move(name));
}

void read_block_boundary(File const& file, Node const& tree, Layout const& layout, int z, Mesh& mesh,
                         Problems& problems) {
  auto const& zone = layout.zones[z];
  for (auto const* zone_bc : zone.node->all("ZoneBC_t"))
    for (auto const* bc : zone_bc->all("BC_t")) {
      std::string const where = file.path() + ": zone '" + zone.name + "', BC '" + bc->name + "'";
      Patch patch;
      patch.name = bc->name;
      patch.zone = z;
      patch.families = families_of(file, *zone.base, *bc);
      if (std::string const unknown = take_bc_type(file, tree, *zone.base, *bc, patch); !unknown.empty())
        mesh.notes.push_back(where + ": " + unknown);

      std::string why;
      auto const set = read_point_set(file, zone, *bc, why);
      auto const face = set ? face_range(zone, *set) : FaceRange{{}, Misfit::not_a_face, why};
      if (face.misfit == Misfit::out_of_bounds)
        problems.add(where + ": " + face.why);
      else if (face.misfit == Misfit::not_a_face)
        mesh.notes.push_back(where + ": skipped, " + face.why);
      else {
        patch.range = face.range;
        mesh.patches.push_back(std::move(patch));
      }
    }
}

void read_boundary(File const& file, Node const& tree, Layout const& layout, Mesh& mesh, Problems& problems) {
  add_families(layout, mesh);
  for (std::size_t z = 0; z < layout.zones.size(); ++z) read_block_boundary(file, tree, layout, int(z), mesh, problems);
}

}  // namespace gridmorph::cgns
