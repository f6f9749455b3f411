#include <gridmorph/fillet/corner_frame.hpp>

namespace gridmorph {

std::vector<CornerFrame> corners_of(Mesh const& mesh, WallSheets const& sheets) {
  std::vector<CornerFrame> out;
  for (std::size_t z = 0; z < mesh.zones.size(); ++z)
    for (int b : sheets.of_zone[z])
      for (int w : sheets.of_zone[z])
        if (sheets.all[b].wall == Wall::blade && sheets.all[w].wall == Wall::end_wall)
          out.push_back({&mesh.zones[z], {&sheets.all[b], &sheets.all[w]}});
  return out;
}

CornerRows::CornerRows(std::vector<CornerFrame> const& corners, Links const& links)
    : corners_(corners), links_(links), row_of_(corners.size(), -1) {
  for (CornerFrame const& corner : corners) number_.emplace_back(std::size_t(corner.stations()), -1);
  auto const other_end = [&](CornerPlace const& end) {
    return CornerPlace{end.corner, corners[end.corner].stations() - 1 - end.station};
  };
  for (std::size_t c = 0; c < corners.size(); ++c) {
    if (row_of_[c] >= 0) continue;
    // Back to where the row begins, or once around.
    CornerPlace begin{c, 0};
    for (auto before = across(begin); before && before->corner != c; before = across(begin)) begin = other_end(*before);
    int const row = int(rows_.size());
    rows_.emplace_back();
    auto& [places, closed] = rows_.back();
    for (std::optional<CornerPlace> at = begin; at;) {
      if (row_of_[at->corner] >= 0) {
        closed = true;
        break;
      }
      row_of_[at->corner] = row;
      int const stations = corners[at->corner].stations(), step = at->station == 0 ? 1 : -1;
      bool const shared = !places.empty();
      for (int n = 0; n < stations; ++n) {
        CornerPlace const place{at->corner, at->station + n * step};
        if (n > 0 || !shared) places.push_back(place);
        number_[place.corner][place.station] = int(places.size()) - 1;
      }
      at = across(other_end(*at));
    }
    if (closed) {  // its last station is its first one
      CornerPlace const last = places.back();
      number_[last.corner][last.station] = 0;
      places.pop_back();
    }
  }
}

std::optional<CornerPlace> CornerRows::across(CornerPlace const& end) const {
  CornerFrame const& corner = corners_[end.corner];
  Index3 const p = corner.index(end.station, {0, 0});
  for (int n : links_.of_zone[corner.zone_number()]) {
    Link const& link = links_.all[n];
    if (link.periodic || link.range.extent(corner.along()) != 1 || !link.range.contains(p)) continue;
    Index3 const q = link.to_donor(p);
    for (std::size_t d = 0; d < corners_.size(); ++d)
      if (corners_[d].zone_number() == link.donor_zone)
        for (int station : {0, corners_[d].stations() - 1})
          if (corners_[d].index(station, {0, 0}) == q && CornerPlace{d, station} != end) return CornerPlace{d, station};
  }
  return {};
}

}  // namespace gridmorph
