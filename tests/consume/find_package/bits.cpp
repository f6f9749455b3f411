// Morphs a curved mesh and writes the bits of its coordinates. Calls the inline functions of the public headers itself,
// so that its object file holds copies of them, compiled with its own options.
#include <gridmorph/gridmorph.hpp>

#include <cstdio>
#include <cstring>

namespace {

using namespace gridmorph;

constexpr Index3 extent{17, 9, 13};

/// Fractions that every compiler rounds alike, and whose squares must be rounded.
Vec3 curved(Index3 const& i) {
  return {(4 * i[0] + (i[1] * i[1] + i[2]) % 7) / 3.0, (4 * i[1] + i[0] * i[2] % 5) / 7.0,
          (4 * i[2] + i[0] * i[1] % 3) / 9.0};
}

Mesh one_zone() {
  Mesh mesh;
  mesh.source = "one zone";
  mesh.add_zone("zone", extent);
  mesh.coordinates = Coordinates(mesh.n_nodes());
  for (Index n = 0; n < mesh.n_nodes(); ++n) mesh.coordinates.set(n, curved(mesh.zones[0].index(n)));
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      Patch patch{"wall", "BCWall", PatchKind::wall, {}, 0, {{0, 0, 0}, extent}};
      patch.range.begin[axis] = side == 0 ? 0 : extent[axis] - 1;
      patch.range.end[axis] = patch.range.begin[axis] + 1;
      mesh.patches.push_back(patch);
    }
  return mesh;
}

/// Keeps what a compiler could leave out.
double used_inline(Vec3 const& a, Vec3 const& b) {
  Mat3 const turn{{{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, {0.7, 0.8, 0.9}}};
  RigidTransform const there{turn * transpose(turn), a};
  return dot(a, cross(a, b)) + distance(there(a), there.inverse().then(there)(b)) + norm(turn * a + 0.1 * b - a);
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  Kokkos::DefaultHostExecutionSpace const exec;
  Mesh const mesh = one_zone();
  Motion motion;
  motion.rules.push_back({{"wall"},
                          FunctionRule{"steps",
                                       [](std::span<Vec3 const> points, std::span<Vec3> u) {
                                         for (std::size_t n = 0; n < points.size(); ++n)
                                           u[n] = {points[n].y / 16, points[n].z / 8, points[n].x / 32};
                                       }},
                          0,
                          "bits"});
  Coordinates const moved = morph(exec, mesh, motion);
  std::FILE* const out = std::fopen(argv[1], "w");
  for (auto const& component : {moved.x, moved.y, moved.z})
    for (Index n = 0; n < moved.size(); ++n) {
      unsigned long long bits = 0;
      std::memcpy(&bits, &component(n), sizeof bits);
      std::fprintf(out, "%016llx\n", bits);
    }
  volatile double const used = used_inline(moved[1], moved[2]);
  return std::fclose(out) == 0 && used == used ? 0 : 1;
}
