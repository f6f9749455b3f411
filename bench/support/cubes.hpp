// Meshes and rules of the kernels' benchmarks: one cube of nodes, or a lattice of equal cubes, joined or apart.
#pragma once

#include <gridmorph/plan/prepare.hpp>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace gridmorph::bench {

struct Cubes {
  int edge = 2;         ///< nodes along an edge of one cube
  int per_axis = 1;     ///< cubes along each axis
  bool joined = false;  ///< by 1-to-1 interfaces; otherwise every face is a patch
  bool operator==(Cubes const&) const = default;
};

inline IndexRange face_of_cube(int edge, int axis, int side) {
  IndexRange r{{0, 0, 0}, {edge, edge, edge}};
  r.begin[axis] = side == 0 ? 0 : edge - 1;
  r.end[axis] = r.begin[axis] + 1;
  return r;
}

/// Curved inside, spaced unevenly, with plane outer faces; patches are named i_min ... k_max.
inline Mesh make_cubes(Cubes const& cubes) {
  Mesh mesh;
  mesh.source = "cubes";
  int const m = cubes.per_axis, edge = cubes.edge;
  auto const place = [&](int z) { return Index3{z % m, z / m % m, z / (m * m)}; };
  for (int z = 0; z < m * m * m; ++z) mesh.add_zone("cube " + std::to_string(z + 1), {edge, edge, edge});
  for (int z = 0; z < m * m * m; ++z)
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        IndexRange const range = face_of_cube(edge, axis, side);
        Index3 beyond = place(z);
        beyond[axis] += side == 0 ? -1 : 1;
        if (!cubes.joined || beyond[axis] < 0 || beyond[axis] >= m) {
          std::string const name(face_name(axis, side));
          mesh.patches.push_back({name, "", PatchKind::farfield, {name}, z, range});
        } else if (side == 1) {
          Interface1to1 join;
          join.name = "join " + std::to_string(mesh.interfaces.size() + 1);
          join.zone = z;
          join.donor_zone = beyond[0] + m * (beyond[1] + m * beyond[2]);
          join.range = range;
          join.to_donor = {Orientation{}, range.begin, face_of_cube(edge, axis, 0).begin};
          mesh.interfaces.push_back(std::move(join));
        }
      }
  mesh.coordinates = Coordinates(mesh.n_nodes());
  // By the node's number in the whole lattice, so that nodes of neighbours agree to the bit.
  int const last = m * (edge - 1);
  std::vector<double> u(last + 1), bend(last + 1), wave(last + 1);
  for (int n = 0; n <= last; ++n) {
    u[n] = double(n) / last;
    bend[n] = 0.05 * std::sin(M_PI * u[n]);
    wave[n] = std::cos(4 * u[n]);
  }
  for (int z = 0; z < m * m * m; ++z) {
    Index3 const p = place(z);
    for (int k = 0; k < edge; ++k)
      for (int j = 0; j < edge; ++j)
        for (int i = 0; i < edge; ++i) {
          int const a = p[0] * (edge - 1) + i, b = p[1] * (edge - 1) + j, c = p[2] * (edge - 1) + k;
          mesh.coordinates.set(mesh.zones[z].node({i, j, k}),
                               {u[a] + bend[a] * wave[b] * wave[c], u[b] + bend[b] * wave[c] * wave[a],
                                u[c] + bend[c] * wave[a] * wave[b]});
        }
  }
  return mesh;
}

/// What is known on the sides of the chains that run along one axis between two known ends.
enum class KnownSides {
  no_side,
  two_sides,        ///< one pair of opposite sides
  four_sides,       ///< transfinite interpolation
  slip_sides,       ///< none, but one pair of opposite sides slips on its planes: a finalize pass follows
  near_field,       ///< none, and the constant law over all cells of a cube but the last
  near_field_turns  ///< the same, and the near field turns with its wall
};
inline constexpr std::array known_names{"no_side",    "two_sides",  "four_sides",
                                        "slip_sides", "near_field", "near_field_turns"};

struct CubeCase {
  int axis = 0;
  Law law = Law::linear;
  KnownSides known = KnownSides::no_side;
};

/// Plans a case on cubes; `cubes` stays as it is. A plan does not depend on displacements, and has none.
inline PreparedMorph prepare_case(Mesh const& cubes, CubeCase const& c) {
  Mesh mesh = cubes;  // coordinates are shared
  int const paired = c.axis == 0 ? 1 : 0, other = 3 - c.axis - paired;
  auto const faces = [](int axis) {
    return std::vector<std::string>{std::string(face_name(axis, 0)), std::string(face_name(axis, 1))};
  };
  RigidRule const moving{{}, {1e-3, 2e-3, 3e-3}};
  Motion motion;
  PlanOptions options;
  options.volume.law = c.law;
  auto const rule = [&](int axis, Rule const& what) { motion.rules.push_back({faces(axis), what, 0, "bench"}); };
  rule(c.axis, moving);
  bool const turns = c.known == KnownSides::near_field_turns;
  if (turns ||
      c.known == KnownSides::near_field)  // all cells but the last one: a near field may not reach another patch
    options.boundary_layers = {{{faces(c.axis)[0]},
                                BoundaryLayer::Extent::layers,
                                mesh.zones[0].extent[c.axis] - 2,
                                0,
                                turns ? BoundaryLayer::Mode::rotate : BoundaryLayer::Mode::translate}};
  bool const pair_moves = c.known == KnownSides::two_sides || c.known == KnownSides::four_sides;
  rule(paired, pair_moves ? Rule(moving) : c.known == KnownSides::slip_sides ? Rule(SlipRule{}) : Rule(FreeRule{}));
  rule(other, c.known == KnownSides::four_sides ? Rule(moving) : Rule(FreeRule{}));
  // Walls rank first, so the chains run along the axis of the case.
  for (Patch& patch : mesh.patches)
    if (patch.name == faces(c.axis)[0] || patch.name == faces(c.axis)[1]) patch.kind = PatchKind::wall;
  return prepare(mesh, motion, options);
}

}  // namespace gridmorph::bench
