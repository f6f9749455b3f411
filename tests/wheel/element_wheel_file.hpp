// A wheel of elements as any other program reads it: nodes and connections with the mid-level library of CGNS. Its
// cells come from read_mesh(), and whether it is closed is counted face by face.
#pragma once

#include "wheel/wheel_file.hpp"

#include <gridmorph/io/mesh_io.hpp>
#include <gridmorph/mesh/as_hexahedra.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <numeric>
#include <set>

namespace gridmorph::test {

struct ElementConnection {
  std::string zone, name, donor;
  std::vector<cgsize_t> nodes, donor_nodes;  // 1-based
  bool periodic = false;
  std::array<float, 3> center{}, angle{}, translation{};
};

/// Faces of a mesh by what is on their other side.
struct FaceCount {
  Index inside = 0;  ///< another element of the zone
  Index seams = 0;   ///< an element of another zone, across a plain connection; each side counts
  Index ends = 0;    ///< a periodic connection
  Index patches = 0;
  Index open = 0;     ///< nothing
  Index claimed = 0;  ///< by a patch, although there is something on the other side
};

struct ElementWheelFile {
  std::map<std::string, FileZone> zones;
  std::vector<ElementConnection> connections;
  std::vector<std::string> families;
  std::string path;

  explicit ElementWheelFile(std::string const& file_path) : path(file_path) {
    int file = 0, n = 0;
    check_cgns(cg_open(path.c_str(), CG_MODE_READ, &file));
    check_cgns(cg_nfamilies(file, 1, &n));
    for (int f = 1; f <= n; ++f) {
      std::array<char, 66> name{};
      int bocos = 0, geometries = 0;
      check_cgns(cg_family_read(file, 1, f, name.data(), &bocos, &geometries));
      families.emplace_back(name.data());
    }
    check_cgns(cg_nzones(file, 1, &n));
    for (int z = 1; z <= n; ++z) read_zone(file, z);
    check_cgns(cg_close(file));
  }

  /// Every plain connection joins the same bits, and has its other side.
  void expect_same_bits() const {
    std::size_t pairs = 0, apart = 0;
    for (auto const& c : connections) {
      if (c.periodic) continue;
      ASSERT_EQ(c.nodes.size(), c.donor_nodes.size());
      FileZone const &own = zones.at(c.zone), &donor = zones.at(c.donor);
      for (std::size_t n = 0; n < c.nodes.size(); ++n, ++pairs)
        if (!(own.at(std::size_t(c.nodes[n] - 1)) == donor.at(std::size_t(c.donor_nodes[n] - 1)))) ++apart;
      bool found = false;
      for (auto const& d : connections)
        found = found || (!d.periodic && d.zone == c.donor && d.donor == c.zone &&
                          list(d.donor_nodes, d.nodes) == list(c.nodes, c.donor_nodes));
      EXPECT_TRUE(found) << c.zone << " " << c.name;
    }
    EXPECT_GT(pairs, 0U);
    EXPECT_EQ(apart, 0U) << "of " << pairs;
  }

  [[nodiscard]] int n_periodic() const {
    return int(std::count_if(connections.begin(), connections.end(), [](auto const& c) { return c.periodic; }));
  }

