#include <generators/wall_shell.hpp>

#include <generators/spacing.hpp>

#include <cmath>

namespace gridmorph::demo {

double LayerHeights::at(int l) const {
  return growth == 1 ? first * l : first * std::expm1(l * std::log(growth)) / (growth - 1);
}

LayerHeights LayerHeights::reaching(double first, double growth, double last, double limit) {
  constexpr int most = 1000;
  LayerHeights heights{first, growth, 1};
  while (heights.n < most && heights.last() * growth < last && heights.at(heights.n + 1) < limit) ++heights.n;
  return heights;
}

std::vector<double> column_heights(LayerHeights const& layers, int n, double length) {
  std::vector<double> heights;
  for (int l = 0; l <= layers.n; ++l) heights.push_back(layers.at(l) / length);
  double const rest = 1 - heights.back();
  auto const beyond = geometric_spacing(n, layers.last() * layers.growth / (rest * length));
  for (int l = 1; l <= n; ++l) heights.push_back(heights[layers.n] + rest * beyond[l]);
  heights.back() = 1;
  return heights;
}

int first_tall_cell(LayerHeights const& layers, std::vector<double> const& heights, double length, double width) {
  constexpr double tall = 0.3;
  auto const last = int(heights.size()) - 1;
  for (int l = layers.n; l < last; ++l)
    if ((heights[l + 1] - heights[l]) * length >= tall * width) return l;
  return last;
}

std::vector<Rank> WallShell::ranks(std::size_t n_nodes) const {
  std::vector<Rank> ranks;
  ranks.reserve(n_nodes);
  for (Index32 c = 0; c < n_columns; ++c)
    for (int l = 0; l < stride(); ++l) ranks.push_back(l <= aligned ? rank_of(node(c, 0), l) : rank_of(node(c, l)));
  while (ranks.size() < n_nodes) ranks.push_back(rank_of(Index32(ranks.size())));
  return ranks;
}

void WallShell::add_to(HybridMesh& mesh) const {
  auto const quad = [&](Quad const& c, int low, int high) {
    return Quad{node(c[0], low), node(c[1], low), node(c[2], high), node(c[3], high)};
  };
  for (auto const& q : quads) {
    for (int l = 0; l < cells; ++l) {
      Hex hex;
      for (std::size_t c = 0; c < 4; ++c) {
        hex[c] = node(q.columns[c], l);
        hex[c + 4] = node(q.columns[c], l + 1);
      }
      if (l >= layers)
        l == layers&& q.hexahedra ? mesh.add_pyramid(hex) : mesh.add_tetrahedra(hex);
      else
        q.hexahedra ? mesh.add_hexahedron(hex) : mesh.add_prisms(hex);
    }
    // The wall's faces point out of the mesh, into the body.
    Quad const wall{node(q.columns[0], 0), node(q.columns[3], 0), node(q.columns[2], 0), node(q.columns[1], 0)};
    q.hexahedra ? mesh.add_quadrilateral(q.patch, wall) : mesh.add_triangles(q.patch, wall);
  }
  for (auto const& rim : rims)
    for (int l = 0; l < cells; ++l) {
      Quad const side = quad({rim.from, rim.to, rim.to, rim.from}, l, l + 1);
      l < layers ? mesh.add_quadrilateral(rim.patch, side) : mesh.add_triangles(rim.patch, side);
    }
}

Index elements_over(int layers, int cells, bool hexahedra) {
  Index const split = Index(cells - layers) * 6;
  // A hexahedron is one element where two prisms are two; the cell over it is eleven elements and not six.
  return hexahedra ? layers + split + 5 : 2 * Index(layers) + split;
}

Index WallShell::n_elements() const {
  Index n = 0;
  for (auto const& q : quads) n += elements_over(layers, cells, q.hexahedra);
  return n;
}

}  // namespace gridmorph::demo
