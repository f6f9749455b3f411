#include <generators/sphere.hpp>
#include <generators/wall_shell.hpp>
#include <gridmorph/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace gridmorph {

namespace {

using namespace demo;

struct SphereCounts {
  int side = 0;         ///< faces along a quarter of the equator
  int tetrahedral = 0;  ///< cells of a column beyond the layers
  LayerHeights layers;  ///< in radii
};

void check(SphereOptions const& o) {
  Problems problems;
  auto const within = [&](char const* what, double value, double low, double high) {
    if (!(value >= low && value <= high))
      problems.add("sphere: " + std::string(what) + " is " + std::to_string(value) + "; it must lie within " +
                   std::to_string(low) + " and " + std::to_string(high));
  };
  if (!(o.radius > 0 && std::isfinite(o.radius)))
    problems.add("sphere: radius is " + std::to_string(o.radius) + "; it must be positive");
  within("distance", o.distance, 0.5, 1000);
  within("first_cell", o.first_cell, 1e-8, 0.1);
  within("growth", o.growth, 1, 2);
  within("jitter", o.jitter, 0, 0.3);
  if (o.layers < 0) problems.add("sphere: layers is " + std::to_string(o.layers) + "; it must not be negative");
  problems.throw_if_any<ConfigError>();
  LayerHeights const asked{o.first_cell, o.growth, o.layers};
  if (o.layers > 0 && !(asked.total() <= o.distance))
    throw ConfigError("sphere: " + std::to_string(o.layers) + " layers that begin with " +
                      std::to_string(o.first_cell) + " and grow by " + std::to_string(o.growth) + " are " +
                      std::to_string(asked.total()) + " radii thick; ask for no more than " +
                      std::to_string(o.distance));
}

/// Faces of the cube that the sphere's faces are named after.
constexpr int cube_faces = 6;

bool has_hexahedra(LayerElements elements, int cube_face) {
  return elements == LayerElements::hexahedra || (elements == LayerElements::mixed && cube_face % 2 == 1);
}

/// Columns of tetrahedra's cells stretch outwards at the rate at which the sphere's faces widen, times 1 / density.
SphereCounts counts_at(SphereOptions const& o, int side, double density) {
  SphereCounts n;
  n.side = side;
  double const face = 0.5 * std::numbers::pi / side, thickest = std::min(0.5, 0.5 * o.distance);
  n.layers = o.layers > 0 ? LayerHeights{o.first_cell, o.growth, o.layers}
                          : LayerHeights::reaching(o.first_cell, o.growth, 0.4 * face, thickest);
  double const stretch = std::log((1 + 2 * o.distance) / (1 + n.layers.total()));
  n.tetrahedral = std::max(2, int(std::lround(density * stretch / face)));
  return n;
}

Index count_elements(SphereOptions const& o, SphereCounts const& n) {
  Index total = 0;
  for (int f = 0; f < cube_faces; ++f)
    total += Index(n.side) * n.side *
             elements_over(n.layers.n, n.layers.n + n.tetrahedral, has_hexahedra(o.layer_elements, f));
  return total;
}

SphereCounts sphere_counts(SphereOptions const& o) {
  constexpr int coarsest = 4, finest = 1000, steps = 60;
  constexpr double span = 1.5, even_weight = 0.2;
  double best = std::numeric_limits<double>::infinity();
  SphereCounts found;
  for (int side = coarsest; side <= finest; ++side) {
    if (double(count_elements(o, counts_at(o, side, 1 / span))) > 1.5 * double(o.elements)) break;
    for (int step = -steps; step <= steps; ++step) {
      double const off = double(step) / steps * std::log(span);
      SphereCounts const counts = counts_at(o, side, std::exp(off));
      double const error = std::abs(std::log(double(count_elements(o, counts)) / double(o.elements)));
      double const cost = error + even_weight * std::abs(off);
      if (error < 0.09 && cost < best) {
        best = cost;
        found = counts;
      }
    }
  }
  if (found.side == 0)
    throw ConfigError("sphere: no mesh of this shape has about " + std::to_string(o.elements) +
                      " elements; ask for 10 thousand to 50 million, or for fewer layers");
  return found;
}

/// The surface of a cube of m^3 cells: its nodes are the columns.
class CubeSurface {
 public:
  explicit CubeSurface(int m) : m_(m), column_(std::size_t(m + 1) * (m + 1) * (m + 1), -1) {
    for (int k = 0; k <= m; ++k)
      for (int j = 0; j <= m; ++j)
        for (int i = 0; i <= m; ++i) {
          bool const inside = i > 0 && i < m && j > 0 && j < m && k > 0 && k < m;
          if (inside) continue;
          column_[place({i, j, k})] = Index32(directions_.size());
          Vec3 const corner{tangent(i), tangent(j), tangent(k)};
          directions_.push_back(corner);
        }
  }

