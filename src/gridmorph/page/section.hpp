// A mesh cut along a surface: the polygons that its cells leave there, flat.
#pragma once

#include <gridmorph/page/canvas.hpp>
#include <gridmorph/page/picture_mesh.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gridmorph::page {

using Flat = std::array<double, 2>;

/// Where a mesh is cut, and how the cut is laid flat.
struct Cut {
  std::string title;                  ///< "span 50 %", "y = 3.5"
  std::array<std::string, 2> labels;  ///< of the two coordinates
  /// Gives each node, (n_nodes), its level: zero where the mesh is cut. Empty: the plane of a mesh.
  std::function<void(Coordinates const& at, std::span<double> level)> levels;
  std::function<Flat(Vec3 const&)> flat;
  double period = 0;  ///< of the second coordinate; polygons wider than half of it are left out; 0: none
  /// Instead of levels: an axis of blocks and a plane of nodes across it, from 0.
  std::optional<std::array<int, 2>> index_plane = {};
};

struct Section {
  std::vector<Index> cell;         ///< (polygons)
  std::vector<std::size_t> first;  ///< (polygons + 1) in `corner`
  std::vector<Flat> corner;
  struct Wall {
    Flat a{}, b{};
    bool moves = false;
    int patch = -1;
  };
  std::vector<Wall> walls;  ///< pieces of patches
};

/// `moves`: per patch, whether it counts as moving; patches that do not count as walls are left out (-1). Cost: one
/// pass over the nodes and cells.
Section cut_mesh(PictureMesh const& mesh, std::vector<Facet> const& boundary, Coordinates const& at, Cut const& cut,
                 std::vector<signed char> const& walls);

/// A frame: centre and half of the width, in the coordinates of the section.
struct Window {
  Flat centre{};
  double half_width = 1;
};

struct FlatBox {
  Flat low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};

  void take(Flat const& p);
  [[nodiscard]] bool empty() const { return !(low[0] <= high[0]); }
};

/// About all walls of a section that move.
FlatBox moving_walls(Section const& section);

/// More lines over a section.
struct Overlay {
  std::vector<std::array<Flat, 2>> lines;
  Colour colour;
  double width = 1;  ///< pixels
};

/// Cells in the colours of their polygons, grid lines where they can be told apart, what lies over them, then walls.
/// Cost: polygons and pixels.
io::Picture section_picture(Section const& section, std::span<Colour const> colour, Window const& window, int width,
                            int height, std::span<Overlay const> overlays = {});

}  // namespace gridmorph::page
