// Small meshes made in memory.
#pragma once

#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/quality/quality.hpp>

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace gridmorph::test {

using NodeMap = std::function<Vec3(Vec3 const& index)>;

/// Appends zones first and fills coordinates later: call fill for every zone once all are added.
inline void fill(Mesh& mesh, int zone, std::function<Vec3(Index3 const&)> const& position) {
  Zone const& z = mesh.zones[zone];
  for (int k = 0; k < z.extent[2]; ++k)
    for (int j = 0; j < z.extent[1]; ++j)
      for (int i = 0; i < z.extent[0]; ++i) mesh.coordinates.set(z.node({i, j, k}), position({i, j, k}));
}

/// One zone; position of node (i, j, k).
inline Mesh one_zone(Index3 extent, std::function<Vec3(Index3 const&)> const& position) {
  Mesh mesh;
  mesh.source = "one_zone";
  mesh.add_zone("only", extent);
  mesh.coordinates = Coordinates(mesh.n_nodes());
  fill(mesh, 0, position);
  return mesh;
}

/// A bounded disturbance that depends on the position alone, so that coincident nodes stay coincident.
inline Vec3 wavy(Vec3 const& p, double amplitude) {
  return p +
         amplitude * Vec3{std::sin(5 * p.y + 3 * p.z + 1), std::cos(4 * p.x - 2 * p.z), std::sin(3 * p.x + 6 * p.y)};
}

/// Two zones, the second left-handed, more cells than one chunk holds.
inline Mesh two_handed_zones() {
  Mesh mesh;
  mesh.source = "two_handed_zones";
  mesh.add_zone("right", {23, 11, 9});
  mesh.add_zone("left", {7, 6, 14});
  mesh.coordinates = Coordinates(mesh.n_nodes());
  fill(mesh, 0, [](Index3 const& i) { return wavy({i[0] * 0.1, i[1] * 0.1, i[2] * 0.1}, 0.01); });
  fill(mesh, 1, [](Index3 const& i) { return wavy({4 - i[0] * 0.1, i[1] * 0.1, i[2] * 0.1}, 0.01); });
  return mesh;
}

/// A wavy box of 9 x 6 x 5 nodes' spacing cut into two zones at i = `cut`; the second zone's indices are turned by
/// `orientation` (one of the 48 signed permutations), and an interface joins them.
inline Mesh two_zones(Orientation const& orientation, bool both_sides, double amplitude = 0.04) {
  Index3 const whole{9, 6, 5};
  int const cut = 3;
  auto const place = [&](Index3 const& p) {
    // Graded along i, so that volumes change.
    return wavy({0.1 * p[0] * (1 + 0.15 * p[0]), 0.2 * p[1], 0.15 * p[2] * (1 + 0.1 * p[2])}, amplitude);
  };
  Index3 const first{cut + 1, whole[1], whole[2]};
  Index3 const second_in_own_order{whole[0] - cut, whole[1], whole[2]};
  Index3 extent{}, origin{};
  for (int a = 0; a < 3; ++a) {
    extent[orientation.axis[a]] = second_in_own_order[a];
    origin[orientation.axis[a]] = orientation.sign[a] > 0 ? 0 : second_in_own_order[a] - 1;
  }
  IndexMap const to_second{orientation, {cut, 0, 0}, origin};
  Mesh mesh;
  mesh.source = "two_zones";
  mesh.add_zone("first", first);
  mesh.add_zone("second", extent);
  mesh.coordinates = Coordinates(mesh.n_nodes());
  fill(mesh, 0, place);
  IndexMap const back = to_second.inverse();
  fill(mesh, 1, [&](Index3 const& q) { return place(back(q)); });

  Interface1to1 face;
  face.name = "join";
  face.zone = 0;
  face.donor_zone = 1;
  face.range = {{cut, 0, 0}, {cut + 1, whole[1], whole[2]}};
  face.to_donor = to_second;
  mesh.interfaces.push_back(face);
  if (both_sides) {
    Interface1to1 other;
    other.name = "join back";
    other.zone = 1;
    other.donor_zone = 0;
    other.range = to_second(face.range);
    other.to_donor = back;
    mesh.interfaces.push_back(other);
  }
  return mesh;
}

inline std::vector<Orientation> all_orientations() {
  std::vector<Orientation> list;
  int const permutations[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (auto const& p : permutations)
    for (int s = 0; s < 8; ++s)
      list.push_back({{p[0], p[1], p[2]}, {(s & 1) != 0 ? -1 : 1, (s & 2) != 0 ? -1 : 1, (s & 4) != 0 ? -1 : 1}});
  return list;
}

/// The mesh as it is, to be measured.
inline QualityInput<Kokkos::HostSpace> input_of(Mesh const& mesh) {
  QualityInput<Kokkos::HostSpace> input;
  input.coordinates = views(mesh.coordinates);
  return input;
}

/// Corners of one cell, straight from the mesh.
inline std::array<Vec3, 8> cell_corners(Mesh const& mesh, Coordinates const& x, int zone, Index3 const& c) {
  std::array<Vec3, 8> corners;
  for (int n = 0; n < 8; ++n)
    corners[n] = x[mesh.zones[zone].node({c[0] + (n & 1), c[1] + (n >> 1 & 1), c[2] + (n >> 2)})];
  return corners;
}

/// Calls f(zone, cell) in mesh order.
inline void each_cell(Mesh const& mesh, std::function<void(int, Index3 const&)> const& f) {
  for (int z = 0; z < int(mesh.zones.size()); ++z) {
    Index3 const n = mesh.zones[z].extent;
    for (int k = 0; k + 1 < n[2]; ++k)
      for (int j = 0; j + 1 < n[1]; ++j)
        for (int i = 0; i + 1 < n[0]; ++i) f(z, {i, j, k});
  }
}

/// A copy of the coordinates, moved.
inline Coordinates moved(Mesh const& mesh, std::function<Vec3(Vec3 const&)> const& motion) {
  Coordinates x(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) x.set(n, motion(mesh.coordinates[n]));
  return x;
}

}  // namespace gridmorph::test