  /// Nodes that plain connections join are one here, so that a face between zones is met twice.
  [[nodiscard]] FaceCount count_faces() const {
    Mesh const mesh = read_mesh(path);
    std::vector<Index> one(mesh.n_nodes());
    std::iota(one.begin(), one.end(), Index(0));
    auto const root = [&](Index n) {
      while (one[n] != n) n = one[n];
      return n;
    };
    std::vector<std::vector<Index>> periodic;  // nodes of each side
    for (auto const& c : mesh.connections) {
      if (c.periodic) periodic.emplace_back(c.nodes.begin(), c.nodes.end());
      if (c.periodic) std::sort(periodic.back().begin(), periodic.back().end());
      for (std::size_t n = 0; n < c.nodes.size() && !c.periodic; ++n) {
        Index const a = root(c.nodes[n]), b = root(c.donor_nodes[n]);
        one[std::max(a, b)] = std::min(a, b);
      }
    }
    struct Side {
      std::vector<Index> nodes;
      int zone;
      bool patch = false;
    };
    std::map<std::vector<Index>, std::vector<Side>> sides;
    auto const add = [&](std::span<Index32 const> face, int zone, bool patch) {
      Side side{{face.begin(), face.end()}, zone, patch};
      std::sort(side.nodes.begin(), side.nodes.end());
      std::vector<Index> key;
      for (Index const n : side.nodes) key.push_back(root(n));
      std::sort(key.begin(), key.end());
      sides[key].push_back(side);
    };
    for (Index e = 0; e < mesh.n_elements(); ++e)
      for (int s = 0; s < n_sides(mesh, e); ++s) {
        std::array<Index32, max_face_corners> room{};
        auto const face = side_nodes(mesh, e, s, room);
        if (face.size() >= std::size_t(mesh.dimension)) add(face, mesh.zone_of_element(e), false);
      }
    for (auto const& patch : mesh.patches)
      for (Index f = 0; f < patch.faces.size(); ++f) add(patch.faces[f], patch.zone, true);
    FaceCount out;
    for (auto const& [key, at] : sides) {
      Index elements = 0, patches = 0;
      bool zones_differ = false;
      for (auto const& side : at) {
        (side.patch ? patches : elements) += 1;
        zones_differ = zones_differ || side.zone != at.front().zone;
      }
      bool const end = std::any_of(periodic.begin(), periodic.end(), [&](auto const& list) {
        return std::includes(list.begin(), list.end(), at.front().nodes.begin(), at.front().nodes.end());
      });
      if (elements == 2) {
        (zones_differ ? out.seams : out.inside) += 1;
        out.claimed += patches;
      } else if (patches == 1 && elements == 1) {
        ++out.patches;
      } else if (elements == 1 && end) {
        ++out.ends;
      } else {
        ++out.open;
      }
    }
    return out;
  }

 private:
  static std::vector<std::pair<cgsize_t, cgsize_t>> list(std::vector<cgsize_t> const& a,
                                                         std::vector<cgsize_t> const& b) {
    std::vector<std::pair<cgsize_t, cgsize_t>> out;
    for (std::size_t n = 0; n < a.size(); ++n) out.emplace_back(a[n], b[n]);
    std::sort(out.begin(), out.end());
    return out;
  }

