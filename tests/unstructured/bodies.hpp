// Closed surfaces in a box, as the moving walls of meshes that have no elements: enough to be wrapped.
#pragma once

#include <gridmorph/mesh/unstructured_mesh.hpp>

#include <cmath>
#include <numbers>
#include <vector>

namespace gridmorph::test {

class Bodies {
 public:
  void box(Vec3 const& low, Vec3 const& high) {
    std::array<Index32, 8> corner{};
    for (int n = 0; n < 8; ++n)
      corner[n] = add({(n & 1) != 0 ? high.x : low.x, (n & 2) != 0 ? high.y : low.y, (n & 4) != 0 ? high.z : low.z});
    constexpr int face[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    for (auto const& f : face) {
      std::array<Index32, 4> const nodes{corner[f[0]], corner[f[1]], corner[f[2]], corner[f[3]]};
      walls.front().add(nodes);
    }
  }
  void sphere(Vec3 const& centre, double radius, int n) {
    grid(n, 2 * n, [&](int j, int i) {
      double const t = j * std::numbers::pi / n, f = i * std::numbers::pi / n;
      return centre + radius * Vec3{std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t)};
    });
  }
  void rod(Vec3 const& from, Vec3 const& to, double radius) {
    Vec3 const along = to - from;
    double const length = norm(along);
    Vec3 const e = (1 / length) * along;
    Vec3 u = cross(e, std::abs(e.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
    u = (1 / norm(u)) * u;
    Vec3 const v = cross(e, u);
    int const n = std::max(1, int(length / radius));
    grid(n, 8, [&](int j, int i) {
      double const f = 2 * std::numbers::pi * i / 8;
      return from + (double(j) / n) * along + radius * std::cos(f) * u + radius * std::sin(f) * v;
    });
  }
  /// n strips of m quadrilaterals, closed around.
  template <class Position>
  void grid(int n, int m, Position const& position) {
    Index32 const first = Index32(points_.size());
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i < m; ++i) points_.push_back(position(j, i));
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < m; ++i) {
        int const next = (i + 1) % m;
        std::array<Index32, 4> const face{first + j * m + i, first + j * m + next, first + (j + 1) * m + next,
                                          first + (j + 1) * m + i};
        walls.front().add(face);
      }
  }
  /// A closed polygon in the plane z = 0, as edges.
  void polygon(std::vector<Vec3> const& corners) {
    std::vector<Index32> numbers;
    for (Vec3 const& p : corners) numbers.push_back(add(p));
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      std::array<Index32, 2> const edge{numbers[n], numbers[(n + 1) % numbers.size()]};
      walls.front().add(edge);
    }
  }
  /// The mesh: all nodes of the bodies and two opposite corners of the domain.
  Mesh in_domain(Vec3 const& low, Vec3 const& high, int dimension = 3) const {
    Mesh mesh;
    mesh.dimension = dimension;
    mesh.add_zone("bodies", Index(points_.size()) + 2);
    mesh.coordinates = Coordinates(mesh.n_nodes());
    for (std::size_t n = 0; n < points_.size(); ++n) mesh.coordinates.set(Index(n), points_[n]);
    mesh.coordinates.set(Index(points_.size()), low);
    mesh.coordinates.set(Index(points_.size()) + 1, high);
    return mesh;
  }
  [[nodiscard]] std::vector<Vec3> const& points() const { return points_; }

  std::vector<CsrGraph> walls{1};

 private:
  Index32 add(Vec3 const& p) {
    points_.push_back(p);
    return Index32(points_.size()) - 1;
  }
  std::vector<Vec3> points_;
};

}  // namespace gridmorph::test
