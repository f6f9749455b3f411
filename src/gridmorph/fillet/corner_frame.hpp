// A corner between two sheets of a zone, and its nodes by their depths off both walls.
#pragma once

#include <gridmorph/fillet/split_mesh.hpp>

#include <array>
#include <optional>

namespace gridmorph {

struct CornerFrame {
  Zone const* zone = nullptr;
  std::array<Sheet const*, 2> sheet{nullptr, nullptr};  ///< blade, end wall

  [[nodiscard]] int zone_number() const { return sheet[0]->zone; }
  [[nodiscard]] int along() const { return 3 - sheet[0]->axis - sheet[1]->axis; }
  /// The number of nodes along the corner.
  [[nodiscard]] int stations() const { return zone->extent[along()]; }
  /// The index of a node at a station. `off[w]`: cells between the node and wall w.
  [[nodiscard]] Index3 index(int station, std::array<int, 2> off) const {
    Index3 p{0, 0, 0};
    p[along()] = station;
    for (std::size_t w = 0; w < 2; ++w)
      p[sheet[w]->axis] = sheet[w]->side == 0 ? off[w] : zone->extent[sheet[w]->axis] - 1 - off[w];
    return p;
  }
  /// The number of cells from wall w to the other side of the zone.
  [[nodiscard]] int cells(int w) const { return zone->extent[sheet[w]->axis] - 1; }
};

/// All corners of a mesh, zone after zone.
std::vector<CornerFrame> corners_of(Mesh const& mesh, WallSheets const& sheets);

/// A station of a corner.
struct CornerPlace {
  std::size_t corner = 0;
  int station = 0;
  friend bool operator==(CornerPlace const&, CornerPlace const&) = default;
};

/// Corners that follow one another from zone to zone, not across periodic interfaces.
struct CornerRow {
  std::vector<CornerPlace> places;  ///< those that zones share once
  bool closed = false;              ///< the first follows on the last
};

/// Rows of corners, and the places where they are.
class CornerRows {
 public:
  CornerRows(std::vector<CornerFrame> const& corners, Links const& links);

  [[nodiscard]] std::vector<CornerRow> const& rows() const { return rows_; }
  [[nodiscard]] int row_of(std::size_t corner) const { return row_of_[corner]; }
  /// The number of a station in its row.
  [[nodiscard]] int number(CornerPlace const& place) const { return number_[place.corner][place.station]; }
  /// The place of the same node in the zone behind the end of a corner; nothing where the row ends.
  [[nodiscard]] std::optional<CornerPlace> across(CornerPlace const& end) const;

 private:
  std::vector<CornerFrame> const& corners_;
  Links const& links_;
  std::vector<CornerRow> rows_;
  std::vector<int> row_of_;
  std::vector<std::vector<int>> number_;  ///< per corner and station
};

}  // namespace gridmorph
