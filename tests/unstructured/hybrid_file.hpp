// Hybrid CGNS files: zones of a file of blocks and zones of the same mesh as elements, put into one file.
#pragma once

#include "io/io_support.hpp"

#include <gridmorph/io/cgns/cgns_file.hpp>
#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace gridmorph::test {

/// Puts zones together. Connections between a block and elements become GridConnectivity_t with lists of nodes on both
/// sides.
class HybridFile {
 public:
  /// blocks, elements: the same zones; as_elements: names of those that are taken from `elements`. one_to_one:
  /// interfaces of blocks with elements stay GridConnectivity1to1_t, whose donor range means nothing there.
  HybridFile(std::string const& path, Mesh const& blocks, Mesh const& elements, std::set<std::string> as_elements,
             FileFormat format = FileFormat::cgns_hdf5, bool one_to_one = false)
      : blocks_(blocks), elements_(elements), as_elements_(std::move(as_elements)), one_to_one_(one_to_one) {
    std::string const structured = path + ".blocks", unstructured = path + ".elements";
    write_mesh(structured, blocks);
    write_mesh(unstructured, elements);
    cgns::File const a(structured, cgns::File::Mode::read), b(unstructured, cgns::File::Mode::read);
    cgns::File to(path, cgns::File::Mode::create, format);
    auto const tree = a.tree(), other = b.tree();
    auto const& base = *tree.labelled("CGNSBase_t");
    copy(to, to.root(), a, *tree.labelled("CGNSLibraryVersion_t"));
    double const id =
        to.create(to.root(), base.name, base.label, a.type(base), a.dimensions(base), raw(a, base).data());
    for (auto const& child : base.children)
      if (child.label != "Zone_t") copy(to, id, a, child);
    for (int z = 0; z < int(blocks.zones.size()); ++z) {
      auto const& name = blocks.zones[z].name;
      if (is_elements(z))
        zone(to, id, b, *other.labelled("CGNSBase_t")->child(name), z);
      else
        zone(to, id, a, *base.child(name), z);
    }
    to.close();
  }

 private:
  [[nodiscard]] bool is_elements(int z) const { return as_elements_.contains(blocks_.zones[z].name); }

  static std::string raw(cgns::File const& file, cgns::Node const& node) {
    std::string const type = file.type(node);
    if (type == "MT") return {};
    std::string out(std::size_t(file.count(node)) * std::size_t(cgns::bytes_per_element(type)), '\0');
    file.read(node, type, out.data());
    return out;
  }

  static double copy(cgns::File& to, double parent, cgns::File const& from, cgns::Node node, bool deep = true) {
    double const id =
        to.create(parent, node.name, node.label, from.type(node), from.dimensions(node), raw(from, node).data());
    if (!deep) return id;
    from.load_children(node);
    for (auto const& child : node.children) copy(to, id, from, child);
    return id;
  }

  void zone(cgns::File& to, double parent, cgns::File const& from, cgns::Node const& node, int z) const {
    double const id = copy(to, parent, from, node, false);
    for (auto const& child : node.children) {
      if (child.label != "ZoneGridConnectivity_t") {
        copy(to, id, from, child);
        continue;
      }
      double const connectivity = copy(to, id, from, child, false);
      for (auto const& c : elements_.connections) {
        if (c.zone != z) continue;
        if (is_elements(z) == is_elements(c.donor_zone) || (one_to_one_ && !is_elements(z)))
          copy(to, connectivity, from, *child.child(c.name));
        else
          mixed(to, connectivity, from, *child.child(c.name), c);
      }
    }
  }

  void mixed(cgns::File& to, double parent, cgns::File const& from, cgns::Node const& node, Connection const& c) const {
    double const id = to.create_text(parent, c.name, "GridConnectivity_t", blocks_.zones[c.donor_zone].name);
    to.create_text(id, "GridConnectivityType", "GridConnectivityType_t", "Abutting1to1");
    points(to, id, "PointList", c.zone, c.nodes);
    points(to, id, "PointListDonor", c.donor_zone, c.donor_nodes);
    for (auto const& child : node.children)
      if (child.label == "GridConnectivityProperty_t" || child.label.find("FamilyName") != std::string::npos)
        copy(to, id, from, child);
  }

  void points(cgns::File& to, double parent, char const* name, int z, std::vector<Index32> const& nodes) const {
    auto const& zone = blocks_.zones[z];
    std::vector<std::int32_t> list;
    for (Index32 const n : nodes) {
      auto const p = zone.index(n);
      if (is_elements(z))
        list.push_back(std::int32_t(n - zone.first_node + 1));
      else
        for (int a = 0; a < 3; ++a) list.push_back(p[a] + 1);
    }
    to.create(parent, name, "IndexArray_t", "I4", {is_elements(z) ? 1 : 3, Index(nodes.size())}, list.data());
  }

  Mesh const& blocks_;
  Mesh const& elements_;
  std::set<std::string> as_elements_;
  bool one_to_one_;
};

/// A mesh of blocks as a file gives it, and a hybrid file of it.
struct Hybrid {
  Mesh blocks;    ///< as read from a file of blocks
  Mesh expected;  ///< all of its zones as hexahedra
  std::string path;

  Hybrid(TemporaryFolder const& folder, Mesh const& mesh, std::set<std::string> as_elements = {},
         FileFormat format = FileFormat::cgns_hdf5)
      : path(folder.file("hybrid.cgns")) {
    auto const all_blocks = folder.file("blocks.cgns");
    write_mesh(all_blocks, mesh);
    blocks = read_mesh(all_blocks);
    expected = as_hexahedra(blocks);
    if (as_elements.empty())
      for (std::size_t z = 1; z < blocks.zones.size(); z += 2) as_elements.insert(blocks.zones[z].name);
    HybridFile(path, blocks, expected, as_elements, format);
    auto const by_zone = [](auto const& a, auto const& b) { return a.zone < b.zone; };
    std::stable_sort(expected.patches.begin(), expected.patches.end(), by_zone);
    std::stable_sort(expected.connections.begin(), expected.connections.end(), by_zone);
  }
};

}  // namespace gridmorph::test
