#include <gridmorph/boundary/patch_surface.hpp>
#include <gridmorph/io/surface/surface_io.hpp>

#include <algorithm>

namespace gridmorph {

TargetGeometry surface_of(Mesh const& mesh, std::vector<int> const& patches) {
  TargetGeometry out;
  PatchSurface const surface(Boundary(mesh), patches);
  for (PatchGrid const& grid : surface.grids) {
    TargetGrid piece;
    piece.name = mesh.zones[mesh.patches[grid.patch].zone].name + "/" + mesh.patches[grid.patch].name;
    piece.extent = grid.extent;
    for (int const v : grid.vertex) piece.points.push_back(surface.points[v]);
    out.grids.push_back(std::move(piece));
  }
  return out;
}

SurfaceTriangles triangulate(Mesh const& mesh, std::vector<int> const& patches, int split) {
  SurfaceTriangles out;
  PatchSurface const surface(Boundary(mesh), patches);
  for (PatchGrid const& grid : surface.grids) {
    int const first = int(out.points.size());
    int const na = (grid.extent[0] - 1) * split + 1, nb = (grid.extent[1] - 1) * split + 1;
    for (int b = 0; b < nb; ++b)
      for (int a = 0; a < na; ++a) {
        int const i = std::min(a / split, std::max(0, grid.extent[0] - 2));
        int const j = std::min(b / split, std::max(0, grid.extent[1] - 2));
        double const s = double(a - i * split) / split, t = double(b - j * split) / split;
        int const i1 = std::min(i + 1, grid.extent[0] - 1), j1 = std::min(j + 1, grid.extent[1] - 1);
        auto const x = [&](int p, int q) { return surface.points[grid.at(p, q)]; };
        out.points.push_back(((1 - s) * (1 - t)) * x(i, j) + (s * (1 - t)) * x(i1, j) + ((1 - s) * t) * x(i, j1) +
                             (s * t) * x(i1, j1));
      }
    for (int b = 0; b + 1 < nb; ++b)
      for (int a = 0; a + 1 < na; ++a) {
        int const v = first + a + na * b;
        std::array<std::array<int, 3>, 2> both{{{v, v + 1, v + 1 + na}, {v, v + 1 + na, v + na}}};
        for (auto& t : both) {
          if (grid.inward) std::swap(t[1], t[2]);
          Vec3 const normal = cross(out.points[t[1]] - out.points[t[0]], out.points[t[2]] - out.points[t[0]]);
          if (norm(normal) > 0) out.triangles.push_back(t);
        }
      }
  }
  return out;
}

}  // namespace gridmorph
