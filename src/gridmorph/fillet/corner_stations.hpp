// The corners of a mesh node by node: walls, lines, balls.
#pragma once

#include <gridmorph/fillet/corner_frame.hpp>
#include <gridmorph/fillet/fillet.hpp>
#include <gridmorph/fillet/wall_path.hpp>

#include <optional>
#include <vector>

namespace gridmorph {

/// How many layers the corners take: options.layers, or as many as reach the mean radius off the blade and 0.6 of it
/// off the end wall, as far as zones have them. Throws MeshError where a zone has too few cells.
SheetLayers choose_layers(Mesh const& mesh, WallSheets const& sheets, FilletOptions const& options);

class CornerStations {
 public:
  CornerStations(Mesh const& mesh, Links const& links, WallSheets const& sheets, SheetLayers const& layers,
                 FilletOptions const& options);

  CornerStations(CornerStations const&) = delete;  // stations refer to the surfaces
  CornerStations& operator=(CornerStations const&) = delete;

  [[nodiscard]] std::vector<CornerFrame> const& corners() const { return corners_; }
  [[nodiscard]] CornerStation const& station(std::size_t corner, int station) const {
    return stations_[corner][station];
  }
  /// Fills in what a result says about balls and ends.
  void describe(FilletResult& result) const;

 private:
  FacetSurface blade_, end_wall_;
  std::vector<CornerFrame> corners_;
  std::vector<BallRow> rows_;                         ///< as the corners follow one another
  std::vector<std::vector<CornerStation>> stations_;  ///< per corner
  int open_ends_ = 0;
};

}  // namespace gridmorph
