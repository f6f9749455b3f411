#include <generators/ball_lattice.hpp>

#include <gridmorph/kernels/element_shape.hpp>

namespace gridmorph::demo {

namespace {

/// Continues lines upwards by n cells from one distance to another off `origin`.
void continue_up(std::vector<double>& lines, Grading const& sizes, double origin, double from, double to, int n) {
  auto const at = sizes.nodes(from, to, n);
  for (std::size_t i = 1; i < at.size(); ++i) lines.push_back(origin + at[i]);
}

/// Lines below `start`, which begins at `origin`.
std::vector<double> with_lines_below(std::vector<double> const& start, Grading const& sizes, double to, int n) {
  auto const at = sizes.nodes(0, to, n);
  std::vector<double> lines;
  for (std::size_t i = at.size() - 1; i > 0; --i) lines.push_back(start.front() - at[i]);
  lines.insert(lines.end(), start.begin(), start.end());
  return lines;
}

}  // namespace

BallLattice::BallLattice(BallOptions const& o, BallCounts const& counts, BallTube const& tube, Index32 first_node) {
  constexpr double a = tube_half_width;
  Grading const& sizes = counts.lattice;
  double const mast = o.mast_distance - a, mast_end = mast + o.mast_width, top = 1 + o.rope_length;
  lines_[0] = with_lines_below(tube.across(), sizes, o.behind - a, counts.behind);
  continue_up(lines_[0], sizes, a, 0, mast, counts.between);
  continue_up(lines_[0], sizes, a, mast, mast_end, counts.mast);
  continue_up(lines_[0], sizes, a, mast_end, mast_end + o.beyond, counts.beyond);
  lines_[1] = with_lines_below(tube.across(), sizes, o.beside - a, counts.beside);
  continue_up(lines_[1], sizes, a, 0, o.beside - a, counts.beside);
  lines_[2] = with_lines_below(tube.along(), sizes, o.below - a, counts.below);
  continue_up(lines_[2], sizes, top, 0, o.jib_height, counts.jib);
  continue_up(lines_[2], sizes, top, o.jib_height, o.jib_height + o.above, counts.above);

  Range const x{counts.behind, counts.behind + counts.side}, y{counts.beside, counts.beside + counts.side};
  Range const z{counts.below, counts.below + counts.rings()}, over{z.end, z.end + counts.jib};
  Range const mast_x{x.end + counts.between, x.end + counts.between + counts.mast};
  tube_ = {x, y, z};
  jib_ = {Range{x.begin, mast_x.end}, y, over};
  mast_ = {mast_x, y, Range{0, over.begin}};

  number_.assign(place(n(0), n(1), n(2)) + 1, -1);
  each_fluid_cell([&](int i, int j, int k) {
    for (int c = 0; c < 8; ++c) number_[place(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))] = 0;
  });
  for (Index32& number : number_)
    if (number == 0) number = first_node + n_nodes_++;
}

BallLattice::Cell BallLattice::cell(int i, int j, int k) const {
  if (i < 0 || j < 0 || k < 0 || i >= n(0) || j >= n(1) || k >= n(2)) return Cell::outside;
  auto const in = [&](Box const& box) { return box[0].holds(i) && box[1].holds(j) && box[2].holds(k); };
  return in(tube_) ? Cell::tube : in(jib_) || in(mast_) ? Cell::crane : Cell::fluid;
}

template <class Function>
void BallLattice::each_fluid_cell(Function const& function) const {
  for (int k = 0; k < n(2); ++k)
    for (int j = 0; j < n(1); ++j)
      for (int i = 0; i < n(0); ++i)
        if (cell(i, j, k) == Cell::fluid) function(i, j, k);
}

Hex BallLattice::corners(int i, int j, int k) const {
  return {node(i, j, k),     node(i + 1, j, k),     node(i + 1, j + 1, k),     node(i, j + 1, k),
          node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)};
}

std::vector<Vec3> BallLattice::nodes() const {
  std::vector<Vec3> nodes;
  for (int k = 0; k <= n(2); ++k)
    for (int j = 0; j <= n(1); ++j)
      for (int i = 0; i <= n(0); ++i)
        if (node(i, j, k) >= 0) nodes.push_back({lines_[0][i], lines_[1][j], lines_[2][k]});
  return nodes;
}

void BallLattice::add_to(HybridMesh& mesh, BallPatches const& patches) const {
  // In the order of the faces of a hexahedron: z min, y min, x max, y max, x min, z max.
  static constexpr std::array<std::array<int, 3>, 6> across{
      {{0, 0, -1}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};
  static constexpr std::array names{"box_z_min", "box_y_min", "box_x_max", "box_y_max", "box_x_min", "box_z_max"};
  std::array<int, 6> box{};
  for (std::size_t f = 0; f < names.size(); ++f)
    box[f] = f == 0 ? mesh.add_patch(names[f], PatchKind::symmetry, "BCSymmetryPlane")
                    : mesh.add_patch(names[f], PatchKind::farfield, "BCFarfield");
  each_fluid_cell([&](int i, int j, int k) {
    Hex const hex = corners(i, j, k);
    mesh.add_tetrahedra(hex);
    for (int f = 0; f < 6; ++f) {
      auto const& to = across[f];
      Cell const behind = cell(i + to[0], j + to[1], k + to[2]);
      if (behind == Cell::fluid || behind == Cell::tube) continue;
      Quad quad;
      for (int c = 0; c < 4; ++c) quad[c] = hex[face_corner(ElementType::hexahedron, f, c)];
      mesh.add_triangles(behind == Cell::crane ? patches.crane : box[f], quad);
    }
  });
}

}  // namespace gridmorph::demo
