#include <gridmorph/motion/inflation/fold_share.hpp>

#include <cmath>

namespace gridmorph {

namespace {

constexpr double least_area = 0.01;  // of the baseline's

/// The smallest positive s with a + b s + c s^2 = 0 for a > 0; above 1 where there is none up to 1.
double first_root(double a, double b, double c) {
  double const discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return 2;
  // 2 a / (-b + root): the root of smaller size where b is negative; where it is not, c has to be.
  double const divisor = -b + std::sqrt(discriminant);
  return divisor > 0 ? 2 * a / divisor : 2;
}

class Search {
 public:
  Search(PatchSurface const& surface, std::span<Vec3 const> u) : surface_(surface), u_(u) {}

  Fold run() {
    if (surface_.lines) {
      for (PatchGrid const& grid : surface_.grids)
        for (GridFacet const& face : grid.faces) {
          Vec3 const e = edge(face[0], face[1]);
          take(face[0], (1 - least_area) * dot(e, e), dot(change(face[0], face[1]), e), 0);
        }
      return out_;
    }
    for (GridFacet const& facet : surface_.facets()) visit(facet, facet[3] < 0 ? 3 : 4);
    return out_;
  }

 private:
  [[nodiscard]] Vec3 edge(int a, int b) const {
    return surface_.points[std::size_t(b)] - surface_.points[std::size_t(a)];
  }
  [[nodiscard]] Vec3 change(int a, int b) const { return u_[std::size_t(b)] - u_[std::size_t(a)]; }

  void visit(GridFacet const& facet, int n) {
    Vec3 normal;
    for (int c = 1; c + 1 < n; ++c) normal += cross(edge(facet[0], facet[c]), edge(facet[0], facet[c + 1]));
    for (int c = 0; c < n; ++c) {
      int const at = facet[c], next = facet[(c + 1) % n], before = facet[(c + n - 1) % n];
      Vec3 const e = edge(at, next), f = edge(at, before), du = change(at, next), dv = change(at, before);
      double const area = dot(cross(e, f), normal);
      // Corners of 180 degrees and re-entrant ones say nothing.
      if (area > 1e-9 * norm(e) * norm(f) * norm(normal))
        take(at, (1 - least_area) * area, dot(cross(e, dv) + cross(du, f), normal), dot(cross(du, dv), normal));
    }
  }

  void take(int vertex, double a, double b, double c) {
    double const share = a > 0 ? first_root(a, b, c) : 2;
    if (share < out_.share) out_ = {share, vertex};
  }

  PatchSurface const& surface_;
  std::span<Vec3 const> u_;
  Fold out_;
};

}  // namespace

Fold fold_share(PatchSurface const& surface, std::span<Vec3 const> displacement) {
  return Search(surface, displacement).run();
}

}  // namespace gridmorph
