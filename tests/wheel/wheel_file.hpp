// A wheel as any other program reads it: with the mid-level library of CGNS, knowing nothing of the code under test.
#pragma once

#include <gridmorph/kernels/vec3.hpp>

#include <cgnslib.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace gridmorph::test {

inline void check_cgns(int status) {
  if (status != CG_OK) throw std::runtime_error(cg_get_error());
}

struct FileConnection {
  std::string zone, name, donor;
  std::array<cgsize_t, 6> range{}, donor_range{};
  std::array<int, 3> transform{};
  bool periodic = false;
  std::array<float, 3> center{}, angle{}, translation{};
};

struct FileZone {
  std::string name;
  std::array<cgsize_t, 3> extent{};
  std::vector<double> x, y, z;
  std::map<std::string, std::string> family_of_bc;

  [[nodiscard]] std::size_t number(std::array<cgsize_t, 3> const& p) const {  // 1-based
    return std::size_t(p[0] - 1 + extent[0] * (p[1] - 1 + extent[1] * (p[2] - 1)));
  }
  [[nodiscard]] Vec3 at(std::size_t n) const { return {x[n], y[n], z[n]}; }
};

struct WheelFile {
  std::map<std::string, FileZone> zones;
  std::vector<FileConnection> connections;
  std::vector<std::string> families;

  explicit WheelFile(std::string const& path) {
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

  /// Calls visit(connection, own zone, own node, donor zone, donor node) for every point pair.
  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    for (auto const& c : connections) {
      FileZone const& own = zones.at(c.zone);
      FileZone const& donor = zones.at(c.donor);
      std::array<cgsize_t, 3> step{}, count{};
      for (int a = 0; a < 3; ++a) {
        step[a] = c.range[3 + a] >= c.range[a] ? 1 : -1;
        count[a] = std::abs(c.range[3 + a] - c.range[a]) + 1;
      }
      for (cgsize_t k = 0; k < count[2]; ++k)
        for (cgsize_t j = 0; j < count[1]; ++j)
          for (cgsize_t i = 0; i < count[0]; ++i) {
            std::array<cgsize_t, 3> const offset{i * step[0], j * step[1], k * step[2]};
            std::array<cgsize_t, 3> p{}, q{c.donor_range[0], c.donor_range[1], c.donor_range[2]};
            for (int a = 0; a < 3; ++a) {
              p[a] = c.range[a] + offset[a];
              q[std::abs(c.transform[a]) - 1] += (c.transform[a] > 0 ? 1 : -1) * offset[a];
            }
            visit(c, own, own.number(p), donor, donor.number(q));
          }
    }
  }

  /// Every plain connection joins the same bits, and has its other side.
  void expect_watertight() const {
    std::size_t pairs = 0, open = 0;
    for_each_pair(
        [&](FileConnection const& c, FileZone const& own, std::size_t p, FileZone const& donor, std::size_t q) {
          if (c.periodic) return;
          ++pairs;
          if (!(own.at(p) == donor.at(q))) ++open;
        });
    EXPECT_GT(pairs, 0U);
    EXPECT_EQ(open, 0U) << "of " << pairs;
    for (auto const& c : connections) {
      bool found = false;
      for (auto const& d : connections)
        found = found || (d.zone == c.donor && d.donor == c.zone && sorted(d.range) == sorted(c.donor_range) &&
                          sorted(d.donor_range) == sorted(c.range));
      EXPECT_TRUE(found) << c.zone << " " << c.name;
    }
  }
  [[nodiscard]] int n_periodic() const {
    int n = 0;
    for (auto const& c : connections) n += c.periodic ? 1 : 0;
    return n;
  }

 private:
  static std::array<cgsize_t, 6> sorted(std::array<cgsize_t, 6> r) {
    for (int a = 0; a < 3; ++a)
      if (r[a] > r[3 + a]) std::swap(r[a], r[3 + a]);
    return r;
  }

  void read_zone(int file, int z) {
    std::array<char, 34> name{};
    std::array<cgsize_t, 9> size{};
    check_cgns(cg_zone_read(file, 1, z, name.data(), size.data()));
    FileZone& zone = zones[name.data()];
    zone.name = name.data();
    zone.extent = {size[0], size[1], size[2]};
    std::array<cgsize_t, 3> const first{1, 1, 1};
    for (auto [component, values] :
         {std::pair{"CoordinateX", &zone.x}, {"CoordinateY", &zone.y}, {"CoordinateZ", &zone.z}}) {
      values->resize(std::size_t(size[0] * size[1] * size[2]));
      check_cgns(
          cg_coord_read(file, 1, z, component, CGNS_ENUMV(RealDouble), first.data(), size.data(), values->data()));
    }
    int n = 0;
    check_cgns(cg_n1to1(file, 1, z, &n));
    for (int c = 1; c <= n; ++c) {
      FileConnection face;
      std::array<char, 34> connection{}, donor{};
      check_cgns(cg_1to1_read(file, 1, z, c, connection.data(), donor.data(), face.range.data(),
                              face.donor_range.data(), face.transform.data()));
      face.zone = zone.name;
      face.name = connection.data();
      face.donor = donor.data();
      face.periodic =
          cg_1to1_periodic_read(file, 1, z, c, face.center.data(), face.angle.data(), face.translation.data()) == CG_OK;
      connections.push_back(face);
    }
    check_cgns(cg_nbocos(file, 1, z, &n));
    for (int b = 1; b <= n; ++b) {
      std::array<char, 34> bc{};
      std::array<char, 66> family{};
      CGNS_ENUMT(BCType_t) type{};
      CGNS_ENUMT(PointSetType_t) set{};
      std::array<int, 3> normal{};
      cgsize_t points = 0, normals = 0;
      CGNS_ENUMT(DataType_t) data{};
      int sets = 0;
      check_cgns(cg_boco_info(file, 1, z, b, bc.data(), &type, &set, &points, normal.data(), &normals, &data, &sets));
      check_cgns(cg_goto(file, 1, "Zone_t", z, "ZoneBC_t", 1, "BC_t", b, "end"));
      if (cg_famname_read(family.data()) == CG_OK) zone.family_of_bc[bc.data()] = family.data();
    }
  }
};

}  // namespace gridmorph::test
