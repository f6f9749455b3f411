#include <gridmorph/plan/elements/wrap.hpp>

#include <array>

namespace gridmorph {
namespace {

Patch wrap_patch() {
  Patch surface;
  surface.name = "wrap";
  surface.bc_type = "BCWall";
  surface.kind = PatchKind::wall;
  surface.zone = 0;
  return surface;
}

/// Prisms between the centre line and the rings.
Mesh tube_mesh(Tube const& tube) {
  Mesh mesh;
  mesh.source = "wrap";
  int const n = tube.sections(), around = tube.around, stride = around + 1;
  mesh.add_zone("wrap", Index(n) * stride);
  mesh.coordinates = Coordinates(mesh.n_nodes());
  Patch surface = wrap_patch();
  auto centre = [&](int j) { return Index32(j * stride); };
  auto ring = [&](int j, int k) { return Index32(j * stride + 1 + k % around); };
  for (int j = 0; j < n; ++j) {
    mesh.coordinates.set(centre(j), tube.centre[j]);
    for (int k = 0; k < around; ++k) mesh.coordinates.set(ring(j, k), tube.point(j, k));
    for (int k = 0; k < around; ++k) {
      if (j == 0 || j == n - 1) {
        std::array<Index32, 3> const end{centre(j), ring(j, k), ring(j, k + 1)};
        surface.faces.add(end);
      }
      if (j == n - 1) continue;
      std::array<Index32, 6> const prism{centre(j),     ring(j, k),     ring(j, k + 1),
                                         centre(j + 1), ring(j + 1, k), ring(j + 1, k + 1)};
      mesh.add_element(ElementType::prism, prism);
      std::array<Index32, 4> const side{ring(j, k), ring(j, k + 1), ring(j + 1, k + 1), ring(j + 1, k)};
      surface.faces.add(side);
    }
  }
  mesh.patches.push_back(std::move(surface));
  return mesh;
}

}  // namespace

Mesh wrap_mesh(Wrap const& wrap) {
  if (wrap.tube) return tube_mesh(*wrap.tube);
  Mesh mesh;
  mesh.dimension = wrap.dimension;
  mesh.source = "wrap";
  bool const flat = wrap.dimension == 2;
  Index const ni = wrap.cells(0) + 1, nj = wrap.cells(1) + 1, nk = flat ? 1 : wrap.cells(2) + 1;
  std::vector<Index32> number(ni * nj * nk, -1);
  std::vector<Vec3> points;
  auto node = [&](int i, int j, int k) {
    Index32& n = number[i + ni * (j + nj * k)];
    if (n < 0) {
      n = Index32(points.size());
      points.push_back(wrap.domain.chart.place({wrap.planes[0][i], wrap.planes[1][j], flat ? 0.0 : wrap.planes[2][k]}));
    }
    return n;
  };
  Patch surface = wrap_patch();
  std::vector<std::array<Index32, 8>> hexahedra;
  for (Index c = 0; c < wrap.n_cells(); ++c) {
    if (wrap.inside[c] == 0) continue;
    Index3 const at = wrap.index(c);
    auto const [i, j, k] = at;
    // Corner (a, b, c) of the cell at 4 c + 2 b + a.
    std::array<Index32, 8> corner{};
    for (int n = 0; n < (flat ? 4 : 8); ++n) corner[n] = node(i + (n & 1), j + (n >> 1 & 1), k + (n >> 2));
    hexahedra.push_back({corner[0], corner[1], corner[3], corner[2], corner[4], corner[5], corner[7], corner[6]});
    for (int axis = 0; axis < wrap.dimension; ++axis)
      for (int const side : {0, 1}) {
        Index3 beyond = at;
        beyond[axis] += 2 * side - 1;
        if (wrap.is_inside(beyond)) continue;
        std::size_t const fixed = std::size_t(side) << axis, u = std::size_t(axis == 0 ? 2 : 1),
                          v = std::size_t(axis == 2 ? 2 : 4);
        std::array<Index32, 4> const face{corner[fixed], corner[fixed + u], corner[flat ? fixed : fixed + u + v],
                                          corner[flat ? fixed : fixed + v]};
        surface.faces.add(std::span(face).first(flat ? 2 : 4));
      }
  }
  mesh.add_zone("wrap", Index(points.size()));
  for (auto const& corners : hexahedra)
    mesh.add_element(flat ? ElementType::quadrilateral : ElementType::hexahedron,
                     std::span(corners).first(flat ? 4 : 8));
  mesh.patches.push_back(std::move(surface));
  mesh.coordinates = Coordinates(Index(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n) mesh.coordinates.set(Index(n), points[n]);
  return mesh;
}

}  // namespace gridmorph