  void read_zone(int file, int z) {
    std::array<char, 34> name{};
    std::array<cgsize_t, 9> size{};
    check_cgns(cg_zone_read(file, 1, z, name.data(), size.data()));
    CGNS_ENUMT(ZoneType_t) type{};
    check_cgns(cg_zone_type(file, 1, z, &type));
    EXPECT_EQ(type, CGNS_ENUMV(Unstructured));
    FileZone& zone = zones[name.data()];
    zone.name = name.data();
    cgsize_t const first = 1;
    for (auto [component, values] :
         {std::pair{"CoordinateX", &zone.x}, {"CoordinateY", &zone.y}, {"CoordinateZ", &zone.z}}) {
      values->resize(std::size_t(size[0]));
      check_cgns(cg_coord_read(file, 1, z, component, CGNS_ENUMV(RealDouble), &first, size.data(), values->data()));
    }
    int n = 0;
    check_cgns(cg_n1to1(file, 1, z, &n));
    EXPECT_EQ(n, 0);
    check_cgns(cg_nconns(file, 1, z, &n));
    for (int c = 1; c <= n; ++c) {
      ElementConnection out;
      std::array<char, 34> connection{}, donor{};
      CGNS_ENUMT(GridLocation_t) location{};
      CGNS_ENUMT(GridConnectivityType_t) kind{};
      CGNS_ENUMT(PointSetType_t) set{}, donor_set{};
      CGNS_ENUMT(ZoneType_t) donor_zone{};
      CGNS_ENUMT(DataType_t) data{};
      cgsize_t points = 0, donor_points = 0;
      check_cgns(cg_conn_info(file, 1, z, c, connection.data(), &location, &kind, &set, &points, donor.data(),
                              &donor_zone, &donor_set, &data, &donor_points));
      EXPECT_EQ(location, CGNS_ENUMV(Vertex));
      EXPECT_EQ(kind, CGNS_ENUMV(Abutting1to1));
      EXPECT_EQ(set, CGNS_ENUMV(PointList));
      EXPECT_EQ(donor_set, CGNS_ENUMV(PointListDonor));
      EXPECT_EQ(donor_zone, CGNS_ENUMV(Unstructured));
      out.nodes.resize(points);
      out.donor_nodes.resize(donor_points);
      check_cgns(cg_conn_read(file, 1, z, c, out.nodes.data(), data, out.donor_nodes.data()));
      out.zone = zone.name;
      out.name = connection.data();
      out.donor = donor.data();
      out.periodic =
          cg_conn_periodic_read(file, 1, z, c, out.center.data(), out.angle.data(), out.translation.data()) == CG_OK;
      connections.push_back(std::move(out));
    }
    check_cgns(cg_nbocos(file, 1, z, &n));
    for (int b = 1; b <= n; ++b) {
      std::array<char, 34> bc{};
      std::array<char, 66> family{};
      CGNS_ENUMT(BCType_t) bc_type{};
      CGNS_ENUMT(PointSetType_t) set{};
      std::array<int, 3> normal{};
      cgsize_t points = 0, normals = 0;
      CGNS_ENUMT(DataType_t) data{};
      int sets = 0;
      check_cgns(
          cg_boco_info(file, 1, z, b, bc.data(), &bc_type, &set, &points, normal.data(), &normals, &data, &sets));
      check_cgns(cg_goto(file, 1, "Zone_t", z, "ZoneBC_t", 1, "BC_t", b, "end"));
      if (cg_famname_read(family.data()) == CG_OK) zone.family_of_bc[bc.data()] = family.data();
    }
  }
};

/// All nodes of the wheel of a mesh of blocks and of the same passage as hexahedra.
inline void expect_same_nodes(WheelFile const& of_blocks, ElementWheelFile const& of_elements, double within) {
  ASSERT_EQ(of_blocks.zones.size(), of_elements.zones.size());
  double worst = 0;
  for (auto const& [name, zone] : of_blocks.zones) {
    FileZone const& other = of_elements.zones.at(name);
    ASSERT_EQ(zone.x.size(), other.x.size()) << name;
    for (std::size_t n = 0; n < zone.x.size(); ++n) worst = std::max(worst, distance(zone.at(n), other.at(n)));
  }
  EXPECT_LT(worst, within);
}

/// Boundaries that rules give, in every passage, of the wheel of a mesh of blocks and of the same passage as hexahedra
/// or what they are split into. `slipping`: families of the others, and `off_them`: without the nodes of those.
inline void expect_same_boundaries(Mesh const& blocks, std::set<std::string> const& slipping,
                                   WheelFile const& of_blocks, ElementWheelFile const& of_elements,
                                   bool off_them = false) {
  std::set<Index> nodes, on_others;
  Mesh const hexahedra = as_hexahedra(blocks);
  for (auto const& patch : hexahedra.patches) {
    auto& list = slipping.contains(patch.families.empty() ? patch.name : patch.families.front()) ? on_others : nodes;
    list.insert(patch.faces.item.begin(), patch.faces.item.end());
  }
  for (auto const& c : hexahedra.connections)
    if (c.periodic) nodes.insert(c.nodes.begin(), c.nodes.end());
  if (off_them)
    for (Index const n : on_others) nodes.erase(n);
  ASSERT_EQ(of_blocks.zones.size(), of_elements.zones.size());
  double worst = 0, moved = 0;
  Index compared = 0;
  for (auto const& [name, zone] : of_blocks.zones) {
    FileZone const& other = of_elements.zones.at(name);
    std::string const of = name.substr(0, name.rfind("_P"));
    auto const sector =
        std::find_if(blocks.zones.begin(), blocks.zones.end(), [&](Zone const& z) { return z.name == of; });
    ASSERT_NE(sector, blocks.zones.end()) << name;
    for (auto n = nodes.lower_bound(sector->first_node); n != nodes.end() && *n < sector->first_node + sector->size();
         ++n) {
      auto const at = std::size_t(*n - sector->first_node);
      worst = std::max(worst, distance(zone.at(at), other.at(at)));
      if (name.ends_with("P01")) moved = std::max(moved, distance(other.at(at), blocks.coordinates[*n]));
      ++compared;
    }
  }
  EXPECT_GT(compared, 500);
  EXPECT_LT(worst, 1e-9 * blocks.size());
  EXPECT_GT(moved, 1e-3 * blocks.size());
}

}  // namespace gridmorph::test
