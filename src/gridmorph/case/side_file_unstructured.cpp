#include <gridmorph/case/detail/side_tables.hpp>
#include <gridmorph/case/side_file.hpp>
#include <gridmorph/core/suggest.hpp>
#include <gridmorph/mesh/coordinate_resolution.hpp>
#include <gridmorph/mesh/unstructured_topology.hpp>

#include <fmt/format.h>
#include <toml.hpp>

#include <algorithm>
#include <utility>

namespace gridmorph {

namespace {

using casefile::Context;
using casefile::TableReader;

class ElementsReader {
 public:
  ElementsReader(Context& context, Mesh& mesh) : context_(context), mesh_(mesh) {}

  void read(toml::value const& document) {
    TableReader root(context_, document, "");
    for (auto& table : root.tables("periodic")) periodic_.read(table);
    for (auto& table : root.tables("patch")) patch(table);
    for (auto& table : root.tables("interface")) interface(table);
    root.finish();
  }

 private:
  /// As for connections of a file.
  [[nodiscard]] double tolerance_of_pairs() const {
    return place_tolerance(1e-6, mesh_.size(), coordinate_resolution(mesh_));
  }

  /// Patches of a name; a problem where there are none.
  std::vector<int> patches(TableReader& table, std::string const& key, std::string const& example) {
    std::vector<int> out;
    auto const name = table.string(key);
    table.require(key, example);
    if (!name) return out;
    std::vector<std::string> names;
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p) {
      if (mesh_.patches[p].name == *name) out.push_back(int(p));
      if (std::find(names.begin(), names.end(), mesh_.patches[p].name) == names.end())
        names.push_back(mesh_.patches[p].name);
    }
    if (out.empty())
      table.problem(key, fmt::format("the mesh has no patch or marker '{}'{}", *name, suggestion(*name, names)));
    return out;
  }

  /// What a patch of the mesh is, where its file does not say.
  void patch(TableReader& table) {
    auto const own = patches(table, "name", "name = \"blade\", a patch or marker of the mesh");
    auto const family = table.strings("family");
    auto const kind = table.choice("kind", casefile::side_file_kinds);
    table.finish();
    for (int const p : own) {
      auto& patch = mesh_.patches[p];
      if (kind) {
        patch.kind = PatchKind(*kind);
        patch.bc_type = casefile::bc_type_of(patch.kind);
      }
      if (family) patch.families = *family;
      for (auto const& name : patch.families)
        if (std::find(mesh_.families.begin(), mesh_.families.end(), name) == mesh_.families.end())
          mesh_.families.push_back(name);
    }
  }

  std::vector<Index32> nodes_of(std::vector<int> const& patches) const {
    std::vector<Index32> out;
    for (int const p : patches) {
      auto const nodes = patch_nodes(mesh_.patches[p]);
      out.insert(out.end(), nodes.begin(), nodes.end());
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  /// Partners of `own` among `donors` under a transform or its inverse, whichever pairs more.
  std::pair<std::vector<Index32>, Periodic> partners(std::vector<Index32> const& own,
                                                     std::vector<Index32> const& donors,
                                                     Periodic const& periodic) const {
    double const tolerance = tolerance_of_pairs();
    auto const found = [](std::vector<Index32> const& list) {
      return std::count_if(list.begin(), list.end(), [](Index32 n) { return n >= 0; });
    };
    Periodic back = periodic;
    back.rotation_angle_rad = -periodic.rotation_angle_rad;
    back.translation = -periodic.translation;
    back.declared = periodic.declared.inverse();
    auto forth_list = match_points(mesh_.coordinates, own, donors, tolerance, periodic);
    auto back_list = match_points(mesh_.coordinates, own, donors, tolerance, back);
    if (found(back_list) > found(forth_list)) return {std::move(back_list), back};
    return {std::move(forth_list), periodic};
  }

  void interface(TableReader& table) {
    Connection out;
    out.name = table.string("name").value_or(fmt::format("interface {}", mesh_.connections.size() + 1));
    if (auto const family = table.strings("family")) out.families = *family;
    auto const own = patches(table, "patch", "patch = \"per1\", a patch or marker of the mesh");
    auto const donor = patches(table, "donor_patch", "donor_patch = \"per2\", the patch that it is mapped onto");
    table.require("periodic", "periodic = \"pitch\", the name of a [[periodic]] table");
    auto const periodic = periodic_.of(table);
    table.finish();
    if (own.empty() || donor.empty() || !periodic) return;
    out.zone = mesh_.patches[own.front()].zone;
    out.donor_zone = mesh_.patches[donor.front()].zone;
    auto const one_zone = [&](std::vector<int> const& list, int zone) {
      return std::all_of(list.begin(), list.end(), [&](int p) { return mesh_.patches[p].zone == zone; });
    };
    if (!one_zone(own, out.zone) || !one_zone(donor, out.donor_zone))
      return table.problem("patch", "lies in several zones; one pair of zones can be joined");
    out.nodes = nodes_of(own);
    auto const others = nodes_of(donor);
    auto [list, transform] = partners(out.nodes, others, *periodic);
    auto const missing = std::count(list.begin(), list.end(), -1);
    if (missing > 0)
      return table.problem(
          "patch",
          fmt::format("{} of its {} nodes have none of donor_patch within {:.3g} after the transform, the first "
                      "is {}; check axis, angle and unit (the donor has {} nodes)",
                      missing, out.nodes.size(), tolerance_of_pairs(),
                      describe_node(mesh_, out.nodes[std::find(list.begin(), list.end(), -1) - list.begin()]),
                      others.size()));
    out.donor_nodes = std::move(list);
    out.periodic = transform;
    mesh_.connections.push_back(std::move(out));
  }

  Context& context_;
  Mesh& mesh_;
  casefile::SidePeriodics periodic_;
};

}  // namespace

void casefile::read_side_file_of_elements(Context& context, toml::value const& document, Mesh& mesh) {
  ElementsReader(context, mesh).read(document);
}

}  // namespace gridmorph
