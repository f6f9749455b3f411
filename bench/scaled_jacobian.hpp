// How bad the worst corner of a mesh is: one number that knows nothing of the measures of the library.
#pragma once

#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace gridmorph::bench {

/// The corners at the other ends of the edges of a corner, right-handed; of tetrahedra, pyramids (base), prisms,
/// hexahedra, and in 2-D.
inline std::vector<std::array<int, 4>> corner_stars(ElementType type) {
  std::vector<std::array<int, 4>> out;
  auto const columns = [&](int n) {
    for (int k = 0; k < n; ++k) {
      int const next = (k + 1) % n, previous = (k + n - 1) % n;
      out.push_back({k, next, previous, k + n});
      out.push_back({k + n, previous + n, next + n, k});
    }
  };
  switch (type) {
    case ElementType::triangle: return {{0, 1, 2, -1}, {1, 2, 0, -1}, {2, 0, 1, -1}};
    case ElementType::quadrilateral: return {{0, 1, 3, -1}, {1, 2, 0, -1}, {2, 3, 1, -1}, {3, 0, 2, -1}};
    case ElementType::tetrahedron: return {{0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 0, 2, 1}};
    case ElementType::pyramid: return {{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}};
    case ElementType::prism: columns(3); return out;
    case ElementType::hexahedron: columns(4); return out;
    case ElementType::polyhedron: break;
  }
  return out;
}

/// Scaled Jacobian: the determinant of the edges at a corner over the product of their lengths; pyramids by the corners
/// of their base, polyhedra not.
struct Verdict {
  double smallest = 1;  ///< over all corners of all elements
  Index inverted = 0;   ///< elements with a corner that is not above zero
};

/// Elements that are numbered the other way round in the baseline are as good as others; collapsed corners are left
/// out.
inline Verdict judge(Mesh const& mesh, Coordinates const& x) {
  std::array<std::vector<std::array<int, 4>>, n_element_types> stars;
  for (int t = 0; t < n_element_types; ++t) stars[t] = corner_stars(ElementType(t));
  Vec3 const up = plane_normal(mesh);
  auto const scaled = [&](Index e, std::array<int, 4> const& star, Coordinates const& at) {
    auto const nodes = mesh.elements.corners(e);
    Vec3 const p = at[nodes[star[0]]];
    auto const edge = [&](int k) { return at[nodes[star[k]]] - p; };
    Vec3 const a = edge(1), b = edge(2), c = star[3] < 0 ? up : edge(3);
    double const lengths = norm(a) * norm(b) * norm(c);
    return lengths > 0 ? dot(cross(a, b), c) / lengths : 2.0;
  };
  Verdict out;
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    double before = 0, least = 1;
    for (auto const& star : stars[std::size_t(mesh.elements.type[e])]) {
      double const s = scaled(e, star, mesh.coordinates);
      if (s <= 1) before += s;
    }
    for (auto const& star : stars[std::size_t(mesh.elements.type[e])])
      least = std::min(least, before < 0 ? -scaled(e, star, x) : scaled(e, star, x));
    if (least == -2) continue;
    out.smallest = std::min(out.smallest, least);
    out.inverted += least <= 0 ? 1 : 0;
  }
  return out;
}

}  // namespace gridmorph::bench
