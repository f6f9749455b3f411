// Pictures of one mesh, or of a baseline and its morphed mesh side by side: sections, close-ups at walls, walls in
// space, and what [output] stages left.
#pragma once

#include <gridmorph/page/view_page.hpp>
#include <gridmorph/run/console.hpp>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace gridmorph::cli {

struct ViewRequest {
  std::filesystem::path mesh;
  std::optional<std::filesystem::path> morphed;
  /// Where it is cut; at most one of the three. None: a plane mesh is itself, a machine with periodic sides is cut at
  /// half span, anything else at the plane through the middle of what moves (or of the walls) that meets most of it.
  std::optional<std::pair<int, double>> plane;  ///< coordinate 0 to 2 and its value [length]
  std::optional<double> span;                   ///< from hub, 0, to case, 1
  std::optional<std::array<int, 2>> index;      ///< axis of blocks and number of a plane of nodes, from 1
  std::optional<int> axis;                      ///< of the machine, 0 to 2; none: that of periodic sides, else x
  std::string wall;                             ///< of the close-ups: a family or patch; empty: the first one met
  std::optional<std::array<double, 4>> box;     ///< of one more close-up: from, to across and from, to up
  std::string color;            ///< determinant, displacement, type, none or a variable; empty: by the kind of mesh
  std::optional<double> moved;  ///< outlines cells that move by at least this [length]
  std::optional<std::filesystem::path> stages;  ///< what [output] stages names
  int dpi = 150;                                ///< a panel is 6.4 inches wide
};

/// Reads the meshes and draws. Throws IoError, MeshError and ConfigError for what cannot be drawn. Cost: reading, the
/// neighbours of elements, a pass over nodes and cells per cut, pixels.
page::ViewPage draw_view(ViewRequest const& request, Console& console);

}  // namespace gridmorph::cli
