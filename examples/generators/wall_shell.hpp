// A shell of cells around a wall: quadrilaterals on the wall, and a column of nodes off each of their corners. Its
// first cells are layers, the others are split into tetrahedra. Internal to the demo meshes.
#pragma once

#include <generators/hybrid_mesh.hpp>

#include <vector>

namespace gridmorph::demo {

/// Heights of the layers: h (g^l - 1) / (g - 1), l = 0 ... n.
struct LayerHeights {
  double first = 0;   ///< of the first cell
  double growth = 1;  ///< of a cell over the one below
  int n = 0;          ///< layers

  [[nodiscard]] double at(int l) const;
  [[nodiscard]] double total() const { return at(n); }
  [[nodiscard]] double last() const { return at(n) - at(n - 1); }
  /// As many as it takes to reach cells of height `last`, within a total of `limit`; at least one.
  static LayerHeights reaching(double first, double growth, double last, double limit);
};

/// Points of a column at fractions of its way: layers first, then `n` cells that continue their growth up to the end.
std::vector<double> column_heights(LayerHeights const& layers, int n, double length);

/// First level, not below the layers, over which a cell is at least 0.3 times as high as it is wide. Cells flatter than
/// that must be split alike at the bottom and at the top, or tetrahedra on a curved wall are inverted.
int first_tall_cell(LayerHeights const& layers, std::vector<double> const& heights, double length, double width);

struct WallQuad {
  Quad columns;  ///< counter-clockwise seen from outside the wall
  int patch = 0;
  bool hexahedra = false;  ///< the layers over it
};

/// Edge of the shell that lies on another boundary: the cells over it show a face there.
struct ShellRim {
  Index32 from = 0, to = 0;  ///< columns; the shell is on the left, seen from outside the wall
  int patch = 0;
};

struct WallShell {
  Index32 n_columns = 0;
  int layers = 0;      ///< cells of a column at the wall
  int cells = 0;       ///< of a column, all together
  int aligned = 0;     ///< up to this level all quadrilaterals over one of the wall are split alike; at least `layers`
  bool closed = true;  ///< the columns own their last nodes; else `outer` names them
  std::vector<Index32> outer;
  std::vector<WallQuad> quads;
  std::vector<ShellRim> rims;

  /// Nodes that a column owns, numbered one after another, column after column, from 0.
  [[nodiscard]] int stride() const { return closed ? cells + 1 : cells; }
  [[nodiscard]] Index32 n_nodes() const { return n_columns * stride(); }
  [[nodiscard]] Index32 node(Index32 column, int level) const {
    return level < stride() ? column * stride() + level : outer[std::size_t(column)];
  }
  /// Ranks of the nodes that the columns own, then of others up to n_nodes.
  [[nodiscard]] std::vector<Rank> ranks(std::size_t n_nodes) const;
  /// Adds all cells, the faces on the wall and those along the rims.
  void add_to(HybridMesh& mesh) const;
  /// Elements that add_to() makes.
  [[nodiscard]] Index n_elements() const;
};

/// Elements over one quadrilateral of a shell.
Index elements_over(int layers, int cells, bool hexahedra);

}  // namespace gridmorph::demo