  /// Of each column: a point of the surface of the cube [-1, 1]^3, from where the faces look equally large to the
  /// centre.
  [[nodiscard]] std::vector<Vec3> const& points() const { return directions_; }

  /// Columns of face (a, b) of one of the sides, counter-clockwise seen from outside.
  [[nodiscard]] Quad quad(int side, int a, int b) const {
    int const axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<int, 3> at{};
    at[axis] = side % 2 == 1 ? m_ : 0;
    auto const corner = [&](int da, int db) {
      at[u] = a + da;
      at[v] = b + db;
      return column_[place(at)];
    };
    if (side % 2 == 1) return {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
    return {corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)};
  }

 private:
  [[nodiscard]] std::size_t place(std::array<int, 3> const& at) const {
    return std::size_t(at[0]) + std::size_t(m_ + 1) * (std::size_t(at[1]) + std::size_t(m_ + 1) * std::size_t(at[2]));
  }
  [[nodiscard]] double tangent(int i) const {
    if (i == 0 || i == m_) return i == 0 ? -1 : 1;
    return std::tan(0.25 * std::numbers::pi * (2.0 * i / m_ - 1));
  }

  int m_;
  std::vector<Index32> column_;  ///< of each of the (m + 1)^3 places; -1 inside
  std::vector<Vec3> directions_;
};

}  // namespace

Mesh make_sphere(SphereOptions const& options) {
  check(options);
  SphereCounts const counts = sphere_counts(options);
  CubeSurface const cube(counts.side);
  WallShell shell;
  shell.n_columns = Index32(cube.points().size());
  shell.layers = counts.layers.n;
  shell.cells = counts.layers.n + counts.tetrahedral;
  for (int side = 0; side < cube_faces; ++side)
    for (int b = 0; b < counts.side; ++b)
      for (int a = 0; a < counts.side; ++a)
        shell.quads.push_back({cube.quad(side, a, b), 0, has_hexahedra(options.layer_elements, side)});

  double const outer_radius = 1 + 2 * options.distance;
  shell.aligned = first_tall_cell(counts.layers, column_heights(counts.layers, counts.tetrahedral, outer_radius - 1),
                                  outer_radius - 1, 0.5 * std::numbers::pi / counts.side);
  std::vector<Vec3> nodes;
  for (Vec3 const& point : cube.points()) {
    double const to_point = norm(point);
    Vec3 const direction = (1 / to_point) * point;
    double const way = (options.outer == SphereOptions::Outer::cube ? outer_radius * to_point : outer_radius) - 1;
    for (double const h : column_heights(counts.layers, counts.tetrahedral, way))
      nodes.push_back(options.radius * (1 + h * way) * direction);
  }
  auto ranks = shell.ranks(nodes.size());
  HybridMesh mesh(std::move(nodes), std::move(ranks));
  mesh.add_patch("sphere", PatchKind::wall, "BCWallViscous");
  int const outer = mesh.add_patch("outer", PatchKind::farfield, "BCFarfield");
  shell.add_to(mesh);
  for (auto const& q : shell.quads) {
    Quad last;
    for (std::size_t c = 0; c < 4; ++c) last[c] = shell.node(q.columns[c], shell.cells);
    mesh.add_triangles(outer, last);
  }
  if (options.jitter > 0) mesh.jitter(options.jitter);
  if (options.shuffle) mesh.shuffle();
  return mesh.finish("Sphere", "sphere demo");
}

}  // namespace gridmorph
